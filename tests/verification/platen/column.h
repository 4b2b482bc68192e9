// SPDX-License-Identifier: GPL-2.0-or-later
// A column of spheres under the platen, and the load that shortens it by a given length.
#ifndef CALENDEM_TESTS_VERIFICATION_PLATEN_COLUMN_H
#define CALENDEM_TESTS_VERIFICATION_PLATEN_COLUMN_H

#include "physics/hertz_contact.h"
#include "spheres.h"
#include <cmath>

namespace calendem::platen_column {

constexpr double E = 2e8, nu = 0.3, R = 0.795, kSide = 5.0, kGap = 1e-4; // kPa, um
constexpr int kSpheres = 5;
const double E_eff = effective_modulus(E, nu, E, nu);

// Spheres on top of each other, `spacing` apart, the lowest just above the collector.
inline std::vector<BodySphere> column(double spacing, bool bonded) {
  std::vector<BodySphere> all;
  for (int n = 0; n < kSpheres; ++n)
    all.push_back({{2.5, 2.5, R + kGap + n * spacing}, R, bonded ? 1 : n + 1});
  return all;
}

inline double top_of(const std::vector<BodySphere> &all) {
  double top = 0.0;
  for (const BodySphere &s : all)
    top = std::fmax(top, s.x.z + s.radius);
  return top;
}

// The spheres in a cell of that side under `wall`: platen or mesh.
inline Files pressed(const std::vector<BodySphere> &all, double side, const Settings &motion,
                     const std::string &wall = "platen") {
  Files files = files_of(all, {0, 0, 0}, {side, side, 12});
  std::ostringstream start;
  for (const auto &m : motion)
    start << "variable " << m.first << " index " << m.second << "\n";
  files["start.in"] += start.str() + "include ${cases}/platen/in." + wall + "\n";
  return files;
}

inline CaseRun press(const std::vector<BodySphere> &all, const Settings &motion, Settings settings,
                     const std::string &more = "") {
  settings.insert({{"bx", "p"}, {"by", "p"}, {"ced", "0"}, {"friction", "0"}, {"skin", "0.15"}});
  Files files = pressed(all, kSide, motion);
  files["start.in"] += more;
  return CaseRun("in.body", settings, 1, files);
}

inline Settings motion(const std::string &control, double aim, double top, double speed,
                       double ramp = 2.0) {
  return {{"motion", control},      {"aim", number(aim)}, {"top", number(top)},
          {"speed", number(speed)}, {"window", "0.25"},   {"dwell", "2"},
          {"ramp", number(ramp)},   {"lost_at", "0.01"}};
}

constexpr double kBondLength = 1.28;
const double kBond = E * kPi * R * R / kBondLength; // k_n, nN/um

// Load of a contact; between bonded spheres the bond bears beside the contact beyond the reference.
inline double pair_load(double d, bool bonded) {
  return hertz_force(E_eff, 0.5 * R, d) + (bonded ? kBond * d : 0.0);
}

inline double pair_shortening(double load, bool bonded) {
  double low = 0.0, high = 0.1;
  while (high - low > 1e-15) {
    const double middle = 0.5 * (low + high);
    (pair_load(middle, bonded) < load ? low : high) = middle;
  }
  return low;
}

// Shortening of the column under a load: two contacts with walls, the others between spheres.
inline double shortening(double load, bool bonded) {
  const double wall = std::pow(0.75 * load / (E_eff * std::sqrt(R)), 2.0 / 3.0);
  return 2.0 * wall + (kSpheres - 1) * pair_shortening(load, bonded);
}

inline double load_of(double wanted, bool bonded) {
  double low = 0.0, high = 1e6;
  while (high - low > 1e-9 * high) {
    const double middle = 0.5 * (low + high);
    (shortening(middle, bonded) < wanted ? low : high) = middle;
  }
  return low;
}

inline double spacing(bool bonded) { return bonded ? kBondLength : 2 * R; }

} // namespace calendem::platen_column

#endif
