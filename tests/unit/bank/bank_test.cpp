// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank_file.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "diagnose/bank/bank_table.h"
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace {

using namespace calendem;
using namespace calendem_test;

TEST(Bank, PointsOfAnEffectStandBesideABasePoint) {
  const BankSpec spec =
      spec_of(kBank + "effects = [\"friction\", \"thickness_zero\"]\n" + kParameters);
  const std::vector<BankPoint> points = bank_points(spec);
  ASSERT_EQ(points.size(), 8u + 4u); // what instruments show needs no runs
  std::set<int> packings, beside;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const BankPoint &p = points[k], &base = points[p.base_point];
    packings.insert(p.packing);
    EXPECT_EQ(p.base, base.base);
    EXPECT_EQ(p.packing, base.packing);
    EXPECT_TRUE(p.base[0] >= 100 && p.base[0] <= 300 && p.base[1] >= 300 && p.base[1] <= 900);
    EXPECT_EQ(p.effect, k < 8 ? "" : "friction");
    if (k >= 8) {
      EXPECT_TRUE(beside.insert(p.base_point).second);
      EXPECT_TRUE(p.value >= 0.05 && p.value <= 0.6) << p.value;
    }
  }
  EXPECT_EQ(packings, (std::set<int>{1, 2, 3}));
}

TEST(Bank, EveryPointIsRunToEveryPressureWithTheEffectOnOrOff) {
  const BankSpec spec = spec_of(kBank + "effects = [\"pre_cracks\"]\n" + kParameters);
  const std::vector<BankPoint> points = bank_points(spec);
  const Study study = pressed_study(spec, bank_runs(spec));
  ASSERT_EQ(study.runs.size(), 2 * points.size());
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const BankPoint &p = points[k / 2];
    const Settings &s = study.runs[k].settings;
    EXPECT_EQ(s.number("platen.max_pressure_MPa"), k % 2 ? 150.0 : 80.0);
    EXPECT_EQ(s.number("bond.shear_strength_MPa"), p.base[1]);
    EXPECT_EQ(s.number("effects.pre_cracks.fraction"), p.effect.empty() ? 0.0 : p.value);
    EXPECT_EQ(study.runs[k].recipe.seed, static_cast<unsigned long>(p.packing));
  }
}

TEST(Bank, AnEffectOfTheCoatingIsInTheRecipe) {
  const BankSpec spec = spec_of(kBank + "effects = [\"cbd_gradient\"]\n" + kParameters);
  const std::vector<BankPoint> points = bank_points(spec);
  const Study study = pressed_study(spec, bank_runs(spec));
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const BankPoint &p = points[k / 2];
    EXPECT_EQ(study.runs[k].recipe.cbd_gradient.slope, p.effect.empty() ? 0.0 : p.value);
  }
}

TEST(Bank, TheFullCellGetsTheFirstBasePointsInItsOwnRecipe) {
  const std::string loading =
      "[[parameter]]\nname = \"L\"\nkeys = [\"recipe.coating.loading_mg_cm2\"]\nlow = "
      "5\nhigh = 7\n";
  const std::string full =
      "[full_cell]\nrecipe = \"full.toml\"\ncase = \"case.toml\"\npoints = 2\n";
  const std::string file =
      write_bank(kBank + "effects = [\"friction\"]\n" + kParameters + loading + full);
  std::ofstream(std::filesystem::path(file).replace_filename("full.toml"))
      << "[coating]\nloading_mg_cm2 = 15\n[cell]\nx_um = 14\ny_um = 14\n";
  const BankSpec spec = read_bank_spec(file);
  const std::vector<BankPoint> base = bank_points(spec), points = full_cell_points(spec);
  ASSERT_EQ(points.size(), 2u);
  const Study study = full_cell_study(spec, full_cell_runs(spec));
  ASSERT_EQ(study.runs.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(points[k / 2].effect, kFullCell);
    EXPECT_EQ(points[k / 2].base, base[k / 2].base);
    EXPECT_EQ(study.runs[k].recipe.loading, 15.0);
    EXPECT_EQ(study.runs[k].recipe.cell_x, 14.0);
    EXPECT_EQ(study.runs[k].settings.number("material.am.youngs_modulus_GPa"), base[k / 2].base[0]);
  }
  BankTable table = {spec, {}};
  BankRow row = {points[1], {}};
  row.run.target = 80.0;
  table.rows.push_back(row);
  write_file(file + ".csv", write_bank_table(table));
  EXPECT_EQ(read_bank_table(spec, file + ".csv").rows[0].point.effect, kFullCell);
}

TEST(Bank, MistakesAreReported) {
  try {
    spec_of("[bank]\nrecipe = \"electrode.toml\"\npressure_MPa = [80]\npackings = 1\nbase_points = "
            "4\neffect_points = 9\neffects = [\"frction\"]\n[[parameter]]\nname = \"E\"\nlow = "
            "3\nhigh = 1\n");
    FAIL();
  } catch (const Failure &e) {
    const std::string message = e.what();
    for (const char *part : {"'case' is missing", "Did you mean 'pressures_MPa'", "packings is 1",
                             "effect_points is 9, base_points 4", "Did you mean 'friction'",
                             "goes from 3 to 1", "needs a list 'keys'"})
      EXPECT_NE(message.find(part), std::string::npos) << part << "\nis not in\n" << message;
  }
}

// The first points stay where they are, so that a bank can grow.
TEST(Bank, AnEffectMayHaveMorePoints) {
  const std::string text = kBank + "effects = [\"friction\", \"pre_cracks\"]\n" + kParameters;
  const std::vector<BankPoint> few = bank_points(spec_of(text));
  const BankSpec spec = spec_of(text + "[[effect]]\nname = \"friction\"\npoints = 8\n");
  EXPECT_EQ(effect_of(spec, "friction").parameter.low, find_effect("friction").parameter.low);
  std::map<std::string, int> count;
  for (const BankPoint &p : bank_points(spec))
    ++count[p.effect];
  EXPECT_EQ(count["friction"], 8);
  EXPECT_EQ(count["pre_cracks"], 4);
  for (int k = 0; k < 4; ++k)
    EXPECT_EQ(bank_points(spec)[std::size_t(8 + k)].value, few[std::size_t(8 + k)].value);
  EXPECT_THROW(spec_of(text + "[[effect]]\nname = \"friction\"\npoints = 9\n"), Failure);
}

// Numbers that begin elsewhere are all that differs.
TEST(Bank, ItsPointsMayBeNumberedForATableThatIsJoined) {
  const std::string effects = "effects = [\"friction\"]\n";
  const std::vector<BankPoint> first = bank_points(spec_of(kBank + effects + kParameters)),
                               later = bank_points(
                                   spec_of(kBank + "first_point = 48\n" + effects + kParameters));
  ASSERT_EQ(first.size(), later.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_EQ(later[k].base_point, first[k].base_point + 48);
    EXPECT_EQ(later[k].base, first[k].base);
    EXPECT_EQ(later[k].effect, first[k].effect);
  }
}

TEST(Bank, AnEffectMayHaveANarrowerRange) {
  const std::string effects = "effects = [\"friction\", \"pre_cracks\"]\n";
  const BankSpec spec = spec_of(kBank + effects + kParameters +
                                "[[effect]]\nname = \"friction\"\nlow = 0.3\nhigh = 0.35\n");
  EXPECT_EQ(effect_of(spec, "friction").parameter.low, 0.3);
  EXPECT_EQ(effect_of(spec, "friction").parameter.high, 0.35);
  EXPECT_EQ(effect_of(spec, "pre_cracks").parameter.high, find_effect("pre_cracks").parameter.high);
  for (const BankPoint &p : bank_points(spec))
    EXPECT_TRUE(p.effect != "friction" || (p.value >= 0.3 && p.value <= 0.35)) << p.value;
  try {
    spec_of(kBank + effects + kParameters +
            "[[effect]]\nname = \"friction\"\nlow = 0.01\nhigh = 0.4\n[[effect]]\nname = "
            "\"friction\"\nlow = 0.4\nhigh = 0.3\n[[effect]]\nname = \"thickness_zero\"\n");
    FAIL();
  } catch (const Failure &e) {
    const std::string message = e.what();
    for (const char *part :
         {"low is 0.01", "from 0.4 to 0.3", "two ranges", "name is \"thickness_zero\"", "friction"})
      EXPECT_NE(message.find(part), std::string::npos) << part << "\nis not in\n" << message;
  }
}

// Requirement: what yields may do so at a tenth of the prior's lower end, but not be weaker than the
// prior, where emulators take the effect to cease.
TEST(Bank, WhatYieldsMayBeSofterThanItsPrior) {
  const std::string effects = "effects = [\"cbd_plasticity\"]\n",
                    range = "[[effect]]\nname = \"cbd_plasticity\"\n";
  const BankSpec spec = spec_of(kBank + effects + kParameters + range + "low = 0.12\nhigh = 0.4\n");
  EXPECT_EQ(effect_of(spec, "cbd_plasticity").parameter.low, 0.12);
  for (const char *refused : {"low = 0.05\nhigh = 0.4\n", "low = 0.12\nhigh = 3.1\n"})
    EXPECT_THROW(spec_of(fmt::format("{}{}{}{}{}", kBank, effects, kParameters, range, refused)),
                 Failure)
        << refused;
}

TEST(Bank, PricesOfMeasurementsAreTheUsualOnesUnlessGiven) {
  const BankSpec spec = spec_of(kBank + kParameters +
                                "[[measurement]]\nname = \"cracked_bodies\"\nhours = 3\nsd = "
                                "0.02\n[[measurement]]\nname = \"dwell\"\nhours = 0.5\n");
  ASSERT_EQ(spec.prices.size(), usual_prices().size());
  for (std::size_t k = 0; k < spec.prices.size(); ++k) {
    const MeasurementPrice &p = spec.prices[k];
    const bool given = p.name == "cracked_bodies", dwell = p.name == "dwell";
    EXPECT_EQ(p.hours, given ? 3.0 : dwell ? 0.5 : usual_prices()[k].hours) << p.name;
    EXPECT_EQ(p.sd, given ? 0.02 : usual_prices()[k].sd) << p.name;
  }
}

TEST(Bank, MistakesOfMeasurementsAreReported) {
  try {
    spec_of(kBank + kParameters +
            "[[measurement]]\nname = \"cracks\"\n[[measurement]]\nname = \"dwell\"\nsd = "
            "1\n[[measurement]]\nname = \"loading_curve\"\nhours = -1\nprice = 3\n");
    FAIL();
  } catch (const Failure &e) {
    const std::string message = e.what();
    for (const char *part :
         {"cracks", "loading_curve", "'dwell' takes no sd", "hours is -1", "unknown key 'price'"})
      EXPECT_NE(message.find(part), std::string::npos) << part << "\nis not in\n" << message;
  }
}

SimulatedRun some_run(double target, double factor) {
  SimulatedRun r;
  r.control = "pressure";
  r.target = target;
  r.max_pressure = target;
  r.solid_column = 40.0;
  r.thickness_at_max = 50.0 * factor;
  r.thickness_after = 56.0 * factor;
  r.porosity_initial = 0.48;
  r.porosity_at_max = 1.0 - 40.0 / r.thickness_at_max;
  r.porosity_after = 1.0 - 40.0 / r.thickness_after;
  for (double p = 0.0; p <= target; p += 1.0) {
    r.pressure.push_back(p);
    r.displacement.push_back(10.0 + 0.1 * p);
    r.release_pressure.push_back(p);
    r.release_displacement.push_back((8.0 + 0.1 * target + 0.02 * p) * factor);
  }
  return r;
}

TEST(Bank, TheTableReadsBackAsWritten) {
  const BankSpec spec = spec_of(kBank + kParameters);
  const BankTable table = {spec,
                           {{{"", 3, 1, {200, 500}, 0.0}, some_run(80, 1)},
                            {{"friction", 3, 1, {200, 500}, 0.3}, some_run(150, 0.9)}}};
  const std::string text = write_bank_table(table), file = (test_folder() / "bank.csv").string();
  std::ofstream(file) << text;
  const BankTable back = read_bank_table(spec, file);
  EXPECT_EQ(write_bank_table(back), text);
  ASSERT_EQ(back.rows.size(), 2u);
  EXPECT_EQ(back.rows[1].point.effect, "friction");
  EXPECT_EQ(back.rows[1].point.value, 0.3);
  EXPECT_EQ(back.rows[0].run.pressure.back(), 80.0);
  EXPECT_NEAR(displacement_at(back.rows[1].run.pressure, back.rows[1].run.displacement, 100.0),
              20.0, 0.005);
  const SimulatedRun &first = back.rows[0].run; // at 5, 10, ... 95 % of 80 MPa
  ASSERT_EQ(first.release_pressure.size(), 19u);
  EXPECT_NEAR(first.release_pressure[4], 20.0, 1e-12);
  EXPECT_NEAR(first.release_displacement[4], 16.0 + 0.02 * 20.0, 0.0005);
  std::ofstream(file) << text.substr(0, text.size() - 40);
  EXPECT_THROW(read_bank_table(spec, file), Failure);
}

// Thin films yield in steps; a curve read from the table has them where the run had them.
TEST(Bank, AStepStaysWhereItWas) {
  const BankSpec spec = spec_of(kBank + kParameters);
  SimulatedRun run = some_run(80, 1);
  run.pressure = {1.0, 37.1, 37.2, 80.0};
  run.displacement = {1.0, 2.0, 3.0, 4.0};
  const std::string file = (test_folder() / "bank.csv").string();
  std::ofstream(file) << write_bank_table({spec, {{{"", 3, 1, {200, 500}, 0.0}, run}}});
  const SimulatedRun back = read_bank_table(spec, file).rows[0].run;
  for (const double p : {20.0, 36.0, 36.9, 38.1, 60.0})
    EXPECT_NEAR(displacement_at(back.pressure, back.displacement, p),
                displacement_at(run.pressure, run.displacement, p), 0.005)
        << p;
}

// Each in a row of its own; the fuzzer found that a parameter could be no number.
TEST(Bank, RowsThatAreNoPointAreReported) {
  BankSpec spec;
  spec.parameters = {{"E", {}, 100.0, 300.0}};
  const BankTable table = {spec, {{{"", 3, 1, {200}, 0.0}, some_run(80, 1)}}};
  const std::string text = write_bank_table(table), file = (test_folder() / "bank.csv").string();
  ASSERT_NE(text.find("\n,3,1,200,,"), std::string::npos) << text;
  for (const auto &[row, reported] : std::map<std::string, std::string>{
           {"\n,,1,200,,", "'base_point' is no number"},
           {"\n,3,1e99,200,,", "'packing' is 1e+99; it is a whole number from 1 to 10000"},
           {"\n,2.5,1,200,,", "'base_point' is 2.5; it is a whole number from 0"},
           {"\n,3,1,,,", "'E' is no number"},
           {"\nfriction,3,1,200,,", "'value' is no number"},
           {"\nfricton,3,1,200,1,", "Did you mean 'friction'"}}) {
    std::string wrong = text;
    wrong.replace(wrong.find("\n,3,1,200,,"), 11, row);
    std::ofstream(file) << "# a remark\n" << wrong;
    try {
      read_bank_table(spec, file);
      ADD_FAILURE() << row;
    } catch (const Failure &f) {
      EXPECT_EQ(f.exit_status(), kBadInput);
      EXPECT_NE(std::string(f.what()).find("bank.csv:3: "), std::string::npos) << f.what();
      EXPECT_NE(std::string(f.what()).find(reported), std::string::npos) << f.what();
    }
  }
}

TEST(Bank, ATableMayLackTheRelease) {
  const BankSpec spec = spec_of(kBank + kParameters);
  SimulatedRun run = some_run(80, 1);
  run.release_pressure.clear();
  const std::string text = write_bank_table({spec, {{{"", 3, 1, {200, 500}, 0.0}, run}}}),
                    file = (test_folder() / "bank.csv").string();
  std::string without; // the columns, and the commas of their empty cells
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find(",displacement_um_released");
    without += line.substr(0, at == std::string::npos ? line.size() - 19 : at) + "\n";
  }
  for (const std::string &table : {text, without}) {
    std::ofstream(file) << table;
    const BankTable back = read_bank_table(spec, file);
    EXPECT_TRUE(back.rows[0].run.release_pressure.empty());
    EXPECT_EQ(back.rows[0].run.pressure.back(), 80.0);
  }
}

// The displacements above 180 MPa; an earlier table has no columns for them.
TEST(Bank, ACurveTo300MPaIsKept) {
  const BankSpec spec = spec_of(kBank + kParameters);
  const std::string text =
                        write_bank_table({spec, {{{"", 3, 1, {200, 500}, 0.0}, some_run(300, 1)}}}),
                    file = (test_folder() / "bank.csv").string();
  std::ofstream(file) << text;
  const SimulatedRun back = read_bank_table(spec, file).rows[0].run;
  EXPECT_EQ(back.pressure.back(), 300.0);
  for (const double p : {183.0, 225.0, 297.5})
    EXPECT_NEAR(displacement_at(back.pressure, back.displacement, p), 10.0 + 0.1 * p, 0.005) << p;
  const auto first = text.find(",displacement_um_at_185_MPa"),
             after = text.find(",displacement_um_released");
  ASSERT_LT(first, after);
  const auto columns = std::count(text.begin() + long(first), text.begin() + long(after), ',');
  std::istringstream lines(text);
  std::string earlier;
  for (std::string line; std::getline(lines, line);) {
    std::size_t place = 0; // of the cells of 185 MPa and above
    for (auto commas = std::count(text.begin(), text.begin() + long(first), ','); commas-- >= 0;)
      place = line.find(',', place + 1);
    std::size_t end = place;
    for (long k = 0; k < columns; ++k)
      end = line.find(',', end + 1);
    earlier += line.substr(0, place) + line.substr(end) + "\n";
  }
  std::ofstream(file) << earlier;
  EXPECT_EQ(read_bank_table(spec, file).rows[0].run.pressure.back(), 180.0);
}

// A quarter of the way in ln p, from 80 to 150 MPa.
TEST(Bank, BetweenTwoPressuresRunsAreLinearInItsLogarithm) {
  const double p = std::pow(80.0, 0.75) * std::pow(150.0, 0.25);
  const SimulatedRun r = between_runs(some_run(80, 1), some_run(150, 0.9), p);
  EXPECT_NEAR(r.thickness_at_max, 48.75, 1e-12);
  EXPECT_EQ(r.target, p);
  EXPECT_NEAR(r.max_pressure, p, 1e-12);
  EXPECT_EQ(r.pressure.back(), 150.0);
  // The release at equal shares: half-way it is 16 + 0.8 and (23 + 1.5) 0.9.
  EXPECT_NEAR(displacement_at(r.release_pressure, r.release_displacement, 0.5 * p),
              0.75 * 16.8 + 0.25 * 24.5 * 0.9, 1e-9);
  EXPECT_NEAR(error_between_runs(80.0, 150.0, p).porosity_after,
              0.007 * std::log(p / 80.0) * std::log(150.0 / p), 1e-15);
}

TEST(Bank, InstrumentsChangeWhatIsShownOnly) {
  const SimulatedRun run = some_run(80, 1);
  const SimulatedRun zero = shown_with(find_effect("thickness_zero"), 2.0, run);
  EXPECT_EQ(zero.thickness_after, 58.0);
  EXPECT_NEAR(zero.porosity_after, 1.0 - 40.0 / 58.0, 1e-12);
  EXPECT_NEAR(zero.porosity_initial, 1.0 - 40.0 / (40.0 / 0.52 + 2.0), 1e-12);
  EXPECT_EQ(zero.displacement, run.displacement);
  const SimulatedRun soft = shown_with(find_effect("machine_compliance"), 0.05, run);
  EXPECT_EQ(soft.thickness_after, run.thickness_after);
  EXPECT_NEAR(soft.porosity_initial, 0.48, 1e-12);
  EXPECT_NEAR(soft.displacement.back(), run.displacement.back() + 4.0, 1e-12);
  EXPECT_NEAR(soft.release_displacement[40], run.release_displacement[40] + 2.0, 1e-12);
  EXPECT_EQ(zero.release_displacement, run.release_displacement);
}

} // namespace
