// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "inference/ensemble.h"
#include "predict/crushed.h"
#include <algorithm>
#include <map>
#include <numeric>

namespace calendem {

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

MeasuredFilms measured_films(const Calibration &c) {
  MeasuredFilms out;
  out.materials = c.materials;
  std::map<int, int> places;
  for (const Datum &d : c.data) {
    const auto [at, is_new] = places.emplace(d.film, int(out.films.size()));
    if (is_new) {
      out.films.push_back(c.films[std::size_t(d.film)]);
      out.cells.push_back(0.0);
    }
    Reading r;
    r.film = at->second;
    r.condition = r.specimen = d.condition;
    r.pressure = d.pressure;
    r.pressure_sd = d.pressure_sd;
    r.observable = observable_of(d.number, d.measured, d.sd);
    out.readings.push_back(r);
  }
  return out;
}

namespace {

/// The product's draw of one of the inference.
Draw draw_of(const FilmProblem &problem, const inference::Draw &from) {
  Draw out;
  for (Eigen::Index m = 0; m < from.scores.cols(); ++m)
    out.materials.push_back(material_of(problem, from.scores.col(m), from.amplitudes.col(m)));
  out.missed = {from.discrepancy, from.shared};
  out.alike = from.material_correlation;
  return out;
}

} // namespace

void calibrate(const FilmBank &bank, const CalibrationSettings &settings, Calibration &c) {
  const MeasuredFilms measured = measured_films(c);
  ProblemOptions options;
  options.acting = acting_in(read_case(bank.spec().case_file, bank.recipe()), bank);
  options.error = c.error;
  FilmProblem problem = problem_of(bank, measured, options);
  if (!c.crushed.empty())
    problem.problem.other_data = [&](int material, const inference::Matrix &scores,
                                     const inference::Matrix &amplitudes) {
      inference::Vector out(scores.cols());
      for (Eigen::Index k = 0; k < out.size(); ++k)
        out[k] = log_likelihood_of_crushed(bank, c, material,
                                           material_of(problem, scores.col(k), amplitudes.col(k)));
      return out;
    };
  inference::SamplerSettings sampler;
  sampler.particles = settings.samples;
  const inference::Posterior posterior = inference::sample_posterior(problem.problem, sampler);
  c.acceptance = 1.0;
  for (const inference::TemperatureStep &step : posterior.steps)
    c.acceptance = std::min(c.acceptance, step.parameters);
  c.draws.clear();
  const inference::Vector equal = inference::Vector::Ones(Eigen::Index(posterior.draws.size()));
  for (const std::size_t k : inference::resampled(equal, settings.draws))
    c.draws.push_back(draw_of(problem, posterior.draws[k]));
}

} // namespace calendem
