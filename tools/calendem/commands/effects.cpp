// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "base/provenance.h"
#include "base/registry.h"
#include "commands/commands.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

void print_list() {
  fmt::print("{:<22} {:<12} {}\n", "effect", "layer", "what it is");
  for (const Effect &e : effects())
    fmt::print("{:<22} {:<12} {}\n", e.name, e.layer, e.what);
  fmt::print("\nOff is the base model. calendem effects NAME shows range, prior, what "
             "it moves and where it comes from.\n");
}

void print_one(const Effect &e) {
  const EffectParameter &a = e.parameter;
  const std::string unit = key_of(e).unit.empty() ? "" : " " + key_of(e).unit;
  fmt::print("{} ({}): {}\n", e.name, e.layer, e.what);
  fmt::print("  key of the {:<6} {}\n", e.in_recipe ? "recipe" : "case",
             fmt::join(a.keys, " and "));
  fmt::print("  off               {}{}\n", a.off, unit);
  fmt::print("  range, prior      {:g} to {:g}{}, {}{}\n", a.low, a.high, unit,
             a.spread == Spread::Uniform ? "uniform" : "log-uniform",
             a.scale == AmplitudeScale::Reciprocal ? "; the smaller, the stronger" : "");
  fmt::print("  moves             {}\n  source            {}\n", e.moves, e.source);
  fmt::print("  law               src_plugin/physics/{}\n  verified by       tests/{}\n", e.law,
             folder_of_tests(e));
}

void print_json(const std::string &name) {
  nlohmann::json all = nlohmann::json::array();
  for (const Effect &e : effects())
    if (name.empty() || e.name == name)
      all.push_back(to_json(e));
  fmt::print("{}\n", all.dump(2));
}

void write_generated(const std::string &top, bool check) {
  std::vector<std::string> stale;
  for (const GeneratedFile &f : generated_files(top)) {
    const std::string path = top + "/" + f.path;
    if (text_of_file(path) == f.text)
      continue;
    stale.push_back(f.path);
    if (!check)
      write_file(path, f.text);
  }
  if (check && !stale.empty())
    throw Failure(
        kCheckFailed,
        "not what the rows of src_plugin/laws make: {}. `calendem registry {}` writes them.",
        fmt::join(stale, ", "), top);
  for (const std::string &path : stale)
    fmt::print("registry: {}\n", path);
}

} // namespace

void add_registry_verb(CLI::App &app) {
  struct Arguments {
    std::string top;
    bool check = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App *verb =
      app.add_subcommand("registry", "Write the scripts and pages that are made from the rows of "
                                     "settings and effects");
  verb->group(""); // for who changes the program
  verb->add_option("DIR", a->top, "top of the repository")->required();
  verb->add_flag("--check", a->check,
                 "only list the files that differ from what the registry generates");
  verb->callback([a] { write_generated(a->top, a->check); });
}

void add_effects_verb(CLI::App &app) {
  struct Arguments {
    std::string name;
    bool json = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App *verb = app.add_subcommand(
      "effects", "List the effects beyond the base model that can be switched on");
  verb->add_option("NAME", a->name, "print all about this effect");
  verb->add_flag("--json", a->json, "as JSON");
  verb->callback([a] {
    if (!a->name.empty())
      find_effect(a->name);
    if (a->json)
      print_json(a->name);
    else if (a->name.empty())
      print_list();
    else
      print_one(find_effect(a->name));
  });
}

} // namespace calendem
