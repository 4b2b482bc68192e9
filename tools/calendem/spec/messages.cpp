// SPDX-License-Identifier: GPL-2.0-or-later
#include "spec/messages.h"
#include <fmt/format.h>

namespace calendem {

void Mistakes::add(int line, const std::string &text) {
  list_.push_back(line > 0 ? fmt::format("{}:{}: {}", file_, line, text)
                           : fmt::format("{}: {}", file_, text));
}

std::string Mistakes::text() const { return fmt::format("{}", fmt::join(list_, "\n")); }

void Mistakes::stop_if_any() const {
  if (!empty())
    throw Failure(kBadInput, text());
}

} // namespace calendem
