// SPDX-License-Identifier: GPL-2.0-or-later
// Puts the pieces of bodies that the periodic faces cut back together.
#ifndef CALENDEM_REPORT_WHOLES_H
#define CALENDEM_REPORT_WHOLES_H

#include <array>
#include <map>

#include "measure/run_directory.h"

namespace calendem::report {

/// The periodic sides [um] that electrode.json gives; 0: not known.
std::array<double, 2> period_of(const Run &run);

class Wholes {
public:
  /// Without a period everything stays where it is.
  Wholes(const ParticleFrame &frame, const std::array<double, 2> &period);
  /// The image of `p`, a point of `body`, nearest to the body's centre in the cell.
  Point place(Point p, int body) const;

private:
  std::array<double, 2> period_;
  std::map<int, std::array<double, 2>> centre_;
};

} // namespace calendem::report

#endif
