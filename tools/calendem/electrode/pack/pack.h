// SPDX-License-Identifier: GPL-2.0-or-later
// Makes an electrode: of a recipe or an existing structure what LIGGGHTS starts from, which is then
// densified and relaxed by running LIGGGHTS, and checked.
#ifndef CALENDEM_ELECTRODE_PACK_PACK_H
#define CALENDEM_ELECTRODE_PACK_PACK_H

#include "base/recipe.h"
#include "electrode/pack/from_structure.h"
#include "electrode/pack/packing_state.h"
#include <nlohmann/json.hpp>
#include <string>

namespace calendem {

struct PackOptions {
  std::string folder;
  std::string liggghts;
  int ranks = 2;
  bool force = false; ///< an electrode of another recipe may be overwritten
};

/// Hash of everything that a packing depends on: recipe, its sources' files, packing_tools.
std::string packing_identity(const Recipe &recipe, const std::string &tools);
/// Program and script of it, as text.
std::string packing_tools(const std::string &liggghts);

/// Throws Failure: 2 bad recipe or folder, 3 the simulation failed, 4 the packing misses its
/// targets.
void pack_electrode(const Recipe &recipe, PackOptions options);

struct BodiesToPack {
  BodiesOfStructure made; ///< places and ids are empty without a structure
  PlacementOfStructure placed;
  nlohmann::json shapes; ///< of a library, for electrode.json; null: generated
};

/// Makes them and writes start.data, bodies.map, electrode.in and what is known already of shapes
/// and structure into the folder.
BodiesToPack make_bodies_to_pack(const PackInput &input, const std::string &folder);

/// What describe() says of the recipe's own shapes and sizes gives way to the measured or given
/// ones.
void add_origin(nlohmann::json &electrode, const PackInput &input, const BodiesToPack &start,
                const std::vector<Pose> &poses);

} // namespace calendem

#endif
