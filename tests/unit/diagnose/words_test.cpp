// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/diagnose.h"
#include <cmath>
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using Json = nlohmann::ordered_json;

Json claimed(const std::string &claim) {
  return {{"which",
           {{"claim", claim},
            {"why", "Because."},
            {"set95", {"friction", "none"}},
            {"probability", {{"none", 0.29}, {"friction", 0.2}, {"unknown", 0.1}}},
            {"inclusion", {{"friction", 0.85}, {"thickness_zero", 0.3}}},
            {"groups", Json::array({{{"effects", {"friction", "thickness_zero"}},
                                     {"with_none", false},
                                     {"probability", 0.53},
                                     {"acts_like", 0.08}}})},
            {"effects", Json::array()},
            {"beside", Json::array()},
            {"short_runs", Json::array()},
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
          {"value_low95", 0.2},
          {"value_high95", 0.45},
          {"limited", true},
          {"said", effect + ": " + key + " below 0.45 (95 %)"}};
}

std::string all_of(const Json &words) { return words.dump(); }

void expect_parts(const Json &gap, const std::vector<std::string> &parts) {
  const std::string text = all_of(claim_in_words(gap));
  for (const std::string &part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

TEST(ClaimInWords, EveryClaimSaysWhatItMeansAndWhatToDo) {
  Json nothing = claimed("none");
  expect_parts(nothing, {"nothing to see", "Nothing that these data could show",
                         "that nothing acts is 29 %", "not excluded", "limit no effect"});
  nothing["which"]["effects"] = Json::array({fitted("friction", "material.am.friction")});
  expect_parts(nothing, {"friction: material.am.friction below 0.45 (95 %). Others"});
  expect_parts(claimed("noise"), {"explained", "Explained by errors larger than stated",
                                  "Measure again", "looks the same"});
  expect_parts(claimed("unknown"), {"something else", "Something that no model here has",
                                    "most likely in: relaxation", "Do not recalibrate"});
  Json alike = claimed("unknown");
  alike["which"]["evidence"][0]["place"] = "like friction";
  expect_parts(alike, {"It acts most like friction, but friction does not fit."});
  Json beyond = claimed("undecided");
  beyond["which"]["short_runs"] =
      Json::array({{{"effect", "friction"}, {"rival", "cbd_collapse"}}});
  expect_parts(beyond, {"; more of cbd_collapse than the bank has run",
                        "The gap is beyond what the bank has run"});
  expect_parts(claimed("undecided"),
               {"one of these",
                "One of these: friction or thickness_zero, or something that acts so (53 %); ",
                "; none of them (29 %); something that no model here has (2 %)", "friction; none",
                "Measure: cracks of p30", "83 %", "50 %"});
}

// The base model never suffices: it only fits.
TEST(ClaimInWords, NothingIsEverSaidToSuffice) {
  for (const char *claim : {"none", "noise", "unknown", "undecided", "friction"}) {
    const std::string text = all_of(claim_in_words(claimed(claim)));
    EXPECT_EQ(text.find("suffice"), std::string::npos) << text;
    EXPECT_EQ(text.find("No gap"), std::string::npos) << text;
  }
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
  Json &rows = gap["which"]["effects"];
  rows = Json::array({fitted("friction", "material.am.friction")});
  expect_parts(gap, {"Explained by friction", "Coulomb friction", "Switch it on",
                     "material.am.friction = 0.300 (95 %: 0.200 to 0.450)",
                     "Something else acts too with a probability of 65 %"});
  rows.push_back(fitted("thickness_zero", "effects.thickness_zero.offset_um"));
  gap["which"]["claim"] = "thickness_zero";
  expect_parts(gap, {"Check the instrument: effects.thickness_zero.offset_um = 0.300"});
  EXPECT_EQ(all_of(claim_in_words(gap)).find("Coulomb"), std::string::npos);
  gap["which"]["claim"] = "friction + thickness_zero";
  expect_parts(gap, {"Explained by friction + thickness_zero", "Switch it on"});
}

// An effect that acts with others is half an explanation.
TEST(ClaimInWords, WhatMayActBesideAClaimIsNamed) {
  Json gap = claimed("friction");
  gap["which"]["effects"] = Json::array({fitted("friction", "material.am.friction")});
  EXPECT_EQ(claim_in_words(gap)["headline"], "Explained by friction");
  gap["which"]["beside"] = Json::array({{{"effect", "pre_cracks"}, {"probability", 0.4}},
                                        {{"effect", "thickness_zero"}, {"probability", 0.1}},
                                        {{"effect", "body_size"}, {"probability", 0.01}}});
  EXPECT_EQ(claim_in_words(gap)["headline"],
            "Explained by friction, perhaps with pre_cracks or thickness_zero");
  expect_parts(gap,
               {"Beside it these data do not exclude: pre_cracks; thickness_zero; body_size."});
}

// Below what noise leaves, a cause neither shrinks nor enlarges the gap.
TEST(HowFarInWords, TheNoiseFloorStandsBesideTheGap) {
  const auto said = [](double before, double after) {
    return shrinkage_in_words({{"before", before}, {"after", after}, {"noise_floor", 35.0}});
  };
  EXPECT_EQ(said(5.2, 8.1),
            "Gap 5.2 before, 8.1 after; errors of measurement and sample alone leave "
            "up to 35.0 (95 %): these data show no gap here, nor that it shrinks "
            "or grows.");
  EXPECT_NE(said(80.0, 8.1).find("what is left may be nothing"), std::string::npos);
  EXPECT_EQ(said(80.0, 50.0).find("nothing"), std::string::npos);
  EXPECT_EQ(shrinkage_in_words({{"before", 50.0}, {"noise_floor", 35.0}}),
            "Gap 50.0; errors of measurement and sample alone leave up to 35.0 (95 %).");
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
      Json::array({{{"effect", "nmc_plasticity"}, {"amplitude", NAN}, {"rival", "none"}},
                   {{"effect", "friction"}, {"amplitude", 0.199}, {"rival", "none"}}});
  gap["which"]["effects"] = Json::array();
  for (const double inclusion : {0.3, 0.9})
    gap["which"]["effects"].push_back({{"effect", "nmc_plasticity"},
                                       {"inclusion", inclusion},
                                       {"amplitude", 0.25},
                                       {"low95", 0.2},
                                       {"high95", 0.5},
                                       {"below95", 0.4},
                                       {"two_sided", false},
                                       {"limited", true}});
  gap["emulators"] = Json::array();
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
  EXPECT_EQ(gap["which"]["headline"], "Explained by nmc_plasticity");
  EXPECT_EQ(gap["said"][0], "p30, total porosity (relaxation): the recalibrated base model is 1.2 "
                            "points too high (z = 4.0, 60 % of the gap).");
  const std::string key = "nmc_plasticity: effects.nmc_plasticity.yield_pressure_GPa ";
  EXPECT_EQ(gap["which"]["effects"][0]["said"], key + "above 2.5 (95 %)");
  EXPECT_EQ(gap["which"]["effects"][1]["said"], key + "= 4.00 (95 %: 2.00 to 5.00)");
}

TEST(PutInWords, APoorEmulatorSaysWhatFollowsForItsEffect) {
  Json gap = claimed("undecided");
  gap["predictions"]["observables"] = Json::array();
  gap["confounding"] = Json::object();
  gap["which"]["effects"] = Json::array({{{"effect", "friction"},
                                          {"inclusion", 0.9},
                                          {"amplitude", 0.25},
                                          {"low95", 0.2},
                                          {"high95", 0.5},
                                          {"below95", 0.4},
                                          {"two_sided", false},
                                          {"limited", true}}});
  gap["emulators"] =
      Json::array({{{"effect", "friction"}, {"poor", true}, {"error", 2.0}, {"runs", 32}}});
  put_in_words({}, BankTable(), gap);
  const std::string said = gap["which"]["effects"][0]["said"];
  for (const char *part : {"cannot be named", "after 32 runs", "off by 2 standard deviations",
                           "about 128 runs are needed"})
    EXPECT_NE(said.find(part), std::string::npos) << said;
}

} // namespace
