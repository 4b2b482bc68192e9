// SPDX-License-Identifier: GPL-2.0-or-later
// What is known of a parameter before the data, and the two scales the diagnosis works in.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_PRIOR_H
#define CALENDEM_DIAGNOSE_INFERENCE_PRIOR_H

#include <string>
#include <vector>

namespace calendem::inference {

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
  /// d value / d score, and d scaled(value) / d score.
  double value_slope(double score) const;
  double scaled_slope(double score) const;
  /// Per unit of the value, which counts as the bound beyond one.
  double density(double value) const;
  /// Largest value the prior reaches, for the scale of an amplitude: b, or a + 2 b.
  double upper() const;
};

struct Parameter {
  std::string name;
  Prior prior;
  /// Of an effect: at 0 (all its amplitudes 0) the effect is off. Others give it its shape.
  bool amplitude = false;
  /// Of an amplitude: what it does grows about as (value / upper)^power; 0: as ln(value / nothing),
  /// `nothing` being where it ceases.
  double power = 1.0;
  double nothing = 0.0;

  /// That, 1 at the upper end of the prior; emulators learn in it.
  double strength(double value) const;
  double strength_slope(double value) const; ///< d strength / d value
  /// What emulators see: the scaled value, or of an amplitude of another power than 1 its strength
  /// on the same scale.
  double input(double value) const;
  double input_slope(double score) const; ///< d input / d score
};

/// Throws Failure(2) if the bounds are in the wrong order, or a spread is not positive.
void check(const Parameter &parameter);

} // namespace calendem::inference

#endif
