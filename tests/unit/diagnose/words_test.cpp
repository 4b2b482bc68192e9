// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/diagnose.h"
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using Json = nlohmann::ordered_json;

Json claimed(const std::string &claim) {
  return {{"which",
           {{"claim", claim},
            {"why", "Because."},
            {"set95", {"friction", "none"}},
            {"next_measurement",
             {{"what", "cracks of p30"}, {"now", 0.5}, {"expected_probability", 0.83}}},
            {"evidence", Json::array({{{"hypothesis", "unknown"}, {"place", "relaxation"}}})}}},
          {"where", Json::array({{{"observable", "total porosity"},
                                  {"stage", "relaxation"},
                                  {"condition", "p30"},
                                  {"unit", "%"},
                                  {"residual", 1.2},
                                  {"z", 4.0},
                                  {"share", 0.6},
                                  {"significant", true}}})},
          {"fitted_effects", Json::array()}};
}

Json fitted(const std::string &effect, const std::string &key) {
  return {{"effect", effect},
          {"keys", Json::array({key})},
          {"value", 0.3},
          {"value_low90", 0.2},
          {"value_high90", 0.45}};
}

std::string all_of(const Json &words) { return words.dump(); }

void expect_parts(const Json &gap, const std::vector<std::string> &parts) {
  const std::string text = all_of(claim_in_words(gap));
  for (const std::string &part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

TEST(ClaimInWords, EveryClaimSaysWhatItMeansAndWhatToDo) {
  expect_parts(claimed("none"), {"No gap beyond noise", "not excluded"});
  expect_parts(claimed("noise"),
               {"errors of the measurement are understated", "Measure again", "looks the same"});
  expect_parts(claimed("unknown"),
               {"no known effect", "most likely in: relaxation", "Do not recalibrate"});
  Json alike = claimed("unknown");
  alike["which"]["evidence"][0]["place"] = "like friction";
  expect_parts(alike, {"It acts most like friction, but friction does not fit."});
  expect_parts(claimed("undecided"), {"friction; none", "Measure: cracks of p30", "83 %", "50 %"});
}

TEST(ClaimInWords, UndecidedSaysWhetherAnythingStandsOutAndCountsALongList) {
  Json gap = claimed("undecided");
  EXPECT_EQ(all_of(claim_in_words(gap)).find("out of the noise"), std::string::npos);
  gap["where"][0]["significant"] = false;
  gap["which"]["set95"] = {"a", "b", "c", "d", "e", "f", "g"};
  expect_parts(gap, {"No difference is significant", "a; b; c; d; e; 2 more."});
}

TEST(ClaimInWords, AnUninformativeMeasurementIsNotProposed) {
  Json gap = claimed("undecided");
  gap["which"]["next_measurement"]["expected_probability"] = 0.505;
  EXPECT_EQ(all_of(claim_in_words(gap)).find("Measure: "), std::string::npos);
  gap["which"]["next_measurement"] = {{"what", ""}, {"expected_probability", 0.0}};
  EXPECT_EQ(all_of(claim_in_words(gap)).find("Measure: "), std::string::npos);
}

TEST(ClaimInWords, AnEffectIsSwitchedOnAndAnInstrumentIsChecked) {
  Json gap = claimed("friction");
  gap["fitted_effects"] = Json::array({fitted("friction", "material.am.friction")});
  expect_parts(gap, {"friction explains the gap", "Coulomb friction", "Switch it on",
                     "material.am.friction = 0.3 (90 %: 0.2 to 0.45)"});
  gap["which"]["claim"] = "thickness_zero";
  gap["fitted_effects"] =
      Json::array({fitted("thickness_zero", "effects.thickness_zero.offset_um")});
  expect_parts(gap, {"Check the instrument: effects.thickness_zero.offset_um = 0.3"});
  gap["which"]["claim"] = "friction + thickness_zero";
  gap["fitted_effects"].push_back(fitted("friction", "material.am.friction"));
  expect_parts(gap, {"explain the gap together", "Switch it on"});
}

// A reciprocal amplitude: 1/GPa. The strongest effect is the smallest yield pressure.
TEST(PutInWords, AmplitudesBecomeValuesOfTheKeyWithTheSmallerEndFirst) {
  Json gap = claimed("nmc_plasticity");
  gap["predictions"] = {{"best", "nmc_plasticity"}, {"observables", Json::array()}};
  gap["fitted_effects"] = Json::array({{{"effect", "nmc_plasticity"},
                                        {"parameter", "amplitude"},
                                        {"mode", 0.25},
                                        {"low90", 0.2},
                                        {"high90", 0.5}}});
  gap["confounding"]["detection_limit"] =
      Json::array({{{"effect", "nmc_plasticity"}, {"amplitude", nullptr}, {"rival", "none"}},
                   {{"effect", "friction"}, {"amplitude", 0.199}, {"rival", "none"}}});
  BankTable bank;
  bank.spec.prices[4].hours = 9.0; // the unloading curve, which this bank lacks
  put_in_words({}, bank, gap);
  const Json &fitted = gap["fitted_effects"][0];
  EXPECT_EQ(fitted["keys"][0], "effects.nmc_plasticity.yield_pressure_GPa");
  EXPECT_NEAR(fitted["value"].get<double>(), 4.0, 1e-12);
  EXPECT_NEAR(fitted["value_low90"].get<double>(), 2.0, 1e-12);
  EXPECT_NEAR(fitted["value_high90"].get<double>(), 5.0, 1e-12);
  EXPECT_TRUE(gap["confounding"]["detection_limit"][0]["value"].is_null());
  EXPECT_NEAR(gap["confounding"]["detection_limit"][1]["value"].get<double>(), 0.2, 1e-12);
  EXPECT_EQ(gap["which"]["not_in_bank"][0]["cost"], 9.0);
  EXPECT_EQ(gap["which"]["headline"], "nmc_plasticity explains the gap");
  EXPECT_EQ(gap["said"][0], "p30, total porosity (relaxation): the recalibrated base model is 1.2 "
                            "points too high (z = 4.0, 60 % of the gap).");
}

} // namespace
