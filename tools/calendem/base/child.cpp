// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/child.h"
#include "base/messages.h"
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <mutex>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>

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

std::string this_program() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

pid_t start_child(const ChildProgram &child) {
  std::vector<char *> argv;
  for (const std::string &w : child.words)
    argv.push_back(const_cast<char *>(w.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, child.output.c_str(),
                                   O_WRONLY | O_CREAT | (child.append ? O_APPEND : O_TRUNC), 0644);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  if (!child.folder.empty())
    posix_spawn_file_actions_addchdir_np(&actions, child.folder.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP); // 0: its own
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw Failure(kBadInput, fmt::format("cannot start {}: {}. {}", child.words[0],
                                         std::strerror(error), child.remedy));
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

} // namespace calendem
