// SPDX-License-Identifier: GPL-2.0-or-later
// Two bodies that several cases let meet.
#ifndef CALENDEM_TESTS_MEETING_H
#define CALENDEM_TESTS_MEETING_H

#include <cmath>
#include <vector>

#include "spheres.h"

namespace calendem {

/// Two shaken bodies that meet: bonds under all loads, contact with friction and cohesion between
/// them.
inline std::vector<BodySphere> meeting() {
  std::vector<BodySphere> all = cube(2, 1.28, {-2.1, -0.9, -0.8}, 1);
  for (BodySphere s : cube(2, 1.28, {0.8, -0.3, -0.5}, 2))
    all.push_back(s);
  for (size_t n = 0; n < all.size(); ++n) {
    all[n].v = {(all[n].body == 1 ? 2.0 : -2.0) + std::sin(1.0 + n), std::sin(2.0 + 3.0 * n),
                std::cos(5.0 * n)};
    all[n].omega = {std::cos(1.0 + n), std::cos(2.0 + 3.0 * n), std::sin(5.0 * n)};
  }
  return all;
}

} // namespace calendem

#endif
