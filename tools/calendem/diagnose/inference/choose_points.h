// SPDX-License-Identifier: GPL-2.0-or-later
// Which runs a bank should get next: those that tell most about the effects.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_CHOOSE_POINTS_H
#define CALENDEM_DIAGNOSE_INFERENCE_CHOOSE_POINTS_H

#include "diagnose/inference/model.h"
#include <cstdint>
#include <string>
#include <vector>

namespace calendem::inference {

/// A point of an effect that could be run beside a base run of the same packing and parameters.
struct PossiblePoint {
  int effect = 0;          ///< place in the bank
  int beside = 0;          ///< number of the base run: no effect gets two points beside one
  Vector base, amplitudes; ///< values
  std::string packing;
};

struct ChosenPoint {
  int place = 0;     ///< in the list of what could be run
  double gain = 0.0; ///< bits, of its effect
};

/// `count` of the possible points (fewer, if there are not as many), each the one that gains most
/// after those before it. The information on an effect is the mean, over its prior and that of the
/// base model, of log2(1 + S/N^2) / 2. S/N^2 is the sum, over features, of the effect's square over
/// the variance of the data (with the scatter that the effect adds), of the base emulator and of the
/// effect's: features count as independent, base parameters as known, and the processes keep their
/// lengths and variances. A run lowers the last variance by what the Gaussian process of each
/// feature says, and the expected square of the mean rises by as much.
std::vector<ChosenPoint> choose_points(const Model &model, const Bank &bank,
                                       const std::vector<PossiblePoint> &possible, int count);

/// Gain of all of these points together; by effect.
std::vector<double> information_gain(const Model &model, const Bank &bank,
                                     const std::vector<PossiblePoint> &points);

} // namespace calendem::inference

#endif
