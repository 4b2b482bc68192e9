// SPDX-License-Identifier: GPL-2.0-or-later
// "How far" from an object made by hand.
#include "diagnose/page.h"
#include <gtest/gtest.h>

namespace {

using calendem::shrink_part;
using nlohmann::json;

json gap_of(double value, double low, double high) {
  return {{"value", value}, {"low90", low}, {"high90", high}};
}

json made_shrink() {
  json models = json::array();
  for (const auto &[role, hypothesis, value] :
       std::vector<std::tuple<std::string, std::string, double>>{{"before", "none", 8.0},
                                                                 {"after", "friction", 2.0},
                                                                 {"runner-up", "pre_cracks", 7.0},
                                                                 {"placebo", "friction off", 2.5}})
    models.push_back({{"role", role},
                      {"hypothesis", hypothesis},
                      {"parameters", {{"E_cbd", 2.5}}},
                      {"gap", gap_of(value, value - 1.0, value + 1.0)}});
  models[1]["predicted_gap"] = gap_of(1.0, 0.5, 10.0);
  json curves = json::array();
  for (const char *role : {"measured", "before", "after", "placebo"})
    for (const char *condition : {"p80", "p150"})
      curves.push_back({{"condition", condition},
                        {"role", role},
                        {"displacement_um", {0, 1, 2}},
                        {"pressure_MPa", {0, 20, 80}}});
  return {{"shrink",
           {{"train", json::array({"p30"})},
            {"held_out", {"p80", "p150"}},
            {"models", models},
            {"shrinkage", {{"value", 0.75}, {"low90", 0.6}, {"high90", 0.85}, {"predicted", 0.8}}},
            {"observables",
             {{{"condition", "p80"},
               {"name", "porosity"},
               {"measured", 30.0},
               {"sd", 0.5},
               {"before", 34.0},
               {"after", 30.4}},
              {{"condition", "p150"},
               {"name", "porosity"},
               {"measured", 25.0},
               {"sd", 0.5},
               {"before", 30.0},
               {"after", 26.5}}}},
            {"curves", curves}}}};
}

std::string text_of(const json &words) { return words.dump(); }

TEST(ShrinkPart, IsDrawnOnlyWhereRerunsWereMade) {
  EXPECT_TRUE(shrink_part(json::object()).is_null());
  EXPECT_TRUE(shrink_part({{"shrink", nullptr}}).is_null());
  EXPECT_TRUE(shrink_part({{"shrink", json::object()}}).is_null());
  EXPECT_FALSE(shrink_part(made_shrink()).is_null());
}

TEST(ShrinkPart, TheBaseModelAloneIsJudgedByItself) {
  json gap = made_shrink();
  json &shrink = gap["shrink"];
  shrink["models"] = json::array({shrink["models"][0]});
  shrink.erase("shrinkage");
  for (json &o : shrink["observables"])
    o.erase("after");
  const json part = shrink_part(gap);
  EXPECT_EQ(part["observables"][0]["after"], "–");
  EXPECT_EQ(part["observables"][0]["after_off"], "–");
  const std::string words = text_of(part["words"]);
  EXPECT_NE(words.find("Only the base model was run again"), std::string::npos);
  EXPECT_NE(words.find("Not met within two standard deviations: p80: porosity"), std::string::npos);
  EXPECT_EQ(words.find("nan"), std::string::npos);
}

TEST(ShrinkPart, BarsShareOneScaleWithTheirIntervals) {
  const json part = shrink_part(made_shrink());
  ASSERT_EQ(part["bars"].size(), 4u); // the scale ends at 10, of what was predicted
  EXPECT_EQ(part["bars"][0]["width"], "192.0");
  EXPECT_EQ(part["bars"][1]["width"], "48.0");
  EXPECT_EQ(part["bars"][1]["whisker"]["low"], "24.0");
  EXPECT_EQ(part["bars"][1]["predicted"], "24.0");
  EXPECT_FALSE(part["bars"][0].contains("predicted"));
  EXPECT_EQ(part["bars"][0]["parameters"], "E_cbd = 2.5");
  EXPECT_EQ(part["shrinkage"]["value"], "75");
}

TEST(ShrinkPart, SaysWhatStaysAndWhetherAnotherDidAsWell) {
  const std::string words = text_of(shrink_part(made_shrink())["words"]);
  for (const char *part : {"Still unexplained: 25 %", "The runner-up (pre_cracks) leaves 7.\"",
                           "The placebo (friction off) leaves 2.5: not clearly more",
                           "Not met within two standard deviations: p150: porosity."})
    EXPECT_NE(words.find(part), std::string::npos) << part << "\nis not in\n" << words;
  json met = made_shrink();
  met["shrink"]["observables"][1]["after"] = 25.4;
  EXPECT_NE(text_of(shrink_part(met)["words"]).find("Every observable is met"), std::string::npos);
}

TEST(ShrinkPart, OneChartForEachCondition) {
  EXPECT_EQ(shrink_part(made_shrink())["charts"][0]["title"], "p80: pressure against displacement");
  const auto charts = calendem::rerun_charts(made_shrink());
  ASSERT_EQ(charts.size(), 2u);
  std::vector<std::string> roles;
  for (const auto &series : charts[1].series)
    roles.push_back(series.name);
  EXPECT_EQ(roles, (std::vector<std::string>{"measured", "before", "after", "placebo"}));
  EXPECT_TRUE(calendem::rerun_charts(json::object()).empty());
}

TEST(ShrinkPart, WhatIsMissingIsLeftOut) {
  json little = made_shrink();
  for (const char *key : {"train", "held_out", "shrinkage", "observables", "curves"})
    little["shrink"].erase(key);
  little["shrink"]["models"][0]["gap"].erase("low90");
  const json part = shrink_part(little);
  EXPECT_FALSE(part.contains("shrinkage"));
  EXPECT_FALSE(part["has_observables"]);
  EXPECT_TRUE(part["charts"].empty());
  EXPECT_FALSE(part["bars"][0].contains("whisker"));
}

TEST(ShrinkPart, LabelImagesStandBesideTheModels) {
  EXPECT_TRUE(shrink_part(made_shrink())["images"].is_null());
  json gap = made_shrink();
  gap["shrink"]["images"] = {{"rows",
                              {{{"condition", "p80"},
                                {"name", "macro porosity, image after"},
                                {"unit", "%"},
                                {"measured", 20.0},
                                {"sd", 0.25},
                                {"before", {{"mean", 22.0}, {"sd", 0.5}, {"off", 3.58}}},
                                {"after", {{"mean", 20.5}, {"sd", 0.5}}}}}},
                             {"without", {"p150: no frame"}}};
  const json images = shrink_part(gap)["images"], row = images["rows"][0];
  EXPECT_EQ(row["name"], "macro porosity, image after, %");
  EXPECT_EQ(row["measured"], "20.00");
  EXPECT_EQ(row["before"], "22.00");
  EXPECT_EQ(row["before_off"], "+3.6");
  EXPECT_EQ(row["after"], "20.50");
  EXPECT_EQ(row["after_off"], "–"); // no deviation is known
  EXPECT_EQ(images["without"][0], "p150: no frame");
}

} // namespace
