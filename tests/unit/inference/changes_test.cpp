// SPDX-License-Identifier: GPL-2.0-or-later
// What is read from draws: which changes, how certain, the verdict; in worlds whose answer is known.
#include "inference/changes.h"
#include "inference/fitted_model.h"
#include "inference/further_data.h"
#include "linear_films.h"
#include <gtest/gtest.h>
#include <numeric>

namespace calendem::inference {
namespace {

/// Draws of equal weight: for each change those in which it is so.
Changes made_changes(int draws, const std::vector<std::vector<int>> &on, double prior = 0.1) {
  Changes out;
  out.on = Matrix::Zero(draws, Eigen::Index(on.size()));
  out.weights = Vector::Constant(draws, 1.0 / draws);
  for (std::size_t k = 0; k < on.size(); ++k) {
    for (const int d : on[k])
      out.on(d, Eigen::Index(k)) = 1.0;
    out.all.push_back({Change::added, int(k), prior});
  }
  for (int k = 0; k < int(on.size()); ++k) {
    out.all[std::size_t(k)].probability = out.probability({k});
    out.all[std::size_t(k)].bayes_factor = out.bayes_factor({k});
  }
  return out;
}

std::vector<int> range(int from, int to) {
  std::vector<int> out(std::size_t(to - from));
  std::iota(out.begin(), out.end(), from);
  return out;
}

TEST(Changes, AreRelativeToTheModel) {
  LinearFilms films(4, 1, 3, 0.0, 1);
  PosteriorProblem &p = films.problem;
  p.effects[1].probability = 0.9; // of the model
  p.effects[2].of_film = true;
  p.understated = 0.05;
  p.discrepancy = {Prior::log_uniform, 0.1, 10.0};
  Posterior posterior;
  Draw d;
  d.weight = 0.25;
  d.amplitudes = Eigen::Vector3d(kOff, 0.0, kOff);
  d.faults = Eigen::Vector3d(kOff, kOff, kOff);
  d.understatement = Vector::Ones(1);
  d.discrepancy = 0.2;
  posterior.draws.assign(4, d);
  posterior.draws[0].amplitudes(0, 0) = 1.0;
  posterior.draws[1].amplitudes(1, 0) = kOff;
  posterior.draws[1].faults(2, 0) = 0.3;
  posterior.draws[2].understatement[0] = 2.0;
  posterior.draws[2].discrepancy = posterior.draws[3].discrepancy = 2.0;
  const Changes found = changes_of(p, posterior, 0, 1.0);
  ASSERT_EQ(found.all.size(), 5u);
  const Change::Kind kinds[] = {Change::added, Change::absent, Change::fault, Change::understated,
                                Change::something};
  const double priors[] = {0.1, 0.1, 0.1, 0.05, 0.5}, after[] = {0.25, 0.25, 0.25, 0.25, 0.5};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(found.all[k].kind, kinds[k]);
    EXPECT_NEAR(found.all[k].prior, priors[k], 1e-12);
    EXPECT_DOUBLE_EQ(found.all[k].probability, after[k]);
    EXPECT_NEAR(found.all[k].bayes_factor,
                after[k] / (1.0 - after[k]) / (priors[k] / (1.0 - priors[k])), 1e-12);
  }
  EXPECT_DOUBLE_EQ(found.probability({0, 3, 4}), 0.75);
  const std::vector<ChangeSet> sets =
      ranked_sets(found); // what may be something else is summed over
  ASSERT_EQ(sets.size(), 4u);
  EXPECT_DOUBLE_EQ(sets[0].probability, 0.25);
  EXPECT_EQ(sets_of_draws(found, sets)[3], 0); // none: the smallest set stands first
}

TEST(Verdict, NamesWhatIsCertainAndStrong) {
  const Changes one = made_changes(20, {range(0, 18), range(3, 5), range(1, 3)});
  const Verdict v = verdict_of(one, 0.5, true);
  EXPECT_EQ(v.kind, Verdict::explained);
  EXPECT_EQ(v.changes, std::vector<int>{0});
  EXPECT_DOUBLE_EQ(v.probability, 0.9);
  // probable before the data, and no more after them
  EXPECT_EQ(verdict_of(made_changes(20, {range(0, 18)}, 0.85), 0.5, false).kind,
            Verdict::nothing_seen);
  EXPECT_EQ(verdict_of(one, 0.001, true).kind, Verdict::something_else);
}

TEST(Verdict, NamesAGroupOfWhichOneActs) {
  const Changes alike = made_changes(20, {range(0, 10), range(10, 19), range(4, 6)});
  const Verdict v = verdict_of(alike, 0.5, true);
  EXPECT_EQ(v.kind, Verdict::one_of);
  EXPECT_EQ(v.changes, (std::vector<int>{0, 1}));
  EXPECT_DOUBLE_EQ(v.probability, 0.95);
  // ten effects of which the data say nothing hold most of the draws, too
  std::vector<std::vector<int>> any(10);
  for (int d = 0; d < 1024; ++d)
    for (int k = 0; k < 10; ++k)
      if (d >> k & 1)
        any[std::size_t(k)].push_back(d);
  EXPECT_EQ(verdict_of(made_changes(1024, any, 0.5), 0.5, false).kind, Verdict::nothing_seen);
}

// Two changes that chance on in the same draws as often as apart are no group: neither stands for the other, though
// one of them is so in 91 % of the draws.
TEST(Verdict, ChangesThatDoNotExcludeEachOtherAreNoGroup) {
  const std::vector<int> first = range(0, 70);
  std::vector<int> second = range(21, 70);
  for (const int d : range(70, 91))
    second.push_back(d);
  const Changes both = made_changes(100, {first, second, range(0, 20)});
  const Verdict v = verdict_of(both, 0.5, false);
  EXPECT_EQ(v.kind, Verdict::one_of);
  EXPECT_EQ(v.changes.size(), 3u) << "all that the sets have, not a group of two";
  const Changes apart = made_changes(100, {range(0, 60), range(55, 91), range(0, 20)});
  EXPECT_EQ(verdict_of(apart, 0.5, false).changes, (std::vector<int>{0, 1}));
}

TEST(Verdict, ASignificantGapWithoutANameListsWhatIsLeft) {
  const Changes open = made_changes(20, {range(0, 5), range(3, 8), range(19, 20)});
  EXPECT_EQ(verdict_of(open, 0.5, false).kind, Verdict::nothing_seen);
  const Verdict v = verdict_of(open, 0.5, true);
  EXPECT_EQ(v.kind, Verdict::one_of);
  EXPECT_EQ(v.changes, (std::vector<int>{0, 1}));
  Changes unknown = made_changes(20, {range(0, 1), range(0, 19)});
  unknown.all[1].kind = Change::something;
  EXPECT_EQ(verdict_of(unknown, 0.5, true).kind, Verdict::something_else);
}

// Closed form: residual C (C + G G')^-1 (y - signature), its covariance C (C + G G' + w w')^-1 C. Errors of the mean and
// of a covariance of 128 particles, 4.5 standard deviations out.
TEST(FittedModel, LeavesTheResidualsOfTheClosedForm) {
  LinearFilms films(8, 2, 3, 0.0, 61);
  Random random(4, 1);
  films.problem.films[0].observed = films.draw({1}, random);
  films.problem.effects[1].probability = 0.9;
  SamplerSettings settings;
  settings.particles = 128;
  const FittedModel model = fit_model(films.problem, effects_of_model(films.problem), 0, settings);
  const Matrix c = films.problem.films[0].measurement;
  const Vector w = films.signatures.col(1);
  const Matrix absorbed = films.slopes * films.slopes.transpose() + 0.09 * w * w.transpose(),
               gain = c * Cholesky(Matrix(c + absorbed)).solve(Matrix::Identity(8, 8));
  const Vector expected = gain * (films.problem.films[0].observed - w);
  const Matrix left = gain * c;
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(model.residual[i], expected[i],
                4.5 * std::sqrt(1.0 - left(i, i)) / std::sqrt(128.0));
    EXPECT_NEAR(model.expected(i, i), left(i, i),
                4.5 * std::sqrt(2.0 / 128.0) * (1.0 - left(i, i)) + 0.05);
  }
}

/// A fitted model without draws: residuals of these errors.
FittedModel made_model(const Vector &residual, const Matrix &expected) {
  FittedModel out;
  out.residual = residual;
  out.covariance = out.expected = expected;
  return out;
}

// 5.0 % of tables pass their threshold: 3 binomial standard deviations of 2000, and of the threshold's own 2000 worlds.
TEST(ResidualTable, PassesItsThresholdByChanceInFivePercent) {
  Random random(8, 1);
  Matrix mix = normal_matrix(9, 9, random);
  const Matrix expected = mix * mix.transpose() + Matrix::Identity(9, 9);
  const std::vector<Block> blocks = {{"a", "", "", {0}},
                                     {"b", "", "", {1, 2, 3, 4, 5}},
                                     {"c", "", "", {6, 7}},
                                     {"d", "", "", {8}}};
  const double threshold = residual_table(made_model(Vector::Zero(9), expected), blocks).threshold;
  int passed = 0;
  const int worlds = 2000;
  const Cholesky factor(expected);
  for (int w = 0; w < worlds; ++w) {
    const Vector noise = factor.matrixL() * normal_matrix(9, 1, random);
    double largest = 0.0;
    for (const Block &b : blocks)
      largest = std::max(largest, equivalent_z(Cholesky(expected(b.members, b.members))
                                                   .matrixL()
                                                   .solve(noise(b.members))
                                                   .squaredNorm(),
                                               int(b.members.size())));
    passed += largest > threshold;
  }
  EXPECT_NEAR(passed / double(worlds), 0.05, 3.0 * std::sqrt(2.0 * 0.05 * 0.95 / worlds));
  Vector off = Vector::Zero(9);
  off[8] = -6.0 * std::sqrt(expected(8, 8));
  const ResidualTable found = residual_table(made_model(off, expected), blocks);
  EXPECT_TRUE(found.rows[3].significant);
  EXPECT_FALSE(found.rows[0].significant);
  EXPECT_NEAR(found.rows[3].z, 6.0, 1e-9); // predicted above measured
  EXPECT_NEAR(found.rows[3].share, 1.0, 1e-12);
  EXPECT_EQ(found.rows[3].worst, 8);
}

TEST(StandardisedGap, IsOneForNoiseThatNothingMakesUpFor) {
  const std::vector<Block> blocks = {{"a", "", "", {0}}, {"b", "", "", {1, 2, 3}}};
  Vector off(4);
  off << 6.0, 1.0, 2.0, -2.0;
  const StandardisedGap gap =
      standardised_gap(made_model(off, 4.0 * Matrix::Identity(4, 4)), blocks);
  EXPECT_NEAR(gap.value, std::sqrt(0.5 * (9.0 + 0.75)), 1e-12);
  EXPECT_NEAR(gap.noise, 1.0, 0.05); // 2000 worlds; 1.9 degrees of freedom or more
  EXPECT_GT(gap.noise_most, 1.3);
}

// Two hypotheses of equal weight, normal with means +-a and a variance of 1: information by quadrature.
TEST(FurtherData, TellWhatQuadratureSays) {
  LinearFilms films(3, 1, 1, 0.0, 71);
  PosteriorProblem &p = films.problem;
  films.slopes.setZero();
  films.signatures.col(0) << 0.0, 3.0, 0.0;
  films.spread = 0.0;
  Posterior posterior;
  for (int k = 0; k < 200; ++k) {
    Draw d;
    d.weight = 1.0 / 200;
    d.scores = Matrix::Zero(1, 2);
    d.amplitudes = Matrix::Constant(1, 2, k % 2 ? 0.0 : kOff);
    d.faults = Matrix::Constant(1, 1, kOff);
    d.understatement = Vector::Ones(1);
    posterior.draws.push_back(d);
  }
  std::vector<int> hypotheses;
  for (int k = 0; k < 200; ++k)
    hypotheses.push_back(k % 2);
  const auto gains = expected_gains(p, posterior, 0, 1, {{0}, {1}, {0, 1}}, hypotheses);
  double information = 0.0, right = 0.0;
  const double step = 0.01, a = 1.5;
  for (double y = -9.0; y < 9.0; y += step) {
    const double after = 1.0 / (1.0 + std::exp(-2.0 * a * y)),
                 density = std::exp(-0.5 * (y - a) * (y - a)) / std::sqrt(2.0 * kPi);
    right += density * after * step;
    information +=
        density *
        (std::log(2.0) + after * std::log(after) + (1.0 - after) * std::log1p(-after + 1e-300)) *
        step;
  }
  // 800 readings: 3 standard errors of at most 0.3 / sqrt(800)
  EXPECT_NEAR(gains[0].probability, right, 0.032);
  EXPECT_NEAR(gains[0].information, information, 0.032);
  EXPECT_NEAR(gains[1].information, 0.0, 1e-6);
  EXPECT_NEAR(gains[1].probability, 0.5, 1e-6);
  EXPECT_NEAR(gains[2].information, information, 0.032);
}

// What was measured fixes what its datum shares with the further one: given it, that is known.
TEST(FurtherData, AreConditionedOnWhatWasMeasured) {
  LinearFilms films(2, 1, 1, 0.0, 81);
  PosteriorProblem &p = films.problem;
  films.slopes.setZero();
  films.signatures.col(0) << 0.0, 1.0;
  films.spread = 0.0;
  p.films[0].measurement << 25.0, 24.99, 24.99, 25.0; // one common error
  Posterior posterior;
  for (int k = 0; k < 2; ++k) {
    Draw d;
    d.weight = 0.5;
    d.scores = Matrix::Zero(1, 2);
    d.amplitudes = Matrix::Constant(1, 2, k ? 0.0 : kOff);
    d.faults = Matrix::Constant(1, 1, kOff);
    d.understatement = Vector::Ones(1);
    posterior.draws.push_back(d);
  }
  EXPECT_GT(expected_gains(p, posterior, 0, 1, {{0}}, {0, 1})[0].probability, 0.99);
  p.films[0].measurement << 25.0, 0.0, 0.0, 25.0;
  EXPECT_LT(expected_gains(p, posterior, 0, 1, {{0}}, {0, 1})[0].probability, 0.55);
}

/// Worlds with 14 effects and 24 data, and a discrepancy from well below the noise to well above it.
struct Worlds {
  LinearFilms films{24, 3, 14, 0.3, 91};
  SamplerSettings settings;
  Worlds() {
    films.signatures *= 1.6; // signals of 5 to 7
    films.problem.discrepancy = {Prior::log_uniform, 0.1, 10.0};
    films.problem.effects[0].probability = 0.9; // of the model
    settings.particles = 256;
    settings.final_sweeps = 8;
  }
  Verdict answer(const Vector &observed, Changes &changes) {
    PosteriorProblem &p = films.problem;
    p.films[0].observed = observed;
    const Posterior posterior = sample_posterior(p, settings);
    changes = changes_of(p, posterior, 0, 1.0);
    return verdict_of(changes, adequacy_of(p, posterior), false);
  }
};

TEST(Verdict, OfLinearWorldsIsTheirCause) {
  Worlds worlds;
  Random random(17, 1);
  int named = 0, wrong = 0;
  const int truths = 10;
  for (int e = 0; e < truths; ++e) {
    Changes c;
    std::vector<int> acting = {0};
    if (e == 0)
      acting.clear(); // the model's own effect is absent
    else
      acting.push_back(e);
    const Verdict v = worlds.answer(worlds.films.draw(acting, random), c);
    bool is_right = false;
    for (const int k : v.changes)
      is_right = is_right || c.all[std::size_t(k)].effect == e;
    named += v.kind == Verdict::explained && is_right;
    wrong += v.kind == Verdict::explained && !is_right;
    EXPECT_TRUE(is_right || v.kind == Verdict::something_else) << e;
  }
  EXPECT_GE(named, 7);
  EXPECT_EQ(wrong, 0);
  int claimed = 0; // a cause is named in fewer than 2 % of worlds without one: 2 of 8 in 1 %
  for (int k = 0; k < 8; ++k) {
    Changes c;
    claimed += worlds.answer(worlds.films.draw({0}, random), c).kind == Verdict::explained;
  }
  EXPECT_LE(claimed, 1);
}

TEST(Verdict, OfACauseThatTheTableLacksIsSomethingElse) {
  Worlds worlds;
  Random random(19, 1);
  int unknown = 0;
  for (int k = 0; k < 4; ++k) {
    Changes c;
    const Vector cause =
        Cholesky(worlds.films.problem.films[0].discrepancy + 1e-6 * Matrix::Identity(24, 24))
            .matrixL() *
        normal_matrix(24, 1, random);
    const Verdict v = worlds.answer(worlds.films.draw({0}, random) + 4.0 * cause, c);
    unknown += v.kind == Verdict::something_else;
    EXPECT_NE(v.kind, Verdict::nothing_seen);
  }
  EXPECT_GE(unknown, 3);
}

} // namespace
} // namespace calendem::inference
