// SPDX-License-Identifier: GPL-2.0-or-later
// Probabilities of what is not in the table, and of what is named, beside how often they are right.
#include "diagnose/inference/scores.h"
#include "diagnose/inference/which.h"
#include "linear_world.h"
#include "physics/pi.h"
#include "support/with_all.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

constexpr int kBins = 10;

/// Stated probabilities and what came true.
struct Stated {
  std::vector<double> probability;
  std::vector<bool> came;

  void add(double p, bool is_true) {
    probability.push_back(p);
    came.push_back(is_true);
  }
};

/// Expected calibration error over equal bins (Naeini et al., AAAI 2015), and what of it chance
/// makes of probabilities that are right: of a bin sqrt(2/pi) standard deviations of its hits.
struct Calibration {
  double error = 0.0, by_chance = 0.0;

  Calibration(const char *what, const Stated &all) {
    for (int bin = 0; bin < kBins; ++bin) {
      double stated = 0.0, came = 0.0, variance = 0.0;
      int count = 0;
      for (std::size_t k = 0; k < all.probability.size(); ++k) {
        const double p = all.probability[k];
        if (std::min(kBins - 1, int(kBins * p)) != bin)
          continue;
        ++count;
        stated += p;
        came += all.came[k];
        variance += p * (1.0 - p);
      }
      error += std::abs(stated - came) / double(all.probability.size());
      by_chance += std::sqrt(2.0 / kPi * variance) / double(all.probability.size());
      if (count > 0)
        std::printf("%s: %d with %.2f, true %.2f\n", what, count, stated / count, came / count);
    }
    std::printf("%s: calibration error %.3f, by chance %.3f\n", what, error, by_chance);
  }
};

constexpr int kFeatures = 10, kEffects = 4;

/// A cause that the table does not have: a signature of its own, or one that departs from a known
/// one by half of its length.
Vector outside(const LinearWorld &world, bool alike, double amplitude, Random &random) {
  Vector own(kFeatures);
  for (double &v : own)
    v = random.normal();
  own /= Cholesky(world.covariance).matrixL().solve(own).norm();
  if (!alike)
    return amplitude * own;
  return amplitude * (world.signatures.col(int(random.uniform() * kEffects)) + 0.5 * own);
}

// As many worlds as the priors say have no cause, one of the table's effects, or a cause outside the
// table: of these 0.4 too small to be seen, 0.48 that depart from something known, the rest of any
// direction. The bound is the gate of the sealed rounds, 0.05, beyond chance.
class Calibrated : public testing::TestWithParam<double> {};

TEST_P(Calibrated, ProbabilitiesOfTheUnknownAndOfTheNamed) {
  WhichSettings settings;
  settings.noise = false;
  settings.evidence.samples = 64;
  settings.priors.pair_share = 0.0;
  settings.pairs = 0;
  settings.beside = 0;
  Stated unknown, named, visible;
  const int worlds = calendem_test::with_all(400, 100);
  for (int w = 0; w < worlds; ++w) {
    LinearWorld world(kFeatures, 2, kEffects, std::uint64_t(5000 + w));
    world.amplitude = GetParam();
    Random random(std::uint64_t(w), 31);
    Vector mean = world.centre;
    for (int j = 0; j < 2; ++j)
      mean += random.normal() * world.sensitivity.col(j);
    const double amplitude = world.amplitude + world.spread * random.normal();
    const double kind = random.uniform(), place = random.uniform();
    const bool hidden = kind >= 0.75, seen = hidden && place >= 0.4;
    std::string truth = hidden ? "unknown" : "none";
    if (kind >= 0.4 && !hidden) {
      const int effect = int(random.uniform() * kEffects);
      truth = "effect " + std::to_string(effect);
      mean += amplitude * world.signatures.col(effect);
    }
    if (seen)
      mean += outside(world, place < 0.88, amplitude, random);
    const Which found = which(world.problem(world.draw(mean, world.covariance, random)), settings);
    unknown.add(found.of("unknown").probability, hidden);
    if (seen || !hidden)
      visible.add(found.of("unknown").probability, hidden);
    for (int e = 0; e < kEffects; ++e) {
      const std::string name = "effect " + std::to_string(e);
      named.add(found.inclusion.at(name), truth == name);
    }
  }
  const Calibration of_unknown("unknown", unknown), of_named("effect", named);
  std::printf("area under the ROC curve of the unknown, where it can be seen: %.3f\n",
              auroc(visible.probability, visible.came));
  EXPECT_LE(of_unknown.error, 0.05 + of_unknown.by_chance);
  EXPECT_LE(of_named.error, 0.05 + of_named.by_chance);
}

INSTANTIATE_TEST_SUITE_P(Amplitudes, Calibrated, testing::Values(4.0, 8.0));

} // namespace
} // namespace calendem::inference
