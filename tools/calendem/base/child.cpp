// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/child.h"
#include "base/messages.h"
#include <atomic>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <spawn.h>

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

} // namespace calendem
