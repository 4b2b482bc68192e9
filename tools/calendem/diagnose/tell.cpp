// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/tell.h"
#include <algorithm>

namespace calendem {
namespace {

using Json = nlohmann::ordered_json;

void tell_units(const ExperimentData &data, Json &gap) {
  Json &rows = gap["predictions"]["observables"];
  for (std::size_t k = 0; k < data.labels.size(); ++k) {
    rows[k]["name"] = data.labels[k].name;
    rows[k]["unit"] = data.labels[k].unit;
    rows[k]["pressure_MPa"] = data.labels[k].pressure;
  }
  for (Json &place : gap["where"])
    for (const Json &row : rows)
      if (row["observable"] == place["observable"] && row["stage"] == place["stage"] &&
          row["condition"] == place["condition"])
        place["unit"] = row["unit"];
}

/// The key's value at an amplitude; null where there is no amplitude.
Json value_at(const EffectParameter &p, const Json &amplitude) {
  return amplitude.is_number() ? Json(p.value(amplitude.get<double>())) : Json();
}

void tell_amplitudes(Json &gap) {
  for (Json &row : gap["fitted_effects"]) {
    const EffectParameter &p = find_effect(row["effect"]).parameter;
    row["keys"] = p.keys;
    row["off"] = p.off;
    row["value"] = value_at(p, row["mode"]);
    row["value_low90"] = value_at(p, row["low90"]);
    row["value_high90"] = value_at(p, row["high90"]);
    if (row["value_low90"] > row["value_high90"]) // a small value is a strong effect
      std::swap(row["value_low90"], row["value_high90"]);
  }
  if (gap["confounding"].contains("detection_limit"))
    for (Json &row : gap["confounding"]["detection_limit"]) {
      const EffectParameter &p = find_effect(row["effect"]).parameter;
      row["keys"] = p.keys;
      row["value"] = value_at(p, row["amplitude"]);
    }
}

void tell_prices(const BankTable &bank, Json &gap) {
  Json rows = Json::array();
  for (const MeasurementPrice &price : bank.spec.prices)
    if (price.unit.empty() || (price.name == kUnloadingCurve && !has_release(bank)))
      rows.push_back({{"what", price.what}, {"cost", price.hours}});
  gap["which"]["not_in_bank"] = rows;
  gap["which"]["cost_unit"] = "working hours";
}

} // namespace

void tell(const ExperimentData &data, const BankTable &bank, Json &gap) {
  tell_units(data, gap);
  tell_amplitudes(gap);
  tell_prices(bank, gap);
  gap["said"] = claim_in_words(gap);
}

} // namespace calendem
