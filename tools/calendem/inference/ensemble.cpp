// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/ensemble.h"
#include "inference/local_model.h"
#include "inference/materials_alike.h"

namespace calendem::inference {
namespace {

using Eigen::Index;

Draw prior_draw(const PosteriorProblem &problem, std::uint64_t seed, std::uint64_t particle) {
  Draw out;
  Random random(seed, particle);
  const auto effects = Index(problem.effects.size()), films = Index(problem.films.size());
  out.scores.resize(problem.parameters, 0);
  out.amplitudes.resize(effects, 0);
  out.discrepancy = problem.discrepancy.value(random.normal());
  out.shared = kShareOfVariance.value(random.normal());
  out.material_correlation = kShareOfVariance.value(random.normal());
  out.faults = Matrix::Constant(effects, films, kOff);
  for (Index e = 0; e < effects; ++e)
    for (Index f = 0; f < films && problem.effects[std::size_t(e)].of_film; ++f)
      if (random.uniform() < problem.effects[std::size_t(e)].probability)
        out.faults(e, f) = random.normal();
  out.understatement = Vector::Ones(films);
  for (double &u : out.understatement)
    if (random.uniform() < problem.understated)
      u = problem.understatement.value(random.normal());
  for (int m = 0; m < problem.materials; ++m)
    out = with_another_material(problem, out, seed, (std::uint64_t(m + 1) << 40) + particle);
  out.particle = int(particle);
  return out;
}

Vector weights_of(const std::vector<Particle> &particles, double power) {
  Vector logs{Index(particles.size())};
  for (std::size_t k = 0; k < particles.size(); ++k)
    logs[Index(k)] = power * particles[k].log_likelihood;
  return (logs.array() - logs.maxCoeff()).exp();
}

/// The largest step up to `most` that leaves this many effective particles.
double step_of(const std::vector<Particle> &particles, double most, double wanted) {
  if (effective_number(weights_of(particles, most)) >= wanted)
    return most;
  double low = 0.0, high = most;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (effective_number(weights_of(particles, middle)) < wanted ? high : low) = middle;
  }
  return high;
}

} // namespace

double effective_number(const Vector &weights) {
  return weights.sum() * weights.sum() / weights.squaredNorm();
}

std::vector<std::size_t> resampled(const Vector &weights, int count) {
  std::vector<std::size_t> out;
  const double sum = weights.sum();
  double passed = 0.0;
  for (Index k = 0; k < weights.size(); ++k) {
    passed += weights[k] / sum * count;
    while (double(out.size()) + 0.5 < passed && int(out.size()) < count)
      out.push_back(std::size_t(k));
  }
  return out;
}

Ensemble::Ensemble(const PosteriorProblem &problem, const SamplerSettings &settings)
    : problem_(problem), seed_(settings.seed) {
  std::vector<ProposedMove> first{std::size_t(settings.particles)};
  for (std::size_t k = 0; k < first.size(); ++k) {
    Particle &p = first[k].to;
    p.draw = prior_draw(problem, seed_, k);
    p.states.resize(problem.films.size());
    p.terms.resize(problem.films.size());
    p.other_data = Vector::Zero(problem.materials);
    first[k].moved = true;
  }
  for (int m = 0; m < problem.materials; ++m)
    predict(m, first);
  weigh(-1, first);
  for (ProposedMove &p : first)
    particles_.push_back(std::move(p.to));
}

Random Ensemble::random(std::size_t particle) const { return {seed_, (move_ << 20) + particle}; }

void Ensemble::predict(int material, std::vector<ProposedMove> &proposals) {
  std::vector<Particle *> moved;
  for (ProposedMove &p : proposals)
    if (p.moved)
      moved.push_back(&p.to);
  const auto count = Index(moved.size());
  if (count == 0)
    return;
  Matrix scores(problem_.parameters, count), amplitudes(Index(problem_.effects.size()), count);
  for (Index k = 0; k < count; ++k)
    scores.col(k) = moved[std::size_t(k)]->draw.scores.col(material);
  for (const int f : films_of(problem_, material)) {
    for (Index k = 0; k < count; ++k)
      amplitudes.col(k) = amplitudes_of(problem_, moved[std::size_t(k)]->draw, f);
    const FilmPredictions all = problem_.predict(f, scores, amplitudes);
    states_ += count;
    for (Index k = 0; k < count; ++k)
      moved[std::size_t(k)]->states[std::size_t(f)] = state_of(all, k);
  }
  if (!problem_.other_data)
    return;
  for (Index k = 0; k < count; ++k)
    amplitudes.col(k) = moved[std::size_t(k)]->draw.amplitudes.col(material);
  const Vector logs = problem_.other_data(material, scores, amplitudes);
  for (Index k = 0; k < count; ++k)
    moved[std::size_t(k)]->other_data[material] = logs[k];
}

void Ensemble::weigh(int material, std::vector<ProposedMove> &proposals) {
  for (ProposedMove &p : proposals) {
    if (!p.moved)
      continue;
    for (int f = 0; f < int(problem_.films.size()); ++f)
      if (material < 0 || problem_.films[std::size_t(f)].material == material)
        p.to.terms[std::size_t(f)] = terms_of(problem_, f, p.to.states[std::size_t(f)], p.to.draw);
    p.to.log_likelihood =
        inference::log_likelihood(problem_, p.to.draw, p.to.terms) + p.to.other_data.sum();
  }
}

std::vector<ProposedMove> Ensemble::proposals() const {
  std::vector<ProposedMove> out{particles_.size()};
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k].to = particles_[k];
  return out;
}

double Ensemble::accept(std::vector<ProposedMove> &proposals) {
  int moved = 0, accepted = 0;
  begin_move();
  for (std::size_t k = 0; k < proposals.size(); ++k) {
    ProposedMove &p = proposals[k];
    if (!p.moved)
      continue;
    ++moved;
    const double gain = p.to.log_likelihood - particles_[k].log_likelihood;
    if (std::log(random(k).uniform()) < temperature_ * gain + p.log_ratio) {
      particles_[k] = std::move(p.to);
      ++accepted;
    }
  }
  return moved > 0 ? double(accepted) / moved : 0.0;
}

double Ensemble::heat(double least_share, double &effective) {
  const double wanted = least_share * double(particles_.size()),
               step = step_of(particles_, 1.0 - temperature_, wanted);
  const Vector weights = weights_of(particles_, step);
  double largest = -INFINITY;
  for (const Particle &p : particles_)
    largest = std::max(largest, p.log_likelihood);
  effective = effective_number(weights);
  std::vector<Particle> next;
  for (const std::size_t k : resampled(weights, int(particles_.size())))
    next.push_back(particles_[k]);
  particles_ = std::move(next);
  for (std::size_t k = 0; k < particles_.size(); ++k)
    particles_[k].draw.particle = int(k);
  temperature_ = step >= 1.0 - temperature_ ? 1.0 : temperature_ + step;
  return step * largest + std::log(weights.mean());
}

} // namespace calendem::inference
