// SPDX-License-Identifier: GPL-2.0-or-later
// Everything learnt from a bank for one set of measured observables; knows no measured value.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_MODEL_H
#define CALENDEM_DIAGNOSE_INFERENCE_MODEL_H

#include "diagnose/inference/scatter.h"
#include "diagnose/inference/which.h"
#include <map>
#include <memory>

namespace calendem::inference {

class Emulators;

/// Observables that could be measured too; all in the bank.
struct Candidate {
  std::string what;
  double cost = 0.0; ///< in any one unit
  std::vector<ObservableId> of;
  Matrix covariance; ///< of that measurement
};

/// The specimen of a condition, by its id, and of how many such it is the mean; none of its own
/// name: the experiment's one. What packings scatter by is common to a specimen's conditions only.
struct Specimen {
  std::string name;
  int count = 1;
};
using Specimens = std::map<std::string, Specimen>;

struct ModelSettings {
  /// Simulated cells that the measured sample is as large as, or that the measured values are the
  /// mean of: the scatter between packings counts with its inverse. 1: one cell of the bank's size.
  double packings_in_sample = 1.0;
  /// An emulator is poor when it predicts less than this share of what it should, the expectation
  /// over packings...
  double least_q2 = 0.5;
  /// ...and what it misses is more than this many standard deviations of the data.
  double largest_error = 1.0;
  Specimens specimens;
};

/// How well emulators predict runs of packings they have not seen.
struct EmulatorQuality {
  std::string effect; ///< empty: base model
  int runs = 0;
  std::vector<Quality> feature; ///< emulated ones, in the order of features
  /// Share of what can be learnt, without the runs' scatter, that left-out packings show to be; of
  /// all features, weighted by the data's variances; 0 to 1. 0: nothing that could be told from
  /// the scatter.
  double q2 = 0.0;
  double error =
      0.0; ///< root mean square over features of the emulators' own error, in the data's sd
  bool poor = false;
};

class Model {
public:
  /// Throws Failure(2) if the bank is not fit for it. Seconds for 300 runs.
  Model(const Bank &bank, const ObservableVector &experiment, const ModelSettings &settings,
        const std::vector<Candidate> &candidates = {});

  /// For measured values of the observables given at the start. `of`: what it predicts.
  Problem problem(const Vector &values, Part of = Part::whole) const;
  std::vector<Extension> extensions(const Vector &values) const;

  const std::vector<EmulatorQuality> &quality() const { return quality_; }
  std::vector<std::string> poor_effects() const;
  const FeatureMap &map() const { return *map_; }
  const Emulators &emulators() const { return *emulators_; }
  /// Variance of the emulated features: the measurement's and the sample's packings'.
  Vector data_variance() const;
  double packings_in_sample() const { return settings_.packings_in_sample; }
  const Scatter &scatter() const { return scatter_; }
  const std::vector<ObservableId> &observables() const { return observables_; }
  const Vector &sd() const { return sd_; } ///< of the observables: measurement and packings
  const Matrix &measurement() const { return measurement_; } ///< covariance of the observables

private:
  struct Extra {
    Candidate candidate;
    std::shared_ptr<const FeatureMap> map;
    std::shared_ptr<const Emulators> emulators;
    Matrix scatter, correlation; ///< of old and new emulated features
  };
  std::vector<ObservableId> observables_;
  std::vector<ModelledEffect> effects_;
  ModelSettings settings_;
  Matrix measurement_; ///< of the observables
  Vector sd_;          ///< of the observables: measurement and packings
  std::shared_ptr<const FeatureMap> map_;
  std::shared_ptr<const Emulators> emulators_;
  Scatter scatter_;
  Matrix correlation_; ///< of the emulators' errors between emulated features
  std::vector<EmulatorQuality> quality_;
  std::vector<Extra> extra_;
  int base_parameters_ = 0;

  void judge_emulators();
  Extra learn_extra(const Bank &bank, const Candidate &candidate) const;
};

/// Covariance of a discrepancy of one standard deviation (`sd` of the observables): Gaussian in the
/// coordinate with a length of 0.3, half of it common to the conditions of an observable and a
/// stage, none between observables and stages, a tenth rough.
Matrix unknown_covariance(const std::vector<ObservableId> &observables, const Vector &sd);

} // namespace calendem::inference

#endif
