// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/job_pool.h"
#include "base/child.h"
#include <algorithm>
#include <atomic>
#include <csignal>
#include <exception>
#include <mutex>
#include <sys/wait.h>
#include <thread>

namespace calendem {
int run_program(const std::vector<std::string> &words, const std::string &log) {
  ChildProgram program;
  program.words = words;
  program.output = log;
  program.append = true;
  const pid_t pid = start_child(program);
  int status = 0;
  for (bool told = false; waitpid(pid, &status, WNOHANG) == 0;) {
    if (stop_requested() && !told)
      told = kill(pid, SIGTERM) == 0;
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

} // namespace calendem
