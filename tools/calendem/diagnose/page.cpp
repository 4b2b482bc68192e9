// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/page.h"
#include "compare/gap.h"
#include "report/page.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace calendem {

extern const char *const kDiagnosisHtml;
namespace {

using nlohmann::json;

/// Ids in the order of the experiment file.
std::vector<std::string> conditions_of(const json &gap) {
  std::vector<std::string> ids;
  for (const json &row : gap["predictions"]["observables"])
    if (std::find(ids.begin(), ids.end(), row["condition"]) == ids.end())
      ids.push_back(row["condition"]);
  return ids;
}

json parameters_of(const json &gap) {
  json rows = json::array();
  for (const json &p : gap["parameters"])
    rows.push_back({{"name", p["parameter"]},
                    {"value", shown(p["mode"], "{:.4g}")},
                    {"low", shown(p["low90"], "{:.4g}")},
                    {"high", shown(p["high90"], "{:.4g}")}});
  for (const json &p : gap["fitted_effects"])
    rows.push_back({{"name", fmt::format("{} (off: {})",
                                         fmt::join(p["keys"].get<std::vector<std::string>>(), ", "),
                                         p["off"].get<std::string>())},
                    {"value", shown(p["value"], "{:.4g}")},
                    {"low", shown(p["value_low90"], "{:.4g}")},
                    {"high", shown(p["value_high90"], "{:.4g}")}});
  return rows;
}

constexpr double kParts = 3.0; // standard deviations between two explanations

json measurements_of(const json &which) {
  json rows = json::array();
  for (const json &m : which["measurements"])
    rows.push_back({{"what", m["what"]},
                    {"cost", shown(m["cost"], "{:.3g}")},
                    {"expected", fmt::format("{:.0f} → {:.0f}", 100.0 * m["now"].get<double>(),
                                             100.0 * m["expected_probability"].get<double>())},
                    {"per_cost", shown(100.0 * m["per_cost"].get<double>(), "{:+.1f}")}});
  for (const json &m : which["not_in_bank"])
    rows.push_back({{"what", m["what"]},
                    {"cost", shown(m["cost"], "{:.3g}")},
                    {"expected", "not in this bank"},
                    {"per_cost", "–"}});
  return rows;
}

/// Further measurements as simulated: a row for each, a cell for each explanation.
json simulated_next(const json &gap) {
  if (!gap.contains("next"))
    return nullptr;
  const json &next = gap["next"];
  json heads = json::array(), rows = json::array();
  for (const json &m : next["models"])
    heads.push_back(fmt::format("{} ({})", m["hypothesis"].get<std::string>(),
                                m["probability"].get<std::string>()));
  for (const json &m : next["measurements"]) {
    json cells = json::array();
    for (const json &v : m["values"])
      cells.push_back(shown(v["mean"], "{:.1f}") + " ± " + shown(v["error"], "{:.1f}"));
    std::vector<std::string> parts;
    for (const json &pair : m["parted"])
      if (pair["apart"].is_number() && pair["apart"].get<double>() >= kParts)
        parts.push_back(fmt::format("{} from {} ({:.1f})", pair["first"].get<std::string>(),
                                    pair["second"].get<std::string>(),
                                    pair["apart"].get<double>()));
    rows.push_back(
        {{"what", m["what"]},
         {"reading", fmt::format("{}, {} (± {:g})", m["reading"].get<std::string>(),
                                 m["unit"].get<std::string>(), m["sd"].get<double>())},
         {"cost", shown(m["cost"], "{:.3g}")},
         {"cells", cells},
         {"parts", parts.empty() ? "nothing" : fmt::format("{}", fmt::join(parts, "; "))}});
  }
  return {{"heads", heads}, {"rows", rows}, {"packings", next["packings"]}};
}

constexpr double kSaysMuch = 0.5; // Q2 below which an emulator explains little

json emulators_of(const json &gap) {
  json rows = json::array();
  for (const json &e : gap["emulators"])
    rows.push_back({{"effect", e["effect"]},
                    {"runs", e["runs"]},
                    {"q2", shown(e["q2"], "{:.3f}")},
                    {"error", shown(e["error"], "{:.2g}")},
                    {"verdict", e["poor"]                           ? "too poor: cannot be claimed"
                                : e["q2"].get<double>() < kSaysMuch ? "hardly moves these data"
                                                                    : "good enough"}});
  return rows;
}

json evidence_of(const json &which) {
  json rows = json::array();
  for (const json &e : which["evidence"])
    rows.push_back({{"hypothesis", e["hypothesis"]},
                    {"prior", fmt::format("{:.1f}", 100.0 * e["prior"].get<double>())},
                    {"probability", fmt::format("{:.2f}", 100.0 * e["probability"].get<double>())},
                    {"log_evidence", shown(e["log_evidence"], "{:.2f}")},
                    {"error", shown(e["log_evidence_error"], "{:.2f}")},
                    {"laplace", shown(e["log_evidence_laplace"], "{:.2f}")},
                    {"effective", fmt::format("{:.0f} of {}", e["effective_samples"].get<double>(),
                                              e["samples"].get<int>())},
                    {"adequacy", shown(e["adequacy_p"], "{:.2g}")}});
  return rows;
}

std::string release_noise(const json &gap) {
  std::vector<std::string> all;
  for (const json &p : gap["point_noise"])
    all.push_back(fmt::format("{:.2g} ({})", p["times_stated"].get<double>(),
                              p["condition"].get<std::string>()));
  return all.empty() ? "No release curve shows how large the measurement errors are."
                     : fmt::format("Points of the release scatter {} times as much as stated.",
                                   fmt::join(all, ", "));
}

} // namespace

std::string diagnosis_page(const nlohmann::ordered_json &ordered) {
  const json gap = ordered;
  const std::vector<report::Chart> predicted = prediction_charts(gap), rerun = rerun_charts(gap);
  report::Page page{kDiagnosisHtml, ordered, json::object(), predicted};
  page.charts.insert(page.charts.end(), rerun.begin(), rerun.end());
  page.values = {{"claim", gap["which"]["claim"]},
                 {"why", gap["which"]["why"]},
                 {"threshold_text", shown(gap["threshold"], "{:.2f}")},
                 {"map", heat_map(gap["where"], gap["threshold"], conditions_of(gap))},
                 {"ranking", ranking_part(gap)},
                 {"predictions", predictions_part(gap)},
                 {"effects", effects_part(gap)},
                 {"budget", budget_part(gap)},
                 {"conflict", conflict_part(gap)},
                 {"drift", drift_part(gap)},
                 {"confounding", confounding_part(gap)},
                 {"shrink", shrink_part(gap)},
                 {"measurements", measurements_of(gap["which"])},
                 {"simulated_next", simulated_next(gap)},
                 {"parameters", parameters_of(gap)},
                 {"emulators", emulators_of(gap)},
                 {"evidence", evidence_of(gap["which"])},
                 {"degrees", shown(gap["scatter"]["degrees_of_freedom"], "{:.0f}")},
                 {"release_noise", release_noise(gap)}};
  return report::to_html(page);
}

namespace {

constexpr double kApart = 2.0; // standard deviations between two stages

/// A p of the conflict matrix: not by colour alone.
json cell(const json &p) {
  const bool low = p.is_number() && p.get<double>() < 0.01;
  return {{"text", shown(p, "{:.2g}") + (low ? " !" : "")},
          {"colour", low ? "#f5c9b8" : "#eef1f4"}};
}

json cells(const json &row, const char *format) {
  json out = json::array();
  for (const json &value : row)
    out.push_back(shown(value, format));
  return out;
}

/// Largest distance between two stages' values of one parameter, in standard deviations.
double drift_of(const json &stages, std::size_t parameter) {
  double most = 0.0;
  for (const json &a : stages)
    for (const json &b : stages) {
      const double off =
          a["scores"][parameter].get<double>() - b["scores"][parameter].get<double>();
      const double sd =
          std::hypot(a["sd"][parameter].get<double>(), b["sd"][parameter].get<double>());
      most = std::max(most, std::fabs(off) / sd);
    }
  return most;
}

} // namespace

json conflict_part(const json &gap) {
  json rows = json::array(), numbers = json::array(), found = json::array();
  const json &matrix = gap["conflict_matrix"];
  for (std::size_t k = 0; k < matrix["blocks"].size(); ++k) {
    json row = {{"number", k + 1}, {"name", matrix["blocks"][k]}, {"cells", json::array()}};
    for (std::size_t other = 0; other <= k; ++other)
      row["cells"].push_back(cell(matrix["p"][k][other]));
    rows.push_back(row);
    numbers.push_back(k + 1);
  }
  for (const json &c : gap["conflicts"])
    found.push_back(fmt::format("{} and {}: each can be met, both together not (p = {}).",
                                c["one"].get<std::string>(), c["other"].get<std::string>(),
                                shown(c["p"], "{:.1e}")));
  return {{"numbers", numbers}, {"rows", rows}, {"found", found}};
}

json drift_part(const json &gap) {
  json names = json::array(), rows = json::array();
  for (const json &s : gap["stages"])
    names.push_back(s["stage"]);
  for (std::size_t j = 0; j < gap["parameters"].size(); ++j) {
    json row = {{"parameter", gap["parameters"][j]["parameter"]}, {"values", json::array()}};
    for (const json &s : gap["stages"])
      row["values"].push_back(shown(s["scores"][j], "{:+.2f}") + " ± " +
                              shown(s["sd"][j], "{:.2f}"));
    row["verdict"] = drift_of(gap["stages"], j) > kApart ? "apart" : "agree";
    rows.push_back(row);
  }
  return {{"stages", names}, {"rows", rows}, {"several", gap["stages"].size() > 1}};
}

/// Effects whose emulators are too poor for a claim.
std::set<std::string> poor_in(const json &gap) {
  std::set<std::string> names;
  for (const json &e : gap["emulators"])
    if (e.value("poor", false))
      names.insert(e["effect"]);
  return names;
}

json confounding_part(const json &gap) {
  const std::set<std::string> poor = poor_in(gap);
  const json &c = gap["confounding"];
  json rows = json::array(), limits = json::array(), alike = json::array();
  for (std::size_t k = 0; k < c["effects"].size(); ++k)
    rows.push_back({{"effect", c["effects"][k]}, {"cosines", cells(c["cosine"][k], "{:+.2f}")}});
  for (std::size_t k = 0; k < c["effects"].size() && c.contains("detection_limit"); ++k) {
    const json &l = c["detection_limit"][k];
    limits.push_back(
        {{"effect", l["effect"]},
         {"key", fmt::format("{}", fmt::join(l["keys"].get<std::vector<std::string>>(), ", "))},
         {"value", l["value"].is_number() ? shown(l["value"], "{:.3g}") : "nowhere"},
         {"rival", l["rival"]},
         {"claim", poor.count("base") + poor.count(l["effect"]) > 0 ? "too poor" : "good enough"},
         {"absorbed", fmt::format("{:.0f}", 100.0 * c["absorbed"][k].get<double>())}});
  }
  for (const json &set : gap["which"]["indistinguishable"])
    alike.push_back(fmt::format("{}", fmt::join(set.get<std::vector<std::string>>(), ", ")));
  return {{"effects", c["effects"]}, {"rows", rows}, {"limits", limits}, {"alike", alike}};
}

} // namespace calendem
