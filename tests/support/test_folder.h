// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef CALENDEM_TESTS_SUPPORT_TEST_FOLDER_H
#define CALENDEM_TESTS_SUPPORT_TEST_FOLDER_H

#include <filesystem>
#include <gtest/gtest.h>
#include <string>

namespace calendem_test {

/// A new folder of the running test, emptied.
inline std::filesystem::path test_folder() {
  const auto *info = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("calendem_") + info->test_suite_name() + "_" + info->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

} // namespace calendem_test

#endif
