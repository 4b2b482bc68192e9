// SPDX-License-Identifier: GPL-2.0-or-later
// Folders of runs become a folder that reads as a run; what is no sample is refused.
#include "base/messages.h"
#include "base/provenance.h"
#include "compare/gap.h"
#include "simulate/sample.h"
#include "support/test_folder.h"
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using calendem_test::test_folder;

class SampleOfRuns : public testing::Test {
protected:
  std::filesystem::path folder_ = test_folder();

  /// A run of a spring of 4 MPa/um, a fifth of it solid, from `height` to `lowest` [um] and back.
  std::string spring(const std::string &name, double height, double lowest,
                     const std::string &more = "") {
    std::filesystem::create_directories(folder_ / name);
    std::string curve = "stage,thickness_um,pressure_MPa,porosity_total\n";
    const auto add = [&](const char *stage, double gap) {
      curve +=
          fmt::format("{},{},{},{}\n", stage, gap, 4.0 * (height - gap), 1.0 - 0.2 * height / gap);
    };
    for (int k = 0; k <= 20; ++k)
      add("compression", height - (height - lowest) * k / 20);
    for (int k = 1; k <= 20; ++k)
      add("relaxation", lowest + (height - lowest) * k / 20);
    write(name + "/curve.csv", curve + more);
    write(name + "/summary.json", "{\"finished\": true, \"porosity_initial\": 0.8, \"bodies\": 10, "
                                  "\"cracked_bodies\": 2}");
    write(name + "/electrode.json",
          fmt::format("{{\"loading_mg_cm2\": {}, \"recipe\": {{\"coating.loading_mg_cm2\": \"4\", "
                      "\"seed\": \"1\"}}}}",
                      0.2 * height));
    write(name + "/case.toml", fmt::format("electrode = \"none\"\n[platen]\ncontrol = "
                                           "\"thickness\"\nthickness_um = {}\n",
                                           lowest));
    return in(name);
  }

  std::string in(const std::string &name) const { return (folder_ / name).string(); }
  void write(const std::string &name, const std::string &text) { write_file(in(name), text); }

  std::string refusal(const std::vector<std::string> &runs, OneFor shared) {
    try {
      make_sample(runs, shared, in("out"));
    } catch (const Failure &f) {
      EXPECT_EQ(f.exit_status(), kBadInput);
      return f.what();
    }
    return "";
  }
};

// Heights 20 and 22 um, 4 MPa/um: at 16 um 16 and 24 MPa. 1 % of the mean, 0.2 MPa, are left where
// the higher one alone bears 0.4.
TEST_F(SampleOfRuns, IsAFolderThatReadsAsARun) {
  const std::string out = in("sample");
  make_sample({spring("a", 20, 16), spring("b", 22, 16)}, OneFor::Gap, out);
  const SimulatedRun run = read_simulated_run(out);
  EXPECT_EQ(run.control, "pressure");
  EXPECT_NEAR(run.target, 20.0, 1e-4);
  EXPECT_NEAR(run.max_pressure, 20.0, 1e-9);
  EXPECT_NEAR(run.thickness_at_max, 16.0, 1e-9);
  EXPECT_NEAR(run.thickness_after, 21.9, 1e-9);
  EXPECT_NEAR(run.solid_column, 4.2, 1e-9);
  EXPECT_NEAR(run.porosity_initial, 0.8, 1e-9);
  EXPECT_EQ(run.cracked_fraction, 0.2);
  EXPECT_EQ(run.recipe.at("coating.loading_mg_cm2"), "4.2");
  EXPECT_EQ(run.recipe.at("seed"), "1");
}

TEST_F(SampleOfRuns, UnderOnePressureHeightsAreAveraged) {
  const std::string out = in("sample");
  make_sample({spring("a", 20, 15), spring("b", 22, 17)}, OneFor::Pressure, out);
  const SimulatedRun run = read_simulated_run(out);
  EXPECT_NEAR(run.max_pressure, 20.0, 1e-9);
  EXPECT_NEAR(run.thickness_at_max, 16.0, 1e-9);
  EXPECT_NEAR(run.thickness_after, 20.95, 1e-9); // 0.2 MPa
}

// What a packing took to make is no part of it.
TEST_F(SampleOfRuns, APackingThatWasMadeTwiceIsOne) {
  make_sample({spring("a", 20, 16)}, OneFor::Gap, in("run"));
  const auto packing = [&](const char *identity, double took) {
    write("run/electrode.json", fmt::format("{{\"recipe\": {{}}, \"identity\": \"{}\", "
                                            "\"wall_clock_s\": {}}}",
                                            identity, took));
    return read_simulated_run(in("run")).electrode_hash;
  };
  EXPECT_EQ(packing("one", 5.0), packing("one", 3.0));
  EXPECT_NE(packing("one", 5.0), packing("another", 5.0));
}

TEST_F(SampleOfRuns, CellsThatTurnApartAreRefused) {
  const std::vector<std::string> runs = {spring("a", 20, 16), spring("b", 22, 17)};
  EXPECT_NE(refusal(runs, OneFor::Gap).find("to 16.000 um"), std::string::npos);
  EXPECT_NE(refusal(runs, OneFor::Pressure).find("to 20.000 MPa"), std::string::npos);
}

TEST_F(SampleOfRuns, CellsOfOtherMaterialsAreRefused) {
  const std::vector<std::string> runs = {spring("a", 20, 16), spring("b", 22, 16)};
  const auto with = [&](const char *keys) {
    write("b/case.toml",
          std::string(
              "electrode = \"none\"\n[platen]\ncontrol = \"thickness\"\nthickness_um = 16\n") +
              keys);
    return refusal(runs, OneFor::Gap);
  };
  EXPECT_NE(with("[effects.machine_compliance]\num_per_MPa = 0.1\n")
                .find("are of one recipe and material"),
            std::string::npos);
  EXPECT_EQ(with("[bond]\nseed = 7\n"), "");
}

// Loading and seed differ from cell to cell, as does the name; what the sample's recipe says is
// true of all.
TEST_F(SampleOfRuns, CellsOfOtherRecipesAreRefused) {
  const std::vector<std::string> runs = {spring("a", 20, 16), spring("b", 22, 16)};
  const auto with = [&](const char *name, const char *key, const char *value) {
    write(std::string(name) + "/electrode.json",
          fmt::format("{{\"loading_mg_cm2\": 4, \"recipe\": {{\"{}\": \"{}\"}}}}", key, value));
  };
  for (const char *key : {"density.am_g_cm3", "composition.am_weight_percent", "cell.x_um",
                          "coating.porosity_total_percent"}) {
    with("a", key, "40");
    with("b", key, "41");
    const std::string said = refusal(runs, OneFor::Gap);
    EXPECT_NE(said.find(fmt::format("{} = 40", key)), std::string::npos) << said;
    EXPECT_NE(said.find("has 41"), std::string::npos) << said;
  }
  for (const char *key : {"name", "seed", "coating.loading_mg_cm2"}) {
    with("a", key, "4");
    with("b", key, "5");
    EXPECT_EQ(refusal(runs, OneFor::Gap), "");
  }
}

TEST_F(SampleOfRuns, NothingButASampleIsWrittenOver) {
  const std::vector<std::string> runs = {spring("a", 20, 16), spring("b", 22, 16)};
  make_sample(runs, OneFor::Gap, in("out"));
  EXPECT_EQ(refusal(runs, OneFor::Gap), "");
  for (const char *file : {"out/curve_raw.csv", "out/electrode.data"}) {
    write(file, "");
    EXPECT_NE(refusal(runs, OneFor::Gap).find("would overwrite"), std::string::npos);
    std::filesystem::remove(in(file));
  }
}

TEST_F(SampleOfRuns, WhatIsNoRunIsRefusedWithEveryReason) {
  const std::string twice = spring("a", 20, 16, "compression,16,16,0.75\n");
  const std::string said = refusal({twice, in("none")}, OneFor::Gap);
  EXPECT_NE(said.find("pressed again after a release"), std::string::npos) << said;
  EXPECT_NE(said.find("none/summary.json: missing"), std::string::npos) << said;
}

} // namespace
