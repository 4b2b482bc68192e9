// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/kernel.h"
#include <cmath>

namespace calendem::inference {

struct Matern {
  Matrix value, slope; ///< d value / d ln(length) is slope * (difference / length)^2
};

namespace {

constexpr double kConstant = 4.0;  // c0, in variances of the values, whose mean was subtracted
constexpr double kDamping = 16.0;  // of trends: |x - x'|^2 per input at which half is left
constexpr double kSmallest = 1e-5; // of the noise: keeps the matrix invertible

/// Order of the parameters: six, then lengths, then c_e and t_e.
enum Layout { kSmooth, kVarying, kBend, kPairs, kPacking, kNoise, kFirstLength };

struct Normal {
  double mean, spread;
};

// Priors of the logarithms. A response is smooth over its range, which is 2: what is rough is
// scatter. Variances are shares of the values'.
constexpr Normal kScalars[] = {{-1.0, 1.5},  // s0
                               {-1.5, 1.5},  // r
                               {-0.5, 1.0},  // q
                               {-0.5, 1.5},  // h
                               {-3.0, 1.5},  // p0
                               {-2.5, 1.5}}; // n
constexpr Normal kLength{1.3, 1.0}, kEffect{-3.0, 2.0}, kGrowth{0.0, 0.4};

Vector filled(int inputs, int effects, double Normal::*member) {
  Vector all(kFirstLength + inputs + 2 * effects);
  for (int i = 0; i < kFirstLength; ++i)
    all[i] = kScalars[i].*member;
  all.segment(kFirstLength, inputs).setConstant(kLength.*member);
  all.segment(kFirstLength + inputs, effects).setConstant(kEffect.*member);
  all.tail(effects).setConstant(kGrowth.*member);
  return all;
}

/// Squares of the distances of columns.
Matrix squares(const Matrix &a, const Matrix &b) {
  Matrix out = -2.0 * (a.transpose() * b);
  out.colwise() += a.colwise().squaredNorm().transpose();
  out.rowwise() += b.colwise().squaredNorm();
  return out.cwiseMax(0.0);
}

Matern matern(const Matrix &a, const Matrix &b, const Vector &lengths, bool slopes) {
  const auto scale = lengths.cwiseInverse().asDiagonal();
  const Matrix root = (5.0 * squares(scale * a, scale * b)).cwiseSqrt();
  const Matrix decay = (-root.array()).exp();
  const auto r = root.array();
  Matern out;
  out.value = (1.0 + r + r.square() / 3.0) * decay.array();
  if (slopes)
    out.slope = 5.0 / 3.0 * (1.0 + r) * decay.array();
  return out;
}

Matrix bent(const Matrix &g) { return g.array() * (2.0 * g.array() - 1.0); }

/// Rows whose products sum up to G_e: g, then sqrt(q) f.
Matrix responses(const Matrix &g, double bend) {
  Matrix out(2 * g.rows(), g.cols());
  out << g, std::sqrt(bend) * bent(g);
  return out;
}

/// Rows whose products sum up to G_e^2.
Matrix squared_responses(const Matrix &g, double bend) {
  const Matrix f = bent(g);
  Matrix out(3 * g.rows(), g.cols());
  out << g.cwiseAbs2(), std::sqrt(2.0 * bend) * g.cwiseProduct(f), bend * f.cwiseAbs2();
  return out;
}

/// x_k' weight x_k of each row x_k.
Vector forms(const Matrix &rows, const Matrix &weight) {
  return (rows * weight).cwiseProduct(rows).rowwise().sum();
}

} // namespace

Vector Kernel::prior_means(int inputs, int effects) {
  return filled(inputs, effects, &Normal::mean);
}

Vector Kernel::prior_spreads(int inputs, int effects) {
  return filled(inputs, effects, &Normal::spread);
}

Kernel::Kernel(int inputs, int effects, const Vector &x) : inputs_(inputs), effects_(effects) {
  smooth_ = std::exp(x[kSmooth]);
  varying_ = std::exp(x[kVarying]);
  bend_ = std::exp(x[kBend]);
  pairs_ = std::exp(x[kPairs]);
  packing_ = std::exp(x[kPacking]);
  noise_ = std::exp(x[kNoise]);
  lengths_ = x.segment(kFirstLength, inputs).array().exp();
  effect_variances_ = x.segment(kFirstLength + inputs, effects).array().exp();
  growth_ = x.tail(effects);
}

/// What the covariance is made of, `of` x `with`.
struct Kernel::Parts {
  Matrix damping, effects, squares; ///< T, E, sum_e c_e^2 G_e^2
  Matern smooth;                    ///< M
};

Kernel::Parts Kernel::parts(const Points &of, const Points &with, bool slopes) const {
  const Vector twice = effect_variances_.replicate(2, 1),
               squared = effect_variances_.cwiseAbs2().replicate(3, 1);
  Parts p;
  p.damping = 1.0 / (1.0 + squares(of.inputs, with.inputs).array() / (kDamping * inputs_));
  p.smooth = matern(of.inputs, with.inputs, lengths_, slopes);
  p.effects = responses(of.amplitudes, bend_).transpose() * twice.asDiagonal() *
              responses(with.amplitudes, bend_);
  p.squares = squared_responses(of.amplitudes, bend_).transpose() * squared.asDiagonal() *
              squared_responses(with.amplitudes, bend_);
  return p;
}

Matrix Kernel::sum_of(const Parts &p) const {
  const auto e = p.effects.array();
  return p.damping.array() * (kConstant + e + 0.5 * pairs_ * (e.square() - p.squares.array())) +
         p.smooth.value.array() * (smooth_ + varying_ * e);
}

Matrix Kernel::expected(const Points &of, const Points &with) const {
  return sum_of(parts(of, with, false));
}

Vector Kernel::prior_variance(const Points &of) const {
  const Matrix own = of.amplitudes.cwiseAbs2() + bend_ * bent(of.amplitudes).cwiseAbs2();
  const Eigen::ArrayXd all = own.transpose() * effect_variances_,
                       squares = own.cwiseAbs2().transpose() * effect_variances_.cwiseAbs2();
  return kConstant + smooth_ + (1.0 + varying_) * all + 0.5 * pairs_ * (all.square() - squares);
}

Vector Kernel::roughness(const Points &of) const {
  return (0.5 * (of.amplitudes.transpose() * growth_).array()).exp();
}

Vector Kernel::scatter(const Points &of) const {
  return (packing_ + noise_ + kSmallest) * roughness(of).cwiseAbs2();
}

Matrix Kernel::of_runs(const Points &runs, const std::vector<int> &packing) const {
  Matrix k = sum_of(parts(runs, runs, false));
  const Vector r = roughness(runs);
  for (Eigen::Index j = 0; j < k.cols(); ++j) {
    for (Eigen::Index i = 0; i < k.rows(); ++i)
      if (packing[std::size_t(i)] == packing[std::size_t(j)])
        k(i, j) += r[i] * r[j] * packing_;
    k(j, j) += r[j] * r[j] * (noise_ + kSmallest);
  }
  return k;
}

/// Sums of pull_ij (x_i - x_j)^2 / length^2 for each input.
Vector Kernel::length_slopes(const Matrix &pull, const Points &runs) const {
  const Vector sums = pull.rowwise().sum();
  const Vector all = 2.0 * (runs.inputs.cwiseAbs2() * sums - forms(runs.inputs, pull));
  return all.cwiseQuotient(lengths_.cwiseAbs2());
}

void Kernel::effect_slopes(const Parts &p, const Points &runs, const Matrix &weight,
                           Vector &out) const {
  const Matrix &g = runs.amplitudes, f = bent(g);
  const Matrix damped = weight.cwiseProduct(p.damping);
  const Matrix all = damped + varying_ * weight.cwiseProduct(p.smooth.value) +
                     pairs_ * damped.cwiseProduct(p.effects);
  const Vector cross = forms(g.cwiseProduct(f), damped), of_bends = forms(f.cwiseAbs2(), damped),
               bends = forms(f, all);
  const Vector squares =
      forms(g.cwiseAbs2(), damped) + 2.0 * bend_ * cross + bend_ * bend_ * of_bends;
  out.segment(kFirstLength + inputs_, effects_) = effect_variances_.cwiseProduct(
      forms(g, all) + bend_ * bends - pairs_ * effect_variances_.cwiseProduct(squares));
  out[kBend] = bend_ * effect_variances_.dot(bends - pairs_ * effect_variances_.cwiseProduct(
                                                                  cross + bend_ * of_bends));
}

Vector Kernel::gradient(const Points &runs, const std::vector<int> &packing,
                        const Matrix &weight) const {
  const Parts p = parts(runs, runs, true);
  Vector out(kFirstLength + inputs_ + 2 * effects_);
  const Matrix smooth = weight.cwiseProduct(p.smooth.value);
  out[kSmooth] = smooth_ * smooth.sum();
  out[kVarying] = varying_ * smooth.cwiseProduct(p.effects).sum();
  out[kPairs] =
      0.5 * pairs_ *
      weight.cwiseProduct(p.damping).cwiseProduct(p.effects.cwiseAbs2() - p.squares).sum();
  effect_slopes(p, runs, weight, out);

  const Vector r = roughness(runs);
  Matrix same(weight.rows(), weight.cols()); // weights of packings
  for (Eigen::Index j = 0; j < same.cols(); ++j)
    for (Eigen::Index i = 0; i < same.rows(); ++i)
      same(i, j) =
          packing[std::size_t(i)] == packing[std::size_t(j)] ? weight(i, j) * r[i] * r[j] : 0.0;
  const Vector own = weight.diagonal().cwiseProduct(r.cwiseAbs2());
  out[kPacking] = packing_ * same.sum();
  out[kNoise] = noise_ * own.sum();
  const Vector rough = packing_ * same.rowwise().sum() + (noise_ + kSmallest) * own;
  out.tail(effects_) = runs.amplitudes * rough;

  const Matrix slopes = p.smooth.slope.array() * (smooth_ + varying_ * p.effects.array());
  out.segment(kFirstLength, inputs_) = length_slopes(weight.cwiseProduct(slopes), runs);
  return out;
}

} // namespace calendem::inference
