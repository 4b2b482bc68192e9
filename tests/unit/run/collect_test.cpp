// SPDX-License-Identifier: GPL-2.0-or-later
// What is read off the curve after the release, and over what its rows are averaged.
#include "base/case.h"
#include "base/provenance.h"
#include "physics/moving_average.h"
#include "simulate/collect.h"
#include "support/test_folder.h"
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {

using namespace calendem;

RawRow row(double stage, double gap, double pressure) {
  RawRow r = {};
  r.stage = stage;
  r.gap = gap;
  r.p_top = pressure;
  return r;
}

// Requirement: the threshold is crossed between two rows, and so is the gap.
TEST(GapAtLoss, BetweenRows) {
  const std::vector<RawRow> rows = {row(1, 20.4, 1.0), row(1, 20.0, 100.0), row(3, 20.6, 6.0),
                                    row(3, 21.0, 4.0), row(4, 21.5, 0.0)};
  EXPECT_DOUBLE_EQ(*gap_at_loss(rows, 0.05, 100.0), 20.8);
  EXPECT_DOUBLE_EQ(*gap_at_loss(rows, 0.01, 100.0), 21.375);
  EXPECT_DOUBLE_EQ(*gap_at_loss(rows, 0.5, 100.0), 20.0 + 0.6 * 50.0 / 94.0);
  EXPECT_FALSE(gap_at_loss({rows.begin(), rows.end() - 2}, 0.05, 100.0).has_value());
}

// Requirement: of several passes under a roll the last one counts.
TEST(GapAtLoss, OfTheLastPass) {
  const std::vector<RawRow> rows = {row(1, 20.0, 100.0), row(3, 21.0, 4.0), row(1, 20.5, 5.0),
                                    row(2, 19.0, 90.0),  row(3, 19.5, 6.0), row(4, 20.0, 4.0)};
  EXPECT_DOUBLE_EQ(*gap_at_loss(rows, 0.05, 100.0), 19.75);
}

// Requirement: of presses to one target the last counts, whatever the overshoot; of passes that carry
// less and less the one that carries most.
TEST(TopOf, TheLastTimeThatAFilmGetsAsFar) {
  const auto pressed = [](double first, double second) {
    return std::vector<RawRow>{row(1, 20.0, 50.0), row(2, 19.0, first), row(3, 20.5, 0.5),
                               row(1, 19.5, 40.0), row(1, 18.2, 70.0),  row(2, 18.0, second),
                               row(3, 18.1, 60.0), row(4, 20.0, 0.1)};
  };
  EXPECT_EQ(top_of(pressed(100.0, 99.9)).gap, 18.0);
  EXPECT_EQ(top_of(pressed(100.0, 100.1)).gap, 18.0);
  EXPECT_EQ(top_of(pressed(100.0, 90.0)).gap, 19.0);
  EXPECT_EQ(top_of({row(1, 20.0, 10.0), row(3, 21.0, 1.0)}).gap, 20.0);
}

// The rows that a film of that pressure gives on release, averaged over `window`, 0.1 um apart.
template <class Film>
std::vector<RawRow> released(Film film, double from, double speed, double window) {
  constexpr double dt = 1e-5; // us
  MovingAverage pressure, gap;
  pressure.set_window(window / dt);
  gap.set_window(window / dt);
  std::vector<RawRow> rows = {row(2, from, film(from))};
  const long apart = std::lround(kAverageTravel / speed / dt);
  for (long n = 0; n * dt * speed < 4.0; ++n) {
    const double h = from + n * dt * speed;
    pressure.add(film(h));
    gap.add(h);
    if (n % apart == 0)
      rows.push_back(row(3, gap.value(), pressure.value()));
  }
  return rows;
}

// Requirement: a film that pays no heed to speed has one thickness after the release, whatever the
// speed and the window within the bound. P falls to 1 % over some tenths of a micrometre; what is
// left is the curve's bend over window and rows, L/24 (s/L)^2 + L/8 (r/L)^2 for P = exp(-h/L).
TEST(GapAtLoss, IsTheFilmsNotTheReleases) {
  constexpr double L = 0.4, top = 20.0;
  const auto film = [](double h) { return 150.0 * std::exp((top - h) / L); };
  const double expected = top + L * std::log(100.0);
  for (const double speed : {1.0, 4.0, 8.0})
    for (const double travel : {0.01, 0.05, kAverageTravel}) {
      const auto gap = gap_at_loss(released(film, top, speed, travel / speed), 0.01, 150.0);
      ASSERT_TRUE(gap.has_value());
      EXPECT_NEAR(*gap, expected,
                  travel * travel / (24.0 * L) + kAverageTravel * kAverageTravel / (8.0 * L) + 1e-4)
          << speed << " m/s, " << travel << " um";
    }
}

Settings case_with(const std::string &tables) {
  const std::string file = (calendem_test::test_folder() / "case.toml").string();
  write_file(file, "electrode = \"none\"\n" + tables);
  return read_case(file);
}

// Requirement: unless it is given, the window is 0.1 um at the highest of the three speeds; more
// than that is refused.
TEST(AveragingWindow, IsBoundByTheFastestSpeed) {
  EXPECT_DOUBLE_EQ(averaging_window(case_with("")), 0.1);
  EXPECT_DOUBLE_EQ(averaging_window(case_with("[platen]\nrelease_speed_m_s = 8\n")), 0.0125);
  EXPECT_DOUBLE_EQ(averaging_window(case_with("[platen]\ntouch_speed_m_s = 4\n")), 0.025);
  const std::string fast = "[platen]\nrelease_speed_m_s = 8\nspeed_m_s = 4\n";
  EXPECT_DOUBLE_EQ(averaging_window(case_with(fast + "[numerics]\naverage_us = 0.0125\n")), 0.0125);
  try {
    case_with(fast + "[numerics]\naverage_us = 0.1\n");
    FAIL() << "0.8 um of travel were accepted";
  } catch (const Failure &f) {
    for (const char *said : {"numerics.average_us is 0.1", "moves 0.8 um",
                             "platen.release_speed_m_s = 8", "at most 0.0125 us"})
      EXPECT_NE(std::string(f.what()).find(said), std::string::npos) << f.what();
  }
}

/// Two presses, to 50 and 100 MPa, of which curve.csv holds the first rows.
nlohmann::json two_presses(const UnionVolume &filled, std::size_t held = 6) {
  const Settings settings = case_with("");
  const auto folder = calendem_test::test_folder();
  std::vector<RawRow> rows = {row(1, 20.0, 0.0), row(1, 18.0, 50.0),  row(3, 18.5, 0.2),
                              row(1, 18.4, 9.0), row(1, 16.0, 100.0), row(3, 16.8, 0.5)};
  std::string curve = "time_us,stage,pressure_MPa\n";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].time = double(k);
    if (k < held)
      curve += fmt::format("{},{},{}\n", k, rows[k].stage > 2.5 ? "relaxation" : "compression",
                           rows[k].p_top);
  }
  write_file((folder / "curve.csv").string(), curve);
  ElectrodeFacts e = {};
  e.solid = 10.0;
  e.lx = e.ly = e.area = 1.0;
  e.nanoporosity = 0.5;
  return presses_of(folder.string(), rows, filled, e, settings);
}

// Requirement: each press has its pressure and what it left; what no frame or table tells is null.
TEST(Presses, HaveWhatEachLeft) {
  const nlohmann::json p = two_presses({});
  ASSERT_EQ(p.size(), 2u);
  EXPECT_EQ(p[0]["pressure_MPa"], 50.0);
  EXPECT_EQ(p[1]["pressure_MPa"], 100.0);
  EXPECT_NEAR(p[1]["porosity_loaded"], 1.0 - 10.0 / 16.0, 1e-12);
  // from 100 MPa at 16 um to 0.5 at 16.8: contact is lost at 1 MPa, after a share 99 / 99.5
  EXPECT_NEAR(p[1]["thickness_released_um"], 16.0 + 0.8 * 99.0 / 99.5, 1e-12);
  EXPECT_TRUE(p[0]["cbd_nanoporosity"].is_null());
  EXPECT_TRUE(p[0]["cracked_fraction"].is_null());
  UnionVolume frames;
  frames.time = {0.0, 2.05, 4.0};
  frames.cbd_spheres = {4.0, 3.2, 3.0};
  const nlohmann::json seen = two_presses(frames);
  EXPECT_NEAR(seen[0]["cbd_nanoporosity"], 1.0 - 0.5 * 4.0 / 3.2, 1e-12);
  EXPECT_TRUE(seen[1]["cbd_nanoporosity"].is_null()); // no frame within 0.1 us of the end
}

// Requirement: a curve without rows is no reason to lose the rest of a summary.
TEST(Presses, OfNoCurveThereAreNone) { EXPECT_TRUE(two_presses({}, 0).empty()); }

// Requirement: what people want of a run stands first; nothing is lost.
TEST(Summary, BeginsWithTheNumbersThatAreAskedForMost) {
  const std::string folder = calendem_test::test_folder().string();
  const nlohmann::json summary = {{"atom_steps_per_second", 5},
                                  {"bodies", 3},
                                  {"springback", 0.1},
                                  {"max_pressure_MPa", 150.0},
                                  {"zeta", {1, 2}}};
  write_summary(folder, summary);
  const std::string text = text_of_file(folder + "/summary.json");
  EXPECT_EQ(nlohmann::json::parse(text), summary);
  const nlohmann::ordered_json written = nlohmann::ordered_json::parse(text);
  std::vector<std::string> keys;
  for (const auto &item : written.items())
    keys.push_back(item.key());
  EXPECT_EQ(keys, (std::vector<std::string>{"max_pressure_MPa", "springback", "bodies",
                                            "atom_steps_per_second", "zeta"}));
}

} // namespace
