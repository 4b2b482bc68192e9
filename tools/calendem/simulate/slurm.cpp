// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/liggghts_job.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "simulate/making.h"
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace calendem {

namespace {

struct Answer {
  int status = 0;
  std::string text;
};

struct Scratch {
  std::string file;
  ~Scratch() { std::filesystem::remove(file); }
};

/// What one of Slurm's commands says.
Answer ask(const std::vector<std::string> &words, const std::string &folder) {
  ChildProgram command;
  command.words = words;
  const Scratch said = {fmt::format("{}/.{}.{}", folder, words[0], getpid())};
  command.output = said.file;
  command.folder = folder;
  command.remedy = "--slurm needs Slurm's commands: call it on a login node of the cluster. For "
                   "another scheduler --slurm-dry-run writes the scripts and submits nothing.";
  int status = 0;
  waitpid(start_child(command), &status, 0);
  std::ostringstream text;
  text << std::ifstream(said.file).rdbuf();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text.str()};
}

std::string quoted(const std::string &word) {
  std::string out = "'";
  for (const char c : word)
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

} // namespace

bool SlurmTask::live() const {
  static const std::vector<std::string> over = {
      "COMPLETED", "FAILED",    "TIMEOUT",  "CANCELLED",     "NODE_FAIL",     "PREEMPTED",
      "REVOKED",   "BOOT_FAIL", "DEADLINE", "OUT_OF_MEMORY", "LAUNCH_FAILED", "UNKNOWN"};
  return std::find(over.begin(), over.end(), state) == over.end();
}

std::string ranges_of(const std::vector<int> &numbers) {
  std::string out;
  for (std::size_t k = 0; k < numbers.size();) {
    std::size_t last = k;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1)
      ++last;
    out += (k > 0 ? "," : "") + std::to_string(numbers[k]);
    if (last > k)
      out += "-" + std::to_string(numbers[last]);
    k = last + 1;
  }
  return out;
}

std::string array_script(const SlurmArray &a) {
  const std::string tasks = ranges_of(a.tasks);
  std::string command;
  for (const std::string &word : a.command)
    command += quoted(word) + " ";
  return fmt::format("#!/bin/bash\n"
                     "# {0}\n"
                     "# Written by calendem. From this folder: sbatch {1}.sh\n"
                     "# On another scheduler: bash {1}.sh NUMBER, once for each of {2}\n"
                     "#SBATCH --nodes=1\n"
                     "#SBATCH --ntasks={3}\n"
                     "{4}"
                     "#SBATCH --job-name={5}\n"
                     "#SBATCH --array={2}{6}\n"
                     "#SBATCH --output={1}.%a.log\n"
                     "exec {7}\"${{SLURM_ARRAY_TASK_ID:-$1}}\"\n",
                     a.purpose, a.file, tasks, a.ranks,
                     a.options.empty() ? "" : "#SBATCH " + a.options + "\n", a.name,
                     a.at_once > 0 ? fmt::format("%{}", a.at_once) : "", command);
}

long submit_array(const SlurmArray &a, const std::vector<long> &after) {
  std::vector<std::string> words = {"sbatch", "--parsable"};
  std::string jobs;
  for (const long job : after)
    jobs += fmt::format(":{}", job);
  if (!jobs.empty())
    words.push_back("--dependency=afterany" + jobs);
  words.push_back(a.file + ".sh");
  const Answer answer = ask(words, a.folder);
  std::istringstream lines(answer.text); // it may warn before it gives the number
  for (std::string line; std::getline(lines, line);)
    if (const long job = std::strtol(line.c_str(), nullptr, 10); answer.status == 0 && job > 0)
      return job;
  throw Failure(
      kBadInput,
      "sbatch refused {}/{}.sh (exit status {}):\n{}Give what it asks for with --sbatch; the array "
      "may have more tasks than the cluster allows (MaxArraySize, MaxSubmitJobs).",
      a.folder, a.file, answer.status, answer.text);
}

void check_slurm(const std::string &scratch) { ask({"sbatch", "--version"}, scratch); }

std::map<int, SlurmTask> tasks_of(const std::string &name, const std::string &scratch) {
  const Answer answer =
      ask({"squeue", "--noheader", "--array", "--states=all", fmt::format("--user={}", getuid()),
           "--name=" + name, "--format=%F|%K|%T|%r"},
          scratch);
  if (answer.status != 0)
    throw Failure(kBadInput,
                  "squeue failed (exit status {}): {}What is in the queue is not known; try again "
                  "when Slurm answers.",
                  answer.status, answer.text);
  std::map<int, SlurmTask> tasks;
  std::istringstream lines(answer.text);
  for (std::string line; std::getline(lines, line);) {
    SlurmTask task;
    std::istringstream cells(line);
    std::string number;
    char bar = 0;
    if (!(cells >> task.job >> bar) || !std::getline(cells, number, '|') ||
        !std::getline(cells, task.state, '|'))
      continue;
    std::getline(cells, task.reason);
    SlurmTask &known = tasks[std::atoi(number.c_str())];
    if (task.job >= known.job)
      known = task;
  }
  return tasks;
}

std::string state_in_accounts(long job, int task, const std::string &scratch) {
  const Answer answer = ask({"sacct", "--noheader", "--allocations", "--parsable2",
                             "--format=State", fmt::format("--jobs={}_{}", job, task)},
                            scratch);
  return answer.status == 0 ? answer.text.substr(0, answer.text.find('\n')) : "";
}

namespace fs = std::filesystem;
namespace {

using Tasks = std::map<int, SlurmTask>; // by number of the run

SlurmArray array_of(const StudyOptions &o, StudyStep step) {
  const bool packings = step == StudyStep::Packing;
  SlurmArray a;
  a.file = packings ? "packings" : "runs";
  // the name identifies the arrays of one folder among all others, without a list of their numbers
  a.name = "calendem-" + hash_of_text(o.folder) + "-" + a.file;
  a.folder = o.folder + "/slurm";
  a.purpose = packings ? "A task makes the packing of the run of its number."
                       : "A task makes the run of its number, when the packings are there.";
  a.command = {o.calendem,
               o.verb,
               fs::absolute(o.file).lexically_normal().string(),
               "--output",
               o.folder,
               "--liggghts",
               o.liggghts,
               "--ranks",
               std::to_string(o.ranks),
               "--step",
               packings ? "packing" : "run",
               "--only"};
  a.command.insert(a.command.begin() + 3, o.further.begin(), o.further.end());
  a.at_once = o.jobs;
  a.ranks = o.ranks;
  a.options = o.slurm.sbatch;
  return a;
}

void say(const std::string &text) { std::cout << "slurm: " << text << std::endl; }

class SlurmStudy {
public:
  SlurmStudy(Making &making, const Study &study, const StudyOptions &o)
      : making_(making), study_(study), o_(o), packings_(array_of(o, StudyStep::Packing)),
        runs_(array_of(o, StudyStep::Run)) {}

  void submit() {
    const WaitingLock lock(runs_.folder + "/.lock"); // the same command, given twice
    if (!o_.slurm.dry_run)
      look();
    std::vector<long> before;
    for (const auto &[number, task] : packing_tasks_)
      if (task.live() && std::find(before.begin(), before.end(), task.job) == before.end())
        before.push_back(task.job);
    packings_.tasks = not_in_queue(making_.packings_to_make(), packing_tasks_, packings_.file);
    runs_.tasks = not_in_queue(making_.runs_to_make(), run_tasks_, runs_.file);
    if (const long job = send(packings_, {}))
      before.push_back(job);
    send(runs_, before);
  }

  void follow() {
    const StopRequests while_it_waits;
    std::set<int> suspects; // their files may come late
    for (bool first = true; first || in_queue() || !suspects.empty(); first = false) {
      if (!first)
        wait();
      if (!try_to_look())
        continue;
      making_.refresh();
      report();
      suspects = lose_or_suspect(suspects);
    }
  }

private:
  Making &making_;
  const Study &study_;
  const StudyOptions &o_;
  SlurmArray packings_, runs_;
  Tasks packing_tasks_, run_tasks_;
  std::set<int> lost_;
  std::string reported_;

  int number(int k) const { return study_.runs[k].number; }

  bool live(const Tasks &tasks, int k) const {
    const auto found = tasks.find(number(k));
    return found != tasks.end() && found->second.live();
  }

  std::vector<int> not_in_queue(const std::vector<int> &runs, const Tasks &tasks,
                                const std::string &what) const {
    std::vector<int> out;
    for (const int k : runs)
      if (!live(tasks, k))
        out.push_back(number(k));
    if (out.size() < runs.size())
      say(fmt::format("{} {} in the queue already", runs.size() - out.size(), what));
    return out;
  }

  /// Runs that have no result and no task: lost if they were suspected already, else suspects.
  std::set<int> lose_or_suspect(const std::set<int> &before) {
    std::set<int> suspects;
    for (const int k : making_.runs_to_make()) {
      if (lost_.count(k) > 0 || live(run_tasks_, k))
        continue;
      if (before.count(k) > 0)
        lose(k);
      else
        suspects.insert(k);
    }
    return suspects;
  }

  /// Writes the script, submits it; the job, or 0 if there was nothing to submit.
  long send(const SlurmArray &array, const std::vector<long> &after) const {
    if (array.tasks.empty())
      return 0;
    const std::string script = array.folder + "/" + array.file + ".sh";
    write_file(script, array_script(array));
    if (o_.slurm.dry_run) {
      say(fmt::format("{} is written, tasks {}; nothing is submitted", script,
                      ranges_of(array.tasks)));
      return 0;
    }
    const long job = submit_array(array, after);
    say(fmt::format("{} submitted as job {}, tasks {}", script, job, ranges_of(array.tasks)));
    return job;
  }

  void look() {
    const auto remember = [](Tasks &tasks, const Tasks &now) {
      for (auto &[number, task] : tasks) // no longer known to Slurm
        if (now.count(number) == 0 && task.live())
          task.state = "UNKNOWN";
      for (const auto &[number, task] : now)
        tasks[number] = task;
    };
    remember(packing_tasks_, tasks_of(packings_.name, packings_.folder));
    remember(run_tasks_, tasks_of(runs_.name, runs_.folder));
  }

  bool try_to_look() {
    try {
      look();
      return true;
    } catch (const Failure &) { // its controller may be down for a while; the jobs go on
      const std::string text = "no answer from squeue, trying again";
      if (text != reported_)
        say(text);
      reported_ = text;
      return false;
    }
  }

  bool in_queue() const {
    const auto live = [](const auto &task) { return task.second.live(); };
    return std::any_of(packing_tasks_.begin(), packing_tasks_.end(), live) ||
           std::any_of(run_tasks_.begin(), run_tasks_.end(), live);
  }

  void wait() const {
    for (int tenth = 0; tenth < 10 * o_.slurm.every_s && !stop_requested(); ++tenth)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (stop_requested())
      throw Failure(kSimulationFailed,
                    "study: stopped on request. Its jobs stay in Slurm's queue; the same command "
                    "waits for them again. To end them: scancel --name={},{}",
                    packings_.name, runs_.name);
  }

  static std::string shown(const Tasks &tasks) {
    int running = 0, waiting = 0;
    std::string reason;
    for (const auto &[number, task] : tasks) {
      running += task.live() && task.state != "PENDING";
      waiting += task.state == "PENDING";
      if (task.state == "PENDING" && reason.empty())
        reason = " (" + task.reason + ")";
    }
    return fmt::format("{} running, {} waiting{}", running, waiting, reason);
  }

  void report() {
    std::string text = fmt::format("{} of {} runs done, {}", making_.count("done"),
                                   study_.runs.size(), shown(run_tasks_));
    if (!making_.packings_to_make().empty())
      text += "; packings: " + shown(packing_tasks_);
    if (text != reported_)
      say(text);
    reported_ = text;
  }

  void lose(int k) {
    lost_.insert(k);
    const bool unpacked = !making_.packed(k);
    const SlurmTask &task = run_tasks_[number(k)];
    std::string state = task.state;
    if (const std::string s = state_in_accounts(task.job, number(k), runs_.folder); !s.empty())
      state = s;
    making_.lost(k, fmt::format("{}task {}_{} ended as {} and printed {}/{}.{}.log",
                                unpacked ? "its packing does not exist; " : "", task.job, number(k),
                                state, runs_.folder, runs_.file, number(k)));
  }
};

} // namespace

void make_by_slurm(Making &making, const Study &study, const StudyOptions &o) {
  const std::string folder = o.folder + "/slurm";
  fs::create_directories(folder);
  if (!o.slurm.dry_run)
    check_slurm(folder);
  SlurmStudy slurm(making, study, o);
  slurm.submit();
  if (!o.slurm.dry_run)
    slurm.follow();
}

} // namespace calendem
