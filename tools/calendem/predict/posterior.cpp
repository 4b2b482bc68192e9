// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/calibration.h"
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

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

/// A sample on its way to one more material. Materials that follow what all have in common have the
/// same effects, the others effects of their own: each follows with a probability whose square is
/// Draw::alike, so that this is how often two of them do.
struct Sample {
  Draw draw;
  int follows = -1; ///< place of a material that does; -1: none
  Curves known;     ///< of the films of its materials
};

/// The hypothesis at a place (0-1) of all, each as wide as the others.
const std::vector<int> &effects_at(const std::vector<std::vector<int>> &all, double place) {
  return all[std::min(all.size() - 1, std::size_t(place * double(all.size())))];
}

/// A score of a new material, given those that others have of the same parameter.
double score_given(const std::vector<double> &others, double alike, double own) {
  const auto n = double(others.size());
  const double pull = n > 0.0 ? alike / (1.0 + (n - 1.0) * alike) : 0.0;
  return pull * std::accumulate(others.begin(), others.end(), 0.0) +
         std::sqrt(1.0 - n * alike * pull) * own;
}

/// Gives each of the samples one more material; with the second, how alike materials are. Scores are
/// normal with that correlation between any two materials that have the parameter.
void add_material(const FilmBank &bank, std::uint64_t seed, std::vector<Sample> &samples) {
  const inference::Prior alike = {inference::Prior::uniform, 0.0, 1.0};
  const auto hypotheses = hypotheses_of(bank);
  const std::size_t d = bank.material().size(), effects = bank.effects().size(),
                    before = samples.front().draw.materials.size();
  const Matrix scores =
      inference::sobol_normals(int(d + effects) + 4, int(samples.size()), seed + 1000 * before);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    Sample &sample = samples[k];
    Draw &draw = sample.draw;
    const auto own = [&](std::size_t place) {
      return scores(Eigen::Index(place), Eigen::Index(k));
    };
    if (before == 1) {
      draw.alike = alike.value(own(d + effects));
      sample.follows = alike.value(own(d + effects + 1)) < std::sqrt(draw.alike) ? 0 : -1;
    }
    const auto next = [&](const inference::Prior &prior, std::size_t place, const auto &value) {
      std::vector<double> others;
      for (const Material &m : draw.materials)
        if (const std::optional<double> v = value(m))
          others.push_back(prior.score(*v));
      return prior.value(score_given(others, draw.alike, own(place)));
    };
    Material more;
    for (std::size_t j = 0; j < d; ++j)
      more.parameters.push_back(next(bank.material()[j].prior, j, [j](const Material &m) {
        return std::optional<double>(m.parameters[j]);
      }));
    const bool follows = alike.value(own(d + effects + 2)) < std::sqrt(draw.alike);
    const std::vector<int> acting = follows && sample.follows >= 0
                                        ? effects_of(draw.materials[std::size_t(sample.follows)])
                                        : effects_at(hypotheses, alike.value(own(d + effects + 3)));
    for (const int effect : acting)
      more.effects.push_back(
          {effect, next(bank.effects()[std::size_t(effect)].prior, d + std::size_t(effect),
                        [effect](const Material &m) -> std::optional<double> {
                          for (const Acting &a : m.effects)
                            if (a.effect == effect)
                              return a.amplitude;
                          return std::nullopt;
                        })});
    if (follows && sample.follows < 0)
      sample.follows = int(before);
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
  out.crushed.erase(std::remove_if(out.crushed.begin(), out.crushed.end(),
                                   [&](const Crushed &k) { return k.material >= int(materials); }),
                    out.crushed.end());
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
  std::vector<Sample> samples;
  std::vector<double> logs;
  double effective = 0.0; ///< the least of all turns
};

Sampled sampled(const FilmBank &bank, const CalibrationSettings &settings, const Calibration &c,
                const std::vector<int> &effects, std::uint64_t seed) {
  Sampled out;
  for (Draw &draw : prior_draws(bank, c.error, effects, settings.samples, seed))
    out.samples.push_back({std::move(draw), -1, {}});
  const auto likelihoods = [&](std::size_t materials) {
    const Calibration seen = of_first(c, materials);
    std::vector<double> logs;
    for (Sample &s : out.samples)
      logs.push_back(log_likelihood(bank, seen, s.draw, s.known));
    return logs;
  };
  std::vector<double> before = likelihoods(1);
  out.logs = before;
  out.effective = Weights(out.logs).effective;
  for (std::size_t next = 2; next <= c.materials.size(); ++next) {
    const Weights weights(out.logs);
    const double evidence = weights.largest + std::log(weights.sum / settings.samples);
    std::vector<Sample> again;
    std::vector<double> of_again; // what the first materials' data say of them
    for (const std::size_t k : resampled(weights.of, settings.samples)) {
      again.push_back(out.samples[k]);
      of_again.push_back(before[k]);
    }
    out.samples = again;
    add_material(bank, seed, out.samples);
    before = likelihoods(next);
    for (std::size_t k = 0; k < before.size(); ++k)
      out.logs[k] = evidence + before[k] - of_again[k];
    out.effective = std::min(out.effective, Weights(out.logs).effective);
  }
  return out;
}

} // namespace

std::vector<std::vector<int>> hypotheses_of(const FilmBank &bank) {
  const auto effects = int(bank.effects().size());
  std::vector<std::vector<int>> out;
  for (unsigned set = 0; set < 1U << effects; ++set) {
    out.emplace_back();
    for (int k = 0; k < effects; ++k)
      if (set >> k & 1U)
        out.back().push_back(k);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto &a, const auto &b) { return a.size() < b.size(); });
  return out;
}

std::string name_of(const FilmBank &bank, const std::vector<int> &effects) {
  std::string out;
  for (const int effect : effects)
    out += (out.empty() ? "" : " + ") + bank.effects()[std::size_t(effect)].name;
  return out.empty() ? "none" : out;
}

std::vector<int> effects_of(const Material &material) {
  std::vector<int> out;
  for (const Acting &a : material.effects)
    out.push_back(a.effect);
  return out;
}

double acting(const FilmBank &bank, const Calibration &c, int effect, std::size_t material) {
  const auto of = hypotheses_of(bank);
  double sum = 0.0;
  for (std::size_t h = 0; h < of.size() && h < c.hypotheses.size(); ++h)
    if (std::find(of[h].begin(), of[h].end(), effect) != of[h].end())
      sum += c.hypotheses[h].probability[material];
  return sum;
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
  std::vector<Sample> all;
  std::vector<double> logs;
  const auto of = hypotheses_of(bank);
  c.hypotheses.clear();
  for (std::size_t h = 0; h < of.size(); ++h) {
    const Sampled samples = sampled(bank, settings, c, of[h], std::uint64_t(h) + 1);
    c.hypotheses.push_back(
        {name_of(bank, of[h]), std::vector<double>(c.materials.size(), 0.0), samples.effective});
    for (const Sample &sample : samples.samples)
      all.push_back({sample.draw, sample.follows, {}});
    for (const double l : samples.logs)
      logs.push_back(l);
  }
  const Weights weights(logs);
  for (std::size_t k = 0; k < all.size(); ++k)
    for (std::size_t m = 0; m < c.materials.size(); ++m) {
      const auto at = std::find(of.begin(), of.end(), effects_of(all[k].draw.materials[m]));
      c.hypotheses[std::size_t(at - of.begin())].probability[m] += weights.of[k] / weights.sum;
    }
  std::vector<Sample> kept;
  for (const std::size_t k : resampled(weights.of, settings.draws))
    kept.push_back(all[k]);
  add_material(bank, 1, kept); // the one that was not measured
  c.draws.clear();
  for (Sample &s : kept)
    c.draws.push_back(std::move(s.draw));
}

} // namespace calendem
