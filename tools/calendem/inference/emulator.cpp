// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/emulator.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <limits>
#include <map>
#include <thread>

namespace calendem::inference {
namespace {

constexpr double kScaleDegrees = 10.0;    // of the prior of an output's scale
constexpr int kMostToFit = 500;           // runs that the hyperparameters are fitted to
constexpr double kLeastEigenvalue = 1e-3; // of a correlation: pairs of outputs have other runs
constexpr Eigen::Index kBatch = 64;       // points at a time: their covariances stay in the cache

Points chosen(const Points &from, const std::vector<int> &places) {
  return {from.inputs(Eigen::all, places), from.amplitudes(Eigen::all, places)};
}

std::vector<int> chosen(const std::vector<int> &from, const std::vector<int> &places) {
  std::vector<int> out;
  for (const int place : places)
    out.push_back(from[std::size_t(place)]);
  return out;
}

/// Scale of each column's covariance: its most probable value is what predictions take.
Vector scales_of(const Matrix &values, const Matrix &weights) {
  const Vector square = values.cwiseProduct(weights).colwise().sum();
  return (kScaleDegrees + square.array()) / (kScaleDegrees + double(values.rows()));
}

/// Outputs of `group` by the runs that have them.
std::map<std::vector<int>, std::vector<int>> patterns_of(const TrainingRuns &runs, int group) {
  std::map<std::vector<int>, std::vector<int>> patterns;
  for (int o = 0; o < int(runs.group.size()); ++o) {
    if (runs.group[std::size_t(o)] != group)
      continue;
    std::vector<int> having;
    for (int r = 0; r < int(runs.packing.size()); ++r)
      if (std::isfinite(runs.values(o, r)))
        having.push_back(r);
    if (!having.empty())
      patterns[having].push_back(o);
  }
  return patterns;
}

/// Evenly chosen among all.
std::vector<int> thinned(const std::vector<int> &runs) {
  const auto n = runs.size();
  if (n <= std::size_t(kMostToFit))
    return runs;
  std::vector<int> out;
  for (std::size_t k = 0; k < std::size_t(kMostToFit); ++k)
    out.push_back(runs[k * n / std::size_t(kMostToFit)]);
  return out;
}

} // namespace

double misfit(const Points &at, const std::vector<int> &packing, const Matrix &values,
              const Vector &parameters, Vector &gradient) {
  const int inputs = int(at.inputs.rows()), effects = int(at.amplitudes.rows());
  const Kernel kernel(inputs, effects, parameters);
  const auto n = values.rows(), outputs = values.cols();
  const Cholesky factor(kernel.of_runs(at, packing));
  if (factor.info() != Eigen::Success)
    return INFINITY;
  Matrix alpha = factor.solve(values);
  const Vector scales = scales_of(values, alpha);
  double value = factor.matrixLLT().diagonal().array().log().sum() +
                 0.5 * (kScaleDegrees + double(n)) * scales.array().log().mean();
  Matrix weight = factor.solve(Matrix::Identity(n, n));
  alpha = alpha * (scales * double(outputs)).cwiseSqrt().cwiseInverse().asDiagonal();
  weight.noalias() -= alpha * alpha.transpose();
  gradient = 0.5 * kernel.gradient(at, packing, weight);
  const Vector off = (parameters - Kernel::prior_means(inputs, effects))
                         .cwiseQuotient(Kernel::prior_spreads(inputs, effects));
  gradient += off.cwiseQuotient(Kernel::prior_spreads(inputs, effects));
  return value + 0.5 * off.squaredNorm();
}

Emulator::Emulator(TrainingRuns runs, const std::optional<Hyperparameters> &known)
    : runs_(std::move(runs)) {
  set_scales();
  const int groups =
      runs_.group.empty() ? 0 : 1 + *std::max_element(runs_.group.begin(), runs_.group.end());
  const int inputs = int(runs_.at.inputs.rows()), effects = int(runs_.at.amplitudes.rows());
  const auto length = std::size_t(Kernel::prior_means(inputs, effects).size());
  hyperparameters_ = known.value_or(Hyperparameters());
  hyperparameters_.resize(std::size_t(groups));
  std::vector<int> missing;
  for (int group = 0; group < groups; ++group)
    if (hyperparameters_[std::size_t(group)].size() != length)
      missing.push_back(group);
  fit(missing);
  for (int group = 0; group < groups; ++group) {
    kernels_.emplace_back(inputs, effects,
                          Vector::Map(hyperparameters_[std::size_t(group)].data(), length));
    add_factors(group);
  }
}

void Emulator::set_scales() {
  const auto outputs = runs_.values.rows();
  centres_ = Vector::Constant(outputs, std::nan(""));
  spreads_ = Vector::Ones(outputs);
  for (Eigen::Index o = 0; o < outputs; ++o) {
    std::vector<Eigen::Index> known;
    for (Eigen::Index r = 0; r < runs_.values.cols(); ++r)
      if (std::isfinite(runs_.values(o, r)))
        known.push_back(r);
    if (known.empty())
      continue;
    const Eigen::ArrayXd row = runs_.values.row(o)(known);
    centres_[o] = row.mean();
    const double least = 1e-16 * std::max(row.square().mean(), 1e-280);
    spreads_[o] =
        std::sqrt(std::max((row - centres_[o]).square().mean(), least)); // may be constant
  }
}

Matrix Emulator::scaled_values(const std::vector<int> &outputs,
                               const std::vector<int> &runs) const {
  Matrix values = runs_.values(outputs, runs).transpose();
  for (std::size_t k = 0; k < outputs.size(); ++k)
    values.col(Eigen::Index(k)) =
        (values.col(Eigen::Index(k)).array() - centres_[outputs[k]]) / spreads_[outputs[k]];
  return values;
}

void Emulator::fit(const std::vector<int> &groups) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < groups.size(); k = next++) {
      const Vector fitted = this->fitted(groups[k]);
      hyperparameters_[std::size_t(groups[k])] = {fitted.begin(), fitted.end()};
    }
  };
  std::vector<std::future<void>> workers;
  for (unsigned w = std::thread::hardware_concurrency(); w > 1 && !groups.empty(); --w)
    workers.push_back(std::async(std::launch::async, work));
  work();
  for (std::future<void> &w : workers)
    w.get();
}

Vector Emulator::fitted(int group) const {
  struct Part {
    Points at;
    std::vector<int> packing;
    Matrix values;
  };
  std::vector<Part> parts;
  double outputs = 0.0;
  for (const auto &[having, of] : patterns_of(runs_, group)) {
    const std::vector<int> runs = thinned(having);
    parts.push_back({chosen(runs_.at, runs), chosen(runs_.packing, runs), scaled_values(of, runs)});
    outputs += double(of.size());
  }
  const auto function = [&](const Vector &x, Vector &gradient) {
    double value = 0.0;
    gradient.setZero();
    Vector own(x.size());
    for (const Part &part : parts) {
      const double share = double(part.values.cols()) / outputs;
      value += share * misfit(part.at, part.packing, part.values, x, own);
      gradient += share * own;
    }
    return value;
  };
  return minimise(function,
                  Kernel::prior_means(int(runs_.at.inputs.rows()), int(runs_.at.amplitudes.rows())))
      .at;
}

void Emulator::add_factors(int group) {
  const Kernel &kernel = kernels_[std::size_t(group)];
  for (const auto &[having, outputs] : patterns_of(runs_, group)) {
    Factor f{group, outputs, having, chosen(runs_.packing, having), chosen(runs_.at, having),
             {},    {},      {}};
    f.covariance.compute(kernel.of_runs(f.at, f.packing));
    const Matrix values = scaled_values(outputs, having);
    f.weights = f.covariance.solve(values);
    f.scales = scales_of(values, f.weights);
    for (std::size_t k = 0; k < outputs.size(); ++k)
      f.scales[Eigen::Index(k)] *= spreads_[outputs[k]] * spreads_[outputs[k]];
    factors_.push_back(std::move(f));
  }
}

Expectation Emulator::predict(const Points &at, const std::vector<int> &outputs,
                              bool with_variance) const {
  const auto count = at.inputs.cols(), rows = Eigen::Index(outputs.size());
  const Matrix unknown = Matrix::Constant(rows, count, std::nan(""));
  Expectation out{unknown, with_variance ? unknown : Matrix(), unknown};
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    std::vector<std::pair<Eigen::Index, Eigen::Index>> wanted; // row of the answer, of the factor
    for (std::size_t k = 0; k < factors_[f].outputs.size(); ++k)
      for (Eigen::Index row = 0; row < rows; ++row)
        if (outputs[std::size_t(row)] == factors_[f].outputs[k])
          wanted.push_back({row, Eigen::Index(k)});
    for (Eigen::Index first = 0; first < count && !wanted.empty(); first += kBatch) {
      const auto size = std::min(kBatch, count - first);
      const Points some{at.inputs.middleCols(first, size), at.amplitudes.middleCols(first, size)};
      const Batch batch = predict_batch(f, some, with_variance);
      for (const auto &[row, k] : wanted) {
        const int output = outputs[std::size_t(row)];
        const double scale = factors_[f].scales[k];
        out.mean.row(row).segment(first, size) =
            centres_[output] + spreads_[output] * batch.mean.row(k).array();
        out.scatter.row(row).segment(first, size) = scale * batch.scatter;
        if (with_variance)
          out.variance.row(row).segment(first, size) = scale * batch.variance;
      }
    }
  }
  return out;
}

Emulator::Batch Emulator::predict_batch(std::size_t place, const Points &at,
                                        bool with_variance) const {
  const Factor &factor = factors_[place];
  const Kernel &kernel = kernels_[std::size_t(factor.group)];
  Matrix k = kernel.expected(factor.at, at);
  Batch out{factor.weights.transpose() * k, {}, kernel.scatter(at)};
  if (with_variance) {
    factor.covariance.matrixL().solveInPlace(k);
    out.variance =
        (kernel.prior_variance(at) - k.colwise().squaredNorm().transpose()).cwiseMax(0.0);
  }
  return out;
}

Matrix Emulator::correlation(const Points &at, int output) const {
  const auto knows = [&](const Factor &f) {
    return std::find(f.outputs.begin(), f.outputs.end(), output) != f.outputs.end();
  };
  const auto factor = std::find_if(factors_.begin(), factors_.end(), knows);
  if (factor == factors_.end())
    return Matrix::Identity(at.inputs.cols(), at.inputs.cols());
  const Kernel &kernel = kernels_[std::size_t(factor->group)];
  const Matrix known = factor->covariance.matrixL().solve(kernel.expected(factor->at, at));
  Matrix left = kernel.expected(at, at) - known.transpose() * known;
  const Vector scale = left.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  left = scale.asDiagonal() * left * scale.asDiagonal();
  left.diagonal().setOnes();
  return left;
}

/// What the factor's outputs miss by where the runs `of` are unknown, and its variance: the residual is
/// [K^-1]_BB^-1 [K^-1 y]_B for the block B (Rasmussen and Williams eq. 5.12, for more than one run).
void Emulator::leave_out(const Factor &f, const Matrix &inverse, const std::vector<int> &of,
                         LeftOut &out) const {
  const Cholesky block(Matrix(inverse(of, of)));
  const Matrix missed = block.solve(Matrix(f.weights(of, Eigen::all)));
  const Vector variance = block.solve(Matrix::Identity(block.rows(), block.rows())).diagonal();
  for (std::size_t i = 0; i < of.size(); ++i)
    for (std::size_t k = 0; k < f.outputs.size(); ++k) {
      const int o = f.outputs[k], run = f.runs[std::size_t(of[i])];
      const auto row = Eigen::Index(i), column = Eigen::Index(k);
      out.predicted(o, run) = runs_.values(o, run) - spreads_[o] * missed(row, column);
      out.deviation(o, run) = std::sqrt(f.scales[column] * variance[row]);
    }
}

LeftOut Emulator::left_out() const {
  LeftOut out;
  out.predicted = out.deviation =
      Matrix::Constant(runs_.values.rows(), runs_.values.cols(), std::nan(""));
  for (const Factor &f : factors_) {
    const auto n = Eigen::Index(f.runs.size());
    const Matrix inverse = f.covariance.solve(Matrix::Identity(n, n));
    std::map<int, std::vector<int>> members;
    for (int k = 0; k < int(n); ++k)
      members[f.packing[std::size_t(k)]].push_back(k);
    for (const auto &[packing, of] : members)
      leave_out(f, inverse, of, out);
  }
  return out;
}

Matrix error_correlation(const LeftOut &left_out, const Matrix &values, const Matrix &expected) {
  const Matrix error = (values - left_out.predicted).cwiseQuotient(left_out.deviation);
  const Matrix known = error.array().isFinite().cast<double>();
  const Matrix z = (known.array() > 0.0).select(error, 0.0);
  const Matrix square = z.cwiseAbs2() * known.transpose(), runs = known * known.transpose();
  const Matrix sd = square.cwiseProduct(square.transpose()).cwiseSqrt();
  const Matrix sample = (sd.array() > 0.0).select((z * z.transpose()).cwiseQuotient(sd), expected);
  const Eigen::ArrayXXd off = (sample - expected).array(),
                        doubt = (1.0 - sample.array().square()).square() / runs.array().max(1.0),
                        kept = (1.0 - doubt / off.square().max(1e-300)).max(0.0);
  const Eigen::SelfAdjointEigenSolver<Matrix> parts(Matrix(expected.array() + kept * off));
  const Matrix out = parts.eigenvectors() *
                     parts.eigenvalues().cwiseMax(kLeastEigenvalue).asDiagonal() *
                     parts.eigenvectors().transpose();
  const Vector scale = out.diagonal().cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * out * scale.asDiagonal();
}

std::vector<Accuracy> accuracy_of(const LeftOut &left_out, const Matrix &values) {
  const double half = normal_quantile(0.75), most = normal_quantile(0.95);
  std::vector<Accuracy> all;
  for (Eigen::Index o = 0; o < values.rows(); ++o) {
    std::vector<Eigen::Index> known;
    for (Eigen::Index r = 0; r < values.cols(); ++r)
      if (std::isfinite(left_out.predicted(o, r)))
        known.push_back(r);
    if (known.empty()) {
      constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
      all.push_back({kNone, kNone, kNone, kNone, kNone, kNone});
      continue;
    }
    const Eigen::ArrayXd value = values.row(o)(known), predicted = left_out.predicted.row(o)(known),
                         deviation = left_out.deviation.row(o)(known);
    const Eigen::ArrayXd z = ((predicted - value) / deviation).abs();
    Accuracy q;
    q.error = std::sqrt((predicted - value).square().mean());
    q.spread = std::sqrt((value - value.mean()).square().mean());
    q.q2 = 1.0 - q.error * q.error / std::max(q.spread * q.spread, 1e-300);
    q.inside_50 = (z < half).cast<double>().mean();
    q.inside_90 = (z < most).cast<double>().mean();
    q.square = z.square().mean();
    all.push_back(q);
  }
  return all;
}

} // namespace calendem::inference
