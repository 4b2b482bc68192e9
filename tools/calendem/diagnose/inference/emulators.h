// SPDX-License-Identifier: GPL-2.0-or-later
// An emulator for every feature, of the base model and of the difference each effect makes.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_EMULATORS_H
#define CALENDEM_DIAGNOSE_INFERENCE_EMULATORS_H

#include "diagnose/inference/gaussian_process.h"
#include "diagnose/inference/problem.h"
#include <map>
#include <string>

namespace calendem::inference {

/// Share of the base model's variance between runs in a difference of two: between 0, if all of it
/// is what the base emulator misses, which cancels, and 2, if all is chaotic. 1 and 2 predict
/// left-out differences of a bank of 8 packings about as well.
constexpr double kOfDifference = 1.5;

class Emulators {
public:
  /// `features`: emulated features x runs of the bank, in its order.
  Emulators(const Bank &bank, const Matrix &features);

  /// Adds to the features from `first` on. Several effects add up: what they do to each other is
  /// not in it. `of`: of the whole, or of what the effects change only.
  void predict(const Vector &base_scores, const std::vector<Applied> &on, int first,
               Prediction &out, Part of = Part::whole) const;

  /// Predicts, with derivatives, into the rows from `first` on.
  void slopes(const Vector &base_scores, const std::vector<Applied> &on, int first, Slopes &out,
              Part of = Part::whole) const;

  const std::vector<GaussianProcess> &base() const { return base_; }
  const std::vector<GaussianProcess> &effect(int which) const { return effects_[which]; }
  /// What base model and simulated effects (not computed ones) miss in their own runs, in standard
  /// deviations of the runs' scatter: runs x features, in an order that depends on the bank only.
  Matrix residuals() const;
  /// Place in the bank of each row's run; those of the base model are the first.
  const std::vector<int> &runs() const { return runs_; }
  /// Number of the packing of each base run.
  const std::vector<int> &packing() const { return packing_; }
  /// What `effect`'s emulators can be asked for at these places; `packing`: the id of each, empty
  /// for the expectation. One that the bank has not is known by no run.
  Asked asked(int effect, const std::vector<Vector> &base, const std::vector<Vector> &amplitudes,
              const std::vector<std::string> &packing) const;

private:
  std::vector<Parameter> parameters_;
  std::vector<ModelledEffect> table_;
  std::vector<int> packing_, runs_;
  std::map<std::string, int> number_; ///< of a packing
  std::vector<GaussianProcess> base_;
  std::vector<std::vector<GaussianProcess>> effects_;

  Vector scaled(const Vector &base_scores) const;
};

/// Places of the bank's runs of the base model.
std::vector<int> base_runs(const Bank &bank);

/// The base parameters of a run, scaled.
Vector scaled_base(const Bank &bank, const BankRun &run);

} // namespace calendem::inference

#endif
