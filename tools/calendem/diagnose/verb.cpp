// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/verb.h"
#include "diagnose/diagnose.h"
#include "spec/output_folder.h"
#include "spec/provenance.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace {

struct Options {
  std::string experiment, folder, bank, table;
  std::vector<std::string> without;
  double cells = 0.0; // 0: from the sample's diameter
};

void print(const inference::Diagnosis &d, const std::vector<std::string> &not_said) {
  fmt::print("claim: {}\n  {}\n", d.which.claim, d.which.why);
  for (const inference::Judged &j : d.which.judged)
    if (j.probability >= 0.005)
      fmt::print("  {:<44} {:5.1f} %   fits with p {:.2g}\n", j.hypothesis.name,
                 100.0 * j.probability, j.adequacy_p);
  fmt::print("where, once recalibrated (beyond |z| = {:.1f} is no chance):\n", d.where.threshold);
  for (const inference::WhereRow &r : d.where.rows) {
    const inference::Block &b = d.blocks[std::size_t(r.block)];
    fmt::print("  {:<8} {:<36} {:<12} z {:+6.1f}  {:3.0f} %{}\n", b.condition, b.name, b.stage, r.z,
               100.0 * r.share, r.significant ? "  beyond noise" : "");
  }
  for (const inference::EmulatorQuality &q : d.emulators)
    if (q.poor)
      fmt::print("- the bank says too little of {}: it cannot be claimed\n",
                 q.effect.empty() ? "the base model" : q.effect);
  for (const std::string &text : not_said)
    fmt::print("- {}\n", text);
}

void run(Options o) {
  if (o.table.empty())
    o.table = std::filesystem::path(o.bank).replace_extension("csv").string();
  const Experiment experiment = read_experiment(o.experiment);
  const BankTable table =
      without_effects(read_bank_table(read_bank_spec(o.bank), o.table), o.without);
  SharedModels models;
  Diagnosed d = diagnosed(experiment, table, o.cells, models);
  nlohmann::ordered_json &provenance = d.gap["provenance"];
  provenance["experiment_file"] = hash_of_file(o.experiment);
  provenance["bank"] = hash_of_file(o.bank);
  provenance["bank_table"] = hash_of_file(o.table);
  make_output_folder(o.folder);
  write_file(o.folder + "/gap.json", d.gap.dump(1) + "\n");
  print(d.diagnosis, d.data.not_said);
  fmt::print("data: {}/gap.json\n", o.folder);
}

} // namespace

void add_diagnose_verb(CLI::App &app) {
  auto o = std::make_shared<Options>();
  o->bank = input_scripts() + "/cases/bank/bank.toml";
  CLI::App *verb = app.add_subcommand(
      "diagnose", "Where simulation and experiment disagree, and which effect explains it");
  verb->add_option("EXPERIMENT", o->experiment, "experiment file (TOML)")->required();
  verb->add_option("-o,--output", o->folder, "folder for gap.json")->required();
  verb->add_option("--bank", o->bank, "bank (TOML) that the table was made from");
  verb->add_option("--table", o->table,
                   "bank.csv as calendem bank wrote it; default: beside the bank, with its name");
  verb->add_option("--without", o->without, "effects that may not be named");
  verb->add_option("--cells", o->cells,
                   "how many of the bank's cells the sample is as large as (scatter between "
                   "packings counts with its inverse); default: from sample_diameter_mm")
      ->check(CLI::Range(1.0, 1e12));
  verb->callback([o] { run(*o); });
}

} // namespace calendem
