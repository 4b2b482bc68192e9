// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed/probability_scores.h"
#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>

namespace calendem {

double log_score(const std::vector<std::vector<double>> &probabilities,
                 const std::vector<int> &truths, double floor) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truths.size(); ++i)
    sum -= std::log(std::max(probabilities[i][std::size_t(truths[i])], floor));
  return sum / double(truths.size());
}

double brier_score(const std::vector<std::vector<double>> &probabilities,
                   const std::vector<int> &truths) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truths.size(); ++i)
    for (std::size_t k = 0; k < probabilities[i].size(); ++k) {
      const double off = probabilities[i][k] - (int(k) == truths[i] ? 1.0 : 0.0);
      sum += off * off;
    }
  return sum / double(truths.size());
}

double brier_skill(const std::vector<std::vector<double>> &probabilities,
                   const std::vector<int> &truths, const std::vector<double> &reference) {
  const std::vector<std::vector<double>> always(truths.size(), reference);
  return 1.0 - brier_score(probabilities, truths) / brier_score(always, truths);
}

std::pair<double, double> clopper_pearson(int hits, int trials, double confidence) {
  const double tail = 0.5 * (1.0 - confidence);
  using Beta = boost::math::beta_distribution<>;
  return {hits == 0 ? 0.0 : quantile(Beta(hits, trials - hits + 1), tail),
          hits == trials ? 1.0 : quantile(complement(Beta(hits + 1, trials - hits), tail))};
}

} // namespace calendem
