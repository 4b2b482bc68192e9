// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/local_model.h"
#include "base/normal_law.h"
#include "physics/pi.h"
#include <algorithm>
#include <boost/math/distributions/normal.hpp>

namespace calendem::inference {
namespace {

using Eigen::Index;

// Scores of amplitudes at which an effect is computed; between and beyond it is taken as linear.
constexpr int kNodes = 7;
constexpr double kFirstNode = -3.0;
constexpr double kStep = 0.5; // of a parameter's score, to either side of the pivot

double node(int k) { return kFirstNode + k; }

/// Probability that a standard normal is below, and its logarithm far out in the tail, too.
double log_below(double z) {
  if (z > -30.0)
    return std::log(normal_cdf(z));
  const double s = 1.0 / (z * z); // of Mills' ratio, relative error 15 s^3
  return -0.5 * z * z - 0.5 * std::log(2.0 * kPi) - std::log(-z) + std::log1p(-s + 3.0 * s * s);
}

/// A standard normal between two bounds, on the side on which its tail is computed without
/// cancellation.
struct Truncated {
  double low, high, side;
  Truncated(double from, double to)
      : low(from > 0.0 ? -to : from), high(from > 0.0 ? -from : to), side(from > 0.0 ? -1.0 : 1.0) {
  }
  double log_share() const {
    const double all = log_below(high);
    return std::isinf(low) ? all : all + std::log1p(-std::exp(log_below(low) - all));
  }
  double at(double share) const {
    const double bottom = std::isinf(low) ? 0.0 : std::exp(log_below(low) - log_below(high));
    const double wanted = log_below(high) + std::log(bottom + share * (1.0 - bottom));
    if (wanted > -15.0)
      return side * normal_quantile(std::min(std::exp(wanted), 1.0 - 1e-16));
    double z = high; // Newton: ln of the tail is concave and smooth
    for (int k = 0; k < 8; ++k)
      z -= (log_below(z) - wanted) /
           std::exp(-0.5 * z * z - 0.5 * std::log(2.0 * kPi) - log_below(z));
    return side * z;
  }
};

/// States of a material and one of its films, column by column.
struct StateList {
  Matrix scores, amplitudes;
};

/// Columns: the pivot, each parameter above and below it, then the switches that touch the film:
/// all without the effect where the pivot has it, and with it at each node.
StateList states_near(const PosteriorProblem &problem, const Draw &pivot, int material, int film,
                      const std::vector<Switch> &touching) {
  const Index p = problem.parameters, sides = 1 + 2 * p,
              count = sides + Index(touching.size()) * (kNodes + 1);
  StateList out;
  out.scores = pivot.scores.col(material).replicate(1, count);
  out.amplitudes = amplitudes_of(problem, pivot, film).replicate(1, count);
  for (Index k = 0; k < p; ++k) {
    out.scores(k, 1 + 2 * k) += kStep;
    out.scores(k, 2 + 2 * k) -= kStep;
  }
  Index column = sides;
  for (const Switch &s : touching) {
    out.amplitudes(s.effect, column++) = kOff;
    for (int k = 0; k < kNodes; ++k)
      out.amplitudes(s.effect, column++) = node(k);
  }
  return out;
}

} // namespace

double &score_of(Draw &draw, int material, const Switch &at) {
  return at.film < 0 ? draw.amplitudes(at.effect, material) : draw.faults(at.effect, at.film);
}
double score_of(const Draw &draw, int material, const Switch &at) {
  return at.film < 0 ? draw.amplitudes(at.effect, material) : draw.faults(at.effect, at.film);
}

std::vector<int> films_of(const PosteriorProblem &problem, int material) {
  std::vector<int> out;
  for (int f = 0; f < int(problem.films.size()); ++f)
    if (problem.films[std::size_t(f)].material == material)
      out.push_back(f);
  return out;
}

std::vector<Switch> switches_of(const PosteriorProblem &problem, int material) {
  std::vector<Switch> out;
  const std::vector<int> films = films_of(problem, material);
  for (int e = 0; e < int(problem.effects.size()); ++e)
    if (!problem.effects[std::size_t(e)].of_film)
      out.push_back({e, -1});
    else
      for (const int f : films)
        out.push_back({e, f});
  return out;
}

Neighbourhood neighbourhood_of(const PosteriorProblem &problem, const Draw &pivot, int material) {
  Neighbourhood out;
  out.films = films_of(problem, material);
  const std::vector<Switch> switches = switches_of(problem, material);
  Index data = 0, at = 0;
  for (const int f : out.films)
    data += problem.films[std::size_t(f)].observed.size();
  out.slopes.resize(data, problem.parameters);
  out.changes = Matrix::Zero(data, Index(switches.size()) * kNodes);
  for (const int f : out.films) {
    std::vector<Switch> touching;
    std::vector<Index> places;
    for (std::size_t s = 0; s < switches.size(); ++s)
      if (switches[s].film < 0 || switches[s].film == f) {
        touching.push_back(switches[s]);
        places.push_back(Index(s));
      }
    const StateList states = states_near(problem, pivot, material, f, touching);
    const FilmPredictions p = problem.predict(f, states.scores, states.amplitudes);
    out.states += states.scores.cols();
    out.pivot.push_back(state_of(p, 0));
    const Index n = p.mean.rows();
    for (Index k = 0; k < problem.parameters; ++k)
      out.slopes.block(at, k, n, 1) =
          (p.mean.col(1 + 2 * k) - p.mean.col(2 + 2 * k)) / (2.0 * kStep);
    for (std::size_t s = 0; s < touching.size(); ++s) {
      const Index off = 1 + 2 * problem.parameters + Index(s) * (kNodes + 1);
      out.changes.block(at, places[s] * kNodes, n, kNodes) =
          p.mean.middleCols(off + 1, kNodes).colwise() - p.mean.col(off);
    }
    at += n;
  }
  return out;
}

LocalModel::LocalModel(const PosteriorProblem &problem, const Neighbourhood &near,
                       const Draw &errors, double prior_variance, double temperature)
    : discrepancy_(errors.discrepancy), prior_variance_(prior_variance) {
  const Residuals data = residuals_of(problem, near.films, near.pivot, errors);
  const Cholesky covariance(data.covariance);
  const Matrix sloped = temperature * covariance.solve(near.slopes);
  Matrix precision = near.slopes.transpose() * sloped;
  precision.diagonal().array() += 1.0 / prior_variance;
  const Index p = precision.rows();
  const Matrix posterior = Cholesky(precision).solve(Matrix::Identity(p, p));
  spread_ = Cholesky(posterior).matrixL();
  gain_ = posterior * sloped.transpose();
  shifts_ = -gain_ * near.changes;
  changes_ = near.changes + near.slopes * shifts_;
  weights_ = temperature * covariance.solve(changes_);
  const auto inner = [&](Index a, Index b) {
    return changes_.col(a).dot(weights_.col(b)) +
           shifts_.col(a).dot(shifts_.col(b)) / prior_variance;
  };
  const Index columns = changes_.cols();
  squares_.resize(columns);
  products_ = Vector::Zero(columns);
  for (Index k = 0; k < columns; ++k) {
    squares_[k] = inner(k, k);
    if (k + 1 < columns)
      products_[k] = inner(k, k + 1);
  }
}

Index LocalModel::column(const Choice &choice, double &along) const {
  const int segment = std::clamp(int(std::floor(choice.score - kFirstNode)), 0, kNodes - 2);
  along = choice.score - node(segment);
  return Index(choice.place) * kNodes + segment;
}

Vector LocalModel::change(const Choice &choice) const {
  double along = 0.0;
  const Index k = column(choice, along);
  return (1.0 - along) * changes_.col(k) + along * changes_.col(k + 1);
}

Vector LocalModel::shift(const Choice &choice) const {
  double along = 0.0;
  const Index k = column(choice, along);
  return (1.0 - along) * shifts_.col(k) + along * shifts_.col(k + 1);
}

Vector LocalModel::centre(const Vector &residual, const Vector &scores,
                          const Vector &prior_mean) const {
  const Vector pull = spread_ * (spread_.transpose() * (prior_mean - scores)) / prior_variance_;
  return scores + gain_ * residual + pull;
}

double LocalModel::square(const Vector &scores) const {
  return spread_.triangularView<Eigen::Lower>().solve(scores).squaredNorm();
}

Choices::Choices(const LocalModel &model, const Vector &residual, const Vector &offset,
                 const std::vector<SwitchPrior> &priors, const std::vector<char> &open, bool none)
    : model_(model), priors_(priors), none_(none), log_total_(none ? 0.0 : -INFINITY) {
  linear_ = model.weights_.transpose() * residual -
            model.shifts_.transpose() * offset / model.prior_variance_;
  for (int place = 0; place < int(open.size()); ++place)
    for (int segment = 0; segment + 1 < kNodes && open[std::size_t(place)]; ++segment)
      parabolas_.push_back(parabola(place, segment));
  for (const Parabola &p : parabolas_)
    log_total_ = std::max(log_total_, p.log_mass);
  double sum = none ? std::exp(-log_total_) : 0.0;
  for (const Parabola &p : parabolas_)
    sum += std::exp(p.log_mass - log_total_);
  log_total_ += std::log(sum);
}

Choices::Parabola Choices::parabola(int place, int segment) const {
  const Index k = Index(place) * kNodes + segment;
  const SwitchPrior &prior = priors_[std::size_t(place)];
  const double v = prior.score.variance, off = node(segment) - prior.score.mean;
  const double a = model_.squares_[k], ab = model_.products_[k], b = model_.squares_[k + 1];
  Parabola p{};
  p.place = place;
  p.segment = segment;
  p.c0 = linear_[k] - 0.5 * a - 0.5 * off * off / v - 0.5 * std::log(2.0 * kPi * v);
  if (std::isfinite(prior.log_odds)) // else it is known to act
    p.c0 += prior.log_odds;
  p.c1 = linear_[k + 1] - linear_[k] - (ab - a) - off / v;
  p.c2 = std::max(0.0, a - 2.0 * ab + b) + 1.0 / v;
  const double scale = std::sqrt(p.c2), top = p.c1 / p.c2;
  const double low = segment == 0 ? -INFINITY : -top * scale;
  const double high = segment == kNodes - 2 ? INFINITY : (1.0 - top) * scale;
  p.log_mass =
      p.c0 + 0.5 * p.c1 * top + 0.5 * std::log(2.0 * kPi / p.c2) + Truncated(low, high).log_share();
  return p;
}

Choice Choices::draw(Random &random) const {
  double left = random.uniform();
  const double within = random.uniform();
  if (none_ && (left -= std::exp(-log_total_)) < 0.0)
    return {};
  const Parabola *chosen = nullptr;
  for (const Parabola &p : parabolas_) {
    chosen = &p;
    if ((left -= std::exp(p.log_mass - log_total_)) < 0.0)
      break;
  }
  if (chosen == nullptr)
    return {};
  const double scale = std::sqrt(chosen->c2), top = chosen->c1 / chosen->c2;
  const double low = chosen->segment == 0 ? -INFINITY : -top * scale;
  const double high = chosen->segment == kNodes - 2 ? INFINITY : (1.0 - top) * scale;
  double along = top + Truncated(low, high).at(within) / scale;
  if (chosen->segment > 0)
    along = std::max(along, 0.0);
  if (chosen->segment < kNodes - 2)
    along = std::min(along, 1.0);
  return {chosen->place, node(chosen->segment) + along};
}

double Choices::log_density(const Choice &choice) const {
  if (choice.place < 0)
    return -log_total_;
  double along = 0.0;
  const Index k = model_.column(choice, along);
  const Parabola p = parabola(choice.place, int(k % kNodes));
  return p.c0 + p.c1 * along - 0.5 * p.c2 * along * along - log_total_;
}

} // namespace calendem::inference
