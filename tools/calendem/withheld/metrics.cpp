// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/scores.h"
#include "withheld/score.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <tuple>

namespace calendem {

namespace {

constexpr double kInterval = 0.9, kBounds = 0.8; // two-sided; bounds are one side of it at 90 %

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
    m.value = m.low = m.high = m.least = m.most = std::nan("");
    return m;
  }
  m.value = statistic(cases);
  const auto of_drawn = [&](const std::vector<int> &places) {
    Cases drawn;
    for (const int k : places)
      drawn.push_back(cases[std::size_t(k)]);
    return statistic(drawn);
  };
  std::tie(m.low, m.high) = inference::clustered_bootstrap(clusters, of_drawn, kInterval);
  std::tie(m.least, m.most) = inference::clustered_bootstrap(clusters, of_drawn, kBounds);
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

double calibration_error_of(const Cases &cases) {
  constexpr int kBins = 10;
  double stated[kBins] = {}, right[kBins] = {};
  for (const ScoredCase *c : cases) {
    const std::string first = c->ranked(0);
    const double p = first.empty() ? 0.0 : c->probability.at(first);
    const int bin = std::min(kBins - 1, int(p * kBins));
    stated[bin] += p;
    right[bin] += first == c->truth;
  }
  double sum = 0.0;
  for (int k = 0; k < kBins; ++k)
    sum += std::fabs(stated[k] - right[k]);
  return sum / double(cases.size());
}

double localisation_f1_of(const Cases &cases) {
  double common = 0.0, all = 0.0;
  for (const ScoredCase *c : cases) {
    for (const std::string &place : c->places)
      common += double(c->true_places.count(place));
    all += double(c->places.size() + c->true_places.size());
  }
  return all > 0.0 ? 2.0 * common / all : std::nan("");
}

std::string ScoredCase::ranked(int n) const {
  std::vector<std::pair<double, std::string>> order;
  for (const auto &[name, p] : probability)
    order.emplace_back(-p, name);
  std::sort(order.begin(), order.end());
  return n < int(order.size()) ? order[std::size_t(n)].second : "";
}

bool ScoredCase::right_in_part() const {
  return std::any_of(beside.begin(), beside.end(), [&](const std::string &other) {
    return truth == claim + " + " + other || truth == other + " + " + claim;
  });
}

Metric share_of(const std::string &name, const std::vector<ScoredCase> &all, const CaseTest &chosen,
                const CaseTest &hit) {
  Metric m = statistic_of(name, chosen_of(all, chosen), [&](const Cases &drawn) {
    const auto hits = std::count_if(drawn.begin(), drawn.end(), [&](auto *c) { return hit(*c); });
    return double(hits) / double(drawn.size());
  });
  if (m.value == 0.0 || m.value == 1.0) {
    const int hits = m.value == 0.0 ? 0 : m.clusters;
    std::tie(m.low, m.high) = inference::clopper_pearson(hits, m.clusters, kInterval);
    std::tie(m.least, m.most) = inference::clopper_pearson(hits, m.clusters, kBounds);
  }
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
/// Claims that can be right or wrong: one that is right in part is neither.
bool judged_claim(const ScoredCase &c) { return names_something(c) && !c.right_in_part(); }
bool wrong(const ScoredCase &c) { return c.claim != c.truth; }
bool run_again(const ScoredCase &c) {
  return std::isfinite(c.predicted_shrinkage) && std::isfinite(c.shrinkage);
}
bool single(const ScoredCase &c, double least, double most = INFINITY) {
  return c.block == "single" && c.signal_to_noise >= least && c.signal_to_noise < most;
}
bool strong_single(const ScoredCase &c) { return single(c, kStrongEnough); }
bool holds(const ScoredCase &c) {
  return std::find(c.set95.begin(), c.set95.end(), c.truth) != c.set95.end();
}
/// No effect of the table, and not too weak.
bool visible_open(const ScoredCase &c) {
  return c.block == "open" && c.paired && c.signal_to_noise >= kVisible;
}

Metric judged(Metric m, const char *gate, double least, double most = INFINITY) {
  m.gate = gate;
  const auto within = [&](double low, double high) { return low >= least && high <= most; };
  m.verdict = std::isnan(m.value)         ? Metric::not_measured
              : !within(m.value, m.value) ? Metric::missed
              : within(m.least, m.most)   ? Metric::met
                                          : Metric::not_shown;
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

void add_gates_of_answers(const All &cases, std::vector<Metric> &out) {
  const auto add = [&](Metric m, const char *gate, double least, double most = INFINITY) {
    out.push_back(judged(std::move(m), gate, least, most));
  };
  const auto share = [&](const char *name, const CaseTest &chosen, const CaseTest &hit) {
    return share_of(name, cases, chosen, hit);
  };
  add(statistic_of("where: F1 of the places reported, effects of signal-to-noise >= 6",
                   chosen_of(cases, [](const auto &c) { return strong_single(c) && c.paired; }),
                   localisation_f1_of),
      ">= 0.80", 0.80);
  add(share("which, top-1, effects of signal-to-noise >= 6", strong_single, right), ">= 0.85",
      0.85);
  add(share("which, top-2, effects of signal-to-noise >= 6", strong_single,
            [](const auto &c) { return right(c) || c.ranked(1) == c.truth; }),
      ">= 0.95", 0.95);
  add(share(
          "claimed right or in the 95 % set, effects of signal-to-noise 3 to 6",
          [](const auto &c) { return single(c, kVisible, kStrongEnough); },
          [](const auto &c) { return c.claim == c.truth || holds(c); }),
      ">= 0.80", 0.80);
  add(share("wrong share among claims of an effect, noise or unknown", judged_claim, wrong),
      "<= 0.05", -INFINITY, 0.05);
  add(share("false claims on nulls", in_block({"null"}), names_something), "<= 0.03", -INFINITY,
      0.03);
  add(share("no effect of the table, signal-to-noise >= 3: unknown or undecided", visible_open,
            [](const auto &c) { return c.claim == "unknown" || c.claim == "undecided"; }),
      ">= 0.90", 0.90);
  add(share("no effect of the table, signal-to-noise >= 3: nothing to see", visible_open,
            [](const auto &c) { return c.claim == "none"; }),
      "<= 0.10", -INFINITY, 0.10);
  add(statistic_of("unknown against known, signal-to-noise >= 3: area under the ROC curve",
                   chosen_of(cases,
                             [](const auto &c) {
                               return c.signal_to_noise >= kVisible &&
                                      in_block({"single", "fault", "open", "left_out"})(c);
                             }),
                   auroc_of_unknown),
      ">= 0.90", 0.90);
}

void add_gates_of_numbers(const All &cases, std::vector<Metric> &out) {
  const auto add = [&](Metric m, const char *gate, double least, double most = INFINITY) {
    out.push_back(judged(std::move(m), gate, least, most));
  };
  const auto share = [&](const char *name, const CaseTest &chosen, const CaseTest &hit) {
    return share_of(name, cases, chosen, hit);
  };
  for (const char *headline : {"explained", "one of these", "something else", "nothing to see"})
    add(statistic_of(
            fmt::format("90 % intervals of base parameters that hold the truth, answer \"{}\"",
                        headline),
            chosen_of(cases,
                      [&](const auto &c) { return c.headline == headline && !c.covered.empty(); }),
            [](const Cases &d) { return share_covered(d, &ScoredCase::covered); }),
        "0.85-0.95", 0.85, 0.95);
  add(share("shrinkage: predicted within the rerun's 90 % interval", run_again,
            [](const auto &c) {
              return c.predicted_shrinkage >= c.least_shrinkage &&
                     c.predicted_shrinkage <= c.most_shrinkage;
            }),
      ">= 0.85", 0.85);
  add(share("shrinkage within 10 points of the rerun", run_again,
            [](const auto &c) { return std::fabs(c.predicted_shrinkage - c.shrinkage) <= 0.1; }),
      ">= 0.80", 0.80);
  add(share(
          "shrinkage: the placebo shrinks the gap less than the effect",
          [](const auto &c) { return run_again(c) && std::isfinite(c.placebo_shrinkage); },
          [](const auto &c) { return c.placebo_shrinkage < c.shrinkage; }),
      ">= 0.90", 0.90);
  add(statistic_of("expected calibration error of the most probable hypothesis",
                   chosen_of(cases, [](const auto &c) { return c.block != "left_out"; }),
                   calibration_error_of),
      "<= 0.05", -INFINITY, 0.05);
}

void add_reported(const All &cases, std::vector<Metric> &out) {
  const auto claims_right = [](const ScoredCase &c) { return c.claim == c.truth; };
  const CaseTest known = in_block({"null", "single", "fault"});
  for (const auto &[name, intervals] :
       {std::pair("95 % intervals of base parameters over all hypotheses that hold the truth",
                  &ScoredCase::covered_by_average),
        std::pair("90 % intervals of amplitudes that hold the truth",
                  &ScoredCase::covered_amplitude)}) {
    const auto which = intervals;
    const bool of_amplitude = which == &ScoredCase::covered_amplitude;
    const Cases chosen = chosen_of(cases, [&](const auto &c) {
      return !(c.*which).empty() && (!of_amplitude || (known(c) && right(c)));
    });
    out.push_back(
        statistic_of(name, chosen, [&](const Cases &d) { return share_covered(d, which); }));
  }
  out.push_back(share_of("which, top-1, all single effects", cases, in_block({"single"}), right));
  out.push_back(share_of("which, top-2, all single effects", cases, in_block({"single"}),
                         [](const auto &c) { return right(c) || c.ranked(1) == c.truth; }));
  const auto between = [&](const char *name, double low, double high) {
    out.push_back(share_of(
        std::string("which, top-1, single effects ") + name, cases,
        [=](const auto &c) { return single(c, low, high); }, right));
  };
  between("below their limit against none", 0.0, kDetectable);
  between("from there to signal-to-noise 6", kDetectable, kStrongEnough);
  out.push_back(share_of("pair: a measurement that would decide is named", cases,
                         in_block({"pair"}), [](const auto &c) { return c.next_named; }));
  out.push_back(share_of("pair: claimed in part, the other half not excluded", cases,
                         in_block({"pair"}), [](const auto &c) { return c.right_in_part(); }));
  out.push_back(share_of("wrong share among claims, were those in part wrong", cases,
                         names_something, wrong));
  out.push_back(share_of("nulls: none claimed", cases, in_block({"null"}), claims_right));
  out.push_back(share_of("nulls: a block beyond the threshold", cases, in_block({"null"}),
                         [](const auto &c) { return !c.places.empty(); }));
  for (const char *block : {"single", "open", "left_out", "pair", "fault", "other"}) {
    out.push_back(
        share_of(std::string(block) + ": claimed right", cases, in_block({block}), claims_right));
    out.push_back(share_of(std::string(block) + ": claimed wrong", cases, in_block({block}),
                           [](const auto &c) { return wrong(c) && judged_claim(c); }));
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
                       : ours <= best                           ? Metric::missed
                       : out[place].least > best                ? Metric::met
                                                                : Metric::not_shown;
}

} // namespace

std::vector<Metric> metrics_of(const All &cases) {
  std::vector<Metric> out;
  add_gates_of_answers(cases, out);
  add_gates_of_numbers(cases, out);
  add_reported(cases, out);
  add_baselines(cases, out);
  return out;
}

} // namespace calendem
