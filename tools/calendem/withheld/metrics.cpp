// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/scores.h"
#include "withheld/score.h"
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace calendem {

namespace {

std::vector<int> clusters_of(const Cases &cases) {
  std::vector<int> out;
  for (const ScoredCase *c : cases)
    out.push_back(c->cluster);
  return out;
}

/// Probabilities of the cases over all hypotheses that any of them, or their truths, name.
struct Table {
  std::vector<std::vector<double>> probability;
  std::vector<int> truth;
  std::vector<std::string> names;
};

Table table_of(const Cases &cases) {
  std::set<std::string> names;
  for (const ScoredCase *c : cases) {
    names.insert(c->truth);
    for (const auto &p : c->probability)
      names.insert(p.first);
  }
  Table t;
  t.names.assign(names.begin(), names.end());
  for (const ScoredCase *c : cases) {
    t.probability.emplace_back();
    for (const std::string &name : t.names) {
      const auto at = c->probability.find(name);
      t.probability.back().push_back(at == c->probability.end() ? 0.0 : at->second);
    }
    t.truth.push_back(int(std::find(t.names.begin(), t.names.end(), c->truth) - t.names.begin()));
  }
  return t;
}

} // namespace

Cases chosen_of(const std::vector<ScoredCase> &cases, const CaseTest &chosen) {
  Cases out;
  for (const ScoredCase &c : cases)
    if (chosen(c))
      out.push_back(&c);
  return out;
}

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

double log_score_of(const Cases &cases) {
  const Table t = table_of(cases);
  return inference::log_score(t.probability, t.truth);
}

double brier_skill_of(const Cases &cases) {
  const Table t = table_of(cases);
  std::vector<double> frequency(t.names.size(), 0.0);
  for (const int truth : t.truth)
    frequency[std::size_t(truth)] += 1.0 / double(t.truth.size());
  if (std::count(t.truth.begin(), t.truth.end(), t.truth.front()) == std::ptrdiff_t(t.truth.size()))
    return std::nan(""); // the frequencies are right already
  return inference::brier_skill(t.probability, t.truth, frequency);
}

double auroc_of_unknown(const Cases &cases) {
  std::vector<double> score;
  std::vector<bool> unknown;
  for (const ScoredCase *c : cases) {
    const auto at = c->probability.find("unknown");
    score.push_back(at == c->probability.end() ? 0.0 : at->second);
    unknown.push_back(c->truth == "unknown");
  }
  return inference::auroc(score, unknown);
}

std::string ScoredCase::ranked(int n) const {
  std::vector<std::pair<double, std::string>> order;
  for (const auto &[name, p] : probability)
    order.emplace_back(-p, name);
  std::sort(order.begin(), order.end());
  return n < int(order.size()) ? order[std::size_t(n)].second : "";
}

Metric share_of(const std::string &name, const std::vector<ScoredCase> &all, const CaseTest &chosen,
                const CaseTest &hit) {
  Metric m = statistic_of(name, chosen_of(all, chosen), [&](const Cases &drawn) {
    const auto hits = std::count_if(drawn.begin(), drawn.end(), [&](auto *c) { return hit(*c); });
    return double(hits) / double(drawn.size());
  });
  if (m.value == 0.0 || m.value == 1.0)
    std::tie(m.low, m.high) =
        inference::clopper_pearson(m.value == 0.0 ? 0 : m.clusters, m.clusters);
  return m;
}

std::map<std::string, std::map<std::string, int>>
confusion_of(const std::vector<ScoredCase> &cases) {
  std::map<std::string, std::map<std::string, int>> out;
  for (const ScoredCase &c : cases)
    ++out[c.block == "left_out" ? "unknown (left out)" : c.truth][c.claim];
  return out;
}

// The gates of the sealed check, what is reported beside them, and the baselines.

namespace {

using All = std::vector<ScoredCase>;

CaseTest in_block(const std::set<std::string> &blocks) {
  return [blocks](const ScoredCase &c) { return blocks.count(c.block) > 0; };
}
bool right(const ScoredCase &c) { return c.ranked(0) == c.truth; }
bool names_something(const ScoredCase &c) { return c.claim != "undecided" && c.claim != "none"; }
bool run_again(const ScoredCase &c) {
  return std::isfinite(c.predicted_shrinkage) && std::isfinite(c.shrinkage);
}
bool strong_single(const ScoredCase &c) {
  return c.block == "single" && c.signal_to_noise >= kStrongEnough;
}

Metric judged(Metric m, const char *gate, double least, double most = INFINITY) {
  m.gate = gate;
  m.verdict = std::isnan(m.value)                   ? Metric::not_measured
              : m.value >= least && m.value <= most ? Metric::met
                                                    : Metric::missed;
  m.certain = m.low >= least && m.high <= most;
  return m;
}

double share_covered(const Cases &cases, std::vector<bool> ScoredCase::*which) {
  double in = 0.0, all = 0.0;
  for (const ScoredCase *c : cases)
    for (const bool covered : c->*which) {
      in += covered;
      all += 1.0;
    }
  return all > 0.0 ? in / all : std::nan("");
}

/// Mean of the shares identified correctly of nulls and of the effects.
double balanced(const Cases &cases, const std::function<std::string(const ScoredCase &)> &named) {
  double right[2] = {0.0, 0.0}, all[2] = {0.0, 0.0};
  for (const ScoredCase *c : cases) {
    const int kind = c->block == "null" ? 0 : 1;
    right[kind] += named(*c) == c->truth;
    all[kind] += 1.0;
  }
  return 0.5 * (right[0] / all[0] + right[1] / all[1]);
}

void add_gates(const All &cases, std::vector<Metric> &out) {
  const CaseTest known = in_block({"null", "single", "fault"});
  out.push_back(judged(share_of("where: a block lies beyond the threshold, effects of "
                                "signal-to-noise >= 6",
                                cases, strong_single, [](const auto &c) { return c.located; }),
                       ">= 0.80", 0.80));
  out.push_back(
      judged(share_of("which, top-1, effects of signal-to-noise >= 6", cases, strong_single, right),
             ">= 0.85", 0.85));
  out.push_back(
      judged(share_of("which, top-2, effects of signal-to-noise >= 6", cases, strong_single,
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
  out.push_back(judged(
      share_of("shrinkage within 10 points of the rerun", cases, run_again,
               [](const auto &c) { return std::fabs(c.predicted_shrinkage - c.shrinkage) <= 0.1; }),
      ">= 0.80", 0.80));
  for (const auto &[name, intervals] :
       {std::pair("90 % intervals of base parameters that hold the truth", &ScoredCase::covered),
        std::pair("90 % intervals of amplitudes that hold the truth",
                  &ScoredCase::covered_amplitude)}) {
    const auto which = intervals;
    const Cases right_ones = chosen_of(
        cases, [&](const auto &c) { return known(c) && right(c) && !(c.*which).empty(); });
    out.push_back(judged(
        statistic_of(name, right_ones, [&](const Cases &d) { return share_covered(d, which); }),
        "0.80-0.97", 0.80, 0.97));
  }
}

void add_reported(const All &cases, std::vector<Metric> &out) {
  const auto claims_right = [](const ScoredCase &c) { return c.claim == c.truth; };
  const auto holds = [](const ScoredCase &c) {
    return std::find(c.set95.begin(), c.set95.end(), c.truth) != c.set95.end();
  };
  out.push_back(statistic_of("unknown against known, effects of signal-to-noise >= 6 and the same "
                             "left out: area under the ROC curve",
                             chosen_of(cases,
                                       [](const auto &c) {
                                         return c.signal_to_noise >= kStrongEnough &&
                                                (c.block == "single" || c.block == "left_out");
                                       }),
                             auroc_of_unknown));
  out.push_back(share_of("shrinkage: predicted within the rerun's 90 % interval", cases, run_again,
                         [](const auto &c) {
                           return c.predicted_shrinkage >= c.least_shrinkage &&
                                  c.predicted_shrinkage <= c.most_shrinkage;
                         }));
  out.push_back(share_of(
      "shrinkage: the placebo shrinks the gap less than the effect", cases,
      [](const auto &c) { return run_again(c) && std::isfinite(c.placebo_shrinkage); },
      [](const auto &c) { return c.placebo_shrinkage < c.shrinkage; }));
  out.push_back(share_of("which, top-1, all single effects", cases, in_block({"single"}), right));
  out.push_back(share_of("which, top-2, all single effects", cases, in_block({"single"}),
                         [](const auto &c) { return right(c) || c.ranked(1) == c.truth; }));
  const auto between = [&](const char *name, double low, double high) {
    out.push_back(share_of(
        std::string("which, top-1, single effects ") + name, cases,
        [=](const auto &c) {
          return c.block == "single" && c.signal_to_noise >= low && c.signal_to_noise < high;
        },
        right));
  };
  between("below their limit against none", 0.0, kDetectable);
  between("from there to signal-to-noise 6", kDetectable, kStrongEnough);
  out.push_back(share_of("pair: a measurement that would decide is named", cases,
                         in_block({"pair"}), [](const auto &c) { return c.next_named; }));
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

void add_baselines(const All &cases, std::vector<Metric> &out) {
  const Cases known = chosen_of(cases, in_block({"null", "single", "fault"}));
  const auto add = [&](const std::string &who, const auto &named) {
    out.push_back(statistic_of("identified correctly, mean of nulls and effects: " + who, known,
                               [&](const Cases &d) { return balanced(d, named); }));
    return out.back().value;
  };
  const std::size_t place = out.size();
  const double ours = add("the diagnosis", [](const ScoredCase &c) { return c.ranked(0); });
  double best = -INFINITY;
  if (!known.empty())
    for (const auto &[name, unused] : known.front()->baselines)
      best = std::max(best, add(name, [n = name](const ScoredCase &c) {
                        const auto at = c.baselines.find(n);
                        return at == c.baselines.end() ? std::string() : at->second;
                      }));
  out[place].gate = "> every baseline";
  out[place].verdict = std::isnan(ours) || !std::isfinite(best) ? Metric::not_measured
                       : ours > best                            ? Metric::met
                                                                : Metric::missed;
  out[place].certain = out[place].low > best;
}

} // namespace

std::vector<Metric> metrics_of(const All &cases) {
  std::vector<Metric> out;
  add_gates(cases, out);
  add_reported(cases, out);
  add_baselines(cases, out);
  return out;
}

} // namespace calendem
