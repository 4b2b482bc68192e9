// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/run_again.h"
#include "base/messages.h"
#include "films/emulated_run.h"
#include "predict/own_runs.h"
#include "simulate/making.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

using inference::FittedModel;
using inference::Vector;
using Json = nlohmann::ordered_json;
namespace {

using Eigen::Index;

constexpr double kSamePressure = 1e-6;

/// One draw of a fitted model.
struct ModelDraw {
  Draw draw; ///< its material in all places of materials
  PressInstruments press;
};

ModelDraw draw_of(const Diagnosis &d, const FittedModel &model, const inference::Draw &from) {
  const int material = d.measured.films[std::size_t(d.film)].material;
  Vector own = from.amplitudes.col(material);
  for (Index k = 0; k < own.size(); ++k)
    if (d.of.problem.effects[std::size_t(model.acting[std::size_t(k)])].of_film)
      own[k] = from.faults(k, d.film);
  const Vector all = inference::with_others_off(own, model.acting, d.of.problem.effects.size());
  ModelDraw out;
  out.draw.materials.assign(std::size_t(material) + 1,
                            material_of(d.of, from.scores.col(material), all));
  for (Index e = 0; e < all.size(); ++e)
    if (d.of.problem.effects[std::size_t(e)].of_film && inference::acts(all[e])) {
      const inference::Parameter &p = d.of.effects[std::size_t(e)];
      const Effect &effect = find_effect(p.name);
      out.press.*effect.shown = effect.parameter.value(p.prior.value(all[e]));
    }
  return out;
}

std::vector<double> pressures_of(const Diagnosis &d) {
  std::vector<double> out;
  for (const int k : d.readings)
    out.push_back(d.measured.readings[std::size_t(k)].pressure);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// The fitted model with the runs' mean readings in place of the emulators'. Runs scatter by packing.
FittedModel by_runs(const Diagnosis &d, const FilmBank &bank, const FittedModel &model,
                    const Recipe &recipe, int runs, const StudyOptions &options, int &made) {
  std::vector<ModelDraw> draws;
  std::vector<Draw> materials;
  const auto &from = model.posterior.draws;
  const int material = d.measured.films[std::size_t(d.film)].material;
  for (const std::size_t place : spread_draws(from.size(), runs, [&](std::size_t k) {
         return can_be_run(bank, draw_of(d, model, from[k]).draw, recipe, material);
       })) {
    draws.push_back(draw_of(d, model, from[place]));
    materials.push_back(draws.back().draw);
  }
  const std::vector<double> pressures = pressures_of(d);
  const std::vector<std::string> folders =
      make_what_runs(own_runs(bank, materials, recipe, material, pressures), options, "Draws");
  Vector sum = Vector::Zero(Index(d.readings.size())), count = sum;
  made = 0;
  for (std::size_t k = 0; k < folders.size(); ++k) {
    if (folders[k].empty())
      continue;
    ++made;
    const Vector values =
        readings_of_run(d, draws[k / pressures.size()].press, read_simulated_run(folders[k]));
    for (Index i = 0; i < values.size(); ++i)
      if (std::isfinite(values[i])) {
        sum[i] += values[i];
        count[i] += 1.0;
      }
  }
  if (!(count.minCoeff() > 0.0))
    throw Failure(kSimulationFailed, fmt::format("no run at each pressure of the experiment ended; "
                                                 "see {}/runs.",
                                                 options.folder));
  FittedModel out = model;
  for (std::size_t k = 0; k < d.readings.size(); ++k)
    out.residual[first_datum(d) + Index(k)] =
        d.measured.readings[std::size_t(d.readings[k])].observable.measured -
        sum[Index(k)] / count[Index(k)];
  return out;
}

double porosity_points_of(const Diagnosis &d, const FittedModel &model) {
  double squares = 0.0, n = 0.0;
  for (std::size_t k = 0; k < d.readings.size(); ++k)
    if (d.measured.readings[std::size_t(d.readings[k])].observable.name == "total porosity") {
      squares += std::pow(model.residual[first_datum(d) + Index(k)], 2);
      n += 1.0;
    }
  return std::sqrt(squares / n); // NaN without a porosity: null in JSON
}

} // namespace

Vector readings_of_run(const Diagnosis &d, const PressInstruments &press, const SimulatedRun &run) {
  const SimulatedRun shown = shown_by(press, run);
  Vector out = Vector::Constant(Index(d.readings.size()), NAN);
  for (std::size_t k = 0; k < d.readings.size(); ++k) {
    const Reading &r = d.measured.readings[std::size_t(d.readings[k])];
    if (std::fabs(r.pressure / run.target - 1.0) < kSamePressure)
      out[Index(k)] = r.observable.simulated(shown);
  }
  return out;
}

Json run_again(const Diagnosis &d, const FilmBank &bank, const Recipe &recipe, int runs,
               const StudyOptions &given) {
  Json models = Json::array();
  const auto add = [&](const char *role, const char *folder, const FittedModel &model) {
    StudyOptions options = given;
    options.folder = given.folder + "/" + folder;
    int made = 0;
    const FittedModel ran = by_runs(d, bank, model, recipe, runs, options, made);
    models.push_back({{"role", role},
                      {"runs", made},
                      {"gap", inference::standardised_gap(ran, d.blocks).value},
                      {"predicted_gap", inference::standardised_gap(model, d.blocks).value},
                      {"porosity_points", porosity_points_of(d, ran)}});
  };
  add("model, recalibrated", "model", d.model);
  if (!d.leading.empty())
    add("with the leading explanation", "explained", d.explained);
  return {{"models", models}};
}

} // namespace calendem
