// SPDX-License-Identifier: GPL-2.0-or-later
#include "films/film_readings.h"
#include <cmath>

namespace calendem {

using Eigen::Index;
using inference::Matrix;
using inference::Vector;
namespace {

constexpr double kStep = 0.05; // of the logarithm of the pressure, for a slope

} // namespace

FilmReadings::FilmReadings(const FilmBank &bank, const Film &film, std::vector<Reading> readings)
    : bank_(bank), film_(film), readings_(std::move(readings)), outputs_(outputs_of_runs(bank)) {
  for (const Reading &r : readings_)
    if (runs_.find(r.pressure) == runs_.end())
      runs_.emplace(r.pressure,
                    std::make_pair(EmulatedRun(bank, film, r.pressure),
                                   EmulatedRun(bank, film, r.pressure * std::exp(kStep))));
}

FilmReadings::Values FilmReadings::values(const Vector &outputs,
                                          const PressInstruments &press) const {
  Values out{Vector(Index(readings_.size())), Vector(Index(readings_.size()))};
  std::map<double, std::pair<SimulatedRun, SimulatedRun>> shown;
  const PressInstruments here{1.0, press.compliance, press.thickness_zero},
      more{std::exp(-kStep), press.compliance, press.thickness_zero};
  for (const auto &[pressure, runs] : runs_)
    shown.emplace(pressure, std::make_pair(shown_by(here, runs.first.of(outputs)),
                                           shown_by(more, runs.second.of(outputs))));
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    const auto &[at_pressure, beyond] = shown.at(readings_[k].pressure);
    const auto &of = readings_[k].observable.simulated;
    const auto at = Index(k);
    out.at[at] = of(at_pressure);
    out.by_log_pressure[at] = (of(beyond) - out.at[at]) / kStep;
  }
  out.at -= std::log(press.pressure_factor) * out.by_log_pressure; // the gauge shows too much
  return out;
}

Matrix FilmReadings::slopes(const Vector &outputs) const {
  constexpr double kSmall = 1e-4;
  const Vector base = values(outputs, {}).at;
  Matrix out = Matrix::Zero(base.size(), outputs.size());
  for (Index o = 0; o < outputs.size(); ++o) {
    if (!std::isfinite(outputs[o]))
      continue;
    Vector changed = outputs;
    changed[o] += kSmall;
    out.col(o) = (values(changed, {}).at - base) / kSmall;
  }
  return out;
}

Vector FilmReadings::derivatives(Derivative Observable::*of, const Vector &outputs) const {
  Vector out = Vector::Zero(Index(readings_.size()));
  for (std::size_t k = 0; k < readings_.size(); ++k)
    if (const Derivative &d = readings_[k].observable.*of)
      out[Index(k)] = d(runs_.at(readings_[k].pressure).first.of(outputs));
  return out;
}

Vector FilmReadings::per_porosity(const Vector &outputs) const {
  Vector out = derivatives(&Observable::per_porosity, outputs);
  for (std::size_t k = 0; k < readings_.size(); ++k)
    if (!readings_[k].observable.per_porosity)
      out[Index(k)] = kCrackedPerPorosity;
  return out;
}

} // namespace calendem
