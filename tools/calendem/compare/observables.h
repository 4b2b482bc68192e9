// SPDX-License-Identifier: GPL-2.0-or-later
// The observables of an experiment file and what a run gives for each. A new one is one function.
#ifndef CALENDEM_COMPARE_OBSERVABLES_H
#define CALENDEM_COMPARE_OBSERVABLES_H

#include "compare/gap.h"
#include "measure/phases.h"
#include <functional>

namespace calendem {

/// Change of a simulated value.
using Derivative = std::function<double(const SimulatedRun &)>;

/// What both have, before statistics.
struct Observable {
  std::string name, stage, unit;
  double measured = 0.0, sd = 0.0;
  std::function<double(const SimulatedRun &)> simulated;
  /// Change of the simulated value per MPa of the condition's pressure, 0 where it does not matter.
  std::function<double(const SimulatedRun &)> slope;
  std::string curve = {};  ///< of a point of a curve: the curve's name
  double coordinate = 0.0; ///< of a point: its place on the curve, 0-1
  double pressure = 0.0;   ///< of a point [MPa]
  /// Change of the measured value by one standard deviation of the sample's loading: the same error
  /// in all of a condition. Not in `sd`.
  double by_loading = 0.0;
  /// Why a run has no value; empty function: it needs no reason.
  std::function<std::string(const SimulatedRun &)> why_none = {};
  /// Change of the simulated value per unit of porosity under pressure, and of that before it: the
  /// solid stays. Empty: none.
  Derivative per_porosity = {}, per_initial_porosity = {};
  /// Change by one standard deviation of the instrument's drift: the same in all of a curve.
  double by_drift = 0.0;
  /// Change by one standard deviation of the first touch: the same in all of a curve.
  double by_zero = 0.0;
};

/// Stage of what is seen of a sample that is not pressed yet: of its recipe, not of the model.
inline constexpr char kBefore[] = "before";
/// Stage of what is seen while the platen rests: the same in any film.
inline constexpr char kDwell[] = "dwell";

/// All of one condition. What a value needs and lacks is reported in `not_said`.
std::vector<Observable> observables_of(const Experiment &experiment, const Condition &condition,
                                       std::vector<std::string> &not_said);

/// The platen goes to the condition's pressure; a roll gap counts by the pressure it was converted
/// into.
bool by_pressure(const Condition &condition);

enum class Branch { Loading, Release };

/// The points at which a branch of a curve to `largest` MPa is compared, without measured values.
std::vector<Observable> points_of_curve(const Experiment &experiment, const Condition &condition,
                                        double largest, Branch branch);

/// True if the run's platen did what the condition says, within 2 %.
bool belongs(const SimulatedRun &run, const Condition &condition);

// What an experiment's label images show, beside the frames of a run, cut into voxels of the same
// size and measured by the same code.

/// Measures of an image, or of the part [i0, i1) x [j0, j1) of its columns of voxels. Shares of the
/// volume 0-1.
struct ImageMeasures {
  double am = 0.0, pore = 0.0;
  double upper_minus_lower = 0.0;   ///< share of AM, upper third minus lower third
  double middle_minus_others = 0.0; ///< middle third minus the mean of the others
};
ImageMeasures measures_of(const PhaseImage &image);
ImageMeasures measures_of(const PhaseImage &image, int i0, int i1, int j0, int j1);

/// Before and after calendering, as far as the condition has images: share of AM or, where CBD is
/// labelled, macro porosity; two numbers for the profile of AM through the thickness; the share of
/// whole particles that are in pieces. Standard deviations: of the mean of the image's four
/// quarters (x, y), and binomial for the particles.
/// The frames of a run are read when an observable is asked for its value; one without frames has
/// none. Throws Failure(2) as read_label_image does, and for images too small to be measured.
std::vector<Observable> image_observables_of(const Experiment &experiment,
                                             const Condition &condition,
                                             std::vector<std::string> &not_said);

} // namespace calendem

#endif
