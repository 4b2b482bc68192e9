// SPDX-License-Identifier: GPL-2.0-or-later
// gap.json, which `compare` and `diagnose` write: one schema (docs/reference/gap.md), one writer.
// What a verb does not find out is null or an empty list.
#ifndef CALENDEM_BASE_GAP_FILE_H
#define CALENDEM_BASE_GAP_FILE_H

#include <nlohmann/json.hpp>
#include <string>

namespace calendem {

/// One place where simulation and experiment differ: a row of "where".
struct Place {
  std::string observable, stage, condition, unit;
  double residual = 0.0;    ///< simulation minus experiment [unit]
  double sd = 0.0;          ///< of the residual
  double z = 0.0;           ///< residual / sd; NaN: no standard deviation is known
  double share = 0.0;       ///< of the whole gap
  bool significant = false; ///< beyond the threshold that the whole table crosses by chance in 5 %
};

nlohmann::ordered_json to_json(const Place &place);

/// "p150, total porosity (relaxation): the simulation is 1.2 points too high (z = 4.8, 90 % of the
/// gap)." `model` is the subject.
std::string in_words(const nlohmann::ordered_json &place, const std::string &model);

/// A gap.json that holds `where` and nothing else. `threshold` is of |z|; `degrees_of_freedom` those
/// of the scatter between packings, negative where it is not known.
nlohmann::ordered_json new_gap(const std::string &experiment, nlohmann::ordered_json where,
                               double threshold, double degrees_of_freedom);

/// gap.json and gap.html.
void write_gap(const nlohmann::ordered_json &gap, const std::string &page,
               const std::string &folder);

} // namespace calendem

#endif
