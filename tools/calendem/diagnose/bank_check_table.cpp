// SPDX-License-Identifier: GPL-2.0-or-later
// diagnoses.csv, and what is printed of it.
#include "base/csv_table.h"
#include "diagnose/bank_check.h"
#include "diagnose/inference/scores.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>

namespace calendem {
namespace {

/// "1101", one digit for each base parameter, and back.
std::vector<bool> held_in(const std::string &digits) {
  std::vector<bool> out;
  for (const char digit : digits)
    out.push_back(digit == '1');
  return out;
}
std::string digits_of(const std::vector<bool> &held) {
  std::string out;
  for (const bool one : held)
    out += one ? '1' : '0';
  return out;
}

} // namespace

std::string table_of(const std::vector<CheckedDiagnosis> &cases) {
  std::string out = "effect,base_point,packing,left_out,amplitude,limit_against_none,most_probable,"
                    "its_probability,truths_probability,unknowns_probability,claim,adequacy_p,"
                    "base_parameters_held\n";
  for (const CheckedDiagnosis &r : cases)
    out += fmt::format("{},{},{},{},{:.5g},{:.5g},{},{:.4g},{:.4g},{:.4g},{},{:.4g},{}\n", r.effect,
                       r.base_point, r.packing, int(r.left_out), r.amplitude, r.limit,
                       r.most_probable, r.its_probability, r.of_truth, r.of_unknown, r.claim,
                       r.adequacy_p, digits_of(r.held));
  return out;
}

std::vector<CheckedDiagnosis> diagnoses_in(const std::string &table) {
  std::vector<CheckedDiagnosis> out;
  const CsvTable t = CsvTable::parse(table);
  const auto effect = t.texts("effect"), first = t.texts("most_probable"), claim = t.texts("claim");
  const auto base_point = t.numbers("base_point"), packing = t.numbers("packing"),
             left_out = t.numbers("left_out"), amplitude = t.numbers("amplitude"),
             limit = t.numbers("limit_against_none"), its = t.numbers("its_probability"),
             truths = t.numbers("truths_probability"), unknowns = t.numbers("unknowns_probability"),
             adequacy = t.numbers("adequacy_p");
  const auto held = t.texts("base_parameters_held");
  for (std::size_t k = 0; k < t.rows(); ++k)
    out.push_back({effect[k], int(base_point[k]), int(packing[k]), left_out[k] == 1.0, amplitude[k],
                   limit[k], first[k], its[k], truths[k], unknowns[k], claim[k], adequacy[k],
                   held_in(held[k])});
  return out;
}

namespace {

std::string interval(const std::vector<CheckedDiagnosis> &cases,
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

using Choice = std::function<bool(const CheckedDiagnosis &)>;

/// Share of the cases that `among` chooses which `hit` chooses too.
std::string share(const std::vector<CheckedDiagnosis> &cases, const Choice &among,
                  const Choice &hit) {
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

/// Share of the base parameters' intervals that hold.
std::string held(const std::vector<CheckedDiagnosis> &cases, const Choice &among) {
  return interval(cases, [&](const std::vector<int> &drawn) {
    double hits = 0.0, trials = 0.0;
    for (const int k : drawn)
      if (const CheckedDiagnosis &r = cases[std::size_t(k)]; among(r)) {
        trials += double(r.held.size());
        hits += double(std::count(r.held.begin(), r.held.end(), true));
      }
    return trials > 0.0 ? hits / trials : std::nan("");
  });
}

std::string unknown_against_known(const std::vector<CheckedDiagnosis> &cases, const Choice &among) {
  return interval(cases, [&](const std::vector<int> &drawn) {
    std::vector<double> scores;
    std::vector<bool> unknown;
    for (const int k : drawn)
      if (const CheckedDiagnosis &r = cases[std::size_t(k)]; !r.effect.empty() && among(r)) {
        scores.push_back(r.of_unknown);
        unknown.push_back(r.left_out);
      }
    return inference::auroc(scores, unknown);
  });
}

} // namespace

bool names_effect(const std::string &claim) {
  return claim != "none" && claim != "unknown" && claim != "noise" && claim != "undecided";
}

std::vector<std::string> summary_of(const std::vector<CheckedDiagnosis> &cases) {
  const auto count = [&](const Choice &of) {
    return std::count_if(cases.begin(), cases.end(), of);
  };
  const Choice null = [](const CheckedDiagnosis &r) { return r.effect.empty(); };
  const Choice known = [](const CheckedDiagnosis &r) { return !r.effect.empty() && !r.left_out; };
  const Choice gone = [](const CheckedDiagnosis &r) { return r.left_out; };
  const Choice named = [](const CheckedDiagnosis &r) { return names_effect(r.claim); };
  const Choice first = [](const CheckedDiagnosis &r) { return r.most_probable == r.truth(); };
  const Choice right = [](const CheckedDiagnosis &r) { return r.claim == r.truth(); };
  const Choice strong = [&](const CheckedDiagnosis &r) { return known(r) && r.above_limit(); };
  const Choice claimed = [&](const CheckedDiagnosis &r) { return known(r) && named(r); };
  double score = 0.0;
  for (const CheckedDiagnosis &r : cases)
    score -= known(r) ? std::log(std::max(r.of_truth, 1e-6)) : 0.0;
  return {
      fmt::format("{} samples of the base model: claimed to be none {}, to have an effect {}",
                  count(null), share(cases, null, right), share(cases, null, named)),
      fmt::format("{} samples with an effect, {} above its limit: of these named first {}",
                  count(known), count(strong), share(cases, strong, first)),
      fmt::format("effects claimed in {} of them: right {}; mean -ln of the truth's "
                  "probability {:.2f}",
                  count(claimed), share(cases, claimed, right),
                  score / std::max<double>(1.0, double(count(known)))),
      fmt::format("the same without their effect: claimed to be unknown {}, to be another {}",
                  share(cases, gone, right), share(cases, gone, named)),
      fmt::format(
          "unknown distinguished from known, area under the ROC curve: {}; above the limits {}",
          unknown_against_known(cases, [](const CheckedDiagnosis &) { return true; }),
          unknown_against_known(cases, [](const CheckedDiagnosis &r) { return r.above_limit(); })),
      fmt::format("90 % intervals of base parameters hold {}; where an effect is claimed {}",
                  held(cases, [](const CheckedDiagnosis &) { return true; }), held(cases, named))};
}

} // namespace calendem
