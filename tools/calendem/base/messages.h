// SPDX-License-Identifier: GPL-2.0-or-later
// How the command line reports errors. A Mistake says where, what is wrong with the value met and
// what is allowed, and what to do. Mistakes collects them, so that all of a file are seen at once.
// Failure ends the program with them; exit_status_of prints it.
#ifndef CALENDEM_BASE_MESSAGES_H
#define CALENDEM_BASE_MESSAGES_H

#include <climits>
#include <fmt/core.h>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace calendem {

enum ExitStatus { kDone = 0, kUsage = 1, kBadInput = 2, kSimulationFailed = 3, kCheckFailed = 4 };

/// Ends the program with a message and an exit status.
class Failure : public std::runtime_error {
public:
  Failure(ExitStatus exit_status, const std::string &message)
      : std::runtime_error(message), exit_status_(exit_status) {}
  /// With values put into the message, as by fmt::format.
  template <class First, class... Others>
  Failure(ExitStatus exit_status, fmt::format_string<First, Others...> message, First &&first,
          Others &&...others)
      : Failure(exit_status,
                fmt::format(message, std::forward<First>(first), std::forward<Others>(others)...)) {
  }
  ExitStatus exit_status() const { return exit_status_; }

private:
  ExitStatus exit_status_;
};

/// Does the work of a program and returns its exit status. What is thrown becomes a message on stderr.
int exit_status_of(const std::function<int()> &work);

/// Each on a line of its own, after "- "; begins with a line's end.
std::string as_list(const std::vector<std::string> &texts);

struct Mistake {
  std::string file;   ///< or folder; empty: `what` names it
  int line = 0;       ///< 0: not bound to a line
  std::string what;   ///< what is wrong, the value met, what is allowed
  std::string remedy; ///< what to do; empty: `what` says it
};

/// "file:line: what. What to do: remedy."
std::string text_of(const Mistake &mistake);

/// Mistakes of one file, or of several.
class Mistakes {
public:
  /// `file` is that of mistakes added without one. Of its mistakes bound to a line the first `most`
  /// are listed, the rest counted: a long file of numbers has one for each row when it has one.
  explicit Mistakes(std::string file = "", int most = INT_MAX)
      : file_(std::move(file)), most_(most) {}
  /// `line` 0: not bound to a line.
  void add(int line, const std::string &what);
  /// With values put into the text, as by fmt::format.
  template <class First, class... Others>
  void add(int line, fmt::format_string<First, Others...> what, First &&first, Others &&...others) {
    add(line, fmt::format(what, std::forward<First>(first), std::forward<Others>(others)...));
  }
  void add(const std::string &file, const std::string &what, const std::string &remedy);
  void add(const Mistakes &others);
  /// What a reader of a file has thrown.
  void add(const Failure &failure) { list_.push_back({"", 0, failure.what(), ""}); }

  bool empty() const { return count() == 0; }
  int count() const;
  const std::string &file() const { return file_; }
  const std::vector<Mistake> &list() const { return list_; }
  /// One per line, file by file, in the order of the file; those without a line come last.
  std::string text() const;
  /// Throws Failure if there are any.
  void stop_if_any(ExitStatus exit_status = kBadInput) const;

private:
  std::string file_;
  int most_, listed_ = 0;
  std::map<std::string, int> unlisted_; ///< how many of a file
  std::vector<Mistake> list_;
};

} // namespace calendem

#endif
