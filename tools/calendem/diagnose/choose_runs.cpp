// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/choose_runs.h"
#include "base/messages.h"
#include "diagnose/bank_points.h"
#include "diagnose/inference/choose_points.h"
#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace calendem {
namespace {

using inference::PossiblePoint;

constexpr int kStrengths = 4; // of an effect, to choose from: the middles of quarters of its prior
constexpr int kMostBeside = 350; // base points of an effect, to choose from: seconds, and 300 MB

struct Possible {
  std::vector<ChosenRun> runs;
  std::vector<PossiblePoint> points; ///< the same
};

/// What the bank has, and what it may still run.
class Inventory {
public:
  Inventory(const BankTable &table, const inference::Bank &bank) : spec_(table.spec), bank_(bank) {
    std::map<int, std::set<double>> run_to;
    for (const BankRow &row : table.rows) {
      if (!row.run.pressing.empty() || row.point.effect == kFullCell)
        continue;
      const int number = row.point.base_point;
      if (!row.point.effect.empty())
        has_[row.point.effect].insert(number);
      else if (number < spec_.first_point + spec_.base_points)
        for (const double pressure : spec_.pressures)
          if (same_pressure(row.run.target, pressure)) {
            run_to[number].insert(pressure);
            base_[number] = row.point;
          }
    }
    for (const auto &[number, pressures] : run_to)
      if (pressures.size() < spec_.pressures.size())
        base_.erase(number);
    for (const ChosenRun &c : spec_.chosen)
      if (has_[c.effect].count(c.base_point) == 0)
        throw Failure(
            kBadInput,
            fmt::format("{}: the point of {} beside base point {} has no runs in the table yet. "
                        "Make them first: calendem bank {} -o DIR; or take its line out.",
                        spec_.chosen_file, c.effect, c.base_point, spec_.file));
  }

  const std::string &name(int effect) const { return bank_.effects[std::size_t(effect)].name; }

  /// Number of points that are learnt from.
  int points(int effect) const {
    return int(
        std::count_if(bank_.runs.begin(), bank_.runs.end(),
                      [&](const inference::BankRun &run) { return run.effect == name(effect); }));
  }

  /// Base points at which the effect was not run.
  std::vector<int> beside(int effect) const {
    std::vector<int> out;
    const auto had = has_.find(name(effect));
    const int own = spec_.first_point + points_of(spec_, name(effect));
    for (const auto &[number, point] : base_)
      if (number >= own && int(out.size()) < kMostBeside &&
          (had == has_.end() || had->second.count(number) == 0))
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
  std::map<int, BankPoint> base_; ///< that were run to all of the bank's pressures
  std::map<std::string, std::set<int>> has_;
};

/// To all effects alike, as far as they have base points left; beside the next ones, spread over
/// the prior.
Possible evenly(const Inventory &bank, const std::vector<int> &simulated, int count) {
  std::map<int, std::vector<int>> beside;
  for (const int e : simulated)
    beside[e] = bank.beside(e);
  std::map<int, int> points;
  for (bool any = true; any && count > 0;) {
    any = false;
    for (const int e : simulated)
      if (count > 0 && points[e] < int(beside[e].size())) {
        any = true;
        ++points[e];
        --count;
      }
  }
  Possible out;
  for (const auto &[e, n] : points) {
    const inference::Matrix strengths =
        inference::sobol_points(1, std::max(n, 1), std::uint64_t(e) + 1);
    for (int j = 0; j < n; ++j)
      bank.add(e, beside[e][std::size_t(j)], strengths(0, j), out);
  }
  return out;
}

/// Conditions that runs to the bank's pressures, pressed in the usual way, tell something about.
std::vector<std::string> conditions_for(const Experiment &experiment, const BankTable &table,
                                        std::vector<std::string> &not_said) {
  std::vector<std::string> out;
  for (const CoveredCondition &c : covered_conditions(experiment, table, {}, not_said)) {
    const bool all =
        c.condition.pressing.empty() &&
        std::all_of(c.runs.begin(), c.runs.end(), [&](double pressure) {
          return std::any_of(table.spec.pressures.begin(), table.spec.pressures.end(),
                             [&](double of_bank) { return same_pressure(pressure, of_bank); });
        });
    if (all)
      out.push_back(c.condition.id);
    else
      not_said.push_back(fmt::format("{}: chosen points are run in the usual way to {} MPa, which "
                                     "tells nothing about it; left out.",
                                     c.condition.id, fmt::join(table.spec.pressures, ", ")));
  }
  if (out.empty())
    throw Failure(kBadInput,
                  fmt::format("no condition of the experiment is one that chosen points tell "
                              "something about.{}",
                              as_list(not_said)));
  return out;
}

} // namespace

RunChoice choose_runs(const Experiment &experiment, const BankTable &table, double cells,
                      int count) {
  RunChoice out;
  const ExperimentData data =
      data_of(experiment, table, conditions_for(experiment, table, out.not_said));
  for (const std::string &text : data.not_said) // some of it was said of the conditions already
    if (std::find(out.not_said.begin(), out.not_said.end(), text) == out.not_said.end())
      out.not_said.push_back(text);
  inference::ModelSettings settings;
  out.cells = settings.packings_in_sample = cells > 0.0 ? cells : cells_of(experiment, table.spec);
  settings.specimens = data.specimens;
  const inference::Model model(data.bank, data.experiment, settings);
  const Inventory bank(table, data.bank);
  std::vector<int> simulated; // effects
  Possible all;
  for (int e = 0; e < int(data.bank.effects.size()); ++e) {
    if (data.bank.effects[std::size_t(e)].computed)
      continue;
    simulated.push_back(e);
    for (const int beside : bank.beside(e))
      for (int k = 0; k < kStrengths; ++k)
        bank.add(e, beside, (k + 0.5) / kStrengths, all);
  }
  if (all.points.empty())
    throw Failure(kBadInput,
                  simulated.empty()
                      ? fmt::format("{}: no effect is simulated and has points enough to learn "
                                    "from.{}",
                                    table.spec.file, as_list(out.not_said))
                      : fmt::format("{}: every effect was run beside every base point. Raise "
                                    "base_points.",
                                    table.spec.file));
  const std::vector<double> even =
      information_gain(model, data.bank, evenly(bank, simulated, count).points);
  std::map<int, RunChoice::Effect> effects;
  for (const int e : simulated)
    effects[e] = {bank.name(e), bank.points(e), 0, 0.0, even[std::size_t(e)]};
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
