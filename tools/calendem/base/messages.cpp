// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {

void Mistakes::add(int line, const std::string &text) {
  if (line > 0 && told_ == most_) {
    ++untold_;
    return;
  }
  told_ += line > 0;
  list_.emplace_back(line, text);
}

std::string Mistakes::text() const {
  auto sorted = list_;
  const auto rank = [](const auto &entry) { return entry.first > 0 ? entry.first : INT_MAX; };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const auto &a, const auto &b) { return rank(a) < rank(b); });
  std::vector<std::string> rows;
  for (const auto &[line, text] : sorted)
    rows.push_back(line > 0 ? fmt::format("{}:{}: {}", file_, line, text)
                            : fmt::format("{}: {}", file_, text));
  if (untold_ > 0)
    rows.insert(rows.begin() + told_, fmt::format("{}: ... and {} more", file_, untold_));
  return fmt::format("{}", fmt::join(rows, "\n"));
}

void Mistakes::stop_if_any() const {
  if (!empty())
    throw Failure(kBadInput, text());
}

std::string as_list(const std::vector<std::string> &texts) {
  std::string out;
  for (const std::string &text : texts)
    out += "\n- " + text;
  return out;
}

} // namespace calendem
