// SPDX-License-Identifier: GPL-2.0-or-later
// A recipe for tests, made through the reader as a user's would be.
#ifndef CALENDEM_TESTS_UNIT_PACK_SUPPORT_H
#define CALENDEM_TESTS_UNIT_PACK_SUPPORT_H

#include "spec/recipe.h"
#include <filesystem>
#include <fstream>
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

/// `lines` is a TOML file; what it leaves out has the default.
inline calendem::Recipe recipe_of(const std::string &lines) {
  const std::filesystem::path file = test_folder() / "recipe.toml";
  std::ofstream(file) << lines;
  return calendem::read_recipe(file.string());
}

inline calendem::Recipe cell(double side, int seed = 1) {
  return recipe_of("name = \"test\"\nseed = " + std::to_string(seed) + "\n[cell]\nx_um = " +
                   std::to_string(side) + "\ny_um = " + std::to_string(side) + "\n");
}

} // namespace calendem_test

#endif
