// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/gap_file.h"
#include "diagnose/compare/gap_page.h"
#include "diagnose/diagnose.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kListed = 5; // of a list of explanations

struct Words {
  std::string headline, meaning;
  std::vector<std::string> next;
};

/// "effects.x.y = 0.3 (0.2 to 0.4)"
std::string setting_of(const Json &fitted) {
  return fmt::format("{} = {} (90 %: {} to {})",
                     fmt::join(fitted["keys"].get<std::vector<std::string>>(), ", "),
                     shown(fitted["value"], "{:.3g}"), shown(fitted["value_low90"], "{:.3g}"),
                     shown(fitted["value_high90"], "{:.3g}"));
}

/// The measurement that is worth most, if it is worth anything.
std::string measurement_of(const Json &which) {
  const Json &best = which["next_measurement"];
  if (!best.contains("now") ||
      best["expected_probability"].get<double>() < best["now"].get<double>() + 0.01)
    return "No measurement that the bank can predict would improve the diagnosis; see the list of "
           "those it cannot predict.";
  return fmt::format("Measure: {}. The right hypothesis would then have a probability of {:.0f} % "
                     "on average, instead of {:.0f} %.",
                     best["what"].get<std::string>(),
                     100.0 * best["expected_probability"].get<double>(),
                     100.0 * best["now"].get<double>());
}

std::string place_of_unknown(const Json &gap) {
  for (const Json &row : gap["which"]["evidence"])
    if (row["hypothesis"] == "unknown" && row.value("place", "") != "")
      return row["place"];
  return "everywhere";
}

/// Where it is, or what it acts like.
std::string about_unknown(const Json &gap) {
  const std::string place = place_of_unknown(gap), like = "like ";
  return place.rfind(like, 0) == 0 ? fmt::format("It acts most like {0}, but {0} does not fit.",
                                                 place.substr(like.size()))
                                   : fmt::format("The discrepancy is most likely in: {}.", place);
}

Words none() {
  return {"No gap beyond noise: the base model suffices",
          "With its parameters recalibrated the base model fits all that was measured.",
          {"Use the recalibrated parameters below.",
           "Effects below their detection limits, listed below, are not excluded."}};
}

Words noise() {
  return {
      "The errors of the measurement are understated",
      "The base model would fit if the measured values scattered more than is stated. No "
      "effect is needed, and none is excluded: with few things measured an effect that the bank "
      "lacks looks the same.",
      {"Measure again on other samples and state the scatter that you find.",
       "Look for a sample or a reading that stands out: see where."}};
}

Words unknown(const Json &gap) {
  return {"A gap that no known effect explains",
          "Neither the base model nor any effect of the bank fits. " + about_unknown(gap),
          {"Do not recalibrate it away: parameters fitted now would carry it.",
           "Check the readings there first, then look for physics that the table of "
           "effects lacks (calendem effects)."}};
}

/// The most probable ones of a list; the others are counted.
std::string leading(const std::vector<std::string> &names) {
  const std::size_t listed = std::min(names.size(), kListed);
  std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + listed, "; "));
  return listed < names.size() ? text + fmt::format("; {} more", names.size() - listed) : text;
}

Words undecided(const Json &gap) {
  const Json &where = gap["where"];
  const bool any = std::any_of(where.begin(), where.end(),
                               [](const Json &row) { return row["significant"] == true; });
  return {"Undecided: the data do not distinguish between the explanations",
          fmt::format("{}With 95 % it is one of these, the most probable first: {}.",
                      any ? ""
                          : "No difference is significant, but weak effects could be hidden in "
                            "the noise. ",
                      leading(gap["which"]["set95"].get<std::vector<std::string>>())),
          {measurement_of(gap["which"])}};
}

Words named(const Json &gap) {
  const std::string claim = gap["which"]["claim"];
  Words w{claim + (claim.find(" + ") == std::string::npos ? " explains the gap"
                                                          : " explain the gap together"),
          "",
          {}};
  bool instrument = true;
  std::string settings;
  for (const Json &fitted : gap["fitted_effects"]) {
    const Effect &e = find_effect(fitted["effect"]);
    w.meaning += (w.meaning.empty() ? "" : "; ") + e.name + ": " + e.what;
    settings +=
        (settings.empty() ? "" : "; ") + setting_of(fitted) + (e.in_recipe ? " in the recipe" : "");
    instrument = instrument && e.layer == "measurement";
  }
  w.meaning += ".";
  w.next = {instrument ? "Check the instrument: " + settings +
                             ". The model needs no change; correct the data and diagnose again."
                       : "Switch it on: " + settings + ".",
            "Recalibrate with it, run conditions that were not used here on new packings, and "
            "compare before with after."};
  return w;
}

} // namespace

Json claim_in_words(const Json &gap) {
  const std::string claim = gap["which"]["claim"];
  const Words w = claim == "none"        ? none()
                  : claim == "noise"     ? noise()
                  : claim == "unknown"   ? unknown(gap)
                  : claim == "undecided" ? undecided(gap)
                                         : named(gap);
  return {{"headline", w.headline}, {"meaning", w.meaning}, {"next", w.next}};
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
  return amplitude.is_number() ? Json(p.value(amplitude.get<double>())) : Json();
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
    if (price.unit.empty() || (price.name == kUnloadingCurve && !has_release(bank)))
      rows.push_back({{"what", price.what}, {"cost", price.hours}});
  gap["which"]["not_in_bank"] = rows;
  gap["which"]["cost_unit"] = "working hours";
}

} // namespace

void put_in_words(const ExperimentData &data, const BankTable &bank, Json &gap) {
  add_units(data, gap);
  add_amplitudes(gap);
  add_prices(bank, gap);
  gap["which"].update(claim_in_words(gap));
  for (const Json &place : gap["where"])
    if (place["significant"] == true)
      gap["said"].push_back(in_words(place, "the recalibrated base model"));
}

} // namespace calendem
