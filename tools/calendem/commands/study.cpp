// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/study.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "report/study_page.h"
#include "simulate/sample.h"
#include <CLI/CLI.hpp>
#include <map>

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
  verb.add_option("--step", o.step,
                  "with --only: make its packing, or its run if the packing is there")
      ->needs(only)
      ->transform(CLI::CheckedTransformer(std::map<std::string, StudyStep>{
          {"packing", StudyStep::Packing}, {"run", StudyStep::Run}}));
  CLI::Option *table =
      verb.add_flag("--table", o.table, "make no runs, only the table of those that are there");
  verb.add_option("--liggghts", o.liggghts, "program with the plugin");
  const auto slurm = [&](CLI::Option *option) { option->excludes(only)->excludes(table); };
  slurm(verb.add_flag("--slurm", o.slurm.on, "run job arrays of Slurm and wait for them"));
  slurm(verb.add_flag("--slurm-dry-run", o.slurm.dry_run,
                      "write the arrays' scripts, submit nothing"));
  verb.add_option("--sbatch", o.slurm.sbatch,
                  "options for sbatch, such as \"--partition=x --time=04:00:00\"")
      ->check([](const std::string &s) {
        return s.rfind('-', 0) == 0 && s.find('\n') == std::string::npos
                   ? ""
                   : "--sbatch takes options of sbatch in one word, as \"--partition=x "
                     "--time=04:00:00\", not '" +
                         s + "'";
      });
  verb.add_option("--slurm-every", o.slurm.every_s, "seconds between queries of Slurm's queue")
      ->check(CLI::Range(1, 3600));
}

void add_study_verb(CLI::App &app) {
  struct Arguments {
    StudyOptions options;
    bool page = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App *verb = app.add_subcommand(
      "study", "Make many runs with varied settings, and a table of their results");
  verb->footer(
      "[study] name, recipe, case, at_pressure_MPa (list), keep (all|tables)\n"
      "[[vary]] keys, values - or normal = {mean, sd, cells}, or design, a CSV file - : "
      "every combination of the groups is a run.\nKeys are those of the recipe "
      "(recipe.seed) and of the case "
      "(case.bond.tensile_strength_MPa).\nThe same command continues a study that was stopped.");
  verb->add_option("STUDY", a->options.file, "study (TOML)")->required();
  add_study_options(*verb, a->options);
  verb->add_flag("--page", a->page, "make no runs, only the page of the table in the folder");
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

void add_sample_verb(CLI::App &app) {
  struct Arguments {
    std::vector<std::string> runs;
    OneFor shared = OneFor::Gap;
    std::string folder;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App *verb = app.add_subcommand(
      "sample", "Combine runs of cells of different loading into one sample under one press");
  verb->footer("gap: a rigid platen or roll; the runs have platen.control = \"thickness\" and the "
               "same thickness_um.\npressure: a press that gives way with every cell; the runs "
               "have the same max_pressure_MPa.\nA study makes the runs: [[vary]] keys = "
               "[\"recipe.coating.loading_mg_cm2\"], normal = {mean, sd, cells}.");
  verb->add_option("DIR", a->runs, "folders made by calendem run, one cell each")->required();
  verb->add_option("--one", a->shared, "what all cells share")
      ->required()
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, OneFor>{{"gap", OneFor::Gap}, {"pressure", OneFor::Pressure}}));
  verb->add_option("-o,--output", a->folder, "folder of the sample")->required();
  verb->callback([a] { make_sample(a->runs, a->shared, a->folder); });
}

} // namespace calendem
