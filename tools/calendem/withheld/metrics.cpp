// SPDX-License-Identifier: GPL-2.0-or-later
#include "withheld/metrics.h"
#include "diagnose/inference/scores.h"
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace calendem {
namespace {

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
    m.value = m.low = m.high = std::nan("");
    return m;
  }
  m.value = statistic(cases);
  std::tie(m.low, m.high) =
      inference::clustered_bootstrap(clusters, [&](const std::vector<int> &places) {
        Cases drawn;
        for (const int k : places)
          drawn.push_back(cases[std::size_t(k)]);
        return statistic(drawn);
      });
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

std::string ScoredCase::ranked(int n) const {
  std::vector<std::pair<double, std::string>> order;
  for (const auto &[name, p] : probability)
    order.emplace_back(-p, name);
  std::sort(order.begin(), order.end());
  return n < int(order.size()) ? order[std::size_t(n)].second : "";
}

Metric share_of(const std::string &name, const std::vector<ScoredCase> &all, const CaseTest &chosen,
                const CaseTest &hit) {
  Metric m = statistic_of(name, chosen_of(all, chosen), [&](const Cases &drawn) {
    const auto hits = std::count_if(drawn.begin(), drawn.end(), [&](auto *c) { return hit(*c); });
    return double(hits) / double(drawn.size());
  });
  if (m.value == 0.0 || m.value == 1.0)
    std::tie(m.low, m.high) =
        inference::clopper_pearson(m.value == 0.0 ? 0 : m.clusters, m.clusters);
  return m;
}

std::map<std::string, std::map<std::string, int>>
confusion_of(const std::vector<ScoredCase> &cases) {
  std::map<std::string, std::map<std::string, int>> out;
  for (const ScoredCase &c : cases)
    ++out[c.block == "left_out" ? "unknown (left out)" : c.truth][c.claim];
  return out;
}

} // namespace calendem
