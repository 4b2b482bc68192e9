// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/page.h"
#include "diagnose/compare/heat_map.h"
#include "report/embedded.h"
#include "report/page_template.h"
#include "report/tables.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {
extern const char *const kDiagnosisHtml;
namespace {

using nlohmann::json;

/// Ids in the order of the experiment file.
std::vector<std::string> conditions_of(const json &gap) {
  std::vector<std::string> ids;
  for (const json &row : gap["predictions"]["observables"])
    if (std::find(ids.begin(), ids.end(), row["condition"]) == ids.end())
      ids.push_back(row["condition"]);
  return ids;
}

json parameters_of(const json &gap) {
  json rows = json::array();
  for (const json &p : gap["parameters"])
    rows.push_back({{"name", p["parameter"]},
                    {"value", shown(p["mode"], "{:.4g}")},
                    {"low", shown(p["low90"], "{:.4g}")},
                    {"high", shown(p["high90"], "{:.4g}")}});
  for (const json &p : gap["fitted_effects"])
    rows.push_back({{"name", fmt::format("{} (off: {})",
                                         fmt::join(p["keys"].get<std::vector<std::string>>(), ", "),
                                         p["off"].get<std::string>())},
                    {"value", shown(p["value"], "{:.4g}")},
                    {"low", shown(p["value_low90"], "{:.4g}")},
                    {"high", shown(p["value_high90"], "{:.4g}")}});
  return rows;
}

json measurements_of(const json &which) {
  json rows = json::array();
  for (const json &m : which["measurements"])
    rows.push_back({{"what", m["what"]},
                    {"cost", shown(m["cost"], "{:.3g}")},
                    {"expected", fmt::format("{:.0f} → {:.0f}", 100.0 * m["now"].get<double>(),
                                             100.0 * m["expected_probability"].get<double>())},
                    {"per_cost", fmt::format("{:+.1f}", 100.0 * m["per_cost"].get<double>())}});
  for (const json &m : which["not_in_bank"])
    rows.push_back({{"what", m["what"]},
                    {"cost", shown(m["cost"], "{:.3g}")},
                    {"expected", "not in this bank"},
                    {"per_cost", "–"}});
  return rows;
}

constexpr double kSaysMuch = 0.5; // Q2 below which an emulator explains little

json emulators_of(const json &gap) {
  json rows = json::array();
  for (const json &e : gap["emulators"])
    rows.push_back({{"effect", e["effect"]},
                    {"runs", e["runs"]},
                    {"q2", shown(e["q2"], "{:.3f}")},
                    {"error", shown(e["error"], "{:.2g}")},
                    {"verdict", e["poor"]                           ? "too poor: cannot be claimed"
                                : e["q2"].get<double>() < kSaysMuch ? "hardly moves these data"
                                                                    : "good enough"}});
  return rows;
}

json evidence_of(const json &which) {
  json rows = json::array();
  for (const json &e : which["evidence"])
    rows.push_back({{"hypothesis", e["hypothesis"]},
                    {"prior", fmt::format("{:.1f}", 100.0 * e["prior"].get<double>())},
                    {"probability", fmt::format("{:.2f}", 100.0 * e["probability"].get<double>())},
                    {"log_evidence", shown(e["log_evidence"], "{:.2f}")},
                    {"error", shown(e["log_evidence_error"], "{:.2f}")},
                    {"laplace", shown(e["log_evidence_laplace"], "{:.2f}")},
                    {"effective", fmt::format("{:.0f} of {}", e["effective_samples"].get<double>(),
                                              e["samples"].get<int>())},
                    {"adequacy", shown(e["adequacy_p"], "{:.2g}")}});
  return rows;
}

std::string release_noise(const json &gap) {
  std::vector<std::string> all;
  for (const json &p : gap["point_noise"])
    all.push_back(fmt::format("{:.2g} ({})", p["times_stated"].get<double>(),
                              p["condition"].get<std::string>()));
  return all.empty() ? "No release tells how large the errors of the measurement are."
                     : fmt::format("Points of the release scatter {} times as much as is stated.",
                                   fmt::join(all, ", "));
}

} // namespace

std::string diagnosis_page(const nlohmann::ordered_json &ordered) {
  const json gap = ordered;
  json values = {{"experiment", gap["experiment"]}, {"said", gap["said"]}};
  values["css"] = report::embedded::kPageCss;
  values["claim"] = gap["which"]["claim"];
  values["why"] = gap["which"]["why"];
  values["threshold"] = shown(gap["threshold"], "{:.2f}");
  values["map"] = heat_map(gap["where"], gap["threshold"], conditions_of(gap));
  values["ranking"] = ranking_part(gap);
  values["predictions"] = predictions_part(gap);
  values["conflict"] = conflict_part(gap);
  values["drift"] = drift_part(gap);
  values["confounding"] = confounding_part(gap);
  values["shrink"] = shrink_part(gap);
  values["measurements"] = measurements_of(gap["which"]);
  values["parameters"] = parameters_of(gap);
  values["emulators"] = emulators_of(gap);
  values["evidence"] = evidence_of(gap["which"]);
  values["degrees"] = shown(gap["scatter"]["degrees_of_freedom"], "{:.0f}");
  values["release_noise"] = release_noise(gap);
  values["not_said"] = gap["not_said"];
  values["provenance_rows"] = report::facts_of(gap["provenance"], {});
  values["json"] = report::in_script(ordered.dump());
  return report::fill_template(kDiagnosisHtml, values);
}

} // namespace calendem
