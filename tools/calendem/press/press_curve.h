// SPDX-License-Identifier: GPL-2.0-or-later
// From an export to a curve: displacement from first contact, loading and release, without what the
// press itself gives way.
#ifndef CALENDEM_PRESS_PRESS_CURVE_H
#define CALENDEM_PRESS_PRESS_CURVE_H

#include "press/press_export.h"

namespace calendem {

struct PressCurve {
  std::vector<double> displacement, pressure, time; ///< [um], [MPa], [s]; time may be empty
  std::vector<std::string> stage;
  std::vector<int> cycle;      ///< from 1; the platen goes down once in each
  std::vector<double> machine; ///< what the press gave way at each row [um]; empty: unknown
  std::size_t contact = 0;     ///< its row in the export
  std::vector<std::string> said;
  double highest() const; ///< pressure
  /// Displacement at which the first loading reaches a pressure; NaN if it does not.
  double displacement_at(double pressure) const;
};

/// `contact_MPa`: the pressure from which on platen and film touch, if it lasts for three rows.
/// Throws Failure(2), with the name of the file, where they never do.
PressCurve make_press_curve(const std::string &file, const PressExport &from, double contact_MPa);

/// Takes off what the press alone, without a film, moves at each pressure. Throws Failure(2) where
/// `blank` ends below the curve's highest pressure.
void subtract_machine(PressCurve &curve, const PressCurve &blank);

/// The table that an experiment names: lines of `head` (TOML) behind '#', then the columns.
std::string curve_table(const PressCurve &curve, const std::string &head);

/// The page that shows what was done.
std::string press_page(const std::string &file, const PressExport &from, const PressCurve &curve);

} // namespace calendem

#endif
