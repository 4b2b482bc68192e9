// SPDX-License-Identifier: GPL-2.0-or-later
// pack, dry, tomogram, run, collect: electrodes, and what a press does to one.
#include "simulate/run.h"
#include "base/case.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "commands/commands.h"
#include "electrode/pack/measured_bodies.h"
#include "electrode/pack/pack.h"
#include "electrode/slurry/dry.h"
#include "electrode/tomogram.h"
#include "simulate/collect.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace calendem {

namespace fs = std::filesystem;
namespace {

const char *const kDefaultsOfMaterial =
    "Values of a material (material.*, bond.*, effects.*, particles.grains, densities): the "
    "defaults below are those of\n"
    "xu2023. The recipe's material takes their place, nmc111 where it names none "
    "(docs/reference/materials.md).\n\n";

/// A value that the scripts wrote down, as the key's kind.
std::string checked(const Key &key, const std::string &value, Mistakes &mistakes) {
  const bool is_text = key.text || !key.choices.empty();
  double number = 0.0;
  if (!is_text && !CLI::detail::lexical_cast(value, number))
    mistakes.add(0, "{} is '{}', which is not a number. Run the scripts again.", key.variable,
                 value);
  return value;
}

/// The settings that the scripts wrote down, lines "variable NAME index VALUE"; `electrode`, if not
/// empty, replaces the path that the run used.
Settings read_settings(const std::string &file, const std::string &electrode) {
  std::ifstream in(file);
  if (!in)
    throw Failure(
        kBadInput,
        "cannot read '{}': give the folder that the input scripts wrote into (-var out DIR)", file);
  std::map<std::string, std::string> values;
  std::string line, variable, name, index, value;
  while (std::getline(in, line))
    if (std::istringstream row(line.substr(0, line.find_last_not_of(" \r") + 1));
        row >> variable >> name >> index && std::getline(row >> std::ws, value))
      values[name] = value;
  Mistakes mistakes(file);
  Settings s;
  for (const Key &key : case_keys()) {
    if (key.variable.empty()) { // nothing that the scripts know of
      s.set(key.name, key.fallback);
      continue;
    }
    const auto found = values.find(key.variable);
    if (found == values.end())
      mistakes.add(0,
                   "'{}' is missing: the run was made by an older version, or the file is cut. Run "
                   "the scripts again.",
                   key.variable);
    else
      s.set(key.name, checked(key, found->second, mistakes));
  }
  mistakes.stop_if_any();
  s.set("electrode", fs::absolute(electrode.empty() ? s.text("electrode") : electrode)
                         .lexically_normal()
                         .string());
  return s;
}

/// A run that was collected before is of the electrode that it was collected with.
void stop_if_of_another(const std::string &folder, const std::string &electrode) {
  RunFolder before(folder);
  const nlohmann::json &old = before.object("summary.json");
  const std::string now = hash_of_file(electrode + "/electrode.data"),
                    then = old.is_object() && old.contains("provenance")
                               ? old["provenance"].value("electrode_data", now)
                               : now;
  if (then != now)
    throw Failure(kBadInput,
                  "'{}' was collected with another electrode (electrode.data then {}, now {}). "
                  "Give the one that it was pressed from with --electrode, or remove its "
                  "summary.json if that was the wrong one.",
                  folder, then, now);
}

/// The folder's case.toml has the settings of these scripts; what they do not know of is taken from
/// it.
bool is_of_case(const std::string &folder, Settings &settings) {
  Mistakes ignored(folder + "/case.toml");
  const Settings as_run = read_toml(ignored.file(), FileKind::Case, case_keys(), ignored);
  if (!ignored.empty())
    return false;
  for (const Key &key : case_keys())
    if (key.name != "electrode" && !key.variable.empty() &&
        as_run.text(key.name) != settings.text(key.name))
      return false;
  for (const Key &key : case_keys())
    if (key.variable.empty())
      settings.set(key.name, as_run.text(key.name));
  return true;
}

/// What only `calendem run` knew of the run, from the summary that it wrote.
void keep_what_run_knew(const nlohmann::json &before, nlohmann::json &summary) {
  for (const char *key : {"case_hash", "ranks", "wall_clock_s", "atom_steps_per_second"})
    if (before.contains(key))
      summary[key] = before[key];
  for (const char *key : {"liggghts", "input_scripts"})
    if (const auto at = nlohmann::json::json_pointer("/provenance") / key; before.contains(at))
      summary[at] = before[at];
}

void collect_folder(const std::string &folder, const std::string &electrode) {
  Settings settings = read_settings(folder + "/settings.txt", electrode);
  if (!fs::is_directory(folder + "/vtk"))
    throw Failure(kBadInput,
                  "'{}' has no folder vtk: its frames are needed to collect it. A study that keeps "
                  "tables only has removed them; run it again.",
                  folder);
  const ElectrodeFacts facts = read_electrode(settings.text("electrode"));
  stop_if_of_another(folder, settings.text("electrode"));
  const nlohmann::json before =
      is_of_case(folder, settings) ? RunFolder(folder).object("summary.json") : nlohmann::json();
  write_file(
      folder + "/case.toml",
      write_toml(settings, case_keys(),
                 fmt::format("# as run by the input scripts; read by calendem {}\n", version())));
  fs::copy_file(settings.text("electrode") + "/electrode.json", folder + "/electrode.json",
                fs::copy_options::overwrite_existing);
  nlohmann::json s = collect(folder, settings, facts, {});
  if (before.is_object() && before.value("steps", s["steps"]) == s["steps"]) {
    keep_what_run_knew(before, s);
    write_summary(folder, s);
  }
  fmt::print("collect: {} rows of the run up to {:.1f} MPa, {:.2f} % of bonds broken, {}\n",
             read_raw(folder + "/curve_raw.csv").size(), s["max_pressure_MPa"].get<double>(),
             100 * s["broken_fraction_after"].get<double>(),
             s["finished"].get<bool>() ? "finished" : "not finished");
  if (s["finished"].get<bool>())
    stop_if_checks_failed(s, folder);
}

} // namespace

void add_collect_verb(CLI::App &app) {
  struct Arguments {
    std::string folder, electrode;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App *verb = app.add_subcommand(
      "collect", "Make the files of a run from what the plain input scripts left");
  verb->add_option("DIR", a->folder, "folder that the scripts wrote (their -var out)")->required();
  verb->add_option("--electrode", a->electrode, "folder of the electrode, if it has moved");
  verb->callback([a] { collect_folder(fs::absolute(a->folder).string(), a->electrode); });
}

void add_run_verb(CLI::App &app) {
  struct Arguments {
    std::string spec;
    RunOptions options;
  };
  auto a = std::make_shared<Arguments>();
  a->options.liggghts = liggghts_program();
  CLI::App *verb =
      app.add_subcommand("run", "Press an electrode and release it, by running LIGGGHTS");
  verb->footer(kDefaultsOfMaterial + list_of_keys(case_keys()));
  verb->add_option("CASE", a->spec, "case (TOML)")->required();
  verb->add_option("-o,--output", a->options.folder, "folder of the run")->required();
  verb->add_option("--ranks", a->options.ranks, "MPI ranks")->check(CLI::Range(1, 4096));
  verb->add_flag("--resume", a->options.resume, "continue from the newest restart file");
  verb->add_flag("--force", a->options.force,
                 "overwrite a run of another case or an unfinished one");
  verb->add_option("--liggghts", a->options.liggghts, "program with the plugin");
  verb->callback([a] {
    const Settings settings = read_case(a->spec);
    for (const std::string &slow : slow_speeds(settings))
      fmt::print(stderr, "warning: {}\n", slow);
    run_case(settings, a->options);
  });
}

void add_pack_verb(CLI::App &app) {
  struct Arguments {
    std::string spec;
    long seed = -1;
    bool shapes_only = false;
    PackOptions options;
  };
  auto a = std::make_shared<Arguments>();
  a->options.liggghts = liggghts_program();
  CLI::App *verb =
      app.add_subcommand("pack", "Make an electrode from a recipe by running LIGGGHTS");
  verb->footer(kDefaultsOfMaterial + list_of_keys(recipe_keys()));
  verb->add_option("SPEC", a->spec, "recipe (TOML)")->required();
  verb->add_option("-o,--output", a->options.folder, "folder of the electrode")->required();
  verb->add_option("--seed", a->seed, "seed, instead of the recipe's")
      ->check(CLI::Range(0L, 4000000000L));
  verb->add_option("--ranks", a->options.ranks, "MPI ranks")->check(CLI::Range(1, 4096));
  verb->add_flag("--force", a->options.force, "overwrite an electrode of another recipe");
  verb->add_option("--liggghts", a->options.liggghts, "program with the plugin");
  verb->add_flag("--shapes-only", a->shapes_only,
                 "only take the shapes from the recipe's image, with what shows how they were "
                 "separated, into DIR/shapes (shapes.library of other recipes)");
  verb->callback([a] {
    Recipe recipe = read_recipe(a->spec);
    if (a->seed >= 0) {
      recipe.seed = static_cast<unsigned long>(a->seed);
      recipe.settings.set("seed", fmt::format("{}", a->seed));
    }
    if (a->shapes_only)
      write_shapes(recipe, a->options.folder);
    else
      pack_electrode(recipe, a->options);
  });
}

void add_dry_verb(CLI::App &app) {
  struct Arguments {
    std::string spec;
    DryOptions options;
  };
  auto a = std::make_shared<Arguments>();
  a->options.liggghts = liggghts_program();
  CLI::App *verb = app.add_subcommand(
      "dry", "Simulate slurry and drying of a recipe, by running LIGGGHTS: a film for pack");
  verb->footer(list_of_keys(film_keys()));
  verb->add_option("SPEC", a->spec, "recipe with [slurry] and [drying] (TOML)")->required();
  verb->add_option("-o,--output", a->options.folder, "folder of the film")->required();
  verb->add_option("--ranks", a->options.ranks, "MPI ranks")->check(CLI::Range(1, 4096));
  verb->add_option("--liggghts", a->options.liggghts, "program with the plugin");
  verb->callback([a] { dry_film(read_film_recipe(a->spec), a->options); });
}

void add_tomogram_verb(CLI::App &app) {
  struct Arguments {
    std::string spec, file;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App *verb =
      app.add_subcommand("tomogram", "Make a synthetic label image whose particles are known");
  verb->footer(list_of_keys(tomogram_keys()));
  verb->add_option("SPEC", a->spec, "what the image shows (TOML)")->required();
  verb->add_option("-o,--output", a->file,
                   "image (.mhd, .mha, .vti or .tif); beside it NAME.truth.csv")
      ->required();
  verb->callback([a] {
    const Tomogram t = make_tomogram(read_tomogram_spec(a->spec));
    write_label_image(t.image, a->file);
    const std::string truth =
        std::filesystem::path(a->file).replace_extension(".truth.csv").string();
    write_file(truth, truth_table(t.truth));
    fmt::print("tomogram: {} x {} x {} voxels of {} um, {} particles -> {}, {}\n", t.image.n[0],
               t.image.n[1], t.image.n[2], t.image.voxel[0], t.truth.size(), a->file, truth);
  });
}

} // namespace calendem
