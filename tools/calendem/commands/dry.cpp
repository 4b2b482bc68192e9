// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/slurry/dry.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include <CLI/CLI.hpp>

namespace calendem {

void add_dry_verb(CLI::App &app) {
  struct Arguments {
    std::string spec;
    DryOptions options;
  };
  auto a = std::make_shared<Arguments>();
  a->options.liggghts = liggghts_program();
  CLI::App *verb = app.add_subcommand(
      "dry", "Make the slurry of a recipe and dry it, by running LIGGGHTS: a film for pack");
  verb->footer(list_of_keys(film_keys()));
  verb->add_option("SPEC", a->spec, "recipe with [slurry] and [drying] (TOML)")->required();
  verb->add_option("-o,--output", a->options.folder, "folder of the film")->required();
  verb->add_option("--ranks", a->options.ranks, "MPI ranks")->check(CLI::Range(1, 4096));
  verb->add_option("--liggghts", a->options.liggghts, "program with the plugin");
  verb->callback([a] { dry_film(read_film_recipe(a->spec), a->options); });
}

} // namespace calendem
