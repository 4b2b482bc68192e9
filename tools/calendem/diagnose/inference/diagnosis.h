// SPDX-License-Identifier: GPL-2.0-or-later
// The diagnosis of one experiment, and of the difference between two, one before and one after a
// change: what the model leaves out of both, the press's errors and the bank's numerics cancel.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_DIAGNOSIS_H
#define CALENDEM_DIAGNOSE_INFERENCE_DIAGNOSIS_H

#include "diagnose/inference/averaged.h"
#include "diagnose/inference/confounding.h"
#include "diagnose/inference/model.h"
#include "diagnose/inference/where.h"
#include "diagnose/inference/which.h"
#include <nlohmann/json_fwd.hpp>

namespace calendem::inference {

/// All vectors are of `of`, in the units of the observables.
struct Predictions {
  std::string best; ///< the most probable hypothesis that makes a prediction
  std::vector<ObservableId> of;
  Vector measured, sd_measurement;
  Vector sd;    ///< of measurement and packings
  Vector base;  ///< of the base model where it fits best: recalibrated, no effect on
  Vector after; ///< of `best` where it fits best, recalibrated too
};

/// From the emulators at the modes of the two hypotheses. What the emulators' features leave out of
/// a curve is that of the bank's mean curve.
Predictions predictions(const Model &model, const Problem &problem, const Which &which,
                        const Vector &measured);

/// The most probable hypothesis that makes a prediction: none, an effect, a pair.
const Judged &best_predicting(const Which &which);

struct DiagnosisSettings {
  ModelSettings model;
  WhichSettings which;
  WhereSettings where;
  ConfoundingSettings confounding;
  NextSettings next;
};

/// Residual of a block, in units of the observable: simulation less experiment. Of a curve the root
/// mean square over its points, with the sign of their mean.
struct BlockResidual {
  double residual = 0.0, sd = 0.0; ///< sd: of measurement and packings, before recalibration
  double worst_coordinate = 0.0;   ///< where |residual| / sd is largest
};

/// A parameter in its unit: where the most probable hypothesis fits best, and as all hypotheses
/// leave it.
struct Recalibrated {
  std::string parameter;
  double mode = 0.0, low90 = 0.0, high90 = 0.0;
};

/// An amplitude or another parameter of an effect that the most probable hypothesis with a
/// prediction has: where that fits best, and as all hypotheses in which the effect acts leave it.
struct FittedEffect {
  std::string effect, parameter;
  double mode = 0.0, low90 = 0.0, high90 = 0.0; ///< in its unit
};

struct Diagnosis {
  Where where;
  std::vector<BlockResidual> residual; ///< by block
  std::vector<Block> blocks;
  Which which;
  Confounding confounding;
  std::vector<NextMeasurement> next;
  std::vector<Recalibrated> parameters; ///< of the base model
  std::vector<FittedEffect> effects;
  std::vector<EffectRange> ranges;               ///< of all effects, over all hypotheses
  std::vector<ParameterRange> parameters_of_all; ///< the same of the base model's parameters
  std::vector<EffectGroup> groups;
  Predictions predictions;
  std::vector<EmulatorQuality> emulators;
  double degrees_of_freedom = 0.0, shrinkage = 0.0; ///< of the scatter between packings
};

/// Which explanations the data discriminate, and from which amplitude on.
struct Discrimination {
  Which which;
  Confounding confounding;
};
/// By the rules, what cannot be seen counting as none; effects with poor emulators are not claimed.
Discrimination discriminate(const Model &model, const Problem &problem,
                            const DiagnosisSettings &settings);

/// Deterministic: the same model, values and settings give the same bytes. A quarter of a minute on
/// one core for 20 features, 10 effects and 60 runs of each.
Diagnosis diagnose(const Model &model, const Bank &bank, const Vector &values,
                   const DiagnosisSettings &settings,
                   const std::vector<PointNoise> &point_noise = {});

/// Diagnosis of a problem that the model's predictions are part of only; no next measurements.
Diagnosis diagnose(const Model &model, const Problem &problem, const Bank &bank,
                   const Vector &values, const DiagnosisSettings &settings);

/// gap.json but for units, words and "shrink".
nlohmann::ordered_json to_json(const Diagnosis &diagnosis, const std::string &experiment);

/// What is known of the base parameters' scores: normal.
struct KnownBase {
  Vector mean;
  Matrix covariance;
};

/// What is known of the base model recalibrated on an experiment. `predicted`: the observables
/// there.
KnownBase recalibrated(const Model &model, const Vector &values, Vector &predicted);

/// `model` is of the differences' observables with their covariance; `values`: `predicted` and what
/// changed. Predictions are `predicted` and the difference that an effect makes at base parameters
/// as known; without an effect nothing changes, whatever they are. Two pieces scatter twice.
Problem change_of(const Model &model, const Vector &values, const Vector &predicted,
                  const KnownBase &base);

} // namespace calendem::inference

#endif
