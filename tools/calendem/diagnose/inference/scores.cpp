// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/scores.h"
#include "base/random.h"
#include <algorithm>
#include <cmath>
#include <map>

namespace calendem::inference {
namespace {

constexpr std::uint64_t kDrawsStream = 0xb007; // of the stream of draws

} // namespace

double auroc(const std::vector<double> &scores, const std::vector<bool> &positive) {
  double higher = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i < scores.size(); ++i)
    for (std::size_t j = 0; j < scores.size(); ++j)
      if (positive[i] && !positive[j]) {
        pairs += 1.0;
        higher += scores[i] > scores[j] ? 1.0 : scores[i] == scores[j] ? 0.5 : 0.0;
      }
  return pairs > 0.0 ? higher / pairs : std::nan("");
}

std::pair<double, double>
clustered_bootstrap(const std::vector<int> &cluster_of_case,
                    const std::function<double(const std::vector<int> &)> &statistic,
                    double confidence, int draws, unsigned long long seed) {
  std::map<int, std::vector<int>> members;
  for (int i = 0; i < int(cluster_of_case.size()); ++i)
    members[cluster_of_case[i]].push_back(i);
  std::vector<const std::vector<int> *> clusters;
  for (const auto &m : members)
    clusters.push_back(&m.second);
  Random random(seed, kDrawsStream);
  std::vector<double> values;
  for (int d = 0; d < draws; ++d) {
    std::vector<int> cases;
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      const auto &drawn = *clusters[std::size_t(random.uniform() * double(clusters.size()))];
      cases.insert(cases.end(), drawn.begin(), drawn.end());
    }
    const double value = statistic(cases);
    if (!std::isnan(value))
      values.push_back(value);
  }
  if (values.empty())
    return {std::nan(""), std::nan("")};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[std::size_t(std::lround(share * double(values.size() - 1)))];
  };
  return {at(0.5 * (1.0 - confidence)), at(0.5 * (1.0 + confidence))};
}

} // namespace calendem::inference
