// SPDX-License-Identifier: GPL-2.0-or-later
// What leaves for other programs: a moment of a run as a fragment of BPX (PyBaMM), as a data file of
// LAMMPS with its bonds, as voxels.
#ifndef CALENDEM_MEASURE_EXPORTS_H
#define CALENDEM_MEASURE_EXPORTS_H

#include "measure/run_directory.h"
#include "measure/structure.h"
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace calendem {

/// The moment of that name. Throws Failure(2) with those that the run has reached.
RunMoment moment_of_run(const std::string &folder, const std::string &name);

/// What BPX asks of an electrode's structure, all lengths in um. BPX knows the active material as
/// equal balls, whose surface per volume is 3 times its volume fraction over the radius.
struct ElectrodeOfBpx {
  double thickness = 0.0, porosity = 0.0, macro_porosity = 0.0;
  double transport_efficiency = 0.0; ///< D_eff/D through the thickness; CBD counts as solid
  double particle_radius = 0.0;      ///< of balls with the volume and surface of all bodies' balls
  double active_fraction = 0.0;      ///< volume of the lattice cells over that of the coating
};
/// Bodies as balls of N s^3. `voxel`: [um], for the transport efficiency.
ElectrodeOfBpx electrode_of_bpx(const SimulatedStructure &structure, double voxel);
/// BPX 0.4: "Positive electrode" with the five values of the structure; "User-defined" what BPX has
/// no name for. In m.
nlohmann::ordered_json bpx_fragment(const ElectrodeOfBpx &electrode, const std::string &title);

/// Masses [pg] by tag, as the electrode was packed.
std::map<long, double> masses_of_electrode(const std::string &folder);
/// atom_style bpm/sphere, units micro, periodic in x and y: bodies as molecules (CBD 0), bonds that are
/// intact. Diameters are those of the moment; densities keep each particle's mass. Throws Failure(2)
/// where the frames lack tags or a mass.
std::string lammps_data(const ParticleFrame &particles, const BondFrame &bonds, const Cell &cell,
                        const std::map<long, double> &mass, const std::string &title);
/// The frame of that moment; `electrode`: its folder, empty: that of the run's case.
std::string lammps_data_of_run(const std::string &folder, const RunMoment &moment,
                               const std::string &electrode);

/// Pores 0, AM 1, CBD 2.
LabelImage with_phases(const PhaseImage &image);
/// Pores 0, bodies from 1, CBD the number after the last body's.
LabelImage with_labels(const PhaseImage &image);

} // namespace calendem

#endif
