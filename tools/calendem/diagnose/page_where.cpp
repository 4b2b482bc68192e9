// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/compare/heat_map.h"
#include "diagnose/page.h"
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace calendem {
namespace {

using nlohmann::json;

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
    found.push_back(fmt::format("{} and {}: each can be met, both together not (p = {:.1e}).",
                                c["one"].get<std::string>(), c["other"].get<std::string>(),
                                c["p"].get<double>()));
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
