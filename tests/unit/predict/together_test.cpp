// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/csv_table.h"
#include "base/provenance.h"
#include "predict/together.h"
#include "support/made_coatings.h"
#include <array>
#include <gtest/gtest.h>
#include <map>

using namespace calendem;
using calendem_test::made_coatings;
using calendem_test::made_film;
namespace {

constexpr Response kBase = {0.36, 0.12};

double after(double load, double springback) { return 1.0 - (1.0 - load) / (1.0 + springback); }
double load_of(const Response &r) { return 1.0 - (1.0 - r.porosity) * (1.0 + r.springback); }

TEST(Together, OneEffectIsWhatItIsAlone) {
  for (const Response &change : {Response{-0.05, -0.04}, Response{0.03, 0.02}}) {
    const Response more = beyond_sum(kBase, {change});
    EXPECT_NEAR(more.springback, 0.0, 1e-15);
    EXPECT_NEAR(more.porosity, 0.0, 1e-15);
  }
}

// Two that leave 1/2 and 1/4 of the springback and take nothing under load.
TEST(Together, TheStrongestTakesItsShareOfTheSpringback) {
  const double load = load_of(kBase), s = kBase.springback;
  const Response half = {after(load, s / 2) - kBase.porosity, -s / 2},
                 most = {after(load, s / 4) - kBase.porosity, -s * 3 / 4};
  const double left = s / 4 * std::pow(0.5, kOthers);
  for (const std::vector<Response> &both : {std::vector{half, most}, std::vector{most, half}}) {
    const Response more = beyond_sum(kBase, both);
    EXPECT_NEAR(more.springback, left - (s - s / 2 - s * 3 / 4), 1e-12);
    EXPECT_NEAR(more.porosity, after(load, left) - (kBase.porosity + half.porosity + most.porosity),
                1e-12);
  }
}

TEST(Together, OfWhatTheyTakeUnderLoadTheMostCountsAndRisesAdd) {
  const double load = load_of(kBase), s = kBase.springback;
  const auto change = [&](double by) {
    return Response{after(load + by, s) - kBase.porosity, 0.0};
  };
  const auto together = [&](const std::vector<Response> &changes) {
    double sum = kBase.porosity;
    for (const Response &c : changes)
      sum += c.porosity;
    return sum + beyond_sum(kBase, changes).porosity;
  };
  EXPECT_NEAR(together({change(-0.03), change(-0.01)}), after(load - 0.03, s), 1e-12);
  EXPECT_NEAR(together({change(0.05), change(-0.01), change(0.02)}), after(load + 0.06, s), 1e-12);
  EXPECT_NEAR(beyond_sum(kBase, {{0.0, 0.03}, {0.0, 0.02}}).springback, 0.0, 1e-12);
}

// Requirement: an effect that does nothing changes nothing, nor does one that is hardly there jump.
TEST(Together, AWeakEffectDoesLittle) {
  const Response one = {-0.05, -0.04}, weak = {-1e-6, -1e-6};
  const Response more = beyond_sum(kBase, {one, weak});
  EXPECT_NEAR(more.porosity, 0.0, 3e-6);
  EXPECT_NEAR(more.springback, 0.0, 3e-6);
}

// An emulator that takes more springback than there is, or of a base model that hardly springs back.
TEST(Together, NoSpringbackIsLeftWhereAnEffectTakesAll) {
  EXPECT_GT(beyond_sum(kBase, {{0.0, -0.2}, {0.0, -0.2}}).springback + kBase.springback - 0.4, 0.0);
  EXPECT_LT(beyond_sum(kBase, {{0.0, -0.2}, {0.0, -0.2}}).springback + kBase.springback - 0.4,
            2e-3);
  const Response stiff = {0.36, -0.01};
  EXPECT_LT(beyond_sum(stiff, {{0.0, 0.03}, {0.0, 0.02}}).springback + 0.04, 0.06);
}

TEST(Together, TheBankAddsItsErrorOnlyWhereSeveralAct) {
  BankTable table = made_coatings({"nmc_plasticity", "cbd_collapse"});
  for (BankRow &row : table.rows)
    if (SimulatedRun &r = row.run; !row.point.effect.empty()) // half of the springback
      r.porosity_at_max = 0.5 * (r.porosity_at_max + r.porosity_after);
  const FilmBank bank(table);
  const Film film = made_film("x", 46.0, 2.2);
  const Acting yields = {0, find_effect("nmc_plasticity").parameter.amplitude(2.5)},
               collapses = {1, find_effect("cbd_collapse").parameter.amplitude(30.0)};
  const auto at = [&](const std::vector<Acting> &effects, FilmNumber number) {
    return bank.at_pressures(number, film, {{190.0, 2.4, 480.0}, effects})[3];
  };
  const auto value = [&](FilmNumber n, const std::vector<Acting> &effects) {
    return at(effects, n).mean;
  };
  const auto response = [&](const std::vector<Acting> &effects) {
    return Response{value(FilmNumber::PorosityAfter, effects),
                    value(FilmNumber::Springback, effects)};
  };
  const Response none = response({}), one = response({yields}), other = response({collapses});
  const Response both = response({yields, collapses});
  const Response more =
      beyond_sum(none, {{one.porosity - none.porosity, one.springback - none.springback},
                        {other.porosity - none.porosity, other.springback - none.springback}});
  EXPECT_GT(more.porosity, 0.005);
  EXPECT_NEAR(both.porosity, one.porosity + other.porosity - none.porosity + more.porosity, 1e-12);
  EXPECT_NEAR(both.springback,
              one.springback + other.springback - none.springback + more.springback, 1e-12);
  const auto variance = [&](FilmNumber number, const std::vector<Acting> &effects) {
    return at(effects, number).variance;
  };
  for (const auto &[number, beyond] : {std::pair(FilmNumber::PorosityAfter, more.porosity),
                                       std::pair(FilmNumber::Springback, more.springback)})
    EXPECT_NEAR(variance(number, {yields, collapses}) - variance(number, {yields}) -
                    variance(number, {collapses}) + variance(number, {}),
                std::pow(kBeyondSumError * beyond, 2), 1e-12);
}

/// Runs of every set of three effects on one film at one pressure, means over packings.
using Sets = std::array<Response, 8>;

std::vector<Sets> simulated() {
  const CsvTable t = CsvTable::parse(
      text_of_file(CALENDEM_SOURCE_DIR "/input_scripts/cases/studies/results/together.csv"));
  const auto column = [&](const char *name) { return t.numbers(name); };
  const auto film = column("recipe.composition.carbon_weight_percent"),
             pressure = column("case.platen.max_pressure_MPa"),
             friction = column("case.material.am.friction"),
             yields = column("case.effects.cbd_plasticity.yield_pressure_GPa"),
             collapses = column("case.effects.cbd_collapse.yield_pressure_MPa"),
             porosity = column("porosity_after_relaxation"), springback = column("springback");
  std::map<std::pair<double, double>, Sets> out;
  std::map<std::pair<double, double>, std::array<int, 8>> runs;
  for (std::size_t k = 0; k < t.rows(); ++k) {
    const std::pair<double, double> of = {film[k], pressure[k]};
    const auto set =
        std::size_t((friction[k] > 0.1) + 2 * (yields[k] > 0) + 4 * (collapses[k] > 0));
    const double n = ++runs[of][set];
    Response &mean = out[of][set];
    mean.porosity += (porosity[k] - mean.porosity) / n;
    mean.springback += (springback[k] - mean.springback) / n;
  }
  std::vector<Sets> all;
  for (const auto &[of, sets] : out)
    all.push_back(sets);
  return all;
}

// More than five points of porosity lie between the sum and what runs show of effects together, and as much
// springback; less than one is left, as much as is stated.
TEST(Together, RunsShowWhatIsStated) {
  const std::vector<Sets> all = simulated();
  ASSERT_EQ(all.size(), 4u);
  Response beyond, left, of_sum; // sums of squares
  for (const Sets &s : all)
    for (const std::size_t set : {3, 5, 6, 7}) {
      std::vector<Response> changes;
      Response sum = s[0];
      for (const std::size_t one : {1, 2, 4})
        if (set & one) {
          changes.push_back({s[one].porosity - s[0].porosity, s[one].springback - s[0].springback});
          sum.porosity += changes.back().porosity;
          sum.springback += changes.back().springback;
        }
      const Response more = beyond_sum(s[0], changes);
      const auto add = [](Response &to, double porosity, double springback) {
        to.porosity += porosity * porosity / 16.0;
        to.springback += springback * springback / 16.0;
      };
      add(beyond, more.porosity, more.springback);
      add(of_sum, s[set].porosity - sum.porosity, s[set].springback - sum.springback);
      add(left, s[set].porosity - sum.porosity - more.porosity,
          s[set].springback - sum.springback - more.springback);
    }
  EXPECT_GT(std::sqrt(of_sum.porosity), 0.05);
  EXPECT_GT(std::sqrt(of_sum.springback), 0.05);
  EXPECT_LT(std::sqrt(left.porosity), 0.009);
  EXPECT_LT(std::sqrt(left.springback), 0.006);
  EXPECT_LT(std::sqrt(left.porosity / beyond.porosity), kBeyondSumError);
  EXPECT_GT(std::sqrt(left.porosity / beyond.porosity), 0.5 * kBeyondSumError);
  EXPECT_LT(std::sqrt(left.springback / beyond.springback), kBeyondSumError);
}

} // namespace
