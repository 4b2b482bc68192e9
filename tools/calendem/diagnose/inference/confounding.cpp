// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/confounding.h"
#include "inference/numerics.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace calendem::inference {

namespace {

constexpr int kShapes = 3;        // values of each parameter that is not the first amplitude
constexpr double kFarthest = 8.0; // score of a prior's lower end
// Rivals whose linear log-odds are beyond this many times what separates them are not
// recalibrated: the tangents overrate a distance by up to two.
constexpr double kLookAgain = 4.0;

int first_amplitude(const ModelledEffect &effect) {
  for (int j = 0; j < int(effect.parameters.size()); ++j)
    if (effect.parameters[j].amplitude)
      return j;
  return 0;
}

const Prior &first_prior(const ModelledEffect &effect) {
  return effect.parameters[std::size_t(first_amplitude(effect))].prior;
}

/// How far the first amplitude's prior reaches above (1) or below (-1) zero.
double reach(const ModelledEffect &effect, double sign) {
  const Prior &p = first_prior(effect);
  return sign > 0.0 ? p.upper() : std::max(0.0, -p.value(-kFarthest));
}

/// Scores of an effect at a share of its first amplitude's range (below 0: of what is below zero),
/// the others at quantiles.
Vector at_share(const ModelledEffect &effect, double share, int shape) {
  Vector scores(Eigen::Index(effect.parameters.size()));
  const int first = first_amplitude(effect);
  for (int j = 0; j < scores.size(); ++j) {
    const Prior &p = effect.parameters[j].prior;
    scores[j] = j == first ? p.score(share * reach(effect, share))
                           : normal_quantile((shape + 1.0) / (kShapes + 1.0));
    shape = j == first ? shape : shape / 2 + 1; // a second shape parameter goes another way
  }
  return scores;
}

/// Signatures of an effect over its amplitudes, of both signs where it has them, and shapes; the
/// first is "off".
std::vector<Signature> grid_of(const Signatures &signatures, const Problem &problem, int effect,
                               int steps) {
  const ModelledEffect &e = problem.effects[effect];
  const int shapes = e.parameters.size() > 1 ? kShapes : 1;
  std::vector<Signature> grid{signatures.off()};
  for (const double sign : {1.0, -1.0})
    for (int s = 0; s < shapes && reach(e, sign) > 0.0; ++s)
      for (int k = 0; k < steps; ++k)
        grid.push_back(
            signatures.of({{effect, at_share(e, sign * (k + 1.0) / steps, shapes == 1 ? 1 : s)}}));
  return grid;
}

/// The amplitude and shape at which the rival is hardest to distinguish from the truth.
const Signature &nearest(const Signature &truth, const std::vector<Signature> &rival) {
  return *std::min_element(rival.begin(), rival.end(), [&](const Signature &a, const Signature &b) {
    return Signatures::odds(truth, a) < Signatures::odds(truth, b);
  });
}

/// The hardest rival at an amplitude, and the log-odds against it.
struct Hardest {
  double odds = 0.0;
  std::string rival = "none";
};

/// First amplitude up to `reach` at which the log-odds are enough, between the steps by their growth
/// with its square; NaN: none. `odds`: at the k-th step, from 0; once they are below a given number
/// it need not look on. `rival`: of the last amplitude looked at.
template <class Odds>
double first_decisive(double reach, const ConfoundingSettings &settings, const Odds &odds,
                      std::string &rival) {
  for (int k = 1; k <= settings.amplitudes; ++k) {
    const Hardest here = odds(k - 1, settings.decisive);
    if (here.odds < settings.decisive)
      continue;
    rival = here.rival;
    const double before = k == 1 ? 0.0 : odds(k - 2, -INFINITY).odds;
    const double from = std::sqrt(std::max(before, 0.0));
    const double within = (std::sqrt(settings.decisive) - from) / (std::sqrt(here.odds) - from);
    return (k - 1 + within) / settings.amplitudes * reach;
  }
  rival = odds(settings.amplitudes - 1, -INFINITY).rival;
  return std::nan("");
}

/// What having an amplitude to choose costs the effect's evidence beside none's, at each step from
/// 0 to `end`: ln of the amplitude's prior width over the width that the data leave it, by
/// Laplace's integral.
std::vector<double> occam_of(const Prior &p, double end, const std::vector<Signature> &truths,
                             const Signature &off) {
  const double step = end / double(truths.size());
  std::vector<double> cost;
  for (std::size_t k = 0; k < truths.size(); ++k) {
    const Vector &below = k == 0 ? off.mean : truths[k - 1].mean;
    const double slope = (truths[k].mean - below).norm() / std::fabs(step); // sd per unit
    const double widths = slope / (std::sqrt(2.0 * kPi) * p.density(double(k + 1) * step));
    cost.push_back(widths > 1.0 ? std::log(widths) : 0.0);
  }
  return cost;
}

/// Amplitudes of one sign at which the effect is distinguished from none and from every other
/// effect: how far from zero.
DetectionLimit limit_on(double sign, const Problem &problem, int effect,
                        const std::vector<std::vector<Signature>> &grids,
                        const Signatures &signatures, const ConfoundingSettings &settings) {
  const ModelledEffect &e = problem.effects[effect];
  std::vector<Signature> truths;
  for (int k = 1; k <= settings.amplitudes; ++k)
    truths.push_back(
        signatures.of({{effect, at_share(e, sign * k / double(settings.amplitudes), 1)}}));
  std::vector<double> of_none(truths.size(), NAN); // both limits ask for them
  const auto from_none = [&](int k, double) {
    double &odds = of_none[std::size_t(k)];
    if (std::isnan(odds))
      odds = signatures.odds_recalibrated(truths[k], grids[effect].front());
    return Hardest{odds};
  };
  const double end = reach(e, sign);
  const std::vector<double> occam = occam_of(first_prior(e), sign * end, truths, signatures.off());
  const auto from_all = [&](int k, double enough) {
    Hardest least = from_none(k, enough);
    least.odds -= occam[std::size_t(k)];
    for (int other = 0; other < int(grids.size()) && least.odds >= enough; ++other) {
      const Signature &rival = nearest(truths[k], grids[other]);
      if (other == effect || Signatures::odds(truths[k], rival) > kLookAgain * settings.decisive)
        continue;
      if (const double odds = signatures.odds_recalibrated(truths[k], rival); odds < least.odds)
        least = {odds, problem.effects[other].name};
    }
    return least;
  };
  DetectionLimit limit{e.name, "none"};
  std::string none;
  limit.amplitude = first_decisive(end, settings, from_all, limit.rival);
  limit.against_none = first_decisive(end, settings, from_none, none);
  return limit;
}

/// The limit on both sides of zero: the farther one. A side on which it is never distinguished
/// counts with all its reach.
DetectionLimit limit_of(const Problem &problem, int effect,
                        const std::vector<std::vector<Signature>> &grids,
                        const Signatures &signatures, const ConfoundingSettings &settings) {
  const ModelledEffect &e = problem.effects[effect];
  const Prior &p = first_prior(e);
  const auto least = std::max(0.0, p.value(-kFarthest));
  DetectionLimit limit = limit_on(1.0, problem, effect, grids, signatures, settings);
  limit.amplitude = std::max(limit.amplitude, least); // NaN stays
  limit.against_none = std::max(limit.against_none, least);
  if (reach(e, -1.0) == 0.0)
    return limit;
  const DetectionLimit other = limit_on(-1.0, problem, effect, grids, signatures, settings);
  const auto farther = [&](double above, double below) {
    if (std::isnan(above) && std::isnan(below))
      return above;
    return std::max(std::isnan(above) ? reach(e, 1.0) : above,
                    std::isnan(below) ? reach(e, -1.0) : below);
  };
  const bool below = std::isnan(other.amplitude) || other.amplitude > limit.amplitude;
  return {e.name, below ? other.rival : limit.rival, farther(limit.amplitude, other.amplitude),
          farther(limit.against_none, other.against_none)};
}

/// Groups of hypotheses of the 95 % set linked by log-odds too small to distinguish them.
std::vector<std::vector<std::string>> alike(const Problem &problem, const Which &which,
                                            const Signatures &signatures, double decisive) {
  std::vector<std::string> names;
  std::vector<Vector> at;
  for (const std::string &name : which.set95) {
    const Judged &j = which.of(name);
    if (j.hypothesis.kind != Hypothesis::none && j.hypothesis.kind != Hypothesis::effects)
      continue;
    names.push_back(name);
    at.push_back(signatures.white(applied_at(problem, j.hypothesis, j.evidence.mode)));
  }
  std::vector<int> group(names.size());
  std::iota(group.begin(), group.end(), 0);
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (0.5 * (at[i] - at[j]).squaredNorm() < decisive)
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
  const Signatures signatures(problem, which.base);
  const int n = int(problem.effects.size());
  Confounding c;
  c.absorbed = Vector::Zero(n);
  c.log_odds = Matrix::Zero(n, n + 1);
  Matrix half(problem.observed.size(), n);
  std::vector<std::vector<Signature>> grids;
  std::vector<Signature> half_way;
  for (int e = 0; e < n; ++e) {
    const Vector scores = at_share(problem.effects[e], 0.5, 1);
    c.effects.push_back(problem.effects[e].name);
    half_way.push_back(signatures.of({{e, scores}}));
    half.col(e) = half_way.back().mean;
    c.absorbed[e] = signatures.absorbed({{e, scores}});
    grids.push_back(grid_of(signatures, problem, e, settings.amplitudes));
  }
  const Vector length = half.colwise().norm().cwiseMax(1e-300);
  c.cosine = length.cwiseInverse().asDiagonal() * (half.transpose() * half) *
             length.cwiseInverse().asDiagonal();
  for (int e = 0; e < n; ++e) {
    for (int other = 0; other < n; ++other)
      c.log_odds(e, other) =
          other == e ? 0.0 : Signatures::odds(half_way[e], nearest(half_way[e], grids[other]));
    c.log_odds(e, n) = Signatures::odds(half_way[e], grids[e].front());
    c.limits.push_back(limit_of(problem, e, grids, signatures, settings));
  }
  c.indistinguishable = alike(problem, which, signatures, settings.decisive);
  return c;
}

namespace {

double log_determinant(const Cholesky &factor) {
  return 2.0 * Matrix(factor.matrixL()).diagonal().array().log().sum();
}

} // namespace

Signatures::Signatures(const Problem &problem, const Linearised &base)
    : problem_(problem), base_(base), factor_(recalibrated_covariance(base)),
      base_variance_(problem.predict(base.at, {}).variance) {}

Vector Signatures::raw(const std::vector<Applied> &on) const {
  return problem_.predict(base_.at, on).mean - base_.mean;
}

Vector Signatures::white(const std::vector<Applied> &on) const {
  return factor_.matrixL().solve(raw(on));
}

Signature Signatures::off() const {
  return {{}, Vector::Zero(base_.mean.size()), {}, 0.0, double(base_.mean.size())};
}

Signature Signatures::of(const std::vector<Applied> &on) const {
  const Prediction p = problem_.predict(base_.at, on);
  Signature s = off();
  s.on = on;
  s.mean = factor_.matrixL().solve(p.mean - base_.mean);
  const Prediction more{{}, (p.variance - base_variance_).cwiseMax(0.0), p.scatter};
  const Matrix errors = errors_of(problem_, more);
  if (errors.diagonal().maxCoeff() == 0.0)
    return s;
  const auto identity = Matrix::Identity(errors.rows(), errors.cols());
  const Matrix half = factor_.matrixL().solve(errors);
  const Cholesky sum(Matrix(identity + factor_.matrixL().solve(half.transpose())));
  s.precision = sum.solve(identity);
  s.log_determinant = log_determinant(sum);
  s.trace = s.precision.trace();
  return s;
}

double Signatures::absorbed(const std::vector<Applied> &on) const {
  const Vector s = raw(on);
  const double before = s.dot(Cholesky(base_.covariance).solve(s));
  return before > 0.0 ? 1.0 - s.dot(factor_.solve(s)) / before : 0.0;
}

double Signatures::odds(const Signature &truth, const Signature &rival) {
  const Vector apart = rival.mean - truth.mean;
  const double square =
      rival.precision.size() == 0 ? apart.squaredNorm() : apart.dot(rival.precision * apart);
  return 0.5 * (square + rival.log_determinant - truth.log_determinant + rival.trace - truth.trace);
}

double Signatures::odds_recalibrated(const Signature &truth, const Signature &rival) const {
  if (base_.at.size() == 0)
    return odds(truth, rival);
  const Vector seen = problem_.predict(base_.at, truth.on).mean;
  const Prediction unmoved = problem_.predict(base_.at, rival.on);
  const Matrix covariance = covariance_about(problem_, unmoved);
  const double usual = log_determinant(Cholesky(covariance));
  const auto square = [&](const Vector &scores, Vector &gradient) {
    const Slopes all = slopes_of(problem_, scores, rival.on);
    const auto n = scores.size(); // what the rival's own amplitude does is not asked
    const Slopes slopes{all.mean.leftCols(n), all.variance.leftCols(n),
                        all.scatter.leftCols(all.scatter.size() > 0 ? n : 0), all.here};
    const Misfit m =
        misfit_of(problem_, seen, all.here, covariance_about(problem_, all.here), slopes);
    gradient = m.square_slopes + m.determinant_slopes + 2.0 * (scores - base_.at);
    return m.square + m.log_determinant - usual + (scores - base_.at).squaredNorm();
  };
  Vector unused(base_.at.size());
  const Matrix &s = base_.sensitivity;
  const Vector linear =
      base_.at +
      s.transpose() * Cholesky(covariance + s * s.transpose()).solve(seen - unmoved.mean);
  const Vector start = square(linear, unused) < square(base_.at, unused) ? linear : base_.at;
  const double least = minimise(square, start).value;
  return 0.5 * (least + rival.log_determinant - truth.log_determinant + rival.trace - truth.trace);
}

} // namespace calendem::inference
