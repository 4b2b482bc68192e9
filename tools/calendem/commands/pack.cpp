// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/pack.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace calendem {
void add_pack_verb(CLI::App &app) {
  struct Arguments {
    std::string spec;
    long seed = -1;
    PackOptions options;
  };
  auto a = std::make_shared<Arguments>();
  a->options.liggghts = liggghts_program();
  CLI::App *verb =
      app.add_subcommand("pack", "Make an electrode from a recipe by running LIGGGHTS");
  verb->footer(list_of_keys(recipe_keys()));
  verb->add_option("SPEC", a->spec, "recipe (TOML)")->required();
  verb->add_option("-o,--output", a->options.folder, "folder of the electrode")->required();
  verb->add_option("--seed", a->seed, "instead of the recipe's")
      ->check(CLI::Range(0L, 4000000000L));
  verb->add_option("--ranks", a->options.ranks, "MPI ranks")->check(CLI::Range(1, 4096));
  verb->add_option("--liggghts", a->options.liggghts, "program with the plugin");
  verb->callback([a] {
    Recipe recipe = read_recipe(a->spec);
    if (a->seed >= 0) {
      recipe.seed = static_cast<unsigned long>(a->seed);
      recipe.settings.set("seed", fmt::format("{}", a->seed));
    }
    pack_electrode(recipe, a->options);
  });
}

} // namespace calendem
