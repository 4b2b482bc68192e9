// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/study.h"
#include "base/liggghts_job.h"
#include "base/material_notes.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "simulate/making.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <iterator>

namespace calendem {

namespace fs = std::filesystem;
namespace {

void stop_if_failed(const Making &making) {
  if (stop_requested())
    throw Failure(kSimulationFailed, "study: stopped on request. What was computed is kept; the "
                                     "same command continues it.");
  if (const std::string failures = making.failures(); !failures.empty())
    throw Failure(making.count("failed") > 0 ? kSimulationFailed : kCheckFailed,
                  "study: some runs are not usable:" + failures);
}

StudyOptions at_whole_paths(StudyOptions o) {
  o.folder = fs::absolute(o.folder).lexically_normal().string();
  o.liggghts = fs::absolute(o.liggghts).lexically_normal().string();
  o.slurm.on = o.slurm.on || o.slurm.dry_run;
  return o;
}

/// The folders of a study that can be made.
void prepare(const Study &study, const StudyOptions &o) {
  const int n = static_cast<int>(study.runs.size());
  if (o.only > n)
    throw Failure(kBadInput, "--only {}: the study has {} runs.", o.only, n);
  if (const std::string wrong = wrong_program(o.liggghts); !wrong.empty())
    throw Failure(kBadInput, wrong);
  make_output_folder(o.folder);
  fs::create_directories(o.folder + "/packings");
  fs::create_directories(o.folder + "/runs");
}

/// Says once what electrodes of the study warn of: that one in whose cell the powder fits least.
void say_warnings(const Making &making) {
  int runs = 0, warned = 0;
  double most = -1.0;
  std::vector<std::string> said;
  for (const std::string &folder : making.finished()) {
    if (folder.empty())
      continue;
    ++runs;
    RunFolder run(folder);
    const std::vector<std::string> warnings = warnings_of_electrode(run.object("electrode.json"));
    if (warnings.empty())
      continue;
    ++warned;
    if (const double cut = run.object("electrode.json").value(kCutOff, 0.0); cut > most) {
      most = cut;
      said = warnings;
    }
  }
  for (const std::string &text : said)
    fmt::print(stderr, "warning: {} of {} runs; one of them: {}\n", warned, runs, text);
}

void make(Making &making, const Study &study, const StudyOptions &o) {
  const int n = static_cast<int>(study.runs.size());
  write_file(o.folder + "/study.json", making.description().dump(2) + "\n");
  fmt::print("study: {} runs, {} of them done already -> {}\n", n, n - making.runs_to_make().size(),
             o.folder);
  std::cout << std::flush;
  if (o.slurm.on)
    make_by_slurm(making, study, o);
  else if (o.only > 0)
    in_parallel(1, 1, [&](int) { making.make(o.only - 1); });
  else if (!o.table)
    in_parallel(n, std::max(1, o.jobs), [&](int k) { making.make(k); });
  if (o.step == StudyStep::Packing || o.slurm.dry_run)
    return stop_if_failed(making);
  making.write_table();
  fmt::print("study: {} of {} runs done, {}/study.csv\n", making.count("done"), n, o.folder);
  std::cout << std::flush;
  say_warnings(making);
  stop_if_failed(making);
}

} // namespace

std::vector<RunPlace> places_of(const Study &study, const StudyOptions &options) {
  const StudyOptions o = at_whole_paths(options);
  const CsvTable table = CsvTable::parse(text_of_file(o.folder + "/study.csv"));
  const std::vector<std::string> run = table.texts("run"), packing = table.texts("packing"),
                                 status = table.texts("status");
  if (run.size() != study.runs.size())
    throw Failure(kBadInput, "{}/study.csv is that of another study. Give an empty folder: -o DIR.",
                  o.folder);
  std::vector<RunPlace> out;
  for (std::size_t k = 0; k < run.size(); ++k)
    out.push_back({o.folder + "/runs/" + run[k], o.folder + "/packings/" + packing[k],
                   status[k] == "done" || status[k] == kChecksFailed || status[k] == "failed"});
  return out;
}

std::vector<std::string> make_study(const Study &study, const StudyOptions &options) {
  const StudyOptions o = at_whole_paths(options);
  prepare(study, o);
  Making making(study, o);
  make(making, study, o);
  return making.finished();
}

std::vector<std::string> make_what_runs(const Study &study, const StudyOptions &options,
                                        const std::string &parts) {
  const StudyOptions o = at_whole_paths(options);
  prepare(study, o);
  Making making(study, o);
  try {
    make(making, study, o);
  } catch (const Failure &f) {
    if (f.exit_status() == kBadInput || stop_requested() != 0)
      throw;
    fmt::print("{}\n{} with such runs are left out.\n", f.what(), parts);
  }
  return making.finished();
}

namespace {

/// A number of summary.json: its place, and the column's name where that is not its last part.
struct Number {
  const char *place, *column = nullptr;
  std::string name() const {
    return column ? column : std::string(place).substr(std::string(place).rfind('/') + 1);
  }
};
const Number kNumbers[] = {
    {"/max_pressure_MPa"},
    {"/broken_fraction_at_max"},
    {"/broken_fraction_after"},
    {"/porosity_initial"},
    {"/porosity_at_max"},
    {"/porosity_after_relaxation"},
    {"/thickness_at_max_um"},
    {"/thickness_after_relaxation_um"},
    {"/springback"},
    {"/bodies"},
    {"/cracked_bodies"},
    {"/bonds_initial"},
    {"/ranks"},
    {"/steps"},
    {"/wall_clock_s"},
    {"/quasi_static/pressure_difference_max_above_5_MPa"},
    {"/quasi_static/inertial_number_max_above_5_MPa"},
    {"/quasi_static/kinetic_to_elastic_max_above_5_MPa"},
    {"/contact_range/at_max_pressure/all/force_beyond_0.2_R", "force_beyond_0.2_R_at_max"}};
const char *const kAtPressure[] = {"displacement_um", "thickness_um", "broken_fraction",
                                   "porosity_total"};

std::string number(double v) { return std::isfinite(v) ? fmt::format("{:.10g}", v) : ""; }

} // namespace

std::string study_header(const Study &study) {
  std::string out = "number,status,run,packing";
  for (const std::string &c : study.columns)
    out += "," + c;
  for (const Number &n : kNumbers)
    out += "," + n.name();
  for (const double p : study.at_pressure)
    for (const char *key : kAtPressure)
      out += fmt::format(",{}_at_{:g}_MPa", key, p);
  return out + "\n";
}

std::string no_results(const std::vector<double> &pressures) {
  return std::string(std::size(kNumbers) + pressures.size() * std::size(kAtPressure), ',');
}

std::string results_of(const std::string &folder, const std::vector<double> &pressures) {
  RunFolder run(folder);
  const nlohmann::json &s = run.object("summary.json");
  if (s.is_null())
    return no_results(pressures);
  const auto value = [&s](const std::string &place) {
    const nlohmann::json::json_pointer at(place);
    return s.contains(at) && s[at].is_number() ? s[at].get<double>() : std::nan("");
  };
  std::string out;
  for (const Number &n : kNumbers)
    out += "," + number(value(n.place));
  Mistakes none; // a curve that is not there leaves empty cells
  const Curve curve = run.curve({"pressure_MPa"}, none, none);
  for (const double p : pressures)
    for (const char *column : kAtPressure)
      out += "," + number(at_first_crossing(curve, p, column));
  return out;
}

} // namespace calendem
