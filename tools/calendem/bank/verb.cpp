// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank/verb.h"
#include "bank/bank_table.h"
#include "spec/messages.h"
#include "spec/provenance.h"
#include "study/study.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace calendem {
namespace {

/// The table of all points whose runs are there; tells how many are not.
BankTable table_of(const BankSpec &spec, const std::vector<BankPoint> &points, const Study &study,
                   const StudyOptions &o) {
  BankTable table = {spec, {}};
  const std::vector<std::string> folders = finished_runs(study, o);
  for (std::size_t k = 0; k < folders.size(); ++k)
    if (!folders[k].empty())
      table.rows.push_back({points[k / spec.pressures.size()], read_simulated_run(folders[k])});
  if (table.rows.size() < folders.size())
    fmt::print("bank: {} of {} runs are not there yet; the table holds the others\n",
               folders.size() - table.rows.size(), folders.size());
  return table;
}

void make_bank(const std::string &file, StudyOptions o) {
  const BankSpec spec = read_bank_spec(file);
  const std::vector<BankPoint> points = bank_points(spec);
  const Study study = bank_study(spec, points);
  const auto write_table = [&] {
    const BankTable table = table_of(spec, points, study, o);
    write_file(o.folder + "/bank.csv", write_bank_table(table));
    fmt::print("bank: {0} rows, {1}/bank.csv\nNext: calendem diagnose EXPERIMENT.toml -o DIR "
               "--bank {2} --table {1}/bank.csv\n",
               table.rows.size(), o.folder, file);
  };
  try {
    make_study(study, o);
  } catch (const Failure &f) {
    if (f.exit_status() != kBadInput) // else there is nothing yet
      write_table();
    throw;
  }
  write_table();
}

} // namespace

void add_bank_verb(CLI::App &app) {
  struct Arguments {
    std::string spec;
    StudyOptions options;
  };
  auto a = std::make_shared<Arguments>();
  a->options.liggghts = liggghts_program();
  CLI::App *verb = app.add_subcommand(
      "bank", "The simulations that the diagnosis learns from, with and without each effect");
  verb->add_option("BANK", a->spec, "bank (TOML)")->required();
  verb->add_option("-o,--output", a->options.folder, "folder of the bank")->required();
  verb->add_option("--jobs", a->options.jobs, "runs at a time")->check(CLI::Range(1, 4096));
  verb->add_option("--only", a->options.only, "make the run of this number and no other")
      ->check(CLI::Range(1, 1000000));
  verb->add_flag("--table", a->options.table, "make no run, only the table of what there is");
  verb->add_option("--liggghts", a->options.liggghts, "program with the plugin");
  verb->callback([a] { make_bank(a->spec, a->options); });
}

} // namespace calendem
