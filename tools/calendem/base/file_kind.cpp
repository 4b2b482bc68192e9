// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/file_kind.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {
namespace {

struct Described {
  FileKind kind;
  const char *what, *verbs;
  std::vector<std::string> tables; ///< and keys that tell it, alone or together
};

const std::vector<Described> &kinds() {
  static const std::vector<Described> all = {
      {FileKind::Recipe,
       "an electrode's recipe",
       "pack",
       {"coating", "cell", "structure", "shapes"}},
      {FileKind::Film,
       "the recipe of a film",
       "dry",
       {"coating", "cell", "shapes", "slurry", "drying"}},
      {FileKind::Tomogram, "the description of a tomogram", "tomogram", {"image"}},
      {FileKind::Case, "a case", "run", {"electrode", "platen", "bond", "material", "numerics"}},
      {FileKind::Experiment, "an experiment", "compare or diagnose", {"experiment", "condition"}},
      {FileKind::Study, "a study", "study", {"study", "vary"}},
      {FileKind::Bank, "a bank", "bank", {"bank", "full_cell"}},
      {FileKind::Round, "a withheld round", "withheld make", {"round"}}};
  return all;
}

bool has(const Described &d, std::string_view table) {
  return std::find(d.tables.begin(), d.tables.end(), table) != d.tables.end();
}

/// Tables and keys of the file that tell what it is.
std::vector<std::string> telling(const toml::table &root) {
  std::vector<std::string> out;
  for (const auto &[key, node] : root)
    if (std::any_of(kinds().begin(), kinds().end(),
                    [name = key.str()](const Described &d) { return has(d, name); }))
      out.emplace_back(key.str());
  return out;
}

} // namespace

TomlFile parse_toml(const std::string &file, FileKind wanted, Mistakes &mistakes) {
  TomlFile out = parse_toml(file, mistakes);
  const std::vector<std::string> found = telling(out.root);
  const auto fits = [&](const Described &d) {
    return std::all_of(found.begin(), found.end(),
                       [&](const std::string &name) { return has(d, name); });
  };
  const auto is_wanted = [&](const Described &d) { return d.kind == wanted; };
  const auto right = std::find_if(kinds().begin(), kinds().end(), is_wanted);
  const auto is = std::find_if(kinds().begin(), kinds().end(), fits);
  if (!found.empty() && is != kinds().end() && !fits(*right))
    throw Failure(
        kBadInput,
        fmt::format("{}: this is {} (it has '{}'); {} is wanted here. Give it to calendem "
                    "{}; input_scripts/cases/ has examples of each.",
                    file, is->what, fmt::join(found, "', '"), right->what, is->verbs));
  return out;
}

} // namespace calendem
