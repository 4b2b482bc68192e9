// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/compare/heat_map.h"
#include "diagnose/inference/which.h"
#include "diagnose/page.h"
#include <fmt/format.h>

namespace calendem {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBars = 8;
constexpr double kLeast = 0.005; // probability below which no bar is drawn, the first three aside

std::string name_of(const json &evidence) {
  const std::string name = evidence["hypothesis"];
  if (name == "none")
    return "none: the base model suffices";
  if (name == "noise")
    return "noise: errors understated";
  if (name == "unknown" && evidence.value("place", "") != "")
    return "unknown: " + evidence["place"].get<std::string>();
  return name;
}

json bar_of(const json &e, const std::string &claim) {
  const double probability = e["probability"];
  const bool predicts = e["hypothesis"] != "noise" && e["hypothesis"] != "unknown";
  return {{"name", name_of(e)},
          {"percent", fmt::format("{:.1f}", 100.0 * probability)},
          {"width", fmt::format("{:.1f}", 100.0 * probability)},
          {"prior", fmt::format("{:.1f}", 100.0 * e["prior"].get<double>())},
          {"fit", predicts ? fmt::format("{:.2g}", e["adequacy_p"].get<double>()) : "–"},
          {"kind", e["hypothesis"] == claim ? "claimed" : "other"}};
}

/// Whether other priors would change the claim, in one sentence.
std::string steadiness(const json &which) {
  std::string changes;
  for (const json &s : which["sensitivity"])
    if (s["claim"] != which["claim"])
      changes += fmt::format("{}{}: {}", changes.empty() ? "" : "; ",
                             s["priors"].get<std::string>(), s["claim"].get<std::string>());
  return changes.empty() ? "The claim is the same with every other prior tried."
                         : "Other priors, other claims: " + changes + ".";
}

} // namespace

json ranking_part(const json &gap) {
  const json &which = gap["which"];
  json bars = json::array(), others = json::array();
  double rest = 0.0;
  const inference::WhichSettings rule;
  for (const json &e : which["evidence"])
    if (bars.size() < 3 || (bars.size() < kMostBars && e["probability"] >= kLeast))
      bars.push_back(bar_of(e, which["claim"]));
    else
      rest += e["probability"].get<double>();
  for (const json &s : which["sensitivity"])
    others.push_back({{"priors", s["priors"]},
                      {"claim", s["claim"]},
                      {"percent", fmt::format("{:.1f}", 100.0 * s["probability"].get<double>())}});
  return {{"bars", bars},
          {"rest", fmt::format("{} more share {:.1f} %.", which["evidence"].size() - bars.size(),
                               100.0 * rest)},
          {"steadiness", steadiness(which)},
          {"claimed_from", fmt::format("{:g}", 100.0 * rule.claim_probability)},
          {"least_p", fmt::format("{:g}", rule.adequacy)},
          {"sensitivity", others}};
}

} // namespace calendem
