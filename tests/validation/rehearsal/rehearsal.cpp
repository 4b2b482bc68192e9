// SPDX-License-Identifier: GPL-2.0-or-later
// A rehearsal of the diagnosis on runs of a bank:
//   rehearsal BANK FOLDER [--every N] [--fresh TABLE] [--cases N] [--baselines]
// Every packing is left out in turn; its runs, with a laboratory's errors, are films that are diagnosed with what the
// other packings teach. With --fresh the films are the runs of TABLE that the bank's own table lacks. The user's model is
// the run's own (nothing to see), lacks an effect of it, or two, or has one that does not act. Writes
// FOLDER/answers.csv and prints scores. With --cases the first N films are asked once each, the model of every fifth
// lacking nothing, and are kept for others to solve: FOLDER/case_01 and so on, with the model as a case file.
#include "base/messages.h"
#include "base/provenance.h"
#include "baselines.h"
#include "laboratory.h"
#include "scores.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace {

using namespace calendem;

struct Options {
  std::string bank, folder, fresh;
  int every = 1, cases = 0;
  bool baselines = false;
};

/// The bank without a packing, its fit kept.
FilmBank without(const bank::Runs &all, int packing, const inference::Hyperparameters &fit) {
  bank::Runs rest = all;
  rest.runs.erase(std::remove_if(rest.runs.begin(), rest.runs.end(),
                                 [&](const bank::Run &r) { return r.point.packing == packing; }),
                  rest.runs.end());
  return FilmBank(rest, inference::Emulator(bank::training_of(rest), fit));
}

/// Runs of the bank's usual cell that were pressed as far as a laboratory would.
bool is_film(const bank::Run &run) {
  return run.failed.empty() && !run.point.larger && run.presses.size() >= 5;
}

/// How errors of packings that were left out are spread, many outputs at a time: their square in the covariance that
/// a diagnosis takes, per output.
void print_errors_together(const std::string &bank_file) {
  const bank::Bank spec = bank::read_bank(bank_file);
  const std::string table = bank::table_of(spec);
  const bank::Runs runs = bank::read_runs(spec, table);
  const inference::Emulator emulator = bank::emulator_of(runs, table);
  const FilmBank bank(runs, emulator);
  const inference::LeftOut left = emulator.left_out();
  const inference::Matrix z =
      (emulator.runs().values - left.predicted).cwiseQuotient(left.deviation);
  const std::size_t presses = bank.pressures().size();
  const int loading = bank::loading_output(0, presses),
            release = bank::release_output(0, 0, presses);
  const auto print = [&](const char *name, int from, int to) {
    std::vector<double> squares;
    for (Eigen::Index r = 0; r < z.cols(); ++r) {
      std::vector<int> known;
      for (int o = from; o < to; ++o)
        if (std::isfinite(z(o, r)))
          known.push_back(o);
      if (known.empty())
        continue;
      const inference::Cholesky c(inference::Matrix(bank.error_correlation()(known, known)));
      squares.push_back(c.matrixL().solve(inference::Vector(z(known, r))).squaredNorm() /
                        double(known.size()));
    }
    std::sort(squares.begin(), squares.end());
    const auto at = [&](double share) {
      return squares[std::size_t(share * double(squares.size() - 1))];
    };
    fmt::print("{}: {} outputs, mean {:.2f}; 25, 50, 75, 95 %: {:.2f} {:.2f} {:.2f} {:.2f}\n", name,
               to - from,
               std::accumulate(squares.begin(), squares.end(), 0.0) / double(squares.size()),
               at(0.25), at(0.5), at(0.75), at(0.95));
  };
  print("porosity after release", 0, int(presses));
  print("compression under load", loading, release);
  print("recovered on release", release, bank::count_of_outputs(presses));
}

class Rehearsal {
public:
  explicit Rehearsal(const Options &options)
      : options_(options), spec_(bank::read_bank(options.bank)), table_(bank::table_of(spec_)),
        runs_(bank::read_runs(spec_, table_)),
        fit_(bank::emulator_of(runs_, table_).hyperparameters()) {}

  void left_out() {
    for (int packing = 1; packing <= spec_.design.packings; ++packing)
      diagnose(without(runs_, packing, fit_), runs_,
               [&](const bank::Run &r) { return r.point.packing == packing; });
  }

  void fresh() {
    const bank::Runs all = bank::read_runs(spec_, options_.fresh);
    diagnose(FilmBank(runs_, bank::emulator_of(runs_, table_)), all, [&](const bank::Run &r) {
      return std::none_of(runs_.runs.begin(), runs_.runs.end(), [&](const bank::Run &known) {
        return known.point.number == r.point.number;
      });
    });
  }

  void finish() {
    write_file(options_.folder + "/answers.csv", answers_);
    scores_.print();
  }

private:
  Options options_;
  bank::Bank spec_;
  std::string table_;
  bank::Runs runs_;
  inference::Hyperparameters fit_;
  Scores scores_;
  std::string answers_ = "case,point,kind,changes,signal,method,answer,named\n";
  int place_ = 0, turn_ = 0, case_ = 0;

  template <class Chosen>
  void diagnose(const FilmBank &bank, const bank::Runs &runs, const Chosen &chosen) {
    for (const bank::Run &run : runs.runs) {
      if (!chosen(run) || !is_film(run) || place_++ % options_.every != 0 ||
          (options_.cases > 0 && turn_ == options_.cases))
        continue;
      std::vector<Truth> truths = truths_of(spec_, run, turn_++);
      if (options_.cases > 0)
        truths = {turn_ % 5 == 1 ? truths.front() : truths.back()};
      for (const Truth &truth : truths)
        ask(bank, run, truth);
    }
  }

  void ask(const FilmBank &bank, const bank::Run &run, const Truth &truth) {
    ++case_;
    const Laboratory laboratory(bank, options_.cases > 0
                                          ? fmt::format("{}/case_{:02}", options_.folder, case_)
                                          : options_.folder);
    const Experiment e = laboratory.measure(run, std::uint64_t(run.point.number));
    laboratory.write_model(truth);
    DiagnosisOptions options;
    options.acting = truth.acting;
    const Diagnosis d = diagnosed(e, bank, options);
    scores_.add_probabilities(truth, d);
    scores_.add_ranges(truth, d, spec_, run);
    std::vector<Answer> answers = {answer_of(d)};
    if (options_.baselines)
      for (const Answer &a : baseline_answers(d))
        answers.push_back(a);
    for (const Answer &a : answers) {
      scores_.add(truth, signal_of(d), a, d);
      answers_ +=
          fmt::format("case_{:02},{},{},{},{:.2f},{},{},{}\n", case_, run.point.number,
                      kKinds[truth.kind], fmt::join(truth.changes, " + "), signal_of(d), a.method,
                      a.named.empty() ? "nothing"
                      : a.sure        ? "explained"
                                      : "one of",
                      fmt::join(a.named, " + "));
    }
    fmt::print("point {}, {} {}: {}\n", run.point.number, kKinds[truth.kind],
               fmt::join(truth.changes, " + "), fmt::join(answers.front().named, " + "));
    std::fflush(stdout);
  }
};

} // namespace

int main(int argc, char **argv) {
  Options options;
  CLI::App app("A rehearsal of the diagnosis on runs of a bank");
  app.add_option("bank", options.bank, "bank.toml")->required();
  app.add_option("folder", options.folder, "what it writes")->required();
  app.add_option("--every", options.every, "of so many runs one")->check(CLI::PositiveNumber);
  app.add_option("--fresh", options.fresh, "table with runs that the bank lacks");
  app.add_option("--cases", options.cases, "of so many films, kept for others to solve")
      ->check(CLI::PositiveNumber);
  app.add_flag("--baselines", options.baselines, "asks simpler methods, too");
  CLI11_PARSE(app, argc, argv);
  return exit_status_of([&] {
    Rehearsal rehearsal(options);
    if (options.fresh.empty())
      print_errors_together(options.bank);
    options.fresh.empty() ? rehearsal.left_out() : rehearsal.fresh();
    rehearsal.finish();
    return 0;
  });
}
