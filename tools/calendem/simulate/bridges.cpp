// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/csv_table.h"
#include "base/provenance.h"
#include "simulate/collect.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace calendem {
namespace {

/// Made to AM, CBD, collector; broken likewise.
using Counts = std::array<long, 6>;
const char *const kTo[] = {"am", "cbd", "collector"};

nlohmann::json by_kind(const Counts &counts, int first) {
  nlohmann::json out;
  for (int k = 0; k < 3; ++k)
    out[kTo[k]] = counts[first + k];
  return out;
}

} // namespace

nlohmann::json write_bridges(const std::string &folder, const std::vector<RawRow> &rows,
                             const RawRow &top) {
  const auto counts = rows_by_step(folder + "/bridges_raw.csv", 7);
  if (counts.empty())
    return nullptr;
  std::string out = "time_us,pressure_MPa,thickness_um,made_am,made_cbd,made_collector,broken_am,"
                    "broken_cbd,broken_collector\n";
  Counts at_top = {}, last = {};
  for (const RawRow &r : rows) {
    const auto found = counts.find(static_cast<long>(r.step));
    if (found == counts.end())
      continue;
    std::copy(found->second.begin() + 1, found->second.end(), last.begin());
    at_top = r.step == top.step ? last : at_top;
    out += fmt::format("{:.6f},{:.6g},{:.6f},{}\n", r.time, r.p_top, r.gap, fmt::join(last, ","));
  }
  write_file(folder + "/bridges.csv", out);
  return {{"made", by_kind(last, 0)},
          {"broken_at_max", by_kind(at_top, 3)},
          {"broken_after", by_kind(last, 3)}};
}

nlohmann::json dried_film(const std::string &folder) {
  std::ifstream in(folder + "/drying.csv");
  const CsvTable rows = CsvTable::parse({std::istreambuf_iterator<char>(in), {}});
  if (rows.rows() == 0)
    return nullptr;
  const auto last = [&](const char *column) { return rows.numbers(column).back(); };
  double left = 0.0;
  for (const double x : rows.numbers("left_over_fJ"))
    left = std::isnan(x) ? x : std::max(left, std::fabs(x));
  return {{"shrinkage", last("shrinkage")},
          {"film_tension_MPa", last("film_tension_MPa")},
          {"height_of_top_um", last("top_um")},
          {"bridges_broken",
           {{"am", static_cast<long>(last("broken_am"))},
            {"cbd", static_cast<long>(last("broken_cbd"))},
            {"collector", static_cast<long>(last("broken_collector"))}}},
          {"kinetic_fJ", last("kinetic_fJ")},
          {"work_of_shrinking_fJ", last("shrinking_fJ")},
          {"unaccounted_fraction", left / last("shrinking_fJ")}};
}

} // namespace calendem
