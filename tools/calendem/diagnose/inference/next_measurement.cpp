// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/next_measurement.h"
#include "base/random.h"
#include "diagnose/inference/scatter.h"
#include <algorithm>
#include <cmath>

namespace calendem::inference {
namespace {

constexpr int kDraws = 60;                 // of a posterior, for the moments of what it predicts
constexpr std::uint64_t kPurpose = 0x4e87; // of the stream of simulated data

/// What a hypothesis expects of the new features, given the old.
struct Forecast {
  double probability = 0.0;
  Vector mean;
  Cholesky covariance;
  double log_determinant = 0.0;
};

/// The hypotheses that count, their probabilities made to sum to 1.
std::vector<const Judged *> leading(const Which &which, const NextSettings &settings) {
  std::vector<const Judged *> some;
  double sum = 0.0;
  for (const Judged &j : which.judged)
    if (int(some.size()) < settings.leading && sum < settings.covered) {
      some.push_back(&j);
      sum += j.probability;
    }
  return some;
}

/// The unknown has no idea of new features beyond their own discrepancy.
Matrix extended_unknown(const Which &which, const Problem &extended) {
  Matrix all = extended.discrepancy;
  const auto old = which.unknown.rows();
  all.topLeftCorner(old, old) = which.unknown;
  all.topRightCorner(old, all.cols() - old).setZero();
  all.bottomLeftCorner(all.rows() - old, old).setZero();
  return all;
}

Forecast forecast(const Judged &judged, const Problem &p, const Matrix &unknown) {
  const Likelihood likelihood(p, judged.hypothesis, unknown);
  const auto old = p.observed.size(), added = Eigen::Index(p.features.size()) - old;
  const Matrix &draws = judged.evidence.draws;
  const int n = std::min(kDraws, int(draws.cols()));
  Matrix means(added, n), rest = Matrix::Zero(added, added);
  for (int k = 0; k < n; ++k) {
    const Vector scores = draws.col(k * draws.cols() / n);
    const Prediction at = likelihood.predict(scores);
    const Matrix c = likelihood.covariance(scores, at);
    const Matrix gain =
        Cholesky(c.topLeftCorner(old, old)).solve(c.topRightCorner(old, added)).transpose();
    means.col(k) = at.mean.tail(added) + gain * (p.observed - at.mean.head(old));
    rest += (c.bottomRightCorner(added, added) - gain * c.topRightCorner(old, added)) / n;
  }
  Forecast f;
  f.probability = judged.probability;
  f.mean = means.rowwise().mean();
  const Matrix apart = means.colwise() - f.mean;
  f.covariance = Cholesky(rest + apart * apart.transpose() / std::max(1, n - 1));
  const Matrix lower = f.covariance.matrixL();
  f.log_determinant = 2.0 * lower.diagonal().array().log().sum();
  return f;
}

/// Mean over simulated data of the probability that the hypothesis they come from is given.
double expected(const std::vector<Forecast> &forecasts, const NextSettings &settings) {
  Random random(settings.seed, kPurpose);
  const auto n = forecasts.front().mean.size();
  double sum = 0.0;
  Vector normal(n);
  for (const Forecast &truth : forecasts)
    for (int k = 0; k < settings.simulations; ++k) {
      for (double &v : normal)
        v = random.normal();
      const Vector data = truth.mean + truth.covariance.matrixL() * normal;
      double all = 0.0, own = 0.0;
      for (const Forecast &f : forecasts) {
        const double square = f.covariance.matrixL().solve(data - f.mean).squaredNorm();
        const double p =
            f.probability * std::exp(log_student_t(square, f.log_determinant, int(n), kNormal) +
                                     0.5 * truth.log_determinant);
        all += p;
        own += &f == &truth ? p : 0.0;
      }
      sum += truth.probability * (all > 0.0 ? own / all : 0.0) / settings.simulations;
    }
  return sum;
}

} // namespace

std::vector<NextMeasurement> next_measurements(const Which &which,
                                               const std::vector<Extension> &candidates,
                                               const NextSettings &settings) {
  const auto some = leading(which, settings);
  double sum = 0.0, now = 0.0;
  for (const Judged *j : some)
    sum += j->probability;
  for (const Judged *j : some)
    now += j->probability * j->probability / (sum * sum);
  std::vector<NextMeasurement> list;
  for (const Extension &candidate : candidates) {
    const Matrix unknown = extended_unknown(which, candidate.extended);
    std::vector<Forecast> forecasts;
    for (const Judged *j : some) {
      forecasts.push_back(forecast(*j, candidate.extended, unknown));
      forecasts.back().probability /= sum;
    }
    NextMeasurement next{candidate.what, candidate.cost, now, expected(forecasts, settings), 0.0};
    next.per_cost = next.cost > 0.0 ? (next.expected_probability - now) / next.cost : 0.0;
    list.push_back(next);
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const NextMeasurement &a, const NextMeasurement &b) {
                     return a.expected_probability > b.expected_probability;
                   });
  return list;
}

} // namespace calendem::inference
