// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef CALENDEM_TESTS_SUPPORT_REFUSAL_H
#define CALENDEM_TESTS_SUPPORT_REFUSAL_H

#include "base/messages.h"
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace calendem_test {

/// The message of the Failure(2) that `call` ends with; empty, and a failed test, without one.
template <class Call> std::string refusal(Call call) {
  try {
    call();
  } catch (const calendem::Failure &e) {
    EXPECT_EQ(e.exit_status(), calendem::kBadInput) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

inline void expect_parts(const std::string &text, const std::vector<std::string> &parts) {
  for (const std::string &part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in\n" << text;
}

} // namespace calendem_test

#endif
