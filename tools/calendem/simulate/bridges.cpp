// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "simulate/collect.h"
#include <array>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <map>

namespace calendem {
namespace {

/// Made to AM, CBD, collector; broken likewise.
using Counts = std::array<long, 6>;
const char *const kTo[] = {"am", "cbd", "collector"};

// After a resumption the last of equal steps counts. Cut lines are dropped.
std::map<long, Counts> read(const std::string &file) {
  std::map<long, Counts> rows;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line) && !in.eof()) {
    long step = 0;
    Counts c;
    if (std::sscanf(line.c_str(), "%ld,%ld,%ld,%ld,%ld,%ld,%ld", &step, &c[0], &c[1], &c[2], &c[3],
                    &c[4], &c[5]) == 7)
      rows[step] = c;
  }
  return rows;
}

nlohmann::json by_kind(const Counts &counts, int first) {
  nlohmann::json out;
  for (int k = 0; k < 3; ++k)
    out[kTo[k]] = counts[first + k];
  return out;
}

} // namespace

nlohmann::json write_bridges(const std::string &folder, const std::vector<RawRow> &rows,
                             const RawRow &top) {
  const std::map<long, Counts> counts = read(folder + "/bridges_raw.csv");
  if (counts.empty())
    return nullptr;
  std::string out = "time_us,pressure_MPa,thickness_um,made_am,made_cbd,made_collector,broken_am,"
                    "broken_cbd,broken_collector\n";
  Counts at_top = {}, last = {};
  for (const RawRow &r : rows) {
    const auto found = counts.find(static_cast<long>(r.step));
    if (found == counts.end())
      continue;
    last = found->second;
    at_top = r.step == top.step ? last : at_top;
    out += fmt::format("{:.6f},{:.6g},{:.6f},{}\n", r.time, r.p_top, r.gap, fmt::join(last, ","));
  }
  write_file(folder + "/bridges.csv", out);
  return {{"made", by_kind(last, 0)},
          {"broken_at_max", by_kind(at_top, 3)},
          {"broken_after", by_kind(last, 3)}};
}

} // namespace calendem
