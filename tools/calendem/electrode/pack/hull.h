// SPDX-License-Identifier: GPL-2.0-or-later
// An outer shape that primaries are filled into.
#ifndef CALENDEM_ELECTRODE_PACK_HULL_H
#define CALENDEM_ELECTRODE_PACK_HULL_H

#include "base/random.h"
#include <functional>
#include <string>

namespace calendem {

/// About the origin.
struct Hull {
  std::function<double(const Eigen::Vector3d &)> depth; ///< at x [um]; grows outwards
  double reach;                                         ///< farthest point of the shape [um]
  std::function<double()> sphericity;
  std::string name;
};
using DrawHull = std::function<Hull(Random &)>;

} // namespace calendem

#endif
