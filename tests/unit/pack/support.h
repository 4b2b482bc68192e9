// SPDX-License-Identifier: GPL-2.0-or-later
// A recipe for tests, made through the reader as a user's would be.
#ifndef CALENDEM_TESTS_UNIT_PACK_SUPPORT_H
#define CALENDEM_TESTS_UNIT_PACK_SUPPORT_H

#include "base/recipe.h"
#include "support/test_folder.h"
#include <fstream>
#include <string>

namespace calendem_test {

/// `lines` is a TOML file; what it leaves out has the default.
inline calendem::Recipe recipe_of(const std::string &lines) {
  const std::filesystem::path file = test_folder() / "recipe.toml";
  std::ofstream(file) << lines;
  return calendem::read_recipe(file.string());
}

/// Its particles are the paper's.
inline calendem::Recipe cell(double side, int seed = 1) {
  return recipe_of("name = \"test\"\nmaterial = \"xu2023\"\nseed = " + std::to_string(seed) +
                   "\n[cell]\nx_um = " + std::to_string(side) + "\ny_um = " + std::to_string(side) +
                   "\n");
}

} // namespace calendem_test

#endif
