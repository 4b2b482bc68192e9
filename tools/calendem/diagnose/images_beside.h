// SPDX-License-Identifier: GPL-2.0-or-later
// An experiment's label images beside the models that are run again.
#ifndef CALENDEM_DIAGNOSE_IMAGES_BESIDE_H
#define CALENDEM_DIAGNOSE_IMAGES_BESIDE_H

#include "diagnose/compare/gap.h"
#include <nlohmann/json.hpp>

namespace calendem {

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
