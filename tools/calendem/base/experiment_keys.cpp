// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/experiment_keys.h"
#include <fmt/format.h>

namespace calendem {

const std::vector<Key> &head_keys() {
  static const std::vector<Key> keys = {
      {"name", "", "", 0, 0, "", "a name for reports", "", true},
      {"electrode", "", "", 0, 0, "", "recipe of the electrode before calendering", "", true},
      {"sample_diameter_mm", "", "0", 1e-3, 1000, "mm", "of the punched disc"},
      {"foil_thickness_um", "", "0", 1, 100, "um", "of the current collector"},
      {"foil_density_g_cm3", "", "0", 0.5, 20, "g/cm3", "aluminium 2.70, copper 8.96"},
      {"labels_pore", "", "0", -1e9, 1e9, "", "label of pores in the label images", "", false,
       true},
      {"labels_cbd", "", "-", -1e9, 1e9, "", "label of CBD in them; without: all is AM", "", false,
       true},
      {"labels_voxel_um", "", "0", 1e-3, 10, "um", "their voxel size, if not as they state"},
  };
  return keys;
}

const std::vector<Key> &condition_keys() {
  static const std::vector<Key> keys = {
      {"id", "", "", 0, 0, "", "name of the condition, as in split", "", true},
      {"control", "", "", 0, 0, "", "what the calender was set to",
       "pressure|displacement|thickness|roll_gap"},
      {"curve", "", "-", 0, 0, "",
       "CSV: displacement_um,pressure_MPa[,stage]; stage: loading, dwell, unloading", "", true},
      {"labels_before", "", "-", 0, 0, "",
       "label image before calendering, z from the collector up", "", true},
      {"labels_after", "", "-", 0, 0, "", "label image after calendering", "", true},
      {"dwell_s", "", "0", 0, 1e6, "s", "time at the target"},
      {"curve_sd_um", "", "0", 0, 100, "um", "of the curve's displacements, independent"},
  };
  return keys;
}

const std::vector<Quantity> &quantities() {
  static const std::vector<Quantity> list = {
      {{"roll_gap_um", "", "-", 0, 1000, "um", "between the rolls"}, &Condition::roll_gap_um},
      {{"displacement_um", "", "-", 0.01, 1000, "um", "of the platen, from first touch"},
       &Condition::displacement_um},
      {{"thickness_at_max_um", "", "-", 1, 1000, "um", "of the loaded coating, without foil"},
       &Condition::thickness_at_max_um},
      {{"max_pressure_MPa", "", "-", 0.1, 2000, "MPa", "at the maximum"},
       &Condition::max_pressure_MPa},
      {{"loading_mg_cm2", "", "-", 0.5, 100, "mg/cm2", "of this sample, without foil"},
       &Condition::loading_mg_cm2},
      {{"porosity_before_percent", "", "-", 1, 90, "%", "total, of this sample, not pressed yet"},
       &Condition::porosity_before_percent},
      {{"porosity_after_percent", "", "-", 1, 90, "%", "total, after calendering"},
       &Condition::porosity_after_percent},
      {{"thickness_after_um", "", "-", 1, 1000, "um", "after calendering"},
       &Condition::thickness_after_um},
      {{"mass_mg", "", "-", 0.01, 1e5, "mg", "of the sample"}, &Condition::mass_mg},
      {{"cracked_bodies_fraction", "", "-", 0, 1, "fraction", "of secondary particles"},
       &Condition::cracked_bodies_fraction},
  };
  return list;
}

std::string list_of_experiment_keys() {
  std::string text = "Keys of an experiment file: name, unit, range, meaning\n";
  const auto rows = [&](const char *table, const std::vector<Key> &keys) {
    text += fmt::format(" {}\n", table);
    for (const Key &k : keys)
      text += fmt::format("  {:<26} {:<8} {:<14} {}\n", k.name, k.unit,
                          k.text || !k.choices.empty() ? "text"
                                                       : fmt::format("{:g}..{:g}", k.low, k.high),
                          k.choices.empty() ? k.meaning : k.choices);
  };
  rows("[experiment]", head_keys());
  text += "  split                                      { train = [ids], test = [ids] }\n";
  rows("[[condition]]", condition_keys());
  std::vector<Key> measured;
  for (const Quantity &q : quantities())
    measured.push_back(q.key);
  rows(
      "[[condition]], a number or { value, sd } or { value, sd_relative }; mass and thickness also "
      "includes_foil (default: a mass does, a thickness does not)",
      measured);
  return text;
}

} // namespace calendem
