// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/choose_points.h"
#include "diagnose/inference/emulators.h"
#include "synthetic_bank.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <numeric>

namespace calendem::inference {
namespace {

constexpr double kScatter = 0.08, kNoise = 0.02;
constexpr int kBaseRuns = 40;

// What is asked for one by one and all together is the same; a run that was not made scatters as
// runs do.
TEST(GaussianProcess, CovarianceOfWhatWasNotRun) {
  Training t;
  t.inputs = (2.0 * sobol_points(2, 24, 1).array() - 1.0).matrix();
  t.amplitudes = sobol_points(1, 24, 2);
  t.values.resize(24);
  Random random(3, 3);
  std::vector<double> of_packing(6);
  for (double &v : of_packing)
    v = 0.3 * random.normal();
  for (int k = 0; k < 24; ++k) {
    t.packing.push_back(k % 6);
    const double a = t.amplitudes(0, k);
    t.values[k] =
        a * (1.0 + t.inputs(0, k) + of_packing[std::size_t(k % 6)]) + 0.1 * random.normal();
  }
  const GaussianProcess g(t);
  Asked asked;
  asked.inputs = (2.0 * sobol_points(2, 4, 9).array() - 1.0).matrix();
  asked.inputs.col(3) = asked.inputs.col(2);
  asked.amplitudes = Matrix(1, 4);
  asked.amplitudes << 0.2, 0.9, 0.5, 0.5;
  constexpr int kNewPacking = 99;
  asked.packing = {kExpectation, kExpectation, kExpectation, kNewPacking};
  const Matrix c = g.covariance(asked);
  EXPECT_NEAR((c - c.transpose()).norm(), 0.0, 1e-12 * c.norm());
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(c(k, k) / g.at(asked.inputs.col(k), asked.amplitudes.col(k)).variance, 1.0, 1e-9);
  EXPECT_NEAR(c(3, 2) / c(2, 2), 1.0, 1e-9);
  EXPECT_NEAR((c(3, 3) - c(2, 2)) / (0.25 * g.packing_variance() + g.run_variance()), 1.0, 1e-9);
  asked.packing[3] = 0; // known, in part
  EXPECT_LT(g.covariance(asked)(3, 3), c(3, 3));
}

/// A bank whose friction was run beside few of the base runs, and what it could still run.
struct Half {
  Bank whole = synthetic_bank(kBaseRuns, kScatter), bank = whole;
  std::vector<PossiblePoint> possible;
  std::vector<BankRun> runs; ///< the same, made

  Half() {
    const std::map<std::string, int> has = {{"friction", 5}, {"plasticity", 20}, {"viscous", 20}};
    bank.runs.clear();
    std::map<std::string, int> count;
    for (const BankRun &run : whole.runs) {
      const auto has_effect = has.find(run.effect);
      const int number = count[run.effect]++;
      if (has_effect == has.end() || number < has_effect->second) {
        bank.runs.push_back(run);
        continue;
      }
      for (const double amplitude : {0.125, 0.375, 0.625, 0.875}) {
        Random packing(std::uint64_t(number), 77); // that of its base run
        BankRun made = run;
        made.amplitudes[0] = amplitude;
        made.values =
            synthetic_values(run.base[0], run.base[1], run.effect, amplitude, packing, kScatter);
        runs.push_back(made);
        const int effect = run.effect == "plasticity" ? 0 : run.effect == "friction" ? 1 : 2;
        possible.push_back({effect, number, run.base, made.amplitudes, run.packing});
      }
    }
  }

  Model learnt(const std::vector<int> &more) const {
    Bank all = bank;
    for (const int k : more)
      all.runs.push_back(runs[std::size_t(k)]);
    ModelSettings large;
    large.packings_in_sample = 1e6;
    return Model(all, synthetic_experiment("", 0.0, 1, 0.0, kNoise), large);
  }
};

/// Mean square, over priors, of what the emulators of an effect are off by, over the data's.
double off(const Model &model, const Half &world, int effect) {
  const Matrix scores = sobol_normals(3, 64, 21);
  const Problem p = model.problem(Vector::Zero(Eigen::Index(model.observables().size())));
  const Vector data = model.data_variance();
  double sum = 0.0;
  for (Eigen::Index k = 0; k < scores.cols(); ++k) {
    const Vector base = scores.col(k).head(2), own = scores.col(k).tail(1);
    const double stiffness = world.bank.base[0].prior.value(base[0]),
                 strength = world.bank.base[1].prior.value(base[1]),
                 amplitude =
                     world.bank.effects[std::size_t(effect)].parameters[0].prior.value(own[0]);
    Random none(1, 1), same(1, 1);
    const auto n = Eigen::Index(model.observables().size());
    const Vector on = synthetic_values(stiffness, strength,
                                       world.bank.effects[std::size_t(effect)].name, amplitude,
                                       same, 0.0),
                 without = synthetic_values(stiffness, strength, "", 0.0, none, 0.0);
    const Vector truth = model.map().emulated_of(Matrix(on.head(n))) -
                         model.map().emulated_of(Matrix(without.head(n)));
    const Vector said =
        (p.predict(base, {{effect, own}}).mean - p.predict(base, {}).mean).head(data.size());
    sum += (said - truth).cwiseAbs2().cwiseQuotient(data).sum() / 64.0;
  }
  return sum;
}

// Most is to be learnt of an effect that was hardly run, and none of the base points counts twice.
// The runs chosen gain more than as many of each effect, and once made they lower what the
// emulators are off by in truth further.
TEST(ChoosePoints, GoWhereMostIsToBeLearnt) {
  const Half world;
  const Model model = world.learnt({});
  constexpr int kCount = 12;
  const std::vector<ChosenPoint> chosen = choose_points(model, world.bank, world.possible, kCount);
  ASSERT_EQ(int(chosen.size()), kCount);
  std::vector<int> places, count(3, 0), even;
  std::map<std::pair<int, int>, int> beside;
  double gain = 0.0;
  for (const ChosenPoint &c : chosen) {
    const PossiblePoint &p = world.possible[std::size_t(c.place)];
    places.push_back(c.place);
    ++count[std::size_t(p.effect)];
    EXPECT_EQ(++beside[std::pair(p.effect, p.beside)], 1);
    gain += c.gain;
  }
  EXPECT_GE(count[1], kCount / 2);
  const auto gain_of = [&](const std::vector<int> &some) {
    std::vector<PossiblePoint> points;
    for (const int k : some)
      points.push_back(world.possible[std::size_t(k)]);
    const std::vector<double> all = information_gain(model, world.bank, points);
    return std::accumulate(all.begin(), all.end(), 0.0);
  };
  EXPECT_NEAR(gain_of(places), gain, 1e-9);
  std::vector<int> of_each(3, 0);
  for (int k = 0; k < int(world.possible.size()); k += 5) // strengths in turn
    if (of_each[std::size_t(world.possible[std::size_t(k)].effect)]++ < kCount / 3)
      even.push_back(k);
  ASSERT_EQ(int(even.size()), kCount);
  EXPECT_GT(gain, 1.2 * gain_of(even));
  const Model with = world.learnt(places), with_even = world.learnt(even);
  double before = 0.0, after = 0.0, after_even = 0.0;
  for (int e = 0; e < 3; ++e) {
    before += std::log2(1.0 + off(model, world, e));
    after += std::log2(1.0 + off(with, world, e));
    after_even += std::log2(1.0 + off(with_even, world, e));
  }
  RecordProperty("before", std::to_string(before));
  RecordProperty("after", std::to_string(after));
  RecordProperty("after_even", std::to_string(after_even));
  EXPECT_LT(after, after_even);
  EXPECT_LT(after_even, before);
}

} // namespace
} // namespace calendem::inference
