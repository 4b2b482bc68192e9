// SPDX-License-Identifier: GPL-2.0-or-later
#include "films/emulated_run.h"
#include <cmath>
#include <numeric>

namespace calendem {

using inference::Matrix;
using inference::Vector;
namespace {

constexpr double kRatio = 1.1; // between points of the loading
constexpr double kPart = 0.05; // of the largest pressure, between points of the release
constexpr double kLast = 1.0 - 1e-9;

std::vector<double> logs(const std::vector<double> &values) {
  std::vector<double> out;
  for (const double v : values)
    out.push_back(std::log(v));
  return out;
}

Matrix weights_at(const std::vector<double> &x, const std::vector<double> &at) {
  Matrix out(Eigen::Index(at.size()), Eigen::Index(x.size()));
  for (std::size_t k = 0; k < at.size(); ++k)
    out.row(Eigen::Index(k)) = cubic_weights(x, at[k]).transpose();
  return out;
}

/// Weights of the loading at places `x`, which no run has beyond `last`: from the last one that runs
/// have on, along the line through it and the one before.
Matrix loading_weights(const std::vector<double> &x, double last, const std::vector<double> &at) {
  std::vector<double> known;
  for (const double v : x)
    if (v <= last)
      known.push_back(v);
  Matrix out = Matrix::Zero(Eigen::Index(at.size()), Eigen::Index(x.size()));
  const auto n = Eigen::Index(known.size());
  out.leftCols(n) = weights_at(known, at);
  const double apart = known[std::size_t(n - 1)] - known[std::size_t(n - 2)];
  for (Eigen::Index k = 0; k < out.rows(); ++k)
    if (const double beyond = (at[std::size_t(k)] - known.back()) / apart; beyond > 0.0) {
      out(k, n - 1) = 1.0 + beyond;
      out(k, n - 2) = -beyond;
    }
  return out;
}

/// Values by weights; those of weight 0 do not matter, even if no run has them.
Vector weighed(const Matrix &weights, const Vector &values) {
  return weights * (weights.array() != 0.0).colwise().any().transpose().select(values, 0.0);
}

/// Shares of the largest pressure at which releases are known, and 1, where nothing is recovered.
std::vector<double> known_shares() {
  std::vector<double> out;
  for (const std::size_t place : bank::kReleases)
    out.push_back(bank::kReleasedTo[place]);
  out.push_back(1.0);
  return out;
}

} // namespace

std::vector<int> outputs_of_runs(const FilmBank &bank) {
  std::vector<int> out(std::size_t(bank::count_of_outputs(bank.pressures().size())));
  std::iota(out.begin(), out.end(), 0);
  return out;
}

EmulatedRun::EmulatedRun(const FilmBank &bank, const Film &film, double pressure)
    : pressure_(pressure), porosity_before_(porosity_before(bank, film)),
      solid_column_(bank.solid_column(film)), presses_(bank.pressures().size()),
      by_press_(bank.weights_at(pressure)) {
  for (double p = bank::loading_pressures().front(); p < kLast * pressure; p *= kRatio)
    loading_.push_back(p);
  loading_.push_back(pressure);
  by_loading_ = loading_weights(logs(bank::loading_pressures()), std::log(bank.pressures().back()),
                                logs(loading_));
  const std::vector<double> shares = known_shares();
  std::vector<double> at;
  for (double share = shares.front(); share < kLast; share += kPart)
    at.push_back(share);
  at.push_back(1.0);
  for (const double share : at)
    release_.push_back(share * pressure);
  const Matrix all = weights_at(shares, at);
  by_release_ = all.leftCols(all.cols() - 1);
}

double EmulatedRun::number(FilmNumber number, const Vector &outputs) const {
  return by_press_.dot(
      outputs.segment(bank::output_of(number, 0, presses_), Eigen::Index(presses_)));
}

SimulatedRun EmulatedRun::of(const Vector &outputs) const {
  SimulatedRun out;
  out.control = "pressure";
  out.target = out.max_pressure = pressure_;
  out.solid_column = solid_column_;
  out.porosity_initial = porosity_before_;
  out.porosity_after = number(FilmNumber::PorosityAfter, outputs);
  out.thickness_after = solid_column_ / (1.0 - out.porosity_after);
  out.cracked_fraction = number(FilmNumber::Cracked, outputs);
  out.broken_fraction = number(FilmNumber::Broken, outputs);
  out.inverse_tortuosity = number(FilmNumber::InverseTortuosity, outputs);
  out.cbd_nanoporosity = number(FilmNumber::CbdNanoporosity, outputs);

  const double before = solid_column_ / (1.0 - porosity_before_);
  const Vector compression =
      weighed(by_loading_, outputs.segment(bank::loading_output(0, presses_), by_loading_.cols()));
  const auto at_max = compression.size() - 1;
  out.thickness_at_max = before * (1.0 - compression[at_max]);
  out.porosity_at_max = 1.0 - solid_column_ / out.thickness_at_max;
  out.pressure = loading_;
  for (const double c : compression)
    out.displacement.push_back(before * c);
  if (at_max > 0)
    out.porosity_slope =
        (out.porosity_at_max - (1.0 - solid_column_ / (before * (1.0 - compression[at_max - 1])))) /
        (loading_.back() - loading_[loading_.size() - 2]);

  Vector recovered = Vector::Zero(by_release_.rows());
  for (std::size_t p = 0; p < presses_; ++p)
    if (by_press_[Eigen::Index(p)] != 0.0)
      recovered +=
          by_press_[Eigen::Index(p)] *
          (by_release_ * outputs.segment(bank::release_output(p, 0, presses_), by_release_.cols()));
  out.release_pressure = release_;
  for (const double r : recovered)
    out.release_displacement.push_back(out.displacement.back() - r * out.thickness_at_max);
  return out;
}

SimulatedRun shown_by(const PressInstruments &press, const SimulatedRun &run) {
  SimulatedRun out = run;
  out.thickness_at_max = press.thickness_shown(run.thickness_at_max);
  out.thickness_after = press.thickness_shown(run.thickness_after);
  const double before = run.solid_column / (1.0 - run.porosity_initial);
  out.porosity_initial = 1.0 - run.solid_column / press.thickness_shown(before);
  out.porosity_after = 1.0 - run.solid_column / out.thickness_after;
  const auto show = [&](std::vector<double> &pressure, std::vector<double> &displacement) {
    for (std::size_t k = 0; k < pressure.size(); ++k) {
      displacement[k] = press.displacement_shown(displacement[k], pressure[k]);
      pressure[k] = press.pressure_shown(pressure[k]);
    }
  };
  show(out.pressure, out.displacement);
  show(out.release_pressure, out.release_displacement);
  return out;
}

} // namespace calendem
