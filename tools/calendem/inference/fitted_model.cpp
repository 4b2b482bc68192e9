// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/fitted_model.h"
#include "base/random.h"
#include "inference/changes.h"
#include <algorithm>
#include <numeric>

namespace calendem::inference {
namespace {

using Eigen::Index;

// A direction in the data keeps this part of its variance at least: draws do not tell more exactly what
// recalibration makes up for.
constexpr double kLeastLeft = 0.05;
constexpr int kWorlds = 2000; // of noise; a 95 % point of these is one of 94.5 to 95.5 %
constexpr std::uint64_t kNoiseStream = 0x4e05;

/// C - A, with A reduced to what leaves each direction its least part.
Matrix without_absorbed(const Matrix &errors, const Matrix &absorbed) {
  const Cholesky factor(errors);
  const auto lower = factor.matrixL();
  const Matrix half = lower.solve(absorbed),
               white = lower.solve(Matrix(half.transpose())); // L^-1 A L^-T
  const Eigen::SelfAdjointEigenSolver<Matrix> parts(0.5 * (white + white.transpose()));
  const Vector left = (1.0 - parts.eigenvalues().array()).max(kLeastLeft);
  const Matrix of = lower * parts.eigenvectors();
  return of * left.asDiagonal() * of.transpose();
}

double quantile_95(std::vector<double> values) {
  const auto at = values.begin() + std::ptrdiff_t(0.95 * double(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Squares of a block in its covariance, for each column.
Vector squares_of(const Matrix &residuals, const Matrix &covariance, const Block &block) {
  const Cholesky factor(covariance(block.members, block.members));
  return factor.matrixL()
      .solve(Matrix(residuals(block.members, Eigen::all)))
      .colwise()
      .squaredNorm()
      .transpose();
}

BlockResidual residual_of(const FittedModel &model, const std::vector<Block> &blocks, int place) {
  const std::vector<int> &members = blocks[std::size_t(place)].members;
  const Vector off = -model.residual(members),
               sd = model.covariance.diagonal()(members).cwiseSqrt();
  BlockResidual out;
  out.block = place;
  out.residual = std::copysign(std::sqrt(off.squaredNorm() / double(off.size())), off.sum());
  out.sd = std::sqrt(sd.squaredNorm() / double(sd.size()));
  Index worst;
  off.cwiseQuotient(sd).cwiseAbs().maxCoeff(&worst);
  out.worst = members[std::size_t(worst)];
  return out;
}

double gap_of(const Vector &residual, const Vector &sd, const std::vector<Block> &blocks) {
  double sum = 0.0;
  for (const Block &b : blocks)
    sum += (residual(b.members).array() / sd(b.members).array()).square().mean();
  return std::sqrt(sum / double(blocks.size()));
}

} // namespace

Matrix noise_of(const Matrix &covariance) {
  Random random(kNoiseStream, 1);
  Matrix out(covariance.rows(), kWorlds);
  for (double &v : out.reshaped())
    v = random.normal();
  return Cholesky(covariance).matrixL() * out;
}

Matrix with_others_off(const Matrix &amplitudes, const std::vector<int> &acting,
                       std::size_t effects) {
  Matrix out = Matrix::Constant(Index(effects), amplitudes.cols(), kOff);
  out(acting, Eigen::all) = amplitudes;
  return out;
}

PosteriorProblem problem_of_model(const PosteriorProblem &problem, const std::vector<int> &acting,
                                  int film) {
  PosteriorProblem out = problem;
  out.effects.clear();
  for (const int e : acting) {
    out.effects.push_back(problem.effects[std::size_t(e)]);
    out.effects.back().probability = 1.0;
  }
  out.understated = 0.0;
  for (FilmData &of : out.films)
    of.discrepancy.resize(0, 0), of.shared_discrepancy.resize(0, 0);
  out.predict = [acting, film, effects = problem.effects, predict = problem.predict](
                    int of, const Matrix &scores, const Matrix &amplitudes) {
    Matrix all = with_others_off(amplitudes, acting, effects.size());
    for (std::size_t e = 0; e < effects.size() && of != film; ++e)
      if (effects[e].of_film)
        all.row(Index(e)).setConstant(kOff);
    return predict(of, scores, all);
  };
  if (problem.other_data)
    out.other_data = [acting, all = problem.effects.size(), other = problem.other_data](
                         int material, const Matrix &scores, const Matrix &amplitudes) {
      return other(material, scores, with_others_off(amplitudes, acting, all));
    };
  return out;
}

std::vector<int> effects_of_model(const PosteriorProblem &problem) {
  std::vector<int> out;
  for (int e = 0; e < int(problem.effects.size()); ++e)
    if (is_of_model(problem.effects[std::size_t(e)]))
      out.push_back(e);
  return out;
}

FittedModel fit_model(const PosteriorProblem &problem, const std::vector<int> &acting, int film,
                      const SamplerSettings &settings) {
  const PosteriorProblem alone = problem_of_model(problem, acting, film);
  FittedModel out;
  out.acting = acting;
  out.posterior = sample_posterior(alone, settings);
  const auto states = film_states(alone, out.posterior.draws);
  std::vector<int> films(alone.films.size());
  std::iota(films.begin(), films.end(), 0);
  Matrix residuals;
  for (std::size_t d = 0; d < states.size(); ++d) {
    const Residuals data = residuals_of(alone, films, states[d], out.posterior.draws[d]);
    if (d == 0) {
      residuals.resize(data.residual.size(), Index(states.size()));
      out.covariance = Matrix::Zero(data.residual.size(), data.residual.size());
    }
    residuals.col(Index(d)) = data.residual;
    out.covariance += data.covariance / double(states.size());
  }
  out.residual = residuals.rowwise().mean();
  const Matrix off = residuals.colwise() - out.residual;
  out.expected = without_absorbed(out.covariance, off * off.transpose() / double(states.size()));
  return out;
}

ResidualTable residual_table(const FittedModel &model, const std::vector<Block> &blocks) {
  ResidualTable out;
  const Matrix noise = noise_of(model.expected);
  std::vector<double> largest(kWorlds, 0.0);
  double sum = 0.0;
  for (int b = 0; b < int(blocks.size()); ++b) {
    const Block &block = blocks[std::size_t(b)];
    const int n = int(block.members.size());
    const Vector of_noise = squares_of(noise, model.expected, block);
    for (int w = 0; w < kWorlds; ++w)
      largest[std::size_t(w)] = std::max(largest[std::size_t(w)], equivalent_z(of_noise[w], n));
    BlockResidual row = residual_of(model, blocks, b);
    row.z = std::copysign(equivalent_z(squares_of(model.residual, model.expected, block)[0], n),
                          row.residual);
    sum += row.z * row.z;
    out.rows.push_back(row);
  }
  out.threshold = quantile_95(std::move(largest));
  for (BlockResidual &row : out.rows) {
    row.share = sum > 0.0 ? row.z * row.z / sum : 0.0;
    row.significant = std::fabs(row.z) > out.threshold;
  }
  return out;
}

StandardisedGap standardised_gap(const FittedModel &model, const std::vector<Block> &blocks) {
  const Vector sd = model.covariance.diagonal().cwiseSqrt();
  const Matrix noise = noise_of(model.expected);
  std::vector<double> gaps;
  double squares = 0.0;
  for (Index w = 0; w < noise.cols(); ++w) {
    gaps.push_back(gap_of(noise.col(w), sd, blocks));
    squares += gaps.back() * gaps.back() / kWorlds;
  }
  return {gap_of(model.residual, sd, blocks), std::sqrt(squares), quantile_95(gaps)};
}

} // namespace calendem::inference
