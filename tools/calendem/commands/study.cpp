// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/study.h"
#include "bank/bank_file.h"
#include "base/liggghts_job.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "diagnose/bank/bank_table.h"
#include "diagnose/bank_check.h"
#include "diagnose/choose_runs.h"
#include "report/study_page.h"
#include "simulate/sample.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <tuple>

namespace calendem {

namespace {

struct BankOptions {
  StudyOptions study;
  bool full_cell = false;
  std::vector<std::string> from; ///< tables whose runs are taken
  int choose = 0;                ///< points to be chosen, for...
  std::string experiment;
  double cells = 0.0; ///< of a sample; 0: from its diameter, for --check one
  bool check = false;
  int draws = 0; ///< for that; 0: packings are left out
};

/// A study of points and where it goes.
struct Part {
  std::vector<PressedPoint> runs;
  Study study;
  StudyOptions options;
};

/// The bank's runs but for those that `rows` have; for another electrode only those on its cell.
std::vector<Part> parts_of(const BankSpec &spec, const BankOptions &o,
                           const std::vector<BankRow> &rows) {
  StudyOptions options = o.study;
  for (const std::string &table : o.from)
    options.further.insert(options.further.end(),
                           {"--from", std::filesystem::absolute(table).string()});
  std::vector<Part> out;
  const auto add = [&](const std::vector<PressedPoint> &runs,
                       Study (*study)(const BankSpec &, const std::vector<PressedPoint> &)) {
    const std::vector<PressedPoint> left = runs_beside(spec, runs, rows);
    out.push_back({left, left.empty() ? Study() : study(spec, left), options});
  };
  if (!spec.full_cell.other_electrode || o.from.empty())
    add(bank_runs(spec), pressed_study);
  if (spec.full_cell.points > 0) {
    add(full_cell_runs(spec), full_cell_study);
    out.back().options.folder += "/full_cell";
    out.back().options.further.push_back("--full-cell");
  }
  return out;
}

/// The table of all points whose runs are there, after `rows`; reports how many are not.
void write_table(const BankSpec &spec, const std::vector<Part> &parts, const std::string &folder,
                 std::vector<BankRow> rows) {
  BankTable table = {spec, std::move(rows)};
  std::size_t missing = 0;
  for (const Part &part : parts) {
    if (part.runs.empty())
      continue;
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

/// Rows of the tables, each once; of a bank that stands for another electrode all but those of its
/// own cell.
std::vector<BankRow> rows_from(const BankOptions &o, const BankSpec &spec) {
  std::vector<BankRow> rows;
  std::set<std::tuple<std::string, int, std::string, double>> had;
  for (const std::string &table : o.from)
    for (const BankRow &row : read_bank_table(spec, table).rows) {
      const bool own_cell = spec.full_cell.other_electrode && row.point.effect == kFullCell;
      if (!own_cell &&
          had.emplace(row.point.effect, row.point.base_point, row.run.pressing, row.run.target)
              .second)
        rows.push_back(row);
    }
  return rows;
}

void print(const RunChoice &choice, const BankOptions &o, const std::string &table) {
  fmt::print("{} of {} points chosen for {} (a sample of {:.3g} cells); learnt from {}\n"
             "  {:<22} {:>6} {:>7} {:>12} {:>20}\n",
             choice.chosen.size(), o.choose, o.experiment, choice.cells, table, "effect", "points",
             "chosen", "gain, bits", "spread evenly, bits");
  double gain = 0.0, evenly = 0.0;
  for (const RunChoice::Effect &e : choice.effects) {
    fmt::print("  {:<22} {:>6} {:>7} {:>12.2f} {:>20.2f}\n", e.name, e.points, e.chosen, e.gain,
               e.evenly);
    gain += e.gain;
    evenly += e.evenly;
  }
  fmt::print("  {:<22} {:>6} {:>7} {:>12.2f} {:>20.2f}\n", "all", "", choice.chosen.size(), gain,
             evenly);
  for (const std::string &text : choice.not_said)
    fmt::print("- {}\n", text);
}

/// The table in the output folder, else the one beside the bank's file.
std::string table_there(const BankOptions &o, const BankSpec &spec) {
  const std::string own = o.study.folder + "/bank.csv";
  return std::filesystem::is_regular_file(own) ? own : table_of(spec);
}

BankCheckOptions check_options(const BankOptions &o, const BankSpec &spec) {
  BankCheckOptions out = {spec.file, table_there(o, spec), o.study.folder + "/check"};
  out.jobs = std::max(1, o.study.jobs);
  out.draws = o.draws;
  out.cells = std::max(1.0, o.cells);
  return out;
}

/// Chosen for what they tell about an experiment: nothing is run.
void choose_points_of(const BankOptions &o, const BankSpec &spec) {
  const std::string file = o.study.folder + "/chosen.csv", table = table_there(o, spec);
  require_own_file(file, "effect,base_point,value");
  std::error_code none;
  if (!spec.chosen_file.empty() && std::filesystem::equivalent(file, spec.chosen_file, none))
    throw Failure(kBadInput, fmt::format("{} is a file of the bank itself. Choose another folder: "
                                         "-o DIR.",
                                         file));
  const Experiment experiment = read_experiment(o.experiment);
  if (const std::string other = other_than_bank(experiment, spec); !other.empty())
    throw Failure(kBadInput, other + ". Choose for an experiment on the bank's electrode.");
  const RunChoice choice = choose_runs(experiment, read_bank_table(spec, table), o.cells, o.choose);
  print(choice, o, table);
  std::vector<ChosenRun> all = spec.chosen;
  all.insert(all.end(), choice.chosen.begin(), choice.chosen.end());
  make_output_folder(o.study.folder);
  write_file(file, write_chosen(all));
  fmt::print("{}: {} points, {} runs more. To make these, name the file in {} ([bank] "
             "chosen_points) and run\n  calendem bank {} -o DIR --from {}\n",
             file, all.size(), choice.chosen.size() * spec.pressures.size(), spec.file, spec.file,
             table);
}

void make_bank(const BankOptions &o) {
  const BankSpec spec = read_bank_spec(o.study.file);
  if (o.choose > 0)
    return choose_points_of(o, spec);
  if (o.check)
    return check_bank(check_options(o, spec));
  const std::vector<BankRow> rows = rows_from(o, spec);
  std::vector<Part> parts = parts_of(spec, o, rows);
  if (o.full_cell) {
    if (spec.full_cell.points == 0)
      throw Failure(kBadInput, spec.file + " has no table [full_cell].");
    parts.back().options.folder = o.study.folder;
    make_study(parts.back().study, parts.back().options);
    return;
  }
  if (o.study.step != StudyStep::All || o.study.only > 0) { // of many tasks: the table is not its
    make_study(parts[0].study, parts[0].options);
    return;
  }
  std::optional<Failure> failed; // of some runs: the other part is made all the same
  for (const Part &part : parts) {
    try {
      if (!part.runs.empty())
        make_study(part.study, part.options);
    } catch (const Failure &f) {
      if (f.exit_status() == kBadInput) // there is nothing yet
        throw;
      if (!failed)
        failed = f;
      if (stop_requested() != 0)
        break;
    }
  }
  if (o.study.slurm.dry_run)
    return;
  make_output_folder(o.study.folder);
  write_table(spec, parts, o.study.folder, rows);
  if (failed)
    throw *failed;
}

/// Options that ask a bank instead of making it; returns that of the sample's size.
CLI::Option *add_questions(CLI::App &verb, BankOptions &o) {
  CLI::Option *choose =
      verb.add_option("--choose", o.choose,
                      "run nothing: choose so many points that would tell most about --experiment")
          ->check(CLI::Range(1, 10000));
  CLI::Option *experiment =
      verb.add_option("--experiment", o.experiment, "experiment (TOML) that points are chosen for")
          ->needs(choose);
  choose->needs(experiment);
  CLI::Option *check = verb.add_flag(
      "--check", o.check,
      "run nothing: how well the bank diagnoses, each packing left out in turn and its runs taken "
      "for samples; in check/ of the folder");
  verb.add_option("--drawn", o.draws,
                  "leave nothing out: draw so many samples of the base model and of each "
                  "effect from the bank's predictions, as if its stated errors were exact")
      ->needs(check)
      ->check(CLI::Range(1, 100000));
  for (const char *other :
       {"--only", "--table", "--slurm", "--slurm-dry-run", "--full-cell", "--from"})
    for (CLI::Option *instead : {choose, check})
      instead->excludes(verb.get_option(other));
  check->excludes(choose);
  return verb
      .add_option("--cells", o.cells,
                  "how many of the bank's cells the sample of --choose (default: from "
                  "sample_diameter_mm) or --drawn (default: one) is as large as")
      ->check(finite_range(1.0, 1e12));
}

} // namespace

void add_bank_verb(CLI::App &app) {
  auto o = std::make_shared<BankOptions>();
  CLI::App *verb =
      app.add_subcommand("bank", "Make the simulations that diagnose or calibrate learns from");
  verb->add_option("BANK", o->study.file, "bank (TOML)")->required();
  add_study_options(*verb, o->study);
  verb->add_flag("--full-cell", o->full_cell, "only the runs on the full cell, in that folder");
  verb->add_option("--from", o->from,
                   "tables whose runs are taken and not made again: of this bank, or of one that "
                   "stands for another electrode ([full_cell] with other_electrode)");
  const CLI::Option *cells = add_questions(*verb, *o);
  verb->callback([=] {
    if (cells->count() > 0 && o->choose == 0 && o->draws == 0)
      throw CLI::RequiresError("--cells", "--choose or --drawn");
    if (!bank::has_points(o->study.file))
      make_bank(*o);
    else if (o->choose > 0)
      throw Failure(kBadInput, o->study.file + " is a bank of points: --choose asks a bank of base "
                                               "points with effects beside them.");
    else if (o->check)
      check_bank_of_points(o->study.file, o->from.empty() ? "" : o->from.front());
    else
      make_bank(o->study, o->from);
  });
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
