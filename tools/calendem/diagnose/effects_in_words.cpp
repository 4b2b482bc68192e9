// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/effects_in_words.h"
#include "base/shown.h"
#include "compare/gap.h"
#include "diagnose/diagnose.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

using Json = nlohmann::ordered_json;

std::string keys_of(const Json &row) {
  return fmt::format("{}", fmt::join(row["keys"].get<std::vector<std::string>>(), ", "));
}

namespace {

/// Values of a row, with the same decimals; a dash where there is no number.
std::vector<std::string> shown_together(const Json &row, const std::vector<const char *> &names) {
  std::vector<double> numbers;
  for (const char *name : names)
    numbers.push_back(row[name].is_number() ? row[name].get<double>() : std::nan(""));
  return shown_alike(numbers);
}

} // namespace

std::string setting_of(const Json &row) {
  const auto text = shown_together(row, {"value", "value_low95", "value_high95"});
  return fmt::format("{} = {} (95 %: {} to {})", keys_of(row), text[0], text[1], text[2]);
}

namespace {

void add_units(const ExperimentData &data, Json &gap) {
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
  const bool known = amplitude.is_number() && std::isfinite(amplitude.get<double>());
  return known ? Json(p.value(amplitude.get<double>())) : Json();
}

bool is_poor(const Json &gap, const std::string &effect, double &error, int &runs) {
  for (const Json &row : gap["emulators"])
    if (row["effect"] == effect && row["poor"] == true) {
      error = row["error"];
      runs = row["runs"];
      return true;
    }
  return false;
}

/// What may be said of one effect on these data.
std::string said_of(const Json &gap, const Json &row) {
  const std::string name = row["effect"], keys = keys_of(row);
  double error = 0.0;
  int runs = 0;
  if (is_poor(gap, name, error, runs))
    return fmt::format(
        "{}: cannot be named: after {} runs its emulators are off by {:.2g} standard "
        "deviations of these data, 1 is allowed; about {:.0f} runs are needed, as "
        "errors fall with the root of their number. Its range is as uncertain",
        name, runs, error, std::ceil(error * error * runs));
  if (row["inclusion"].get<double>() >= 0.5)
    return fmt::format("{}: {}", name, setting_of(row));
  if (row["limited"] != true)
    return fmt::format("{}: not limited", name);
  if (row["two_sided"] == true) {
    const auto text = shown_together(row, {"value_low95", "value_high95"});
    return fmt::format("{}: {} between {} and {} (95 %)", name, keys, text[0], text[1]);
  }
  return fmt::format("{}: {} {} {} (95 %)", name, keys,
                     row["weak_is_large"] == true ? "above" : "below",
                     shown(row["value_limit95"], "{:.2g}"));
}

void add_ranges(Json &gap) {
  for (Json &row : gap["which"]["effects"]) {
    const EffectParameter &p = find_effect(row["effect"]).parameter;
    row["keys"] = p.keys;
    row["value"] = value_at(p, row["amplitude"]);
    row["value_low95"] = value_at(p, row["low95"]);
    row["value_high95"] = value_at(p, row["high95"]);
    row["value_limit95"] = value_at(p, row["below95"]);
    row["weak_is_large"] = row["value_low95"] > row["value_high95"];
    if (row["weak_is_large"] == true)
      std::swap(row["value_low95"], row["value_high95"]);
    row["said"] = said_of(gap, row);
  }
}

void add_amplitudes(Json &gap) {
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

void add_prices(const BankTable &bank, Json &gap) {
  Json rows = Json::array();
  for (const MeasurementPrice &price : bank.spec.prices)
    if ((price.unit.empty() && !find_pressing(bank.spec, price.name)) ||
        (price.name == kUnloadingCurve && !has_release(bank)))
      rows.push_back({{"what", price.what}, {"cost", price.hours}});
  gap["which"]["not_in_bank"] = rows;
  gap["which"]["cost_unit"] = "working hours";
}

} // namespace

void put_in_words(const ExperimentData &data, const BankTable &bank, Json &gap) {
  add_units(data, gap);
  add_amplitudes(gap);
  add_ranges(gap);
  add_prices(bank, gap);
  gap["which"].update(claim_in_words(gap));
  for (const Json &place : gap["where"])
    if (place["significant"] == true)
      gap["said"].push_back(in_words(place, "the recalibrated base model"));
}

} // namespace calendem
