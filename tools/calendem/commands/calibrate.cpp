// SPDX-License-Identifier: GPL-2.0-or-later
// What measured films say of the material.
#include "base/output_folder.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "predict/files.h"
#include "predict/prediction.h"
#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr double kPercent = 100.0;

struct CalibrateOptions {
  std::vector<std::string> experiments;
  std::string bank, folder;
  CalibrationSettings settings;
};

void run_calibrate(const CalibrateOptions &o) {
  const FilmBank bank(read_bank_table(read_bank_spec(o.bank), table_file(o.bank)));
  Calibration c;
  double numerics = 0.0;
  for (const Numerics &n : bank.spec().numerics)
    numerics += n.porosity_points * n.porosity_points;
  c.error.numerics = std::sqrt(numerics) / kPercent;
  std::vector<std::string> not_said;
  for (const std::string &file : o.experiments)
    add_experiment(read_experiment(file), bank, c, not_said);
  make_output_folder(o.folder);
  std::vector<std::string> cases;
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    cases.push_back(o.folder + (m == 0 ? "/case.toml" : fmt::format("/case_{}.toml", m + 1)));
    must_be_ours(cases.back(), kHeadOfCase);
  }
  fmt::print("calibrate: {} films, {} numbers\n", c.films.size(), c.data.size());
  calibrate(bank, o.settings, c);
  for (const std::string &text : warnings_of(bank, c))
    not_said.push_back(text);
  const std::vector<LeftOut> rows = left_out(bank, c, o.settings);
  nlohmann::ordered_json model = to_json(bank, c, rows);
  for (const std::string &file : o.experiments)
    model["provenance"]["experiments"].push_back({{"file", file}, {"hash", hash_of_file(file)}});
  model["not_said"] = not_said;
  write_file(o.folder + "/model.json", model.dump(1) + "\n");
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    write_file(cases[m], case_of(bank, c, m));
  write_file(o.folder + "/model.html", model_page(bank, c, model));
  if (c.materials.size() > 1)
    fmt::print("probability of effects in {}\n", fmt::join(c.materials, " | "));
  for (const Weighed &w : c.hypotheses) {
    fmt::print("  {:<28}", w.name);
    for (const double probability : w.probability)
      fmt::print(" {:5.1f} %", kPercent * probability);
    fmt::print("   ({:.0f} effective samples)\n", w.effective_samples);
  }
  if (!rows.empty())
    fmt::print("each film left out in turn: porosity after release, %\n");
  for (const LeftOut &r : rows)
    fmt::print("  {:<36} {:4.0f} MPa  measured {:.1f}, predicted {:.1f} (90 %: {:.1f} to {:.1f}), "
               "Heckel {:.1f}, Meyer {:.1f}\n",
               r.film, r.pressure, kPercent * r.measured, kPercent * r.predicted.median,
               kPercent * r.predicted.low90, kPercent * r.predicted.high90,
               kPercent * r.rules.at("Heckel"), kPercent * r.rules.at("Meyer"));
  for (const std::string &text : not_said)
    fmt::print("- {}\n", text);
  fmt::print("page: {0}/model.html\nmodel: {0}/model.json\n", o.folder);
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    fmt::print("case: {}{}\n", cases[m], of_material(c, m));
}

} // namespace

void add_calibrate_verb(CLI::App &app) {
  auto o = std::make_shared<CalibrateOptions>();
  o->bank = input_scripts() + "/cases/coatings/bank.toml";
  CLI::App *verb =
      app.add_subcommand("calibrate", "Infer a material's parameters and effects from measured "
                                      "films; predict each film from the others");
  verb->add_option("EXPERIMENT", o->experiments, "experiment files (TOML)")->required();
  verb->add_option("-o,--output", o->folder, "folder for model.json, case.toml and model.html")
      ->required();
  verb->add_option("--bank", o->bank, "bank (TOML) with its table (CSV) beside it");
  verb->add_option("--samples", o->settings.samples, "of each hypothesis, from its prior")
      ->check(CLI::Range(64, 1 << 20));
  verb->callback([o] { run_calibrate(*o); });
}

} // namespace calendem
