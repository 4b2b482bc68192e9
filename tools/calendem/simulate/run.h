// SPDX-License-Identifier: GPL-2.0-or-later
// One compression and relaxation: checks, starts LIGGGHTS on in.calendering, follows it, collects.
#ifndef CALENDEM_SIMULATE_RUN_H
#define CALENDEM_SIMULATE_RUN_H

#include "base/toml_reader.h"
#include "physics/inertial_number.h"
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace calendem {

struct RunOptions {
  std::string folder;
  std::string liggghts;
  int ranks = 2;
  bool resume = false;
  bool force = false; ///< overwrite a run of another case or an unfinished one
};

/// All that a run depends on, but for its electrode's file: settings and run_tools; as text.
std::string run_identity(const Settings &settings, const std::string &tools);
/// Program and scripts of it, as text.
std::string run_tools(const std::string &liggghts);

/// What was computed is collected and kept however the run ends, marked in summary.json
/// ("finished", "stopped_because", "failed_checks"). Throws Failure: 2 bad input, 3 the simulation
/// failed, 4 a check did not hold.
void run_case(const Settings &settings, RunOptions options);

/// The electrode that a case names.
struct ElectrodeFacts {
  double thickness = 0.0; ///< um
  double area = 0.0;      ///< um2
  double solid = 0.0;     ///< AM envelopes + solid carbon and binder [um3]
  double cbd_envelope = 0.0;
  double am = 0.0;
  double lx = 0.0, ly = 0.0;
  double lattice = 0.0;
  double nanoporosity = 0.0; ///< of CBD, as packed; 0: not known
  double widest = 0.0;       ///< largest diameter of a primary or a CBD sphere [um]
  MeanSphere primary;        ///< of the active material; from the atoms, as `atoms` is
  long bonds = 0, atoms = 0, bodies = 0, primaries = 0;

  /// In a cell that is longer along x by a fraction.
  ElectrodeFacts elongated(double by) const {
    ElectrodeFacts e = *this;
    e.lx *= 1.0 + by;
    e.area *= 1.0 + by;
    return e;
  }
};

/// From electrode.json; the atoms are not in it. Throws std::exception where a field is missing.
ElectrodeFacts describe_electrode(const nlohmann::json &electrode);

/// Throws Failure(2) if a file is missing or cut.
ElectrodeFacts read_electrode(const std::string &folder);

} // namespace calendem

#endif
