// SPDX-License-Identifier: GPL-2.0-or-later
// sealed score: opens the truths and judges the answers, beside the gap that each cause
// really made: the keeper runs the same samples with it and without it.
#ifndef CALENDEM_TESTS_VALIDATION_SEALED_SCORE_H
#define CALENDEM_TESTS_VALIDATION_SEALED_SCORE_H

#include "diagnose/diagnose.h"
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

namespace calendem {

struct TrueGap {
  /// Length of the difference in the metric in which noise and free recalibration have covariance 1.
  double signal_to_noise = 0.0;
  /// "condition|stage|observable" where what recalibration leaves of the difference, without any
  /// noise, is beyond the threshold of "where".
  std::set<std::string> places;
};

/// Specimens with a cause and without it.
struct PairedExperiments {
  Experiment with, without;
};

/// Two runs of one packing differ by chance, too: the least change makes other bonds break. What
/// the samples' differences (columns, in units of noise) have in common is the cause's: the mean of
/// d_i . d_j over all pairs of samples is free of what each has by itself. Its root, 0 where it is
/// negative; of a single sample the length, which chance makes too large.
double common_length(const inference::Matrix &differences);

/// Both share all errors of measurement. Recalibration is linear about the true base parameters
/// `base` (in the bank's order and units); the bank serves for what it absorbs and for the
/// covariance only, not for the difference. `samples`: each alone; fewer than two: the
/// signal-to-noise is that of their mean.
TrueGap true_gap(const PairedExperiments &all, const std::vector<PairedExperiments> &samples,
                 const std::vector<double> &base, const BankTable &table, SharedModels &models);

// How good the answers of a round are. Pure: cases in, numbers with intervals out.

/// One answered case beside its truth.
struct ScoredCase {
  std::string id, block;       ///< of the truth; left_out: the answer without the case's own effect
  int cluster = 0;             ///< number of the truth: cases of one packing share it
  int samples = 0;             ///< of the truth, each as large as a cell; 0: not written down
  std::string truth;           ///< what should be said
  std::string claim, headline; ///< headline: gap.json's "answer"
  std::map<std::string, double> probability; ///< of hypotheses
  std::vector<std::string> set95;
  std::set<std::string> beside; ///< effects that the answer does not exclude beside its claim
  std::set<std::string> places,
      true_places;              ///< "condition|stage|observable": reported, by paired runs
  bool paired = false;          ///< the keeper ran the same samples without the cause
  bool next_named = false;      ///< a measurement that would decide is named
  double signal_to_noise = 0.0; ///< by paired runs, else of a single effect; 0: not known
  std::map<std::string, double> parameters; ///< of the base model, true
  std::vector<bool> covered;                ///< base parameters inside their 90 % intervals
  std::vector<bool> covered_by_average;     ///< ... 95 % intervals over all hypotheses
  std::vector<bool> covered_amplitude;
  /// Share by which the claimed effect shrinks the held-out gap: by the emulators, run again with
  /// its 90 % interval, and the placebo's. NaN: not run again, or there was no gap.
  double predicted_shrinkage = NAN, shrinkage = NAN, least_shrinkage = NAN, most_shrinkage = NAN;
  double placebo_shrinkage = NAN;
  std::map<std::string, std::string> baselines;

  /// The n-th most probable hypothesis, from 0; empty beyond the last.
  std::string ranked(int n) const;
  /// A pair of which one half is claimed and the other is not excluded beside it.
  bool right_in_part() const;
};

using CaseTest = std::function<bool(const ScoredCase &)>;
/// Some of the cases of a round, which outlives the list.
using Cases = std::vector<const ScoredCase *>;

/// One number of the score, with a 90 % interval.
struct Metric {
  std::string name;
  double value = 0.0, low = 0.0, high = 0.0; ///< NaN: no case for it
  double least = 0.0, most = 0.0;            ///< one-sided 90 % bounds
  int cases = 0, clusters = 0;
  std::string gate; ///< "≥ 0.85"; empty: reported only
  /// Met: by the one-sided 90 % bound too; not_shown: by the value alone.
  enum Verdict { none, met, not_shown, missed, not_measured } verdict = none;
};

/// Every gate and what is reported beside it, then the baselines.
std::vector<Metric> metrics_of(const std::vector<ScoredCase> &cases);

/// truth -> claim -> cases.
std::map<std::string, std::map<std::string, int>>
confusion_of(const std::vector<ScoredCase> &cases);

/// Share of the cases chosen for which `hit` holds. Interval by drawing whole clusters; where all
/// cases agree, the exact one of a proportion of clusters, since no draw could differ.
Metric share_of(const std::string &name, const std::vector<ScoredCase> &cases,
                const CaseTest &chosen, const CaseTest &hit);

/// Any statistic of the cases, which are not none; the interval by drawing whole clusters. NaN
/// without cases.
Metric statistic_of(const std::string &name, const Cases &cases,
                    const std::function<double(const Cases &)> &statistic);

Cases chosen_of(const std::vector<ScoredCase> &cases, const CaseTest &chosen);

/// Mean of -ln of the probability given to the truth, 1e-6 at least.
double log_score_of(const Cases &cases);
/// Against always giving the round's own frequencies: the best that knows nothing of the data.
double brier_skill_of(const Cases &cases);
/// Expected calibration error: mean over cases of |how often the most probable hypothesis is right -
/// its mean probability| in tenths of that probability. Nulls, unknowns and the rest count together as much as their
/// priors: a probability is right only for the mixture for which it is stated.
double calibration_error_of(const Cases &cases);
/// F1 of the places reported against the true ones, all cases together: 2 common / (reported +
/// true).
double localisation_f1_of(const Cases &cases);
/// AUROC of the probability given to "unknown", where that is the truth against where it is not.
double auroc_of_unknown(const Cases &cases);

/// Signal-to-noise from which the gates of `where` and `which` count, that from which an effect must
/// be in the stated set and a cause outside the table must not be "nothing to see", and that of the
/// detection limit: log-odds of 3 are half of a squared distance of 6.
constexpr double kStrongEnough = 6.0, kVisible = 3.0, kDetectable = 2.449489742783178;

/// Signal-to-noise and places of the cases whose samples the keeper ran without the cause too.
/// Throws Failure(4) if bank or table are not those of the answers.
void add_true_gaps(const std::string &folder, const std::string &answers, const std::string &bank,
                   const std::string &table, std::vector<ScoredCase> &cases);

/// Truths and answers of a round. Throws Failure: 4 if a truth, what was handed out or an answer
/// is not what its hash says, 2 if files are missing.
std::vector<ScoredCase> open_round(const std::string &folder, const std::string &answers);

/// One case from its truth and its answer; `without`: the answer without its own effect, which
/// is a case of its own where that was the truth's only effect; `shrink`: of models run again, an
/// empty object where none was.
void add_cases(const nlohmann::json &truth, const nlohmann::json &gap,
               const nlohmann::json &without, const nlohmann::json &baselines,
               const nlohmann::json &shrink, std::vector<ScoredCase> &out);

/// Writes scores.json, scores.md and scores.html into `folder`.
void write_scores(const std::vector<ScoredCase> &cases, const std::string &round,
                  const std::string &folder);

struct ScoreOptions {
  std::string round, answers, folder;
  std::string bank, table; ///< with which it was answered
};
void score_round(const ScoreOptions &options);

} // namespace calendem

#endif
