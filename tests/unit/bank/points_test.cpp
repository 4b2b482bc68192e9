// SPDX-License-Identifier: GPL-2.0-or-later
// A bank of points: its file, the design, the table of its runs, and what the emulator learns of them.
#include "bank/training.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "support/test_folder.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {
using namespace calendem;

const std::string kShipped = CALENDEM_SOURCE_DIR "/input_scripts/cases/films/bank.toml";

const bank::Bank &shipped() {
  static const bank::Bank bank = bank::read_bank(kShipped);
  return bank;
}

int place_of(const std::string &name) {
  const auto &inputs = shipped().design.inputs;
  return int(std::find_if(inputs.begin(), inputs.end(),
                          [&](const bank::Input &i) { return i.name == name; }) -
             inputs.begin());
}

// An effect acts in its share of 600 points, less where another one excludes it; four standard deviations.
TEST(Points, FillTheSpaceAndEffectsActInTheirShare) {
  const bank::Design &design = shipped().design;
  const auto points = bank::points_of(design);
  const double n = double(points.size());
  for (std::size_t d = 0; d < design.inputs.size(); ++d) {
    const bank::Input &input = design.inputs[d];
    double acts = 0.0, low = 0.0;
    for (const bank::Point &p : points)
      if (!std::isnan(p.values[d])) {
        EXPECT_TRUE(p.values[d] >= input.low && p.values[d] <= input.high) << input.name;
        acts += 1.0;
        low += p.values[d] < (input.spread == Spread::LogUniform ? std::sqrt(input.low * input.high)
                                                                 : 0.5 * (input.low + input.high));
      }
    double share = input.share;
    for (std::size_t later = d + 1; later < design.inputs.size(); ++later)
      if (const auto &names = design.inputs[later].excludes;
          std::find(names.begin(), names.end(), input.name) != names.end())
        share *= 1.0 - design.inputs[later].share;
    EXPECT_NEAR(acts, n * share, 4.0 * std::sqrt(n * share * (1.0 - share)) + 1e-9) << input.name;
    EXPECT_NEAR(low, 0.5 * acts, 4.0 * std::sqrt(0.25 * acts)) << input.name;
  }
}

TEST(Points, MoreGoOnWhereFewerEnded) {
  bank::Design fewer = shipped().design;
  fewer.points = 40;
  const auto few = bank::points_of(fewer), all = bank::points_of(shipped().design);
  for (std::size_t k = 0; k < few.size(); ++k) {
    EXPECT_EQ(few[k].packing, all[k].packing);
    EXPECT_EQ(few[k].larger, all[k].larger);
    for (std::size_t d = 0; d < few[k].values.size(); ++d)
      EXPECT_TRUE(few[k].values[d] == all[k].values[d] ||
                  (std::isnan(few[k].values[d]) && std::isnan(all[k].values[d])));
  }
}

// A contact follows one law, and a bridge holds no CBD that shrinks: what run would refuse is no point.
TEST(Points, EffectsThatExcludeEachOtherNeverActTogether) {
  EXPECT_EQ(shipped().design.inputs[std::size_t(place_of("cbd_confinement"))].excludes,
            (std::vector<std::string>{"cbd_plasticity", "cbd_viscoelasticity"}));
  for (const auto &[one, other] : {std::pair("cbd_plasticity", "cbd_viscoelasticity"),
                                   {"nmc_plasticity", "nmc_confinement"},
                                   {"cbd_collapse", "binder_bridges"}})
    for (const bank::Point &p : bank::points_of(shipped().design))
      EXPECT_TRUE(std::isnan(p.values[std::size_t(place_of(one))]) ||
                  std::isnan(p.values[std::size_t(place_of(other))]))
          << one;
  EXPECT_EQ(bank::study_of(shipped(), bank::points_of(shipped().design)).runs.size(), 600u);
}

std::string said_of(const std::string &change, const std::string &to) {
  std::string text = text_of_file(kShipped);
  const auto at = text.find(change);
  EXPECT_NE(at, std::string::npos) << change;
  text.replace(at, change.size(), to);
  const std::string file = (calendem_test::test_folder() / "bank.toml").string();
  write_file(file, text);
  try {
    bank::read_bank(file);
  } catch (const Failure &f) {
    return f.what();
  }
  return "";
}

TEST(BankFile, MistakesAreNamed) {
  for (const auto &[change, to, said] :
       {std::tuple("points = 600", "points = 600\nbase = 3", "unknown key 'base'"),
        {"low = 40", "low = 60", "low must be below high"},
        {"share = 0.8", "share = 1.5", "share is 1.5"},
        {"name = \"friction\"", "name = \"fricton\"", "friction"},
        {"\"thickness_zero\"", "\"friction\"", "Give it a table [[effect]]"},
        {"[[numerics]]", "[[numeric]]", "unknown 'numeric'"},
        {"name = \"E_am_GPa\"", "name = \"E_cbd_GPa\"", "two inputs are called 'E_cbd_GPa'"}})
    EXPECT_NE(said_of(change, to).find(said), std::string::npos) << said_of(change, to);
}

/// Two runs of the shipped design: one of all presses, one that was not packed.
bank::Runs two_runs() {
  bank::Runs runs;
  runs.bank = shipped();
  const auto points = bank::points_of(runs.bank.design);
  bank::Run run;
  run.point = points[3];
  run.porosity_before = 0.5;
  run.thickness_before = 25.0;
  run.loading.assign(bank::curve_pressures().size(), NAN);
  for (std::size_t k = 0; k < 40; ++k)
    run.loading[k] = 0.125 * double(k);
  for (const double pressure : bank::pressures_of(runs.bank)) {
    bank::PressedFilm film;
    film.pressure = pressure;
    film.thickness_at_max = 20.0;
    film.porosity_at_max = 0.25;
    film.porosity_after = 0.28;
    film.cracked = 0.5;
    for (const double share : bank::kReleasedTo)
      film.release.push_back(5.0 - share);
    run.presses.push_back(film);
  }
  runs.runs = {run, {points[7], "not packed"}};
  return runs;
}

TEST(RunsTable, ReadsBackWhatWasWritten) {
  const std::string file = (calendem_test::test_folder() / "bank.csv").string();
  write_file(file, bank::write_runs(two_runs()));
  const bank::Runs runs = bank::read_runs(shipped(), file);
  ASSERT_EQ(runs.runs.size(), 2u);
  EXPECT_EQ(runs.runs[1].failed, "not packed");
  EXPECT_TRUE(runs.runs[1].presses.empty());
  ASSERT_EQ(runs.runs[0].presses.size(), 6u);
  EXPECT_EQ(runs.runs[0].presses[2].porosity_after, 0.28);
  EXPECT_TRUE(std::isnan(runs.runs[0].presses[2].cbd_nanoporosity));
  EXPECT_EQ(runs.runs[0].presses[2].release.back(), 5.0 - bank::kReleasedTo.back());
  EXPECT_EQ(runs.runs[0].loading[39], 4.875);
  EXPECT_TRUE(std::isnan(runs.runs[0].loading[40]));
  EXPECT_EQ(bank::write_runs(runs), bank::write_runs(two_runs()));
}

TEST(RunsTable, IsThatOfItsBank) {
  const std::string file = (calendem_test::test_folder() / "bank.csv").string(),
                    text = bank::write_runs(two_runs());
  const auto refused = [&](const std::string &with) {
    write_file(file, with);
    try {
      bank::read_runs(shipped(), file);
    } catch (const Failure &f) {
      return std::string(f.what());
    }
    return std::string();
  };
  std::string other = text;
  other.replace(other.find("\n4,"), 3, "\n5,");
  EXPECT_NE(refused(other).find("point 5 has other inputs"), std::string::npos);
  other = text;
  other.replace(other.find("friction"), 8, "rubbing");
  EXPECT_NE(refused(other).find("column 'friction' is missing"), std::string::npos);
  other = text + "8,8\n";
  EXPECT_NE(refused(other).find("another number of cells"), std::string::npos);
}

// Strengths are 1 at the strong end of a prior and 0 where an effect is off; a press that missed its pressure by more than
// 5 % teaches nothing.
TEST(Training, EffectsAreStrengthsAndPressesTheirPressures) {
  bank::Runs runs = two_runs();
  const bank::Space space(runs.bank);
  runs.runs.pop_back();
  const auto points = bank::points_of(runs.bank.design);
  for (int k = 10; k < 20; ++k) {
    runs.runs.push_back(runs.runs[0]);
    runs.runs.back().point = points[std::size_t(k)];
  }
  runs.runs[1].presses.back().pressure = 250.0;
  const inference::TrainingRuns t = bank::training_of(runs);
  ASSERT_EQ(t.values.rows(), bank::count_of_outputs(6));
  const auto output = [](std::size_t k) {
    return bank::output_of(FilmNumber::PorosityAfter, k, 6);
  };
  EXPECT_EQ(t.values(output(5), 0), 0.28);
  EXPECT_TRUE(std::isnan(t.values(output(5), 1)));
  EXPECT_EQ(t.values(output(4), 1), 0.28);
  for (Eigen::Index r = 0; r < t.values.cols(); ++r) {
    const bank::Point &point = runs.runs[std::size_t(r)].point;
    for (std::size_t e = 0; e < space.effects.size(); ++e) {
      const double strength = t.at.amplitudes(Eigen::Index(e), r);
      if (std::isnan(point.values[std::size_t(space.effects[e])]))
        EXPECT_EQ(strength, 0.0);
      else
        EXPECT_TRUE(strength > 0.0 && strength <= 1.0 + 1e-9) << space.amplitudes[e].name;
    }
    EXPECT_EQ(t.at.amplitudes(t.at.amplitudes.rows() - 1, r), double(point.larger));
    EXPECT_EQ(t.packing[std::size_t(r)] % 2, int(point.larger));
    EXPECT_LE(t.at.inputs.col(r).cwiseAbs().maxCoeff(), 1.0 + 1e-9);
  }
}

TEST(Training, PressuresAreThoseOfTheCase) {
  const std::vector<double> p = bank::pressures_of(shipped());
  ASSERT_EQ(p.size(), 6u);
  EXPECT_NEAR(p[0], 10.0, 1e-9);
  EXPECT_NEAR(p[3] / p[2], std::pow(30.0, 0.2), 1e-9);
  EXPECT_NEAR(p[5], 300.0, 1e-9);
  bank::Bank once = shipped();
  once.case_file = (calendem_test::test_folder() / "case.toml").string();
  write_file(once.case_file, "electrode = \"any\"\n");
  EXPECT_THROW(bank::pressures_of(once), Failure);
}

// Packings that are left out of the table that ships lie within the emulator's intervals as often as these say: half and
// nine in ten of some 250 porosities of about 24 packings, which leaves a standard deviation of 5 and 3 points between
// packings; three are allowed.
TEST(ShippedFilms, LeftOutPackingsAreWhereTheEmulatorExpectsThem) {
  const bank::Runs runs = bank::read_runs(shipped(), bank::table_of(shipped()));
  const inference::Emulator emulator = bank::emulator_of(runs, bank::table_of(shipped()));
  const auto all = inference::accuracy_of(emulator.left_out(), emulator.runs().values);
  double in_50 = 0.0, in_90 = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    const inference::Accuracy &a =
        all[std::size_t(bank::output_of(FilmNumber::PorosityAfter, k, 6))];
    in_50 += a.inside_50 / 6.0;
    in_90 += a.inside_90 / 6.0;
    EXPECT_GT(a.q2, 0.6) << k;
  }
  EXPECT_NEAR(in_50, 0.5, 0.15);
  EXPECT_NEAR(in_90, 0.9, 0.09);
}

} // namespace
