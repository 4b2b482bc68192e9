// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/run.h"
#include "base/case.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include <CLI/CLI.hpp>

namespace calendem {

void add_run_verb(CLI::App &app) {
  struct Arguments {
    std::string spec;
    RunOptions options;
  };
  auto a = std::make_shared<Arguments>();
  a->options.liggghts = liggghts_program();
  CLI::App *verb = app.add_subcommand("run", "One compression and relaxation of an electrode");
  verb->footer(list_of_keys(case_keys()));
  verb->add_option("CASE", a->spec, "case (TOML)")->required();
  verb->add_option("-o,--output", a->options.folder, "folder of the run")->required();
  verb->add_option("--ranks", a->options.ranks, "MPI ranks")->check(CLI::Range(1, 4096));
  verb->add_flag("--resume", a->options.resume, "go on from the newest restart file");
  verb->add_flag("--force", a->options.force,
                 "overwrite a run of another case or an unfinished one");
  verb->add_option("--liggghts", a->options.liggghts, "program with the plugin");
  verb->callback([a] { run_case(read_case(a->spec), a->options); });
}

} // namespace calendem
