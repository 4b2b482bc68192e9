// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/gap_file.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "base/shown.h"
#include <cmath>
#include <fmt/format.h>

namespace calendem {

using Json = nlohmann::ordered_json;

Json to_json(const Place &p) {
  return {{"observable", p.observable},  {"stage", p.stage},
          {"condition", p.condition},    {"unit", p.unit},
          {"residual", p.residual},      {"sd", p.sd},
          {"z", Json(or_null(p.z))},     {"share", p.share},
          {"significant", p.significant}};
}

std::string in_words(const Json &place, const std::string &model) {
  const double residual = place["residual"];
  return fmt::format("{}, {} ({}): {} is {} too {} (z = {}, {:.0f} % of the gap).",
                     place["condition"].get<std::string>(), place["observable"].get<std::string>(),
                     place["stage"].get<std::string>(), model,
                     shown_difference(std::fabs(residual), place["unit"]),
                     residual > 0.0 ? "high" : "low", shown(place["z"], "{:.1f}"),
                     100.0 * place["share"].get<double>());
}

Json new_gap(const std::string &experiment, Json where, double threshold,
             double degrees_of_freedom) {
  return {{"experiment", experiment},
          {"where", std::move(where)},
          {"threshold", threshold},
          {"scatter",
           {{"degrees_of_freedom", degrees_of_freedom < 0.0 ? Json() : Json(degrees_of_freedom)}}},
          {"which", nullptr},
          {"shrink", nullptr},
          {"said", Json::array()},
          {"not_said", Json::array()},
          {"provenance", {{"calendem", version()}, {"hashes", "64-bit FNV-1a"}}}};
}

void write_gap(const Json &gap, const std::string &page, const std::string &folder) {
  write_file(folder + "/gap.json", gap.dump(1) + "\n");
  write_file(folder + "/gap.html", page);
}

} // namespace calendem
