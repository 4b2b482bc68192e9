// SPDX-License-Identifier: GPL-2.0-or-later
// How far simulations are from what nothing was fitted to, with resamples of noise and packings.
#include "diagnose/rerun.h"
#include <algorithm>
#include <boost/random/chi_squared_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <functional>
#include <limits>

namespace calendem {

using inference::Matrix;
using inference::Vector;
namespace {

constexpr int kResamples = 1000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Vector squared_error_of_mean(const Matrix &packings) {
  const Eigen::Index n = packings.cols();
  if (n < 2)
    return Vector::Zero(packings.rows());
  const Matrix centred = packings.colwise() - packings.rowwise().mean();
  return centred.rowwise().squaredNorm() / double(n - 1) / double(n);
}

double shrunk(double before, double after) { return before > 0.0 ? 1.0 - after / before : kNaN; }

/// A mean that other packings could have given: normal packings' means are t-distributed about the
/// one found. `weights`: a number for each packing.
Vector mean_of(const Matrix &packings, const Vector &weights) {
  const double n = double(packings.cols());
  const Vector mean = packings.rowwise().mean();
  return mean + (packings.colwise() - mean) * weights / std::sqrt(n * (n - 1.0));
}

/// A resample: its measured values and the weights of its packings.
using OfResample = std::function<double(const HeldOut &, const Vector &)>;

std::vector<double> resampled(const HeldOut &held_out, int packings, const OfResample &value) {
  boost::random::mt19937 random(1);
  boost::random::normal_distribution<double> normal;
  boost::random::chi_squared_distribution<double> square(packings - 1);
  std::vector<double> out;
  for (int k = 0; k < kResamples; ++k) {
    HeldOut again = held_out;
    for (Eigen::Index i = 0; i < again.measured.size(); ++i)
      again.measured[i] += again.sd[i] * normal(random);
    const double spread = std::sqrt((packings - 1) / square(random));
    Vector weights(packings);
    for (double &w : weights)
      w = spread * normal(random);
    out.push_back(value(again, weights));
  }
  return out;
}

} // namespace

void add_sample_scatter(const std::vector<Matrix> &models, double cells, HeldOut &held_out) {
  Vector variance = Vector::Zero(held_out.sd.size());
  for (const Matrix &packings : models)
    variance += squared_error_of_mean(packings) * double(packings.cols()) / double(models.size());
  held_out.sd = (held_out.sd.cwiseAbs2() + variance / cells).cwiseSqrt();
}

double gap_of(const HeldOut &held_out, const Vector &mean, const Vector &scatter, double noises) {
  const Vector variance = held_out.sd.cwiseAbs2();
  const Vector excess = ((mean - held_out.measured).cwiseAbs2() - noises * (variance + scatter))
                            .cwiseQuotient(variance);
  double sum = 0.0;
  for (const inference::Block &b : held_out.blocks)
    sum += excess(b.members).mean();
  return std::sqrt(std::max(0.0, sum / double(held_out.blocks.size())));
}

Estimate interval_of(double value, std::vector<double> draws) {
  draws.erase(std::remove_if(draws.begin(), draws.end(), [](double d) { return std::isnan(d); }),
              draws.end());
  if (draws.empty())
    return {value, kNaN, kNaN};
  std::sort(draws.begin(), draws.end());
  const auto quantile = [&](double share) {
    return draws[std::size_t(std::lround(share * double(draws.size() - 1)))];
  };
  return {value, quantile(0.05), quantile(0.95)};
}

Estimate gap_of_packings(const HeldOut &held_out, const Matrix &simulated) {
  const Vector scatter = squared_error_of_mean(simulated);
  // a resample holds noise and scatter twice: the data's and its own
  const auto again = [&](const HeldOut &h, const Vector &weights) {
    return gap_of(h, mean_of(simulated, weights), scatter, 2.0);
  };
  return interval_of(gap_of(held_out, simulated.rowwise().mean(), scatter),
                     resampled(held_out, int(simulated.cols()), again));
}

double noise_floor(const HeldOut &held_out, const Matrix &simulated) {
  const Vector scatter = squared_error_of_mean(simulated);
  HeldOut without = held_out;
  without.measured = simulated.rowwise().mean();
  const auto again = [&](const HeldOut &h, const Vector &weights) {
    return gap_of(h, mean_of(simulated, weights), scatter);
  };
  return interval_of(0.0, resampled(without, int(simulated.cols()), again)).high90;
}

Estimate shrinkage_of(const HeldOut &held_out, const Matrix &before, const Matrix &after) {
  const Vector scatter_before = squared_error_of_mean(before),
               scatter_after = squared_error_of_mean(after);
  const auto again = [&](const HeldOut &h, const Vector &weights) {
    return shrunk(gap_of(h, mean_of(before, weights), scatter_before, 2.0),
                  gap_of(h, mean_of(after, weights), scatter_after, 2.0));
  };
  const double value = shrunk(gap_of(held_out, before.rowwise().mean(), scatter_before),
                              gap_of(held_out, after.rowwise().mean(), scatter_after));
  return interval_of(value, resampled(held_out, int(before.cols()), again));
}

} // namespace calendem
