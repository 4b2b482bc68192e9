// SPDX-License-Identifier: GPL-2.0-or-later
// The paper's experiment and what a run of it gives.
#ifndef CALENDEM_TESTS_UNIT_COMPARE_PRESSED_H
#define CALENDEM_TESTS_UNIT_COMPARE_PRESSED_H

#include "compare/gap.h"
#include <string>

namespace calendem {

inline Experiment paper() { return read_experiment(CALENDEM_CASES "/paper/experiment.toml"); }

/// To a pressure [MPa], with that porosity after the release, on a packing of that hash.
inline SimulatedRun pressed_to(double pressure, double porosity, const std::string &packing) {
  static int runs = 0;
  SimulatedRun r;
  r.folder = "run_" + std::to_string(++runs); // every run has its own, also of one packing
  r.control = "pressure";
  r.target = r.max_pressure = pressure;
  r.porosity_after = porosity;
  r.porosity_at_max = porosity - 0.05;
  r.solid_column = 40.0;
  r.thickness_at_max = r.solid_column / (1.0 - r.porosity_at_max);
  r.thickness_after = r.solid_column / (1.0 - porosity);
  r.pressure = {0.0, 0.5 * pressure, pressure};
  r.displacement = {0.0, 20.0, 24.0};
  r.electrode_hash = packing;
  return r;
}

} // namespace calendem

#endif
