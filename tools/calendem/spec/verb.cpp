// SPDX-License-Identifier: GPL-2.0-or-later
#include "spec/verb.h"
#include "spec/case.h"
#include "spec/recipe.h"
#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <fstream>
#include <iterator>

namespace calendem {
namespace {

// A case names its electrode's folder; a recipe has none of a case's tables.
bool looks_like_case(const std::string &file) {
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  for (const char *word :
       {"electrode =", "electrode=", "[platen", "[bond", "[material", "[numerics"})
    if (text.find(word) != std::string::npos)
      return true;
  return false;
}

void validate(const std::vector<std::string> &files) {
  std::string problems;
  for (const std::string &file : files)
    try {
      const bool is_case = looks_like_case(file);
      if (is_case)
        read_case(file);
      else
        read_recipe(file);
      fmt::print("{}: a valid {}\n", file, is_case ? "case" : "recipe");
    } catch (const Failure &e) {
      problems += std::string(problems.empty() ? "" : "\n") + e.what();
    }
  if (!problems.empty())
    throw Failure(kBadInput, problems);
}

} // namespace

void add_validate_verb(CLI::App &app) {
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App *verb = app.add_subcommand("validate", "Every mistake in recipes and cases, at once");
  verb->add_option("FILE", *files, "TOML files")->required();
  verb->callback([files] { validate(*files); });
}

} // namespace calendem
