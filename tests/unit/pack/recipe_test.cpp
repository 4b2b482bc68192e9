// SPDX-License-Identifier: GPL-2.0-or-later
#include "support.h"

namespace {
using namespace calendem;
using calendem_test::recipe_of;

std::string message_for(const std::string &lines) {
  try {
    recipe_of(lines);
  } catch (const Failure &e) {
    EXPECT_EQ(e.exit_status(), kBadInput);
    return e.what();
  }
  return "";
}

void expect_all(const std::string &message, const std::vector<std::string> &parts) {
  for (const std::string &part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << "no '" << part << "' in\n" << message;
}

TEST(Recipe, DefaultIsThePaperSElectrode) {
  const Recipe r = recipe_of("name = \"x\"\n");
  EXPECT_NEAR(r.am_column(), 36.04, 0.01);
  EXPECT_NEAR(r.thickness(), 76.5, 0.2);
  EXPECT_EQ(r.cell_x, 15.0);
}

TEST(Recipe, EveryMistakeIsNamedAtOnceWithItsLine) {
  expect_all(message_for("name = \"x\"\n[coating]\nloading_mg_cm2 = -3\nporosity_percent = 40\n"
                         "[particles]\nmedian_um = nan\n[cell]\nx_um = \"15\"\n"),
             {":3: coating.loading_mg_cm2 is -3", ":4: unknown key 'coating.porosity_percent'",
              "coating.porosity_total_percent", ":6: particles.median_um is nan",
              ":8: cell.x_um must be a number"});
}

TEST(Recipe, SaysWhatAFractionOrAnotherUnitLooksLike) {
  expect_all(message_for("[coating]\nporosity_total_percent = 0.48\n"), {"0.48", "fraction"});
  expect_all(message_for("[particles]\nmedian_um = 4350\n"), {"4350", "nm"});
}

TEST(Recipe, WeightsAddUpToHundred) {
  expect_all(message_for("[composition]\nam_weight_percent = 90\n"), {"94", "100"});
}

TEST(Recipe, ActiveMaterialIsWhatCarbonAndBinderLeave) {
  const Recipe r = recipe_of("name = \"x\"\n[composition]\ncarbon_weight_percent = 2.5\n"
                             "binder_weight_percent = 2.5\n");
  EXPECT_NEAR(r.am_weight, 0.95, 1e-12);
  expect_all(message_for("[composition]\ncarbon_weight_percent = 30\nbinder_weight_percent = "
                         "30\n"),
             {":3:", "leave 40 %", "50 to 100 %"});
  expect_all(message_for("[composition]\ncarbon_weight_percent = 0.02\nbinder_weight_percent = "
                         "0.02\n"),
             {"look like fractions"});
}

TEST(Recipe, AGradientIsRefusedBesideAStructure) {
  expect_all(
      message_for("[structure]\nfile = \"recipe.toml\"\nunits = \"micro\"\nam_types = \"1\"\n"
                  "cbd_types = \"2\"\n[effects.cbd_gradient]\nslope = 0.3\n"),
      {":7: effects.cbd_gradient.slope is 0.3", "the structure has its carbon-binder"});
}

TEST(Recipe, FileMustExistAndBeWhole) {
  EXPECT_THROW(read_recipe("/no/such/recipe.toml"), Failure);
  expect_all(message_for("[coating]\nloading_mg_cm2 = "), {"recipe.toml:2", "not valid TOML"});
}

} // namespace
