// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/study.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "report/study_page.h"
#include <CLI/CLI.hpp>

namespace calendem {

void add_study_options(CLI::App &verb, StudyOptions &o) {
  o.verb = verb.get_name();
  o.liggghts = liggghts_program();
  verb.add_option("-o,--output", o.folder, "folder of the " + o.verb)->required();
  verb.add_option("--jobs", o.jobs, "runs at a time (default 1; with --slurm no limit)")
      ->check(CLI::Range(1, 4096));
  verb.add_option("--ranks", o.ranks, "MPI ranks of each run")->check(CLI::Range(1, 4096));
  CLI::Option *only = verb.add_option("--only", o.only, "make the run of this number and no other")
                          ->check(CLI::Range(1, 1000000));
  verb.add_option("--step", o.step, "of --only: its packing, or its run if that is there")
      ->needs(only)
      ->transform(CLI::CheckedTransformer(std::map<std::string, StudyStep>{
          {"packing", StudyStep::Packing}, {"run", StudyStep::Run}}));
  CLI::Option *table =
      verb.add_flag("--table", o.table, "make no run, only the table of what there is");
  verb.add_option("--liggghts", o.liggghts, "program with the plugin");
  const auto slurm = [&](CLI::Option *option) { option->excludes(only)->excludes(table); };
  slurm(verb.add_flag("--slurm", o.slurm.on, "make them as job arrays of Slurm, wait for them"));
  slurm(verb.add_flag("--slurm-dry-run", o.slurm.dry_run,
                      "write the arrays' scripts, submit nothing"));
  verb.add_option("--sbatch", o.slurm.sbatch,
                  "options of sbatch for them, as \"--partition=x --time=04:00:00\"")
      ->check([](const std::string &s) {
        return s.rfind('-', 0) == 0 && s.find('\n') == std::string::npos
                   ? ""
                   : "--sbatch takes options of sbatch in one word, as \"--partition=x "
                     "--time=04:00:00\", not '" +
                         s + "'";
      });
  verb.add_option("--slurm-every", o.slurm.every_s, "seconds between looks at Slurm's queue")
      ->check(CLI::Range(1, 3600));
}

void add_study_verb(CLI::App &app) {
  struct Arguments {
    StudyOptions options;
    bool page = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App *verb = app.add_subcommand("study", "Many runs of one electrode and case, settings "
                                               "varied; a table of what they gave");
  verb->footer("[study] name, recipe, case, at_pressure_MPa (list), keep (all|tables)\n"
               "[[vary]] keys, values - or design, a CSV file - : every combination of the groups "
               "is a run.\nKeys are those of the recipe (recipe.seed) and of the case "
               "(case.bond.tensile_strength_MPa).\nThe same command again goes on where it was.");
  verb->add_option("STUDY", a->options.file, "study (TOML)")->required();
  add_study_options(*verb, a->options);
  verb->add_flag("--page", a->page, "draw the page of the table that lies in the folder, no more");
  verb->callback([a] {
    const StudyOptions &o = a->options;
    const Study study = read_study(o.file);
    if (a->page)
      return draw_study(study.columns, o.folder);
    const bool whole = o.only == 0 && !o.slurm.dry_run; // a task among many draws nothing
    try {
      make_study(study, o);
    } catch (const Failure &f) {
      if (whole && f.exit_status() != kBadInput) // else there is nothing yet
        draw_study(study.columns, o.folder);
      throw;
    }
    if (whole)
      draw_study(study.columns, o.folder);
  });
}

} // namespace calendem
