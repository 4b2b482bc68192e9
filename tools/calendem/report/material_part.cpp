// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "base/material.h"
#include "base/recipe.h"
#include "base/run_folder.h"
#include "report/tables.h"
#include <fmt/format.h>

namespace calendem::report {
namespace {

using nlohmann::json;

/// A row: the value, and where it comes from.
json value_row(const Key &key, const std::string &value, const ReferenceMaterial &m,
               const std::string &elsewhere) {
  const auto at = m.values.find(key.name);
  const bool of_material = at != m.values.end() && at->second.text == value;
  const std::string sd =
      of_material && at->second.sd > 0.0 ? fmt::format(" ± {:g}", at->second.sd) : "";
  return {{"name", key.name},
          {"text", value + sd},
          {"unit", key.unit},
          {"source", of_material ? at->second.source
                     : !key.fallback.empty() && !wants_text(key) &&
                             std::stod(key.fallback) == std::stod(value)
                         ? "the program's default"
                         : elsewhere}};
}

void add_rows(const std::vector<Key> &keys, bool of_recipe,
              const std::map<std::string, std::string> &values, const ReferenceMaterial &m,
              json &rows) {
  for (const Key &key : keys) {
    const auto at = values.find(key.name);
    const bool off = key.name.rfind("effects.", 0) == 0 && m.values.count(key.name) == 0 &&
                     at != values.end() && at->second == key.fallback;
    if (describes_material(key, of_recipe) && at != values.end() && !off)
      rows.push_back(value_row(key, at->second, m, of_recipe ? "the recipe" : "the case"));
  }
}

} // namespace

json material_table(const Run &run) {
  const ReferenceMaterial m = material_of_electrode(run.directory);
  RunFolder folder(run.directory);
  if (!m.given() || !folder.has("case.toml"))
    return nullptr;
  json rows = json::array();
  add_rows(recipe_keys(), true, run.electrode.value("recipe", std::map<std::string, std::string>()),
           m, rows);
  try {
    add_rows(case_keys(), false, folder.settings().all(), m, rows);
  } catch (const Failure &) { // of another version; its values are not known
    return nullptr;
  }
  return {{"name", m.name},
          {"status", m.calibrated()
                         ? fmt::format("calibrated on: {}", fmt::join(m.calibrated_on, "; "))
                         : std::string("not calibrated")},
          {"rows", rows}};
}

} // namespace calendem::report
