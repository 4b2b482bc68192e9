// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/compare/heat_map.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {
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
  return {{"text", fmt::format("{}{} (z {})", shown(r["residual"], "{:+.3g}"),
                               r["unit"] == "" ? "" : " " + r["unit"].get<std::string>(),
                               shown(r["z"], "{:+.1f}"))},
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
