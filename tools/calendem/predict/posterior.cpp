// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "base/random.h"
#include "predict/calibration.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace calendem {

using inference::Vector;

std::string name_of(const FilmBank &bank, const std::vector<int> &effects) {
  std::string out;
  for (const int effect : effects)
    out += (out.empty() ? "" : " + ") + bank.effects()[std::size_t(effect)].name;
  return out.empty() ? "none" : out;
}

std::vector<int> effects_of(const Material &material) {
  std::vector<int> out;
  for (const ActiveEffect &a : material.effects)
    out.push_back(a.effect);
  return out;
}

std::vector<EffectSet> effect_sets_of(const FilmBank &bank, const Calibration &c) {
  std::map<std::vector<int>, std::vector<double>> found;
  for (const Draw &draw : c.draws)
    for (std::size_t m = 0; m < c.materials.size(); ++m) {
      auto &probability = found[effects_of(draw.materials[m])];
      probability.resize(c.materials.size());
      probability[m] += 1.0 / double(c.draws.size());
    }
  std::vector<EffectSet> out;
  for (const auto &[effects, probability] : found)
    out.push_back({name_of(bank, effects), effects, probability});
  const auto most = [](const EffectSet &set) {
    return *std::max_element(set.probability.begin(), set.probability.end());
  };
  std::stable_sort(out.begin(), out.end(),
                   [&](const EffectSet &a, const EffectSet &b) { return most(a) > most(b); });
  return out;
}

double acting(const Calibration &c, int effect, std::size_t material) {
  double sum = 0.0;
  for (const Draw &draw : c.draws) {
    const std::vector<int> on = effects_of(draw.materials[material]);
    sum += double(std::count(on.begin(), on.end(), effect));
  }
  return sum / double(c.draws.size());
}

std::vector<std::size_t> resampled(const std::vector<double> &weights, int count) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<std::size_t> out;
  double passed = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    passed += weights[k] / sum * count;
    while (double(out.size()) + 0.5 < passed && int(out.size()) < count)
      out.push_back(k);
  }
  return out;
}

namespace {

constexpr double kWrong = 0.1; // probability that the model is wrong about one effect
constexpr double kLeastEffective =
    0.5;                         // share of effective samples after a step of the temperature
constexpr int kSweeps = 4;       // of moves after each step
constexpr double kWanted = 0.25; // share of the moves of scores that are taken
constexpr int kMostSteps = 60;

/// One of the sampler's draws. All scores are standard normal and all flags independent before the
/// data: a material's scores are sqrt(alike) common + sqrt(1 - alike) own, so that those of two
/// materials have the correlation `alike`. Where its score of following lies below sqrt(alike), it
/// has the common effects, otherwise its own.
struct Particle {
  Vector scores;
  std::vector<char> flags;
  Draw draw;
  Curves known;
  double log_likelihood = 0.0;
};

double share_of(double score) { return 0.5 * std::erfc(-score / std::sqrt(2.0)); }

/// Where what stands among scores and flags; materials are those with data and one more.
class Layout {
public:
  Layout(const FilmBank &bank, const Calibration &c)
      : bank_(bank), c_(c), parameters_(int(bank.material().size())),
        effects_(int(bank.effects().size())), materials_(int(c.materials.size()) + 1) {}

  int of_one() const { return parameters_ + effects_; }
  int effects() const { return effects_; }
  int materials() const { return materials_; }
  int scores() const { return of_one() * (materials_ + 1) + materials_ + 3; }
  int flags() const { return effects_ * (materials_ + 1); }
  /// Scores of a set of parameters and amplitudes: common to all (-1), or a material's own.
  int begin_of(int material) const { return of_one() * (material + 1); }
  int follow_of(int material) const { return of_one() * (materials_ + 1) + material; }
  int hyper() const { return of_one() * (materials_ + 1) + materials_; }

  Draw draw_of(const Particle &p) const {
    Draw draw;
    draw.missed.sd = discrepancy_of(c_.error).value(p.scores[hyper()]);
    draw.missed.shared = share_of(p.scores[hyper() + 1]);
    draw.alike = materials_ > 2 ? share_of(p.scores[hyper() + 2]) : 0.5;
    for (int m = 0; m < materials_; ++m)
      draw.materials.push_back(material_of(p, m, draw.alike));
    return draw;
  }

private:
  const FilmBank &bank_;
  const Calibration &c_;
  int parameters_, effects_, materials_;

  Material material_of(const Particle &p, int m, double alike) const {
    const Vector scores = std::sqrt(alike) * p.scores.segment(begin_of(-1), of_one()) +
                          std::sqrt(1.0 - alike) * p.scores.segment(begin_of(m), of_one());
    const bool follows = share_of(p.scores[follow_of(m)]) < std::sqrt(alike);
    Material out;
    for (int k = 0; k < parameters_; ++k)
      out.parameters.push_back(bank_.material()[std::size_t(k)].prior.value(scores[k]));
    for (int e = 0; e < effects_; ++e)
      if (p.flags[std::size_t(effects_ * (follows ? 0 : m + 1) + e)])
        out.effects.push_back(
            {e, bank_.effects()[std::size_t(e)].prior.value(scores[parameters_ + e])});
    return out;
  }
};

/// Sequential Monte Carlo from the prior to the posterior through powers of the likelihood (Del
/// Moral, Doucet and Jasra 2006), with moves of scores that keep the prior (Cotter, Roberts, Stuart
/// and White 2013) and of flags.
class Sampler {
public:
  Sampler(const FilmBank &bank, const Calibration &c, int count)
      : bank_(bank), c_(c), layout_(bank, c), random_(1, 0x706f7374) {
    const Settings base = read_case(bank.spec().case_file, bank.recipe());
    for (const inference::Parameter &e : bank.effects()) {
      const EffectParameter &p = find_effect(e.name).parameter;
      const bool acts =
          !find_effect(e.name).in_recipe && base.number(p.keys.front()) != std::stod(p.off);
      on_.push_back(acts ? 1.0 - kWrong : kWrong);
    }
    for (int m = -1; m < layout_.materials(); ++m)
      blocks_.push_back({layout_.begin_of(m), layout_.of_one()});
    blocks_.push_back({layout_.follow_of(0), layout_.materials() + 3});
    steps_.assign(blocks_.size(), 0.5);
    particles_.resize(std::size_t(count));
    for (Particle &p : particles_) {
      p.scores =
          Vector::NullaryExpr(layout_.scores(), [&](Eigen::Index) { return random_.normal(); });
      for (int f = 0; f < layout_.flags(); ++f)
        p.flags.push_back(random_.uniform() < on_[std::size_t(f % layout_.effects())]);
    }
    evaluate(particles_);
  }

  /// The least share of moves that were taken in a step of the temperature.
  double run() {
    double temperature = 0.0, least = 1.0;
    for (int step = 0; step < kMostSteps && temperature < 1.0; ++step) {
      const double next = next_temperature(temperature);
      resample(next - temperature);
      temperature = next;
      double taken = 0.0;
      for (int sweep = 0; sweep < kSweeps; ++sweep)
        taken += move(temperature) / kSweeps;
      least = std::min(least, taken);
    }
    return least;
  }

  const std::vector<Particle> &particles() const { return particles_; }

private:
  struct Block {
    int begin, size;
  };
  const FilmBank &bank_;
  const Calibration &c_;
  Layout layout_;
  Random random_;
  std::vector<double> on_; ///< prior probability of each effect
  std::vector<Block> blocks_;
  std::vector<double> steps_; ///< of the moves of each block's scores, 0-1
  std::vector<Particle> particles_;

  /// Draws, emulated films and likelihoods.
  void evaluate(std::vector<Particle> &all) const {
    for (Particle &p : all) {
      p.draw = layout_.draw_of(p);
      p.known.clear();
    }
    std::map<std::pair<int, FilmNumber>, bool> needed;
    for (const Datum &d : c_.data)
      needed[{d.film, d.number}] = true;
    for (const auto &[what, yes] : needed) {
      const Film &film = c_.films[std::size_t(what.first)];
      std::vector<const Material *> materials;
      for (const Particle &p : all)
        materials.push_back(&p.draw.of(film));
      const auto curves = bank_.at_pressures(what.second, film, materials);
      for (std::size_t k = 0; k < all.size(); ++k)
        all[k].known[what] = curves[k];
    }
    for (Particle &p : all)
      p.log_likelihood = log_likelihood(bank_, c_, p.draw, p.known);
  }

  double effective_after(double step) const {
    std::vector<double> logs;
    for (const Particle &p : particles_)
      logs.push_back(step * p.log_likelihood);
    const double largest = *std::max_element(logs.begin(), logs.end());
    double sum = 0.0, squares = 0.0;
    for (const double l : logs) {
      const double w = std::exp(l - largest);
      sum += w;
      squares += w * w;
    }
    return sum * sum / squares / double(logs.size());
  }

  double next_temperature(double temperature) const {
    double low = 0.0, high = 1.0 - temperature;
    if (effective_after(high) >= kLeastEffective)
      return 1.0;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (low + high);
      (effective_after(middle) >= kLeastEffective ? low : high) = middle;
    }
    return temperature + high;
  }

  void resample(double step) {
    double largest = -INFINITY;
    for (const Particle &p : particles_)
      largest = std::max(largest, step * p.log_likelihood);
    std::vector<double> weights;
    for (const Particle &p : particles_)
      weights.push_back(std::exp(step * p.log_likelihood - largest));
    std::vector<Particle> next;
    for (const std::size_t k : resampled(weights, int(particles_.size())))
      next.push_back(particles_[k]);
    particles_ = std::move(next);
  }

  /// Takes proposals by the ratio of likelihoods; their prior is heeded where they are made.
  double take(std::vector<Particle> proposed, double temperature) {
    evaluate(proposed);
    double taken = 0.0;
    for (std::size_t k = 0; k < proposed.size(); ++k)
      if (std::log(random_.uniform()) <
          temperature * (proposed[k].log_likelihood - particles_[k].log_likelihood)) {
        particles_[k] = std::move(proposed[k]);
        taken += 1.0 / double(particles_.size());
      }
    return taken;
  }

  double move(double temperature) {
    double sum = 0.0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      std::vector<Particle> proposed = particles_;
      const double step = steps_[b], keep = std::sqrt(1.0 - step * step);
      for (Particle &p : proposed)
        for (int k = blocks_[b].begin; k < blocks_[b].begin + blocks_[b].size; ++k)
          p.scores[k] = keep * p.scores[k] + step * random_.normal();
      const double taken = take(std::move(proposed), temperature);
      steps_[b] = std::clamp(steps_[b] * std::exp(taken - kWanted), 0.02, 0.98);
      sum += taken;
    }
    take(with_one_flag_drawn_anew(), temperature);
    take(with_two_flags_swapped(), temperature);
    return sum / double(blocks_.size());
  }

  std::vector<Particle> with_one_flag_drawn_anew() {
    std::vector<Particle> out = particles_;
    for (Particle &p : out) {
      const auto f = std::size_t(random_.uniform() * layout_.flags());
      const std::size_t effect = f % std::size_t(layout_.effects());
      p.flags[f] = random_.uniform() < on_[effect];
      const int set = int(f) / layout_.effects();
      p.scores[layout_.begin_of(set - 1) + layout_.of_one() - layout_.effects() + int(effect)] =
          random_.normal();
    }
    return out;
  }

  /// Two effects of equal prior probability: as probable before the data.
  std::vector<Particle> with_two_flags_swapped() {
    std::vector<Particle> out = particles_;
    for (Particle &p : out) {
      const int set = int(random_.uniform() * (layout_.materials() + 1)),
                a = int(random_.uniform() * layout_.effects()),
                b = int(random_.uniform() * layout_.effects());
      if (on_[std::size_t(a)] == on_[std::size_t(b)])
        std::swap(p.flags[std::size_t(set * layout_.effects() + a)],
                  p.flags[std::size_t(set * layout_.effects() + b)]);
    }
    return out;
  }
};

} // namespace

void calibrate(const FilmBank &bank, const CalibrationSettings &settings, Calibration &c) {
  Sampler sampler(bank, c, settings.samples);
  c.acceptance = sampler.run();
  c.draws.clear();
  for (const std::size_t k :
       resampled(std::vector<double>(sampler.particles().size(), 1.0), settings.draws))
    c.draws.push_back(sampler.particles()[k].draw);
}

} // namespace calendem
