// SPDX-License-Identifier: GPL-2.0-or-later
// What an electrode is made of: a file of the keys of recipe and case that describe a material, each
// with its source. Its values stand between the keys' fallbacks and what recipe and case give. An
// electrode keeps them in electrode.json, so that they outlast a change of the file.
#ifndef CALENDEM_BASE_MATERIAL_H
#define CALENDEM_BASE_MATERIAL_H

#include "base/toml_reader.h"
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace calendem {

struct MaterialValue {
  std::string text;   ///< in the key's unit, as Settings hold it
  std::string source; ///< a publication, or what it was calibrated on
  double sd = 0.0;    ///< standard deviation; 0: not stated
};

struct ReferenceMaterial {
  std::string name;
  std::vector<std::string> also_called;
  std::vector<std::string> calibrated_on; ///< measurements that its values were fitted to
  std::map<std::string, MaterialValue> values;

  bool given() const { return !name.empty(); }
  bool calibrated() const { return !calibrated_on.empty(); }
  /// Changes with any value and any source.
  std::string hash() const;
};

/// Whether a material can say it: a phase, the bonds, an effect of contacts and bonds, or the recipe's
/// densities, grains and nanopores. Not what a press, a dryer or a cell is.
bool describes_material(const Key &key, bool of_recipe);

/// Names of the files in the installation's input_scripts/materials, sorted.
std::vector<std::string> known_materials();

/// `given` by a recipe: a known name, or a path relative to the recipe's `file`.
std::string material_path(const std::string &given, const std::string &file);

/// With the values of its base. Throws Failure(2) with every mistake of the file.
ReferenceMaterial read_material(const std::string &file);

/// Sets those of `keys` that the material has and that the settings' file does not give.
void take_values(const ReferenceMaterial &material, const std::vector<Key> &keys,
                 Settings &settings);

nlohmann::ordered_json to_json(const ReferenceMaterial &material);
/// The electrode's in this folder; not given where electrode.json is missing or of an older version.
ReferenceMaterial material_of_electrode(const std::string &folder);

} // namespace calendem

#endif
