// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/compare/gap_page.h"
#include "diagnose/compare/gap.h"
#include "report/page.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {

extern const char *const kGapHtml;
namespace {

nlohmann::json number_or_null(double x) {
  return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json();
}

nlohmann::json table(const nlohmann::json &gap) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto &r : gap["where"])
    rows.push_back({{"condition", r["condition"]},
                    {"observable", r["observable"]},
                    {"stage", r["stage"]},
                    {"unit", shown_unit(r["unit"])},
                    {"measured", shown(r["measured"], "{:.4g}")},
                    {"simulated", shown(r["simulated"], "{:.4g}")},
                    {"packings", r["packings"]},
                    {"residual", shown(r["residual"], "{:+.3g}")},
                    {"sd_measurement", shown(r["sd_measurement"], "{:.2g}")},
                    {"sd_seeds", shown(r["sd_seeds"], "{:.2g}")},
                    {"sd_pressure", shown(r["sd_pressure"], "{:.2g}")},
                    {"z", shown(r["z"], "{:+.1f}")},
                    {"share", shown(100.0 * r["share"].get<double>(), "{:.0f}")},
                    {"verdict", r["significant"] ? "beyond noise" : "within noise"}});
  return rows;
}

} // namespace

nlohmann::ordered_json to_json(const Gap &gap) {
  nlohmann::ordered_json where = nlohmann::ordered_json::array();
  for (const Residual &r : gap.rows) {
    where.push_back(to_json(static_cast<const Place &>(r)));
    where.back().update({{"measured", r.measured},
                         {"simulated", r.simulated},
                         {"packings", r.packings},
                         {"sd_measurement", r.sd_measurement},
                         {"sd_seeds", number_or_null(r.sd_seeds)},
                         {"sd_pressure", r.sd_pressure}});
  }
  nlohmann::ordered_json out =
      new_gap(gap.experiment, where, gap.threshold, gap.degrees_of_freedom);
  out["chi2"] = number_or_null(gap.chi2);
  out["p_value"] = gap.p_value;
  out["said"] = gap.said;
  out["not_said"] = gap.not_said;
  return out;
}

std::string gap_page(const nlohmann::ordered_json &ordered) {
  const nlohmann::json gap = ordered;
  report::Page page{kGapHtml, ordered};
  page.values = {{"table", table(gap)},
                 {"map", heat_map(gap["where"], gap["threshold"])},
                 {"threshold_text", shown(gap["threshold"], "{:.2f}")},
                 {"chi2_text", shown(gap["chi2"], "{:.1f}")},
                 {"p_text", shown(gap["p_value"], "{:.2g}")},
                 {"rows_text", fmt::format("{}", gap["where"].size())}};
  return report::to_html(page);
}

namespace {

/// A square of the map: how far, and which way; never by colour alone.
std::string colour_of(double z, double threshold) {
  if (std::fabs(z) <= threshold)
    return "#eef1f4";
  const bool strong = std::fabs(z) > 2.0 * threshold;
  return z > 0.0 ? (strong ? "#e58a6f" : "#f5c9b8") : (strong ? "#6ea6d8" : "#bcd9f2");
}

nlohmann::json square(const nlohmann::json &r, double threshold) {
  const double z = r["z"].is_number() ? r["z"].get<double>() : INFINITY;
  const std::string unit = r["unit"] == "%" ? "points" : shown_unit(r["unit"]);
  return {{"text", fmt::format("{}{} (z\u00a0{})", shown(r["residual"], "{:+.3g}"),
                               unit.empty() ? "" : "\u00a0" + unit, shown(r["z"], "{:+.1f}"))},
          {"colour", colour_of(z, threshold)}};
}

void add(std::vector<std::string> &list, const std::string &name) {
  if (std::find(list.begin(), list.end(), name) == list.end())
    list.push_back(name);
}

} // namespace

std::string shown(const nlohmann::json &number, const char *format) {
  return number.is_number() ? fmt::format(fmt::runtime(format), number.get<double>()) : "–";
}

std::string shown_unit(const std::string &unit) { return unit == "um" ? "µm" : unit; }

nlohmann::json heat_map(const nlohmann::json &where, double threshold,
                        const std::vector<std::string> &conditions) {
  std::vector<std::string> columns = conditions, others, observables;
  std::map<std::pair<std::string, std::string>, nlohmann::json> squares;
  for (const auto &row : where) {
    const std::string o = fmt::format("{}: {}", row["stage"].get<std::string>(),
                                      row["observable"].get<std::string>());
    add(observables, o);
    add(others, row["condition"]);
    squares[{o, row["condition"]}] = square(row, threshold);
  }
  std::sort(others.begin(), others.end());
  for (const std::string &c : others)
    add(columns, c);
  nlohmann::json out = {{"conditions", columns}, {"rows", nlohmann::json::array()}};
  for (const std::string &o : observables) {
    nlohmann::json row = {{"observable", o}, {"cells", nlohmann::json::array()}};
    for (const std::string &c : columns) {
      const auto hit = squares.find({o, c});
      row["cells"].push_back(hit == squares.end()
                                 ? nlohmann::json{{"text", "–"}, {"colour", "#ffffff"}}
                                 : hit->second);
    }
    out["rows"].push_back(row);
  }
  return out;
}

} // namespace calendem
