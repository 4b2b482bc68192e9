// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "base/provenance.h"
#include "simulate/collect.h"
#include "simulate/run.h"
#include "support/test_folder.h"
#include <gtest/gtest.h>

namespace {

using namespace calendem;

/// A case that only differs from the defaults in its platen.
Settings platen_case(const std::string &platen) {
  const std::string file = (calendem_test::test_folder() / "case.toml").string();
  write_file(file, "electrode = \"none\"\n[platen]\n" + platen);
  return read_case(file);
}

/// Compression: 12 rows, 0.1 us apart, the platen at 2 m/s from 0.2 um, the film 30 um; the
/// pressure grows by a factor of e in 0.5 us.
std::vector<RawRow> compressed() {
  std::vector<RawRow> rows(12);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    RawRow &r = rows[k];
    r.stage = 1.0;
    r.time = 0.1 * double(k + 1);
    r.displacement = 2.0 * r.time;
    r.gap = 30.0 - r.displacement;
    r.p_top = 3.0 * std::exp(2.0 * r.time);
  }
  return rows;
}

TEST(TimeToTarget, PressureGrowsAsItDid) {
  const Settings s = platen_case("control = \"pressure\"\nmax_pressure_MPa = 90\n");
  std::vector<RawRow> rows = compressed();
  // 3 exp(2 t) = 90 at t = ln(30) / 2, 1.2 us of which are over.
  EXPECT_NEAR(time_to_target(s, rows), 0.5 * std::log(30.0) - 1.2, 1e-12);
  EXPECT_NEAR(target_share(s, rows.back()), std::exp(2.4) / 30.0, 1e-12);
  rows.back().p_top = 95.0; // beyond it
  EXPECT_EQ(time_to_target(s, rows), 0.0);
  rows.back().p_top = 1.0; // it falls
  EXPECT_TRUE(std::isnan(time_to_target(s, rows)));
  for (RawRow &r : rows)
    r.p_top = 0.0; // not touched yet
  EXPECT_TRUE(std::isnan(time_to_target(s, rows)));
}

TEST(TimeToTarget, DisplacementAndThicknessAtThePlatensSpeed) {
  const std::vector<RawRow> rows = compressed(); // 2.4 um down
  EXPECT_NEAR(
      time_to_target(platen_case("control = \"displacement\"\ndisplacement_um = 6\nspeed_m_s "
                                 "= 2\n"),
                     rows),
      1.8, 1e-12);
  EXPECT_NEAR(time_to_target(
                  platen_case("control = \"thickness\"\nthickness_um = 24\nspeed_m_s = 2\n"), rows),
              1.8, 1e-12);
}

TEST(TimeToTarget, OnlyWhileThePlatenGoesDown) {
  const Settings s = platen_case("control = \"pressure\"\nmax_pressure_MPa = 90\n");
  std::vector<RawRow> rows = compressed();
  rows.back().stage = 3.0;
  EXPECT_TRUE(std::isnan(time_to_target(s, rows)));
  EXPECT_EQ(target_share(s, rows.back()), 1.0);
  rows.back().stage = 0.0;
  EXPECT_TRUE(std::isnan(time_to_target(s, rows)));
}

} // namespace
