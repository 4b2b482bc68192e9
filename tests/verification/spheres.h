// SPDX-License-Identifier: GPL-2.0-or-later
// Spheres of a verification case, written as the files its in-script reads.
#ifndef CALENDEM_TESTS_SPHERES_H
#define CALENDEM_TESTS_SPHERES_H

#include <sstream>
#include <string>
#include <vector>

#include "physics/parallel_bond.h"
#include "run_case.h"

namespace calendem {

struct BodySphere {
  Vec3 x;
  double radius;
  int body;
  Vec3 v = {}, omega = {};
};

constexpr double kDensity = 4.65; // g/cm3

inline std::vector<BodySphere> cube(int side, double spacing, const Vec3 &corner, int body) {
  std::vector<BodySphere> all;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z)
        all.push_back({corner + spacing * Vec3{double(x), double(y), double(z)}, 0.795, body});
  return all;
}

/// atoms.data, bodies.map and start.in (velocities and spins) in a box from `low` to `high`.
inline Files files_of(const std::vector<BodySphere> &spheres, const Vec3 &low, const Vec3 &high) {
  std::ostringstream data, map, start;
  for (std::ostringstream *s : {&data, &map, &start})
    s->precision(17);
  data << "verification case\n\n"
       << spheres.size() << " atoms\n1 atom types\n"
       << low.x << " " << high.x << " xlo xhi\n"
       << low.y << " " << high.y << " ylo yhi\n"
       << low.z << " " << high.z << " zlo zhi\n\nAtoms\n\n";
  int tag = 0;
  for (const BodySphere &s : spheres) {
    ++tag;
    data << tag << " 1 " << 2.0 * s.radius << " " << kDensity << " " << s.x.x << " " << s.x.y << " "
         << s.x.z << "\n";
    if (s.body > 0)
      map << tag << " " << s.body << "\n";
    if (norm(s.v) + norm(s.omega) > 0.0)
      start << "set atom " << tag << " vx " << s.v.x << " vy " << s.v.y << " vz " << s.v.z
            << " omegax " << s.omega.x << " omegay " << s.omega.y << " omegaz " << s.omega.z
            << "\n";
  }
  start << "# velocities and spins\n";
  return {{"atoms.data", data.str()}, {"bodies.map", map.str()}, {"start.in", start.str()}};
}

} // namespace calendem

#endif
