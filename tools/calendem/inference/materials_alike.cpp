// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/materials_alike.h"
#include "base/random.h"

namespace calendem::inference {
namespace {

using Eigen::Index;

/// ln of the probability that an effect acts in `acting` materials and not in the others, over the
/// probability (1 - sqrt(rho))^n that none of them follows.
double log_agreement(double probability, int acting, int not_acting, double correlation) {
  const double follow = std::sqrt(correlation), odds = follow / (1.0 - follow);
  const auto followed = [&](double p, int n) { return p * (std::pow(1.0 + odds / p, n) - 1.0); };
  const double off = 1.0 - probability;
  return std::log(1.0 + followed(probability, acting) + followed(off, not_acting)) +
         acting * std::log(probability) + not_acting * std::log(off);
}

/// ln density of n normal scores of which any two are correlated, without 2 pi.
double log_density_together(double sum, double squares, int n, double correlation) {
  const double apart = 1.0 - correlation, all = 1.0 + (n - 1) * correlation;
  return -0.5 * ((n - 1) * std::log(apart) + std::log(all) +
                 (squares - correlation * sum * sum / all) / apart);
}

/// Scores of one effect in materials.
struct Amplitudes {
  int acting = 0, not_acting = 0;
  double sum = 0.0, squares = 0.0;
  void add(double score) {
    if (!acts(score)) {
      ++not_acting;
      return;
    }
    ++acting;
    sum += score;
    squares += score * score;
  }
};

} // namespace

ScorePrior score_given(double sum, int others, double correlation) {
  const double pull = others > 0 ? correlation / (1.0 + (others - 1) * correlation) : 0.0;
  return {pull * sum, 1.0 - others * correlation * pull};
}

double log_odds_given(double probability, int acting, int not_acting, double correlation) {
  if (probability >= 1.0)
    return INFINITY;
  if (acting + not_acting == 0)
    return std::log(probability / (1.0 - probability));
  return log_agreement(probability, acting + 1, not_acting, correlation) -
         log_agreement(probability, acting, not_acting + 1, correlation);
}

MaterialPrior material_given(const PosteriorProblem &problem, const Draw &draw, int material) {
  MaterialPrior out;
  const double rho = draw.material_correlation;
  out.mean = Vector::Zero(problem.parameters);
  for (Index m = 0; m < draw.scores.cols(); ++m)
    if (m != material)
      out.mean += draw.scores.col(m);
  const int others = int(draw.scores.cols()) - (material < draw.scores.cols());
  const ScorePrior one = score_given(1.0, others, rho);
  out.mean *= one.mean;
  out.variance = one.variance;
  out.log_odds.resize(Index(problem.effects.size()));
  for (std::size_t e = 0; e < problem.effects.size(); ++e) {
    Amplitudes known;
    for (Index m = 0; m < draw.amplitudes.cols() && !problem.effects[e].of_film; ++m)
      if (m != material)
        known.add(draw.amplitudes(Index(e), m));
    out.amplitudes.push_back(score_given(known.sum, known.acting, rho));
    out.log_odds[Index(e)] =
        log_odds_given(problem.effects[e].probability, known.acting, known.not_acting, rho);
  }
  return out;
}

double log_density_of_materials(const PosteriorProblem &problem, const Draw &draw) {
  if (problem.materials < 2)
    return 0.0;
  const double rho = draw.material_correlation;
  const int n = problem.materials;
  double out = 0.0;
  for (Index p = 0; p < draw.scores.rows(); ++p)
    out += log_density_together(draw.scores.row(p).head(n).sum(),
                                draw.scores.row(p).head(n).squaredNorm(), n, rho);
  for (std::size_t e = 0; e < problem.effects.size(); ++e) {
    if (problem.effects[e].of_film)
      continue;
    Amplitudes all;
    for (int m = 0; m < n; ++m)
      all.add(draw.amplitudes(Index(e), m));
    if (all.acting > 0)
      out += log_density_together(all.sum, all.squares, all.acting, rho);
    if (problem.effects[e].probability < 1.0)
      out += log_agreement(problem.effects[e].probability, all.acting, all.not_acting, rho) +
             n * std::log(1.0 - std::sqrt(rho));
  }
  return out;
}

Draw with_another_material(const PosteriorProblem &problem, const Draw &draw, std::uint64_t seed,
                           std::uint64_t purpose) {
  Random random(seed, purpose);
  const auto next = draw.scores.cols();
  const MaterialPrior prior = material_given(problem, draw, int(next));
  Draw out = draw;
  out.scores.conservativeResize(Eigen::NoChange, next + 1);
  out.amplitudes.conservativeResize(Eigen::NoChange, next + 1);
  for (Index p = 0; p < out.scores.rows(); ++p)
    out.scores(p, next) = prior.mean[p] + std::sqrt(prior.variance) * random.normal();
  for (Index e = 0; e < out.amplitudes.rows(); ++e) {
    const double chosen = random.uniform(), own = random.normal();
    const ScorePrior &amplitude = prior.amplitudes[std::size_t(e)];
    const bool on = !problem.effects[std::size_t(e)].of_film &&
                    chosen < 1.0 / (1.0 + std::exp(-prior.log_odds[e]));
    out.amplitudes(e, next) = on ? amplitude.mean + std::sqrt(amplitude.variance) * own : kOff;
  }
  return out;
}

} // namespace calendem::inference
