// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/moves.h"
#include <algorithm>
#include <numeric>

namespace calendem::inference {
namespace {

using Eigen::Index;

constexpr std::size_t kModels = 4;       // sizes of the discrepancy with a local model
const double kSteps[] = {1.0, 0.5, 0.2}; // of the errors' scores, one chosen at random

/// The middle of the particles: mean scores, and effects that act in most of them.
Draw pivot_of(const Ensemble &ensemble, const std::vector<Particle> &particles, int material) {
  Draw out = particles.front().draw;
  const double n = double(particles.size());
  out.scores.col(material).setZero();
  for (const Particle &p : particles)
    out.scores.col(material) += p.draw.scores.col(material) / n;
  for (const Switch &s : switches_of(ensemble.problem(), material)) {
    double sum = 0.0, acting = 0.0;
    for (const Particle &p : particles)
      if (const double score = score_of(p.draw, material, s); acts(score)) {
        sum += score;
        ++acting;
      }
    score_of(out, material, s) = acting > 0.5 * n ? sum / acting : kOff;
  }
  return out;
}

const LocalModel &nearest(const std::vector<LocalModel> &models, const Draw &draw) {
  return *std::min_element(models.begin(), models.end(),
                           [&](const LocalModel &a, const LocalModel &b) {
                             return std::fabs(std::log(a.discrepancy() / draw.discrepancy)) <
                                    std::fabs(std::log(b.discrepancy() / draw.discrepancy));
                           });
}

/// Residuals of a material's films, one behind another.
Vector residual_of(const PosteriorProblem &problem, const std::vector<int> &films,
                   const Particle &particle) {
  Index n = 0, at = 0;
  for (const int f : films)
    n += problem.films[std::size_t(f)].observed.size();
  Vector out(n);
  for (const int f : films) {
    const Vector &observed = problem.films[std::size_t(f)].observed;
    out.segment(at, observed.size()) = observed - particle.states[std::size_t(f)].mean;
    at += observed.size();
  }
  return out;
}

/// Effects, or none, that may stand in the place of one; what does is the choice.
class Exchange {
public:
  Exchange(const Ensemble &ensemble, int material, const LocalModel &model,
           const Particle &particle)
      : problem_(ensemble.problem()), material_(material), model_(model),
        switches_(switches_of(problem_, material)), films_(films_of(problem_, material)),
        prior_(material_given(problem_, particle.draw, material)) {
    for (const Switch &s : switches_) {
      const double p = problem_.effects[std::size_t(s.effect)].probability;
      priors_.push_back(s.film < 0 ? SwitchPrior{prior_.log_odds[s.effect],
                                                 prior_.amplitudes[std::size_t(s.effect)]}
                                   : SwitchPrior{p < 1.0 ? std::log(p / (1.0 - p)) : INFINITY, {}});
    }
  }

  /// Switches that act, and -1 for none.
  std::vector<int> slots(const Draw &draw) const {
    std::vector<int> out = {-1};
    for (int s = 0; s < int(switches_.size()); ++s)
      if (acts(score_of(draw, material_, switches_[std::size_t(s)])))
        out.push_back(s);
    return out;
  }
  Choice choice_in(const Draw &draw, int slot) const {
    return slot < 0 ? Choice{}
                    : Choice{slot, score_of(draw, material_, switches_[std::size_t(slot)])};
  }
  /// What could be chosen when `now` is taken out of the particle.
  Choices choices(const Particle &particle, const Choice &now) const {
    const bool fixed = now.place >= 0 && is_known(now.place);
    std::vector<char> open;
    for (int s = 0; s < int(switches_.size()); ++s)
      open.push_back(s == now.place ||
                     (!fixed && !is_known(s) && !acts(choice_in(particle.draw, s).score)));
    Vector residual = residual_of(problem_, films_, particle),
           offset = particle.draw.scores.col(material_) - prior_.mean;
    if (now.place >= 0) {
      residual += model_.change(now);
      offset -= model_.shift(now);
    }
    return {model_, residual, offset, priors_, open, !fixed};
  }
  void replace(const Choice &now, const Choice &by, Draw &draw) const {
    if (now.place >= 0) {
      score_of(draw, material_, switches_[std::size_t(now.place)]) = kOff;
      draw.scores.col(material_) -= model_.shift(now);
    }
    if (by.place >= 0) {
      score_of(draw, material_, switches_[std::size_t(by.place)]) = by.score;
      draw.scores.col(material_) += model_.shift(by);
    }
  }
  /// ln prior of the parameters and of a choice, but for a constant.
  double log_prior(const Draw &draw, const Choice &choice) const {
    const double off = (draw.scores.col(material_) - prior_.mean).squaredNorm() / prior_.variance;
    if (choice.place < 0)
      return -0.5 * off;
    const SwitchPrior &p = priors_[std::size_t(choice.place)];
    const double score = choice.score - p.score.mean;
    return -0.5 *
               (off + score * score / p.score.variance + std::log(2.0 * kPi * p.score.variance)) +
           (std::isfinite(p.log_odds) ? p.log_odds : 0.0);
  }

private:
  const PosteriorProblem &problem_;
  int material_;
  const LocalModel &model_;
  std::vector<Switch> switches_;
  std::vector<int> films_;
  MaterialPrior prior_;
  std::vector<SwitchPrior> priors_;
  bool is_known(int place) const { return std::isinf(priors_[std::size_t(place)].log_odds); }
};

/// What a proposal exchanges.
struct Exchanged {
  Choice now, by;
};

Exchanged propose_exchange(const Exchange &exchange, const Particle &from, Random &random,
                           ProposedMove &p) {
  const std::vector<int> slots = exchange.slots(from.draw);
  const int slot = slots[std::size_t(random.uniform() * double(slots.size()))];
  Exchanged e;
  e.now = exchange.choice_in(from.draw, slot);
  const Choices choices = exchange.choices(from, e.now);
  e.by = choices.draw(random);
  p.moved = e.now.place >= 0 || e.by.place >= 0;
  if (!p.moved)
    return e;
  exchange.replace(e.now, e.by, p.to.draw);
  p.log_ratio = exchange.log_prior(p.to.draw, e.by) - exchange.log_prior(from.draw, e.now) -
                choices.log_density(e.by) + std::log(double(slots.size()));
  return e;
}

/// Adds the chance of the way back.
void add_way_back(const Exchange &exchange, const Exchanged &e, ProposedMove &p) {
  p.log_ratio += exchange.choices(p.to, e.by).log_density(e.now) -
                 std::log(double(exchange.slots(p.to.draw).size()));
}

/// A new score from a standard normal one, which it leaves as it is.
double moved_score(double score, Random &random) {
  const double step = kSteps[int(random.uniform() * 3.0)];
  return std::sqrt(1.0 - step * step) * score + step * random.normal();
}

void move_value(double &value, const Prior &prior, Random &random) {
  value = prior.value(moved_score(prior.score(value), random));
}

/// A move of the errors that asks for no prediction.
template <class Change> void move_all(Ensemble &ensemble, const Change &change) {
  std::vector<ProposedMove> proposals = ensemble.proposals();
  ensemble.begin_move();
  for (std::size_t k = 0; k < proposals.size(); ++k) {
    Random random = ensemble.random(k);
    proposals[k].moved = true;
    change(proposals[k], random);
  }
  ensemble.weigh(-1, proposals);
  ensemble.accept(proposals);
}

/// Off or on, with a new factor; half of the proposals each.
void move_understatement(const PosteriorProblem &problem, ProposedMove &p, Random &random) {
  Vector &factors = p.to.draw.understatement;
  double &factor = factors[Index(random.uniform() * double(factors.size()))];
  const auto log_chance = [&] {
    return std::log(factor > 1.0 ? problem.understated : 1.0 - problem.understated);
  };
  const double before = log_chance();
  const bool on = random.uniform() < 0.5;
  factor = on ? problem.understatement.value(random.normal()) : 1.0;
  p.log_ratio = log_chance() - before;
}

} // namespace

std::vector<LocalModel> local_models(Ensemble &ensemble, int material) {
  const std::vector<Particle> &particles = ensemble.particles();
  const PosteriorProblem &problem = ensemble.problem();
  const Neighbourhood near =
      neighbourhood_of(problem, pivot_of(ensemble, particles, material), material);
  ensemble.count_states(near.states);
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return particles[a].draw.discrepancy < particles[b].draw.discrepancy;
  });
  std::vector<LocalModel> out;
  for (std::size_t k = 0; k < kModels; ++k) {
    const Draw &errors = particles[order[(2 * k + 1) * order.size() / (2 * kModels)]].draw;
    out.emplace_back(problem, near, errors, material_given(problem, errors, material).variance,
                     ensemble.temperature());
  }
  return out;
}

double move_switches(Ensemble &ensemble, int material, const std::vector<LocalModel> &models) {
  const std::vector<Particle> &from = ensemble.particles();
  std::vector<ProposedMove> proposals = ensemble.proposals();
  std::vector<Exchange> exchanges;
  std::vector<Exchanged> exchanged;
  ensemble.begin_move();
  for (std::size_t k = 0; k < proposals.size(); ++k) {
    Random random = ensemble.random(k);
    exchanges.emplace_back(ensemble, material, nearest(models, from[k].draw), from[k]);
    exchanged.push_back(propose_exchange(exchanges[k], from[k], random, proposals[k]));
  }
  ensemble.predict(material, proposals);
  ensemble.weigh(material, proposals);
  for (std::size_t k = 0; k < proposals.size(); ++k)
    if (proposals[k].moved && std::isfinite(proposals[k].to.log_likelihood))
      add_way_back(exchanges[k], exchanged[k], proposals[k]);
  return ensemble.accept(proposals);
}

double move_parameters(Ensemble &ensemble, int material, const std::vector<LocalModel> &models,
                       double step) {
  const PosteriorProblem &problem = ensemble.problem();
  const std::vector<Particle> &from = ensemble.particles();
  const std::vector<int> films = films_of(problem, material);
  const double keep = std::sqrt(1.0 - step * step);
  std::vector<ProposedMove> proposals = ensemble.proposals();
  ensemble.begin_move();
  const auto mean = [&](const Particle &p, const Vector &prior_mean) -> Vector {
    const Vector scores = p.draw.scores.col(material);
    const Vector centre =
        nearest(models, p.draw).centre(residual_of(problem, films, p), scores, prior_mean);
    return centre + keep * (scores - centre);
  };
  for (std::size_t k = 0; k < proposals.size(); ++k) {
    Random random = ensemble.random(k);
    const MaterialPrior prior = material_given(problem, from[k].draw, material);
    Vector normal(problem.parameters);
    for (double &v : normal)
      v = random.normal();
    proposals[k].moved = true;
    proposals[k].to.draw.scores.col(material) =
        mean(from[k], prior.mean) + step * (nearest(models, from[k].draw).spread() * normal);
    const auto off = [&](const Draw &d) {
      return (d.scores.col(material) - prior.mean).squaredNorm() / prior.variance;
    };
    proposals[k].log_ratio =
        0.5 * (off(from[k].draw) - off(proposals[k].to.draw) + normal.squaredNorm());
  }
  ensemble.predict(material, proposals);
  ensemble.weigh(material, proposals);
  for (std::size_t k = 0; k < proposals.size(); ++k) {
    ProposedMove &p = proposals[k];
    if (!std::isfinite(p.to.log_likelihood))
      continue;
    const MaterialPrior prior = material_given(problem, from[k].draw, material);
    const Vector back = from[k].draw.scores.col(material) - mean(p.to, prior.mean);
    p.log_ratio -= 0.5 * nearest(models, p.to.draw).square(back) / (step * step);
  }
  return ensemble.accept(proposals);
}

void move_errors(Ensemble &ensemble) {
  const PosteriorProblem &problem = ensemble.problem();
  move_all(ensemble, [&](ProposedMove &p, Random &random) {
    move_value(p.to.draw.discrepancy, problem.discrepancy, random);
  });
  if (problem.films.size() > 1)
    move_all(ensemble, [&](ProposedMove &p, Random &random) {
      move_value(p.to.draw.shared, kShareOfVariance, random);
    });
  if (problem.materials > 1)
    move_all(ensemble, [&](ProposedMove &p, Random &random) {
      const double before = log_density_of_materials(problem, p.to.draw);
      move_value(p.to.draw.material_correlation, kShareOfVariance, random);
      p.log_ratio = log_density_of_materials(problem, p.to.draw) - before;
    });
  if (problem.understated > 0.0)
    move_all(ensemble,
             [&](ProposedMove &p, Random &random) { move_understatement(problem, p, random); });
}

} // namespace calendem::inference
