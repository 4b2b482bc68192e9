// SPDX-License-Identifier: GPL-2.0-or-later
#include "withheld/rehearsal.h"
#include "bank/bank_design.h"
#include "diagnose/diagnose.h"
#include "inference/scores.h"
#include "pack/random.h"
#include "spec/messages.h"
#include "spec/output_folder.h"
#include "spec/provenance.h"
#include "study/job_pool.h"
#include "withheld/handed_out.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <iostream>
#include <map>

namespace calendem {
namespace {

constexpr int kFewestPackings = 3;
constexpr std::uint64_t kPurpose = 0x402;

using Point = std::pair<std::string, int>; // effect, base point

/// Runs of the packing's points, by pressure; of those points that have all.
std::map<Point, std::vector<PressedSamples>> points_of_packing(const BankTable &table,
                                                               int packing) {
  std::map<Point, std::vector<PressedSamples>> out;
  for (const double pressure : table.spec.pressures)
    for (const BankRow &row : table.rows)
      if (row.point.packing == packing && row.point.effect != kFullCell &&
          std::fabs(row.run.target - pressure) < 1e-6 * pressure)
        out[{row.point.effect, row.point.base_point}].push_back({ShownRun{row.run, {}, {}}});
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

Rehearsed judged(const Diagnosed &d, Rehearsed out) {
  const inference::Which &which = d.diagnosis.which;
  out.limit = std::nan("");
  for (const inference::DetectionLimit &l : d.diagnosis.confounding.limits)
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

std::string table_of(const std::vector<Rehearsed> &cases) {
  std::string out = "effect,base_point,packing,left_out,amplitude,limit_against_none,most_probable,"
                    "its_probability,truths_probability,unknowns_probability,claim,adequacy_p\n";
  for (const Rehearsed &r : cases)
    out +=
        fmt::format("{},{},{},{},{:.5g},{:.5g},{},{:.4g},{:.4g},{:.4g},{},{:.4g}\n", r.effect,
                    r.base_point, r.packing, int(r.left_out), r.amplitude, r.limit, r.most_probable,
                    r.its_probability, r.of_truth, r.of_unknown, r.claim, r.adequacy_p);
  return out;
}

std::string interval(const std::vector<Rehearsed> &cases,
                     const std::function<double(const std::vector<int> &)> &statistic) {
  std::vector<int> packings, all;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    packings.push_back(cases[k].packing);
    all.push_back(int(k));
  }
  const double value = statistic(all);
  if (!std::isfinite(value))
    return "not known";
  const auto [low, high] = inference::clustered_bootstrap(packings, statistic);
  return fmt::format("{:.2f} (90 %: {:.2f}–{:.2f})", value, low, high);
}

using Choice = std::function<bool(const Rehearsed &)>;

/// Of the cases that `among` chooses, the share that `hit` chooses too.
std::string share(const std::vector<Rehearsed> &cases, const Choice &among, const Choice &hit) {
  return interval(cases, [&](const std::vector<int> &drawn) {
    double hits = 0.0, trials = 0.0;
    for (const int k : drawn)
      if (among(cases[std::size_t(k)])) {
        trials += 1.0;
        hits += hit(cases[std::size_t(k)]);
      }
    return trials > 0.0 ? hits / trials : std::nan("");
  });
}

std::string unknown_told(const std::vector<Rehearsed> &cases, const Choice &among) {
  return interval(cases, [&](const std::vector<int> &drawn) {
    std::vector<double> scores;
    std::vector<bool> unknown;
    for (const int k : drawn)
      if (const Rehearsed &r = cases[std::size_t(k)]; !r.effect.empty() && among(r)) {
        scores.push_back(r.of_unknown);
        unknown.push_back(r.left_out);
      }
    return inference::auroc(scores, unknown);
  });
}

} // namespace

std::vector<std::string> summary_of(const std::vector<Rehearsed> &cases) {
  const auto count = [&](const Choice &of) {
    return std::count_if(cases.begin(), cases.end(), of);
  };
  const Choice null = [](const Rehearsed &r) { return r.effect.empty(); };
  const Choice known = [](const Rehearsed &r) { return !r.effect.empty() && !r.left_out; };
  const Choice gone = [](const Rehearsed &r) { return r.left_out; };
  const Choice named = [](const Rehearsed &r) { return names_effect(r.claim); };
  const Choice first = [](const Rehearsed &r) { return r.most_probable == r.truth(); };
  const Choice right = [](const Rehearsed &r) { return r.claim == r.truth(); };
  const Choice strong = [&](const Rehearsed &r) { return known(r) && r.above_limit(); };
  const Choice claimed = [&](const Rehearsed &r) { return known(r) && named(r); };
  double score = 0.0;
  for (const Rehearsed &r : cases)
    score -= known(r) ? std::log(std::max(r.of_truth, 1e-6)) : 0.0;
  return {fmt::format("{} samples of the base model: claimed to be none {}, to have an effect {}",
                      count(null), share(cases, null, right), share(cases, null, named)),
          fmt::format("{} samples with an effect, {} above its limit: of these named first {}",
                      count(known), count(strong), share(cases, strong, first)),
          fmt::format("effects claimed in {} of them: right {}; mean -ln of the truth's "
                      "probability {:.2f}",
                      count(claimed), share(cases, claimed, right),
                      score / std::max<double>(1.0, double(count(known)))),
          fmt::format("the same without their effect: claimed to be unknown {}, to be another {}",
                      share(cases, gone, right), share(cases, gone, named)),
          fmt::format("unknown told from known, area under the ROC curve: {}; above the limits {}",
                      unknown_told(cases, [](const Rehearsed &) { return true; }),
                      unknown_told(cases, [](const Rehearsed &r) { return r.above_limit(); }))};
}

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
  std::vector<std::vector<Rehearsed>> parts(packings.size());
  in_parallel(int(packings.size()), o.jobs, [&](int k) {
    parts[std::size_t(k)] = of_packing(o, table, packings[std::size_t(k)]);
    fmt::print("rehearsal: packing {} left out, {} diagnoses\n", packings[std::size_t(k)],
               parts[std::size_t(k)].size());
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
