// SPDX-License-Identifier: GPL-2.0-or-later
#include "withheld/baselines.h"
#include "diagnose/inference/chances.h"
#include <Eigen/Cholesky>
#include <cmath>

namespace calendem {
namespace {
using inference::Matrix;
using inference::Problem;
using inference::Vector;

/// Residual and signatures in units in which noise and recalibration have covariance 1.
struct Whitened {
  Vector residual;
  std::vector<std::vector<Vector>> signatures; ///< of each effect, two
};

Whitened whitened(const Problem &problem, const inference::Linearised &base) {
  const Eigen::LLT<Matrix> root(inference::recalibrated_covariance(base));
  const auto white = [&](const Vector &v) { return Vector(root.matrixL().solve(v)); };
  Whitened out;
  // before recalibration within the priors: r + J at, whose covariance is S + J J^T
  out.residual = white(problem.observed - base.mean + base.sensitivity * base.at);
  for (int e = 0; e < int(problem.effects.size()); ++e) {
    out.signatures.emplace_back();
    const Eigen::Index n = Eigen::Index(problem.effects[std::size_t(e)].parameters.size());
    for (const double score : {-1.0, 1.0})
      out.signatures.back().push_back(
          white(problem.predict(base.at, {{e, Vector::Constant(n, score)}}).mean - base.mean));
  }
  return out;
}

/// The effect with the largest value, by its better signature.
template <typename Value> std::string best(const Problem &problem, const Whitened &w, Value value) {
  std::string name = "none";
  double most = 0.0;
  for (std::size_t e = 0; e < w.signatures.size(); ++e)
    for (const Vector &s : w.signatures[e])
      if (const double v = s.norm() > 0.0 ? value(s) : 0.0; v > most) {
        most = v;
        name = problem.effects[e].name;
      }
  return name;
}

std::string by_largest_residual(const Problem &problem, const inference::Diagnosis &d,
                                const Whitened &w) {
  if (d.where.rows.empty() || !d.where.rows.front().significant)
    return "none";
  const std::vector<int> members =
      inference::features_by_block(problem)[std::size_t(d.where.rows.front().block)];
  return best(problem, w, [&](const Vector &s) { return Vector(s(members)).norm() / s.norm(); });
}

std::string by_cosine(const Problem &problem, const Whitened &w) {
  if (inference::chance_beyond(w.residual.squaredNorm(), int(w.residual.size()),
                               problem.degrees_of_freedom) > 0.05)
    return "none";
  return best(problem, w,
              [&](const Vector &s) { return s.dot(w.residual) / (s.norm() * w.residual.norm()); });
}

std::string by_bic(const Problem &problem, const inference::Which &which) {
  std::string name = "none";
  double least = INFINITY;
  for (const inference::Judged &j : which.judged) {
    if (j.hypothesis.kind != inference::Hypothesis::none && !j.hypothesis.single())
      continue;
    const inference::Likelihood likelihood(problem, j.hypothesis, Matrix());
    const double bic = -2.0 * likelihood.log(j.evidence.mode) +
                       likelihood.dimension() * std::log(double(problem.observed.size()));
    if (bic < least) {
      least = bic;
      name = j.hypothesis.name;
    }
  }
  return name;
}

} // namespace

std::map<std::string, std::string> baselines(const Problem &problem,
                                             const inference::Diagnosis &d) {
  const Whitened w = whitened(problem, d.which.base);
  return {{"always none", "none"},
          {"largest residual", by_largest_residual(problem, d, w)},
          {"cosine match", by_cosine(problem, w)},
          {"BIC", by_bic(problem, d.which)}};
}

} // namespace calendem
