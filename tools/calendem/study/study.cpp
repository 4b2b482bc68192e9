// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/study.h"
#include "pack/pack.h"
#include "run/child.h"
#include "run/process.h"
#include "run/run.h"
#include "spec/case.h"
#include "spec/output_folder.h"
#include "spec/provenance.h"
#include "study/job_pool.h"
#include "study/study_table.h"
#include <algorithm>
#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

namespace calendem {
namespace fs = std::filesystem;
namespace {

const char *const kChecksFailed = "checks failed";

/// Where a run's results lie and how it stands.
struct RunState {
  std::string run, packing;           ///< names of their folders: hashes of what they depend on
  std::string status = "not started"; ///< "done", "checks failed", "failed", ...
  std::string results;                ///< cells of the table
};

/// The recipe as a file that reads back the same: tables of sources that it does not use may not be
/// there.
std::string recipe_file(const Recipe &r) {
  std::vector<Key> keys;
  for (const Key &key : recipe_keys())
    if ((r.shapes.given() || key.name.rfind("shapes.", 0) != 0) &&
        (r.structure.given() || key.name.rfind("structure.", 0) != 0))
      keys.push_back(key);
  return write_toml(r.settings, keys, "# a packing of a study; every default filled in\n");
}

/// Keeps other programs from making the same packing at the same time; waits for them.
class WaitingLock {
public:
  explicit WaitingLock(const std::string &file)
      : file_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (file_ >= 0)
      flock(file_, LOCK_EX);
  }
  ~WaitingLock() {
    if (file_ >= 0)
      close(file_);
  }
  WaitingLock(const WaitingLock &) = delete;
  WaitingLock &operator=(const WaitingLock &) = delete;

private:
  int file_;
};

/// The study under way.
class Making {
public:
  Making(const Study &study, const StudyOptions &options)
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

  void make(int k) {
    if (states_[k].status == "done" || states_[k].status == kChecksFailed)
      return;
    set_status(k, "running");
    const auto begin = std::chrono::steady_clock::now();
    std::string failed = pack(k);
    if (failed.empty())
      failed = run(k);
    if (failed.empty() && !study_.keep_all)
      keep_tables(k);
    set_status(k, failed.empty() ? "done" : failed);
    const double s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    tell(k, fmt::format("{}, {:.0f} s", states_[k].status, s));
  }

  void write_table() {
    const std::lock_guard<std::mutex> lock(guard_);
    const WaitingLock others(o_.folder + "/.study.lock"); // jobs of an array write it too
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

  int count(const std::string &status) const {
    return static_cast<int>(std::count_if(states_.begin(), states_.end(),
                                          [&](const RunState &s) { return s.status == status; }));
  }

  std::string failures() const {
    std::string out;
    for (std::size_t k = 0; k < states_.size(); ++k)
      if (states_[k].status == "failed" || states_[k].status == kChecksFailed)
        out += fmt::format("\n  run {}: {}; see {}", study_.runs[k].number, states_[k].status,
                           log_of(static_cast<int>(k)));
    return out;
  }

  std::vector<std::string> finished() const {
    std::vector<std::string> out;
    for (const RunState &s : states_)
      out.push_back(s.status == "done" ? run_folder(s) : "");
    return out;
  }

  nlohmann::json description() const {
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

private:
  const Study &study_;
  const StudyOptions &o_;
  std::vector<RunState> states_;
  std::mutex guard_;

  std::string run_folder(const RunState &s) const { return o_.folder + "/runs/" + s.run; }
  std::string packing_folder(const RunState &s) const {
    return o_.folder + "/packings/" + s.packing;
  }
  std::string log_of(int k) const { return o_.folder + "/runs/" + states_[k].run + ".log"; }

  std::string status_of(const RunState &s) const {
    std::ifstream in(run_folder(s) + "/summary.json");
    const nlohmann::json j = nlohmann::json::parse(in, nullptr, false);
    if (!j.is_object())
      return "not started";
    if (!j.value("finished", false))
      return "not finished";
    return j.value("failed_checks", nlohmann::json::array()).empty() ? "done" : kChecksFailed;
  }

  std::string results(const RunState &s) const {
    return s.status == "done" || s.status == kChecksFailed
               ? results_of(run_folder(s), study_.at_pressure)
               : no_results(study_.at_pressure);
  }

  void set_status(int k, const std::string &status) {
    {
      const std::lock_guard<std::mutex> lock(guard_);
      states_[k].status = status;
      states_[k].results = results(states_[k]);
    }
    write_table();
  }

  void tell(int k, const std::string &what) {
    const std::lock_guard<std::mutex> lock(guard_);
    std::string values;
    for (std::size_t c = 0; c < study_.columns.size(); ++c) {
      const std::string &name = study_.columns[c];
      values += fmt::format(" {} = {}", name.substr(name.rfind('.') + 1), study_.runs[k].values[c]);
    }
    fmt::print("study: run {} of {}:{}: {}\n", study_.runs[k].number, study_.runs.size(), values,
               what);
    std::cout << std::flush;
  }

  std::string ended(int status) const {
    if (stop_requested())
      return "stopped";
    return status == 0 ? "" : status == kCheckFailed ? kChecksFailed : "failed";
  }

  std::vector<std::string> command(const char *verb, const std::string &spec,
                                   const std::string &folder) const {
    return {fs::read_symlink("/proc/self/exe").string(),
            verb,
            spec,
            "-o",
            folder,
            "--ranks",
            std::to_string(o_.ranks),
            "--liggghts",
            o_.liggghts};
  }

  std::string pack(int k) {
    const std::string folder = packing_folder(states_[k]);
    const WaitingLock lock(folder + ".lock");
    if (fs::exists(folder + "/electrode.json"))
      return "";
    write_file(folder + ".toml", recipe_file(study_.runs[k].recipe));
    return ended(run_program(command("pack", folder + ".toml", folder), log_of(k)));
  }

  std::string run(int k) {
    const std::string folder = run_folder(states_[k]);
    Settings settings = study_.runs[k].settings;
    settings.set("electrode", packing_folder(states_[k]));
    write_file(folder + ".toml",
               write_toml(settings, case_keys(), "# a run of a study; every default filled in\n"));
    std::vector<std::string> words = command("run", folder + ".toml", folder);
    words.push_back("--resume");
    return ended(run_program(words, log_of(k)));
  }

  /// Leaves the tables of a finished run, removes frames and restart files.
  void keep_tables(int k) const {
    const std::string folder = run_folder(states_[k]);
    fs::remove_all(folder + "/vtk");
    for (const auto &entry : fs::directory_iterator(folder))
      if (entry.path().filename().string().find(".restart") != std::string::npos)
        fs::remove(entry.path());
  }
};

} // namespace

std::vector<std::string> finished_runs(const Study &study, StudyOptions o) {
  o.liggghts = fs::absolute(o.liggghts).lexically_normal().string();
  return Making(study, o).finished();
}

void make_study(const Study &study, StudyOptions o) {
  o.folder = fs::absolute(o.folder).lexically_normal().string();
  o.liggghts = fs::absolute(o.liggghts).lexically_normal().string();
  const int n = static_cast<int>(study.runs.size());
  if (o.only > n)
    throw Failure(kBadInput, fmt::format("--only {}: the study has {} runs.", o.only, n));
  if (const std::string wrong = wrong_program(o.liggghts); !wrong.empty())
    throw Failure(kBadInput, wrong);
  make_output_folder(o.folder);
  fs::create_directories(o.folder + "/packings");
  fs::create_directories(o.folder + "/runs");
  Making making(study, o);
  write_file(o.folder + "/study.json", making.description().dump(2) + "\n");
  const int there = making.count("done") + making.count(kChecksFailed);
  fmt::print("study: {} runs, {} of them there -> {}\n", n, there, o.folder);
  std::cout << std::flush;
  if (o.only > 0)
    in_parallel(1, 1, [&](int) { making.make(o.only - 1); });
  else if (!o.table)
    in_parallel(n, o.jobs, [&](int k) { making.make(k); });
  making.write_table();
  fmt::print("study: {} of {} runs done, {}/study.csv\n", making.count("done"), n, o.folder);
  if (stop_requested())
    throw Failure(kSimulationFailed, "study: stopped on request. What was computed is kept; the "
                                     "same command goes on.");
  if (const std::string failures = making.failures(); !failures.empty())
    throw Failure(making.count("failed") > 0 ? kSimulationFailed : kCheckFailed,
                  "study: some runs are not usable:" + failures);
}

} // namespace calendem
