// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that run beside each other, a given number at a time.
#ifndef CALENDEM_BASE_JOB_POOL_H
#define CALENDEM_BASE_JOB_POOL_H

#include <functional>
#include <string>
#include <vector>

namespace calendem {

/// Runs a program, its output to the end of `log`; waits. A request to stop is passed on. Returns
/// its exit status; 128 + signal if it was killed. Throws Failure(2) if it cannot be started.
int run_program(const std::vector<std::string> &words, const std::string &log);

/// Calls `work(0)` .. `work(n - 1)`, `jobs` at a time, in order; begins no more once asked to stop.
void in_parallel(int n, int jobs, const std::function<void(int)> &work);

} // namespace calendem

#endif
