// SPDX-License-Identifier: GPL-2.0-or-later
// A world in which everything is linear and normal, so that every answer has a closed form.
#ifndef CALENDEM_TESTS_DIAGNOSE_LINEAR_WORLD_H
#define CALENDEM_TESTS_DIAGNOSE_LINEAR_WORLD_H

#include "base/random.h"
#include "diagnose/inference/problem.h"
#include "diagnose/inference/scatter.h"
#include "diagnose/inference/which.h"

namespace calendem::inference {

/// Few samples; single effects only, and an unknown beside none.
inline WhichSettings quick() {
  WhichSettings s;
  s.noise = false;
  s.evidence.samples = 128;
  s.priors.pair_share = 0.0;
  s.pairs = 0;
  s.beside = 0;
  return s;
}

struct LinearWorld {
  Vector centre;
  Matrix sensitivity; ///< features x base parameters
  Matrix signatures;  ///< features x effects, per unit amplitude
  Matrix covariance;
  double amplitude = 4.0, spread = 1.0; ///< of every effect's normal prior

  /// Signatures of unit length in the inverse covariance; correlated noise.
  LinearWorld(int features, int base, int effects, std::uint64_t seed) {
    Random random(seed, 1);
    const auto filled = [&](int rows, int columns) {
      Matrix m(rows, columns);
      for (double &v : m.reshaped())
        v = random.normal();
      return m;
    };
    centre = filled(features, 1);
    sensitivity = filled(features, base);
    const Matrix mix = filled(features, features);
    covariance =
        0.3 * mix * mix.transpose() / features + 0.5 * Matrix::Identity(features, features);
    signatures = filled(features, effects);
    const Cholesky factor(covariance);
    for (int e = 0; e < effects; ++e)
      signatures.col(e) /= factor.matrixL().solve(Vector(signatures.col(e))).norm();
  }

  Vector draw(const Vector &mean, const Matrix &of, Random &random) const {
    Vector normal(mean.size());
    for (double &v : normal)
      v = random.normal();
    return mean + Cholesky(of).matrixL() * normal;
  }
  /// Mean and covariance of data before anything is known; `effect` -1: none.
  Vector mean_of(int effect) const {
    return effect < 0 ? centre : Vector(centre + amplitude * signatures.col(effect));
  }
  Matrix covariance_of(int effect) const {
    Matrix c = covariance + sensitivity * sensitivity.transpose();
    if (effect >= 0)
      c += spread * spread * signatures.col(effect) * signatures.col(effect).transpose();
    return c;
  }
  double exact_evidence(int effect, const Vector &data) const {
    const Cholesky factor(covariance_of(effect));
    const Matrix lower = factor.matrixL();
    return log_student_t(factor.matrixL().solve(data - mean_of(effect)).squaredNorm(),
                         2.0 * lower.diagonal().array().log().sum(), int(data.size()), kNormal);
  }

  /// Every feature is a scalar observable of its own. The problem refers to this world.
  Problem problem(const Vector &data) const {
    Problem p;
    const int n = int(centre.size());
    p.observed = data;
    for (int f = 0; f < n; ++f) {
      p.features.push_back({f, true});
      p.blocks.push_back(
          {"observable " + std::to_string(f), f % 2 ? "relaxation" : "compression", "c", {f}});
    }
    p.measurement = covariance;
    p.scatter = Matrix::Zero(n, n);
    p.base_parameters = int(sensitivity.cols());
    for (int e = 0; e < signatures.cols(); ++e)
      p.effects.push_back({"effect " + std::to_string(e),
                           {{"amplitude", {Prior::normal, amplitude, spread}, true}}});
    p.discrepancy = covariance.diagonal().asDiagonal();
    p.predict = [this](const Vector &base, const std::vector<Applied> &on) {
      Prediction out{centre + sensitivity * base, Vector::Zero(centre.size())};
      for (const Applied &a : on)
        out.mean += (amplitude + spread * a.scores[0]) * signatures.col(a.effect);
      return out;
    };
    return p;
  }
};

} // namespace calendem::inference

#endif
