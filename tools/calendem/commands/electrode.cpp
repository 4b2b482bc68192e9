// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "commands/commands.h"
#include "electrode/pack/pack.h"
#include "electrode/slurry/dry.h"
#include "electrode/tomogram.h"
#include <CLI/CLI.hpp>
#include <filesystem>
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

void add_tomogram_verb(CLI::App &app) {
  struct Arguments {
    std::string spec, file;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App *verb =
      app.add_subcommand("tomogram", "A synthetic label image whose particles are known");
  verb->footer(list_of_keys(tomogram_keys()));
  verb->add_option("SPEC", a->spec, "what the image shows (TOML)")->required();
  verb->add_option("-o,--output", a->file, "image (.mhd, .mha or .vti); beside it NAME.truth.csv")
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
