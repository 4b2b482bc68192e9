// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/liggghts_job.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <mutex>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char **environ;

namespace calendem {

namespace {

const int kStopSignals[] = {SIGINT, SIGTERM, SIGHUP};
std::atomic<int> received{0}; // lock-free, for the handler and the threads
void on_signal(int number) { received = number; }

} // namespace

StopRequests::StopRequests() {
  received = 0;
  struct sigaction to_us = {};
  to_us.sa_handler = on_signal;
  for (int k = 0; k < 3; ++k) {
    sigaction(kStopSignals[k], nullptr, &before_[k]);
    if (before_[k].sa_handler != SIG_IGN)
      sigaction(kStopSignals[k], &to_us, nullptr);
  }
}

StopRequests::~StopRequests() {
  for (int k = 0; k < 3; ++k)
    sigaction(kStopSignals[k], &before_[k], nullptr);
}

int stop_requested() { return received; }

namespace {

/// This program's environment with the child's own variables, each NAME=VALUE.
std::vector<std::string> environment_of(const ChildProgram &child) {
  std::vector<std::string> out;
  for (const auto &[name, value] : child.environment)
    out.push_back(fmt::format("{}={}", name, value));
  for (char **e = environ; *e; ++e) {
    const std::string variable = *e, name = variable.substr(0, variable.find('='));
    if (std::none_of(child.environment.begin(), child.environment.end(),
                     [&](const auto &own) { return own.first == name; }))
      out.push_back(variable);
  }
  return out;
}

/// As posix_spawn takes it; valid as long as the words are.
std::vector<char *> pointers_to(const std::vector<std::string> &words) {
  std::vector<char *> out;
  for (const std::string &w : words)
    out.push_back(const_cast<char *>(w.c_str()));
  out.push_back(nullptr);
  return out;
}

/// What the child does between fork and exec, with calls alone that are safe there; returns if it
/// cannot become the program. The kernel ends it when the thread that started it is gone: this
/// program, killed, cannot pass that on.
void become(const ChildProgram &child, char *const *argv, char *const *envp, pid_t parent) {
  setpgid(0, 0); // its own
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent)
    _exit(kUsage);
  const int in = open("/dev/null", O_RDONLY),
            out = open(child.output.c_str(),
                       O_WRONLY | O_CREAT | (child.append ? O_APPEND : O_TRUNC), 0644);
  if (in >= 0 && out >= 0 && dup2(in, 0) == 0 && dup2(out, 1) == 1 && dup2(out, 2) == 2 &&
      (child.folder.empty() || chdir(child.folder.c_str()) == 0))
    execvpe(argv[0], argv, envp);
}

} // namespace

pid_t start_child(const ChildProgram &child) {
  const std::vector<std::string> environment = environment_of(child);
  const std::vector<char *> argv = pointers_to(child.words), envp = pointers_to(environment);
  int report[2]; // closed by exec; else it brings the error
  const pid_t parent = getpid();
  int error = pipe2(report, O_CLOEXEC) == 0 ? 0 : errno;
  const pid_t pid = error == 0 ? fork() : -1;
  if (pid == 0) {
    become(child, argv.data(), envp.data(), parent);
    error = errno;
    _exit(write(report[1], &error, sizeof error) == sizeof error ? kUsage : kBadInput);
  }
  if (error == 0) {
    error = pid < 0 ? errno : 0;
    close(report[1]);
    if (pid > 0 && read(report[0], &error, sizeof error) > 0)
      waitpid(pid, nullptr, 0);
    close(report[0]);
  }
  if (error != 0)
    throw Failure(kBadInput, "cannot start {}: {}. {}", child.words[0], std::strerror(error),
                  child.remedy);
  return pid;
}

int run_program(const std::vector<std::string> &words, const std::string &log) {
  ChildProgram program;
  program.words = words;
  program.output = log;
  program.append = true;
  const pid_t pid = start_child(program);
  int status = 0;
  for (bool signalled = false; waitpid(pid, &status, WNOHANG) == 0;) {
    if (stop_requested() && !signalled)
      signalled = kill(pid, SIGTERM) == 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void in_parallel(int n, int jobs, const std::function<void(int)> &work) {
  const StopRequests while_they_run;
  std::atomic<int> next{0};
  std::exception_ptr first;
  std::mutex guard;
  std::vector<std::thread> threads;
  for (int k = 0; k < std::min(n, jobs); ++k)
    threads.emplace_back([&] {
      for (int i = next++; i < n && !stop_requested(); i = next++)
        try {
          work(i);
        } catch (...) {
          const std::lock_guard<std::mutex> lock(guard);
          if (!first)
            first = std::current_exception();
          next = n;
        }
    });
  for (std::thread &t : threads)
    t.join();
  if (first)
    std::rethrow_exception(first);
}

namespace {

std::vector<std::string> command_line(const LiggghtsJob &job) {
  std::vector<std::string> words = {"mpirun", "-np", std::to_string(job.ranks)};
  // More ranks than cores: an idle rank gives its core away at every step. As many as the machine
  // has: each keeps a core, or beside another program two ranks share one and wait for each other.
  // Fewer are left to move: OpenMPI would tie the ranks of every run to the same first cores.
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const bool all = job.ranks == cores && cores == sysconf(_SC_NPROCESSORS_ONLN);
  if (job.ranks > cores)
    words.push_back("--oversubscribe");
  else if (!std::getenv("OMPI_MCA_hwloc_base_binding_policy")) // the user's, if there is one
    words.insert(words.end(), {"--bind-to", all ? "core:if-supported" : "none"});
  words.insert(words.end(), {job.program, "-in", job.script, "-log", job.log});
  for (const auto &[name, value] : job.variables) {
    if (!value.empty() && value.front() == '-')
      throw Failure(kBadInput,
                    "{} = {}: LIGGGHTS takes a negative value on its command line for a switch; "
                    "none of these settings may be negative",
                    name, value);
    if (const std::string wrong = wrong_path(value); !wrong.empty())
      throw Failure(kBadInput, wrong);
    words.insert(words.end(), {"-var", name, value});
  }
  return words;
}

/// A folder for the temporary files of one mpirun. All runs of OpenMPI on a machine share one by
/// default; a run that ends removes it if it sees no other run in it, and one that starts just then
/// fails. TMPDIR gives way to a user's own orte_tmpdir_base, in whichever way that is set.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::error_code none;
    const auto base = std::filesystem::temp_directory_path(none);
    if (none)
      return;
    std::string path = (std::filesystem::absolute(base) / "calendem.XXXXXX").string();
    if (mkdtemp(path.data()))
      path_ = path;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty())
      std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;

  /// Empty if none could be made; mpirun then uses what it finds, as any other program does.
  const std::string &path() const { return path_; }

private:
  std::string path_;
};

std::string folder_of(const LiggghtsJob &job) {
  return std::filesystem::path(job.log).parent_path().string();
}

pid_t start(const LiggghtsJob &job, const std::string &temporary) {
  ChildProgram mpirun;
  if (geteuid() == 0)
    mpirun.environment = {{"OMPI_ALLOW_RUN_AS_ROOT", "1"}, {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"}};
  if (!temporary.empty())
    mpirun.environment.emplace_back("TMPDIR", temporary);
  mpirun.words = command_line(job);
  mpirun.output = job.screen;
  // the host writes a forced restart file into its working folder when it is asked to stop
  mpirun.folder = folder_of(job);
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
  return path.find_first_of(" \t\n\"'$#&*%;()<>|`\\?") == std::string::npos
             ? ""
             : fmt::format(
                   "'{}': LIGGGHTS cannot take a path with a blank, a quote or one of "
                   "$ # & * % ; ( ) < > | ` \\ ? in it. Move the folder, or give another one.",
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
  const TemporaryFolder temporary;
  int status = 0;
  const std::string stopped = wait_for(start(job, temporary.path()), job, status, tick);
  if (!stopped.empty())
    throw Failure(kSimulationFailed, stopped);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Failure(kSimulationFailed, "LIGGGHTS failed ({}):\n{}The whole output is in {}",
                  WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status))
                                      : fmt::format("exit status {}", WEXITSTATUS(status)),
                  own_error(job.screen), job.screen);
}

} // namespace calendem
