// SPDX-License-Identifier: GPL-2.0-or-later
// All English of a diagnosis, made of gap.json.
#include "base/gap_file.h"
#include "base/shown.h"
#include "diagnose/diagnosis.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {

using Json = nlohmann::ordered_json;
namespace {

constexpr double kPerhaps = 0.2; // probability of a change beside what is named, to be mentioned
constexpr double kWorthMeasuring = 0.02; // by how much the expected probability has to grow
constexpr std::size_t kListed = 6;

std::string percent(double probability) {
  return probability > 0.995 && probability < 1.0 ? "more than 99 %"
                                                  : fmt::format("{:.0f} %", kPercent * probability);
}

const Json &change_of(const Json &which, const std::string &name) {
  return *std::find_if(which["changes"].begin(), which["changes"].end(),
                       [&](const Json &c) { return c["name"] == name; });
}

std::string phrase_of(const Json &change) {
  const std::string kind = change["kind"];
  if (kind == "understated")
    return "errors that are larger than stated";
  if (kind == "something")
    return "a cause that no effect of the bank describes";
  const std::string effect = change["effect"];
  return kind == "absent"  ? "the absence of " + effect
         : kind == "fault" ? effect + " (a fault of the press or of a reading)"
                           : effect;
}

std::string joined(const Json &which, const Json &names, const char *last, bool with_probability) {
  std::string out;
  const std::size_t count = std::min(kListed, names.size());
  for (std::size_t k = 0; k < count; ++k) {
    const Json &change = change_of(which, names[k]);
    out += k == 0 ? "" : k + 1 < count ? ", " : last;
    out += phrase_of(change);
    if (with_probability)
      out += fmt::format(" ({})", percent(change["probability"]));
  }
  return out;
}

std::string range_in_words(const Json &amplitude) {
  return fmt::format("{} = {} (90 %: {} to {})", amplitude["key"].get<std::string>(),
                     shown(amplitude["value"], "{:.3g}"), shown(amplitude["low90"], "{:.3g}"),
                     shown(amplitude["high90"], "{:.3g}"));
}

/// What to do about a change that is named.
std::string step_of(const Json &change) {
  const std::string kind = change["kind"];
  if (kind == "understated")
    return "Repeat a measurement: its errors are larger than the experiment file states.";
  if (kind == "something")
    return "Look at where the gap lies; the cause is none of the effects of `calendem effects`.";
  const std::string effect = change["effect"];
  if (kind == "absent") {
    const EffectParameter &p = find_effect(effect).parameter;
    return fmt::format("Switch {} off: {} = {}.", effect, p.keys.front(), p.off);
  }
  return fmt::format("{}: {}.",
                     kind == "fault" ? "Check the press and its readings" : "Switch it on",
                     range_in_words(change["amplitude"]));
}

std::string measurement_in_words(const Json &m) {
  const std::string what = m["observable"];
  return fmt::format("{} {} {:.3g} MPa", what == "curve" ? "the curve" : what,
                     what == "curve" ? "up to" : "after", m["pressure_MPa"].get<double>());
}

/// The measurement that tells most, if it tells anything.
std::string best_measurement(const Json &which) {
  const Json *best = nullptr;
  for (const Json &m : which["measurements"])
    if (!best || m["expected_probability"] > (*best)["expected_probability"])
      best = &m;
  const double now = which["now"];
  if (!best || (*best)["expected_probability"].get<double>() < now + kWorthMeasuring)
    return "No further measurement that the bank predicts would tell more.";
  return fmt::format("Measure {}: the right explanation would then have a probability of {} on "
                     "average, instead of {}.",
                     measurement_in_words(*best), percent((*best)["expected_probability"]),
                     percent(now));
}

/// Changes that may be so beside those that are named.
std::string perhaps_with(const Json &which) {
  Json names = Json::array();
  for (const Json &c : which["changes"])
    if (c["probability"] >= kPerhaps && c["bayes_factor"] > 1.0 &&
        std::find(which["named"].begin(), which["named"].end(), c["name"]) == which["named"].end())
      names.push_back(c["name"]);
  return names.empty() ? "" : fmt::format(" Perhaps with {}.", joined(which, names, " and ", true));
}

struct Words {
  std::string headline, meaning;
  std::vector<std::string> next;
};

Words explained(const Json &which) {
  Words out;
  const Json &named = which["named"];
  out.headline = "Explained by " + joined(which, named, " and ", false);
  out.meaning =
      fmt::format("Probability: {}.{}", joined(which, named, "; ", true), perhaps_with(which));
  for (const Json &name : named)
    out.next.push_back(step_of(change_of(which, name)));
  return out;
}

Words one_of(const Json &which) {
  const Json &named = which["named"];
  Words out;
  out.headline = "One of these: " + joined(which, named, " or ", true);
  if (named.empty())
    out.headline = "A gap that these data do not explain";
  out.meaning = "The model does not fit, or hardly, and these data do not say which of them it is.";
  return out;
}

Words something_else() {
  return {"Something that no model here has",
          "The gap is larger than errors explain, and no effect or fault of the bank accounts for "
          "it.",
          {"Look at where the gap lies; check the experiment's pressures, thicknesses and loadings "
           "first."}};
}

Words nothing(const Json &gap) {
  return {
      "Nothing that these data could show",
      fmt::format("Recalibrated, the model fits all that was measured (largest |z| below {}). "
                  "An effect too small to be seen, or hidden in the recalibrated parameters, is "
                  "not excluded.",
                  shown(gap["threshold"], "{:.1f}")),
      {"Use the recalibrated parameters with their ranges."}};
}

Words words_of(const Json &gap) {
  const std::string answer = gap["which"]["answer"];
  Words out = answer == "explained"        ? explained(gap["which"])
              : answer == "one of these"   ? one_of(gap["which"])
              : answer == "something else" ? something_else()
                                           : nothing(gap);
  out.next.push_back(best_measurement(gap["which"]));
  return out;
}

std::string in_points(const Json &points) {
  return points.is_null() ? "" : fmt::format("{:.1f} points of porosity", points.get<double>());
}

std::string shrink_in_words(const Json &gap) {
  const Json &s = gap["shrink"], &points = s["porosity_points"];
  std::string out = fmt::format("Recalibrated, the model is off by {:.1f} standard deviations",
                                s["before"].get<double>());
  if (!points["before"].is_null())
    out += fmt::format(" ({})", in_points(points["before"]));
  if (!s["hypothesis"].empty()) {
    out += fmt::format("; with {} by {:.1f}", joined(gap["which"], s["hypothesis"], " and ", false),
                       s["after"].get<double>());
    if (!points["after"].is_null())
      out += fmt::format(" ({})", in_points(points["after"]));
  }
  return out +
         fmt::format(". Noise alone leaves {:.1f}, and in one of twenty cases {:.1f} or more.",
                     s["noise"].get<double>(), s["noise_floor"].get<double>());
}

/// What the runs left of the gap; empty: nothing was run.
std::string runs_in_words(const Json &runs) {
  std::string out;
  for (const Json &m : runs["models"])
    out += fmt::format("{}{}: {:.1f} standard deviations", out.empty() ? "" : "; ",
                       m["role"].get<std::string>(), m["gap"].get<double>());
  return out + ". Means over runs at several draws, each on a packing of its own. Another "
               "explanation may close the gap as well.";
}

} // namespace

void put_in_words(Json &gap) {
  const Words words = words_of(gap);
  gap["which"]["headline"] = words.headline;
  gap["which"]["meaning"] = words.meaning;
  gap["which"]["next"] = words.next;
  gap["shrink"]["in_words"] = shrink_in_words(gap);
  if (Json &runs = gap["shrink"]["runs"]; !runs.is_null())
    runs["in_words"] = runs_in_words(runs);
  gap["in_bank"] =
      gap["inside_bank"].get<bool>()
          ? fmt::format("The data lie inside the bank: {}.", gap["bank"].get<std::string>())
          : fmt::format("The data lie outside the bank ({}): {}.", gap["bank"].get<std::string>(),
                        fmt::join(gap["outside"].get<std::vector<std::string>>(), "; "));
  gap["said"] = Json::array();
  for (const Json &place : gap["where"])
    if (place["significant"] == true)
      gap["said"].push_back(in_words(place, "the recalibrated model"));
}

} // namespace calendem
