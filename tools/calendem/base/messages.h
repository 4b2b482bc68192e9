// SPDX-License-Identifier: GPL-2.0-or-later
// How the command line reports errors: all mistakes of a file at once, each with the
// value received, what is allowed and what to do.
#ifndef CALENDEM_BASE_MESSAGES_H
#define CALENDEM_BASE_MESSAGES_H

#include <climits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace calendem {

enum ExitStatus { kDone = 0, kUsage = 1, kBadInput = 2, kSimulationFailed = 3, kCheckFailed = 4 };

/// Ends the program with a message and an exit status.
class Failure : public std::runtime_error {
public:
  Failure(int exit_status, const std::string &message)
      : std::runtime_error(message), exit_status_(exit_status) {}
  int exit_status() const { return exit_status_; }

private:
  int exit_status_;
};

/// Each on a line of its own, after "- "; begins with a line's end.
std::string as_list(const std::vector<std::string> &texts);

/// The mistakes of one file.
class Mistakes {
public:
  /// Of the mistakes bound to a line the first `most` are listed, the rest counted: a long file of
  /// numbers has one for each row when it has one.
  explicit Mistakes(std::string file, int most = INT_MAX) : file_(std::move(file)), most_(most) {}
  /// `line` 0: not bound to a line.
  void add(int line, const std::string &text);
  bool empty() const { return count() == 0; }
  int count() const { return static_cast<int>(list_.size()) + untold_; }
  const std::string &file() const { return file_; }
  /// One per line, in the order of the file; those without a line come last.
  std::string text() const;
  /// Throws Failure with exit status 2 if there are any.
  void stop_if_any() const;

private:
  std::string file_;
  int most_, told_ = 0, untold_ = 0;
  std::vector<std::pair<int, std::string>> list_;
};

} // namespace calendem

#endif
