// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/pairs.h"
#include "diagnose/inference/scatter.h"
#include <algorithm>
#include <cmath>

namespace calendem::inference {

namespace {

constexpr int kPoints = 16; // of each effect's prior

/// What an effect changes at each point of its prior, about one point of the base parameters.
std::vector<Prediction> changes_of(const Problem &problem, const Vector &base, int effect,
                                   const Prediction &without) {
  const auto parameters = int(problem.effects[std::size_t(effect)].parameters.size());
  const Matrix points = sobol_normals(parameters, kPoints, 0);
  std::vector<Prediction> changes;
  for (int k = 0; k < kPoints; ++k) {
    Prediction p = problem.predict(base, {{effect, points.col(k)}});
    p.mean -= without.mean;
    p.variance = (p.variance - without.variance).cwiseMax(0.0);
    changes.push_back(std::move(p));
  }
  return changes;
}

/// The base model about the fit of one effect, and what every effect changes there.
struct About {
  Vector apart; ///< observed - expected before anything is known of the base parameters
  Matrix covariance;
  std::vector<std::vector<Prediction>> changes;

  About(const Problem &problem, const Vector &base) {
    const Linearised line = linearise(problem, base);
    apart = problem.observed - line.mean + line.sensitivity * line.at;
    covariance = recalibrated_covariance(line);
    const Prediction without = problem.predict(base, {});
    for (int e = 0; e < int(problem.effects.size()); ++e)
      changes.push_back(changes_of(problem, base, e, without));
  }

  double log_likelihood(const Problem &problem, const Prediction &a, const Prediction &b) const {
    const Prediction both{
        {}, a.variance + b.variance, a.scatter.size() > 0 ? a.scatter + b.scatter : a.scatter};
    const Cholesky factor(covariance + errors_of(problem, both));
    const Matrix lower = factor.matrixL();
    return log_student_t(factor.matrixL().solve(apart - a.mean - b.mean).squaredNorm(),
                         2.0 * lower.diagonal().array().log().sum(), int(apart.size()),
                         problem.degrees_of_freedom);
  }

  double log_evidence(const Problem &problem, int a, int b) const {
    double top = -INFINITY, sum = 0.0;
    for (const Prediction &of_a : changes[std::size_t(a)])
      for (const Prediction &of_b : changes[std::size_t(b)]) {
        const double here = log_likelihood(problem, of_a, of_b);
        sum = here > top ? sum * std::exp(top - here) + 1.0 : sum + std::exp(here - top);
        top = std::max(top, here);
      }
    return top + std::log(sum / double(kPoints * kPoints));
  }
};

} // namespace

std::vector<Promise> promising_pairs(const Problem &problem, const Which &so_far) {
  std::vector<About> about;
  for (const ModelledEffect &e : problem.effects)
    about.emplace_back(problem, so_far.of(e.name).evidence.mode.head(problem.base_parameters));
  std::vector<Promise> all;
  for (int b = 1; b < int(about.size()); ++b)
    for (int a = 0; a < b; ++a)
      all.push_back(
          {{Hypothesis::effects,
            {a, b},
            problem.effects[std::size_t(a)].name + " + " + problem.effects[std::size_t(b)].name,
            0.0},
           std::max(about[std::size_t(a)].log_evidence(problem, a, b),
                    about[std::size_t(b)].log_evidence(problem, a, b))});
  std::stable_sort(all.begin(), all.end(), [](const Promise &one, const Promise &other) {
    return one.log_evidence > other.log_evidence;
  });
  return all;
}

} // namespace calendem::inference
