// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/random.h"
#include "diagnose/inference/scores.h"
#include <cmath>
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

TEST(Auroc, ByHand) {
  EXPECT_NEAR(auroc({0.9, 0.5, 0.5, 0.1}, {true, true, false, false}), 3.5 / 4.0, 1e-15);
  EXPECT_TRUE(std::isnan(auroc({0.1}, {true})));
}

// Cases of one cluster are equal: the interval is that of the clusters' mean, not of four times as
// many independent cases. Normal approximation of 50 clusters; its ends wander by a tenth of its
// width.
TEST(ClusteredBootstrap, WidthIsThatOfTheClusters) {
  Random random(1, 1);
  std::vector<int> cluster;
  std::vector<double> value;
  double square = 0.0;
  for (int c = 0; c < 50; ++c) {
    const double v = random.normal();
    square += v * v;
    for (int k = 0; k < 4; ++k) {
      cluster.push_back(c);
      value.push_back(v);
    }
  }
  const auto mean = [&](const std::vector<int> &cases) {
    double sum = 0.0;
    for (const int i : cases)
      sum += value[i];
    return sum / double(cases.size());
  };
  const auto [low, high] = clustered_bootstrap(cluster, mean, 0.9);
  EXPECT_NEAR(high - low, 2.0 * 1.645 * std::sqrt(square / 50.0 / 50.0), 0.1 * (high - low));
  EXPECT_EQ(clustered_bootstrap(cluster, mean, 0.9), std::make_pair(low, high));
}

} // namespace
} // namespace calendem::inference
