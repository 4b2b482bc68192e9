// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that this one starts, and how it is asked to stop them.
#ifndef CALENDEM_BASE_CHILD_H
#define CALENDEM_BASE_CHILD_H

#include <csignal>
#include <functional>
#include <string>
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

/// Path of the program that runs, to start it again.
std::string this_program();

struct ChildProgram {
  std::vector<std::string> words; ///< the program, found in PATH, and its arguments
  std::string output;             ///< file that takes what it prints
  bool append = false;            ///< to the end of that file
  std::string folder;             ///< its working folder; empty: this program's
  std::string remedy;             ///< what to do if it cannot be started
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

} // namespace calendem

#endif
