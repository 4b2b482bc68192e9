// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef CALENDEM_TESTS_SUPPORT_WITH_ALL_H
#define CALENDEM_TESTS_SUPPORT_WITH_ALL_H

#include <cstdlib>
#include <gtest/gtest.h>

namespace calendem_test {

/// How many worlds a statistic is counted in: `all` with tools/test --all, otherwise `some`. Its
/// tolerance follows from the number.
inline int with_all(int all, int some) { return std::getenv("CALENDEM_HEAVY") ? all : some; }

} // namespace calendem_test

/// First line of a test that runs with tools/test --all only.
#define CALENDEM_RUNS_WITH_ALL()                                                                   \
  if (!std::getenv("CALENDEM_HEAVY"))                                                              \
  GTEST_SKIP() << "skipped: " << __FILE__ << ": a test runs with tools/test --all"

#endif
