// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/proposal.h"
#include "diagnose/inference/scatter.h"
#include "diagnose/inference/sobol_points.h"
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace calendem::inference {
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
