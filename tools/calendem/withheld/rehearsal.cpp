// SPDX-License-Identifier: GPL-2.0-or-later
#include "withheld/rehearsal.h"
#include "base/job_pool.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/random.h"
#include "diagnose/bank/bank_design.h"
#include "diagnose/diagnose.h"
#include "withheld/handed_out.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iostream>
#include <map>
#include <memory>

namespace calendem {
namespace {

constexpr int kFewestPackings = 3;
constexpr std::uint64_t kPurpose = 0x402, kDrawn = 0x403;

using Point = std::pair<std::string, int>; // effect, base point

/// Runs of the packing's points, by pressure; of those points that have all.
std::map<Point, std::vector<PressedSamples>> points_of_packing(const BankTable &table,
                                                               int packing) {
  std::map<Point, std::vector<PressedSamples>> out;
  for (const double pressure : table.spec.pressures)
    for (const BankRow &row : table.rows)
      if (row.point.packing == packing && row.point.effect != kFullCell &&
          std::fabs(row.run.target - pressure) < 1e-6 * pressure)
        out[{row.point.effect, row.point.base_point}].push_back({row.run});
  for (auto it = out.begin(); it != out.end();)
    it = it->second.size() == table.spec.pressures.size() ? std::next(it) : out.erase(it);
  return out;
}

double value_of(const BankTable &table, const Point &point) {
  for (const BankRow &row : table.rows)
    if (row.point.effect == point.first && row.point.base_point == point.second)
      return row.point.value;
  return 0.0;
}

/// What a laboratory would hand in of the point.
Experiment sample_of(const std::string &folder, const BankTable &table, const Point &point,
                     const std::vector<PressedSamples> &runs) {
  Round round;
  round.bank = table.spec;
  Truth truth;
  const auto &names = table.spec.effects;
  const auto effect = std::uint64_t(std::find(names.begin(), names.end(), point.first) -
                                    names.begin()); // one seed for each point
  const std::uint64_t seed = std::uint64_t(point.second) * (names.size() + 1) + effect;
  truth.pressure_error = 0.01 * round.noise.pressure_percent * Random(seed, kPurpose).normal();
  const std::string id =
      fmt::format("{}_{}", point.first.empty() ? "none" : point.first, point.second);
  hand_out(folder + "/samples/" + id, id, round, truth, runs, seed);
  return read_experiment(folder + "/samples/" + id + "/experiment.toml");
}

Rehearsed judged(const inference::Which &which, const inference::Confounding &confounding,
                 Rehearsed out) {
  out.limit = std::nan("");
  for (const inference::DetectionLimit &l : confounding.limits)
    if (l.effect == out.effect)
      out.limit = l.against_none;
  out.most_probable = which.judged.front().hypothesis.name;
  out.its_probability = which.judged.front().probability;
  for (const inference::Judged &j : which.judged) {
    out.of_truth += j.hypothesis.name == out.truth() ? j.probability : 0.0;
    out.of_unknown += j.hypothesis.name == "unknown" ? j.probability : 0.0;
  }
  out.claim = which.claim;
  out.adequacy_p = which.adequacy_p;
  return out;
}

Rehearsed judged(const Diagnosed &d, const Rehearsed &sample) {
  return judged(d.diagnosis.which, d.diagnosis.confounding, sample);
}

/// All samples of one packing, diagnosed by a bank that has not seen it.
std::vector<Rehearsed> of_packing(const RehearsalOptions &o, const BankTable &table, int packing) {
  BankTable others = table;
  others.rows.erase(
      std::remove_if(others.rows.begin(), others.rows.end(),
                     [&](const BankRow &row) { return row.point.packing == packing; }),
      others.rows.end());
  SharedModels models;
  std::map<std::string, SharedModels> less;
  std::vector<Rehearsed> out;
  for (const auto &[point, runs] : points_of_packing(table, packing)) {
    const Experiment e = sample_of(o.folder, table, point, runs);
    Rehearsed r;
    r.effect = point.first;
    r.base_point = point.second;
    r.packing = packing;
    if (!r.effect.empty())
      r.amplitude = find_effect(r.effect).parameter.amplitude(value_of(table, point));
    out.push_back(judged(diagnosed(e, others, 0.0, models), r));
    if (r.effect.empty())
      continue;
    r.left_out = true;
    const double limit = out.back().limit;
    out.push_back(
        judged(diagnosed(e, without_effects(others, {r.effect}), 0.0, less[r.effect]), r));
    out.back().limit = limit; // this diagnosis does not know the effect
  }
  return out;
}

/// What the bank foretells of samples like its own base points'.
class Foretold {
public:
  Foretold(const RehearsalOptions &o, const BankTable &table) {
    const int first = table.rows.front().point.packing;
    const auto points = points_of_packing(table, first);
    if (points.empty())
      throw Failure(kBadInput, fmt::format("{}: no point of packing {} has runs to all pressures; "
                                           "run calendem bank to the end.",
                                           o.table, first));
    settings_.model.packings_in_sample = o.cells;
    const Experiment like =
        sample_of(o.folder, table, points.begin()->first, points.begin()->second);
    const ExperimentData data = data_of(like, table, {});
    model_ = std::make_unique<inference::Model>(data.bank, data.experiment, settings_.model);
    problem_ = model_->problem(data.experiment.values);
  }

  /// One sample of the base model and of each effect.
  std::vector<Rehearsed> of_draw(int draw) const {
    std::vector<Rehearsed> out;
    Random random(std::uint64_t(draw), kDrawn);
    for (int e = -1; e < int(problem_.effects.size()); ++e) {
      Rehearsed r;
      r.base_point = r.packing = draw;
      inference::Problem sample = problem_;
      sample.observed =
          drawn(problem_, scores(problem_.base_parameters, random), applied(e, random, r), random);
      out.push_back(told_of(sample, r));
      if (e < 0)
        continue;
      r.left_out = true;
      const double limit = out.back().limit;
      out.push_back(told_of(without_effect(sample, e), r));
      out.back().limit = limit;
    }
    return out;
  }

private:
  inference::DiagnosisSettings settings_;
  std::unique_ptr<inference::Model> model_;
  inference::Problem problem_;

  static inference::Vector scores(int count, Random &random) {
    inference::Vector out(count);
    for (double &v : out)
      v = random.normal();
    return out;
  }
  /// The effect at scores from its prior; none for -1.
  std::vector<inference::Applied> applied(int effect, Random &random, Rehearsed &r) const {
    if (effect < 0)
      return {};
    const inference::ModelledEffect &e = problem_.effects[std::size_t(effect)];
    const inference::Vector at = scores(int(e.parameters.size()), random);
    r.effect = e.name;
    r.amplitude = e.parameters[0].prior.value(at[0]);
    return {{effect, at}};
  }
  Rehearsed told_of(const inference::Problem &sample, const Rehearsed &r) const {
    const inference::Discrimination t = discriminate(*model_, sample, settings_);
    return judged(t.which, t.confounding, r);
  }
};

} // namespace

void rehearse(const RehearsalOptions &o) {
  const BankTable table = read_bank_table(read_bank_spec(o.bank), o.table);
  std::vector<int> packings;
  for (const BankRow &row : table.rows)
    packings.push_back(row.point.packing);
  std::sort(packings.begin(), packings.end());
  packings.erase(std::unique(packings.begin(), packings.end()), packings.end());
  if (int(packings.size()) < kFewestPackings)
    throw Failure(kBadInput, fmt::format("{} has {} packings; at least {} are needed to leave one "
                                         "out.",
                                         o.table, packings.size(), kFewestPackings));
  make_output_folder(o.folder);
  const std::unique_ptr<Foretold> foretold =
      o.draws > 0 ? std::make_unique<Foretold>(o, table) : nullptr;
  std::vector<std::vector<Rehearsed>> parts(foretold ? std::size_t(o.draws) : packings.size());
  in_parallel(int(parts.size()), o.jobs, [&](int k) {
    std::vector<Rehearsed> &part = parts[std::size_t(k)];
    part = foretold ? foretold->of_draw(k + 1) : of_packing(o, table, packings[std::size_t(k)]);
    fmt::print("rehearsal: {}, {} diagnoses\n",
               foretold ? fmt::format("draw {}", k + 1)
                        : fmt::format("packing {} left out", packings[std::size_t(k)]),
               part.size());
    std::cout << std::flush;
  });
  std::vector<Rehearsed> cases;
  for (const auto &part : parts)
    cases.insert(cases.end(), part.begin(), part.end());
  write_file(o.folder + "/rehearsal.csv", table_of(cases));
  for (const std::string &line : summary_of(cases))
    fmt::print("{}\n", line);
  fmt::print("table: {}/rehearsal.csv\n", o.folder);
}

} // namespace calendem
