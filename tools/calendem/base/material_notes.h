// SPDX-License-Identifier: GPL-2.0-or-later
// What a user is told of an electrode's material: that a recipe is of another, that none of its
// values was fitted to films.
#ifndef CALENDEM_BASE_MATERIAL_NOTES_H
#define CALENDEM_BASE_MATERIAL_NOTES_H

#include "base/recipe.h"
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace calendem {

/// True densities of NMC111, 622 and 811 differ by less than 3 %.
bool are_of_one_density(double a, double b);

/// Both go by one name, whatever their values are: NMC111 and that of Xu et al.
bool share_a_name(const ReferenceMaterial &a, const ReferenceMaterial &b);

/// In what the recipe is not of its material: its density differs by more than 3 %, its name or its
/// file's is that of another known material. Empty: in nothing.
std::vector<std::string> other_material(const Recipe &recipe);

/// Throws Failure(2) where there is something: what is predicted would be another material's.
void stop_if_of_other_material(const Recipe &recipe);

/// Empty where it is calibrated.
std::string not_calibrated(const ReferenceMaterial &material);

/// Both, as sentences.
std::vector<std::string> notes_of(const Recipe &recipe);

/// What electrode.json says of its material and of the powder that the cell cannot hold: warnings of
/// whoever packs or presses it.
std::vector<std::string> warnings_of_electrode(const nlohmann::json &electrode);

/// In electrode.json: notes_of() its recipe.
constexpr const char *kMaterialNotes = "material_notes";
/// In electrode.json: the share of the powder's volume in wider particles than the cell can hold, and
/// the largest diameter that it can.
constexpr const char *kCutOff = "volume_fraction_cut_off_by_size_limit";
inline constexpr double kCutOffWarned = 0.2; ///< a larger share is a warning
constexpr const char *kLargestAllowed = "largest_equivalent_diameter_allowed_um";

} // namespace calendem

#endif
