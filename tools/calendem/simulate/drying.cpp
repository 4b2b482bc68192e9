// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/drying.h"
#include "base/csv_table.h"
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace calendem {

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
