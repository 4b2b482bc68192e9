// SPDX-License-Identifier: GPL-2.0-or-later
// The truths of a round: what was true of every sample that is handed out.
#ifndef CALENDEM_TESTS_VALIDATION_SEALED_TRUTHS_H
#define CALENDEM_TESTS_VALIDATION_SEALED_TRUTHS_H

#include "sealed/round_file.h"
#include "simulate/study_file.h"
#include <nlohmann/json.hpp>
#include <optional>

namespace calendem {

/// One set of parameters, run to every pressure of the bank on a packing for each sample.
struct Truth {
  std::string block; ///< null, single, open, pair, fault, other, intervention
  std::vector<std::pair<std::string, double>> effects; ///< value of the effect's key
  std::vector<std::string> hidden;
  int samples = 1;          ///< whose mean is handed out
  double understated = 1.0; ///< true over stated standard deviations
  /// Seeds of the recipe: one for each sample, or, where every pressure has discs of its own, for
  /// each sample and pressure, the pressures of a sample together. Of a round with repeats the samples
  /// of one repeat together.
  std::vector<unsigned long> packings;
  std::vector<unsigned long>
      packings_before;         ///< the same of what was pressed before an intervention
  std::vector<double> base;    ///< of the bank's parameters
  double pressure_error = 0.0; ///< true over stated pressure, less 1
  int draws = 1;               ///< of noise
  std::size_t set =
      0; ///< truths of one set share samples, press and base parameters; in random order
};

/// Samples as those of `truth`, under the same press without effects and hidden changes of the
/// physics.
Truth without_cause(Truth truth);
bool has_cause(const Truth &truth);
/// What is run beside a truth, if anything: the samples before an intervention; in a round of paired
/// runs the samples of any other truth with a cause again, without it.
std::optional<Truth> companion(const Round &round, const Truth &truth);
/// All that is run: the truths, and behind them their companions, in their order.
std::vector<Truth> with_pairs(const Round &round, std::vector<Truth> truths);

/// What a diagnosis should say: none, effects joined by " + " in the bank's order, noise, unknown.
std::string right_answer(const Truth &truth, const BankSpec &bank);

/// All truths of the round, the same for the same secret. Base parameters are drawn from their
/// priors, or intervals could not be judged; the k-th of n amplitudes from the k-th n-th of its
/// prior. Numbers of samples come in turn in every block; among single effects each effect starts
/// with another, or an amplitude would always have the same. In a round of shared samples all else than the cause is that of
/// the nulls, in turn; numerics and understated errors are the truth's own.
std::vector<Truth> draw_truths(const Round &round, const std::string &secret);

/// Truths set after set, so that a round that was stopped has whole sets; only the first so many,
/// 0: all. Throws Failure(2) if that is asked of a round without sets.
std::vector<Truth> truths_of_sets(const Round &round, const std::string &secret, int sets);

/// The runs of a truth, and of all: for each repeat and sample, one per pressure of the bank. Throws Failure(2) where
/// values contradict each other.
std::size_t runs_of(const Round &round, const Truth &truth);
struct TruthRuns {
  Study study;
  std::vector<std::size_t> of_truths; ///< number of the run in the study; alike runs are one
};
TruthRuns truth_runs(const Round &round, const std::vector<Truth> &truths);

nlohmann::json to_json(const Truth &truth, const BankSpec &bank);

} // namespace calendem

#endif
