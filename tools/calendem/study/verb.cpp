// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/verb.h"
#include "spec/messages.h"
#include "spec/provenance.h"
#include "study/study.h"
#include "study/study_page.h"
#include <CLI/CLI.hpp>

namespace calendem {

void add_study_verb(CLI::App &app) {
  struct Arguments {
    std::string spec;
    StudyOptions options;
    bool page = false;
  };
  auto a = std::make_shared<Arguments>();
  a->options.liggghts = liggghts_program();
  CLI::App *verb = app.add_subcommand("study", "Many runs of one electrode and case, settings "
                                               "varied; a table of what they gave");
  verb->footer("[study] name, recipe, case, at_pressure_MPa (list), keep (all|tables)\n"
               "[[vary]] keys, values - or design, a CSV file - : every combination of the groups "
               "is a run.\nKeys are those of the recipe (recipe.seed) and of the case "
               "(case.bond.tensile_strength_MPa).\nThe same command again goes on where it was.");
  verb->add_option("STUDY", a->spec, "study (TOML)")->required();
  verb->add_option("-o,--output", a->options.folder, "folder of the study")->required();
  verb->add_option("--jobs", a->options.jobs, "runs at a time")->check(CLI::Range(1, 4096));
  verb->add_option("--ranks", a->options.ranks, "MPI ranks of each run")
      ->check(CLI::Range(1, 4096));
  verb->add_option("--only", a->options.only, "make the run of this number and no other")
      ->check(CLI::Range(1, 1000000));
  verb->add_flag("--table", a->options.table, "make no run, only the table of what there is");
  verb->add_flag("--page", a->page, "draw the page of the table that lies in the folder, no more");
  verb->add_option("--liggghts", a->options.liggghts, "program with the plugin");
  verb->callback([a] {
    const Study study = read_study(a->spec);
    if (a->page)
      return draw_study(study.columns, a->options.folder);
    try {
      make_study(study, a->options);
    } catch (const Failure &f) {
      if (f.exit_status() != kBadInput) // else there is nothing yet
        draw_study(study.columns, a->options.folder);
      throw;
    }
    if (a->options.only == 0)
      draw_study(study.columns, a->options.folder);
  });
}

} // namespace calendem
