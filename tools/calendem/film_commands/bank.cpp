// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank/training.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "film_commands/film_commands.h"
#include "simulate/making.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace {

namespace fs = std::filesystem;

/// What became of a run whose making is over.
bank::Run run_of(const bank::Point &point, const std::string &folder, const std::string &packing) {
  try {
    return bank::read_run_of(point, folder);
  } catch (const Failure &) {
    bank::Run run;
    run.point = point;
    run.failed = fs::exists(packing + "/electrode.json") ? "not pressed" : "not packed";
    return run;
  }
}

void write_table(const bank::Bank &spec, const std::vector<bank::Run> &runs,
                 const std::string &folder) {
  write_file(folder + "/bank.csv", bank::write_runs({spec, runs}));
  const auto failed = std::count_if(runs.begin(), runs.end(),
                                    [](const bank::Run &run) { return !run.failed.empty(); });
  fmt::print("bank: {} of {} points, {} of them without a run, {}/bank.csv\n", runs.size(),
             spec.design.points, failed, folder);
}

const char *const kNames[kFilmNumbers] = {
    "porosity after release", "springback",         "cracked particles",  "ln of unloading modulus",
    "broken bonds",           "inverse tortuosity", "nanoporosity of CBD"};

/// Prints how well the emulator of such a bank predicts packings that are left out. `table`: empty:
/// the one beside the bank's file.
void check_bank(const std::string &file, const std::string &table) {
  const bank::Bank spec = bank::read_bank(file);
  const std::string from = table.empty() ? bank::table_of(spec) : table;
  const bank::Runs runs = bank::read_runs(spec, from);
  const inference::Emulator emulator = bank::emulator_of(runs, from);
  const std::vector<double> pressures = bank::pressures_of(spec);
  const std::vector<inference::Accuracy> all =
      inference::accuracy_of(emulator.left_out(), emulator.runs().values);
  fmt::print("{}: {} runs, every packing left out in turn\n  {:<24} {:>5} {:>7} {:>8} {:>8} {:>7} "
             "{:>7}\n",
             from, emulator.runs().packing.size(), "", "MPa", "Q2", "error", "spread", "in 50 %",
             "in 90 %");
  for (int number = 0; number < kFilmNumbers; ++number)
    for (std::size_t k = 0; k < pressures.size(); ++k) {
      const inference::Accuracy &a =
          all[std::size_t(bank::output_of(FilmNumber(number), k, pressures.size()))];
      if (std::isfinite(a.q2))
        fmt::print("  {:<24} {:>5.0f} {:>7.2f} {:>8.4f} {:>8.4f} {:>6.0f}% {:>6.0f}%\n",
                   kNames[number], pressures[k], a.q2, a.error, a.spread, 100.0 * a.inside_50,
                   100.0 * a.inside_90);
    }
}

/// Makes the runs of a bank of points and its table. `from`: tables whose runs are taken.
void make_bank(const StudyOptions &given, const std::vector<std::string> &from) {
  const bank::Bank spec = bank::read_bank(given.file);
  std::vector<bank::Run> runs;
  std::vector<bank::Point> left = bank::points_of(spec.design);
  for (const std::string &table : from)
    for (bank::Run &run : bank::read_runs(spec, table).runs) {
      const auto had = std::remove_if(left.begin(), left.end(), [&](const bank::Point &p) {
        return p.number == run.point.number;
      });
      if (had != left.end())
        runs.push_back(std::move(run));
      left.erase(had, left.end());
    }
  make_output_folder(given.folder);
  if (!left.empty()) {
    StudyOptions options = given;
    for (const std::string &table : from)
      options.further.insert(options.further.end(), {"--from", fs::absolute(table).string()});
    const Study study = bank::study_of(spec, left);
    make_what_runs(study, options, "Points");
    if (options.slurm.dry_run)
      return;
    const std::vector<RunPlace> places = places_of(study, options);
    for (std::size_t k = 0; k < left.size(); ++k)
      if (places[k].ended)
        runs.push_back(run_of(left[k], places[k].run, places[k].packing));
  }
  std::sort(runs.begin(), runs.end(),
            [](const bank::Run &a, const bank::Run &b) { return a.point.number < b.point.number; });
  write_table(spec, runs, given.folder);
  const auto there = [](const bank::Run &run) { return run.failed.empty(); };
  if (!runs.empty() && std::none_of(runs.begin(), runs.end(), there))
    throw Failure(kSimulationFailed, given.folder + ": no point has a run.");
}

struct BankOptions {
  StudyOptions study;
  std::vector<std::string> from; ///< tables whose runs are taken
  bool check = false;
};

} // namespace

void set_up_bank(CLI::App &verb) {
  auto o = std::make_shared<BankOptions>();
  verb.add_option("BANK", o->study.file, "bank (TOML)")->required();
  add_study_options(verb, o->study);
  verb.add_option("--from", o->from, "tables of this bank whose runs are used again");
  CLI::Option *check = verb.add_flag(
      "--check", o->check,
      "make no runs: print how well the emulator predicts packings that are left out");
  for (const char *other : {"--only", "--table", "--slurm", "--slurm-dry-run"})
    check->excludes(verb.get_option(other));
  verb.callback([o] {
    if (o->check)
      check_bank(o->study.file, o->from.empty() ? "" : o->from.front());
    else
      make_bank(o->study, o->from);
  });
}

} // namespace calendem
