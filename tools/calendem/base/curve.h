// SPDX-License-Identifier: GPL-2.0-or-later
// The course of a run as columns, and what is read off it.
#ifndef CALENDEM_BASE_CURVE_H
#define CALENDEM_BASE_CURVE_H

#include <map>
#include <string>
#include <vector>

namespace calendem {

using Column = std::vector<double>;

struct Curve {
  std::vector<std::string> stage;
  std::map<std::string, Column> columns; ///< every numeric column of curve.csv, by its name

  bool has(const std::string &name) const { return columns.count(name) > 0; }
  const Column &operator[](const std::string &name) const { return columns.at(name); }
  std::size_t rows() const { return stage.size(); }
  std::size_t row_of_max_pressure() const;

  /// Rows of one branch: compression and dwell, or relaxation, joined to the other at its end.
  std::vector<std::size_t> compression() const;
  std::vector<std::size_t> relaxation() const;
};

/// Value of column `name` when the pressure first reaches `pressure` in compression, interpolated
/// between rows; NaN if it never does.
double at_first_crossing(const Curve &curve, double pressure_MPa, const std::string &name);

/// |P_top - P_bottom| / P_top of every row: the column `pressure_difference`, which is averaged
/// over a longer window than a row, or else from the row's own pressures.
Column imbalance(const Curve &curve);

/// The largest of them over rows with P_top above `threshold_MPa`; NaN if none.
double worst_imbalance(const Curve &curve, double threshold_MPa);

Column picked(const Column &values, const std::vector<std::size_t> &rows, double factor = 1);

} // namespace calendem

#endif
