// SPDX-License-Identifier: GPL-2.0-or-later
// The whole way on a table from formulas: an effect is named, and the page says so.
#include "base/messages.h"
#include "base/provenance.h"
#include "compare/gap.h"
#include "diagnose/diagnose.h"
#include "diagnose/page.h"
#include "support/made_bank.h"
#include "support/page.h"
#include "support/test_folder.h"
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using namespace calendem_test;

/// Friction of 0.4 on a packing that the bank does not have, a large sample.
const Diagnosed &friction() {
  static const Diagnosed d = [] {
    SharedModels models;
    Experiment e = made_experiment({"friction", 0, 99, {1.4, 260.0}, 0.4});
    e.name = "friction </script><b>";
    return diagnosed(e, made_bank(), 1e4, models);
  }();
  return d;
}

TEST(DiagnosisPage, TheEffectIsNamedWithItsValueInTheKeysUnit) {
  const nlohmann::ordered_json &gap = friction().gap;
  EXPECT_EQ(gap["which"]["claim"], "friction") << gap["which"].dump(1);
  EXPECT_EQ(gap["which"]["headline"], "Explained by friction");
  const auto &fitted = gap["fitted_effects"][0];
  EXPECT_EQ(fitted["keys"][0], "material.am.friction");
  EXPECT_LT(fitted["value_low90"], 0.4);
  EXPECT_GT(fitted["value_high90"], 0.4);
}

// After is the better of the two; both are in the observables' units, as measured is.
TEST(DiagnosisPage, PredictionsStandBesideWhatWasMeasured) {
  double before = 0.0, after = 0.0;
  const auto &predictions = friction().gap["predictions"];
  EXPECT_EQ(predictions["best"], "friction");
  for (const auto &o : predictions["observables"]) {
    const double measured = o["measured"], sd = o["sd"];
    before += std::pow((o["base"].get<double>() - measured) / sd, 2);
    after += std::pow((o["best"].get<double>() - measured) / sd, 2);
    EXPECT_NEAR(o["best"].get<double>(), measured, 3.0 * sd) << o.dump();
  }
  EXPECT_GT(before, 4.0 * after);
  EXPECT_EQ(predictions["observables"][0]["unit"], "%");
}

TEST(DiagnosisPage, WhereHasUnitsAndTheListOfWhatTheBankCannotPredict) {
  for (const auto &row : friction().gap["where"])
    EXPECT_TRUE(row.contains("unit")) << row.dump();
  EXPECT_EQ(friction().gap["which"]["not_in_bank"].size(), 7u);
}

/// Names of an object that do not stand in backquotes in the text.
std::string not_in(const std::string &page, const nlohmann::ordered_json &object) {
  std::string out;
  for (const auto &[name, value] : object.items())
    if (page.find("`" + name + "`") == std::string::npos)
      out += name + " ";
  return out;
}

TEST(GapFile, EveryNameIsOnItsPage) {
  const nlohmann::ordered_json &gap = friction().gap;
  const std::string page = text_of_file(CALENDEM_SOURCE_DIR "/docs/reference/gap.md");
  EXPECT_EQ(not_in(page, gap) + not_in(page, gap["where"][0]) + not_in(page, gap["which"]), "");
}

// Requirement: both verbs write one schema; compare has all of it, empty where it finds nothing out.
TEST(GapFile, CompareWritesTheSameNames) {
  const nlohmann::ordered_json &diagnosed = friction().gap;
  Gap gap;
  gap.rows.push_back({});
  const nlohmann::ordered_json compared = to_json(gap);
  const std::string page = text_of_file(CALENDEM_SOURCE_DIR "/docs/reference/gap.md");
  EXPECT_EQ(not_in(page, compared) + not_in(page, compared["where"][0]), "");
  for (const char *name : {"experiment", "where", "threshold", "scatter", "which", "shrink", "said",
                           "not_said", "provenance"}) {
    EXPECT_TRUE(diagnosed.contains(name) && compared.contains(name)) << name;
    EXPECT_TRUE(diagnosed[name].type() == compared[name].type() || compared[name].is_null())
        << name;
  }
  const nlohmann::ordered_json place = to_json(Place());
  for (const auto &[name, value] : place.items())
    for (const auto &row : {diagnosed["where"][0], compared["where"][0]})
      EXPECT_TRUE(row.contains(name)) << name;
}

TEST(GapFile, WhatIsNoDiagnosisIsRefused) {
  const std::string file = (test_folder() / "gap.json").string();
  const auto refusal = [&](const std::string &text) -> std::string {
    write_file(file, text);
    try {
      read_diagnosis(file);
    } catch (const Failure &f) {
      return f.exit_status() == kBadInput ? f.what() : "another exit status";
    }
    return "";
  };
  const std::string whole = friction().gap.dump();
  EXPECT_EQ(refusal(whole), "");
  EXPECT_NE(refusal(whole.substr(0, whole.size() / 2)).find("cut or damaged"), std::string::npos);
  EXPECT_NE(refusal(to_json(Gap()).dump()).find("it has no 'which'"), std::string::npos);
}

TEST(DiagnosisPage, HoldsTheClaimAndNothingFromElsewhere) {
  const std::string whole = diagnosis_page(friction().gap), page = without_scripts(whole);
  nlohmann::json data = data_in(whole);
  data.erase("charts");
  EXPECT_EQ(data, nlohmann::json::parse(friction().gap.dump()));
  for (const char *part :
       {"Explained by friction", "Switch it on", "p60: cracked bodies", "thickness_zero",
        "displacement while the pressure rises: p30, p60", "X-ray tomogram", "Q²"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  for (const char *part : {"{{", "http:", "https:", " src=", "<b>", "How far"})
    EXPECT_EQ(page.find(part), std::string::npos) << part;
}

TEST(DiagnosisPage, SameBytesTwice) {
  SharedModels models;
  const Experiment e = made_experiment({"", 0, 99, {1.4, 260.0}, 0.0});
  const Diagnosed one = diagnosed(e, made_bank(), 1e4, models);
  SharedModels others;
  const Diagnosed two = diagnosed(e, made_bank(), 1e4, others);
  EXPECT_EQ(one.gap.dump(), two.gap.dump());
  EXPECT_EQ(diagnosis_page(one.gap), diagnosis_page(two.gap));
}

// The truth is 0.4, the parameters those of the table.
TEST(DiagnosisPage, EveryEffectHasARangeOrALimitOverAllExplanations) {
  const auto &effects = friction().gap["which"]["effects"];
  ASSERT_EQ(effects.size(), 2u);
  EXPECT_EQ(effects[0]["effect"], "friction");
  EXPECT_GT(effects[0]["inclusion"], 0.8);
  EXPECT_LT(effects[0]["value_low95"], 0.4);
  EXPECT_GT(effects[0]["value_high95"], 0.4);
  EXPECT_LT(effects[1]["inclusion"], 0.5);
  EXPECT_TRUE(effects[1]["two_sided"]); // thickness_zero
  EXPECT_NE(effects[1]["said"].get<std::string>().find(" between "), std::string::npos)
      << effects[1].dump();
  for (const auto &p : friction().gap["parameters"]) {
    EXPECT_LE(p["low95"], p["low90"]) << p.dump();
    EXPECT_GE(p["high95"], p["high90"]) << p.dump();
  }
  const std::string page = diagnosis_page(friction().gap);
  for (const char *part :
       {"Every effect: probability and limits", "Budget of uncertainty", "reading 0.1, "})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST(RankingPart, BarsAreProbabilitiesAndTheRestIsCounted) {
  nlohmann::json which = {{"claim", "b"}, {"evidence", nlohmann::json::array()}};
  for (const auto &[name, p] : std::vector<std::pair<std::string, double>>{
           {"b", 0.9}, {"none", 0.06}, {"unknown", 0.03}, {"c", 0.006}, {"d", 0.003}, {"e", 0.001}})
    which["evidence"].push_back({{"hypothesis", name},
                                 {"probability", p},
                                 {"prior", 0.1},
                                 {"adequacy_p", 0.5},
                                 {"place", name == "unknown" ? "dwell" : ""}});
  which["sensitivity"] = {
      {{"priors", "none halved"}, {"claim", "b"}, {"probability", 0.93}},
      {{"priors", "none doubled"}, {"claim", "undecided"}, {"probability", 0.7}}};
  const nlohmann::json part = ranking_part({{"which", which}});
  ASSERT_EQ(part["bars"].size(), 4u);
  EXPECT_EQ(part["bars"][0]["kind"], "claimed");
  EXPECT_EQ(part["bars"][0]["width"], "90.0");
  EXPECT_EQ(part["bars"][2]["name"], "unknown: dwell");
  EXPECT_EQ(part["bars"][2]["fit"], "–");
  EXPECT_EQ(part["rest"], "2 more share 0.4 %.");
  EXPECT_EQ(part["claimed_from"], "80");
  EXPECT_EQ(part["least_p"], "0.05");
  EXPECT_EQ(part["steadiness"], "Other priors, other claims: none doubled: undecided.");
}

TEST(PredictionsPart, StripsAreScaledToTheFarthestAndCurvesAreCharts) {
  const auto row = [](double coordinate, const char *name, double measured) {
    return nlohmann::json{{"observable", name},
                          {"stage", "compression"},
                          {"condition", "p30"},
                          {"name", name},
                          {"unit", "um"},
                          {"coordinate", coordinate},
                          {"measured", measured},
                          {"sd_measurement", 1.0},
                          {"base", measured + 4.0},
                          {"best", measured - 1.0},
                          {"pressure_MPa", 10.0 + coordinate}};
  };
  nlohmann::json gap = {
      {"predictions",
       {{"best", "friction"},
        {"observables", {row(0, "thickness", 50), row(0, "curve", 1), row(1, "curve", 2)}}}}};
  nlohmann::json part = predictions_part(gap);
  ASSERT_EQ(part["strips"].size(), 1u);
  EXPECT_EQ(part["strips"][0]["at_base"], "190.0"); // 4 of 4 to the right of the middle, 100
  EXPECT_EQ(part["strips"][0]["at_best"], "77.5");  // 1 of 4 to the left
  EXPECT_EQ(part["strips"][0]["wide1"], "45.0");    // two standard deviations, 1 of 4 each
  ASSERT_EQ(part["charts"].size(), 1u);
  EXPECT_EQ(prediction_charts(gap)[0].series[1].name, "friction");
  EXPECT_EQ(part["charts"][0]["title"], "p30: curve, compression"); // not that of the release
  gap["predictions"]["best"] = "none";
  part = predictions_part(gap);
  EXPECT_FALSE(part["has_best"]);
  EXPECT_TRUE(part["strips"][0]["at_best"].is_null());
}

TEST(ConflictPart, SmallProbabilitiesArePowersOfTen) {
  const nlohmann::json gap = {
      {"conflict_matrix", {{"blocks", {"a", "b"}}, {"p", {{0.5, 4.1e-8}, {4.1e-8, 0.5}}}}},
      {"conflicts", {{{"one", "a"}, {"other", "b"}, {"p", 4.1e-8}}}}};
  const nlohmann::json part = conflict_part(gap);
  EXPECT_EQ(part["rows"][1]["cells"][0]["text"], "4.1·10⁻⁸ !");
  EXPECT_EQ(part["found"][0], "a and b: each can be met, both together not (p = 4.1·10⁻⁸).");
}

TEST(DriftPart, StagesThatAskForOtherParametersAreApart) {
  const nlohmann::json gap = {
      {"parameters", {{{"parameter", "E"}}, {{"parameter", "s"}}}},
      {"stages",
       {{{"stage", "compression"}, {"scores", {1.5, 0.5}}, {"sd", {0.4, 0.4}}},
        {{"stage", "relaxation"}, {"scores", {0.0, 0.0}}, {"sd", {0.3, 0.3}}}}}};
  const nlohmann::json part = drift_part(gap); // 1.5 and 0.5 over 0.5
  EXPECT_EQ(part["rows"][0]["verdict"], "apart");
  EXPECT_EQ(part["rows"][1]["verdict"], "agree");
}

TEST(ConfoundingPart, AnEffectThatNoAmplitudeShowsIsInvisible) {
  const nlohmann::json gap = {
      {"which",
       {{"indistinguishable", nlohmann::json::array({nlohmann::json::array({"a", "b"})})}}},
      {"confounding",
       {{"effects", nlohmann::json::array({"a"})},
        {"cosine", nlohmann::json::array({nlohmann::json::array({1.0})})},
        {"absorbed", nlohmann::json::array({0.25})},
        {"detection_limit", nlohmann::json::array({{{"effect", "a"},
                                                    {"rival", "none"},
                                                    {"keys", nlohmann::json::array({"k"})},
                                                    {"value", nullptr}}})}}},
      {"emulators", nlohmann::json::array({{{"effect", "a"}, {"poor", true}}})}};
  const nlohmann::json part = confounding_part(gap);
  EXPECT_EQ(part["limits"][0]["claim"], "too poor");
  nlohmann::json base_poor = gap;
  base_poor["emulators"][0]["effect"] = "base";
  EXPECT_EQ(confounding_part(base_poor)["limits"][0]["claim"], "too poor");
  base_poor["emulators"][0]["poor"] = false;
  EXPECT_EQ(confounding_part(base_poor)["limits"][0]["claim"], "good enough");
  EXPECT_EQ(part["limits"][0]["value"], "nowhere");
  EXPECT_EQ(part["limits"][0]["absorbed"], "25");
  EXPECT_EQ(part["alike"][0], "a, b");
}

} // namespace
