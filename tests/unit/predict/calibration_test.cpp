// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/prediction.h"
#include "support/made_coatings.h"
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;

const std::vector<double> kPressures = {25.0, 50.0, 90.0, 150.0, 250.0};

CalibrationSettings few() {
  CalibrationSettings s;
  s.samples = 512;
  s.draws = 200;
  return s;
}

Calibration of(const Truth &truth, std::uint64_t seed = 1) {
  Random random(seed, 21);
  Calibration c;
  c.error = {0.0, 0.001, 0.02};
  measure(truth, made_film("a", 48.0, 2.0), kPressures, 0.002, random, c);
  measure(truth, made_film("b", 43.0, 2.5), kPressures, 0.002, random, c);
  calibrate(made_film_bank(), few(), c);
  return c;
}

double probability(const Calibration &c, const std::string &name, std::size_t material = 0) {
  for (const EffectSet &set : effect_sets_of(made_film_bank(), c))
    if (set.name == name)
      return set.probability[material];
  return 0.0;
}

// Each of two effects acts with a probability of 0.1 before the data. 200 draws: standard deviations of 0.028 and 0.021,
// of which three are allowed.
TEST(Calibrate, WithoutDataNothingIsLearnt) {
  Calibration c;
  c.films = {made_film("a", 48.0, 2.0)};
  calibrate(made_film_bank(), few(), c);
  EXPECT_NEAR(probability(c, "none"), 0.81, 0.084);
  EXPECT_NEAR(acting(c, kYields, 0), 0.1, 0.063);
  EXPECT_EQ(c.draws.size(), 200u);
}

// A measured film is known by what it is, whatever it is called.
TEST(Calibrate, AFilmsNameIsNoEvidence) {
  const Film a = made_film("a", 48.0, 2.0), renamed = made_film("z", 48.0, 2.0);
  EXPECT_TRUE(is_same_film(a, renamed));
  EXPECT_FALSE(is_same_film(a, made_film("a", 48.0, 2.5)));
  Film thick = a;
  thick.loading = 17.0;
  EXPECT_FALSE(is_same_film(a, thick));
}

// The product of the binder's stiffness and the root of the strength is what porosity shows: its logarithm has a
// standard deviation of 0.33 before the data.
TEST(Calibrate, FindsWhatTheDataShow) {
  const Calibration c = of({});
  double sum = 0.0, squares = 0.0;
  for (const Draw &d : c.draws) {
    const double x = std::log(d.materials[0].parameters[1] / 2.4) +
                     0.5 * std::log(d.materials[0].parameters[2] / 480.0);
    sum += x;
    squares += x * x;
  }
  const double n = double(c.draws.size()), mean = sum / n,
               sd = std::sqrt(squares / n - mean * mean);
  EXPECT_LT(sd, 0.5 * 0.33);
  EXPECT_LT(std::fabs(mean), 2.0 * sd);
  EXPECT_GT(probability(c, "none"), 0.5);
}

TEST(Calibrate, NamesAnEffectThatActs) {
  const Calibration c = of({{190.0, 1.7, 260.0}, 1.0}); // no other material falls as far
  EXPECT_GT(acting(c, kYields, 0), 0.9);
}

// No other material falls as far as the yielding one, and none falls as fast at first as with the other effect.
TEST(Calibrate, FindsTwoEffectsThatActTogether) {
  const FilmBank &bank = made_film_bank();
  const std::vector<double> material = {190.0, 1.7, 260.0};
  const auto calibrated = [&](double yield, double collapse) {
    Random random(4, 21);
    Calibration c;
    c.error = {0.0, 0.001, 0.003};
    measure({material, yield}, made_film("a", 48.0, 2.0), kPressures, 0.001, random, c);
    measure({material, yield}, made_film("b", 43.0, 3.0), kPressures, 0.001, random, c);
    for (Datum &d : c.data)
      d.measured -= collapse > 0.0 ? made_collapse(collapse, d.pressure) : 0.0;
    calibrate(bank, few(), c);
    return c;
  };
  const std::string both = "nmc_plasticity + cbd_collapse";
  const Calibration two = calibrated(1.6, 20.0), one = calibrated(1.6, 0.0);
  EXPECT_GT(probability(two, both), 0.8);
  EXPECT_LT(probability(one, both), 0.3);
  double yield = 0.0, collapse = 0.0, n = 0.0;
  for (const Draw &d : two.draws)
    if (d.materials[0].effects.size() == 2) {
      yield += std::log(key_value(bank, d.materials[0].effects[0]));
      collapse += std::log(key_value(bank, d.materials[0].effects[1]));
      ++n;
    }
  EXPECT_NEAR(yield / n, std::log(1.6), 0.5);
  EXPECT_NEAR(collapse / n, std::log(20.0), 0.7);
}

// No binder of the bank is as soft as this film asks for.
TEST(Calibrate, SaysThatAParameterIsAtTheEndOfItsRange) {
  const std::string end = "lower end of the bank's range";
  const auto said = [](const Calibration &c) {
    return fmt::format("{}", fmt::join(warnings_of(made_film_bank(), c), "\n"));
  };
  EXPECT_EQ(said(of({})).find(end), std::string::npos);
  EXPECT_NE(said(of({{190.0, 1.2, 180.0}, 0.0}, 2)).find(end), std::string::npos);
}

TEST(Calibrate, SaysWhatTheBanksCellsCannotHold) {
  const auto said = warnings_of(made_film_bank(), of({}));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].rfind("84 % of the volume of the bank's powder", 0), 0u) << said[0];
}

// Porosities that rise with pressure are no material's.
TEST(Calibrate, SaysThatNoMaterialComesNear) {
  Calibration c;
  c.error = {0.0, 0.003, 0.04};
  c.films = {made_film("a", 48.0, 2.0)};
  for (const double p : kPressures)
    c.data.push_back({0, "p", FilmNumber::PorosityAfter, p, 0.0, 0.2 + 0.001 * p, 0.002});
  calibrate(made_film_bank(), few(), c);
  const std::string said = fmt::format("{}", fmt::join(warnings_of(made_film_bank(), c), "\n"));
  EXPECT_NE(said.find("No material of the bank comes near"), std::string::npos) << said;
}

// A posterior that hardly any move of the sampler finds.
TEST(Calibrate, SaysThatTheSamplerHardlyMoved) {
  Calibration c = of({});
  c.acceptance = 0.001;
  const std::string said = fmt::format("{}", fmt::join(warnings_of(made_film_bank(), c), "\n"));
  EXPECT_NE(said.find("the sampler took 0.1 % of its moves"), std::string::npos) << said;
}

/// A film that is measured well at all pressures, of that material.
void measure_film(const Truth &truth, const std::string &name, int material, Random &random,
                  Calibration &to) {
  Film film = made_film(name, 46.0, 2.0);
  film.material = material;
  measure(truth, film, kPressures, 0.002, random, to);
}

struct Spread {
  double mean, sd;
};

/// What porosity shows of a material: ln(stiffness of the binder) + ln(strength) / 2.
Spread shown_of(const Calibration &c, std::size_t material) {
  double sum = 0.0, squares = 0.0;
  for (const Draw &d : c.draws) {
    const double x = std::log(d.materials[material].parameters[1]) +
                     0.5 * std::log(d.materials[material].parameters[2]);
    sum += x;
    squares += x * x;
  }
  const double n = double(c.draws.size());
  return {sum / n, std::sqrt(squares / n - sum / n * sum / n)};
}

// Two materials a factor 2.3 apart in that: as one they end between them; as two each is found.
TEST(Calibrate, FilmsOfAnotherMaterialDoNotMislead) {
  const Truth soft = {{190.0, 1.9, 380.0}, 0.0}, stiff = {{190.0, 3.4, 620.0}, 0.0};
  const auto known = [](const Truth &t) {
    return std::log(t.material[1]) + 0.5 * std::log(t.material[2]);
  };
  const auto calibrated = [&](const std::vector<std::string> &materials) {
    Random random(4, 21);
    Calibration c;
    c.error = {0.0, 0.001, 0.02};
    c.materials = materials;
    measure_film(soft, "a", 0, random, c);
    measure_film(stiff, "b", int(materials.size()) - 1, random, c);
    calibrate(made_film_bank(), few(), c);
    return c;
  };
  const double apart = known(stiff) - known(soft);
  const Calibration one = calibrated({"one"}), two = calibrated({"soft", "stiff"});
  ASSERT_EQ(one.draws[0].materials.size(), 2u);
  ASSERT_EQ(two.draws[0].materials.size(), 3u);
  const Spread between = shown_of(one, 0);
  EXPECT_GT(between.mean, known(soft) + 0.3 * apart);
  EXPECT_LT(between.mean, known(stiff) - 0.3 * apart);
  for (const std::size_t m : {0, 1}) {
    const Spread own = shown_of(two, m);
    EXPECT_NEAR(own.mean, known(m == 0 ? soft : stiff), 2.0 * own.sd);
    EXPECT_LT(own.sd, 0.25 * apart);
    EXPECT_GT(shown_of(two, 2).sd, 1.5 * own.sd); // one that was not measured
  }
}

// Whichever comes first, within what 512 samples leave open.
TEST(Calibrate, TheOrderOfMaterialsDoesNotMatter) {
  const Truth soft = {{190.0, 2.0, 400.0}, 0.0}, stiff = {{190.0, 2.8, 560.0}, 1.5};
  const auto calibrated = [&](int first) {
    Random random(4, 21);
    Calibration c;
    c.error = {0.0, 0.001, 0.02};
    c.materials = {"a", "b"};
    measure_film(soft, "soft", first, random, c);
    measure_film(stiff, "stiff", 1 - first, random, c);
    calibrate(made_film_bank(), few(), c);
    return c;
  };
  const Calibration a = calibrated(0), b = calibrated(1);
  EXPECT_NEAR(shown_of(a, 0).mean, shown_of(b, 1).mean, 0.05);
  EXPECT_NEAR(shown_of(a, 1).mean, shown_of(b, 0).mean, 0.05);
  EXPECT_NEAR(probability(a, "none", 0), probability(b, "none", 1), 0.1);
  EXPECT_NEAR(probability(a, "none", 1), probability(b, "none", 0), 0.1);
}

// One that was not measured follows half of the time; otherwise it has effects of its own, one of two with 0.19. 200 draws:
// 0.035 a standard deviation, of which three are allowed.
TEST(Calibrate, AMaterialThatWasNotMeasuredMayHaveOtherEffects) {
  const Calibration c = of({{190.0, 1.7, 260.0}, 1.0});
  const double measured = 1.0 - probability(c, "none");
  EXPECT_GT(measured, 0.9);
  double acts = 0.0;
  for (const Draw &d : c.draws)
    acts += !d.materials[1].effects.empty() / 200.0;
  EXPECT_GT(acts, 0.19);
  EXPECT_LT(acts, 0.5 * measured + 0.5 * 0.19 + 0.105);
}

// The other material's films change the odds of an effect by less than a factor of two: at most 3 to 1 in favour of what they
// show, and half of the time nothing.
TEST(Calibrate, AnEffectMayActInOneOfTwoMaterials) {
  const auto calibrated = [](bool both) {
    Random random(4, 21);
    Calibration c;
    c.error = {0.0, 0.001, 0.02};
    c.materials = {"yielding"};
    measure_film({{190.0, 1.7, 260.0}, 1.0}, "a", 0, random, c);
    if (both) {
      c.materials.push_back("plain");
      measure_film({{190.0, 2.4, 480.0}, 0.0}, "b", 1, random, c);
    }
    calibrate(made_film_bank(), few(), c);
    return c;
  };
  const Calibration alone = calibrated(false), both = calibrated(true);
  const auto odds = [](double p) { return p / (1.0 - p); };
  EXPECT_LT(odds(probability(both, "none", 0)), 2.0 * odds(probability(alone, "none")));
  EXPECT_GT(probability(both, "none", 1), 0.5);
}

TEST(Calibrate, IsDeterministic) {
  const Calibration a = of({}), b = of({});
  for (std::size_t k = 0; k < a.draws.size(); ++k)
    EXPECT_EQ(a.draws[k].materials[0].parameters, b.draws[k].materials[0].parameters);
}

} // namespace
