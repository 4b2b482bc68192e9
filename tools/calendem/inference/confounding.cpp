// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/confounding.h"
#include "inference/sobol_points.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace calendem::inference {
namespace {

constexpr int kShapes = 3; // values of each parameter that is not the first amplitude

/// What effects add to the features, whitened by the recalibrated covariance.
class Signatures {
public:
  Signatures(const Problem &problem, const Which &which)
      : problem_(problem), base_(which.base), factor_(recalibrated_covariance(which.base)) {}
  Vector raw(const std::vector<Applied> &on) const {
    return problem_.predict(base_.at, on).mean - base_.mean;
  }
  Vector white(const std::vector<Applied> &on) const { return factor_.matrixL().solve(raw(on)); }
  Vector of(int effect, const Vector &scores) const { return white({{effect, scores}}); }
  /// Share of the squared length that recalibration takes up.
  double absorbed(int effect, const Vector &scores) const {
    const Vector s = raw({{effect, scores}});
    const double before = s.dot(Cholesky(base_.covariance).solve(s));
    return before > 0.0 ? 1.0 - s.dot(factor_.solve(s)) / before : 0.0;
  }

private:
  const Problem &problem_;
  const Linearised &base_;
  Cholesky factor_;
};

int first_amplitude(const Effect &effect) {
  for (int j = 0; j < int(effect.parameters.size()); ++j)
    if (effect.parameters[j].amplitude)
      return j;
  return 0;
}

/// Scores of an effect at a share of its first amplitude's range, the others at quantiles.
Vector at_share(const Effect &effect, double share, int shape) {
  Vector scores(Eigen::Index(effect.parameters.size()));
  const int first = first_amplitude(effect);
  for (int j = 0; j < scores.size(); ++j) {
    const Prior &p = effect.parameters[j].prior;
    scores[j] =
        j == first ? p.score(share * p.upper()) : normal_quantile((shape + 1.0) / (kShapes + 1.0));
    shape = j == first ? shape : shape / 2 + 1; // a second shape parameter goes another way
  }
  return scores;
}

/// Signatures of an effect over its amplitudes and shapes; the first column is "off".
Matrix grid_of(const Signatures &signatures, const Problem &problem, int effect, int steps) {
  const Effect &e = problem.effects[effect];
  const int shapes = e.parameters.size() > 1 ? kShapes : 1;
  Matrix grid = Matrix::Zero(problem.observed.size(), 1 + steps * shapes);
  for (int s = 0; s < shapes; ++s)
    for (int k = 0; k < steps; ++k)
      grid.col(1 + s * steps + k) =
          signatures.of(effect, at_share(e, (k + 1.0) / steps, shapes == 1 ? 1 : s));
  return grid;
}

double log_odds(const Vector &truth, const Matrix &rival) {
  return 0.5 * (rival.colwise() - truth).colwise().squaredNorm().minCoeff();
}

/// First amplitude at which the effect is told from none and from every other effect.
DetectionLimit limit_of(const Problem &problem, int effect, const std::vector<Matrix> &grids,
                        const Signatures &signatures, const ConfoundingSettings &settings) {
  const Effect &e = problem.effects[effect];
  DetectionLimit limit{e.name, "none", std::nan("")};
  double before = 0.0; // log-odds at the step below
  for (int k = 1; k <= settings.amplitudes; ++k) {
    const double share = double(k) / settings.amplitudes;
    const Vector truth = signatures.of(effect, at_share(e, share, 1));
    double least = 0.5 * truth.squaredNorm();
    std::string rival = "none";
    for (int other = 0; other < int(grids.size()); ++other) {
      const double odds = other == effect ? INFINITY : log_odds(truth, grids[other]);
      if (odds < least) {
        least = odds;
        rival = problem.effects[other].name;
      }
    }
    limit.rival = rival;
    if (least >= settings.telling) { // the odds grow with the square of the amplitude
      const double within = (std::sqrt(settings.telling) - std::sqrt(before)) /
                            std::max(std::sqrt(least) - std::sqrt(before), 1e-300);
      const Prior &p = e.parameters[first_amplitude(e)].prior;
      limit.amplitude = (k - 1 + within) / settings.amplitudes * p.upper();
      return limit;
    }
    before = least;
  }
  return limit;
}

/// Signature of a hypothesis at its mode.
Vector fitted(const Problem &problem, const Signatures &signatures, const Judged &j) {
  std::vector<Applied> on;
  Eigen::Index next = problem.base_parameters;
  for (const int e : j.hypothesis.on) {
    const auto n = Eigen::Index(problem.effects[e].parameters.size());
    on.push_back({e, j.evidence.mode.segment(next, n)});
    next += n;
  }
  return signatures.white(on);
}

/// Groups of hypotheses of the 95 % set linked by log-odds too small to tell them apart.
std::vector<std::vector<std::string>> alike(const Problem &problem, const Which &which,
                                            const Signatures &signatures, double telling) {
  std::vector<std::string> names;
  std::vector<Vector> at;
  for (const std::string &name : which.set95) {
    const Judged &j = which.of(name);
    if (j.hypothesis.kind != Hypothesis::none && j.hypothesis.kind != Hypothesis::effects)
      continue;
    names.push_back(name);
    at.push_back(fitted(problem, signatures, j));
  }
  std::vector<int> group(names.size());
  std::iota(group.begin(), group.end(), 0);
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (0.5 * (at[i] - at[j]).squaredNorm() < telling)
        std::replace(group.begin(), group.end(), group[i], group[j]);
  std::vector<std::vector<std::string>> sets;
  for (int g = 0; g < int(names.size()); ++g) {
    std::vector<std::string> set;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (group[i] == g)
        set.push_back(names[i]);
    if (set.size() > 1)
      sets.push_back(set);
  }
  return sets;
}

} // namespace

Confounding confounding(const Problem &problem, const Which &which,
                        const ConfoundingSettings &settings) {
  const Signatures signatures(problem, which);
  const int n = int(problem.effects.size());
  Confounding c;
  c.absorbed = Vector::Zero(n);
  c.log_odds = Matrix::Zero(n, n + 1);
  Matrix half(problem.observed.size(), n);
  std::vector<Matrix> grids;
  for (int e = 0; e < n; ++e) {
    const Vector scores = at_share(problem.effects[e], 0.5, 1);
    c.effects.push_back(problem.effects[e].name);
    half.col(e) = signatures.of(e, scores);
    c.absorbed[e] = signatures.absorbed(e, scores);
    grids.push_back(grid_of(signatures, problem, e, settings.amplitudes));
  }
  const Vector length = half.colwise().norm().cwiseMax(1e-300);
  c.cosine = length.cwiseInverse().asDiagonal() * (half.transpose() * half) *
             length.cwiseInverse().asDiagonal();
  for (int e = 0; e < n; ++e) {
    for (int other = 0; other < n; ++other)
      c.log_odds(e, other) = other == e ? 0.0 : log_odds(half.col(e), grids[other]);
    c.log_odds(e, n) = 0.5 * half.col(e).squaredNorm();
    c.limits.push_back(limit_of(problem, e, grids, signatures, settings));
  }
  c.indistinguishable = alike(problem, which, signatures, settings.telling);
  return c;
}

} // namespace calendem::inference
