// SPDX-License-Identifier: GPL-2.0-or-later
// Makes an electrode of a recipe: places, densifies and relaxes it by running LIGGGHTS, checks it.
#ifndef CALENDEM_ELECTRODE_PACK_PACK_H
#define CALENDEM_ELECTRODE_PACK_PACK_H

#include "base/recipe.h"
#include <string>

namespace calendem {

struct PackOptions {
  std::string folder;
  std::string liggghts;
  int ranks = 2;
};

/// Hash of everything that a packing depends on: recipe, its sources' files, packing_tools.
std::string packing_identity(const Recipe &recipe, const std::string &tools);
/// Program and script of it, as text.
std::string packing_tools(const std::string &liggghts);

/// Throws Failure: 2 bad recipe or folder, 3 the simulation failed, 4 the packing misses its
/// targets.
void pack_electrode(const Recipe &recipe, PackOptions options);

} // namespace calendem

#endif
