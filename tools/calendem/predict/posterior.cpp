// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/calibration.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace calendem {

using inference::Matrix;
using inference::Vector;
namespace {

/// Samples of one hypothesis, from its prior, with their first material.
std::vector<Draw> prior_draws(const FilmBank &bank, const ModelError &error,
                              const std::vector<int> &effects, int count, std::uint64_t seed) {
  const auto d = int(bank.material().size());
  const Matrix scores = inference::sobol_normals(d + 2 + int(effects.size()), count, seed);
  const inference::Prior discrepancy = discrepancy_of(error),
                         shared = {inference::Prior::uniform, 0.0, 1.0};
  std::vector<Draw> out{std::size_t(count)};
  for (int k = 0; k < count; ++k) {
    Draw &draw = out[std::size_t(k)];
    Material &material = draw.materials.emplace_back();
    for (int j = 0; j < d; ++j)
      material.parameters.push_back(bank.material()[std::size_t(j)].prior.value(scores(j, k)));
    draw.missed.sd = discrepancy.value(scores(d, k));
    draw.missed.shared = shared.value(scores(d + 1, k));
    for (int j = 0; j < int(effects.size()); ++j) {
      const int effect = effects[std::size_t(j)];
      material.effects.push_back(
          {effect, bank.effects()[std::size_t(effect)].prior.value(scores(d + 2 + j, k))});
    }
  }
  return out;
}

/// Gives each of the draws, which have the same effects, one more material; with the second, how
/// alike materials are. Scores are normal with that correlation between any two materials.
void add_material(const FilmBank &bank, std::uint64_t seed, std::vector<Draw> &draws) {
  const inference::Prior alike = {inference::Prior::uniform, 0.0, 1.0};
  const std::size_t d = bank.material().size(), before = draws.front().materials.size();
  const Matrix scores =
      inference::sobol_normals(int(d + draws.front().materials[0].effects.size()) + 1,
                               int(draws.size()), seed + 1000 * before);
  for (std::size_t k = 0; k < draws.size(); ++k) {
    Draw &draw = draws[k];
    const Vector own = scores.col(Eigen::Index(k));
    if (before == 1)
      draw.alike = alike.value(own[own.size() - 1]);
    const double pull = draw.alike / (1.0 + double(before - 1) * draw.alike),
                 sd = std::sqrt(1.0 - double(before) * draw.alike * pull);
    const auto next = [&](const inference::Prior &prior, std::size_t place, const auto &value) {
      double sum = 0.0;
      for (const Material &m : draw.materials)
        sum += prior.score(value(m));
      return prior.value(pull * sum + sd * own[Eigen::Index(place)]);
    };
    Material more = draw.materials[0];
    for (std::size_t j = 0; j < d; ++j)
      more.parameters[j] =
          next(bank.material()[j].prior, j, [j](const Material &m) { return m.parameters[j]; });
    for (std::size_t j = 0; j < more.effects.size(); ++j)
      more.effects[j].amplitude =
          next(bank.effects()[std::size_t(more.effects[j].effect)].prior, d + j,
               [j](const Material &m) { return m.effects[j].amplitude; });
    draw.materials.push_back(more);
  }
}

/// The data of the first materials.
Calibration of_first(const Calibration &c, std::size_t materials) {
  Calibration out = c;
  out.data.clear();
  for (const Datum &d : c.data)
    if (std::size_t(c.films[std::size_t(d.film)].material) < materials)
      out.data.push_back(d);
  return out;
}

/// Samples with the logarithms of their weights.
struct Weights {
  std::vector<double> of; ///< relative to the largest
  double largest = 0.0, sum = 0.0, effective = 0.0;
  explicit Weights(const std::vector<double> &logs)
      : largest(*std::max_element(logs.begin(), logs.end())) {
    double squares = 0.0;
    for (const double l : logs) {
      of.push_back(std::exp(l - largest));
      sum += of.back();
      squares += of.back() * of.back();
    }
    effective = sum * sum / squares;
  }
};

/// Samples of one hypothesis, weighted by the likelihood.
struct Sampled {
  std::vector<Draw> draws;
  std::vector<double> logs;
  double effective = 0.0; ///< the least of all turns
};

Sampled sampled(const FilmBank &bank, const CalibrationSettings &settings, const Calibration &c,
                const std::vector<int> &effects, std::uint64_t seed) {
  Sampled out = {prior_draws(bank, c.error, effects, settings.samples, seed), {}, 0.0};
  const auto likelihoods = [&](std::size_t materials) {
    const Calibration seen = of_first(c, materials);
    std::vector<double> logs;
    for (const Draw &draw : out.draws)
      logs.push_back(log_likelihood(bank, seen, draw));
    return logs;
  };
  std::vector<double> before = likelihoods(1);
  out.logs = before;
  out.effective = Weights(out.logs).effective;
  for (std::size_t next = 2; next <= c.materials.size(); ++next) {
    const Weights weights(out.logs);
    const double evidence = weights.largest + std::log(weights.sum / settings.samples);
    std::vector<Draw> again;
    std::vector<double> of_again; // what the first materials' data say of them
    for (const std::size_t k : resampled(weights.of, settings.samples)) {
      again.push_back(out.draws[k]);
      of_again.push_back(before[k]);
    }
    out.draws = again;
    add_material(bank, seed, out.draws);
    before = likelihoods(next);
    for (std::size_t k = 0; k < before.size(); ++k)
      out.logs[k] = evidence + before[k] - of_again[k];
    out.effective = std::min(out.effective, Weights(out.logs).effective);
  }
  return out;
}

/// Of a hypothesis that is as probable before the data as all others of as many effects.
double prior_of(const std::vector<std::vector<int>> &all, const std::vector<int> &effects,
                double pair_share) {
  const auto pairs =
      double(std::count_if(all.begin(), all.end(), [](const auto &of) { return of.size() > 1; }));
  return effects.size() > 1 ? pair_share / pairs
                            : (pairs > 0.0 ? 1.0 - pair_share : 1.0) / (double(all.size()) - pairs);
}

} // namespace

std::vector<std::vector<int>> hypotheses_of(const FilmBank &bank) {
  const auto effects = int(bank.effects().size());
  std::vector<std::vector<int>> out = {{}};
  for (int a = 0; a < effects; ++a)
    out.push_back({a});
  for (int a = 0; a < effects; ++a)
    for (int b = a + 1; b < effects; ++b)
      out.push_back({a, b});
  return out;
}

std::string name_of(const FilmBank &bank, const std::vector<int> &effects) {
  std::string out;
  for (const int effect : effects)
    out += (out.empty() ? "" : " + ") + bank.effects()[std::size_t(effect)].name;
  return out.empty() ? "none" : out;
}

std::vector<int> effects_of(const Draw &draw) {
  std::vector<int> out;
  for (const Acting &a : draw.materials[0].effects)
    out.push_back(a.effect);
  return out;
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

void calibrate(const FilmBank &bank, const CalibrationSettings &settings, Calibration &c) {
  std::vector<Draw> all;
  std::vector<double> logs;
  const auto of = hypotheses_of(bank);
  c.hypotheses.clear();
  for (std::size_t h = 0; h < of.size(); ++h) {
    const double prior = std::log(prior_of(of, of[h], settings.pair_share));
    const Sampled samples = sampled(bank, settings, c, of[h], std::uint64_t(h) + 1);
    c.hypotheses.push_back({name_of(bank, of[h]), 0.0, samples.effective});
    all.insert(all.end(), samples.draws.begin(), samples.draws.end());
    for (const double l : samples.logs)
      logs.push_back(prior + l);
  }
  const Weights weights(logs);
  for (std::size_t k = 0; k < all.size(); ++k)
    c.hypotheses[k / std::size_t(settings.samples)].probability += weights.of[k] / weights.sum;
  c.draws.clear();
  for (const std::size_t k : resampled(weights.of, settings.draws))
    c.draws.push_back(all[k]);
  for (std::size_t h = 0; h < of.size(); ++h) { // the one that was not measured
    std::vector<Draw> same;
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < c.draws.size(); ++k)
      if (effects_of(c.draws[k]) == of[h]) {
        same.push_back(c.draws[k]);
        places.push_back(k);
      }
    if (!same.empty())
      add_material(bank, std::uint64_t(h) + 1, same);
    for (std::size_t k = 0; k < places.size(); ++k)
      c.draws[places[k]] = same[k];
  }
}

} // namespace calendem
