// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/scores.h"
#include "diagnose/inference/which.h"
#include "sealed/probability_scores.h"
#include "sealed/round_file.h"
#include "sealed/score.h"
#include <algorithm>
#include <cmath>
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
  return log_score(t.probability, t.truth);
}

double brier_skill_of(const Cases &cases) {
  const Table t = table_of(cases);
  std::vector<double> frequency(t.names.size(), 0.0);
  for (const int truth : t.truth)
    frequency[std::size_t(truth)] += 1.0 / double(t.truth.size());
  if (std::count(t.truth.begin(), t.truth.end(), t.truth.front()) == std::ptrdiff_t(t.truth.size()))
    return std::nan(""); // the frequencies are right already
  return brier_skill(t.probability, t.truth, frequency);
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
  const inference::Priors priors;
  const auto kind = [](const ScoredCase *c) {
    return c->truth == "none" ? 0 : c->truth == "unknown" ? 1 : 2;
  };
  double of_kind[3] = {}, stated[kBins] = {}, right[kBins] = {}, all = 0.0;
  for (const ScoredCase *c : cases)
    of_kind[kind(c)] += 1.0;
  const double prior[3] = {priors.none, priors.unknown, 1.0 - priors.none - priors.unknown};
  for (const ScoredCase *c : cases) {
    const std::string first = c->ranked(0);
    const double p = first.empty() ? 0.0 : c->probability.at(first);
    const int bin = std::min(kBins - 1, int(p * kBins));
    const double weight = prior[kind(c)] / of_kind[kind(c)];
    stated[bin] += weight * p;
    right[bin] += weight * (first == c->truth);
    all += weight;
  }
  double sum = 0.0;
  for (int k = 0; k < kBins; ++k)
    sum += std::fabs(stated[k] - right[k]);
  return sum / all;
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
    std::tie(m.low, m.high) = clopper_pearson(hits, m.clusters, kInterval);
    std::tie(m.least, m.most) = clopper_pearson(hits, m.clusters, kBounds);
  }
  return m;
}

std::map<std::string, std::map<std::string, int>>
confusion_of(const std::vector<ScoredCase> &cases) {
  std::map<std::string, std::map<std::string, int>> out;
  for (const ScoredCase &c : cases)
    ++out[c.block == "left_out"      ? "unknown (left out)"
          : c.block == kIntervention ? c.truth + " (intervention)"
                                     : c.truth][c.claim];
  return out;
}

} // namespace calendem
