// SPDX-License-Identifier: GPL-2.0-or-later
// The gates of the sealed check, what is reported beside them, and the baselines.
#include "sealed/round_file.h"
#include "sealed/score.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace calendem {

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
  add(statistic_of("where: F1 of the places reported, effects of signal-to-noise ≥ 6",
                   chosen_of(cases, [](const auto &c) { return strong_single(c) && c.paired; }),
                   localisation_f1_of),
      "≥ 0.80", 0.80);
  add(share("which, top-1, effects of signal-to-noise ≥ 6", strong_single, right), "≥ 0.85", 0.85);
  add(share("which, top-2, effects of signal-to-noise ≥ 6", strong_single,
            [](const auto &c) { return right(c) || c.ranked(1) == c.truth; }),
      "≥ 0.95", 0.95);
  add(share(
          "claimed right or in the 95 % set, effects of signal-to-noise 3–6",
          [](const auto &c) { return single(c, kVisible, kStrongEnough); },
          [](const auto &c) { return c.claim == c.truth || holds(c); }),
      "≥ 0.80", 0.80);
  add(share("wrong share among claims of an effect, noise or unknown", judged_claim, wrong),
      "≤ 0.05", -INFINITY, 0.05);
  add(share("false claims on nulls", in_block({"null"}), names_something), "≤ 0.03", -INFINITY,
      0.03);
  add(share("no effect of the table, signal-to-noise ≥ 3: unknown or undecided", visible_open,
            [](const auto &c) { return c.claim == "unknown" || c.claim == "undecided"; }),
      "≥ 0.90", 0.90);
  add(share("no effect of the table, signal-to-noise ≥ 3: nothing to see", visible_open,
            [](const auto &c) { return c.claim == "none"; }),
      "≤ 0.10", -INFINITY, 0.10);
  add(statistic_of("unknown against known, signal-to-noise ≥ 3: area under the ROC curve",
                   chosen_of(cases,
                             [](const auto &c) {
                               return c.signal_to_noise >= kVisible &&
                                      in_block({"single", "fault", "open", "left_out"})(c);
                             }),
                   auroc_of_unknown),
      "≥ 0.90", 0.90);
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
        "0.85–0.95", 0.85, 0.95);
  add(share("shrinkage: predicted within the rerun's 90 % interval", run_again,
            [](const auto &c) {
              return c.predicted_shrinkage >= c.least_shrinkage &&
                     c.predicted_shrinkage <= c.most_shrinkage;
            }),
      "≥ 0.85", 0.85);
  add(share("shrinkage within 10 points of the rerun", run_again,
            [](const auto &c) { return std::fabs(c.predicted_shrinkage - c.shrinkage) <= 0.1; }),
      "≥ 0.80", 0.80);
  add(share(
          "shrinkage: the placebo shrinks the gap less than the effect",
          [](const auto &c) { return run_again(c) && std::isfinite(c.placebo_shrinkage); },
          [](const auto &c) { return c.placebo_shrinkage < c.shrinkage; }),
      "≥ 0.90", 0.90);
  add(statistic_of("expected calibration error of the most probable hypothesis",
                   chosen_of(cases, [](const auto &c) { return c.block != "left_out"; }),
                   calibration_error_of),
      "≤ 0.05", -INFINITY, 0.05);
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

void add_interventions(const All &cases, std::vector<Metric> &out) {
  const CaseTest any = [](const ScoredCase &) { return true; },
                 nothing = [](const ScoredCase &c) { return c.truth == "none"; },
                 change = [&](const ScoredCase &c) { return !nothing(c); };
  const auto add = [&](const char *name, const CaseTest &chosen, const CaseTest &hit) {
    out.push_back(share_of(name, cases, chosen, hit));
  };
  add("intervention: the most probable is right", any, right);
  add("intervention: claimed right where something changed", change,
      [](const auto &c) { return c.claim == c.truth; });
  add("intervention: the 95 % set holds the truth", any, holds);
  add(
      "intervention: wrong share among claims where something changed",
      [&](const auto &c) { return change(c) && judged_claim(c); }, wrong);
  add("intervention: a change claimed where nothing changed", nothing, names_something);
  out.push_back(statistic_of(
      "intervention: 90 % intervals of amplitudes that hold the truth",
      chosen_of(cases, [](const auto &c) { return right(c) && !c.covered_amplitude.empty(); }),
      [](const Cases &d) { return share_covered(d, &ScoredCase::covered_amplitude); }));
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

/// Where a round has samples of several sizes.
void add_by_size(const All &cases, std::vector<Metric> &out) {
  std::set<int> sizes;
  for (const ScoredCase &c : cases)
    sizes.insert(c.samples);
  if (sizes.size() < 2)
    return;
  for (const char *block : {"null", "single", "open", "fault", kIntervention})
    for (const int size : sizes)
      out.push_back(share_of(
          fmt::format("{}: claimed right, samples of {} cells", block, size), cases,
          [&](const auto &c) { return c.block == block && c.samples == size; },
          [](const auto &c) { return c.claim == c.truth; }));
}

} // namespace

std::vector<Metric> metrics_of(const All &cases) {
  std::vector<Metric> out;
  All alone, changes; // experiments by themselves, and interventions
  for (const ScoredCase &c : cases)
    (c.block == kIntervention ? changes : alone).push_back(c);
  add_gates_of_answers(alone, out);
  add_gates_of_numbers(alone, out);
  add_reported(alone, out);
  add_baselines(alone, out);
  if (!changes.empty())
    add_interventions(changes, out);
  add_by_size(cases, out);
  return out;
}

} // namespace calendem
