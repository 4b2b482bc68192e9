// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "base/gap_file.h"
#include "base/material_notes.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "diagnose/run_again.h"
#include "film_commands/film_commands.h"
#include "film_commands/films_asked.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <optional>

namespace calendem {
namespace {

struct DiagnoseOptions {
  std::string experiment, folder, bank, case_file, prior;
  int runs = 0; ///< of the model and of the leading explanation; 0: none
  StudyOptions study;
};

constexpr double kWorthPrinting = 0.05; // probability

void print(const nlohmann::ordered_json &gap) {
  const auto text = [](const nlohmann::ordered_json &of) { return of.get<std::string>(); };
  const nlohmann::ordered_json &which = gap["which"];
  fmt::print("{}\nclaim: {}\n{}.\n{}\n", text(gap["in_bank"]), text(which["claim"]),
             text(which["headline"]), text(which["meaning"]));
  for (const auto &step : which["next"])
    fmt::print("* {}\n", text(step));
  fmt::print("which: probability, before the data, Bayes factor\n");
  for (const auto &c : which["changes"])
    if (c["probability"] >= kWorthPrinting && (c["bayes_factor"] > 1.0 || c["probability"] > 0.5))
      fmt::print("  {:<28} {:5.1f} % {:5.1f} % {:8.2g}\n", text(c["name"]),
                 kPercent * c["probability"].get<double>(), kPercent * c["prior"].get<double>(),
                 c["bayes_factor"].get<double>());
  fmt::print("where, once recalibrated (significant beyond |z| = {:.1f}):\n",
             gap["threshold"].get<double>());
  for (const auto &r : gap["where"])
    fmt::print("  {:<8} {:<36} {:<12} z {:+6.1f}{}\n", text(r["condition"]), text(r["observable"]),
               text(r["stage"]), r["z"].get<double>(), r["significant"] ? "  beyond noise" : "");
  fmt::print("how far: {}\n", text(gap["shrink"]["in_words"]));
  for (const auto &warning : gap["not_said"])
    fmt::print("- {}\n", text(warning));
}

void print_runs(const nlohmann::ordered_json &runs) {
  fmt::print("how far, by runs\n");
  for (const auto &m : runs["models"])
    fmt::print("  {:<30} {} runs: off by {:.1f} standard deviations ({:.1f} predicted)\n",
               m["role"].get<std::string>(), m["runs"].get<int>(), m["gap"].get<double>(),
               m["predicted_gap"].get<double>());
}

/// The bank of a model of calibrate is the one that is asked, unless another is given.
DiagnosisOptions options_of(const DiagnoseOptions &o, const FilmBank &bank, const Recipe &recipe,
                            const std::optional<Model> &prior) {
  DiagnosisOptions out;
  out.acting = acting_in(o.case_file.empty() ? read_case(bank.spec().case_file, bank.recipe())
                                             : read_case(o.case_file, recipe),
                         bank);
  if (prior)
    out.prior = &prior->calibration;
  return out;
}

void run_diagnose(DiagnoseOptions o) {
  const Experiment experiment = read_experiment(o.experiment);
  stop_if_of_other_material(experiment.recipe);
  std::optional<Model> prior;
  if (!o.prior.empty())
    prior.emplace(read_model(o.prior));
  std::optional<FilmBank> own;
  if (!prior)
    own.emplace(o.bank);
  const FilmBank &bank = prior ? prior->bank : *own;
  Diagnosis d = diagnosed(experiment, bank, options_of(o, bank, experiment.recipe, prior));
  for (const std::string &note : notes_of(experiment.recipe))
    d.warnings.push_back(note);
  nlohmann::ordered_json gap = to_json(d, bank);
  nlohmann::ordered_json &provenance = gap["provenance"];
  provenance["experiment_file"] = hash_of_file(o.experiment);
  provenance["bank"] = hash_of_file(bank.spec().file);
  provenance["bank_table"] = hash_of_file(bank::table_of(bank.spec()));
  if (!o.case_file.empty())
    provenance["case"] = hash_of_file(o.case_file);
  if (!o.prior.empty())
    provenance["prior"] = hash_of_file(o.prior);
  make_output_folder(o.folder);
  write_gap(gap, diagnosis_page(gap), o.folder);
  print(gap);
  if (o.runs > 0) {
    o.study.folder = o.folder + "/runs";
    gap["shrink"]["runs"] = run_again(d, bank, experiment.recipe, o.runs, o.study);
    put_in_words(gap);
    write_gap(gap, diagnosis_page(gap), o.folder);
    print_runs(gap["shrink"]["runs"]);
  }
  fmt::print("page: {0}/gap.html\ndata: {0}/gap.json\n", o.folder);
}

} // namespace

void set_up_diagnose(CLI::App &verb) {
  auto o = std::make_shared<DiagnoseOptions>();
  o->bank = input_scripts() + "/cases/films/bank.toml";
  verb.add_option("EXPERIMENT", o->experiment, "experiment file (TOML)")->required();
  verb.add_option("-o,--output", o->folder, "folder for gap.json and gap.html")->required();
  verb.add_option("--case", o->case_file,
                  "your model's case (TOML): what acts in it; default: the bank's reference");
  CLI::Option *bank = verb.add_option("--bank", o->bank, "bank (TOML) with its table beside it");
  verb.add_option("--prior", o->prior,
                  "model.json of calibrate, with what other films have taught and its bank")
      ->excludes(bank);
  add_run_options(verb, o->runs, o->study, "--run",
                  "number of simulations of the model and of the leading explanation at every "
                  "pressure, each with another draw on another packing");
  verb.callback([o] { run_diagnose(*o); });
}

} // namespace calendem
