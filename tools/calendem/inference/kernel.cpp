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

/// Order of the parameters: six, then lengths, then those of effects.
enum Layout { kSmooth, kSlope, kBend, kPairs, kPacking, kNoise, kFirstLength };

struct Normal {
  double mean, spread;
};

// Priors of the logarithms. A response is smooth over its range, which is 2: what is rough is
// scatter. Variances are shares of the values'.
constexpr Normal kScalars[] = {{-1.0, 1.5},  // s0
                               {-1.5, 1.5},  // b
                               {-0.5, 1.0},  // q
                               {-0.5, 1.5},  // h
                               {-3.0, 1.5},  // p0
                               {-2.5, 1.5}}; // n
constexpr Normal kLength{1.3, 1.0}, kEffectLength{1.2, 0.5};
constexpr Normal kMain{-3.0, 2.0}, kVarying{-4.0, 1.5}, kGrowth{0.0, 0.4};

Vector filled(int inputs, int effects, double Normal::*member) {
  Vector all(kFirstLength + 2 * inputs + 3 * effects);
  for (int i = 0; i < kFirstLength; ++i)
    all[i] = kScalars[i].*member;
  all.segment(kFirstLength, inputs).setConstant(kLength.*member);
  all.segment(kFirstLength + inputs, inputs).setConstant(kEffectLength.*member);
  const int first = kFirstLength + 2 * inputs;
  all.segment(first, effects).setConstant(kMain.*member);
  all.segment(first + effects, effects).setConstant(kVarying.*member);
  all.segment(first + 2 * effects, effects).setConstant(kGrowth.*member);
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
  const int first = kFirstLength + 2 * inputs;
  smooth_ = std::exp(x[kSmooth]);
  slope_ = std::exp(x[kSlope]);
  bend_ = std::exp(x[kBend]);
  pairs_ = std::exp(x[kPairs]);
  packing_ = std::exp(x[kPacking]);
  noise_ = std::exp(x[kNoise]);
  lengths_ = x.segment(kFirstLength, inputs).array().exp();
  effect_lengths_ = x.segment(kFirstLength + inputs, inputs).array().exp();
  constant_ = x.segment(first, effects).array().exp();
  varying_ = x.segment(first + effects, effects).array().exp();
  growth_ = x.segment(first + 2 * effects, effects);
}

/// What the covariance is made of, `of` x `with`.
struct Kernel::Parts {
  Matrix damping, product; ///< T, x.x'
  Matrix constant, bend, varying,
      squares; ///< sums over effects: c g g', c f f', s g g', (v g g')^2
  Matern smooth, of_effects;
};

Kernel::Parts Kernel::parts(const Points &of, const Points &with, bool slopes) const {
  Parts p;
  p.product = of.inputs.transpose() * with.inputs;
  p.damping = 1.0 / (1.0 + squares(of.inputs, with.inputs).array() / (kDamping * inputs_));
  p.smooth = matern(of.inputs, with.inputs, lengths_, slopes);
  p.of_effects = matern(of.inputs, with.inputs, effect_lengths_, slopes);
  const Matrix &g = of.amplitudes, &h = with.amplitudes;
  const Vector v = (constant_ + varying_).cwiseAbs2();
  p.constant = g.transpose() * constant_.asDiagonal() * h;
  p.bend = bent(g).transpose() * constant_.asDiagonal() * bent(h);
  p.varying = g.transpose() * varying_.asDiagonal() * h;
  p.squares = g.cwiseAbs2().transpose() * v.asDiagonal() * h.cwiseAbs2();
  return p;
}

/// All that T damps.
Matrix Kernel::trend(const Parts &p) const {
  const auto both = p.constant.array() + p.varying.array();
  return p.damping.array() *
         (kConstant + slope_ * p.product.array() + p.constant.array() + bend_ * p.bend.array() +
          0.5 * pairs_ * (both.square() - p.squares.array()));
}

Matrix Kernel::expected(const Points &of, const Points &with) const {
  const Parts p = parts(of, with, false);
  return trend(p).array() + smooth_ * p.smooth.value.array() +
         p.varying.array() * p.of_effects.value.array();
}

Vector Kernel::prior_variance(const Points &of) const {
  const Matrix squared = of.amplitudes.cwiseAbs2();
  const Vector v = constant_ + varying_;
  const Vector both = squared.transpose() * v;
  const Vector own = squared.cwiseAbs2().transpose() * v.cwiseAbs2();
  const Vector bend = bent(of.amplitudes).cwiseAbs2().transpose() * constant_;
  return kConstant + smooth_ + slope_ * of.inputs.colwise().squaredNorm().transpose().array() +
         both.array() + bend_ * bend.array() + 0.5 * pairs_ * (both.array().square() - own.array());
}

Vector Kernel::roughness(const Points &of) const {
  return (0.5 * (of.amplitudes.transpose() * growth_).array()).exp();
}

Vector Kernel::scatter(const Points &of) const {
  return (packing_ + noise_ + kSmallest) * roughness(of).cwiseAbs2();
}

Matrix Kernel::of_runs(const Points &runs, const std::vector<int> &packing) const {
  const Parts p = parts(runs, runs, false);
  Matrix k = trend(p).array() + smooth_ * p.smooth.value.array() +
             p.varying.array() * p.of_effects.value.array();
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
Vector Kernel::length_slopes(const Matrix &pull, const Points &runs, const Vector &lengths) const {
  const Vector sums = pull.rowwise().sum();
  const Vector all = 2.0 * (runs.inputs.cwiseAbs2() * sums - forms(runs.inputs, pull));
  return all.cwiseQuotient(lengths.cwiseAbs2());
}

void Kernel::effect_slopes(const Parts &p, const Points &runs, const Matrix &weight,
                           Vector &out) const {
  const Matrix &g = runs.amplitudes;
  const Matrix damped = weight.cwiseProduct(p.damping);
  const Vector v = constant_ + varying_;
  const Vector of_pairs = pairs_ * (forms(g, damped.cwiseProduct(p.constant + p.varying)) -
                                    v.cwiseProduct(forms(g.cwiseAbs2(), damped)));
  const Vector bend = bend_ * forms(bent(g), damped);
  const int first = kFirstLength + 2 * inputs_;
  out[kBend] = constant_.dot(bend);
  out.segment(first, effects_) = constant_.cwiseProduct(forms(g, damped) + bend + of_pairs);
  out.segment(first + effects_, effects_) =
      varying_.cwiseProduct(forms(g, weight.cwiseProduct(p.of_effects.value)) + of_pairs);
}

Vector Kernel::gradient(const Points &runs, const std::vector<int> &packing,
                        const Matrix &weight) const {
  const Parts p = parts(runs, runs, true);
  Vector out(kFirstLength + 2 * inputs_ + 3 * effects_);
  const Matrix damped = weight.cwiseProduct(p.damping);
  out[kSmooth] = smooth_ * weight.cwiseProduct(p.smooth.value).sum();
  out[kSlope] = slope_ * damped.cwiseProduct(p.product).sum();
  const Matrix pairs = (p.constant + p.varying).cwiseAbs2() - p.squares;
  out[kPairs] = 0.5 * pairs_ * damped.cwiseProduct(pairs).sum();
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

  const Matrix pull = smooth_ * weight.cwiseProduct(p.smooth.slope);
  out.segment(kFirstLength, inputs_) = length_slopes(pull, runs, lengths_);
  out.segment(kFirstLength + inputs_, inputs_) = length_slopes(
      weight.cwiseProduct(p.varying).cwiseProduct(p.of_effects.slope), runs, effect_lengths_);
  return out;
}

} // namespace calendem::inference
