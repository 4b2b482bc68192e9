// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/elongation.h"
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <tuple>

namespace calendem {

// After a resumption the last of equal steps counts. Cut lines are dropped.
bool add_elongation(const std::string &folder, std::vector<RawRow> &rows) {
  std::map<long, std::pair<double, double>> known;
  std::ifstream in(folder + "/elongation_raw.csv");
  std::string line;
  while (std::getline(in, line) && !in.eof()) {
    long step = 0;
    double elongation = 0.0, work = 0.0;
    if (std::sscanf(line.c_str(), "%ld,%lf,%lf", &step, &elongation, &work) == 3)
      known[step] = {elongation, work};
  }
  for (RawRow &r : rows)
    if (const auto at = known.find(static_cast<long>(r.step)); at != known.end())
      std::tie(r.elongation, r.work_elongation) = at->second;
  return !known.empty();
}

double elongation_at(const std::vector<RawRow> &rows, double time) {
  const auto above = std::lower_bound(rows.begin(), rows.end(), time,
                                      [](const RawRow &r, double t) { return r.time < t; });
  if (above == rows.end())
    return rows.back().elongation;
  if (above == rows.begin())
    return above->elongation;
  const RawRow &a = *(above - 1), &b = *above;
  return a.elongation + (b.elongation - a.elongation) * (time - a.time) / (b.time - a.time);
}

std::string elongation_columns() { return ",elongation_percent,cell_x_um,work_elongation_fJ"; }

std::string elongation_cells(const RawRow &row, const ElectrodeFacts &e) {
  return fmt::format(",{:.6f},{:.9f},{:.6g}", 100.0 * row.elongation,
                     e.elongated(row.elongation).lx, row.work_elongation);
}

nlohmann::json elongation_of(const RawRow &top, const RawRow &last, const ElectrodeFacts &e) {
  return {{"percent_at_max", 100.0 * top.elongation},
          {"percent_after", 100.0 * last.elongation},
          {"cell_x_after_um", e.elongated(last.elongation).lx}};
}

} // namespace calendem
