// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/page.h"

#include <limits>

#include <gtest/gtest.h>

#include "support/page.h"

using namespace calendem::report;
using calendem_test::data_in;

namespace {

Chart chart() {
  Chart chart;
  chart.id = "c";
  chart.title = "a < b";
  chart.y_label = "Pressure (MPa)";
  chart.right_label = "Broken (%)";
  Series area;
  area.mark = Mark::area;
  area.hatch = Hatch::dots;
  area.x = {0, 1, 2};
  area.y = {1, std::numeric_limits<double>::quiet_NaN(), 3};
  area.base = {0, 0, 1};
  Series points;
  points.mark = Mark::points;
  points.symbol = Symbol::diamond;
  points.right_axis = true;
  points.x = {1};
  points.y = {2};
  points.y_error = {0.5};
  chart.series = {area, points};
  chart.limits = {{5, "limit"}};
  return chart;
}

const char *const kTemplate = "<p>{{name}} {{own}}</p>{{#charts}}<i>{{title}}</i>{{/charts}}"
                              "<script type=\"application/json\" id=\"data\">{{{data}}}</script>";

} // namespace

// Requirement: a chart's data say all that is drawn; a value that is missing is null.
TEST(Chart, DataHoldNumbersAndLooks) {
  const nlohmann::json j = nlohmann::json::parse(to_json(chart()).dump());
  const auto &area = j["series"][0], &points = j["series"][1];
  EXPECT_EQ(area["mark"], "area");
  EXPECT_EQ(area["hatch"], "dots");
  EXPECT_TRUE(area["y"][1].is_null());
  EXPECT_EQ(area["base"], (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(area["axis"], "Pressure (MPa)");
  EXPECT_EQ(points["axis"], "Broken (%)");
  EXPECT_EQ(points["symbol"], "diamond");
  EXPECT_EQ(points["right"], true);
  EXPECT_EQ(points["y_error"], std::vector<double>{0.5});
  EXPECT_EQ(j["limits"][0]["label"], "limit");
}

// Requirement: the page holds the object it shows and the charts' numbers.
TEST(Page, HoldsItsObjectAndItsCharts) {
  const Page page{kTemplate, {{"name", "run"}, {"number", 3}}, {{"own", "words"}}, {chart()}};
  const std::string html = to_html(page);
  EXPECT_NE(html.find("<p>run words</p><i>a &lt; b</i>"), std::string::npos) << html;
  const nlohmann::json data = data_in(html);
  EXPECT_EQ(data, nlohmann::json::parse(data_of(page).dump()));
  EXPECT_EQ(data["number"], 3);
  EXPECT_EQ(data["charts"][0]["id"], "c");
  EXPECT_FALSE(data.contains("own"));
}

// Requirement: no text of a user ends the script that holds it.
TEST(Page, TextCannotBecomeMarkup) {
  const std::string name = "</script><b>";
  const std::string html = to_html({kTemplate, {{"name", name}}});
  EXPECT_EQ(html.find("<b>"), std::string::npos);
  EXPECT_EQ(data_in(html)["name"], name);
  EXPECT_FALSE(data_in(html).contains("charts"));
}

// Requirement: a provenance is rows of a name and a text; a path stays as it is.
TEST(Page, ProvenanceIsRows) {
  const nlohmann::ordered_json j = {{"calendem", "1.0"},
                                    {"model_hash", "aa"},
                                    {"runs", {{"build/my_run", "bb"}}},
                                    {"recipes",
                                     {{{"file", "my/a_s.toml"}, {"hash", "cc"}},
                                      {{"file", "b.toml"}, {"hash", "dd"}, {"table_hash", "ee"}}}}};
  std::string text;
  for (const auto &row : provenance_rows(j))
    text += row["name"].get<std::string>() + " = " + row["text"].get<std::string>() + "\n";
  EXPECT_EQ(text, "calendem = 1.0\nmodel hash = aa\nruns = build/my_run, bb\n"
                  "recipes = my/a_s.toml, cc\nrecipes = b.toml, dd\nrecipes: table hash = ee\n");
}
