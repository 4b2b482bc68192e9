// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank/bank_file.h"
#include "base/case.h"
#include "base/experiment.h"
#include "base/material_notes.h"
#include "base/particle_sizes.h"
#include "base/toml_reader.h"
#include "compare/observables.h"
#include "electrode/pack/from_structure.h"
#include "electrode/pack/measured_bodies.h"
#include "electrode/slurry/dry.h"
#include "electrode/tomogram.h"
#include "film_commands/film_commands.h"
#include "simulate/study_file.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace {

int keys_known(const toml::table &table, const std::string &prefix, const std::vector<Key> &keys) {
  int known = 0;
  for (const auto &[k, node] : table) {
    const std::string name = prefix + std::string(k.str());
    const auto begins = [&](const Key &key) {
      return key.name == name || key.name.rfind(name + ".", 0) == 0;
    };
    known += std::any_of(keys.begin(), keys.end(), begins);
    if (node.is_table())
      known += keys_known(*node.as_table(), name + ".", keys);
  }
  return known;
}

/// By what is in it: the kind that knows most of its keys and tables; of equals a recipe.
FileKind kind_of(const std::string &file) {
  Mistakes elsewhere(file); // the reader of that kind reports them
  const toml::table root = parse_toml(file, elsewhere).root;
  if (root.contains("experiment") || root.contains("condition"))
    return FileKind::Experiment;
  if (root.contains("study") || root.contains("vary"))
    return FileKind::Study;
  if (root.contains("bank"))
    return FileKind::Bank;
  if (root.contains("also_called") || root.contains("calibrated_on"))
    return FileKind::Material;
  FileKind best = FileKind::Recipe;
  int most = keys_known(root, "", recipe_keys());
  const auto consider = [&](FileKind kind, const std::vector<Key> &keys) {
    if (const int known = keys_known(root, "", keys); known > most) {
      best = kind;
      most = known;
    }
  };
  consider(FileKind::Case, case_keys());
  consider(FileKind::Tomogram, tomogram_keys());
  consider(FileKind::Film, film_keys());
  return best;
}

/// Prints what its user should know, too.
std::string recipe_in_words(const Recipe &recipe) {
  read_input(recipe);
  if (recipe.shapes.given() && !recipe.shapes.in_place) // as pack and dry do
    library_of(recipe);
  for (const std::string &text : notes_of(recipe))
    fmt::print("note: {}: {}\n", recipe.file, text);
  const std::string sizes = sizes_in_words(recipe);
  return sizes.empty() ? "recipe" : "recipe; " + sizes;
}

std::string experiment_in_words(const std::string &file) {
  const Experiment e = read_experiment(file);
  std::vector<std::string> not_said;
  for (const Condition &c : e.conditions)
    image_observables_of(e, c, not_said);
  return fmt::format("experiment of {} conditions", e.conditions.size());
}

std::string case_in_words(const Settings &settings) {
  std::string out = "case";
  if (const std::string &electrode = settings.text("electrode");
      !std::filesystem::exists(electrode))
    out += fmt::format("\n- {} is not there yet: calendem pack RECIPE -o {} makes it", electrode,
                       electrode);
  for (const std::string &slow : slow_speeds(settings))
    out += "\n- " + slow;
  return out;
}

std::string name_after_check(const std::string &file) {
  switch (kind_of(file)) {
  case FileKind::Experiment:
    return experiment_in_words(file);
  case FileKind::Study:
    return fmt::format("study of {} runs", read_study(file).runs.size());
  case FileKind::Bank: {
    const bank::Bank points = bank::read_bank(file);
    return fmt::format("bank of {} runs",
                       bank::study_of(points, bank::points_of(points.design)).runs.size());
  }
  case FileKind::Case:
    return case_in_words(read_case(file));
  case FileKind::Tomogram:
    read_tomogram_spec(file);
    return "tomogram";
  case FileKind::Film:
    recipe_in_words(read_film_recipe(file).recipe);
    return "recipe of a film";
  case FileKind::Material: {
    const ReferenceMaterial m = read_material(std::filesystem::absolute(file).string());
    return fmt::format("material of {} values, {}", m.values.size(),
                       m.calibrated() ? "calibrated" : "not calibrated");
  }
  default:
    return recipe_in_words(read_recipe(file));
  }
}

void validate(const std::vector<std::string> &files) {
  Mistakes mistakes;
  for (const std::string &file : files)
    try {
      fmt::print("{}: a valid {}\n", file, name_after_check(file));
    } catch (const Failure &e) {
      mistakes.add(e);
    }
  mistakes.stop_if_any();
}

} // namespace

void set_up_validate(CLI::App &verb) {
  auto files = std::make_shared<std::vector<std::string>>();
  verb.add_option("FILE", *files, "TOML files")->required();
  verb.footer(
      list_of_experiment_keys() +
      "Keys of the others: calendem pack --help, calendem run --help, calendem tomogram --help,\n"
      "calendem dry --help, calendem study --help");
  verb.callback([files] { validate(*files); });
}

} // namespace calendem
