// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/making.h"
#include "base/case.h"
#include "base/liggghts_job.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "electrode/pack/pack.h"
#include "simulate/run.h"
#include "simulate/study.h"
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace calendem {
namespace fs = std::filesystem;
namespace {

/// The recipe as a file that reads back the same: tables of sources that it does not use may not be
/// there, nor, beside a structure, what neither the recipe nor the study (`columns`) says: the
/// structure gives it.
std::string recipe_file(const Recipe &r, const std::vector<std::string> &columns) {
  std::vector<Key> keys;
  for (const Key &key : recipe_keys()) {
    const bool of_shapes = key.name.rfind("shapes.", 0) == 0,
               of_structure = key.name.rfind("structure.", 0) == 0,
               said =
                   r.settings.line(key.name) > 0 ||
                   std::find(columns.begin(), columns.end(), "recipe." + key.name) != columns.end();
    if (r.structure.given() ? of_structure || said
                            : !of_structure && (r.shapes.given() || !of_shapes))
      keys.push_back(key);
  }
  return write_toml(r.settings, keys, "# a packing of a study; every default filled in\n");
}

/// The status that an exit status stands for; empty: done.
std::string ended_with(int exit_status) {
  if (stop_requested())
    return "stopped";
  return exit_status == 0 ? "" : exit_status == kCheckFailed ? kChecksFailed : "failed";
}

} // namespace

Making::Making(const Study &study, const StudyOptions &options)
    : study_(study), o_(options), states_(study.runs.size()) {
  const std::string for_packing = packing_tools(o_.liggghts), for_run = run_tools(o_.liggghts);
  std::map<std::map<std::string, std::string>, std::string> packings; // by settings
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const StudyRun &r = study.runs[k];
    RunState &state = states_[k];
    std::string &packing = packings[r.recipe.settings.all()];
    if (packing.empty())
      packing = packing_identity(r.recipe, for_packing);
    state.packing = packing;
    state.run = hash_of_text(packing + run_identity(r.settings, for_run));
    state.status = status_of(state);
    state.results = results(state);
  }
}

void Making::make(int k) {
  if (ended(k))
    return;
  const auto begin = std::chrono::steady_clock::now();
  const auto report_end = [&](const std::string &how) {
    const auto s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin);
    report(k, fmt::format("{}, {:.0f} s", how, s.count()));
  };
  if (o_.step == StudyStep::Packing) {
    states_[k].status = pack(k);
    report_end(states_[k].status.empty() ? "packed" : states_[k].status);
    return;
  }
  if (o_.step == StudyStep::Run && !packed(k))
    return lost(k, "its packing does not exist");
  set_status(k, "running");
  std::string failed = o_.step == StudyStep::Run ? "" : pack(k);
  if (failed.empty())
    failed = run(k);
  if (failed.empty() && study_.measured)
    failed = measure(k);
  if (failed.empty() && !study_.keep_all)
    keep_tables(k);
  set_status(k, failed.empty() ? "done" : failed);
  report_end(states_[k].status);
}

void Making::refresh(int but) {
  for (int k = 0; k < static_cast<int>(states_.size()); ++k)
    if (k != but && !ended(k) && states_[k].why.empty()) {
      states_[k].status = status_of(states_[k]);
      states_[k].results = results(states_[k]);
    }
}

void Making::lost(int k, const std::string &why) {
  states_[k].why = why;
  set_status(k, "failed");
  report(k, fmt::format("failed: {}; see {}", why, log_of(k)));
}

void Making::write_table() {
  const std::lock_guard<std::mutex> lock(guard_);
  const WaitingLock others(o_.folder + "/.study.lock"); // tasks of an array write it too
  if (o_.only > 0)
    refresh(o_.only - 1);
  std::string table = study_header(study_);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const RunState &s = states_[k];
    table += fmt::format("{},{},{},{}", study_.runs[k].number, s.status, s.run, s.packing);
    for (const std::string &v : study_.runs[k].values)
      table += "," + v;
    table += s.results + "\n";
  }
  write_file(o_.folder + "/study.csv", table);
}

std::vector<int> Making::runs_to_make() const {
  std::vector<int> out;
  for (int k = 0; k < static_cast<int>(states_.size()); ++k)
    if (!ended(k))
      out.push_back(k);
  return out;
}

std::vector<int> Making::packings_to_make() const {
  std::vector<int> out;
  std::set<std::string> seen;
  for (const int k : runs_to_make())
    if (!packed(k) && seen.insert(states_[k].packing).second)
      out.push_back(k);
  return out;
}

int Making::count(const std::string &status) const {
  return static_cast<int>(std::count_if(states_.begin(), states_.end(),
                                        [&](const RunState &s) { return s.status == status; }));
}

bool Making::packed(int k) const {
  return fs::exists(packing_folder(states_[k]) + "/electrode.json");
}

bool Making::ended(int k) const {
  return states_[k].status == "done" || states_[k].status == kChecksFailed;
}

std::string Making::failures() const {
  std::string out;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const RunState &s = states_[k];
    if (s.status == "failed" || s.status == kChecksFailed)
      out += fmt::format("\n  run {}: {}; see {}", study_.runs[k].number,
                         s.why.empty() ? s.status : s.status + ", " + s.why,
                         log_of(static_cast<int>(k)));
  }
  return out;
}

std::string Making::log_of(int k) const {
  return (packed(k) ? run_folder(states_[k]) : packing_folder(states_[k])) + ".log";
}

std::vector<std::string> Making::finished() const {
  std::vector<std::string> out;
  for (const RunState &s : states_)
    out.push_back(s.status == "done" ? run_folder(s) : "");
  return out;
}

nlohmann::json Making::description() const {
  return {{"name", study_.name},
          {"columns", study_.columns},
          {"runs", study_.runs.size()},
          {"provenance",
           {{"calendem", version()},
            {"hashes", "64-bit FNV-1a"},
            {"study_toml", hash_of_file(study_.file)},
            {"recipe", hash_of_file(study_.recipe_file)},
            {"case", hash_of_file(study_.case_file)},
            {"liggghts", hash_of_file(o_.liggghts)},
            {"packing_tools", hash_of_text(packing_tools(o_.liggghts))},
            {"run_tools", hash_of_text(run_tools(o_.liggghts))}}}};
}

std::string Making::run_folder(const RunState &s) const { return o_.folder + "/runs/" + s.run; }

std::string Making::packing_folder(const RunState &s) const {
  return o_.folder + "/packings/" + s.packing;
}

std::string Making::status_of(const RunState &s) const {
  RunFolder run(run_folder(s));
  const nlohmann::json &summary = run.object("summary.json");
  if (summary.is_null())
    return "not started";
  if (!run.unfinished().empty())
    return "not finished";
  return summary.value("failed_checks", nlohmann::json::array()).empty() ? "done" : kChecksFailed;
}

std::string Making::results(const RunState &s) const {
  return s.status == "done" || s.status == kChecksFailed
             ? results_of(run_folder(s), study_.at_pressure)
             : no_results(study_.at_pressure);
}

void Making::set_status(int k, const std::string &status) {
  {
    const std::lock_guard<std::mutex> lock(guard_);
    states_[k].status = status;
    states_[k].results = results(states_[k]);
  }
  write_table();
}

void Making::report(int k, const std::string &what) {
  const std::lock_guard<std::mutex> lock(guard_);
  fmt::print("study: run {} of {}: {}: {}\n", study_.runs[k].number, study_.runs.size(),
             study_.runs[k].said, what);
  std::cout << std::flush;
}

std::vector<std::string> Making::command(const char *verb, const std::string &spec,
                                         const std::string &folder) const {
  return {o_.calendem,  verb,       spec, "-o", folder, "--ranks", std::to_string(o_.ranks),
          "--liggghts", o_.liggghts};
}

std::string Making::pack(int k) {
  const std::string folder = packing_folder(states_[k]);
  const WaitingLock lock(folder + ".lock");
  if (packed(k))
    return "";
  {
    const std::lock_guard<std::mutex> guard(guard_);
    if (const auto before = not_packed_.find(folder); before != not_packed_.end())
      return before->second;
  }
  write_file(folder + ".toml", recipe_file(study_.runs[k].recipe, study_.columns));
  const std::string failed =
      ended_with(run_program(command("pack", folder + ".toml", folder), folder + ".log"));
  const std::lock_guard<std::mutex> guard(guard_);
  if (!failed.empty() && !stop_requested())
    not_packed_[folder] = failed;
  return failed;
}

std::string Making::run(int k) {
  const std::string folder = run_folder(states_[k]);
  const WaitingLock lock(folder + ".lock"); // two rows may ask for the same run
  Settings settings = study_.runs[k].settings;
  settings.set("electrode", packing_folder(states_[k]));
  write_file(folder + ".toml",
             write_toml(settings, case_keys(), "# a run of a study; every default filled in\n"));
  std::vector<std::string> words = command("run", folder + ".toml", folder);
  words.push_back("--resume");
  return ended_with(run_program(words, folder + ".log"));
}

std::string Making::measure(int k) {
  const std::string folder = run_folder(states_[k]);
  return ended_with(run_program({o_.calendem, "measure", folder, "--moment", "releases"},
                                folder + ".measure.log"));
}

/// Leaves the tables of a finished run, removes frames and restart files.
void Making::keep_tables(int k) const {
  const std::string folder = run_folder(states_[k]);
  fs::remove_all(folder + "/vtk");
  for (const auto &entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().find(".restart") != std::string::npos)
      fs::remove(entry.path());
}

} // namespace calendem
