// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/tables.h"
#include "simulate/collect.h"
#include <cmath>
#include <fmt/format.h>

namespace calendem::report {

namespace {

using nlohmann::json;

constexpr double kAgrees = 2; // standard deviations

json line(const char *kind, const std::string &text) { return {{"kind", kind}, {"text", text}}; }

/// One cell of a row of Table 1 that was measured in a pressed film.
json agreement(const json &row, const json &cell) {
  const double z = cell["z"].get<double>(), points = cell["difference"].get<double>();
  const std::string of = fmt::format("{} points, {} standard deviations of measurement, pressure "
                                     "and packing",
                                     shown(std::fabs(points), 1), shown(std::fabs(z), 1)),
                    at = fmt::format("Table 1 of the paper, {} MPa",
                                     row["pressure_text"].get<std::string>());
  if (std::fabs(z) <= kAgrees)
    return line("good",
                fmt::format("{}: agrees (too {} by {})", at, points > 0 ? "porous" : "dense", of));
  return line("bad", fmt::format("{}: too {} by {}", at, points > 0 ? "porous" : "dense", of));
}

void add_agreements(const std::string &run, const json &comparison, json &out) {
  const std::size_t before = out.size();
  if (comparison.is_object())
    for (const json &row : comparison["rows"])
      for (const json &cell : row["cells"])
        if (cell["run"] == run && cell.contains("z"))
          out.push_back(agreement(row, cell));
  if (out.size() == before)
    out.push_back(line("none",
                       "There is no measurement to compare with: Table 1 of the paper is of "
                       "another electrode or other pressures. calendem compare compares a "
                       "run with your own."));
}

} // namespace

json verdict_of(const Run &run, const json &headline, const json &comparison) {
  json out = json::array();
  add_agreements(run.name, comparison, out);
  for (const json &figure : headline)
    if (figure["exceeded"].get<bool>())
      out.push_back(line("bad", fmt::format("{}: {} %. {}", figure["label"].get<std::string>(),
                                            figure["text"].get<std::string>(),
                                            figure["means"].get<std::string>())));
  return out;
}

} // namespace calendem::report
