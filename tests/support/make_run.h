// SPDX-License-Identifier: GPL-2.0-or-later
// A made-up run directory in the true format (curve.csv, summary.json, breaks.csv, bodies.csv,
// electrode.json, case.toml, vtk/*.pvd with frames), for tests of what reads such directories.
// Nothing in it is physics: the film is squeezed by an affine map and bonds break at random.
#ifndef CALENDEM_TESTS_MAKE_RUN_H
#define CALENDEM_TESTS_MAKE_RUN_H

#include <filesystem>

namespace calendem::tests {

struct MadeRun {
  double max_pressure_MPa = 150;
  double broken_at_max = 0.2; ///< of the bonds
  double cell_um = 15;
  int bodies = 30;
  int rows = 240;
  bool finished = true; ///< false: stops in compression, without summary.json
  bool frames = true;
};

/// Writes the run into `directory` (made if missing). Same options, same bytes.
void make_run(const std::filesystem::path &directory, const MadeRun &options = {});

} // namespace calendem::tests

#endif
