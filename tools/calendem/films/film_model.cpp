// SPDX-License-Identifier: GPL-2.0-or-later
#include "films/film_model.h"
#include <algorithm>
#include <cmath>

namespace calendem {

using Eigen::Index;
using inference::Matrix;
using inference::Vector;

std::string kind_of(const Observable &o) {
  return o.curve.empty() ? o.name + "|" + o.stage : o.curve + "|" + o.stage;
}

double pressure_of(const Reading &r) {
  return r.observable.pressure > 0.0 ? r.observable.pressure : r.pressure;
}

namespace {

Vector finite(const Vector &of) {
  return of.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

/// Standard deviations of outputs; 0 of what no run has.
Vector deviations(const Vector &variance) { return finite(variance.cwiseMax(0.0).cwiseSqrt()); }

/// Correlation of errors of the data, of outputs with these standard deviations and correlation.
Matrix data_correlation(const Matrix &slopes, const Vector &sd, const Matrix &correlation) {
  const Matrix by = slopes * sd.asDiagonal(), covariance = by * correlation * by.transpose();
  const Vector scale = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Matrix out = scale.asDiagonal() * covariance * scale.asDiagonal();
  out.diagonal().setOnes();
  return out;
}

/// Adds `of` of each reading as an error common to readings of one group.
void add_common(const std::vector<Reading> &readings, const Vector &of, std::string Reading::*group,
                Matrix &to) {
  for (Index i = 0; i < of.size(); ++i)
    for (Index j = 0; j < of.size(); ++j)
      if (readings[std::size_t(i)].*group == readings[std::size_t(j)].*group)
        to(i, j) += of[i] * of[j];
}

/// Covariance of a discrepancy of size 1: readings of one kind have it alike at like pressures.
Matrix discrepancy_of_one(const std::vector<Reading> &readings, const Vector &per_porosity) {
  const Index n = per_porosity.size();
  Matrix out = Matrix::Zero(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const Reading &a = readings[std::size_t(i)], &b = readings[std::size_t(j)];
      if (kind_of(a.observable) == kind_of(b.observable))
        out(i, j) = per_porosity[i] * per_porosity[j] * alike_at(pressure_of(a), pressure_of(b));
    }
  return out;
}

} // namespace

FilmModel::FilmModel(const FilmBank &bank, const Film &film, const std::vector<Reading> &readings,
                     double cells, const Material &middle)
    : readings_(bank, film, readings), cells_(cells) {
  const Matrix &correlation = bank.error_correlation();
  const inference::Expectation e = readings_.emulated({&middle}, readings_.outputs());
  outputs_ = e.mean.col(0);
  slopes_ = readings_.slopes(outputs_);
  emulator_ = data_correlation(slopes_, deviations(e.variance.col(0)), correlation);
  scatter_ = data_correlation(slopes_, deviations(e.scatter.col(0)), correlation);
  for (Index o = 0; o < slopes_.cols(); ++o)
    if (slopes_.col(o).any())
      used_.push_back(int(o));
  for (Index k = 0; k < slopes_.rows(); ++k) {
    places_.emplace_back();
    for (std::size_t u = 0; u < used_.size(); ++u)
      if (slopes_(k, used_[u]) != 0.0)
        places_.back().push_back(Index(u));
  }
  slopes_ = Matrix(slopes_(Eigen::all, used_));
  correlation_ = correlation(used_, used_);
}

double FilmModel::variance(Index reading, const Vector &sd) const {
  double sum = 0.0;
  for (const Index i : places_[std::size_t(reading)])
    for (const Index j : places_[std::size_t(reading)])
      sum += slopes_(reading, i) * sd[i] * correlation_(i, j) * sd[j] * slopes_(reading, j);
  return sum;
}

inference::FilmData FilmModel::data(const ModelError &error, double sizes) const {
  const std::vector<Reading> &all = readings_.readings();
  const auto n = Index(all.size());
  inference::FilmData out;
  out.observed.resize(n);
  Vector stated(n), loading(n), drift(n), zero(n), before(n), after(n);
  const Vector per_porosity = readings_.per_porosity(outputs_),
               of_pressed = readings_.derivatives(&Observable::per_porosity, outputs_),
               of_initial = readings_.derivatives(&Observable::per_initial_porosity, outputs_);
  for (Index k = 0; k < n; ++k) {
    const Reading &r = all[std::size_t(k)];
    out.observed[k] = r.observable.measured;
    stated[k] = r.observable.sd * r.observable.sd;
    loading[k] = r.observable.by_loading;
    drift[k] = r.observable.by_drift;
    zero[k] = r.observable.by_zero;
    before[k] = r.specimen_porosity_before * of_initial[k];
    after[k] = r.specimen_porosity * of_pressed[k];
  }
  out.measurement = stated.asDiagonal();
  add_common(all, loading, &Reading::specimen, out.measurement);
  add_common(all, drift, &Reading::condition, out.measurement);
  add_common(all, zero, &Reading::condition, out.measurement);
  out.fixed = Matrix::Zero(n, n);
  add_common(all, before, &Reading::specimen, out.fixed);
  add_common(all, after, &Reading::specimen, out.fixed);
  const double tiny = 1e-12 * std::max(1.0, out.measurement.diagonal().maxCoeff());
  out.fixed.diagonal().array() += tiny;
  out.emulator_correlation = emulator_;
  out.scatter_correlation = scatter_;
  out.discrepancy = discrepancy_of_one(all, per_porosity);
  out.shared_errors.resize(n, 2);
  out.shared_errors.col(0) = error.numerics * of_pressed;
  out.shared_errors.col(1) = kPorosityBySize * sizes * of_pressed;
  return out;
}

inference::FilmPredictions FilmModel::predict(const std::vector<Material> &materials,
                                              const std::vector<PressInstruments> &presses) const {
  std::vector<const Material *> of;
  for (const Material &m : materials)
    of.push_back(&m);
  const inference::Expectation e = readings_.emulated(of, used_);
  const auto n = Index(readings_.readings().size()), count = Index(materials.size());
  inference::FilmPredictions out;
  out.mean.resize(n, count);
  out.variance.resize(n, count);
  if (cells_ > 0.0)
    out.scatter.resize(n, count);
  out.errors.assign(1, Matrix(n, count));
  Vector outputs = outputs_;
  for (Index m = 0; m < count; ++m) {
    outputs(used_) = e.mean.col(m);
    const auto values = readings_.values(outputs, presses[std::size_t(m)]);
    out.mean.col(m) = values.at;
    const Vector sd = deviations(e.variance.col(m)), packings = deviations(e.scatter.col(m));
    for (Index k = 0; k < n; ++k) {
      out.errors[0](k, m) =
          values.by_log_pressure[k] * readings_.readings()[std::size_t(k)].pressure_sd;
      out.variance(k, m) = variance(k, sd);
      if (cells_ > 0.0)
        out.scatter(k, m) = variance(k, packings) / cells_;
    }
  }
  return out;
}

} // namespace calendem
