// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/gaussian_process.h"
#include "inference/numerics.h"
#include <algorithm>
#include <cmath>
#include <map>

namespace calendem::inference {
namespace {

constexpr double kTrend = 25.0;   // prior variance of the linear trend, in variances of the values
constexpr double kOfEffect = 0.5; // the same of an effect's slopes: others change its size somewhat
constexpr double kSmallest = 1e-6; // variance of noise: keeps the matrix invertible
constexpr double kNothing = 1e-24; // square of values, relative to their size, that never change

// Log-normal priors: mean and standard deviation of ln(variance) and ln(length). Inputs span 2. A
// response is smooth over its range, what is rough is scatter: with weaker priors thirty runs are
// followed too closely: the mean square error of packings left out is 1.5 where 1.1 is expected.
constexpr double kVarianceMean = -2.0, kVarianceSpread = 2.0;
constexpr double kLengthMean = 1.6, kLengthSpread = 0.5;
constexpr double kOwnLengthMean = 0.0; // of an effect's amplitudes: it may saturate
constexpr double kUsualSpread = 0.7;   // of the noise, where it is known about

struct Matern {
  double value, slope; // slope: d value / d ln(length) is slope * (difference / length)^2
};

Matern matern(double square) {
  const double r = std::sqrt(5.0 * square), e = std::exp(-r);
  return {(1.0 + r + r * r / 3.0) * e, 5.0 / 3.0 * (1.0 + r) * e};
}

/// Variables of the search: ln of signal, noise, [packing], lengths.
Vector start(int which, int dimension, bool packing) {
  const double signal[] = {0.1, 1.0, 0.003}, noise[] = {0.1, 0.003, 0.5},
               length[] = {2.0, 1.0, 3.0};
  Vector x(2 + packing + dimension);
  x[0] = std::log(signal[which]);
  x[1] = std::log(noise[which]);
  if (packing)
    x[2] = std::log(noise[which]);
  x.tail(dimension).setConstant(std::log(length[which]));
  return x;
}

} // namespace

double q2_of(const Vector &predicted, const Vector &actual) {
  const double spread = (actual.array() - actual.mean()).square().sum();
  return 1.0 - (predicted - actual).squaredNorm() / std::max(spread, 1e-300);
}

double learnt_share(double missed, double all) {
  return all > missed ? std::min(1.0, 1.0 - missed / all) : 0.0;
}

GaussianProcess::GaussianProcess(Training training) : training_(std::move(training)) {
  const auto n = training_.values.size();
  const bool effect = training_.amplitudes.rows() > 0;
  amplitude_product_ =
      effect ? Matrix(training_.amplitudes.transpose() * training_.amplitudes) : Matrix::Ones(n, n);
  centre_ = effect ? 0.0 : training_.values.mean();
  slopes_ = effect ? kOfEffect : kTrend;
  const Vector shifted = training_.values.array() - centre_;
  square_ = shifted.squaredNorm() / double(n);
  const double size = std::max(training_.values.squaredNorm() / double(n), 1e-300);
  if (square_ <= kNothing * size || square_ < 1e-280)
    square_ = size * 1e-16; // constant: predicted as such
  scaled_values_ = shifted / std::sqrt(square_);
  std::map<int, int> runs;
  for (const int p : training_.packing)
    repeated_ |= ++runs[p] > 1;
  learn();
}

void GaussianProcess::learn() {
  const int dimension = int(training_.inputs.rows());
  const auto function = [this](const Vector &x, Vector &g) { return misfit(x, g); };
  Minimum best;
  for (int which = 0; which < 3; ++which) {
    const Minimum found = minimise(function, start(which, dimension, repeated_));
    if (which == 0 || found.value < best.value)
      best = found;
  }
  use(best.at);
}

/// Minus the logarithm of marginal likelihood times prior, and its gradient (Rasmussen and
/// Williams eq. 5.9).
double GaussianProcess::misfit(const Vector &x, Vector &gradient) const {
  const int n = int(scaled_values_.size()), d = int(training_.inputs.rows());
  const double signal = std::exp(x[0]), noise = std::exp(x[1]) + kSmallest;
  const double packing = repeated_ ? std::exp(x[2]) : 0.0;
  const Vector inverse = (-2.0 * x.tail(d)).array().exp();
  Matrix k(n, n), shape(n, n), slope(n, n);
  const Matrix trend = training_.inputs.transpose() * training_.inputs;
  for (int j = 0; j < n; ++j)
    for (int i = j; i < n; ++i) {
      const Matern m =
          matern((training_.inputs.col(i) - training_.inputs.col(j)).cwiseAbs2().dot(inverse));
      const double g = amplitude_product_(i, j);
      const bool same = training_.packing[i] == training_.packing[j];
      shape(i, j) = shape(j, i) = g * m.value;
      slope(i, j) = slope(j, i) = g * m.slope;
      k(i, j) = k(j, i) = g * (kTrend + slopes_ * trend(i, j) + signal * m.value + packing * same) +
                          (i == j ? noise : 0.0);
    }
  const Cholesky factor(k);
  if (factor.info() != Eigen::Success)
    return INFINITY;
  const Vector alpha = factor.solve(scaled_values_);
  Matrix weight = factor.solve(Matrix::Identity(n, n)); // K^-1 - alpha alpha^T
  weight.noalias() -= alpha * alpha.transpose();
  double value =
      0.5 * scaled_values_.dot(alpha) + Matrix(factor.matrixL()).diagonal().array().log().sum();
  gradient[0] = 0.5 * signal * weight.cwiseProduct(shape).sum();
  gradient[1] = 0.5 * (noise - kSmallest) * weight.trace();
  if (repeated_) {
    double sum = 0.0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        if (training_.packing[i] == training_.packing[j])
          sum += weight(i, j) * amplitude_product_(i, j);
    gradient[2] = 0.5 * packing * sum;
  }
  const Matrix pull = weight.cwiseProduct(slope);
  for (int m = 0; m < d; ++m) {
    const Eigen::RowVectorXd row = training_.inputs.row(m);
    const Vector ones_pull = pull.rowwise().sum();
    const double sum =
        2.0 * (row.cwiseAbs2().transpose().dot(ones_pull) - row * pull * row.transpose());
    gradient[2 + repeated_ + m] = 0.5 * signal * sum * inverse[m];
  }
  for (int m = 0; m < x.size(); ++m) {
    const bool length = m >= 2 + repeated_, usual = m == 1 && training_.usual_noise > 0.0;
    const double spread = length ? kLengthSpread : usual ? kUsualSpread : kVarianceSpread;
    const bool own = m >= x.size() - training_.amplitudes.rows();
    const double mean = usual     ? std::log(training_.usual_noise / square_)
                        : !length ? kVarianceMean
                        : own     ? kOwnLengthMean
                                  : kLengthMean;
    const double off = (x[m] - mean) / spread;
    value += 0.5 * off * off;
    gradient[m] += off / spread;
  }
  return value;
}

Matrix GaussianProcess::expected_covariance() const {
  const int n = int(scaled_values_.size());
  Matrix k(n, n);
  for (int i = 0; i < n; ++i)
    k.col(i) = near(training_.inputs.col(i)).covariance;
  return k.cwiseProduct(amplitude_product_);
}

void GaussianProcess::use(const Vector &x) {
  const int n = int(scaled_values_.size());
  signal_ = std::exp(x[0]);
  noise_ = std::exp(x[1]) + kSmallest;
  packing_ = repeated_ ? std::exp(x[2]) : 0.0;
  lengths_ = x.tail(training_.inputs.rows()).array().exp();
  inputs_ = training_.inputs.transpose();
  scaled_inputs_ = inputs_ * lengths_.cwiseInverse().asDiagonal();
  const Matrix expected = expected_covariance();
  Matrix k = expected;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      if (training_.packing[i] == training_.packing[j])
        k(i, j) += packing_ * amplitude_product_(i, j) + (i == j ? noise_ : 0.0);
  const Cholesky factor(k);
  factor_ = factor.matrixL();
  covariance_inverse_ = factor.solve(Matrix::Identity(n, n));
  weights_ = covariance_inverse_ * scaled_values_;
  residuals_ = std::sqrt(square_) * (scaled_values_ - expected * weights_);
  parameters_used_ = expected.cwiseProduct(covariance_inverse_).sum();
}

GaussianProcess::Near GaussianProcess::near(const Vector &input) const {
  Near all;
  all.root = Vector::Zero(inputs_.rows());
  for (Eigen::Index m = 0; m < input.size(); ++m)
    all.root.array() += (scaled_inputs_.col(m).array() - input[m] / lengths_[m]).square();
  all.root = (5.0 * all.root.array()).sqrt();
  all.decay = (-all.root.array()).exp();
  const auto r = all.root.array();
  all.covariance.noalias() = slopes_ * (inputs_ * input);
  all.covariance.array() += kTrend + signal_ * (1.0 + r + r.square() / 3.0) * all.decay.array();
  return all;
}

Mean GaussianProcess::mean_of(const Vector &input, const Vector &amplitudes,
                              const Vector &covariances, const Vector &white) const {
  const double g = amplitudes.size() ? amplitudes.squaredNorm() : 1.0;
  const double prior = g * (kTrend + slopes_ * input.squaredNorm() + signal_);
  const double left = prior - white.squaredNorm();
  return {centre_ + std::sqrt(square_) * covariances.dot(weights_), square_ * std::max(left, 0.0)};
}

Mean GaussianProcess::at(const Vector &input, const Vector &amplitudes) const {
  Vector k = near(input).covariance;
  if (amplitudes.size())
    k.array() *= (training_.amplitudes.transpose() * amplitudes).array();
  return mean_of(input, amplitudes, k, factor_.triangularView<Eigen::Lower>().solve(k));
}

MeanSlopes GaussianProcess::slopes_at(const Vector &input, const Vector &amplitudes) const {
  const Near all = near(input);
  Vector share = Vector::Ones(inputs_.rows()); // covariance is share * that of `near`
  if (amplitudes.size())
    share = training_.amplitudes.transpose() * amplitudes;
  const Vector k = share.cwiseProduct(all.covariance);
  const Vector white = factor_.triangularView<Eigen::Lower>().solve(k);
  const Vector solved = factor_.transpose().triangularView<Eigen::Upper>().solve(white);
  const Vector slope =
      5.0 / 3.0 * signal_ * (1.0 + all.root.array()) * all.decay.array(); // as in `matern`
  /// d covariance / d input, times these weights of the runs.
  const auto turned = [&](const Vector &weights) {
    const Vector pulled = slope.cwiseProduct(weights);
    const Vector apart =
        scaled_inputs_.transpose() * pulled - pulled.sum() * input.cwiseQuotient(lengths_);
    return Vector(slopes_ * (inputs_.transpose() * weights) + apart.cwiseQuotient(lengths_));
  };
  MeanSlopes s;
  s.here = mean_of(input, amplitudes, k, white);
  const double scale = std::sqrt(square_), own = amplitudes.size() ? amplitudes.squaredNorm() : 1.0;
  const double prior = kTrend + slopes_ * input.squaredNorm() + signal_;
  const double square = s.here.variance > 0.0 ? square_ : 0.0; // it is never below 0
  s.mean_inputs = scale * turned(share.cwiseProduct(weights_));
  s.variance_inputs = square * 2.0 * (own * slopes_ * input - turned(share.cwiseProduct(solved)));
  s.mean_amplitudes = scale * (training_.amplitudes * all.covariance.cwiseProduct(weights_));
  s.variance_amplitudes =
      square * 2.0 *
      (prior * amplitudes - training_.amplitudes * all.covariance.cwiseProduct(solved));
  return s;
}

Matrix GaussianProcess::covariance(const Asked &asked) const {
  const auto n = asked.inputs.cols(), runs = scaled_values_.size();
  const bool effect = asked.amplitudes.rows() > 0;
  Matrix own = Matrix::Ones(n, n), with_runs = Matrix::Ones(runs, n);
  if (effect) {
    own = asked.amplitudes.transpose() * asked.amplitudes;
    with_runs = training_.amplitudes.transpose() * asked.amplitudes;
  }
  const Matrix scaled = lengths_.cwiseInverse().asDiagonal() * asked.inputs;
  for (Eigen::Index j = 0; j < n; ++j) {
    Vector k = near(asked.inputs.col(j)).covariance;
    for (Eigen::Index i = 0; i < runs; ++i)
      k[i] += training_.packing[std::size_t(i)] == asked.packing[std::size_t(j)] ? packing_ : 0.0;
    with_runs.col(j).array() *= k.array();
    for (Eigen::Index i = 0; i < n; ++i) {
      const bool run = asked.packing[std::size_t(i)] != kExpectation,
                 same = run && asked.packing[std::size_t(i)] == asked.packing[std::size_t(j)];
      own(i, j) =
          own(i, j) * (kTrend + slopes_ * asked.inputs.col(i).dot(asked.inputs.col(j)) +
                       signal_ * matern((scaled.col(i) - scaled.col(j)).squaredNorm()).value +
                       (same ? packing_ : 0.0)) +
          (run && i == j ? noise_ : 0.0);
    }
  }
  const Matrix white = factor_.triangularView<Eigen::Lower>().solve(with_runs);
  return square_ * (own - white.transpose() * white);
}

/// Dubrule, Math. Geol. 15 (1983) 687: the error of a group left out is (K^-1_PP)^-1 (K^-1 y)_P.
Quality GaussianProcess::left_out() const {
  std::map<int, std::vector<int>> groups;
  for (int i = 0; i < int(training_.packing.size()); ++i)
    groups[training_.packing[i]].push_back(i);
  if (int(groups.size()) < kFewestPackings) {
    groups.clear();
    for (int i = 0; i < int(training_.packing.size()); ++i)
      groups[i].push_back(i);
  }
  double errors = 0.0, scatter = 0.0;
  for (const auto &[packing, runs] : groups) {
    const Matrix block = covariance_inverse_(runs, runs);
    errors += Cholesky(block).solve(Vector(weights_(runs))).squaredNorm();
    for (const int i : runs)
      scatter += noise_ + packing_ * amplitude_product_(i, i);
  }
  const double n = double(scaled_values_.size());
  Quality q;
  q.q2 = 1.0 - errors / scaled_values_.squaredNorm();
  q.error = std::sqrt(square_ * errors / n);
  q.spread = std::sqrt(square_ * scaled_values_.squaredNorm() / n);
  q.scatter = std::sqrt(square_ * scatter / n);
  q.own = std::sqrt(square_ * std::max(0.0, errors - scatter) / n);
  return q;
}

} // namespace calendem::inference
