// SPDX-License-Identifier: GPL-2.0-or-later
// How far the gap shrinks once an effect is in: base model and effect, both recalibrated on the
// training conditions, are run again for the held-out ones on packings that nothing has seen.
#ifndef CALENDEM_DIAGNOSE_RERUN_H
#define CALENDEM_DIAGNOSE_RERUN_H

#include "compare/gap.h"
#include "diagnose/diagnose.h"
#include "inference/quantities.h"
#include "simulate/study.h"
#include <nlohmann/json.hpp>

namespace calendem {

// How far simulations are from measurements that nothing was fitted to.

/// A number with the interval that holds 90 % of its resamples; NaN: not known.
struct Estimate {
  double value = 0.0, low90 = 0.0, high90 = 0.0;
};

/// Held-out observables: what was measured, and a column for each simulated packing.
struct HeldOut {
  std::vector<inference::Block> blocks; ///< each counts the same
  inference::Vector measured, sd;       ///< sd > 0: of measurement and sample
};

/// Adds to the deviations what the measured sample scatters by itself: the variance of packings,
/// pooled over the models (columns: packings), over the number of cells it is as large as.
void add_sample_scatter(const std::vector<inference::Matrix> &models, double cells,
                        HeldOut &held_out);

/// Root mean square of (mean over packings - measured) / sd, freed of what measurement noise and
/// the scatter of that mean add to it; 0 where they explain all. In standard deviations of the
/// measurement and the sample. `scatter`: squares of the standard errors of `mean`.
double gap_of(const HeldOut &held_out, const inference::Vector &mean,
              const inference::Vector &scatter, double noises = 1.0);

/// Gap from packings (columns, two at least). The interval is of resamples of noise and
/// packings (t).
Estimate gap_of_packings(const HeldOut &held_out, const inference::Matrix &simulated);

/// 1 - gap after / gap before, packing by packing (the same columns); NaN where
/// there is no gap before.
Estimate shrinkage_of(const HeldOut &held_out, const inference::Matrix &before,
                      const inference::Matrix &after);

/// The gap that a model without any would show at most, with 95 % probability, by the noise and the
/// scatter of these packings.
double noise_floor(const HeldOut &held_out, const inference::Matrix &simulated);

/// Value and 90 % interval of numbers of equal weight.
Estimate interval_of(double value, std::vector<double> draws);

/// One model that is run again.
struct RerunModel {
  std::string role; ///< before, after (the leading effect, claimed or not), runner-up, placebo
  std::string hypothesis;   ///< none, an effect, or "a + b"
  std::vector<double> base; ///< base parameters at their mode on the training conditions
  std::map<std::string, double> effect; ///< value of the effect's key, by name
  Estimate predicted;                   ///< gap on the held-out conditions by the emulators
};

/// The model of a hypothesis at these scores of base parameters and effects.
RerunModel model_at(const std::string &role, const inference::Hypothesis &hypothesis,
                    const inference::Vector &scores, const inference::Problem &problem,
                    const ExperimentData &data);

/// Columns of a study of models, and a model's values for them: seed, base parameters, effects.
/// `film`: thickness of the bank's film over the sample's; an instrument's micrometres do not grow
/// with a film. Packings have seeds that no bank has.
std::vector<std::string> model_columns(const BankSpec &spec);
std::vector<std::string> model_values(const BankSpec &spec, const RerunModel &model, int packing,
                                      double film);

/// Models worth running: always the base model; the leading effect unless the claim is none; with a
/// claimed effect its runner-up and, as placebo, the effect that the data speak against most.
/// `cells` as in diagnosed(). Empty if the experiment has no split or nothing held out can be
/// compared.
std::vector<RerunModel> models_to_rerun(const Experiment &experiment, const BankTable &table,
                                        const Diagnosed &diagnosed, double cells);

/// What was measured on the conditions of the data.
HeldOut held_out_of(const ExperimentData &data);

struct RerunOptions {
  StudyOptions study; ///< folder, program, jobs
  int packings = 4;
  double cells = 1.0; ///< of the bank's, that the measured sample is as large as
};

/// Runs them in the bank's cell and returns "shrink" of gap.json. Throws Failure as make_study.
nlohmann::ordered_json rerun(const Experiment &experiment, const BankTable &table,
                             const std::vector<RerunModel> &models, const RerunOptions &options);

// An experiment's label images beside the models that are run again.

/// A model's runs, one for each packing and held-out pressure, with their frames.
struct ModelRuns {
  std::string role;
  std::vector<SimulatedRun> runs;
};

/// True if the condition has a label image of before or after.
bool has_images(const Condition &condition);

/// True if its images can be set beside the runs: it is held out and goes to a pressure, as they
/// do.
bool has_images_beside(const Experiment &experiment, const Condition &condition);

/// "images" of gap.json's "shrink": a row for each observable of the held-out conditions' label
/// images, with the mean over each model's packings, and by how many of their common standard
/// deviations (image, packings, pressure) image and mean are apart. "without": what has no value,
/// and why. Throws Failure(2) as image_observables_of.
nlohmann::ordered_json images_beside(const Experiment &experiment,
                                     const std::vector<ModelRuns> &models);

} // namespace calendem

#endif
