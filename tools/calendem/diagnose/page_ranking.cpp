// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/gap.h"
#include "diagnose/inference/which.h"
#include "diagnose/page.h"
#include "report/page.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

namespace {

using nlohmann::json;

constexpr double kHalf = 90.0, kMargin = 10.0; // px: half a strip, and what is left beside it

/// The rows of one observable, stage and condition.
using Block = std::vector<json>;

std::vector<Block> blocks_of(const json &rows) {
  std::vector<Block> blocks;
  for (const json &row : rows) {
    const auto mine = std::find_if(blocks.begin(), blocks.end(), [&](const Block &b) {
      return b[0]["observable"] == row["observable"] && b[0]["stage"] == row["stage"] &&
             b[0]["condition"] == row["condition"];
    });
    if (mine == blocks.end())
      blocks.push_back({row});
    else
      mine->push_back(row);
  }
  return blocks;
}

/// Places on a strip whose middle is the measured value.
json strip(const json &r, bool has_best) {
  const double measured = r["measured"], sd = r["sd_measurement"];
  const double base = r["base"].get<double>() - measured;
  const double best = has_best ? r["best"].get<double>() - measured : 0.0;
  const double reach = std::max({std::fabs(base), std::fabs(best), 2.0 * sd, 1e-300});
  const auto px = [&](double off) {
    return fmt::format("{:.1f}", kMargin + kHalf + off / reach * kHalf);
  };
  const std::string digits = format_by_error(r["sd_measurement"]);
  const auto wide = [&](double length) { return fmt::format("{:.1f}", length / reach * kHalf); };
  return {{"condition", r["condition"]},
          {"name", r["name"]},
          {"unit", shown_unit(r["unit"])},
          {"stage", r["stage"]},
          {"measured", shown(r["measured"], digits.c_str())},
          {"sd", shown(r["sd_measurement"], digits.c_str())},
          {"base", shown(r["base"], digits.c_str())},
          {"best", has_best ? shown(r["best"], digits.c_str()) : ""},
          {"middle", px(0.0)},
          {"low1", px(-sd)},
          {"low2", px(-2.0 * sd)},
          {"wide1", wide(2.0 * sd)},
          {"wide2", wide(4.0 * sd)},
          {"at_base", px(base)},
          {"at_best", has_best ? json(px(best)) : json()}};
}

std::vector<double> column(const Block &rows, const char *key) {
  std::vector<double> out;
  for (const json &r : rows)
    out.push_back(r[key].is_number() ? r[key].get<double>() : std::nan(""));
  return out;
}

report::Chart chart(const Block &rows, const std::string &best, std::size_t number) {
  using namespace report;
  const std::string unit = shown_unit(rows[0]["unit"]), name = rows[0]["observable"];
  Chart c;
  c.id = fmt::format("curve{}", number);
  c.title = fmt::format("{}: {}, {}", rows[0]["condition"].get<std::string>(), name,
                        rows[0]["stage"].get<std::string>());
  c.from_zero = false;
  c.x_label = "Pressure (MPa)";
  c.y_label = unit.empty() ? name : name + " (" + unit + ")";
  const auto add = [&](const std::string &legend, const char *key, Symbol symbol) -> Series & {
    c.series.push_back({});
    Series &s = c.series.back();
    s.name = legend;
    s.x = column(rows, "pressure_MPa");
    s.y = column(rows, key);
    s.symbol = symbol;
    return s;
  };
  Series &base = add("base", "base", Symbol::square);
  base.colour = "#b4481c", base.dash = "7 4";
  if (best != "none")
    add(best, "best", Symbol::triangle).colour = "#0b62a8";
  Series &measured = add("measured ± sd", "measured", Symbol::circle);
  measured.mark = Mark::points, measured.y_error = column(rows, "sd_measurement");
  c.note = "Base: the base model, recalibrated. Predictions are the emulators', not runs.";
  return c;
}

} // namespace

std::vector<report::Chart> prediction_charts(const json &gap) {
  std::vector<report::Chart> charts;
  for (const Block &rows : blocks_of(gap["predictions"]["observables"]))
    if (rows.size() > 1)
      charts.push_back(chart(rows, gap["predictions"]["best"], charts.size()));
  return charts;
}

json predictions_part(const json &gap) {
  const std::string best = gap["predictions"]["best"];
  json strips = json::array();
  for (const Block &rows : blocks_of(gap["predictions"]["observables"]))
    if (rows.size() == 1)
      strips.push_back(strip(rows[0], best != "none"));
  return {{"best", best},
          {"has_best", best != "none"},
          {"strips", strips},
          {"has_strips", !strips.empty()},
          {"charts", report::places_of(prediction_charts(gap))}};
}

namespace {

constexpr std::size_t kMostBars = 8;
constexpr double kLeast = 0.005; // probability below which no bar is drawn, the first three aside

std::string name_of(const json &evidence) {
  const std::string name = evidence["hypothesis"];
  if (name == "none")
    return "none: no effect";
  if (name == "noise")
    return "noise: errors understated";
  if (name == "unknown" && evidence.value("place", "") != "")
    return "unknown: " + evidence["place"].get<std::string>();
  return name;
}

json bar_of(const json &e, const std::string &claim) {
  const double probability = e["probability"];
  const bool predicts = e["hypothesis"] != "noise" && e["hypothesis"] != "unknown";
  return {{"name", name_of(e)},
          {"percent", fmt::format("{:.1f}", 100.0 * probability)},
          {"width", fmt::format("{:.1f}", 100.0 * probability)},
          {"prior", fmt::format("{:.1f}", 100.0 * e["prior"].get<double>())},
          {"fit", predicts ? fmt::format("{:.2g}", e["adequacy_p"].get<double>()) : "–"},
          {"kind", e["hypothesis"] == claim ? "claimed" : "other"}};
}

/// Whether other priors would change the claim, in one sentence.
std::string steadiness(const json &which) {
  std::string changes;
  for (const json &s : which["sensitivity"])
    if (s["claim"] != which["claim"])
      changes += fmt::format("{}{}: {}", changes.empty() ? "" : "; ",
                             s["priors"].get<std::string>(), s["claim"].get<std::string>());
  return changes.empty() ? "The claim is the same with every other prior tried."
                         : "Other priors, other claims: " + changes + ".";
}

} // namespace

json ranking_part(const json &gap) {
  const json &which = gap["which"];
  json bars = json::array(), others = json::array();
  double rest = 0.0;
  const inference::WhichSettings rule;
  for (const json &e : which["evidence"])
    if (bars.size() < 3 || (bars.size() < kMostBars && e["probability"] >= kLeast))
      bars.push_back(bar_of(e, which["claim"]));
    else
      rest += e["probability"].get<double>();
  for (const json &s : which["sensitivity"])
    others.push_back({{"priors", s["priors"]},
                      {"claim", s["claim"]},
                      {"percent", fmt::format("{:.1f}", 100.0 * s["probability"].get<double>())}});
  return {{"bars", bars},
          {"rest", fmt::format("{} more share {:.1f} %.", which["evidence"].size() - bars.size(),
                               100.0 * rest)},
          {"steadiness", steadiness(which)},
          {"claimed_from", fmt::format("{:g}", 100.0 * rule.claim_probability)},
          {"least_p", fmt::format("{:g}", rule.adequacy)},
          {"sensitivity", others}};
}

namespace {

using nlohmann::json;

std::string range(const json &row) {
  return fmt::format("{} to {}", shown(row["low95"], "{:.3g}"), shown(row["high95"], "{:.3g}"));
}

/// "numerics: cell 2.0, reading 0.23", the largest first.
std::string terms_of(const json &terms) {
  std::vector<std::pair<double, std::string>> sizes;
  for (const auto &[name, sd] : terms.items())
    if (sd.get<double>() > 0.0)
      sizes.emplace_back(-sd.get<double>(), name);
  std::sort(sizes.begin(), sizes.end());
  std::string out;
  for (const auto &[size, name] : sizes)
    out += fmt::format("{}{} {:.2g}", out.empty() ? "" : ", ", name, -size);
  return out;
}

double sum_of(const json &terms) {
  double squares = 0.0;
  for (const json &sd : terms)
    squares += sd.get<double>() * sd.get<double>();
  return std::sqrt(squares);
}

} // namespace

json budget_part(const json &gap) {
  json rows = json::array();
  for (const json &row : gap["budget"]) {
    const std::string unit = row["unit"];
    rows.push_back({{"observable",
                     fmt::format("{}: {}{}", row["condition"].get<std::string>(),
                                 row["name"].get<std::string>(), unit.empty() ? "" : ", " + unit)},
                    {"sd", fmt::format("{:.2g}", sum_of(row["terms"]))},
                    {"terms", terms_of(row["terms"])}});
  }
  return {{"rows", rows}, {"has_rows", !rows.empty()}};
}

json effects_part(const json &gap) {
  json rows = json::array(), hidden = json::array();
  for (const json &row : gap["which"]["effects"]) {
    const std::string name = row["effect"], said = row["said"]; // "name: what"
    rows.push_back({{"effect", name},
                    {"acts", fmt::format("{:.1f}", 100.0 * row["inclusion"].get<double>())},
                    {"said", said.substr(std::min(said.size(), name.size() + 2))}});
  }
  for (const json &p : gap["parameters"]) {
    json row = {{"name", p["parameter"]}, {"all", range(p)}, {"moved_by", "–"}};
    if (p.contains("moved_by"))
      row["moved_by"] = fmt::format("{}: {} ({})", p["moved_by"]["effect"].get<std::string>(),
                                    shown(p["moved_by"]["median"], "{:.3g}"), range(p["moved_by"]));
    hidden.push_back(row);
  }
  return {{"rows", rows}, {"hidden", hidden}};
}

} // namespace calendem
