// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/job_pool.h"
#include "spec/messages.h"
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <fmt/format.h>
#include <mutex>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char **environ;

namespace calendem {
namespace {

std::atomic<int> signal_received{0}; // lock-free, for the handler and the threads
void on_signal(int number) { signal_received = number; }

} // namespace

bool asked_to_stop() { return signal_received != 0; }

int run_program(const std::vector<std::string> &words, const std::string &log) {
  std::vector<char *> argv;
  for (const std::string &w : words)
    argv.push_back(const_cast<char *>(w.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw Failure(kBadInput, fmt::format("cannot start '{}': {}.", words[0], strerror(error)));
  int status = 0;
  for (bool told = false; waitpid(pid, &status, WNOHANG) == 0;) {
    if (asked_to_stop() && !told)
      told = kill(pid, SIGTERM) == 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void in_parallel(int n, int jobs, const std::function<void(int)> &work) {
  signal_received = 0;
  struct sigaction to_us = {}, old_int = {}, old_term = {};
  to_us.sa_handler = on_signal;
  sigaction(SIGINT, &to_us, &old_int);
  sigaction(SIGTERM, &to_us, &old_term);
  std::atomic<int> next{0};
  std::exception_ptr first;
  std::mutex guard;
  std::vector<std::thread> threads;
  for (int k = 0; k < std::min(n, jobs); ++k)
    threads.emplace_back([&] {
      for (int i = next++; i < n && !asked_to_stop(); i = next++)
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
  sigaction(SIGINT, &old_int, nullptr);
  sigaction(SIGTERM, &old_term, nullptr);
  if (first)
    std::rethrow_exception(first);
}

} // namespace calendem
