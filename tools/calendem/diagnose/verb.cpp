// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/verb.h"
#include "diagnose/experiment_data.h"
#include "inference/diagnosis.h"
#include "spec/output_folder.h"
#include "spec/provenance.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

struct Options {
  std::string experiment, folder, bank, table;
  std::vector<std::string> without;
  double cells = 0.0; // 0: from the sample's diameter
};

/// The table's spec without the effects that may not be named.
BankSpec spec_of(const Options &o) {
  BankSpec spec = read_bank_spec(o.bank);
  for (const std::string &name : o.without) {
    find_effect(name);
    spec.effects.erase(std::remove(spec.effects.begin(), spec.effects.end(), name),
                       spec.effects.end());
  }
  return spec;
}

BankTable table_of(const Options &o) {
  BankTable table = read_bank_table(spec_of(o), o.table);
  const auto excluded = [&](const BankRow &row) {
    return std::find(o.without.begin(), o.without.end(), row.point.effect) != o.without.end();
  };
  table.rows.erase(std::remove_if(table.rows.begin(), table.rows.end(), excluded),
                   table.rows.end());
  return table;
}

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

/// How many of the bank's cells the sample is as large as.
double cells_of(const Experiment &e, const BankSpec &spec) {
  if (!(e.sample_diameter_mm > 0.0))
    throw Failure(kBadInput, "how large is the sample? Give sample_diameter_mm in the experiment "
                             "file, or --cells, how many of the bank's cells it is as large as.");
  return 1e8 * sample_area_cm2(e) / read_recipe(spec.recipe_file).area(); // um2 per cm2
}

void run(Options o) {
  if (o.table.empty())
    o.table = std::filesystem::path(o.bank).replace_extension("csv").string();
  const Experiment experiment = read_experiment(o.experiment);
  const BankTable table = table_of(o);
  const ExperimentData data = data_of(experiment, table, {});
  inference::Settings settings;
  settings.model.packings_in_sample = o.cells > 0.0 ? o.cells : cells_of(experiment, table.spec);
  const inference::Model model(data.bank, data.experiment, settings.model, data.next);
  const inference::Diagnosis d =
      inference::diagnose(model, data.bank, data.experiment.values, settings);
  nlohmann::ordered_json j = nlohmann::ordered_json::parse(inference::to_json(d));
  j["experiment"] = experiment.name;
  j["not_said"] = data.not_said;
  j["provenance"] = {{"calendem", version()},
                     {"hashes", "64-bit FNV-1a"},
                     {"experiment_file", hash_of_file(o.experiment)},
                     {"bank", hash_of_file(o.bank)},
                     {"bank_table", hash_of_file(o.table)}};
  make_output_folder(o.folder);
  write_file(o.folder + "/gap.json", j.dump(1) + "\n");
  print(d, data.not_said);
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
