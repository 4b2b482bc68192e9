// SPDX-License-Identifier: GPL-2.0-or-later
// Posteriors against closed forms and quadrature. Tolerance of a probability p: 4.5 sqrt(p (1 - p) /
// N) for N particles, the error of N independent draws 4.5 standard deviations out (one in 150 000);
// draws are fewer than independent by resampling, and more by the moves afterwards.
#include "inference/local_model.h"
#include "linear_films.h"
#include <gtest/gtest.h>
#include <map>

namespace calendem::inference {
namespace {

double tolerance_of(double p, int particles) {
  return 4.5 * std::sqrt(std::max(p * (1.0 - p), 1.0 / particles) / particles);
}

/// Probability that each switch of the first material is on, and of every set of them, as bits.
std::pair<Vector, std::map<unsigned, double>> inclusion_of(const PosteriorProblem &problem,
                                                           const Posterior &posterior) {
  const std::vector<Switch> switches = switches_of(problem, 0);
  std::pair<Vector, std::map<unsigned, double>> out{Vector::Zero(Eigen::Index(switches.size())),
                                                    {}};
  for (const Draw &d : posterior.draws) {
    unsigned set = 0;
    for (std::size_t s = 0; s < switches.size(); ++s)
      if (acts(score_of(d, 0, switches[s]))) {
        out.first[Eigen::Index(s)] += d.weight;
        set |= 1U << unsigned(s);
      }
    out.second[set] += d.weight;
  }
  return out;
}

void expect_inclusion(const Vector &expected, const PosteriorProblem &problem,
                      const Posterior &posterior) {
  const Vector found = inclusion_of(problem, posterior).first;
  for (Eigen::Index e = 0; e < expected.size(); ++e)
    EXPECT_NEAR(found[e], expected[e], tolerance_of(expected[e], posterior.particles))
        << "effect " << e;
}

TEST(Posterior, HasTheProbabilityOfEverySetInLinearWorlds) {
  const double alike[] = {0.3, 0.5, 0.9}, scale[] = {0.3, 1.0, 4.0};
  for (int world = 0; world < 3; ++world) {
    LinearFilms films(30, 3, 6, alike[world], 100 + std::uint64_t(world));
    films.signatures *= scale[world];
    Random random(7, std::uint64_t(world));
    films.problem.films[0].observed = films.draw({2, 5}, random);
    double log_evidence = 0.0;
    const Vector sets = films.exact(log_evidence);
    const Posterior posterior = sample_posterior(films.problem);
    expect_inclusion(films.exact_inclusion(log_evidence), films.problem, posterior);
    // A step that leaves half of the particles has a relative variance of 1 / N.
    EXPECT_NEAR(posterior.log_evidence, log_evidence,
                4.5 * std::sqrt(double(posterior.steps.size()) / posterior.particles));
    for (const auto &[set, probability] : inclusion_of(films.problem, posterior).second)
      EXPECT_NEAR(probability, sets[set], tolerance_of(sets[set], posterior.particles));
  }
}

TEST(Posterior, AgreesWithQuadratureOverTheDiscrepancy) {
  LinearFilms films(30, 2, 4, 0.5, 11);
  films.problem.discrepancy = {Prior::log_uniform, 0.05, 5.0};
  Random random(3, 1);
  films.problem.films[0].observed = films.draw({1}, random);
  double log_evidence = 0.0;
  const Vector expected = films.exact_inclusion(log_evidence, 60);
  const Posterior posterior = sample_posterior(films.problem);
  expect_inclusion(expected, films.problem, posterior);
}

TEST(Posterior, IsThePriorWithoutData) {
  LinearFilms films(1, 2, 3, 0.0, 5);
  films.problem.films[0].measurement *= 1e12; // a reading that says nothing
  films.problem.effects[1].probability = 0.4;
  films.problem.effects[2].of_film = true;
  films.problem.understated = 0.3;
  const Posterior posterior = sample_posterior(films.problem);
  const Vector found = inclusion_of(films.problem, posterior).first;
  const double expected[] = {0.1, 0.4, 0.1};
  for (std::size_t e = 0; e < 3; ++e)
    EXPECT_NEAR(found[Eigen::Index(e)], expected[e], tolerance_of(expected[e], 512));
  double understated = 0.0, mean = 0.0, square = 0.0;
  for (const Draw &d : posterior.draws) {
    understated += d.weight * double(d.understatement[0] > 1.0);
    mean += d.weight * d.scores(0, 0);
    square += d.weight * d.scores(0, 0) * d.scores(0, 0);
  }
  // One reading on its mean has a density of 1 / factor: mean of that over a log-uniform factor.
  const double density = (1.0 / 1.5 - 1.0 / 5.0) / std::log(5.0 / 1.5),
               expected_share = 0.3 * density / (0.7 + 0.3 * density);
  EXPECT_NEAR(understated, expected_share, tolerance_of(expected_share, 512));
  EXPECT_NEAR(mean, 0.0, 4.5 / std::sqrt(512.0));
  EXPECT_NEAR(square, 1.0, 4.5 * std::sqrt(2.0 / 512.0));
}

/// A datum of a model that is nonlinear in its score and in an effect's.
double bent(double score, double amplitude, int datum) {
  const double x = 0.3 * (datum + 1);
  return 2.0 * std::tanh(x * score + 0.5 * score * score) +
         (acts(amplitude) ? 1.5 * std::exp(0.5 * amplitude) * std::sin(2.0 * x + score) : 0.0);
}

/// By quadrature over both scores, of data with errors of 1: probability that the effect acts, 0.3
/// before the data, and mean of the score.
std::pair<double, double> bent_posterior(const Vector &y) {
  const auto density = [&](double score, double amplitude) {
    double square = score * score;
    for (int i = 0; i < int(y.size()); ++i)
      square += std::pow(y[i] - bent(score, amplitude, i), 2);
    return std::exp(-0.5 * square);
  };
  double on = 0.0, off = 0.0, mean = 0.0;
  const double step = 0.02;
  for (double s = -6.0; s <= 6.0; s += step) {
    const double without = density(s, kOff) * 0.7 * step;
    off += without;
    mean += s * without;
    for (double a = -6.0; a <= 6.0; a += step) {
      const double with =
          density(s, a) * std::exp(-0.5 * a * a) / std::sqrt(2.0 * kPi) * 0.3 * step * step;
      on += with;
      mean += s * with;
    }
  }
  return {on / (on + off), mean / (on + off)};
}

TEST(Posterior, AgreesWithQuadratureWhereTheModelBends) {
  LinearFilms films(6, 1, 1, 0.0, 21);
  films.problem.effects[0].probability = 0.3;
  films.problem.predict = [&](int, const Matrix &scores, const Matrix &amplitudes) {
    FilmPredictions out;
    out.mean.resize(6, scores.cols());
    for (Eigen::Index k = 0; k < scores.cols(); ++k)
      for (int i = 0; i < 6; ++i)
        out.mean(i, k) = bent(scores(0, k), amplitudes(0, k), i);
    return out;
  };
  Vector &y = films.problem.films[0].observed;
  for (int i = 0; i < 6; ++i)
    y[i] = bent(0.6, -0.4, i) + 0.7 * (i % 2 ? 1.0 : -1.0);
  const auto [on, mean] = bent_posterior(y);
  const Posterior posterior = sample_posterior(films.problem);
  expect_inclusion(Vector::Constant(1, on), films.problem, posterior);
  double found = 0.0, square = 0.0;
  for (const Draw &d : posterior.draws) {
    found += d.weight * d.scores(0, 0);
    square += d.weight * d.scores(0, 0) * d.scores(0, 0);
  }
  EXPECT_NEAR(found, mean, 4.5 * std::sqrt((square - found * found) / posterior.particles));
}

TEST(Posterior, IsTheSameTwice) {
  LinearFilms films(12, 2, 4, 0.5, 31);
  SamplerSettings settings;
  settings.particles = 64;
  const Posterior one = sample_posterior(films.problem, settings),
                  two = sample_posterior(films.problem, settings);
  ASSERT_EQ(one.draws.size(), two.draws.size());
  EXPECT_EQ(one.log_evidence, two.log_evidence);
  for (std::size_t k = 0; k < one.draws.size(); ++k) {
    EXPECT_EQ(one.draws[k].scores, two.draws[k].scores);
    EXPECT_EQ(one.draws[k].amplitudes, two.draws[k].amplitudes);
  }
}

/// Two films of different materials, one parameter and one effect each; the exact answer by
/// quadrature over how alike they are.
/// Mean correlation of two materials, and the probabilities that the effect acts in the first and in
/// both.
struct ByQuadrature {
  double alike = 0.0, first = 0.0, both = 0.0;
};

/// Over the correlation, with each set of effects in closed form.
ByQuadrature of_two_materials(const LinearFilms &films) {
  Vector y(16);
  y << films.problem.films[0].observed, films.problem.films[1].observed;
  double all = 0.0, rho_sum = 0.0, first = 0.0, both = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double rho = (k + 0.5) / 200;
    for (int set = 0; set < 4; ++set) {
      const bool on[] = {(set & 1) != 0, (set & 2) != 0};
      Matrix c = Matrix::Identity(16, 16);
      Vector off = y;
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
          const double alike = a == b ? 1.0 : rho;
          c.block(8 * a, 8 * b, 8, 8) += alike * films.slopes * films.slopes.transpose();
          if (on[a] && on[b])
            c.block(8 * a, 8 * b, 8, 8) +=
                0.09 * alike * films.signatures * films.signatures.transpose();
        }
      for (int a = 0; a < 2; ++a)
        if (on[a])
          off.segment(8 * a, 8) -= films.signatures.col(0);
      const auto own = [&](int a) { return on[a] ? 0.3 : 0.7; };
      const double prior = (1.0 - rho) * own(0) * own(1) + (on[0] == on[1] ? rho * own(0) : 0.0);
      const Cholesky factor(c);
      const double density =
          prior * std::exp(log_student_t(factor.matrixL().solve(off).squaredNorm(),
                                         2.0 * factor.matrixLLT().diagonal().array().log().sum(),
                                         16, kNormal));
      all += density;
      rho_sum += rho * density;
      first += on[0] ? density : 0.0;
      both += on[0] && on[1] ? density : 0.0;
    }
  }
  return {rho_sum / all, first / all, both / all};
}

TEST(Posterior, LearnsHowAlikeMaterialsAre) {
  LinearFilms films(8, 1, 1, 0.0, 41);
  films.problem.materials = 2;
  films.problem.effects[0].probability = 0.3;
  films.problem.films.push_back(films.problem.films[0]);
  films.problem.films[1].material = 1;
  Random random(9, 1);
  films.problem.films[0].observed =
      0.8 * films.slopes + films.signatures * 0.6 + normal_matrix(8, 1, random);
  films.problem.films[1].observed = 0.9 * films.slopes + normal_matrix(8, 1, random);
  const ByQuadrature expected = of_two_materials(films);
  const Posterior posterior = sample_posterior(films.problem);
  double rho = 0.0, one = 0.0, two = 0.0;
  for (const Draw &d : posterior.draws) {
    ASSERT_EQ(d.scores.cols(), 3); // with one that was not measured
    rho += d.weight * d.material_correlation;
    one += d.weight * double(acts(d.amplitudes(0, 0)));
    two += d.weight * double(acts(d.amplitudes(0, 0)) && acts(d.amplitudes(0, 1)));
  }
  EXPECT_NEAR(rho, expected.alike, 4.5 * 0.29 / std::sqrt(512.0)); // sd of a uniform
  EXPECT_NEAR(one, expected.first, tolerance_of(expected.first, 512));
  EXPECT_NEAR(two, expected.both, tolerance_of(expected.both, 512));
}

TEST(Posterior, SharesDiscrepancyAsADenseCovarianceDoes) {
  LinearFilms films(5, 1, 1, 0.0, 51);
  PosteriorProblem &p = films.problem;
  p.materials = 2;
  Random random(2, 1);
  for (int f = 0; f < 3; ++f) {
    FilmData film = p.films[0];
    film.material = f == 2;
    film.observed = normal_matrix(5, 1, random);
    film.shared_discrepancy = normal_matrix(5, 2, random);
    film.shared_errors = normal_matrix(5, 1, random);
    p.films.push_back(film);
  }
  p.films.erase(p.films.begin());
  Draw draw = sample_posterior(p, {8, 1, 1, 1, 0.5, 1}).draws.front();
  draw.discrepancy = 1.3;
  std::vector<FilmTerms> terms;
  const auto states = film_states(p, {draw}).front();
  for (int f = 0; f < 3; ++f)
    terms.push_back(terms_of(p, f, states[std::size_t(f)], draw));
  const Residuals dense = residuals_of(p, {0, 1, 2}, states, draw);
  const Cholesky factor(dense.covariance);
  EXPECT_NEAR(log_likelihood(p, draw, terms),
              log_student_t(factor.matrixL().solve(dense.residual).squaredNorm(),
                            2.0 * factor.matrixLLT().diagonal().array().log().sum(), 15, kNormal),
              1e-9);
}

} // namespace
} // namespace calendem::inference
