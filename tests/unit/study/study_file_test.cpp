// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "simulate/study_file.h"
#include "support/test_folder.h"
#include <cmath>
#include <fstream>

namespace {

using namespace calendem;
using calendem_test::test_folder;

const std::string kHead = "[study]\nrecipe = \"electrode.toml\"\ncase = \"case.toml\"\n";

std::string write_study(const std::string &text) {
  const auto folder = test_folder();
  std::ofstream(folder / "electrode.toml")
      << "material = \"xu2023\"\n[cell]\nx_um = 12\ny_um = 12\n";
  std::ofstream(folder / "case.toml") << "electrode = \"any\"\n";
  std::ofstream(folder / "points.csv") << "case.bond.damping,recipe.seed\n0.1,4\n0.2,5\n";
  std::ofstream(folder / "wrong.csv") << "case.bond.damping,seed\n0.1,4\n-1,5\n";
  std::ofstream(folder / "study.toml") << text;
  return (folder / "study.toml").string();
}

std::string refusal(const std::string &text) {
  try {
    read_study(write_study(text));
  } catch (const Failure &e) {
    EXPECT_EQ(e.exit_status(), kBadInput);
    return e.what();
  }
  ADD_FAILURE() << "taken:\n" << text;
  return "";
}

void expect_parts(const std::string &message, const std::vector<std::string> &parts) {
  for (const std::string &part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nis not in\n" << message;
}

// Requirement: cells of a normal law, at the middle of equal shares, have its mean and sd.
TEST(StudyFile, CellsOfASampleHaveTheLawsMeanAndScatter) {
  const Study study =
      read_study(write_study(kHead + "[[vary]]\nkeys = [\"recipe.coating.loading_mg_cm2\"]\n"
                                     "normal = { mean = 17.46, sd = 0.4, cells = 5 }\n"));
  ASSERT_EQ(study.runs.size(), 5u);
  double sum = 0.0, squares = 0.0;
  for (const StudyRun &r : study.runs) {
    sum += r.recipe.loading / 5;
    squares += (r.recipe.loading - 17.46) * (r.recipe.loading - 17.46) / 5;
  }
  EXPECT_NEAR(sum, 17.46, 1e-4); // values have six digits
  EXPECT_NEAR(std::sqrt(squares), 0.4, 1e-4);
  EXPECT_LT(study.runs[0].recipe.loading, study.runs[1].recipe.loading);
}

TEST(StudyFile, CellsOfASampleMistaken) {
  const std::string vary = kHead + "[[vary]]\nkeys = [\"recipe.coating.loading_mg_cm2\"]\n";
  expect_parts(refusal(vary + "normal = { mean = 17, cells = 1, deviation = 2 }\n"),
               {"'sd' is missing", "cells is 1", "normal.deviation"});
  expect_parts(refusal(vary + "normal = { mean = 17, sd = 20, cells = 3 }\n"),
               {"coating.loading_mg_cm2 is -"});
  expect_parts(refusal(vary + "values = [1]\nnormal = { mean = 17, sd = 1, cells = 3 }\n"),
               {"either a list 'values' or a table 'normal'"});
}

TEST(StudyFile, WithoutGroupsIsOneRun) {
  const Study s = read_study(write_study(kHead));
  ASSERT_EQ(s.runs.size(), 1u);
  EXPECT_TRUE(s.columns.empty());
  EXPECT_EQ(s.runs[0].recipe.cell_x, 12.0);
}

TEST(StudyFile, EveryCombinationOfTheGroupsIsARun) {
  const Study s = read_study(write_study(
      kHead + "at_pressure_MPa = [90, 20]\n[[vary]]\nkeys = [\"case.bond.criterion\"]\nvalues = "
              "[\"signed\", \"unsigned\"]\n[[vary]]\nkeys = [\"case.bond.tensile_strength_MPa\", "
              "\"case.bond.shear_strength_MPa\"]\nvalues = [200, [300, 400]]\n[[vary]]\ndesign = "
              "\"points.csv\"\n"));
  ASSERT_EQ(s.runs.size(), 8u);
  EXPECT_EQ(s.columns.size(), 5u);
  EXPECT_EQ(s.at_pressure, (std::vector<double>{20, 90}));
  const StudyRun &last = s.runs[7], &second = s.runs[1];
  EXPECT_EQ(last.settings.text("bond.criterion"), "unsigned");
  EXPECT_EQ(last.settings.number("bond.tensile_strength_MPa"), 300.0);
  EXPECT_EQ(last.settings.number("bond.shear_strength_MPa"), 400.0);
  EXPECT_EQ(last.recipe.seed, 5u);
  EXPECT_EQ(last.number, 8);
  EXPECT_EQ(second.settings.text("bond.criterion"), "signed");
  EXPECT_EQ(second.settings.number("bond.shear_strength_MPa"), 200.0);
  EXPECT_EQ(second.settings.number("bond.damping"), 0.2);
}

TEST(StudyFile, ARunOfManySettingsIsNamedByTheFirstSix) {
  const Study s = read_study(write_study(
      kHead + "[[vary]]\nkeys = [\"case.material.am.friction\", \"case.material.cbd.friction\", "
              "\"case.bond.tensile_strength_MPa\", \"case.bond.shear_strength_MPa\", "
              "\"case.bond.damping\", \"case.platen.speed_m_s\", \"case.platen.dwell_us\", "
              "\"recipe.seed\"]\nvalues = [[0.3, 0.3, 77, 77, 0.1, 0.7, 0.2, 9]]\n"));
  ASSERT_EQ(s.runs.size(), 1u);
  EXPECT_NE(s.runs[0].said.find("am.friction 0.3, cbd.friction 0.3"), std::string::npos);
  EXPECT_EQ(s.runs[0].said.substr(s.runs[0].said.size() - 11), " and 2 more");
}

// Two moduli are told apart, what is as in the files is not repeated.
TEST(StudyFile, ARunIsNamedByWhatDiffersFromRecipeAndCase) {
  const Study s = read_study(write_study(
      kHead + "[[vary]]\nkeys = [\"recipe.seed\"]\nvalues = [1, 3]\n[[vary]]\nkeys = "
              "[\"case.material.am.friction\", \"case.material.cbd.friction\"]\nvalues = [0.001, "
              "0.2]\n"));
  ASSERT_EQ(s.runs.size(), 4u);
  EXPECT_EQ(s.runs[0].said, "as recipe and case");
  EXPECT_EQ(s.runs[1].said, "am.friction 0.2, cbd.friction 0.2");
  EXPECT_EQ(s.runs[2].said, "seed 3");
}

TEST(StudyFile, EveryMistakeIsReported) {
  expect_parts(
      refusal(kHead + "keep = \"some\"\nat_pressure_MPa = [-1]\nspeed = 3\n[[vary]]\nkeys = "
                      "[\"case.bond.tensile_strength\"]\nvalues = [1]\n[[vary]]\nkeys = "
                      "[\"case.bond.damping\", \"recipe.seed\"]\nvalues = [[0.1, 2, 3], [7, 1.5]]\n"
                      "[[vary]]\ndesign = \"none.csv\"\n[[vary]]\ndesign = \"wrong.csv\"\n"),
      {"keep is \"some\"", "at_pressure_MPa is -1", "unknown key 'speed'",
       "Did you mean 'case.bond.tensile_strength_MPa'", "3 entries for 2 keys", "bond.damping is 7",
       "seed is 1.5; it must be a whole number", "none.csv", "bond.damping is -1",
       "'seed' is not a key that can be varied", "is varied twice"});
  expect_parts(refusal("[study]\nname = 3\n"),
               {"name must be a text in quotes (for reports), not 3", "'recipe' is missing",
                "'case' is missing"});
  expect_parts(refusal("[studio]\n"), {"unknown 'studio'", "no table [study]"});
}

TEST(StudyFile, ACombinationThatContradictsItselfIsNamed) {
  expect_parts(refusal(kHead + "[[vary]]\nkeys = [\"case.material.cbd.youngs_modulus_GPa\"]\n"
                               "values = [2, 0.02]\n"),
               {"run 2", "cohesion would collapse the packing"});
  expect_parts(
      refusal(kHead + "[[vary]]\nkeys = [\"recipe.particles.min_um\"]\nvalues = [2, 15]\n"),
      {"run 2", "no particle fits: particles.min_um is 15"});
}

} // namespace
