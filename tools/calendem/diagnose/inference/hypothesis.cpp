// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/hypothesis.h"
#include "diagnose/inference/scatter.h"
#include <cmath>

namespace calendem::inference {
namespace {

constexpr double kSizeStep = 1e-4; // of differences

} // namespace

const Prior kUnknownSize{Prior::log_uniform, 1.0, 30.0};
const Prior kNoiseFactor{Prior::log_uniform, 1.5, 5.0};

Likelihood::Likelihood(const Problem &problem, const Hypothesis &hypothesis, const Matrix &unknown)
    : problem_(problem), hypothesis_(hypothesis), unknown_(unknown) {}

/// Its last score is that of a factor or a standard deviation that no prediction depends on.
bool Likelihood::has_size() const {
  return hypothesis_.kind == Hypothesis::noise ||
         (hypothesis_.kind == Hypothesis::unknown && hypothesis_.size == 0.0);
}

int Likelihood::dimension() const {
  int n = problem_.base_parameters + has_size();
  for (const int e : hypothesis_.on)
    n += int(problem_.effects[e].parameters.size());
  return n;
}

std::vector<Applied> applied_at(const Problem &problem, const Hypothesis &hypothesis,
                                const Vector &scores) {
  std::vector<Applied> on;
  Eigen::Index next = problem.base_parameters;
  for (const int e : hypothesis.on) {
    const auto n = Eigen::Index(problem.effects[e].parameters.size());
    on.push_back({e, scores.segment(next, n)});
    next += n;
  }
  return on;
}

double Likelihood::noise_factor(const Vector &scores) const {
  return kNoiseFactor.value(scores[scores.size() - 1]);
}

/// The prediction of emulators or formula.
Prediction Likelihood::bare(const Vector &scores) const {
  return problem_.predict(scores.head(problem_.base_parameters),
                          applied_at(problem_, hypothesis_, scores));
}

/// With what understated noise adds to truncation residuals.
Prediction Likelihood::shifted(const Vector &scores, const Prediction &bare) const {
  Prediction p = bare;
  if (hypothesis_.kind == Hypothesis::noise)
    for (const Roughness &r : problem_.roughness)
      p.mean[r.feature] += score_moments(r.measured, noise_factor(scores)).mean;
  return p;
}

Prediction Likelihood::predict(const Vector &scores) const { return shifted(scores, bare(scores)); }

Matrix Likelihood::covariance(const Vector &scores, const Prediction &prediction) const {
  Matrix total = covariance_about(problem_, prediction);
  if (hypothesis_.kind == Hypothesis::noise) {
    const double factor = noise_factor(scores);
    total += (factor * factor - 1.0) * problem_.measurement;
    for (const Roughness &r : problem_.roughness)
      total(r.feature, r.feature) = score_moments(r.measured, factor).variance;
  } else if (hypothesis_.kind == Hypothesis::unknown) {
    const double sd = has_size() ? kUnknownSize.value(scores[scores.size() - 1]) : hypothesis_.size;
    total += sd * sd * unknown_;
  }
  return total;
}

double Likelihood::log_about(const Vector &scores, const Prediction &bare) const {
  const Prediction p = shifted(scores, bare);
  const Cholesky factor(covariance(scores, p));
  const Matrix lower = factor.matrixL();
  const double square = factor.matrixL().solve(problem_.observed - p.mean).squaredNorm();
  return log_student_t(square, 2.0 * lower.diagonal().array().log().sum(), int(p.mean.size()),
                       problem_.degrees_of_freedom) +
         log_of_points(scores);
}

/// What the points of curves say: ln of their density under this noise over that of errors as
/// stated, which is that under every other hypothesis.
double Likelihood::log_of_points(const Vector &scores) const {
  if (hypothesis_.kind != Hypothesis::noise)
    return 0.0;
  double sum = 0.0;
  for (const PointNoise &p : problem_.point_noise) {
    const NormalMoments larger = score_moments(p.measured, noise_factor(scores));
    const double off = p.score - larger.mean;
    sum += 0.5 * (p.score * p.score - off * off / larger.variance - std::log(larger.variance));
  }
  return sum;
}

double Likelihood::log(const Vector &scores) const { return log_about(scores, bare(scores)); }

Slopes Likelihood::bare_slopes(const Vector &scores) const {
  return slopes_of(problem_, scores.head(problem_.base_parameters),
                   applied_at(problem_, hypothesis_, scores));
}

Misfit Likelihood::misfit(const Vector &scores, const Slopes &bare) const {
  const Prediction p = shifted(scores, bare.here);
  return misfit_of(problem_, problem_.observed, p, covariance(scores, p), bare);
}

double Likelihood::log(const Vector &scores, Vector &gradient) const {
  const Slopes here = bare_slopes(scores);
  const Misfit m = misfit(scores, here);
  const int n = int(here.mean.rows());
  const double nu = problem_.degrees_of_freedom;
  const double pull = nu >= kNormal ? 1.0 : (nu + n) / (nu + m.square);
  const auto predicted = m.square_slopes.size();
  gradient.head(predicted) = -0.5 * (pull * m.square_slopes + m.determinant_slopes);
  if (has_size()) {
    Vector moved = scores;
    double &last = moved[predicted];
    last = scores[predicted] + kSizeStep;
    const double above = log_about(moved, here.here);
    last = scores[predicted] - kSizeStep;
    gradient[predicted] = (above - log_about(moved, here.here)) / (2.0 * kSizeStep);
  }
  return log_student_t(m.square, m.log_determinant, n, nu) + log_of_points(scores);
}

double Likelihood::square(const Vector &scores, Vector &gradient) const {
  const Misfit m = misfit(scores, bare_slopes(scores));
  gradient = m.square_slopes;
  return m.square;
}

double Likelihood::deviance(const Vector &scores, Vector &gradient) const {
  const Misfit m = misfit(scores, bare_slopes(scores));
  gradient = m.square_slopes + m.determinant_slopes;
  return m.square + m.log_determinant;
}

Evidence evidence(const Likelihood &likelihood, const EvidenceSettings &settings) {
  return evidence(
      likelihood.dimension(), [&](const Vector &s) { return likelihood.log(s); }, settings,
      [&](const Vector &s, Vector &gradient) { return likelihood.log(s, gradient); });
}

} // namespace calendem::inference
