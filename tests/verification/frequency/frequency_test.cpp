// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, G = E / 2.6, R = 0.795, l = 1.28;
const double A = kPi * R * R, I = kPi * R * R * R * R / 4.0, J = 2.0 * I;
const double m = kDensity * 4.0 / 3.0 * kPi * R * R * R, I_s = 0.4 * m * R * R;

struct Mode {
  const char *name;
  double omega;           // closed form, rad/us
  Vec3 v, spin_1, spin_2; // sphere 2 moves at v, sphere 1 at -v
  const char *column;     // of sphere 2
};

// Largest departure of the mode's velocity from cos(omega' t), omega' = 2/dt asin(omega dt/2).
double departure(const Mode &mode) {
  const double speed = 1e-3, dt = 0.05 / mode.omega;
  const std::vector<BodySphere> pair = {{{0, 0, 0}, R, 1, -speed * mode.v, speed * mode.spin_1},
                                        {{l, 0, 0}, R, 1, speed * mode.v, speed * mode.spin_2}};
  const CaseRun run("in.body",
                    {{"Ey", "1e3"},
                     {"restitution", "1"},
                     {"friction", "0"},
                     {"ced", "0"},
                     {"dt", number(dt)},
                     {"steps", "2000"},
                     {"every", "1"}},
                    1, files_of(pair, {-20, -20, -20}, {20, 20, 20}));
  const auto frames = run.frames();
  EXPECT_EQ(frames.size(), 2001u) << run.why();
  const double verlet = 2.0 / dt * std::asin(0.5 * mode.omega * dt);
  double worst = 0.0;
  for (size_t n = 0; n < frames.size(); ++n) {
    const double expected = frames[0][1].at(mode.column) * std::cos(verlet * n * dt);
    worst = std::fmax(worst, std::fabs(frames[n][1].at(mode.column) - expected));
  }
  return worst / std::fabs(frames.empty() ? 1.0 : frames[0][1].at(mode.column));
}

} // namespace

TEST(VerificationFrequency, FourModesOfAPair) {
  const double k_t = G * A / l, inverse = 2.0 / m + l * l / (2.0 * I_s);
  // shear: equal spins with the deflection's reaction, so that the pair does not turn as a whole
  const double spin = (l / (2.0 * I_s)) / (1.0 / m);
  const Mode modes[] = {
      {"axial", std::sqrt(2.0 * E * A / (l * m)), {1, 0, 0}, {}, {}, "vx"},
      {"torsion", std::sqrt(2.0 * G * J / (l * I_s)), {}, {-1, 0, 0}, {1, 0, 0}, "omegax"},
      {"bending", std::sqrt(2.0 * E * I / (l * I_s)), {}, {0, 0, -1}, {0, 0, 1}, "omegaz"},
      {"shear", std::sqrt(k_t * inverse), {0, 1, 0}, {0, 0, -spin}, {0, 0, -spin}, "vy"}};
  for (const Mode &mode : modes) {
    const double e = departure(mode);
    std::printf("%s: %.6g rad/us, 16 periods depart by %.1e\n", mode.name, mode.omega, e);
    EXPECT_LT(e, 1e-6);
  }
}
