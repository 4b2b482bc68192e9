// SPDX-License-Identifier: GPL-2.0-or-later
// Starts LIGGGHTS under mpirun and waits for it.
#ifndef CALENDEM_BASE_LIGGGHTS_JOB_H
#define CALENDEM_BASE_LIGGGHTS_JOB_H

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace calendem {

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
/// on. Throws Failure(3) with LIGGGHTS's own error if it fails or is stopped, Failure(2) if it
/// cannot be started.
void run_liggghts(const LiggghtsJob &job, const std::function<void()> &tick);

} // namespace calendem

#endif
