// SPDX-License-Identifier: GPL-2.0-or-later
#include "withheld/metrics.h"
#include "inference/scores.h"
#include <algorithm>
#include <cmath>
#include <set>

namespace calendem {
namespace {

using Cases = std::vector<ScoredCase>;
using Test = std::function<bool(const ScoredCase &)>;

Test in_block(const std::set<std::string> &blocks) {
  return [blocks](const ScoredCase &c) { return blocks.count(c.block) > 0; };
}
bool right(const ScoredCase &c) { return c.ranked(0) == c.truth; }
bool names_something(const ScoredCase &c) { return c.claim != "undecided" && c.claim != "none"; }
bool loud_single(const ScoredCase &c) {
  return c.block == "single" && c.signal_to_noise >= kLoudEnough;
}

Cases chosen_of(const Cases &cases, const Test &chosen) {
  Cases out;
  std::copy_if(cases.begin(), cases.end(), std::back_inserter(out), chosen);
  return out;
}

std::vector<int> clusters_of(const Cases &cases) {
  std::vector<int> out;
  for (const ScoredCase &c : cases)
    out.push_back(c.cluster);
  return out;
}

/// A statistic of the cases, its interval by drawing clusters.
Metric statistic_of(const std::string &name, const Cases &cases,
                    const std::function<double(const Cases &)> &statistic) {
  const std::vector<int> clusters = clusters_of(cases);
  Metric m;
  m.name = name;
  m.cases = int(cases.size());
  m.clusters = int(std::set<int>(clusters.begin(), clusters.end()).size());
  if (cases.empty()) {
    m.value = m.low = m.high = std::nan("");
    return m;
  }
  m.value = statistic(cases);
  std::tie(m.low, m.high) =
      inference::clustered_bootstrap(clusters, [&](const std::vector<int> &places) {
        Cases drawn;
        for (const int k : places)
          drawn.push_back(cases[std::size_t(k)]);
        return statistic(drawn);
      });
  return m;
}

Metric judged(Metric m, const char *gate, double least, double most = INFINITY) {
  m.gate = gate;
  m.verdict = std::isnan(m.value)                   ? Metric::not_measured
              : m.value >= least && m.value <= most ? Metric::met
                                                    : Metric::missed;
  return m;
}

/// Probabilities of the cases over all hypotheses that any of them, or their truths, name.
struct Table {
  std::vector<std::vector<double>> probability;
  std::vector<int> truth;
  std::vector<std::string> names;
};

Table table_of(const Cases &cases) {
  std::set<std::string> names;
  for (const ScoredCase &c : cases) {
    names.insert(c.truth);
    for (const auto &p : c.probability)
      names.insert(p.first);
  }
  Table t;
  t.names.assign(names.begin(), names.end());
  for (const ScoredCase &c : cases) {
    t.probability.emplace_back();
    for (const std::string &name : t.names) {
      const auto at = c.probability.find(name);
      t.probability.back().push_back(at == c.probability.end() ? 0.0 : at->second);
    }
    t.truth.push_back(int(std::find(t.names.begin(), t.names.end(), c.truth) - t.names.begin()));
  }
  return t;
}

double log_score_of(const Cases &cases) {
  const Table t = table_of(cases);
  return inference::log_score(t.probability, t.truth);
}

/// Against always giving the round's own frequencies: the best that knows nothing of the data.
double brier_skill_of(const Cases &cases) {
  const Table t = table_of(cases);
  std::vector<double> frequency(t.names.size(), 0.0);
  for (const int truth : t.truth)
    frequency[std::size_t(truth)] += 1.0 / double(t.truth.size());
  return inference::brier_skill(t.probability, t.truth, frequency);
}

double auroc_of_unknown(const Cases &cases) {
  std::vector<double> score;
  std::vector<bool> unknown;
  for (const ScoredCase &c : cases) {
    const auto at = c.probability.find("unknown");
    score.push_back(at == c.probability.end() ? 0.0 : at->second);
    unknown.push_back(c.truth == "unknown");
  }
  return inference::auroc(score, unknown);
}

double share_covered(const Cases &cases, std::vector<bool> ScoredCase::*which) {
  double in = 0.0, all = 0.0;
  for (const ScoredCase &c : cases)
    for (const bool covered : c.*which) {
      in += covered;
      all += 1.0;
    }
  return all > 0.0 ? in / all : std::nan("");
}

/// Mean of the shares told right of nulls and of the effects.
double balanced(const Cases &cases, const std::function<std::string(const ScoredCase &)> &named) {
  double right[2] = {0.0, 0.0}, all[2] = {0.0, 0.0};
  for (const ScoredCase &c : cases) {
    const int kind = c.block == "null" ? 0 : 1;
    right[kind] += named(c) == c.truth;
    all[kind] += 1.0;
  }
  return 0.5 * (right[0] / all[0] + right[1] / all[1]);
}

void add_gates(const Cases &cases, std::vector<Metric> &out) {
  const Test known = in_block({"null", "single", "fault"});
  out.push_back(judged(share_of("where: a block lies beyond the threshold, effects of "
                                "signal-to-noise >= 6",
                                cases, loud_single, [](const auto &c) { return c.located; }),
                       ">= 0.80", 0.80));
  out.push_back(
      judged(share_of("which, top-1, effects of signal-to-noise >= 6", cases, loud_single, right),
             ">= 0.85", 0.85));
  out.push_back(judged(share_of("which, top-2, effects of signal-to-noise >= 6", cases, loud_single,
                                [](const auto &c) { return right(c) || c.ranked(1) == c.truth; }),
                       ">= 0.95", 0.95));
  out.push_back(judged(share_of("wrong share among claims of an effect, noise or unknown", cases,
                                names_something, [](const auto &c) { return c.claim != c.truth; }),
                       "<= 0.10", 0.0, 0.10));
  out.push_back(
      judged(share_of("false claims on nulls", cases, in_block({"null"}), names_something),
             "<= 0.03", 0.0, 0.03));
  out.push_back(
      judged(statistic_of("unknown against known: area under the ROC curve",
                          chosen_of(cases, in_block({"single", "fault", "open", "left_out"})),
                          auroc_of_unknown),
             ">= 0.90", 0.90));
  Metric shrink = statistic_of("shrinkage within 10 points of the rerun", {}, log_score_of);
  out.push_back(judged(shrink, ">= 0.80", 0.80));
  const Cases told = chosen_of(cases, [&](const auto &c) { return known(c) && right(c); });
  for (const auto &[name, which] :
       {std::pair("90 % intervals of base parameters that hold the truth", &ScoredCase::covered),
        std::pair("90 % intervals of amplitudes that hold the truth",
                  &ScoredCase::covered_amplitude)}) {
    const Cases with = chosen_of(told, [w = which](const auto &c) { return !(c.*w).empty(); });
    out.push_back(judged(
        statistic_of(name, with, [w = which](const Cases &d) { return share_covered(d, w); }),
        "0.80-0.97", 0.80, 0.97));
  }
}

void add_reported(const Cases &cases, std::vector<Metric> &out) {
  const auto claims_right = [](const ScoredCase &c) { return c.claim == c.truth; };
  const auto holds = [](const ScoredCase &c) {
    return std::find(c.set95.begin(), c.set95.end(), c.truth) != c.set95.end();
  };
  out.push_back(share_of("which, top-1, all single effects", cases, in_block({"single"}), right));
  out.push_back(share_of("which, top-2, all single effects", cases, in_block({"single"}),
                         [](const auto &c) { return right(c) || c.ranked(1) == c.truth; }));
  out.push_back(share_of("nulls: none claimed", cases, in_block({"null"}), claims_right));
  out.push_back(share_of("nulls: a block beyond the threshold", cases, in_block({"null"}),
                         [](const auto &c) { return c.located; }));
  for (const char *block : {"single", "open", "left_out", "pair", "fault", "other"}) {
    out.push_back(
        share_of(std::string(block) + ": claimed right", cases, in_block({block}), claims_right));
    out.push_back(share_of(std::string(block) + ": claimed wrong", cases, in_block({block}),
                           [](const auto &c) { return c.claim != c.truth && names_something(c); }));
    out.push_back(share_of(std::string(block) + ": the 95 % set holds the truth", cases,
                           in_block({block}), holds));
  }
  const Cases given = chosen_of(cases, [](const auto &c) { return c.block != "left_out"; });
  out.push_back(statistic_of("log score, nats (0 is perfect)", given, log_score_of));
  out.push_back(
      statistic_of("Brier skill over the round's own frequencies", given, brier_skill_of));
}

void add_baselines(const Cases &cases, std::vector<Metric> &out) {
  const Cases known = chosen_of(cases, in_block({"null", "single", "fault"}));
  const auto add = [&](const std::string &who, const auto &named) {
    out.push_back(statistic_of("told right, mean of nulls and effects: " + who, known,
                               [&](const Cases &d) { return balanced(d, named); }));
    return out.back().value;
  };
  const double ours = add("the diagnosis", [](const ScoredCase &c) { return c.ranked(0); });
  const std::size_t place = out.size() - 1;
  double best = -INFINITY;
  if (!known.empty())
    for (const auto &[name, unused] : known.front().baselines)
      best = std::max(best, add(name, [n = name](const ScoredCase &c) {
                        const auto at = c.baselines.find(n);
                        return at == c.baselines.end() ? std::string() : at->second;
                      }));
  out[place].gate = "> every baseline";
  out[place].verdict = std::isnan(ours) || !std::isfinite(best) ? Metric::not_measured
                       : ours > best                            ? Metric::met
                                                                : Metric::missed;
}

} // namespace

std::string ScoredCase::ranked(int n) const {
  std::vector<std::pair<double, std::string>> order;
  for (const auto &[name, p] : probability)
    order.emplace_back(-p, name);
  std::sort(order.begin(), order.end());
  return n < int(order.size()) ? order[std::size_t(n)].second : "";
}

Metric share_of(const std::string &name, const Cases &all, const Test &chosen, const Test &hit) {
  const Cases cases = chosen_of(all, chosen);
  Metric m = statistic_of(name, cases, [&](const Cases &drawn) {
    return double(std::count_if(drawn.begin(), drawn.end(), hit)) / double(drawn.size());
  });
  if (m.value == 0.0 || m.value == 1.0)
    std::tie(m.low, m.high) =
        inference::clopper_pearson(m.value == 0.0 ? 0 : m.clusters, m.clusters);
  return m;
}

std::map<std::string, std::map<std::string, int>> confusion_of(const Cases &cases) {
  std::map<std::string, std::map<std::string, int>> out;
  for (const ScoredCase &c : cases)
    ++out[c.block == "left_out" ? "unknown (left out)" : c.truth][c.claim];
  return out;
}

std::vector<Metric> metrics_of(const Cases &cases) {
  std::vector<Metric> out;
  add_gates(cases, out);
  add_reported(cases, out);
  add_baselines(cases, out);
  return out;
}

} // namespace calendem
