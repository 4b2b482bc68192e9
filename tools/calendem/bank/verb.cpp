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

/// A study of points and where it goes.
struct Part {
  std::vector<BankPoint> points;
  Study study;
  StudyOptions options;
};

std::vector<Part> parts_of(const BankSpec &spec, const StudyOptions &o) {
  std::vector<Part> out = {{bank_points(spec), {}, o}};
  out[0].study = bank_study(spec, out[0].points);
  if (spec.full_cell.points > 0) {
    out.push_back({full_cell_points(spec), {}, o});
    out[1].study = full_cell_study(spec, out[1].points);
    out[1].options.folder += "/full_cell";
  }
  return out;
}

/// The table of all points whose runs are there; tells how many are not.
void write_table(const BankSpec &spec, const std::vector<Part> &parts, const std::string &folder) {
  BankTable table = {spec, {}};
  std::size_t missing = 0;
  for (const Part &part : parts) {
    const std::vector<std::string> folders = finished_runs(part.study, part.options);
    for (std::size_t k = 0; k < folders.size(); ++k)
      if (folders[k].empty())
        ++missing;
      else
        table.rows.push_back(
            {part.points[k / spec.pressures.size()], read_simulated_run(folders[k])});
  }
  if (missing > 0)
    fmt::print("bank: {} of {} runs are not there yet; the table holds the others\n", missing,
               missing + table.rows.size());
  write_file(folder + "/bank.csv", write_bank_table(table));
  fmt::print("bank: {0} rows, {1}/bank.csv\nNext: calendem diagnose EXPERIMENT.toml -o DIR "
             "--bank {2} --table {1}/bank.csv\n",
             table.rows.size(), folder, spec.file);
}

void make_bank(const std::string &file, const StudyOptions &o) {
  const BankSpec spec = read_bank_spec(file);
  const std::vector<Part> parts = parts_of(spec, o);
  try {
    for (const Part &part : parts)
      make_study(part.study, part.options);
  } catch (const Failure &f) {
    if (f.exit_status() != kBadInput) // else there is nothing yet
      write_table(spec, parts, o.folder);
    throw;
  }
  write_table(spec, parts, o.folder);
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
