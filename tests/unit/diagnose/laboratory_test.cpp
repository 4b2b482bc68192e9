// SPDX-License-Identifier: GPL-2.0-or-later
// A laboratory's file, made from runs of the shipped bank: four specimens for each pressure, each a
// little thicker and more porous than the next, readings with errors, one porosity and one row of a
// curve that are wrong, and releases that were recorded down to half of the maximum only. One such
// file for each kind of answer, and a change of the press between two.
#include "base/random.h"
#include "diagnose/diagnose.h"
#include "reported.h"
#include "support/test_folder.h"
#include "support/with_all.h"
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using calendem_test::reported;

constexpr int kSpecimens = 4;
// All specimens are copies of one run, of one packing: together they are as good as one cell.
constexpr double kCellsOfSpecimens = 1.0 / kSpecimens;
constexpr double kThickness = 0.005, kPorosity = 0.3; // of a specimen: share, points
constexpr double kDisplacementSd = 0.1, kThicknessSd = 0.2, kPorositySd = 0.4, kCrackedSd = 0.04;

const BankTable &bank() {
  static const BankTable table = [] {
    const std::string folder = std::string(CALENDEM_SOURCE_DIR) + "/input_scripts/cases/bank/";
    return read_bank_table(read_bank_spec(folder + "bank.toml"), folder + "bank.csv");
  }();
  return table;
}

/// The base model's run of the parameters nearest the middle.
SimulatedRun run_to(double pressure) {
  const BankRow *best = nullptr;
  double least = INFINITY;
  for (const BankRow &row : bank().rows) {
    if (!row.point.effect.empty() || !row.run.pressing.empty() || row.run.target != pressure)
      continue;
    double off = 0.0;
    for (std::size_t p = 0; p < row.point.base.size(); ++p) {
      const BankParameter &range = bank().spec.parameters[p];
      const bool log = range.spread == Spread::LogUniform;
      const auto of = [log](double v) { return log ? std::log(v) : v; };
      off += std::pow((of(row.point.base[p]) - 0.5 * (of(range.low) + of(range.high))) /
                          (of(range.high) - of(range.low)),
                      2);
    }
    if (off < least) {
      least = off;
      best = &row;
    }
  }
  return best->run;
}

/// Emptied once: a test may have several laboratories.
std::filesystem::path folder_of_test() {
  static std::string test;
  static std::filesystem::path folder;
  const std::string now = testing::UnitTest::GetInstance()->current_test_info()->name();
  if (test != now)
    folder = calendem_test::test_folder();
  test = now;
  return folder;
}

using Change = std::function<void(SimulatedRun &)>;

class Laboratory {
public:
  explicit Laboratory(const std::string &name, bool curves = true)
      : folder_(folder_of_test() / name), curves_(curves),
        random_(std::hash<std::string>{}(name), 7) {
    std::filesystem::create_directories(folder_);
  }

  Experiment experiment(const Change &change) {
    std::string text = fmt::format("[experiment]\nname = \"laboratory\"\nelectrode = \"{}\"\n"
                                   "sample_diameter_mm = 11\n",
                                   bank().spec.recipe_file);
    for (const double pressure : {80.0, 150.0})
      for (int k = 0; k < kSpecimens; ++k) {
        SimulatedRun run = run_to(pressure);
        change(run);
        text += specimen(run, fmt::format("p{:g}{}", pressure, "abcd"[k]), k == 2);
      }
    std::ofstream(folder_ / "experiment.toml") << text;
    return read_experiment((folder_ / "experiment.toml").string());
  }

private:
  std::filesystem::path folder_;
  bool curves_;
  Random random_;

  double noisy(double value, double sd) { return value + sd * random_.normal(); }

  std::string specimen(const SimulatedRun &r, const std::string &id, bool wrong) {
    const double thicker = 1.0 + kThickness * random_.normal();
    const double porosity = kPorosity * random_.normal(); // points
    const auto thickness = [&](double h, double p) {
      return noisy(thicker * h * (1.0 + 0.01 * porosity / (1.0 - p)), kThicknessSd);
    };
    std::string text = fmt::format(
        "\n[[condition]]\nid = \"{}\"\ncontrol = \"pressure\"\n"
        "max_pressure_MPa = {{ value = {:g}, sd_relative = 0.02 }}\n"
        "porosity_after_percent = {{ value = {:.3f}, sd = {:g} }}\n",
        id, r.target, noisy(100.0 * r.porosity_after + porosity, kPorositySd) + (wrong ? 8.0 : 0.0),
        kPorositySd);
    if (!curves_)
      return text;
    text += fmt::format("thickness_at_max_um = {{ value = {:.3f}, sd = {:g} }}\n"
                        "cracked_bodies_fraction = {{ value = {:.3f}, sd = {:g} }}\n"
                        "curve = \"{}.csv\"\ncurve_sd_um = {:g}\n",
                        thickness(r.thickness_at_max, r.porosity_at_max), kThicknessSd,
                        std::clamp(noisy(r.cracked_fraction, kCrackedSd), 0.0, 1.0), kCrackedSd, id,
                        kDisplacementSd);
    write_curve(r, id, thicker, wrong);
    return text;
  }

  /// Up to the maximum, and down to half of it.
  void write_curve(const SimulatedRun &r, const std::string &id, double thicker, bool wrong) {
    std::ofstream out(folder_ / (id + ".csv"));
    out << "displacement_um,pressure_MPa,stage\n";
    for (std::size_t k = 0; k < r.pressure.size(); ++k)
      if (r.pressure[k] <= r.target)
        out << fmt::format("{:.4f},{:g},loading\n",
                           noisy(thicker * r.displacement[k], kDisplacementSd) +
                               (wrong && k == 40 ? 6.0 : 0.0),
                           r.pressure[k]);
    out << fmt::format("{:.4f},{:g},unloading\n", thicker * r.displacement.back(), r.target);
    for (std::size_t k = r.release_pressure.size(); k-- > 0;)
      if (r.release_pressure[k] > 0.5 * r.target)
        out << fmt::format("{:.4f},{:g},unloading\n",
                           noisy(thicker * r.release_displacement[k], kDisplacementSd),
                           r.release_pressure[k]);
  }
};

Diagnosed diagnosis_of(const Experiment &e) {
  SharedModels models;
  return diagnosed(e, bank(), kCellsOfSpecimens, models);
}

std::string summary(const Diagnosed &d) {
  return d.gap["which"]["headline"].dump() + d.gap["which"]["probability"].dump() +
         d.gap["which"]["why"].dump();
}

void shift_zero(SimulatedRun &r) { r = shown_with(find_effect("thickness_zero"), 4.0, r); }

TEST(Laboratory, TheBaseModelShowsNothing) {
  const Diagnosed d = diagnosis_of(Laboratory("nothing").experiment([](SimulatedRun &) {}));
  EXPECT_EQ(d.gap["which"]["answer"], "nothing to see") << summary(d);
  EXPECT_TRUE(reported(d.data, "p80c: total porosity"));
  EXPECT_TRUE(reported(d.data, "rows of its curve jump away"));
  EXPECT_TRUE(reported(d.data, "4 specimens pressed alike"));
}

TEST(Laboratory, AThicknessZeroIsTheExplanation) {
  const Diagnosed d = diagnosis_of(Laboratory("zero").experiment(shift_zero));
  EXPECT_EQ(d.gap["which"]["answer"], "explained") << summary(d);
  EXPECT_EQ(d.gap["which"]["claim"], "thickness_zero") << summary(d);
}

// Thinner under pressure and more porous after it than any parameter or effect makes it.
TEST(Laboratory, WhatNoModelHasIsSomethingElse) {
  CALENDEM_RUNS_WITH_ALL();
  const Diagnosed d = diagnosis_of(Laboratory("else").experiment([](SimulatedRun &r) {
    r.thickness_at_max *= 0.85;
    r.porosity_after += 0.10;
    r.cracked_fraction = 0.02;
  }));
  EXPECT_EQ(d.gap["which"]["answer"], "something else") << summary(d);
}

// Two porosities, both too low, and nothing else.
TEST(Laboratory, PorositiesAloneLeaveOneOfThese) {
  const Diagnosed d = diagnosis_of(Laboratory("porosities", false).experiment([](SimulatedRun &r) {
    r.porosity_after -= 0.08;
  }));
  EXPECT_EQ(d.gap["which"]["answer"], "one of these") << summary(d);
  EXPECT_FALSE(d.gap["which"]["groups"].empty()) << summary(d);
}

// One disc for each pressure, the second 2 % thicker and pressed as much further: two pieces.
TEST(Laboratory, TwoDiscsThatDifferAreNotSomethingElse) {
  CALENDEM_RUNS_WITH_ALL();
  Experiment e = Laboratory("two").experiment([](SimulatedRun &r) {
    if (r.target < 100.0)
      return;
    r.thickness_at_max *= 1.02;
    for (double &d : r.displacement)
      d *= 1.02;
    for (double &d : r.release_displacement)
      d *= 1.02;
  });
  e.conditions = {e.conditions[0], e.conditions[kSpecimens]};
  const Diagnosed two = diagnosis_of(e);
  EXPECT_NE(two.gap["which"]["answer"], "something else") << summary(two);
  EXPECT_LT(two.gap["which"]["probability"]["unknown"], 0.5) << summary(two);
}

// One press, before and after its dial was set anew.
TEST(Laboratory, AChangeOfTheDialIsWhatChanged) {
  const Experiment before = Laboratory("before").experiment([](SimulatedRun &) {}),
                   after = Laboratory("after").experiment(shift_zero);
  const Diagnosed d = diagnosed_change(before, after, bank(), kCellsOfSpecimens);
  EXPECT_EQ(d.gap["which"]["claim"], "thickness_zero") << summary(d);
  EXPECT_EQ(d.gap["which"]["headline"], "What changed. Explained by thickness_zero");
  if (!calendem_test::with_all(1, 0))
    return;
  const Experiment again = Laboratory("again").experiment([](SimulatedRun &) {});
  const Diagnosed nothing = diagnosed_change(before, again, bank(), kCellsOfSpecimens);
  EXPECT_EQ(nothing.gap["which"]["answer"], "nothing to see") << summary(nothing);
  EXPECT_NE(nothing.gap["which"]["meaning"].get<std::string>().find("Before and after agree"),
            std::string::npos);
}

// A point that runs of the full cell lack spoils no error of the others.
TEST(Laboratory, ErrorsAreNumbersWhereACurveIsLowerThanTheBanks) {
  Experiment e = Laboratory("low").experiment([](SimulatedRun &) {});
  e.conditions.resize(1);
  std::ofstream(e.conditions[0].curve) << "displacement_um,pressure_MPa\n0,0\n0.1,0.1\n0.2,0.2\n";
  const ExperimentData data = data_of(e, bank(), {});
  ASSERT_FALSE(data.terms.empty());
  for (const ErrorTerm &t : data.terms)
    EXPECT_TRUE(t.columns.allFinite()) << t.name;
}

} // namespace
