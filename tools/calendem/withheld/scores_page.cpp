// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/effects.h"
#include "base/provenance.h"
#include "report/embedded.h"
#include "report/page_template.h"
#include "withheld/score.h"
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {
extern const char *const kScoresHtml;
namespace {

using Json = nlohmann::ordered_json;

std::string verdict_of(const Metric &m) {
  switch (m.verdict) {
  case Metric::met:
    return m.certain ? "met" : "met, but its interval reaches beyond";
  case Metric::missed:
    return "missed";
  case Metric::not_measured:
    return "not measured";
  default:
    return "";
  }
}

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(); }
std::string shown(double v) { return std::isfinite(v) ? fmt::format("{:.3f}", v) : "–"; }

/// Everything as one object: scores.json, and what the page is made of.
Json scores_of(const std::vector<ScoredCase> &cases, const std::string &round) {
  Json out = {{"round", round}, {"metrics", Json::array()}, {"cases", Json::array()}};
  for (const Metric &m : metrics_of(cases)) {
    const std::string interval =
        std::isfinite(m.low) ? shown(m.low) + " to " + shown(m.high) : shown(m.low);
    out["metrics"].push_back({{"name", m.name},
                              {"value", number(m.value)},
                              {"interval90", {number(m.low), number(m.high)}},
                              {"cases", m.cases},
                              {"truths", m.clusters},
                              {"gate", m.gate},
                              {"verdict", verdict_of(m)},
                              {"shown", shown(m.value)},
                              {"interval", interval}});
  }
  for (const auto &[truth, claims] : confusion_of(cases))
    for (const auto &[claim, n] : claims)
      out["confusion"][truth][claim] = n;
  for (const ScoredCase &c : cases)
    out["cases"].push_back(
        {{"id", c.id},
         {"block", c.block},
         {"truth", c.truth},
         {"claim", c.claim},
         {"most_probable", c.ranked(0)},
         {"probability_of_truth",
          number(c.probability.count(c.truth) ? c.probability.at(c.truth) : 0.0)},
         {"signal_to_noise", c.signal_to_noise},
         {"shrinkage_predicted", number(c.predicted_shrinkage)},
         {"shrinkage_rerun", number(c.shrinkage)},
         {"shrinkage_placebo", number(c.placebo_shrinkage)},
         {"baselines", c.baselines}});
  out["note"] = "Truths made by the same program as the bank are withheld, not independent.";
  out["provenance"] = {{"calendem", version()}};
  return out;
}

std::string as_markdown(const Json &scores) {
  std::string out =
      fmt::format("# Withheld effects: {}\n\n{}\n\n| what | value | 90 % | cases | "
                  "truths | gate | |\n|---|---|---|---|---|---|---|\n",
                  scores["round"].get<std::string>(), scores["note"].get<std::string>());
  const auto text = [](const Json &row, const char *key) { return row[key].get<std::string>(); };
  for (const Json &m : scores["metrics"])
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", text(m, "name"), text(m, "shown"),
                       text(m, "interval"), m["cases"].get<int>(), m["truths"].get<int>(),
                       text(m, "gate"), text(m, "verdict"));
  out += "\n| truth | claims |\n|---|---|\n";
  for (const auto &[truth, claims] : scores["confusion"].items()) {
    std::string list;
    for (const auto &[claim, n] : claims.items())
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", n.get<int>(), claim);
    out += fmt::format("| {} | {} |\n", truth, list);
  }
  return out;
}

std::string as_page(const Json &scores) {
  nlohmann::json values = nlohmann::json::parse(scores.dump());
  values["css"] = report::embedded::kPageCss;
  for (const auto &[truth, claims] : scores["confusion"].items())
    for (const auto &[claim, n] : claims.items())
      values["matrix"].push_back({{"truth", truth}, {"claim", claim}, {"n", n.get<int>()}});
  for (nlohmann::json &c : values["cases"]) {
    const auto percent = [&c](const char *key) {
      return c[key].is_number() ? fmt::format("{:.0f} %", 100.0 * c[key].get<double>())
                                : std::string("–");
    };
    const double signal = c["signal_to_noise"].get<double>();
    c["signal_shown"] = signal > 0.0 ? fmt::format("{:.1f}", signal) : "–";
    c["predicted_shown"] = percent("shrinkage_predicted");
    c["rerun_shown"] = percent("shrinkage_rerun");
    c["placebo_shown"] = percent("shrinkage_placebo");
  }
  values["json"] = scores.dump();
  return report::fill_template(kScoresHtml, values);
}

} // namespace

void write_scores(const std::vector<ScoredCase> &cases, const std::string &round,
                  const std::string &folder) {
  const Json scores = scores_of(cases, round);
  const std::string table = as_markdown(scores);
  write_file(folder + "/scores.json", scores.dump(1) + "\n");
  write_file(folder + "/scores.md", table);
  write_file(folder + "/scores.html", as_page(scores));
  fmt::print("{}\npage: {}/scores.html\n", table, folder);
}

} // namespace calendem
