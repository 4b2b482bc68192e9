// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>

namespace calendem {

std::string text_of(const Mistake &m) {
  std::string out = m.file.empty() ? m.what
                    : m.line > 0   ? fmt::format("{}:{}: {}", m.file, m.line, m.what)
                                   : fmt::format("{}: {}", m.file, m.what);
  if (!m.remedy.empty())
    out += ". What to do: " + m.remedy + ".";
  return out;
}

void Mistakes::add(int line, const std::string &what) {
  if (line > 0 && listed_ == most_) {
    ++unlisted_[file_];
    return;
  }
  listed_ += line > 0;
  list_.push_back({file_, line, what, ""});
}

void Mistakes::add(const std::string &file, const std::string &what, const std::string &remedy) {
  list_.push_back({file, 0, what, remedy});
}

void Mistakes::add(const Mistakes &others) {
  list_.insert(list_.end(), others.list_.begin(), others.list_.end());
  for (const auto &[file, more] : others.unlisted_)
    unlisted_[file] += more;
}

int Mistakes::count() const {
  int n = static_cast<int>(list_.size());
  for (const auto &[file, more] : unlisted_)
    n += more;
  return n;
}

std::string Mistakes::text() const {
  std::vector<std::string> files, rows;
  const auto remember = [&files](const std::string &file) {
    if (std::find(files.begin(), files.end(), file) == files.end())
      files.push_back(file);
  };
  for (const Mistake &m : list_)
    remember(m.file);
  for (const auto &[file, more] : unlisted_)
    remember(file);
  auto by_line = list_;
  std::stable_sort(by_line.begin(), by_line.end(),
                   [](const Mistake &a, const Mistake &b) { return a.line < b.line; });
  for (const std::string &file : files) {
    for (const Mistake &m : by_line)
      if (m.file == file && m.line > 0)
        rows.push_back(text_of(m));
    if (const auto more = unlisted_.find(file); more != unlisted_.end())
      rows.push_back(fmt::format("{}: ... and {} more", file, more->second));
    for (const Mistake &m : by_line)
      if (m.file == file && m.line <= 0)
        rows.push_back(text_of(m));
  }
  return fmt::format("{}", fmt::join(rows, "\n"));
}

void Mistakes::stop_if_any(ExitStatus exit_status) const {
  if (!empty())
    throw Failure(exit_status, text());
}

std::string as_list(const std::vector<std::string> &texts) {
  std::string out;
  for (const std::string &text : texts)
    out += "\n- " + text;
  return out;
}

namespace {

/// A message that cannot be written, as on a full disk, is no reason for another exit status.
void say(const std::string &message) { std::fputs(message.c_str(), stderr); }

} // namespace

int exit_status_of(const std::function<int()> &work) {
  int status = kDone;
  try {
    status = work();
  } catch (const Failure &e) {
    say(std::string(e.what()) + "\n");
    return e.exit_status();
  } catch (const std::bad_alloc &) {
    say("not enough memory. Take a smaller cell or image, or a machine with more.\n");
    return kBadInput;
  } catch (const nlohmann::json::exception &e) {
    say(fmt::format("a JSON file is not as calendem writes it ({}). Was it edited, or made by "
                    "another version? Make it again.\n",
                    e.what()));
    return kBadInput;
  } catch (const std::exception &e) {
    say(fmt::format("calendem: {}\n", e.what()));
    return kBadInput;
  }
  if (std::fflush(stdout) != 0 || !std::cout.flush()) {
    say("the output could not be written. Is the disk full?\n");
    return kBadInput;
  }
  return status;
}

} // namespace calendem
