// SPDX-License-Identifier: GPL-2.0-or-later
// What LIGGGHTS starts from: bodies and CBD at loose places, of a recipe or an existing structure.
#ifndef CALENDEM_ELECTRODE_PACK_START_H
#define CALENDEM_ELECTRODE_PACK_START_H

#include "electrode/pack/given_placement.h"
#include "electrode/pack/given_recipe.h"
#include "electrode/pack/pose.h"
#include <nlohmann/json.hpp>

namespace calendem {

struct Start {
  GivenBodies made; ///< places and ids are empty without a structure
  GivenPlacement placed;
  nlohmann::json shapes; ///< of a library, for electrode.json; null: generated
};

/// Makes them and writes start.data, bodies.map, electrode.in and what is known already of shapes
/// and structure into the folder.
Start make_start(const PackInput &input, const std::string &folder);

/// What describe() says of the recipe's own shapes and sizes gives way to the measured or given
/// ones.
void add_origin(nlohmann::json &electrode, const PackInput &input, const Start &start,
                const std::vector<Pose> &poses);

} // namespace calendem

#endif
