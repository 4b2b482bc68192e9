// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/tomogram.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {

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
