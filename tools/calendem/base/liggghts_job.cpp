// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/liggghts_job.h"
#include "base/child.h"
#include "base/messages.h"
#include "base/provenance.h"
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace calendem {
namespace {

std::vector<std::string> command_line(const LiggghtsJob &job) {
  std::vector<std::string> words = {"mpirun", "-np", std::to_string(job.ranks)};
  // Only when there are more ranks than cores: it makes idle ranks give their core away at every
  // step.
  if (job.ranks > static_cast<int>(std::thread::hardware_concurrency()))
    words.push_back("--oversubscribe");
  words.insert(words.end(), {job.program, "-in", job.script, "-log", job.log});
  for (const auto &[name, value] : job.variables) {
    if (!value.empty() && value.front() == '-')
      throw Failure(kBadInput,
                    fmt::format("{} = {}: LIGGGHTS takes a negative value on its command line "
                                "for a switch; none of these settings may be negative",
                                name, value));
    if (const std::string wrong = wrong_path(value); !wrong.empty())
      throw Failure(kBadInput, wrong);
    words.insert(words.end(), {"-var", name, value});
  }
  return words;
}

pid_t start(const LiggghtsJob &job) {
  if (geteuid() == 0) {
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }
  // OpenMPI would tie the ranks of every run to the same first cores.
  setenv("OMPI_MCA_hwloc_base_binding_policy", "none", 0);
  ChildProgram mpirun;
  mpirun.words = command_line(job);
  mpirun.output = job.screen;
  // the host writes a forced restart file into its working folder when it is asked to stop
  mpirun.folder = std::filesystem::path(job.log).parent_path().string();
  mpirun.remedy = "Install OpenMPI (openmpi-bin) or load its module";
  return start_child(mpirun);
}

/// The lines that say why: LIGGGHTS's own errors, else mpirun's report of a rank that was killed,
/// else the last line.
std::string own_error(const std::string &screen) {
  std::ifstream in(screen);
  std::string line, errors, killed, last;
  while (std::getline(in, line)) {
    if (line.rfind("ERROR", 0) == 0 && errors.find(line) == std::string::npos)
      errors += line + "\n";
    if (line.find("exited on signal") != std::string::npos)
      killed += line + "\n";
    if (!line.empty() && line.find("---") == std::string::npos)
      last = line;
  }
  if (!errors.empty())
    return errors;
  return killed.empty() ? last + "\n" : killed;
}

std::string folder_of(const LiggghtsJob &job) {
  return std::filesystem::path(job.log).parent_path().string();
}

/// Why the job must be stopped, empty if it may go on.
std::string reason_to_stop(const LiggghtsJob &job) {
  if (const int signal = stop_requested())
    return fmt::format("stopped on request (signal {})", signal);
  const std::uintmax_t left = room_on_disk(folder_of(job));
  if (left < job.room)
    return fmt::format(
        "stopped because the disk of '{}' is almost full: {:.1f} MB are left, {:.1f} "
        "MB are needed for the next files. Make room",
        folder_of(job), 1e-6 * left, 1e-6 * job.room);
  return "";
}

/// Waits; returns the reason if the job was stopped. mpirun is signalled once and stops its ranks;
/// signalled twice it exits at once and the ranks keep running.
std::string wait_for(pid_t pid, const LiggghtsJob &job, int &status,
                     const std::function<void()> &tick) {
  std::string stopped;
  while (waitpid(pid, &status, WNOHANG) == 0) {
    if (stopped.empty()) {
      stopped = reason_to_stop(job);
      if (!stopped.empty())
        kill(pid, SIGTERM);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    tick();
  }
  return stopped;
}

} // namespace

std::string wrong_path(const std::string &path) {
  return path.find_first_of(" \t\n\"'$#&") == std::string::npos
             ? ""
             : fmt::format("'{}': LIGGGHTS cannot take a path with a blank, a quote, $, # or & in "
                           "it. Move the folder, or give another one.",
                           path);
}

std::string wrong_program(const std::string &program) {
  std::error_code none;
  if (!std::filesystem::exists(program, none))
    return fmt::format("no program '{}'. Build it with tools/build, or give its path with "
                       "--liggghts.",
                       program);
  if (std::filesystem::is_directory(program, none) || access(program.c_str(), X_OK) != 0)
    return fmt::format("'{}' is not a program that can be started. Give the path of liggghts with "
                       "--liggghts.",
                       program);
  return "";
}

void run_liggghts(const LiggghtsJob &job, const std::function<void()> &tick) {
  if (const std::string wrong = wrong_program(job.program); !wrong.empty())
    throw Failure(kBadInput, wrong);
  const StopRequests while_it_runs;
  int status = 0;
  const std::string stopped = wait_for(start(job), job, status, tick);
  if (!stopped.empty())
    throw Failure(kSimulationFailed, stopped);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Failure(kSimulationFailed,
                  fmt::format("LIGGGHTS failed ({}):\n{}The whole output is in {}",
                              WIFSIGNALED(status)
                                  ? fmt::format("signal {}", WTERMSIG(status))
                                  : fmt::format("exit status {}", WEXITSTATUS(status)),
                              own_error(job.screen), job.screen));
}

} // namespace calendem
