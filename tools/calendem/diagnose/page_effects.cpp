// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/compare/gap_page.h"
#include "diagnose/page.h"
#include <fmt/format.h>

namespace calendem {

namespace {

using nlohmann::json;

std::string range(const json &row) {
  return fmt::format("{} to {}", shown(row["low95"], "{:.3g}"), shown(row["high95"], "{:.3g}"));
}

} // namespace

json effects_part(const json &gap) {
  json rows = json::array(), hidden = json::array();
  for (const json &row : gap["which"]["effects"])
    rows.push_back({{"effect", row["effect"]},
                    {"acts", fmt::format("{:.1f}", 100.0 * row["inclusion"].get<double>())},
                    {"said", row["said"]}});
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
