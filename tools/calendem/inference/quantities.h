// SPDX-License-Identifier: GPL-2.0-or-later
// What the inference reasons about: observables, each with its place in the process; parameters and
// what is known of them before the data; the two scales of both.
#ifndef CALENDEM_INFERENCE_QUANTITIES_H
#define CALENDEM_INFERENCE_QUANTITIES_H

#include "inference/numerics.h"
#include <string>
#include <vector>

namespace calendem::inference {

/// One number. A curve is several that differ in `coordinate` only.
struct ObservableId {
  std::string name;        ///< with its unit, as in curve.csv
  std::string stage;       ///< compression, dwell, relaxation, ...
  std::string condition;   ///< id of the experiment's condition
  double coordinate = 0.0; ///< of a point of a curve, scaled to 0-1 over the curve
};

/// The observables of one name, stage and condition: a scalar or a curve.
struct Block {
  std::string name, stage, condition;
  std::vector<int> members; ///< places in the list, in its order
};

/// In the order of first appearance.
std::vector<Block> blocks_of(const std::vector<ObservableId> &all);

/// A parameter is the image of a standard normal *score*: inference sees scores only, whose prior
/// is the same for all. Emulators see the *scaled* value, -1 to 1 over the prior's range.
struct Prior {
  enum Kind { normal, uniform, log_uniform };
  Kind kind = uniform;
  double a = 0.0; ///< mean, or lower bound; in the parameter's unit
  double b = 1.0; ///< standard deviation, or upper bound; in the parameter's unit

  double value(double score) const;
  double score(double value) const;
  /// -1 at the lower bound (mean - 2 sd), 1 at the upper (mean + 2 sd).
  double scaled(double value) const;
  /// Per unit of the value, which counts as the bound beyond one.
  double density(double value) const;
  /// Largest value the prior reaches, for the scale of an amplitude: b, or a + 2 b.
  double upper() const;
};

struct Parameter {
  std::string name;
  Prior prior;
  /// An effect's strength: at 0 (all its amplitudes 0) the effect is off. Others give it its shape.
  bool amplitude = false;
  /// What an amplitude does grows about as (value / upper)^power; 0: as ln(value / nothing),
  /// `nothing` being where it ceases.
  double power = 1.0;
  double nothing = 0.0;

  /// What an amplitude does, 1 at the upper end of the prior; emulators learn in it.
  double strength(double value) const;
  /// What emulators see: the scaled value, or of an amplitude of another power than 1 its strength
  /// on the same scale.
  double input(double value) const;
};

/// Throws Failure(2) if the bounds are in the wrong order, or a spread is not positive.
void check(const Parameter &parameter);

/// Quantiles of weighted draws.
struct CredibleRange {
  double median = 0.0, low90 = 0.0, high90 = 0.0;
};
CredibleRange credible_range(const std::vector<double> &values, const std::vector<double> &weights);

} // namespace calendem::inference

#endif
