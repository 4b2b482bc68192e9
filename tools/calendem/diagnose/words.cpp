// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/gap_file.h"
#include "compare/gap.h"
#include "diagnose/diagnose.h"
#include "diagnose/effects_in_words.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kListed = 5;    // of a list of explanations
constexpr double kWorthSaying = 0.01; // probability
constexpr double kPerhaps =
    0.1; // probability of an effect beside what is claimed, to be in its name

struct Words {
  std::string headline, meaning;
  std::vector<std::string> next;
};

std::string percent(double probability) {
  return probability > 0.995 && probability < 1.0 ? "more than 99 %"
                                                  : fmt::format("{:.0f} %", 100.0 * probability);
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

/// "friction; thickness_zero" of the effects whose limits are worth reading.
std::vector<std::string> limits_of(const Json &which) {
  std::vector<std::string> out;
  for (const Json &row : which["effects"])
    if (row["limited"] == true)
      out.push_back(row["said"]);
  return out;
}

std::string what_is_left(const Json &which) {
  const std::vector<std::string> limits = limits_of(which);
  return limits.empty() ? "These data limit no effect of the bank: all of them stay possible."
                        : fmt::format("Of effects that may hide in it these data leave room for: "
                                      "{}. Others are not limited.",
                                      fmt::join(limits, "; "));
}

Words none(const Json &gap) {
  return {
      "Nothing that these data could show",
      fmt::format(
          "With its parameters recalibrated the base model fits all that was measured. "
          "The probability that nothing acts is {}; an effect too small to be seen, or hidden in "
          "the recalibrated parameters, is not excluded.",
          percent(gap["which"]["probability"]["none"])),
      {"Use the recalibrated parameters with their 95 % ranges over all explanations, below: "
       "part of each may be a hidden cause.",
       what_is_left(gap["which"])}};
}

Words nothing_changed(const Json &gap) {
  return {"Nothing that these data could show",
          fmt::format("Before and after agree within their errors. The probability that nothing "
                      "changed is {}; a change too small to be seen is not excluded.",
                      percent(gap["which"]["probability"]["none"])),
          {what_is_left(gap["which"])}};
}

Words noise() {
  return {
      "Explained by errors larger than stated",
      "The base model would fit if the measured values scattered more than is stated. No "
      "effect is needed, and none is excluded: with few things measured an effect that the bank "
      "lacks looks the same.",
      {"Measure again on other samples and state the scatter that you find.",
       "Look for a sample or a reading that stands out: see where."}};
}

Words unknown(const Json &gap) {
  return {"Something that no model here has",
          "Neither the base model nor any effect of the bank fits. " + about_unknown(gap),
          {"Do not recalibrate it away: parameters fitted now would carry it.",
           "Check the readings there first, then look for physics that the table of "
           "effects lacks (calendem effects)."}};
}

Words unknown_change(const Json &gap) {
  return {"Something that no model here has",
          "No effect of the bank makes this difference. " + about_unknown(gap),
          {"Check the readings there first. A base parameter that changed (a softer binder, weaker "
           "particles) is no effect of the table: it counts here."}};
}

/// The most probable ones of a list; the others are counted.
std::string leading(const std::vector<std::string> &names) {
  const std::size_t listed = std::min(names.size(), kListed);
  std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + listed, "; "));
  return listed < names.size() ? text + fmt::format("; {} more", names.size() - listed) : text;
}

/// "friction or thickness_zero, or something that acts so (59 %)"
std::string group_in_words(const Json &group) {
  std::string text =
      fmt::format("{}", fmt::join(group["effects"].get<std::vector<std::string>>(), " or "));
  if (group["acts_like"].get<double>() >= kWorthSaying)
    text += ", or something that acts so";
  if (group["with_none"] == true)
    text += ", or nothing";
  return fmt::format("{} ({})", text, percent(group["probability"]));
}

/// What these data cannot tell apart is one explanation; what has no part in any stands by itself.
std::vector<std::string> explanations(const Json &which) {
  std::vector<std::string> out;
  bool with_none = false;
  double like = 0.0;
  for (const Json &group : which["groups"]) {
    out.push_back(group_in_words(group));
    with_none |= group["with_none"] == true;
    like += group["acts_like"].get<double>();
  }
  const auto add = [&](const char *name, const char *said, double less) {
    const double p = which["probability"].value(name, 0.0) - less;
    if (p >= kWorthSaying)
      out.push_back(fmt::format("{} ({})", said, percent(p)));
  };
  if (!with_none)
    add("none", "none of them", 0.0);
  add("noise", "errors larger than stated", 0.0);
  add("unknown", "something that no model here has", like);
  for (const Json &row : which["short_runs"])
    out.push_back(fmt::format("more of {} than the bank has run", row["rival"].get<std::string>()));
  return out;
}

Words undecided(const Json &gap) {
  const Json &where = gap["where"], &which = gap["which"];
  const bool any = std::any_of(where.begin(), where.end(),
                               [](const Json &row) { return row["significant"] == true; });
  const std::vector<std::string> all = explanations(which);
  Words w{"One of these: " + leading(all), "", {measurement_of(which)}};
  if (!which["short_runs"].empty())
    w.next.push_back("The gap is beyond what the bank has run: run more of what is named last, and "
                     "diagnose again.");
  if (!any)
    w.meaning = "No difference is significant, but weak effects could be hidden in the noise. ";
  w.meaning += fmt::format("These data do not distinguish effects with \"or\" between them. "
                           "Sets of them, the most probable first, up to 95 %: {}.",
                           leading(which["set95"].get<std::vector<std::string>>()));
  return w;
}

bool names(const std::string &claim, const std::string &effect) {
  return (" + " + claim + " + ").find(" + " + effect + " + ") != std::string::npos;
}

/// Effects that may act beside what is claimed, from that probability on.
std::vector<std::string> beside(const Json &which, double least) {
  std::vector<std::string> out;
  for (const Json &row : which["beside"])
    if (row["probability"].get<double>() >= least)
      out.push_back(row["effect"]);
  return out;
}

/// "friction, perhaps with pre_cracks"
std::string with_companions(const Json &which) {
  const std::string claim = which["claim"];
  const std::vector<std::string> names = beside(which, kPerhaps);
  return names.empty() ? claim
                       : fmt::format("{}, perhaps with {}", claim, fmt::join(names, " or "));
}

/// How probable it is that something else acts too, and what.
std::string with_others(const Json &which) {
  const std::string claim = which["claim"];
  double acts = 0.0;
  for (const auto &[name, inclusion] : which["inclusion"].items())
    if (names(claim, name))
      acts = acts == 0.0 ? inclusion.get<double>() : std::min(acts, inclusion.get<double>());
  const double more = acts - which["probability"].value(claim, 0.0);
  const std::vector<std::string> others = beside(which, 0.0);
  std::string text;
  if (more >= kWorthSaying)
    text += fmt::format(" Something else acts too with a probability of {}.", percent(more));
  if (!others.empty())
    text += fmt::format(" Beside it these data do not exclude: {}.", leading(others));
  return text;
}

Words named(const Json &gap) {
  const Json &which = gap["which"];
  const std::string claim = which["claim"];
  Words w{"Explained by " + with_companions(which), "", {}};
  bool instrument = true;
  std::string settings;
  for (const Json &row : which["effects"]) {
    if (!names(claim, row["effect"]))
      continue;
    const Effect &e = find_effect(row["effect"]);
    w.meaning += (w.meaning.empty() ? "" : "; ") + e.name + ": " + e.what;
    settings +=
        (settings.empty() ? "" : "; ") + setting_of(row) + (e.in_recipe ? " in the recipe" : "");
    instrument = instrument && e.layer == "measurement";
  }
  w.meaning += "." + with_others(which);
  w.next = {instrument ? "Check the instrument: " + settings +
                             ". The model needs no change; correct the data and diagnose again."
                       : "Switch it on: " + settings + ".",
            "Recalibrate with it, run conditions that were not used here on new packings, and "
            "compare before with after."};
  return w;
}

/// One of the four kinds of answer.
const char *answer_of(const std::string &claim) {
  return claim == "none"        ? "nothing to see"
         : claim == "unknown"   ? "something else"
         : claim == "undecided" ? "one of these"
                                : "explained";
}

} // namespace

Json claim_in_words(const Json &gap) {
  const std::string claim = gap["which"]["claim"];
  const bool change = gap.contains("change_from");
  const Words w = claim == "none"        ? (change ? nothing_changed(gap) : none(gap))
                  : claim == "noise"     ? noise()
                  : claim == "unknown"   ? (change ? unknown_change(gap) : unknown(gap))
                  : claim == "undecided" ? undecided(gap)
                                         : named(gap);
  return {{"answer", answer_of(claim)},
          {"headline", change ? "What changed. " + w.headline : w.headline},
          {"meaning", w.meaning},
          {"next", w.next}};
}

std::string shrinkage_in_words(const Json &shrink) {
  const double before = shrink["before"], floor = shrink["noise_floor"];
  const double after = shrink.value("after", before);
  const bool both = shrink.contains("after");
  const std::string gaps = both ? fmt::format("Gap {:.1f} before, {:.1f} after", before, after)
                                : fmt::format("Gap {:.1f}", before);
  const std::string noise =
      fmt::format("errors of measurement and sample alone leave up to {:.1f} (95 %)", floor);
  if (before <= floor && after <= floor)
    return fmt::format("{}; {}: these data show no gap here, nor that it shrinks or grows.", gaps,
                       noise);
  if (both && after <= floor)
    return fmt::format("{}; {}: what is left may be nothing.", gaps, noise);
  return fmt::format("{}; {}.", gaps, noise);
}

} // namespace calendem
