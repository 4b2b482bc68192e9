// SPDX-License-Identifier: GPL-2.0-or-later
// The files of an electrode: electrode.data, bodies.map, electrode.in (for scripts), bodies.csv and
// a picture for ParaView.
#ifndef CALENDEM_ELECTRODE_PACK_ELECTRODE_FILES_H
#define CALENDEM_ELECTRODE_PACK_ELECTRODE_FILES_H

#include "electrode/pack/packing_state.h"
#include <string>

namespace calendem {

/// LIGGGHTS data file, atom_style granular, 4 atom types; box z from 0 to `height`.
std::string data_file(const Recipe &recipe, const std::vector<Particle> &particles, double height,
                      const std::string &heading = "Electrode made by calendem pack");
std::string body_map(const std::vector<Particle> &particles);
/// Variables that the input scripts include.
std::string script_variables(const Recipe &recipe, double thickness);
/// One row per body; centre and orientation as they are after the packing.
std::string bodies_table(const std::vector<Body> &bodies, const std::vector<Pose> &poses,
                         const PackingState &state);
/// VTK polydata (text): points with id, type, body, radius.
std::string picture_file(const std::vector<Particle> &particles);

/// Takes positions from a LIGGGHTS dump with columns id x y z; throws Failure(3) if any is
/// missing or there twice.
void read_positions(const std::string &dump, std::vector<Particle> &particles);

} // namespace calendem

#endif
