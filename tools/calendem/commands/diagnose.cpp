// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/gap_file.h"
#include "base/material_notes.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "diagnose/next_runs.h"
#include "diagnose/page.h"
#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace {

struct DiagnoseOptions {
  std::string experiment, before, folder, bank, table;
  std::vector<std::string> without;
  double cells = 0.0; // 0: from the sample's diameter
  bool no_rerun = false, other_electrode = false;
  int next_packings = 0; ///< that further measurements are simulated on; 0: they are not
  RerunOptions rerun;
};

void print(const Diagnosed &diagnosed) {
  const inference::Diagnosis &d = diagnosed.diagnosis;
  const nlohmann::ordered_json &which = diagnosed.gap["which"];
  fmt::print("claim: {}\n{}.\n{}\n  {}\n", d.which.claim, which["headline"].get<std::string>(),
             which["meaning"].get<std::string>(), d.which.why);
  for (const auto &step : which["next"])
    fmt::print("* {}\n", step.get<std::string>());
  for (const inference::Judged &j : d.which.judged)
    if (j.probability >= 0.005)
      fmt::print("  {:<44} {:5.1f} %   fits with p {:.2g}\n",
                 j.place.empty() ? j.hypothesis.name : j.hypothesis.name + ": " + j.place,
                 100.0 * j.probability, j.adequacy_p);
  fmt::print("where, once recalibrated (significant beyond |z| = {:.1f}):\n", d.where.threshold);
  for (const inference::WhereRow &r : d.where.rows) {
    const inference::Block &b = d.blocks[std::size_t(r.block)];
    fmt::print("  {:<8} {:<36} {:<12} z {:+6.1f}  {:3.0f} %{}\n", b.condition, b.name, b.stage, r.z,
               100.0 * r.share, r.significant ? "  beyond noise" : "");
  }
  for (const inference::EmulatorQuality &q : d.emulators)
    if (q.poor)
      fmt::print("- the bank has too few runs of {}: it cannot be claimed\n",
                 q.effect.empty() ? "the base model" : q.effect);
  for (const std::string &text : diagnosed.data.not_said)
    fmt::print("- {}\n", text);
}

std::string shown(const Estimate &e) {
  return fmt::format("{:.1f} ({:.1f} to {:.1f})", e.value, e.low90, e.high90);
}

void print_images(const nlohmann::ordered_json &shrink) {
  if (!shrink.contains("images"))
    return;
  fmt::print("label images of what was held out beside these runs\n");
  for (const auto &row : shrink["images"]["rows"]) {
    fmt::print(
        "  {:<8} {:<46} image {:>7.4g}", row["condition"].get<std::string>(),
        fmt::format("{}, {}", row["name"].get<std::string>(), row["unit"].get<std::string>()),
        row["measured"].get<double>());
    for (const char *role : {"before", "after"})
      if (row.contains(role))
        fmt::print(", {} {:.4g}{}", role, row[role]["mean"].get<double>(),
                   row[role].contains("off")
                       ? fmt::format(" (z {:+.1f})", row[role]["off"].get<double>())
                       : "");
    fmt::print("\n");
  }
  for (const auto &text : shrink["images"]["without"])
    fmt::print("- {}\n", text.get<std::string>());
}

/// The third part: adds "shrink" to gap.json once the models have run again.
void run_models_again(DiagnoseOptions &o, const Experiment &experiment, const BankTable &table,
                      Diagnosed &d) {
  if (o.no_rerun || !o.before.empty())
    return;
  const std::vector<RerunModel> models = models_to_rerun(experiment, table, d, o.cells);
  if (models.empty()) {
    fmt::print("- how far: the experiment file has no split = {{ train = [...], test = [...] }}; "
               "nothing is run again\n");
    return;
  }
  fmt::print("how far: gap on the held-out conditions, in standard deviations, as predicted\n");
  for (const RerunModel &m : models)
    fmt::print("  {:<10} {:<32} {}\n", m.role, m.hypothesis, shown(m.predicted));
  o.rerun.cells = o.cells > 0.0 ? o.cells : cells_of(experiment, table.spec);
  o.rerun.study.folder = o.folder + "/rerun";
  d.gap["shrink"] = rerun(experiment, table, models, o.rerun);
  write_gap(d.gap, diagnosis_page(d.gap), o.folder);
  fmt::print("how far: as run again on {} packings that are not in the bank\n", o.rerun.packings);
  for (const auto &m : d.gap["shrink"]["models"])
    fmt::print("  {:<10} {:<32} {:.1f}\n", m["role"].get<std::string>(),
               m["hypothesis"].get<std::string>(), m["gap"]["value"].get<double>());
  fmt::print("{}\n", d.gap["shrink"]["in_words"].get<std::string>());
  print_images(d.gap["shrink"]);
}

/// What further measurements would give under each explanation that is left.
void simulate_measurements(const DiagnoseOptions &o, const Experiment &experiment,
                           const BankTable &table, Diagnosed &d) {
  if (o.next_packings == 0)
    return;
  const std::vector<RerunModel> models = models_to_part(d);
  if (models.size() < 2) {
    fmt::print(
        "- what to measure next: fewer than two explanations that can be simulated are left; "
        "nothing is run\n");
    return;
  }
  RerunOptions options = o.rerun;
  options.packings = o.next_packings;
  options.study.folder = o.folder + "/next";
  d.gap["next"] = simulate_next(experiment, table, models, options);
  write_gap(d.gap, diagnosis_page(d.gap), o.folder);
  fmt::print("what to measure next, simulated on {} packings\n", o.next_packings);
  for (const auto &m : d.gap["next"]["measurements"]) {
    fmt::print("  {}: {}, {}\n", m["what"].get<std::string>(), m["reading"].get<std::string>(),
               m["unit"].get<std::string>());
    for (const auto &v : m["values"])
      fmt::print("    {:<44} {:6.1f} ± {:.1f}\n", v["hypothesis"].get<std::string>(),
                 v["mean"].get<double>(), v["error"].get<double>());
    for (const auto &pair : m["parted"])
      fmt::print("    {} and {}: {:.1f} standard deviations apart\n",
                 pair["first"].get<std::string>(), pair["second"].get<std::string>(),
                 pair["apart"].get<double>());
  }
}

/// Samples that were not the recipe's before they were pressed: by more than 3 of their standard
/// deviations and 2 %.
std::vector<std::string> other_samples(const Experiment &e) {
  std::vector<std::string> out;
  const double recipe = 100.0 * e.recipe.porosity_total;
  for (const Condition &c : e.conditions)
    if (const auto &p = c.porosity_before_percent;
        p && std::fabs(p->value - recipe) > std::max(3.0 * p->sd, 0.02 * recipe))
      out.push_back(
          fmt::format("{}: its porosity before calendering is {:g} ± {:g} %, the recipe's "
                      "coating.porosity_total_percent is {:g}: another coating than the bank's, or "
                      "a wrong thickness or loading.",
                      c.id, p->value, p->sd, recipe));
  return out;
}

/// A bank says nothing of another electrode.
std::string of_another_electrode(const DiagnoseOptions &o, const Experiment &e,
                                 const BankSpec &bank) {
  const std::string text = other_than_bank(e, bank);
  if (text.empty())
    return "";
  if (!o.other_electrode)
    throw Failure(kBadInput, fmt::format("{}. Make a bank of it (calendem bank; copy {} and change "
                                         "its recipe), or go on with --other-electrode if that "
                                         "does not matter to you.",
                                         text, o.bank));
  return text + ": what follows holds as far as that does not matter.";
}

void run(DiagnoseOptions o) {
  if (o.table.empty())
    o.table = std::filesystem::path(o.bank).replace_extension("csv").string();
  const Experiment experiment = read_experiment(o.experiment);
  const BankTable table =
      without_effects(read_bank_table(read_bank_spec(o.bank), o.table), o.without);
  const std::string another = of_another_electrode(o, experiment, table.spec);
  SharedModels models;
  Diagnosed d = o.before.empty()
                    ? diagnosed(experiment, table, o.cells, models)
                    : diagnosed_change(read_experiment(o.before), experiment, table, o.cells);
  std::vector<std::string> first = other_samples(experiment);
  if (!another.empty())
    first.push_back(another);
  for (const std::string &text : notes_of(experiment.recipe))
    first.push_back(text);
  for (const std::string &note : first) {
    d.data.not_said.insert(d.data.not_said.begin(), note);
    fmt::print("note: {}\n", note);
  }
  d.gap["not_said"] = d.data.not_said;
  nlohmann::ordered_json &provenance = d.gap["provenance"];
  provenance["experiment_file"] = hash_of_file(o.experiment);
  provenance["bank"] = hash_of_file(o.bank);
  provenance["bank_table"] = hash_of_file(o.table);
  if (const std::string &further = table.spec.further_table;
      !further.empty() && std::filesystem::equivalent(o.table, table_of(table.spec)))
    provenance["bank_further_table"] = hash_of_file(further);
  make_output_folder(o.folder);
  write_gap(d.gap, diagnosis_page(d.gap), o.folder);
  print(d);
  fmt::print("page: {0}/gap.html\ndata: {0}/gap.json\n", o.folder);
  run_models_again(o, experiment, table, d);
  simulate_measurements(o, experiment, table, d);
}

} // namespace

void add_diagnose_verb(CLI::App &app) {
  auto o = std::make_shared<DiagnoseOptions>();
  o->bank = input_scripts() + "/cases/bank/bank.toml";
  o->rerun.study.liggghts = liggghts_program();
  CLI::App *verb = app.add_subcommand(
      "diagnose", "Find where simulation and experiment disagree, and which effect explains it");
  verb->add_option("EXPERIMENT", o->experiment, "experiment file (TOML)")->required();
  verb->add_option("-o,--output", o->folder, "folder for gap.json and gap.html")->required();
  verb->add_option("--before", o->before,
                   "experiment before a change, of which EXPERIMENT is after it: what changed?");
  verb->add_option("--bank", o->bank, "bank (TOML) that the table was made from");
  verb->add_option("--table", o->table,
                   "bank.csv as calendem bank wrote it; default: beside the bank, with its name");
  verb->add_option("--without", o->without, "effects that may not be named");
  verb->add_option("--cells", o->cells,
                   "how many of the bank's cells the sample is as large as (scatter between "
                   "packings counts with its inverse); default: from sample_diameter_mm")
      ->check(finite_range(1.0, 1e12));
  verb->add_flag("--other-electrode", o->other_electrode,
                 "go on though the sample's recipe is not the bank's");
  verb->add_flag("--no-rerun", o->no_rerun, "where and which only: run nothing again");
  verb->add_option("--packings", o->rerun.packings, "new packings that models are run again on")
      ->check(CLI::Range(2, 1000));
  verb->add_option("--simulate-next", o->next_packings,
                   "simulate further measurements under the explanations that are left, on so many "
                   "packings: what they would read, and which of them part what")
      ->check(CLI::Range(2, 1000));
  verb->add_option("--jobs", o->rerun.study.jobs, "runs at a time")->check(CLI::Range(1, 4096));
  verb->add_option("--liggghts", o->rerun.study.liggghts, "program with the plugin");
  verb->callback([o] { run(*o); });
}

} // namespace calendem
