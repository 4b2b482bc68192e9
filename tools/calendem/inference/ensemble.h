// SPDX-License-Identifier: GPL-2.0-or-later
// The particles of the sampler: states of the world with what is known of their data. All of them
// are evaluated together.
#ifndef CALENDEM_INFERENCE_ENSEMBLE_H
#define CALENDEM_INFERENCE_ENSEMBLE_H

#include "base/random.h"
#include "inference/likelihood.h"

namespace calendem::inference {

/// Prior of the shares and correlations of a draw.
inline const Prior kShareOfVariance{Prior::uniform, 0.0, 1.0};

struct Particle {
  Draw draw;
  std::vector<FilmState> states; ///< of the films
  std::vector<FilmTerms> terms;  ///< of the films
  Vector other_data;             ///< ln likelihood of each material's
  double log_likelihood = 0.0;
};

/// A state to which a particle may go.
struct ProposedMove {
  Particle to;
  bool moved = false;
  double log_ratio = 0.0; ///< of priors and of the chances to propose, backward over forward
};

class Ensemble {
public:
  /// Particles from the prior.
  Ensemble(const PosteriorProblem &problem, const SamplerSettings &settings);

  const PosteriorProblem &problem() const { return problem_; }
  std::vector<Particle> &particles() { return particles_; }
  double temperature() const { return temperature_; }
  long states() const { return states_; }
  void count_states(long more) { states_ += more; }

  /// A stream of random numbers for each particle in each move.
  void begin_move() { ++move_; }
  Random random(std::size_t particle) const;

  /// Asks the model for a material's films in the proposals that moved.
  void predict(int material, std::vector<ProposedMove> &proposals);
  /// Likelihood of the proposals that moved; of the films of one material, or (-1) of all.
  void weigh(int material, std::vector<ProposedMove> &proposals);
  /// Metropolis and Hastings; returns the accepted share of those that moved.
  double accept(std::vector<ProposedMove> &proposals);
  /// A proposal for each particle, to be changed.
  std::vector<ProposedMove> proposals() const;

  /// Raises the temperature as far as the effective share allows, and resamples. Returns what this
  /// adds to the logarithm of the evidence.
  double heat(double least_share, double &effective);

private:
  const PosteriorProblem &problem_;
  std::uint64_t seed_;
  std::vector<Particle> particles_;
  double temperature_ = 0.0;
  std::uint64_t move_ = 0;
  long states_ = 0;
};

/// Systematic resampling: the k-th of `count` is the first whose summed share passes (k + 1/2) /
/// count.
std::vector<std::size_t> resampled(const Vector &weights, int count);
/// Number of equal weights that would scatter as much: (sum)^2 / sum of squares.
double effective_number(const Vector &weights);

} // namespace calendem::inference

#endif
