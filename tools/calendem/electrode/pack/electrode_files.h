// SPDX-License-Identifier: GPL-2.0-or-later
// The files of an electrode: electrode.data, bodies.map, electrode.in (for scripts), bodies.csv, a
// picture for ParaView, and electrode.json with the checks against the recipe.
#ifndef CALENDEM_ELECTRODE_PACK_ELECTRODE_FILES_H
#define CALENDEM_ELECTRODE_PACK_ELECTRODE_FILES_H

#include "electrode/pack/from_structure.h"
#include "electrode/pack/packing_state.h"
#include <nlohmann/json_fwd.hpp>
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

// electrode.json: what was made, whether it is what the recipe asks for, and what became of an
// existing structure: counts, masses and places, in against out.

/// The last row of packing.csv, and of other tables with its columns: step, gap, pressure, kinetic.
struct LastRow {
  double gap_um = 0.0, pressure_MPa = 0.0, kinetic_fJ = 0.0;
};
LastRow last_row(const std::string &file);

struct FinishedPacking {
  const Recipe &recipe;
  const std::vector<Body> &bodies;
  const std::vector<Particle> &particles;
  const std::vector<Pose> &poses;
  const PackingState &state;
  LastRow end;
};

nlohmann::json describe(const FinishedPacking &packing);

/// Throws Failure(4) with every target that `electrode`, made by describe(), misses.
void check_targets(const nlohmann::json &electrode, const Recipe &recipe,
                   const std::string &folder);

/// "structure" of electrode.json.
nlohmann::json describe_structure(const Recipe &recipe, const ExistingStructure &structure,
                                  const BodiesOfStructure &given,
                                  const PlacementOfStructure &placed,
                                  const std::vector<Pose> &poses,
                                  const std::vector<Particle> &particles);

/// structure.csv: one row per particle of the structure, with the body and the tag it became.
std::string structure_table(const ExistingStructure &structure, const BodiesOfStructure &given);

/// Throws Failure(4) unless every particle came through once and each phase has its mass: AM to
/// half a primary, CBD to rounding. `described` is made by describe_structure().
void check_kept(const nlohmann::json &described, const std::string &folder);

} // namespace calendem

#endif
