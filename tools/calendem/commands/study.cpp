// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/study.h"
#include "base/liggghts_job.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "diagnose/bank/bank_table.h"
#include "diagnose/choose_runs.h"
#include "report/study_page.h"
#include "simulate/sample.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <optional>

namespace calendem {

namespace {

struct Options {
  StudyOptions study;
  bool full_cell = false;
  std::string from; ///< a table whose rows are taken for all but the full cell
  int choose = 0;   ///< points to be chosen, for...
  std::string experiment;
  double cells = 0.0; ///< 0: from the sample's diameter
};

/// A study of points and where it goes.
struct Part {
  std::vector<PressedPoint> runs;
  Study study;
  StudyOptions options;
};

std::vector<Part> parts_of(const BankSpec &spec, const StudyOptions &o) {
  std::vector<Part> out = {{bank_runs(spec), {}, o}};
  out[0].study = pressed_study(spec, out[0].runs);
  if (spec.full_cell.points > 0) {
    out.push_back({full_cell_runs(spec), full_cell_study(spec), o});
    out[1].options.folder += "/full_cell";
    out[1].options.further = {"--full-cell"};
  }
  return out;
}

/// The table of all points whose runs are there, after `rows`; reports how many are not.
void write_table(const BankSpec &spec, const std::vector<Part> &parts, const std::string &folder,
                 std::vector<BankRow> rows = {}) {
  BankTable table = {spec, std::move(rows)};
  std::size_t missing = 0;
  for (const Part &part : parts) {
    const std::vector<std::string> folders = finished_runs(part.study, part.options);
    for (std::size_t k = 0; k < folders.size(); ++k)
      if (folders[k].empty()) {
        ++missing;
      } else {
        table.rows.push_back({part.runs[k].point, read_simulated_run(folders[k])});
        table.rows.back().run.pressing = part.runs[k].name;
      }
  }
  if (missing > 0)
    fmt::print("bank: {} of {} runs are not there yet; the table holds the others\n", missing,
               missing + table.rows.size());
  write_file(folder + "/bank.csv", write_bank_table(table));
  fmt::print("bank: {0} rows, {1}/bank.csv\nNext: calendem diagnose EXPERIMENT.toml -o DIR "
             "--bank {2} --table {1}/bank.csv\n",
             table.rows.size(), folder, spec.file);
}

/// Only the runs of the other electrode are made, the rest is that of another bank's table.
void transfer_bank(const Options &o, const BankSpec &spec, const std::vector<Part> &parts) {
  if (!spec.full_cell.other_electrode)
    throw Failure(kBadInput, fmt::format("{}: --from is for a bank that stands for another "
                                         "electrode: give it [full_cell] with other_electrode = "
                                         "\"yes\".",
                                         spec.file));
  std::vector<BankRow> rows = read_bank_table(spec, o.from).rows;
  rows.erase(std::remove_if(rows.begin(), rows.end(),
                            [](const BankRow &row) { return row.point.effect == kFullCell; }),
             rows.end());
  make_study(parts[1].study, parts[1].options);
  write_table(spec, {parts[1]}, o.study.folder, std::move(rows));
}

/// Chosen for what they tell about an experiment: nothing is run.
void choose_points_of(const Options &o, const BankSpec &spec) {
  const std::string own = o.study.folder + "/bank.csv",
                    table = std::filesystem::is_regular_file(own) ? own : table_of(spec);
  const RunChoice choice =
      choose_runs(read_experiment(o.experiment), read_bank_table(spec, table), o.cells, o.choose);
  fmt::print("{} points chosen of those that {} can still run, for {} (a sample of {:.3g} cells)\n"
             "  {:<22} {:>6} {:>6} {:>12} {:>20}\n",
             choice.chosen.size(), table, o.experiment, choice.cells, "effect", "points", "more",
             "gain, bits", "were they even, bits");
  double gain = 0.0, evenly = 0.0;
  for (const RunChoice::Effect &e : choice.effects) {
    fmt::print("  {:<22} {:>6} {:>6} {:>12.2f} {:>20.2f}\n", e.name, e.points, e.chosen, e.gain,
               e.evenly);
    gain += e.gain;
    evenly += e.evenly;
  }
  fmt::print("  {:<22} {:>6} {:>6} {:>12.2f} {:>20.2f}\n", "all", "", choice.chosen.size(), gain,
             evenly);
  std::vector<ChosenRun> all = spec.chosen;
  all.insert(all.end(), choice.chosen.begin(), choice.chosen.end());
  make_output_folder(o.study.folder);
  write_file(o.study.folder + "/chosen.csv", write_chosen(all));
  fmt::print("{} runs: {}/chosen.csv. To make them name it in {}, [bank] chosen_points, and run "
             "calendem bank on it.\n",
             choice.chosen.size() * spec.pressures.size(), o.study.folder, spec.file);
}

void make_bank(const Options &o) {
  const BankSpec spec = read_bank_spec(o.study.file);
  if (o.choose > 0)
    return choose_points_of(o, spec);
  std::vector<Part> parts = parts_of(spec, o.study);
  if (!o.from.empty())
    return transfer_bank(o, spec, parts);
  if (o.full_cell) {
    if (parts.size() < 2)
      throw Failure(kBadInput, spec.file + " has no table [full_cell].");
    parts[1].options.folder = o.study.folder;
    make_study(parts[1].study, parts[1].options);
    return;
  }
  if (o.study.step != StudyStep::All || o.study.only > 0) { // of many tasks: the table is not its
    make_study(parts[0].study, o.study);
    return;
  }
  std::optional<Failure> failed; // of some runs: the other part is made all the same
  for (const Part &part : parts)
    try {
      make_study(part.study, part.options);
    } catch (const Failure &f) {
      if (f.exit_status() == kBadInput) // there is nothing yet
        throw;
      if (!failed)
        failed = f;
      if (stop_requested() != 0)
        break;
    }
  if (o.study.slurm.dry_run)
    return;
  write_table(spec, parts, o.study.folder);
  if (failed)
    throw *failed;
}

} // namespace

void add_bank_verb(CLI::App &app) {
  auto o = std::make_shared<Options>();
  CLI::App *verb =
      app.add_subcommand("bank", "Make the simulations that diagnose or calibrate learns from");
  verb->add_option("BANK", o->study.file, "bank (TOML)")->required();
  add_study_options(*verb, o->study);
  verb->add_flag("--full-cell", o->full_cell, "only the runs on the full cell, in that folder");
  verb->add_option("--from", o->from,
                   "bank.csv whose runs stand for another electrode, which alone is run "
                   "([full_cell] with other_electrode)");
  CLI::Option *choose =
      verb->add_option("--choose", o->choose,
                       "run nothing: choose so many points that would tell most about --experiment")
          ->check(CLI::Range(1, 10000));
  CLI::Option *experiment = verb->add_option("--experiment", o->experiment,
                                             "experiment (TOML) that points are chosen for")
                                ->needs(choose);
  choose->needs(experiment);
  verb->add_option("--cells", o->cells,
                   "how many of the bank's cells its sample is as large as; default: from "
                   "sample_diameter_mm")
      ->needs(choose)
      ->check(finite_range(1.0, 1e12));
  verb->callback([o] { make_bank(*o); });
}

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
  verb->add_option("DIR", a->runs, "directories made by calendem run, a cell each")->required();
  verb->add_option("--one", a->shared, "what all cells share")
      ->required()
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, OneFor>{{"gap", OneFor::Gap}, {"pressure", OneFor::Pressure}}));
  verb->add_option("-o,--output", a->folder, "folder of the sample")->required();
  verb->callback([a] { make_sample(a->runs, a->shared, a->folder); });
}

} // namespace calendem
