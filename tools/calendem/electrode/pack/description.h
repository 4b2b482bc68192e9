// SPDX-License-Identifier: GPL-2.0-or-later
// electrode.json: what was made, whether it is what the recipe asks for, and what became of an
// existing structure: counts, masses and places, in against out.
#ifndef CALENDEM_ELECTRODE_PACK_DESCRIPTION_H
#define CALENDEM_ELECTRODE_PACK_DESCRIPTION_H

#include "electrode/pack/from_structure.h"
#include "electrode/pack/packing_state.h"
#include <nlohmann/json_fwd.hpp>

namespace calendem {

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
