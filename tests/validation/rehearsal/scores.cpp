// SPDX-License-Identifier: GPL-2.0-or-later
#include "scores.h"
#include "inference/quantities.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

using inference::Change;
using inference::Verdict;
namespace {

constexpr double kStrongSignal = 6.0, kMiddlingSignal = 3.0;

bool is_true(const Truth &truth, const std::string &name) {
  return std::find(truth.changes.begin(), truth.changes.end(), name) != truth.changes.end();
}

/// The change of an effect or of the press that is the most probable.
std::string first_of(const Diagnosis &d) {
  int first = -1;
  for (int k = 0; k < int(d.changes.all.size()); ++k)
    if (d.changes.all[std::size_t(k)].effect >= 0 &&
        (first < 0 ||
         d.changes.all[std::size_t(k)].probability > d.changes.all[std::size_t(first)].probability))
      first = k;
  return first < 0 ? "" : name_of(d, first);
}

/// The change is in one of the sets that reach 95 %.
bool is_possible(const Diagnosis &d, const Truth &truth) {
  return std::any_of(d.sets.begin(), d.sets.end(), [&](const inference::ChangeSet &set) {
    return std::any_of(set.changes.begin(), set.changes.end(),
                       [&](int k) { return is_true(truth, name_of(d, k)); });
  });
}

} // namespace

double signal_of(const Diagnosis &d) {
  const auto at = first_datum(d);
  const auto n = Eigen::Index(d.readings.size());
  const inference::Vector r = d.model.residual.segment(at, n);
  const double square = r.dot(inference::Cholesky(d.model.expected.block(at, at, n, n)).solve(r));
  return std::sqrt(std::max(0.0, square - double(n)));
}

Answer answer_of(const Diagnosis &d) {
  Answer out{"diagnose", {}, d.verdict.kind != Verdict::one_of};
  if (d.verdict.kind == Verdict::something_else)
    out.named.push_back("unknown");
  else if (d.verdict.kind != Verdict::nothing_seen)
    for (const int k : d.verdict.changes)
      out.named.push_back(name_of(d, k));
  return out;
}

void Scores::add(const Truth &truth, double signal, const Answer &answer, const Diagnosis &d) {
  const auto hit = [&](const std::string &name) { return is_true(truth, name); };
  const bool any = std::any_of(answer.named.begin(), answer.named.end(), hit),
             every = std::all_of(answer.named.begin(), answer.named.end(), hit),
             nothing = answer.named.empty(), sure = answer.sure && !nothing;
  Count &count = by_method_[answer.method][truth.kind];
  ++count.all;
  count.right += sure && every;
  count.wrong += sure && !any;
  count.in_list += !sure && any;
  count.claimed += sure;
  count.nothing += nothing;
  if (answer.method != "diagnose")
    return;
  if (truth.kind == Truth::single && signal >= kStrongSignal) {
    ++strong_;
    strong_first_ += hit(first_of(d));
  } else if (truth.kind == Truth::single && signal >= kMiddlingSignal) {
    ++middling_;
    middling_found_ += any || is_possible(d, truth);
  }
  if (truth.kind != Truth::none && signal >= kMiddlingSignal) {
    ++seen_;
    unseen_ += nothing;
  }
}

void Scores::add_probabilities(const Truth &truth, const Diagnosis &d) {
  for (int k = 0; k < int(d.changes.all.size()); ++k) {
    const Change &change = d.changes.all[std::size_t(k)];
    if (change.effect < 0)
      continue;
    const int tenth = std::min(9, int(10.0 * change.probability));
    all_[tenth] += 1.0;
    sums_[tenth] += change.probability;
    hits_[tenth] += is_true(truth, name_of(d, k));
  }
}

void Scores::add_ranges(const Truth &truth, const Diagnosis &d, const bank::Bank &spec,
                        const bank::Run &run) {
  for (const int k : d.verdict.changes) {
    const Change &change = d.changes.all[std::size_t(k)];
    if (d.verdict.kind != Verdict::explained || change.kind != Change::added ||
        !is_true(truth, name_of(d, k)))
      continue;
    std::vector<double> values, weights;
    for (const inference::Draw &draw : d.posterior.draws)
      if (const double s = inference::amplitudes_of(d.of.problem, draw, d.film)[change.effect];
          inference::acts(s)) {
        const inference::Parameter &p = d.of.effects[std::size_t(change.effect)];
        values.push_back(find_effect(p.name).parameter.value(p.prior.value(s)));
        weights.push_back(draw.weight);
      }
    const inference::CredibleRange range = inference::credible_range(values, weights);
    for (std::size_t i = 0; i < spec.design.inputs.size(); ++i)
      if (spec.design.inputs[i].name == name_of(d, k)) {
        ++ranges_;
        held_ += range.low90 <= run.point.values[i] && run.point.values[i] <= range.high90;
      }
  }
}

void Scores::print() const {
  fmt::print("{:<18} {:<8} {:>5} {:>6} {:>6} {:>8} {:>8} {:>8}\n", "method", "truth", "all",
             "right", "wrong", "in list", "claimed", "nothing");
  for (const auto &[method, kinds] : by_method_)
    for (const auto &[kind, n] : kinds)
      fmt::print("{:<18} {:<8} {:>5} {:>6} {:>6} {:>8} {:>8} {:>8}\n", method, kKinds[kind], n.all,
                 n.right, n.wrong, n.in_list, n.claimed, n.nothing);
  fmt::print("single effects with a signal of 6 or more: {} of {} first\n", strong_first_, strong_);
  fmt::print("single effects with a signal of 3 to 6: {} of {} named or possible\n",
             middling_found_, middling_);
  fmt::print("changes with a signal of 3 or more: {} of {} called nothing to see\n", unseen_,
             seen_);
  fmt::print("amplitudes of effects that are rightly named: {} of {} within 90 % ranges\n", held_,
             ranges_);
  double off = 0.0, n = 0.0;
  for (int k = 0; k < 10; ++k) {
    if (all_[k] > 0.0)
      fmt::print("probability {:.2f}: true in {:.2f} of {:.0f}\n", sums_[k] / all_[k],
                 hits_[k] / all_[k], all_[k]);
    off += std::fabs(sums_[k] - hits_[k]);
    n += all_[k];
  }
  fmt::print("calibration error {:.3f}\n", off / n);
}

} // namespace calendem
