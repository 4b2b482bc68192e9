// SPDX-License-Identifier: GPL-2.0-or-later

#include "measure/run_directory.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/csv_table.h"
#include "base/provenance.h"

namespace calendem {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const char *const kRequired[] = {
    "time_us",        "stage",           "displacement_um", "pressure_MPa",   "pressure_bottom_MPa",
    "bonds_broken",   "broken_fraction", "broken_tension",  "broken_bending", "broken_shear",
    "broken_torsion", "porosity_total",  "porosity_macro"};

std::string contents(const fs::path &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// JSON of `file`; null and a problem when it cannot be read.
json read_json(const fs::path &file, Problems &problems) {
  json value = json::parse(contents(file), nullptr, false);
  if (value.is_object())
    return value;
  problems.push_back({file.string(), "not complete JSON: truncated or damaged",
                      "run the case again, or remove the file to get a report marked unfinished"});
  return nullptr;
}

bool check_columns(const CsvTable &table, const std::string &file, Problems &problems) {
  std::string missing;
  for (const char *column : kRequired)
    if (!table.has(column))
      missing += (missing.empty() ? "" : ", ") + std::string(column);
  if (missing.empty())
    return true;
  problems.push_back({file, "columns missing: " + missing,
                      "the header must be the one written by calendem run; run the case again"});
  return false;
}

/// Rows of a wrong length: only the last line of an unfinished run may have one (being written).
void check_rows(const CsvTable &table, const std::string &file, Run &run, Problems &problems) {
  for (const int line : table.bad_lines()) {
    const std::string what = "line " + std::to_string(line) + " is cut short or has cells too many";
    if (line == table.last_line() && !run.unfinished.empty())
      run.notes.push_back({file, what, "left out: the run was still writing it"});
    else
      problems.push_back({file, what, "the file is damaged: run the case again"});
  }
}

void check_numbers(const Curve &curve, const std::string &file, Problems &problems) {
  for (const char *column : kRequired) {
    if (!curve.has(column))
      continue;
    const Column &values = curve[column];
    const auto bad = std::find_if(values.begin(), values.end(),
                                  [](double value) { return !std::isfinite(value); });
    if (bad != values.end())
      problems.push_back({file,
                          "column " + std::string(column) + ", row " +
                              std::to_string(bad - values.begin() + 1) + ": not a number",
                          "the simulation went wrong or the file is damaged: see log.liggghts"});
  }
}

void read_curve(const fs::path &directory, Run &run, Problems &problems) {
  const fs::path path = directory / "curve.csv";
  const std::string file = path.string();
  if (!fs::exists(path)) {
    const bool raw = fs::exists(directory / "curve_raw.csv");
    problems.push_back({file, raw ? "missing, though curve_raw.csv is there" : "missing",
                        raw ? "the run was interrupted: calendem run CASE.toml -o DIR --resume"
                            : "give a directory made by calendem run"});
    return;
  }
  const CsvTable table = CsvTable::parse(contents(path));
  run.files_read.push_back(file);
  if (!check_columns(table, file, problems))
    return;
  check_rows(table, file, run, problems);
  if (table.rows() < 2) {
    problems.push_back({file, std::to_string(table.rows()) + " rows, at least 2 are needed",
                        "let the run go on (calendem run --resume)"});
    return;
  }
  run.curve.stage = table.texts("stage");
  for (const auto &column : table.header())
    if (column != "stage")
      run.curve.columns[column] = table.numbers(column);
  check_numbers(run.curve, file, problems);
}

void read_summary(const fs::path &directory, Run &run, Problems &problems) {
  const fs::path file = directory / "summary.json";
  if (!fs::exists(file)) {
    run.unfinished = "summary.json is missing";
    return;
  }
  json summary = read_json(file, problems);
  if (summary.is_null())
    return;
  run.summary = std::move(summary);
  run.files_read.push_back(file.string());
  for (const char *key : {"finished", "complete"})
    if (run.summary.value(key, json(true)) == json(false))
      run.unfinished = "summary.json says so";
}

const char *const kProfileColumns[] = {"moment", "z_over_thickness", "porosity_macro", "bonds",
                                       "bonds_broken"};

/// structure.json and structure.csv. A file that is cut or was measured of another curve is a note,
/// not a mistake.
void read_structure(const fs::path &directory, Run &run) {
  const fs::path file = directory / "structure.json", profile = directory / "structure.csv";
  if (!fs::exists(file) || !fs::exists(profile))
    return;
  const std::string again = "measure it again: calendem measure " + directory.string();
  json structure = json::parse(contents(file), nullptr, false);
  const CsvTable table = CsvTable::parse(contents(profile));
  bool whole = structure.is_object() && structure.contains("moments") && table.bad_lines().empty();
  for (const char *column : kProfileColumns)
    whole = whole && table.has(column);
  const std::string curve = hash_of_file((directory / "curve.csv").string());
  if (!whole) {
    run.notes.push_back({file.string(), "it or structure.csv is cut or damaged", again});
    return;
  }
  if (structure.value("/provenance/curve"_json_pointer, "") != curve) {
    run.notes.push_back({file.string(), "measured of another curve.csv, left out", again});
    return;
  }
  const auto moment = table.texts("moment");
  const auto height = table.numbers("z_over_thickness"), macro = table.numbers("porosity_macro"),
             bonds = table.numbers("bonds"), broken = table.numbers("bonds_broken");
  for (std::size_t i = 0; i < table.rows(); ++i)
    run.profile.push_back({moment[i], height[i], macro[i], bonds[i], broken[i]});
  run.structure = std::move(structure);
  run.files_read.push_back(file.string());
  run.files_read.push_back(profile.string());
}

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

/// Files that are damaged become notes.
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

void read_optional(const fs::path &directory, Run &run) {
  const fs::path electrode = directory / "electrode.json";
  if (fs::exists(electrode)) {
    run.electrode = read_json(electrode, run.notes);
    run.files_read.push_back(electrode.string());
  }
  const auto series = [&](const char *name) {
    return read_series((directory / "vtk" / name).string(), run.notes);
  };
  run.particles = series("particles.pvd");
  run.bonds = series("bonds.pvd");
  run.platen = series("platen.pvd");
  read_structure(directory, run);
  read_fracture(directory, run);
  for (const char *name : {"breaks.csv", "bodies.csv", "cracks.csv", "thresholds.csv", "case.toml"})
    if (fs::exists(directory / name))
      run.files_read.push_back((directory / name).string());
}

} // namespace

Run read_run(const std::string &directory, Problems &problems) {
  Run run;
  fs::path path = fs::path(directory).lexically_normal();
  if (!path.has_filename())
    path = path.parent_path();
  run.directory = path.string();
  run.name = (path == "." ? fs::absolute(path).parent_path() : path).filename().string();
  if (!fs::is_directory(path)) {
    problems.push_back(
        {run.directory, "no such directory", "give a directory made by calendem run"});
    return run;
  }
  read_summary(path, run, problems);
  read_curve(path, run, problems);
  if (run.unfinished.empty() && run.curve.rows() > 0 && run.curve.relaxation().empty())
    run.unfinished = "curve.csv has no relaxation";
  read_optional(path, run);
  return run;
}

void make_names_unique(std::vector<Run> &runs) {
  std::vector<std::string> names;
  for (auto &run : runs) {
    const auto same = std::count_if(runs.begin(), runs.end(),
                                    [&](const Run &other) { return other.name == run.name; });
    names.push_back(same > 1 ? run.directory : run.name);
  }
  for (std::size_t i = 0; i < runs.size(); ++i)
    runs[i].name = names[i];
}

} // namespace calendem
