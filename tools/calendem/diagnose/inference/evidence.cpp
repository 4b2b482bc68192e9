// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/evidence.h"
#include "diagnose/inference/scatter.h"
#include "inference/numerics.h"
#include "physics/pi.h"
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numeric>

namespace calendem::inference {

namespace {

constexpr int kStarts = 32;    // points of the prior among which the search for modes begins
constexpr int kModes = 3;      // at most
constexpr int kAgain = 3;      // passes with a better proposal
constexpr double kApart = 1.0; // distance of modes in their own covariance, below which one is kept
constexpr double kStep = 0.01; // of second derivatives, in standard deviations of the prior

using Density = std::function<double(const Vector &)>;

double log_prior(const Vector &scores) {
  return -0.5 * (scores.squaredNorm() + double(scores.size()) * std::log(2.0 * kPi));
}

/// Inverse of the second derivatives; directions that bend less than the prior get the prior's.
Matrix laplace_covariance(const Matrix &second) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(second);
  const Vector bent = eigen.eigenvalues().cwiseMax(0.5);
  return eigen.eigenvectors() * bent.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
}

Peak peak_near(const WithGradient &falling, const Vector &start) {
  const Minimum found = minimise(falling, start);
  return {found.at, laplace_covariance(hessian(falling, found.at, kStep)), -found.value};
}

std::vector<Peak> modes_of(const Density &density, const WithGradient &falling, int dimension) {
  Matrix starts = Matrix::Zero(dimension, kStarts + 1);
  starts.rightCols(kStarts) = sobol_normals(dimension, kStarts, 0);
  std::vector<std::pair<double, int>> order;
  for (int k = 0; k <= kStarts; ++k)
    order.emplace_back(-density(starts.col(k)), k);
  std::stable_sort(order.begin(), order.end());
  std::vector<Peak> peaks;
  for (int k = 0; k < kModes; ++k) {
    const Peak found = peak_near(falling, starts.col(order[k].second));
    bool known = false;
    for (const Peak &p : peaks)
      known |= Cholesky(p.covariance).matrixL().solve(found.at - p.at).norm() < kApart;
    if (!known)
      peaks.push_back(found);
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Peak &a, const Peak &b) { return a.log_density > b.log_density; });
  return peaks;
}

double laplace_evidence(const Peak &peak) {
  const Matrix factor = Cholesky(peak.covariance).matrixL();
  return peak.log_density + factor.diagonal().array().log().sum() +
         0.5 * double(peak.at.size()) * std::log(2.0 * kPi);
}

struct WeightedPoints {
  Matrix points;
  Vector log_weights;
};

double log_mean(const Vector &logs) {
  const double top = logs.maxCoeff();
  return std::isfinite(top) ? top + std::log((logs.array() - top).exp().mean()) : top;
}

/// Evidence, its error, the share of effective samples and the moments of the posterior.
void summarise(const std::vector<WeightedPoints> &passes, Evidence &e) {
  Vector each(Eigen::Index(passes.size()));
  e.samples = 0;
  for (Eigen::Index s = 0; s < each.size(); ++s) {
    each[s] = log_mean(passes[s].log_weights);
    e.samples += int(passes[s].log_weights.size());
  }
  e.log_evidence = log_mean(each);
  const Eigen::ArrayXd relative = (each.array() - e.log_evidence).exp();
  e.error =
      each.size() < 2
          ? 0.0
          : std::sqrt((relative - 1.0).square().sum() / double(each.size() * (each.size() - 1)));
  const auto d = e.mode.size();
  double sum = 0.0, squares = 0.0;
  e.mean = Vector::Zero(d);
  Matrix second = Matrix::Zero(d, d);
  for (const WeightedPoints &pass : passes) {
    const Vector w = (pass.log_weights.array() - e.log_evidence).exp();
    sum += w.sum();
    squares += w.squaredNorm();
    e.mean += pass.points * w;
    second += pass.points * w.asDiagonal() * pass.points.transpose();
  }
  e.mean /= sum;
  e.covariance = second / sum - e.mean * e.mean.transpose();
  e.effective_samples = sum * sum / squares;
}

/// The sample that weighs most: where the proposal lacks a component, if too few count.
Vector heaviest(const std::vector<WeightedPoints> &passes) {
  const WeightedPoints *best = nullptr;
  Eigen::Index at = 0, here = 0;
  for (const WeightedPoints &pass : passes)
    if (pass.log_weights.maxCoeff(&here); !best || pass.log_weights[here] > best->log_weights[at]) {
      best = &pass;
      at = here;
    }
  return best->points.col(at);
}

/// Where the weighted samples lie, wider the fewer of them count.
Peak cloud(const Evidence &e) {
  const double few = 1.0 / e.effective_samples;
  Matrix covariance = (1.0 + 2.0 * few) * e.covariance;
  covariance.diagonal().array() += few;
  return {e.mean, covariance, 0.0};
}

/// Systematic resampling: every draw stands for the same share of the weight.
Matrix resampled(const std::vector<WeightedPoints> &passes, const Evidence &e, int count) {
  Matrix draws(e.mode.size(), count);
  double total = 0.0, passed = 0.0;
  for (const WeightedPoints &pass : passes)
    total += (pass.log_weights.array() - e.log_evidence).exp().sum();
  int next = 0;
  for (const WeightedPoints &pass : passes)
    for (Eigen::Index k = 0; k < pass.log_weights.size(); ++k) {
      passed += std::exp(pass.log_weights[k] - e.log_evidence) / total;
      while (next < count && (next + 0.5) / count <= passed)
        draws.col(next++) = pass.points.col(k);
    }
  while (next < count) // rounding of the last
    draws.col(next++) = e.mode;
  return draws;
}

std::vector<WeightedPoints> sample(const Density &density, const Proposal &proposal,
                                   const EvidenceSettings &settings) {
  std::vector<WeightedPoints> passes;
  for (int s = 0; s < settings.shifts; ++s) {
    WeightedPoints pass;
    pass.points = proposal.points(settings.samples, settings.seed + std::uint64_t(s));
    pass.log_weights.resize(pass.points.cols());
    for (Eigen::Index k = 0; k < pass.points.cols(); ++k)
      pass.log_weights[k] =
          density(pass.points.col(k)) - proposal.log_density(pass.points.col(k), settings.samples);
    passes.push_back(std::move(pass));
  }
  return passes;
}

} // namespace

Evidence evidence(int dimension, const Density &log_likelihood, const EvidenceSettings &settings,
                  const WithGradient &with_gradient) {
  Evidence e;
  e.mode = Vector::Zero(dimension);
  if (dimension == 0) {
    e.log_evidence = e.laplace = log_likelihood(e.mode);
    e.samples = 1;
    e.effective_samples = 1.0;
    e.mean = e.mode;
    e.covariance = Matrix::Zero(0, 0);
    e.draws = Matrix::Zero(0, settings.draws);
    return e;
  }
  const Density density = [&](const Vector &x) { return log_likelihood(x) + log_prior(x); };
  const WithGradient likelihood = with_gradient ? with_gradient : with_differences(log_likelihood);
  const WithGradient falling = [&](const Vector &x, Vector &gradient) {
    const double value = -likelihood(x, gradient) - log_prior(x);
    gradient = x - gradient;
    return value;
  };
  const std::vector<Peak> peaks = modes_of(density, falling, dimension);
  e.mode = peaks.front().at;
  e.laplace = laplace_evidence(peaks.front());
  double log_density_of_mode = peaks.front().log_density;
  Proposal proposal(peaks);
  auto passes = sample(density, proposal, settings);
  summarise(passes, e);
  for (int again = 0; again < kAgain && e.effective_samples < settings.least_share * e.samples;
       ++again) {
    const Peak higher = peak_near(falling, heaviest(passes));
    proposal.add(higher);
    proposal.add(cloud(e));
    if (higher.log_density > log_density_of_mode) {
      log_density_of_mode = higher.log_density;
      e.mode = higher.at;
      e.laplace = laplace_evidence(higher);
    }
    passes = sample(density, proposal, settings);
    summarise(passes, e);
  }
  e.draws = resampled(passes, e, settings.draws);
  return e;
}

namespace {

constexpr double kDegrees = 6.0; // of the t distributions: tails heavier than any posterior here
constexpr double kPrior = 0.15;  // share of the points that come from the prior

} // namespace

Proposal::Proposal(const std::vector<Peak> &peaks) {
  for (const Peak &p : peaks)
    add(p);
}

void Proposal::add(const Peak &peak) {
  Component c{peak.at, Cholesky(peak.covariance).matrixL(), 0.0};
  c.log_determinant = 2.0 * c.factor.diagonal().array().log().sum();
  components_.push_back(c);
}

int Proposal::of_prior(int count) const { return int(std::lround(kPrior * count)); }

int Proposal::of_component(int which, int count) const {
  const int rest = count - of_prior(count), n = int(components_.size());
  return rest / n + (which < rest % n ? 1 : 0);
}

Matrix Proposal::points(int count, std::uint64_t shift) const {
  const int d = int(components_.front().at.size());
  const boost::math::chi_squared squares(kDegrees);
  Matrix all(d, count);
  int next = of_prior(count);
  all.leftCols(next) = sobol_normals(d, next, shift);
  for (int c = 0; c < int(components_.size()); ++c) {
    const int n = of_component(c, count);
    const Matrix uniform = sobol_points(d + 1, n, shift);
    for (int k = 0; k < n; ++k) {
      const Vector normal = uniform.col(k).head(d).unaryExpr(&normal_quantile);
      const double stretch = std::sqrt(kDegrees / quantile(squares, uniform(d, k)));
      all.col(next + k) = components_[c].at + stretch * (components_[c].factor * normal);
    }
    next += n;
  }
  return all;
}

double Proposal::log_density(const Vector &point, int count) const {
  const int d = int(point.size());
  const double prior = double(of_prior(count)) / count;
  Vector logs(Eigen::Index(components_.size()) + 1);
  logs[0] = std::log(prior) + log_student_t(point.squaredNorm(), 0.0, d, kNormal);
  for (int c = 0; c < int(components_.size()); ++c) {
    const Component &at = components_[c];
    const double square =
        at.factor.triangularView<Eigen::Lower>().solve(point - at.at).squaredNorm();
    logs[c + 1] = std::log(double(of_component(c, count)) / count) +
                  log_student_t(square, at.log_determinant, d, kDegrees);
  }
  const double top = logs.maxCoeff();
  return top + std::log((logs.array() - top).exp().sum());
}

} // namespace calendem::inference
