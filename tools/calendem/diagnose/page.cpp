// SPDX-License-Identifier: GPL-2.0-or-later
// gap.html: what gap.json holds, in tables and charts.
#include "report/page.h"
#include "base/shown.h"
#include "compare/gap.h"
#include "diagnose/diagnosis.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

extern const char *const kDiagnosisHtml;

using Json = nlohmann::ordered_json;
using nlohmann::json;
namespace {

std::string in_percent(const Json &share) {
  return shown(kPercent * share.get<double>(), "{:.1f}");
}

std::string range(const Json &of) {
  return fmt::format("{} ({} to {})", shown(of["value"], "{:.3g}"), shown(of["low90"], "{:.3g}"),
                     shown(of["high90"], "{:.3g}"));
}

/// "yield_pressure_GPa" of "effects.nmc_plasticity.yield_pressure_GPa".
std::string last_name(const std::string &key) { return key.substr(key.rfind('.') + 1); }

json change_rows(const Json &which) {
  std::vector<Json> changes(which["changes"].begin(), which["changes"].end());
  std::stable_sort(changes.begin(), changes.end(), [](const Json &a, const Json &b) {
    return a["probability"] > b["probability"];
  });
  json out = json::array();
  for (const Json &c : changes) {
    const bool named =
        std::find(which["named"].begin(), which["named"].end(), c["name"]) != which["named"].end();
    json row = {{"name", c["name"]},
                {"kind", named ? "claimed" : "other"},
                {"percent", in_percent(c["probability"])},
                {"width", in_percent(c["probability"])},
                {"prior", in_percent(c["prior"])},
                {"bayes", shown(c["bayes_factor"], "{:.2g}")},
                {"value", "–"}};
    if (c.contains("amplitude") && !c["amplitude"].is_null())
      row["value"] = fmt::format("{} {}", last_name(c["amplitude"]["key"]), range(c["amplitude"]));
    out.push_back(row);
  }
  return out;
}

json set_rows(const Json &which) {
  json out = json::array();
  for (const Json &s : which["set95"]) {
    const auto names = s["changes"].get<std::vector<std::string>>();
    out.push_back({{"changes", names.empty() ? "none" : fmt::format("{}", fmt::join(names, " + "))},
                   {"percent", in_percent(s["probability"])}});
  }
  return out;
}

json measurement_rows(const Json &which) {
  json out = json::array();
  for (const Json &m : which["measurements"])
    out.push_back({{"what", fmt::format("{} after {:.3g} MPa", m["observable"].get<std::string>(),
                                        m["pressure_MPa"].get<double>())},
                   {"sd", fmt::format("{:.2g} {}", m["sd"].get<double>(),
                                      shown_unit(m["unit"].get<std::string>()))},
                   {"probability", in_percent(m["expected_probability"])},
                   {"information", shown(m["information"], "{:.2f}")}});
  return out;
}

json parameter_rows(const Json &gap) {
  json out = json::array();
  for (const Json &p : gap["parameters"])
    out.push_back(
        {{"name", p["parameter"]}, {"model", range(p["model"])}, {"all", range(p["all"])}});
  return out;
}

bool is_curve(const Json &row) { return row["coordinate"].get<double>() > 0.0; }

json reading_rows(const Json &gap) {
  json out = json::array();
  for (const Json &p : gap["predictions"]) {
    if (is_curve(p))
      continue;
    const std::string digits = format_by_error(p["sd"]);
    out.push_back({{"condition", p["condition"]},
                   {"name", fmt::format("{}{}", p["observable"].get<std::string>(),
                                        p["unit"] == "" ? "" : ", " + shown_unit(p["unit"]))},
                   {"measured", shown(p["measured"], digits.c_str())},
                   {"sd", shown(p["sd"], digits.c_str())},
                   {"model", shown(p["model"], digits.c_str())},
                   {"explained", shown(p["explained"], digits.c_str())}});
  }
  return out;
}

report::Chart empty_chart(const std::string &title, const std::string &unit, std::size_t number) {
  report::Chart c;
  c.id = fmt::format("curve_{}", number);
  c.title = title;
  c.x_label = "Pressure (MPa)";
  c.y_label = fmt::format("Displacement{}", unit == "um" ? " (µm)" : " / solid thickness");
  c.from_zero = false;
  c.note =
      "Points of the loading, and of the release from the same pressure. Both models are shifted "
      "by the error of the first contact that fits best; error bars: one standard deviation of "
      "all other errors.";
  const char *const names[] = {"measured", "model, recalibrated", "with the leading explanation"};
  for (std::size_t k = 0; k < 3; ++k) {
    report::Series s;
    s.name = names[k];
    s.mark = report::Mark::points;
    s.symbol = report::kSeriesSymbols[k];
    s.colour = report::kSeriesColours[k];
    c.series.push_back(s);
  }
  return c;
}

void add_reading(const Json &p, report::Chart &chart) {
  const auto value = [&](const char *key) { return p[key].get<double>(); };
  const double y[] = {value("measured"), value("model") + value("zero"),
                      value("explained") + value("zero_explained")};
  for (std::size_t k = 0; k < 3; ++k) {
    chart.series[k].x.push_back(p["pressure_MPa"]);
    chart.series[k].y.push_back(y[k]);
  }
  const double sd = value("sd"), zero = value("zero_sd");
  chart.series[0].y_error.push_back(std::sqrt(std::max(0.0, sd * sd - zero * zero)));
}

/// A condition's curve: measured, and as both models have it.
std::vector<report::Chart> curve_charts(const Json &gap) {
  std::vector<report::Chart> out;
  for (const Json &p : gap["predictions"]) {
    if (!is_curve(p))
      continue;
    const std::string title = fmt::format("{}: {}", p["condition"].get<std::string>(),
                                          p["observable"].get<std::string>());
    auto chart = std::find_if(out.begin(), out.end(),
                              [&](const report::Chart &c) { return c.title == title; });
    if (chart == out.end())
      chart = out.insert(out.end(), empty_chart(title, p["unit"], out.size() + 1));
    add_reading(p, *chart);
  }
  return out;
}

/// Models that were run; null: none was.
json run_rows(const Json &runs) {
  if (runs.is_null())
    return nullptr;
  json rows = json::array();
  for (const Json &m : runs["models"])
    rows.push_back({{"model", m["role"]},
                    {"runs", m["runs"]},
                    {"gap", shown(m["gap"], "{:.2f}")},
                    {"predicted", shown(m["predicted_gap"], "{:.2f}")},
                    {"points", shown(m["porosity_points"], "{:.1f}")}});
  return {{"rows", rows}, {"in_words", runs["in_words"]}};
}

} // namespace

std::string diagnosis_page(const Json &gap) {
  report::Page page{kDiagnosisHtml, gap};
  page.charts = curve_charts(gap);
  page.values = {{"map", heat_map(json(gap["where"]), gap["threshold"])},
                 {"threshold_text", shown(gap["threshold"], "{:.1f}")},
                 {"change_rows", change_rows(gap["which"])},
                 {"set_rows", set_rows(gap["which"])},
                 {"measurement_rows", measurement_rows(gap["which"])},
                 {"now", in_percent(gap["which"]["now"])},
                 {"parameter_rows", parameter_rows(gap)},
                 {"reading_rows", reading_rows(gap)},
                 {"has_charts", !page.charts.empty()},
                 {"run", run_rows(gap["shrink"]["runs"])}};
  return report::to_html(page);
}

} // namespace calendem
