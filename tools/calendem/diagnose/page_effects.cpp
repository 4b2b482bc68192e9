// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/compare/gap_page.h"
#include "diagnose/page.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

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
