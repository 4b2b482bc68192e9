// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/gap_file.h"
#include "base/shown.h"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

using Texts = std::vector<std::string>;

TEST(Shown, WritesAMinusForPeople) {
  EXPECT_EQ(shown(-0.46, "{:+.1f}"), "−0.5");
  EXPECT_EQ(shown(0.46, "{:+.1f}"), "+0.5");
  EXPECT_EQ(shown(nullptr, "{:.2f}"), "–");
  EXPECT_EQ(shown(-0.04, "{:+.1f}"), "0.0");
}

TEST(Shown, WritesPowersOfTenForPeople) {
  EXPECT_EQ(shown(4.1e-8, "{:.1e}"), "4.1·10⁻⁸");
  EXPECT_EQ(shown(-2e12, "{:.2g}"), "−2·10¹²");
  EXPECT_EQ(shown(0.041, "{:.2g}"), "0.041");
}

TEST(Shown, ValuesHaveTheDecimalsOfTheirError) {
  const auto both = [](double value, double error) {
    const std::string format = format_by_error(error);
    return shown(value, format.c_str()) + " ± " + shown(error, format.c_str());
  };
  EXPECT_EQ(both(27.75, 2.46), "27.8 ± 2.5");
  EXPECT_EQ(both(27.75, 0.23), "27.75 ± 0.23");
  EXPECT_EQ(both(27.75, 0.0998), "27.75 ± 0.10");
  EXPECT_EQ(both(-312.4, 25.0), "−312 ± 25");
  EXPECT_EQ(both(27.756, 0.0), "27.76 ± 0");
  EXPECT_EQ(format_by_error(nullptr), "{:.4g}");
}

TEST(Shown, NumbersSideBySideHaveTheSameDecimals) {
  EXPECT_EQ(shown_alike({30.04, 28.0, 32.2}), (Texts{"30.0", "28.0", "32.2"}));
  EXPECT_EQ(shown_alike({4.5, 2.1, 11.0}), (Texts{"4.5", "2.1", "11.0"}));
  EXPECT_EQ(shown_alike({0.0, -0.31}), (Texts{"0.000", "−0.310"}));
  EXPECT_EQ(shown_alike({339.0, 98.2}), (Texts{"339", "98"}));
}

// Over decades the decimals of the largest would leave nothing of the smallest.
TEST(Shown, NumbersOfManyDecadesKeepTheirDigits) {
  EXPECT_EQ(shown_alike({0.012, 10.0}), (Texts{"0.012", "10"}));
  EXPECT_EQ(shown_alike({2e8, 1e8}), (Texts{"2·10⁸", "1·10⁸"}));
}

TEST(Shown, ADifferenceHasItsUnit) {
  EXPECT_EQ(shown_difference(9.06, "%"), "9.06 points");
  EXPECT_EQ(shown_difference(-2.0, "um"), "−2 µm");
  EXPECT_EQ(shown_difference(0.138, "fraction"), "0.138");
}

TEST(Shown, ANameSaysItsUnitAtItsEnd) {
  EXPECT_EQ(in_words("porosity_before_percent").name, "porosity before");
  EXPECT_EQ(in_words("porosity_before_percent").unit, " %");
  EXPECT_EQ(in_words("loading_mg_cm2").unit, " mg/cm²");
  EXPECT_EQ(in_words("seed").name, "seed");
  EXPECT_EQ(in_words("_um").unit, ""); // a unit alone is no name
}

TEST(InWords, HasUnitsAndSignsForPeople) {
  Place p;
  p.condition = "p150";
  p.observable = "thickness";
  p.stage = "relaxation";
  p.unit = "um";
  p.residual = -4.8;
  p.z = -2.5;
  p.share = 1.0;
  EXPECT_EQ(in_words(to_json(p), "the simulation"), "p150, thickness (relaxation): the simulation "
                                                    "is 4.8 µm too low (z = −2.5, 100 % of the "
                                                    "gap).");
}

} // namespace
} // namespace calendem
