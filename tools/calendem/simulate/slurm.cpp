// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/slurm.h"
#include "base/child.h"
#include "base/messages.h"
#include "base/provenance.h"
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <sys/wait.h>
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
  throw Failure(kBadInput,
                fmt::format("sbatch refused {}/{}.sh (exit status {}):\n{}Give what it asks for "
                            "with --sbatch; the array may have more tasks than the cluster allows "
                            "(MaxArraySize, MaxSubmitJobs).",
                            a.folder, a.file, answer.status, answer.text));
}

void check_slurm(const std::string &scratch) { ask({"sbatch", "--version"}, scratch); }

std::map<int, SlurmTask> tasks_of(const std::string &name, const std::string &scratch) {
  const Answer answer =
      ask({"squeue", "--noheader", "--array", "--states=all", fmt::format("--user={}", getuid()),
           "--name=" + name, "--format=%F|%K|%T|%r"},
          scratch);
  if (answer.status != 0)
    throw Failure(kBadInput, fmt::format("squeue failed (exit status {}): {}What is in the queue "
                                         "is not known; try again when Slurm answers.",
                                         answer.status, answer.text));
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

} // namespace calendem
