// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

// Energy at the end over energy at the start; infinite when the run stopped on a torn bond.
double growth(double of_bound, double damping) {
  std::vector<BodySphere> all = cube(3, 1.28, {-1.28, -1.28, -1.28}, 1);
  all[0].v = {1e-3, -2e-3, 3e-3}; // small: the body stays linear
  all[0].omega = {2e-3, 1e-3, -1e-3};
  const CaseRun run("in.body",
                    {{"Ey", "1e3"},
                     {"friction", "0"},
                     {"restitution", "1"},
                     {"ced", "0"},
                     {"of_bound", number(of_bound)},
                     {"damping", number(damping)},
                     {"steps", "5000"},
                     {"every", "50"}},
                    1, files_of(all, {-20, -20, -20}, {20, 20, 20}));
  if (!run.finished()) {
    EXPECT_NE(run.why().find("an intact bond is stretched"), std::string::npos) << run.why();
    return HUGE_VAL;
  }
  const std::vector<Row> rows = run.rows("curve.csv");
  const auto energy = [](const Row &r) {
    return r.at("kinetic") + r.at("rotational") + r.at("strain");
  };
  const double ratio = rows.size() < 2 ? HUGE_VAL : energy(rows.back()) / energy(rows.front());
  std::printf("damping %g, %.2f of the bound (%.4g us): energy x %.3g\n", damping, of_bound,
              rows.empty() ? 0.0 : rows[0].at("bound"), ratio);
  return std::isfinite(ratio) ? ratio : HUGE_VAL;
}

} // namespace

TEST(VerificationTimestep, StableAtTheBound) {
  EXPECT_LT(growth(1.0, 0.0), 2.0);
  EXPECT_LT(growth(1.0, 0.1), 1.0);
}

TEST(VerificationTimestep, UnstableNotFarAboveIt) {
  EXPECT_GT(growth(1.4, 0.0), 1e6);
  EXPECT_GT(growth(1.5, 0.1), 1e6);
}
