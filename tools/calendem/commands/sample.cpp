// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/sample.h"
#include "commands/commands.h"
#include <CLI/CLI.hpp>
#include <map>

namespace calendem {

void add_sample_verb(CLI::App &app) {
  struct Arguments {
    std::vector<std::string> runs;
    OneFor shared = OneFor::Gap;
    std::string folder;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App *verb = app.add_subcommand(
      "sample", "Runs of cells of different loading as one sample that lies under one press");
  verb->footer("gap: a rigid platen or roll; the runs have platen.control = \"thickness\" and the "
               "same thickness_um.\npressure: a press that gives way with every cell; the runs "
               "have the same max_pressure_MPa.\nA study makes the runs: [[vary]] keys = "
               "[\"recipe.coating.loading_mg_cm2\"], normal = {mean, sd, cells}.");
  verb->add_option("DIR", a->runs, "directories made by calendem run, a cell each")->required();
  verb->add_option("--one", a->shared, "what all cells share")
      ->required()
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, OneFor>{{"gap", OneFor::Gap}, {"pressure", OneFor::Pressure}}));
  verb->add_option("-o,--output", a->folder, "folder of the sample")->required();
  verb->callback([a] { make_sample(a->runs, a->shared, a->folder); });
}

} // namespace calendem
