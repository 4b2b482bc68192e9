// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/choose_runs.h"
#include "base/messages.h"
#include "diagnose/inference/choose_points.h"
#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace calendem {
namespace {

using inference::PossiblePoint;

constexpr int kStrengths = 4; // of an effect, to choose from: the middles of quarters of its prior

struct Possible {
  std::vector<ChosenRun> runs;
  std::vector<PossiblePoint> points; ///< the same
};

/// What the bank may still run, and what it has.
class Left {
public:
  Left(const BankTable &table, const inference::Bank &bank) : spec_(table.spec), bank_(bank) {
    for (const BankRow &row : table.rows)
      if (row.point.effect.empty())
        base_[row.point.base_point] = row.point;
      else if (row.run.pressing.empty())
        has_[row.point.effect].insert(row.point.base_point);
    for (const ChosenRun &c : spec_.chosen)
      if (has_[c.effect].count(c.base_point) == 0)
        throw Failure(
            kBadInput,
            fmt::format("{}: its chosen point of {} beside base point {} has no runs yet. "
                        "Make them first: calendem bank {} -o DIR.",
                        spec_.file, c.effect, c.base_point, spec_.file));
  }

  const std::string &name(int effect) const { return bank_.effects[std::size_t(effect)].name; }

  /// That the effect has.
  int points(int effect) const {
    const auto at = has_.find(name(effect));
    return at == has_.end() ? 0 : int(at->second.size());
  }

  /// Base points at which the effect was not run.
  std::vector<int> beside(int effect) const {
    std::vector<int> out;
    const auto had = has_.find(name(effect));
    const int own = spec_.first_point + points_of(spec_, name(effect));
    for (const auto &[number, point] : base_)
      if (number >= own && (had == has_.end() || had->second.count(number) == 0))
        out.push_back(number);
    return out;
  }

  void add(int effect, int base_point, double share, Possible &to) const {
    const Effect e = effect_of(spec_, name(effect));
    const EffectParameter &p = e.parameter;
    const double value = prior_value(p.low, p.high, p.spread, share);
    const BankPoint &base = base_.at(base_point);
    to.runs.push_back({e.name, base_point, value});
    PossiblePoint out;
    out.effect = effect;
    out.beside = base_point;
    out.packing = fmt::format("{}", base.packing);
    out.base =
        Eigen::Map<const inference::Vector>(base.base.data(), Eigen::Index(base.base.size()));
    out.amplitudes = inference::Vector::Constant(1, p.amplitude(value));
    to.points.push_back(out);
  }

private:
  const BankSpec &spec_;
  const inference::Bank &bank_;
  std::map<int, BankPoint> base_;
  std::map<std::string, std::set<int>> has_;
};

/// As many of each effect, beside the next base points, spread over its prior.
Possible evenly(const Left &left, const std::vector<int> &simulated, int count) {
  Possible out;
  for (std::size_t k = 0; k < simulated.size(); ++k) {
    const int share =
        count / int(simulated.size()) + (int(k) < count % int(simulated.size()) ? 1 : 0);
    const std::vector<int> beside = left.beside(simulated[k]);
    const int points = std::min(share, int(beside.size()));
    const inference::Matrix strengths = inference::sobol_points(1, std::max(points, 1), 1 + k);
    for (int j = 0; j < points; ++j)
      left.add(simulated[k], beside[std::size_t(j)], strengths(0, j), out);
  }
  return out;
}

} // namespace

RunChoice choose_runs(const Experiment &experiment, const BankTable &table, double cells,
                      int count) {
  const ExperimentData data = data_of(experiment, table, {});
  inference::ModelSettings settings;
  RunChoice out;
  out.cells = settings.packings_in_sample = cells > 0.0 ? cells : cells_of(experiment, table.spec);
  settings.specimens = data.specimens;
  const inference::Model model(data.bank, data.experiment, settings);
  const Left left(table, data.bank);
  std::vector<int> simulated; // effects
  Possible all;
  for (int e = 0; e < int(data.bank.effects.size()); ++e) {
    if (data.bank.effects[std::size_t(e)].computed)
      continue;
    simulated.push_back(e);
    for (const int beside : left.beside(e))
      for (int k = 0; k < kStrengths; ++k)
        left.add(e, beside, (k + 0.5) / kStrengths, all);
  }
  if (all.points.empty())
    throw Failure(kBadInput, fmt::format("{}: every effect was run beside every base point. Raise "
                                         "base_points.",
                                         table.spec.file));
  const std::vector<double> even =
      information_gain(model, data.bank, evenly(left, simulated, count).points);
  std::map<int, RunChoice::Effect> effects;
  for (const int e : simulated)
    effects[e] = {left.name(e), left.points(e), 0, 0.0, even[std::size_t(e)]};
  for (const inference::ChosenPoint &c : choose_points(model, data.bank, all.points, count)) {
    out.chosen.push_back(all.runs[std::size_t(c.place)]);
    RunChoice::Effect &of = effects[all.points[std::size_t(c.place)].effect];
    ++of.chosen;
    of.gain += c.gain;
  }
  for (const auto &[place, effect] : effects)
    out.effects.push_back(effect);
  return out;
}

} // namespace calendem
