// SPDX-License-Identifier: GPL-2.0-or-later
// What became of an existing structure: counts, masses and places, in against out.
#ifndef CALENDEM_ELECTRODE_PACK_GIVEN_DESCRIPTION_H
#define CALENDEM_ELECTRODE_PACK_GIVEN_DESCRIPTION_H

#include "electrode/pack/given_placement.h"
#include "electrode/pack/pose.h"
#include <nlohmann/json_fwd.hpp>

namespace calendem {

/// "structure" of electrode.json.
nlohmann::json describe_structure(const Recipe &recipe, const GivenStructure &structure,
                                  const GivenBodies &given, const GivenPlacement &placed,
                                  const std::vector<Pose> &poses,
                                  const std::vector<Particle> &particles);

/// structure.csv: one row per particle of the structure, with the body and the tag it became.
std::string structure_table(const GivenStructure &structure, const GivenBodies &given);

/// Throws Failure(4) unless every particle came through once and each phase has its mass: AM to
/// half a primary, CBD to rounding. `described` is made by describe_structure().
void check_kept(const nlohmann::json &described, const std::string &folder);

} // namespace calendem

#endif
