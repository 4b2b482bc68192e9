// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/further_data.h"
#include "base/random.h"
#include "inference/likelihood.h"
#include <algorithm>
#include <numeric>

namespace calendem::inference {
namespace {

using Eigen::Index;

constexpr int kSamples = 400; // of readings; a probability's error is 0.025 at most
constexpr std::uint64_t kReadingStream = 0x4ead;

/// Further data under one draw.
struct Predicted {
  Vector mean;
  Matrix covariance;
};

Predicted given_measured(const Residuals &data, Index from, Index measured, Index all) {
  std::vector<Index> known(static_cast<std::size_t>(data.residual.size()));
  std::iota(known.begin(), known.end(), Index(0));
  known.erase(known.begin() + from + measured, known.begin() + from + all);
  const auto n = all - measured, at = from + measured;
  const Cholesky factor(data.covariance(known, known));
  const Matrix with = data.covariance(known, Eigen::seqN(at, n)), by = factor.solve(with);
  return {by.transpose() * data.residual(known) - data.residual.segment(at, n),
          data.covariance.block(at, at, n, n) - with.transpose() * by};
}

/// Moments of a hypothesis.
struct Moments {
  double weight = 0.0;
  Vector mean;
  Matrix square; ///< of the data about 0

  void add(double by, const Predicted &p) {
    if (weight == 0.0) {
      mean = Vector::Zero(p.mean.size());
      square = Matrix::Zero(p.mean.size(), p.mean.size());
    }
    weight += by;
    mean += by * p.mean;
    square += by * (p.covariance + p.mean * p.mean.transpose());
  }
  Vector middle(const std::vector<int> &of) const { return mean(of) / weight; }
  Matrix covariance(const std::vector<int> &of) const {
    const Vector m = middle(of);
    Matrix out = square(of, of) / weight - m * m.transpose();
    out.diagonal() *= 1.0 + 1e-9;
    return out;
  }
};

double entropy_of(const Vector &probabilities) {
  double out = 0.0;
  for (const double p : probabilities)
    out -= p > 0.0 ? p * std::log(p) : 0.0;
  return out;
}

/// Hypotheses as normals of what is measured together.
class Rivals {
public:
  Rivals(const std::vector<Moments> &of, const std::vector<int> &places)
      : weights_(Index(of.size())) {
    for (std::size_t h = 0; h < of.size(); ++h) {
      weights_[Index(h)] = of[h].weight;
      means_.push_back(of[h].middle(places));
      factors_.emplace_back(of[h].covariance(places));
      log_norms_.push_back(-factors_[h].matrixLLT().diagonal().array().log().sum());
    }
  }
  ExpectedGain gain() const {
    Random random(kReadingStream, 1);
    ExpectedGain out;
    const double now = entropy_of(weights_);
    for (Index h = 0; h < weights_.size(); ++h) {
      const Vector &mean = means_[std::size_t(h)];
      Matrix readings(mean.size(), kSamples);
      for (double &v : readings.reshaped())
        v = random.normal();
      readings = Matrix(factors_[std::size_t(h)].matrixL() * readings).colwise() + mean;
      const Matrix after = given(readings);
      for (const auto probabilities : after.colwise())
        out.information += weights_[h] / kSamples * (now - entropy_of(probabilities));
      out.probability += weights_[h] * after.row(h).mean();
    }
    return out;
  }

private:
  Vector weights_;
  std::vector<Vector> means_;
  std::vector<Cholesky> factors_;
  std::vector<double> log_norms_;

  /// Hypotheses x readings, which are columns.
  Matrix given(const Matrix &readings) const {
    Matrix out(weights_.size(), readings.cols());
    for (Index h = 0; h < out.rows(); ++h) {
      Matrix off = readings.colwise() - means_[std::size_t(h)];
      factors_[std::size_t(h)].matrixL().solveInPlace(off);
      out.row(h) = std::log(weights_[h]) + log_norms_[std::size_t(h)] -
                   0.5 * off.colwise().squaredNorm().array();
    }
    out = (out.rowwise() - out.colwise().maxCoeff().eval()).array().exp();
    return out.array().rowwise() / out.colwise().sum().eval().array();
  }
};

} // namespace

std::vector<ExpectedGain> expected_gains(const PosteriorProblem &problem,
                                         const Posterior &posterior, int film, Index measured,
                                         const std::vector<std::vector<int>> &further,
                                         const std::vector<int> &hypotheses) {
  std::vector<int> films(problem.films.size());
  std::iota(films.begin(), films.end(), 0);
  const auto states = film_states(problem, posterior.draws);
  const Index all = problem.films[std::size_t(film)].observed.size();
  std::vector<Moments> moments(
      std::size_t(*std::max_element(hypotheses.begin(), hypotheses.end())) + 1);
  for (std::size_t d = 0; d < posterior.draws.size(); ++d) {
    Residuals data = residuals_of(problem, films, states[d], posterior.draws[d]);
    const Index from = data.begin[std::size_t(film)];
    data.residual.segment(from + measured, all - measured) -=
        problem.films[std::size_t(film)].observed.tail(all - measured);
    moments[std::size_t(hypotheses[d])].add(posterior.draws[d].weight,
                                            given_measured(data, from, measured, all));
  }
  moments.erase(std::remove_if(moments.begin(), moments.end(),
                               [](const Moments &m) { return m.weight <= 0.0; }),
                moments.end());
  std::vector<ExpectedGain> out;
  for (const std::vector<int> &places : further)
    out.push_back(Rivals(moments, places).gain());
  return out;
}

} // namespace calendem::inference
