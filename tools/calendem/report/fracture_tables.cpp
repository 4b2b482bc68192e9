// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/fracture_part.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "spec/csv_table.h"

namespace calendem::report {
namespace {

namespace fs = std::filesystem;
using Columns = std::map<std::string, Column>;

/// The table's numbers, if it has all `columns`.
Columns read_columns(const fs::path &file, const std::vector<std::string> &columns, Run &run) {
  Columns out;
  if (!fs::exists(file))
    return out;
  std::ifstream in(file, std::ios::binary);
  const auto table =
      CsvTable::parse({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
  const bool all = std::all_of(columns.begin(), columns.end(),
                               [&](const std::string &c) { return table.has(c); });
  if (!all || !table.bad_lines().empty()) {
    run.notes.push_back({file.string(), "it lacks columns or is cut: no charts of it",
                         "collect the run again: calendem collect " + run.directory});
    return out;
  }
  for (const std::string &column : columns)
    out[column] = table.numbers(column);
  return out;
}

} // namespace

void read_fracture(const fs::path &directory, Run &run) {
  FractureTables &f = run.fracture;
  f.cracks =
      read_columns(directory / "cracks.csv",
                   {"time_us", "pressure_MPa", "bodies_with_bonds", "bodies_apart",
                    "bodies_cracked", "bodies_split", "crack_surface_um2", "parted_surface_um2"},
                   run);
  if (f.cracks.empty()) // a run of an earlier version
    return;
  f.bodies = read_columns(
      directory / "bodies.csv",
      {"body", "bonds", "broken", "broken_fraction", "fragments", "largest_fragment", "depth_um"},
      run);
  f.thresholds = read_columns(directory / "thresholds.csv",
                              {"threshold_percent", "above_apart", "above_whole", "below_apart",
                               "below_whole", "above_split", "below_split"},
                              run);
  f.breaks = read_columns(directory / "breaks.csv", {"time_us", "body"}, run);
}

int studied_body(const Run &run) {
  const Columns &b = run.fracture.bodies;
  if (b.empty() || b.at("broken").empty())
    return 0;
  const Column &broken = b.at("broken");
  const auto most = std::max_element(broken.begin(), broken.end());
  return *most > 0 ? static_cast<int>(b.at("body")[most - broken.begin()]) : 0;
}

} // namespace calendem::report
