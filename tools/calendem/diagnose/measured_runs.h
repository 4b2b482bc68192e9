// SPDX-License-Identifier: GPL-2.0-or-later
// Runs as a laboratory would report them: an experiment file with curves, each reading with its error.
#ifndef CALENDEM_DIAGNOSE_MEASURED_RUNS_H
#define CALENDEM_DIAGNOSE_MEASURED_RUNS_H

#include "compare/gap.h"
#include <cstdint>
#include <string>
#include <vector>

namespace calendem {

/// Standard deviations of the measurement.
struct MeasurementNoise {
  double pressure_percent = 1.0, displacement_um = 0.02, thickness_um = 0.05;
  double porosity_percent = 0.3, cracked_fraction = 0.03;
};

/// What the press shows beside the truth.
struct PressErrors {
  double pressure = 0.0;            ///< true over stated pressure, less 1
  double displacement_factor = 1.0; ///< of what the press shows
  double pressure_offset_MPa = 0.0; ///< shown above the true pressure
  double release_shift_um = 0.0;    ///< of displacements shown during the release
  double drift_um = 0.0;            ///< of displacements, from the first row of a curve to its last
};

/// What the press shows of one specimen at one pressure: a run for each packing. Their mean is reported.
using PressedSamples = std::vector<SimulatedRun>;

/// What is measured, and how.
struct MeasuredSpecimens {
  std::string id, recipe_file;
  std::vector<double> pressures;
  int packings = 1;                    ///< of one specimen, each as large as a cell
  double area = 0.0;                   ///< of one specimen [um2]
  int repeats = 1;                     ///< specimens at each pressure
  bool disc_for_each_pressure = false; ///< as on a press: no specimen is pressed twice
  MeasurementNoise noise;              ///< as stated
  double understated = 1.0;            ///< true over stated standard deviations
  PressErrors press;
};

/// Writes experiment.toml, a curve for each pressure and the recipe into `folder`, which is made.
/// `shown`: by pressures, of one repeat after the other. `seed`: of the noise.
void write_measured(const std::string &folder, const MeasuredSpecimens &specimens,
                    const std::vector<PressedSamples> &shown, std::uint64_t seed);

} // namespace calendem

#endif
