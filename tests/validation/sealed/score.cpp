// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed/score.h"
#include "base/gap_file.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/registry.h"
#include "base/shown.h"
#include "report/page.h"
#include "sealed/sealing.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {

namespace {

using Json = nlohmann::json;

/// Signal-to-noise of a single effect: it grows with the amplitude.
double signal_to_noise(const Json &gap, const std::string &effect, double amplitude) {
  for (const Json &limit : gap.at("confounding").value("detection_limit", Json::array()))
    if (limit.at("effect") == effect && limit.at("against_none").is_number())
      return kDetectable * std::fabs(amplitude) / limit.at("against_none").get<double>();
  return 0.0;
}

std::vector<bool> covered_parameters(const Json &truth, const Json &gap, const char *low,
                                     const char *high) {
  std::vector<bool> out;
  for (const Json &p : gap.at("parameters")) {
    const double v = truth.at("parameters").at(p.at("parameter").get<std::string>());
    out.push_back(v >= p.at(low).get<double>() && v <= p.at(high).get<double>());
  }
  return out;
}

std::vector<bool> covered_amplitudes(const Json &truth, const Json &gap) {
  std::vector<bool> out;
  for (const Json &e : gap.value("fitted_effects", Json::array()))
    if (const std::string name = e.at("effect"); truth.at("effects").contains(name)) {
      const double a = find_effect(name).parameter.amplitude(truth.at("effects").at(name));
      out.push_back(a >= e.at("low90").get<double>() && a <= e.at("high90").get<double>());
    }
  return out;
}

double number(const Json &j, const char *key) {
  return j.contains(key) && j[key].is_number() ? j[key].get<double>() : std::nan("");
}

void add_shrinkage(const Json &shrink, ScoredCase &c) {
  const Json share = shrink.value("shrinkage", Json::object());
  c.predicted_shrinkage = number(share, "predicted");
  c.shrinkage = number(share, "value");
  c.least_shrinkage = number(share, "low90");
  c.most_shrinkage = number(share, "high90");
  c.placebo_shrinkage = number(shrink, "placebo");
}

ScoredCase case_of(const Json &truth, const Json &gap) {
  ScoredCase c;
  c.id = truth.at("id");
  c.block = truth.at("block");
  c.cluster = truth.at("point");
  c.samples = truth.value("samples", 0);
  c.truth = truth.at("answer");
  const Json &which = gap.at("which");
  c.claim = which.at("claim");
  c.headline = which.value("answer", "");
  c.parameters = truth.at("parameters").get<std::map<std::string, double>>();
  c.probability = which.at("probability").get<std::map<std::string, double>>();
  c.set95 = which.at("set95").get<std::vector<std::string>>();
  for (const Json &row : which.value("beside", Json::array()))
    c.beside.insert(row.at("effect").get<std::string>());
  c.next_named =
      which.contains("next_measurement") && which["next_measurement"].value("what", "") != "";
  for (const Json &row : gap.at("where"))
    if (row.at("significant").get<bool>())
      c.places.insert(fmt::format("{}|{}|{}", row.at("condition").get<std::string>(),
                                  row.at("stage").get<std::string>(),
                                  row.at("observable").get<std::string>()));
  if (const Json &effects = truth.at("effects"); effects.size() == 1) {
    const std::string name = effects.begin().key();
    const double value = effects.begin().value();
    c.signal_to_noise = signal_to_noise(gap, name, find_effect(name).parameter.amplitude(value));
  }
  return c;
}

} // namespace

void add_cases(const Json &truth, const Json &gap, const Json &without, const Json &baselines,
               const Json &shrink, std::vector<ScoredCase> &out) {
  ScoredCase c = case_of(truth, gap);
  add_shrinkage(shrink, c);
  c.covered = covered_parameters(truth, gap, "low90", "high90");
  c.covered_by_average = covered_parameters(truth, gap, "low95", "high95");
  c.covered_amplitude = covered_amplitudes(truth, gap);
  c.baselines = baselines.at("named").get<std::map<std::string, std::string>>();
  out.push_back(c);
  if (c.block != "single" || without.value("without", "") != c.truth)
    return;
  ScoredCase less = case_of(truth, without);
  less.signal_to_noise = c.signal_to_noise;
  less.block = "left_out";
  less.truth = "unknown";
  out.push_back(less);
}

std::vector<ScoredCase> open_round(const std::string &folder, const std::string &answers) {
  const Json sealed = json_of(folder + "/sealed/truth.json");
  const std::string open = folder + "/handed_out/commitment.json";
  const Json committed = json_of(open).at("cases"), list = json_of(answers + "/answers.json");
  must_be(sha256(bytes_of(open)), list.value("commitment_sha256", ""),
          open + ", which was answered,");
  if (sealed.at("cases").size() != committed.size())
    throw Failure(kCheckFailed, fmt::format("{} truths are sealed, {} were committed to. Nothing "
                                            "is scored.",
                                            sealed.at("cases").size(), committed.size()));
  std::vector<ScoredCase> out;
  for (const Json &one : sealed.at("cases")) {
    const Json &truth = one.at("truth");
    const std::string id = truth.at("id");
    must_be(commitment(one.at("salt"), truth), committed.value(id, ""), "the truth of case " + id);
    must_be(sha256_of_case(folder + "/handed_out/" + id), truth.at("handed_out_sha256"),
            "what was handed out of case " + id);
    if (const std::string sealed_too = truth.value("without_cause_sha256", ""); !sealed_too.empty())
      must_be(sha256_of_files(folder + "/sealed/without_cause/" + id), sealed_too,
              "what case " + id + " is without its cause");
    if (const std::string sealed_too = truth.value("samples_sha256", ""); !sealed_too.empty())
      must_be(sha256_of_samples(folder + "/sealed/samples/" + id), sealed_too,
              "what the samples of case " + id + " are alone");
    Json answer[4] = {{}, {}, {}, Json::object()};
    const char *const files[] = {"gap.json", "gap_without.json", "baselines.json", "shrink.json"};
    for (int k = 0; k < 4; ++k) {
      const std::string name = id + "/" + files[k];
      if (k == 3 && !list.at("sha256").contains(name))
        continue;
      must_be(sha256(bytes_of(answers + "/" + name)), list.at("sha256").value(name, ""),
              "the answer " + name);
      answer[k] = k == 0 ? read_diagnosis(answers + "/" + name) : json_of(answers + "/" + name);
    }
    add_cases(truth, answer[0], answer[1], answer[2], answer[3], out);
  }
  return out;
}

void score_round(const ScoreOptions &o) {
  std::vector<ScoredCase> cases = open_round(o.round, o.answers);
  if (std::filesystem::exists(o.round + "/sealed/without_cause"))
    add_true_gaps(o.round, o.answers, o.bank, o.table, cases);
  make_output_folder(o.folder);
  write_scores(cases, json_of(o.round + "/sealed/truth.json").value("round", ""), o.folder);
}

extern const char *const kScoresHtml;
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string verdict_of(const Metric &m) {
  switch (m.verdict) {
  case Metric::met:
    return "met";
  case Metric::not_shown:
    return "the value meets it, its 90 % bound does not";
  case Metric::missed:
    return "missed";
  case Metric::not_measured:
    return "not measured";
  default:
    return "";
  }
}

OrderedJson number_or_null(double v) { return std::isfinite(v) ? OrderedJson(v) : OrderedJson(); }
std::string in_thousandths(double v) { return shown(number_or_null(v), "{:.3f}"); }

/// Everything as one object: scores.json, and what the page is made of.
OrderedJson scores_of(const std::vector<ScoredCase> &cases, const std::string &round) {
  OrderedJson out = {
      {"round", round}, {"metrics", OrderedJson::array()}, {"cases", OrderedJson::array()}};
  for (const Metric &m : metrics_of(cases)) {
    const char *const to = m.low < 0.0 ? " to " : "–"; // no dash behind a minus sign
    const std::string interval =
        in_thousandths(m.low) + (std::isfinite(m.low) ? to + in_thousandths(m.high) : "");
    out["metrics"].push_back({{"name", m.name},
                              {"value", number_or_null(m.value)},
                              {"interval90", {number_or_null(m.low), number_or_null(m.high)}},
                              {"cases", m.cases},
                              {"truths", m.clusters},
                              {"gate", m.gate},
                              {"verdict", verdict_of(m)},
                              {"shown", in_thousandths(m.value)},
                              {"interval", interval}});
  }
  for (const auto &[truth, claims] : confusion_of(cases))
    for (const auto &[claim, n] : claims)
      out["confusion"][truth][claim] = n;
  for (const ScoredCase &c : cases)
    out["cases"].push_back(
        {{"id", c.id},
         {"block", c.block},
         {"samples", c.samples},
         {"truth", c.truth},
         {"claim", c.claim},
         {"most_probable", c.ranked(0)},
         {"probability_of_truth",
          number_or_null(c.probability.count(c.truth) ? c.probability.at(c.truth) : 0.0)},
         {"headline", c.headline},
         {"beside", c.beside},
         {"right_in_part", c.right_in_part()},
         {"signal_to_noise", c.signal_to_noise},
         {"paired", c.paired},
         {"places", c.places},
         {"true_places", c.true_places},
         {"shrinkage_predicted", number_or_null(c.predicted_shrinkage)},
         {"shrinkage_rerun", number_or_null(c.shrinkage)},
         {"shrinkage_placebo", number_or_null(c.placebo_shrinkage)},
         {"baselines", c.baselines}});
  out["note"] = "Truths made by the same program as the bank are withheld, not independent.";
  out["provenance"] = {{"calendem", version()}};
  return out;
}

std::string as_markdown(const OrderedJson &scores) {
  std::string out =
      fmt::format("# Withheld effects: {}\n\n{}\n\n| what | value | 90 % | cases | "
                  "truths | gate | |\n|---|---|---|---|---|---|---|\n",
                  scores["round"].get<std::string>(), scores["note"].get<std::string>());
  const auto text = [](const OrderedJson &row, const char *key) {
    return row[key].get<std::string>();
  };
  for (const OrderedJson &m : scores["metrics"])
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

std::string as_page(const OrderedJson &scores) {
  Json matrix = Json::array(), cases = scores["cases"];
  for (const auto &[truth, claims] : scores["confusion"].items())
    for (const auto &[claim, n] : claims.items())
      matrix.push_back({{"truth", truth}, {"claim", claim}, {"n", n.get<int>()}});
  for (Json &c : cases) {
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
  return report::to_html({kScoresHtml, scores, {{"matrix", matrix}, {"cases", cases}}});
}

} // namespace

void write_scores(const std::vector<ScoredCase> &cases, const std::string &round,
                  const std::string &folder) {
  const OrderedJson scores = scores_of(cases, round);
  const std::string table = as_markdown(scores);
  write_file(folder + "/scores.json", scores.dump(1) + "\n");
  write_file(folder + "/scores.md", table);
  write_file(folder + "/scores.html", as_page(scores));
  fmt::print("{}\npage: {}/scores.html\n", table, folder);
}

} // namespace calendem
