// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that this one starts and is asked to stop, among them LIGGGHTS under mpirun.
#ifndef CALENDEM_BASE_LIGGGHTS_JOB_H
#define CALENDEM_BASE_LIGGGHTS_JOB_H

#include <csignal>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace calendem {

/// While one lives, SIGINT, SIGTERM and SIGHUP do not end the program but are remembered. A signal
/// that was ignored before (nohup, a script's background job) stays ignored.
class StopRequests {
public:
  StopRequests(); ///< forgets earlier requests
  ~StopRequests();
  StopRequests(const StopRequests &) = delete;
  StopRequests &operator=(const StopRequests &) = delete;

private:
  struct sigaction before_[3];
};

/// The last signal that asked to stop; 0: none.
int stop_requested();

struct ChildProgram {
  std::vector<std::string> words; ///< the program, found in PATH, and its arguments
  std::string output;             ///< file that takes what it prints
  bool append = false;            ///< to the end of that file
  std::string folder;             ///< its working folder; empty: this program's
  std::string remedy;             ///< what to do if it cannot be started
  /// Variables of its environment, NAME and value; the others are this program's.
  std::vector<std::pair<std::string, std::string>> environment;
};

/// Starts the program with an empty input, in a process group of its own: a terminal's Ctrl-C
/// reaches this program only, which signals the child once (mpirun signalled twice leaves its ranks
/// behind). Returns its process id. Throws Failure(2) if it cannot be started.
pid_t start_child(const ChildProgram &child);

// Programs that run beside each other, a given number at a time.

/// Runs a program, its output to the end of `log`; waits. A request to stop is passed on. Returns
/// its exit status; 128 + signal if it was killed. Throws Failure(2) if it cannot be started.
int run_program(const std::vector<std::string> &words, const std::string &log);

/// Calls `work(0)` .. `work(n - 1)`, `jobs` at a time, in order; begins no more once asked to stop.
void in_parallel(int n, int jobs, const std::function<void(int)> &work);

struct LiggghtsJob {
  std::string program; ///< path of liggghts
  int ranks = 2;       ///< >= 1
  std::string script;  ///< input script
  std::string log;    ///< log.liggghts; its folder is the working folder, so paths must be absolute
  std::string screen; ///< file that takes what the program prints
  std::vector<std::pair<std::string, std::string>> variables; ///< -var NAME VALUE
  std::uintmax_t room =
      0; ///< bytes that must stay free on the disk of `log`, else the job is stopped
};

/// What is wrong with the program, what to do; empty if it can be started.
std::string wrong_program(const std::string &program);

/// What is wrong with a path for LIGGGHTS's scripts, what to do; empty if they can take it.
std::string wrong_path(const std::string &path);

/// Runs the job; calls `tick` about twice a second meanwhile. SIGINT, SIGTERM and SIGHUP are passed
/// on. mpirun and its ranks have a folder of their own in the folder for temporary files (TMPDIR),
/// which is removed at the end. Throws Failure(3) with LIGGGHTS's own error if it fails or is
/// stopped, Failure(2) if it cannot be started.
void run_liggghts(const LiggghtsJob &job, const std::function<void()> &tick);

} // namespace calendem

#endif
