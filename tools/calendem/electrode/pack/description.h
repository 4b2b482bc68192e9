// SPDX-License-Identifier: GPL-2.0-or-later
// electrode.json: what was made, and whether it is what the recipe asks for.
#ifndef CALENDEM_ELECTRODE_PACK_DESCRIPTION_H
#define CALENDEM_ELECTRODE_PACK_DESCRIPTION_H

#include "electrode/pack/packing_state.h"
#include "electrode/pack/pose.h"
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

} // namespace calendem

#endif
