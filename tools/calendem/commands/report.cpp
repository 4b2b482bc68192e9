// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/report.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "diagnose/compare/gap.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <memory>

namespace calendem {

namespace {

struct Options {
  std::string experiment, folder = "gap";
  std::vector<std::string> runs;
};

void print_rows(const std::vector<Residual> &rows) {
  const auto name = [](const Residual &r) {
    return r.observable + (r.unit.empty() ? "" : ", " + r.unit);
  };
  std::size_t width = 0;
  for (const Residual &r : rows)
    width = std::max(width, name(r).size());
  fmt::print("{:<6} {:<{}} {:>9} {:>9} {:>9} {:>7} {:>6}\n", "", "", width, "measured", "simulated",
             "differ by", "z", "share");
  for (const Residual &r : rows)
    fmt::print("{:<6} {:<{}} {:>9.4g} {:>9.4g} {:>+9.3g} {:>+7.1f} {:>5.0f}%\n", r.condition,
               name(r), width, r.measured, r.simulated, r.residual, r.z, 100.0 * r.share);
}

void compare(const Options &o) {
  const Experiment experiment = read_experiment(o.experiment);
  std::vector<SimulatedRun> runs;
  Mistakes mistakes;
  for (const std::string &folder : o.runs)
    try {
      runs.push_back(read_simulated_run(folder));
    } catch (const Failure &f) {
      mistakes.add(f);
    }
  mistakes.stop_if_any();
  const Gap gap = find_gap(experiment, runs);
  nlohmann::ordered_json j = to_json(gap);
  j["provenance"]["experiment_file"] = hash_of_file(o.experiment);
  for (const std::string &folder : o.runs)
    j["provenance"]["runs"][folder] = hash_of_file(folder + "/summary.json");
  make_output_folder(o.folder);
  write_gap(j, gap_page(j), o.folder);
  print_rows(gap.rows);
  for (const std::string &text : gap.said)
    fmt::print("* {}\n", text);
  for (const std::string &text : gap.not_said)
    fmt::print("- {}\n", text);
  fmt::print("page: {0}/gap.html\ndata: {0}/gap.json\n", o.folder);
}

} // namespace

void add_compare_verb(CLI::App &app) {
  auto o = std::make_shared<Options>();
  CLI::App *verb = app.add_subcommand("compare", "Where simulation and experiment disagree");
  verb->add_option("EXPERIMENT", o->experiment, "experiment file (TOML)")->required();
  verb->add_option("DIR", o->runs,
                   "directories made by calendem run; several packings per "
                   "condition give the scatter")
      ->required();
  verb->add_option("-o,--output", o->folder, "folder for gap.json and gap.html")
      ->capture_default_str();
  verb->callback([o] { compare(*o); });
}

void add_report_verb(CLI::App &app) {
  struct Options {
    std::vector<std::string> directories;
    std::string page;
  };
  const auto options = std::make_shared<Options>();
  CLI::App *verb = app.add_subcommand(
      "report", "One self-contained page with charts and pictures of one or more runs");
  verb->add_option("DIR", options->directories, "Directories made by calendem run")
      ->required()
      ->type_name("");
  verb->add_option("-o,--output", options->page,
                   "Page to write; its data go to the same name with .json. Default: report.html "
                   "in the run's directory, or here if there are several")
      ->type_name("FILE.html");
  verb->callback([options] { report::write_report(options->directories, options->page); });
}

} // namespace calendem
