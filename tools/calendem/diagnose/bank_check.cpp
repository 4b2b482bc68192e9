// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/bank_check.h"
#include "base/liggghts_job.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/random.h"
#include "diagnose/bank/bank_table.h"
#include "diagnose/diagnose.h"
#include "diagnose/measured_runs.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>

namespace calendem {

namespace {

constexpr int kFewestPackings = 3;
constexpr std::uint64_t kPressureStream = 0x402, kDrawn = 0x403;

using Point = std::pair<std::string, int>; // effect, base point

/// Runs of the packing's points, by pressure; of those points that have all.
std::map<Point, std::vector<PressedSamples>> points_of_packing(const BankTable &table,
                                                               int packing) {
  std::map<Point, std::vector<PressedSamples>> out;
  for (const double pressure : table.spec.pressures)
    for (const BankRow &row : table.rows)
      if (row.point.packing == packing && row.point.effect != kFullCell &&
          row.run.pressing.empty() && std::fabs(row.run.target - pressure) < 1e-6 * pressure)
        out[{row.point.effect, row.point.base_point}].push_back({row.run});
  for (auto it = out.begin(); it != out.end();)
    it = it->second.size() == table.spec.pressures.size() ? std::next(it) : out.erase(it);
  return out;
}

const BankPoint &point_of(const BankTable &table, const Point &point) {
  return std::find_if(table.rows.begin(), table.rows.end(),
                      [&](const BankRow &row) {
                        return row.point.effect == point.first &&
                               row.point.base_point == point.second;
                      })
      ->point;
}

/// What a laboratory would hand in of the point.
Experiment sample_of(const std::string &folder, const BankTable &table, const Point &point,
                     const std::vector<PressedSamples> &runs) {
  MeasuredSpecimens sample;
  sample.recipe_file = table.spec.recipe_file;
  sample.pressures = table.spec.pressures;
  sample.area = read_recipe(sample.recipe_file).area();
  const auto &names = table.spec.effects;
  const auto effect = std::uint64_t(std::find(names.begin(), names.end(), point.first) -
                                    names.begin()); // one seed for each point
  const std::uint64_t seed = std::uint64_t(point.second) * (names.size() + 1) + effect;
  sample.press.pressure =
      0.01 * sample.noise.pressure_percent * Random(seed, kPressureStream).normal();
  sample.id = fmt::format("{}_{}", point.first.empty() ? "none" : point.first, point.second);
  const std::string at = folder + "/samples/" + sample.id;
  write_measured(at, sample, runs, seed);
  return read_experiment(at + "/experiment.toml");
}

/// `base`: true values of the base parameters `of`.
CheckedDiagnosis judged(const inference::Which &which, const inference::Confounding &confounding,
                        const std::vector<inference::Parameter> &of,
                        const std::vector<double> &base, CheckedDiagnosis out) {
  const auto ranges = inference::parameter_ranges(of, which);
  out.held.clear();
  for (std::size_t k = 0; k < base.size(); ++k)
    out.held.push_back(base[k] >= ranges[k].all.low90 && base[k] <= ranges[k].all.high90);
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

/// All samples of one packing, diagnosed by a bank that has not seen it.
std::vector<CheckedDiagnosis> of_packing(const BankCheckOptions &o, const BankTable &table,
                                         int packing) {
  BankTable others = table;
  others.rows.erase(
      std::remove_if(others.rows.begin(), others.rows.end(),
                     [&](const BankRow &row) { return row.point.packing == packing; }),
      others.rows.end());
  SharedModels models;
  std::map<std::string, SharedModels> less;
  std::vector<CheckedDiagnosis> out;
  for (const auto &[point, runs] : points_of_packing(table, packing)) {
    const Experiment e = sample_of(o.folder, table, point, runs);
    const BankPoint &true_point = point_of(table, point);
    const auto judged_by = [&](const BankTable &bank, SharedModels &shared,
                               const CheckedDiagnosis &r) {
      const Diagnosed d = diagnosed(e, bank, 0.0, shared);
      return judged(d.diagnosis.which, d.diagnosis.confounding, d.data.bank.base, true_point.base,
                    r);
    };
    CheckedDiagnosis r;
    r.effect = point.first;
    r.base_point = point.second;
    r.packing = packing;
    if (!r.effect.empty())
      r.amplitude = find_effect(r.effect).parameter.amplitude(true_point.value);
    out.push_back(judged_by(others, models, r));
    if (r.effect.empty())
      continue;
    r.left_out = true;
    const double limit = out.back().limit;
    out.push_back(judged_by(without_effects(others, {r.effect}), less[r.effect], r));
    out.back().limit = limit; // this diagnosis does not know the effect
  }
  return out;
}

/// What the bank predicts of samples like its own base points'.
class Predicted {
public:
  Predicted(const BankCheckOptions &o, const BankTable &table) {
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
    base_ = data.bank.base;
  }

  /// One sample of the base model and of each effect.
  std::vector<CheckedDiagnosis> of_draw(int draw) const {
    std::vector<CheckedDiagnosis> out;
    Random random(std::uint64_t(draw), kDrawn);
    for (int e = -1; e < int(problem_.effects.size()); ++e) {
      CheckedDiagnosis r;
      r.base_point = r.packing = draw;
      inference::Problem sample = problem_;
      const inference::Vector at = scores(problem_.base_parameters, random);
      std::vector<double> base;
      for (std::size_t k = 0; k < base_.size(); ++k)
        base.push_back(base_[k].prior.value(at[Eigen::Index(k)]));
      sample.observed = drawn(problem_, at, applied(e, random, r), random);
      out.push_back(diagnosis_of(sample, base, r));
      if (e < 0)
        continue;
      r.left_out = true;
      const double limit = out.back().limit;
      out.push_back(diagnosis_of(without_effect(sample, e), base, r));
      out.back().limit = limit;
    }
    return out;
  }

private:
  inference::DiagnosisSettings settings_;
  std::unique_ptr<inference::Model> model_;
  inference::Problem problem_;
  std::vector<inference::Parameter> base_;

  static inference::Vector scores(int count, Random &random) {
    inference::Vector out(count);
    for (double &v : out)
      v = random.normal();
    return out;
  }
  /// The effect at scores from its prior; none for -1.
  std::vector<inference::Applied> applied(int effect, Random &random, CheckedDiagnosis &r) const {
    if (effect < 0)
      return {};
    const inference::ModelledEffect &e = problem_.effects[std::size_t(effect)];
    const inference::Vector at = scores(int(e.parameters.size()), random);
    r.effect = e.name;
    r.amplitude = e.parameters[0].prior.value(at[0]);
    return {{effect, at}};
  }
  CheckedDiagnosis diagnosis_of(const inference::Problem &sample, const std::vector<double> &base,
                                const CheckedDiagnosis &r) const {
    const inference::Discrimination t = discriminate(*model_, sample, settings_);
    return judged(t.which, t.confounding, base_, base, r);
  }
};

/// A comment at the head of the table: what it was made from. With another its rows are not taken.
std::string made_from(const BankCheckOptions &o) {
  return fmt::format("# program {}, bank {}, table {}, draws {}, cells {:g}\n",
                     hash_of_file(this_program()), hash_of_file(o.bank), hash_of_file(o.table),
                     o.draws, o.cells);
}

/// Rows of a table that was begun, by packing or draw; empty where it is of something else.
std::map<int, std::vector<CheckedDiagnosis>> begun(const std::string &file,
                                                   const std::string &head) {
  std::map<int, std::vector<CheckedDiagnosis>> out;
  const std::string text = std::filesystem::is_regular_file(file) ? text_of_file(file) : "";
  if (text.compare(0, head.size(), head) == 0)
    for (const CheckedDiagnosis &r : diagnoses_in(text))
      out[r.packing].push_back(r);
  return out;
}

/// Numbers of the packings, or of the draws.
std::vector<int> parts_of(const BankCheckOptions &o, const BankTable &table) {
  std::vector<int> out;
  for (int draw = 1; draw <= o.draws; ++draw)
    out.push_back(draw);
  if (o.draws > 0)
    return out;
  for (const BankRow &row : table.rows)
    out.push_back(row.point.packing);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  if (int(out.size()) < kFewestPackings)
    throw Failure(kBadInput, fmt::format("{} has {} packings; at least {} are needed to leave one "
                                         "out.",
                                         o.table, out.size(), kFewestPackings));
  return out;
}

} // namespace

void check_bank(const BankCheckOptions &o) {
  const BankTable table = read_bank_table(read_bank_spec(o.bank), o.table);
  const std::vector<int> numbers = parts_of(o, table);
  make_output_folder(o.folder);
  const FolderLock lock(o.folder);
  const std::string file = o.folder + "/diagnoses.csv", head = made_from(o);
  std::map<int, std::vector<CheckedDiagnosis>> done = begun(file, head);
  std::vector<int> missing;
  for (const int number : numbers)
    if (done.count(number) == 0)
      missing.push_back(number);
  if (missing.size() < numbers.size())
    fmt::print("bank: {} of {} are in {} already\n", numbers.size() - missing.size(),
               numbers.size(), file);
  const std::unique_ptr<Predicted> predicted =
      o.draws > 0 ? std::make_unique<Predicted>(o, table) : nullptr;
  std::vector<CheckedDiagnosis> cases;
  const auto write = [&] {
    cases.clear();
    for (const auto &[number, part] : done)
      cases.insert(cases.end(), part.begin(), part.end());
    write_file(file, head + table_of(cases));
  };
  std::mutex writing;
  in_parallel(int(missing.size()), o.jobs, [&](int k) {
    const int number = missing[std::size_t(k)];
    const std::vector<CheckedDiagnosis> part =
        predicted ? predicted->of_draw(number) : of_packing(o, table, number);
    const std::lock_guard<std::mutex> lock(writing);
    done[number] = part;
    write();
    fmt::print("bank: {} {}, {} diagnoses\n", predicted ? "draw" : "left out packing", number,
               part.size());
    std::cout << std::flush;
  });
  write();
  for (const std::string &line : summary_of(cases))
    fmt::print("{}\n", line);
  fmt::print("table: {}\n", file);
}

} // namespace calendem
