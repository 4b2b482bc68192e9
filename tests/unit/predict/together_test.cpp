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
  EXPECT_NEAR(springback_beyond_sum(kBase, {{-0.05, -0.04}}), 0.0, 1e-15);
  EXPECT_NEAR(porosity_beyond_sum(kBase, {{-0.05, -0.04}}), 0.0, 1e-15);
}

// Two that halve the springback and take nothing under load leave a quarter of it.
TEST(Together, SpringbackIsMultipliedAndPorosityUnderLoadAdded) {
  const double load = load_of(kBase), half = after(load, 0.06) - kBase.porosity;
  const std::vector<Response> both = {{half, -0.06}, {half, -0.06}};
  EXPECT_NEAR(springback_beyond_sum(kBase, both), 0.03, 1e-12);
  EXPECT_NEAR(porosity_beyond_sum(kBase, both), after(load, 0.03) - kBase.porosity - 2.0 * half,
              1e-12);
  // Effects that leave springback alone add.
  const double denser = after(load - 0.03, 0.12) - kBase.porosity;
  EXPECT_NEAR(porosity_beyond_sum(kBase, {{denser, 0.0}, {denser, 0.0}}), 0.0, 1e-12);
}

// An emulator that takes more springback than there is does not turn the product's sign.
TEST(Together, NoSpringbackIsLeftWhereAnEffectTakesAll) {
  const double s =
      springback_beyond_sum(kBase, {{0.0, -0.2}, {0.0, -0.2}}) + kBase.springback - 0.4;
  EXPECT_GT(s, 0.0);
  EXPECT_LT(s, 1e-4);
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
  const std::vector<Response> changes = {
      {one.porosity - none.porosity, one.springback - none.springback},
      {other.porosity - none.porosity, other.springback - none.springback}};
  const Response both = response({yields, collapses});
  const double more = porosity_beyond_sum(none, changes);
  EXPECT_GT(more, 0.005);
  EXPECT_NEAR(both.porosity, one.porosity + other.porosity - none.porosity + kRunsOverRule * more,
              1e-12);
  EXPECT_NEAR(both.springback,
              one.springback + other.springback - none.springback +
                  springback_beyond_sum(none, changes),
              1e-12);
  const auto variance = [&](const std::vector<Acting> &effects) {
    return at(effects, FilmNumber::PorosityAfter).variance;
  };
  EXPECT_NEAR(variance({yields, collapses}) - variance({yields}) - variance({collapses}) +
                  variance({}),
              kRunsOverRuleError * kRunsOverRuleError * more * more, 1e-12);
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

// Nearly five points lie between the sum and what runs show of effects together; one is left.
TEST(Together, RunsShowWhatIsStated) {
  double products = 0.0, squares = 0.0, beyond_sum = 0.0, left = 0.0;
  const std::vector<Sets> all = simulated();
  ASSERT_EQ(all.size(), 4u);
  for (const Sets &s : all)
    for (const std::size_t set : {3, 5, 6, 7}) {
      std::vector<Response> changes;
      double sum = s[0].porosity;
      for (const std::size_t one : {1, 2, 4})
        if (set & one) {
          changes.push_back({s[one].porosity - s[0].porosity, s[one].springback - s[0].springback});
          sum += changes.back().porosity;
        }
      const double given = porosity_beyond_sum(s[0], changes), shown = s[set].porosity - sum;
      products += given * shown;
      squares += given * given;
      beyond_sum += shown * shown / 16.0;
      left += (shown - kRunsOverRule * given) * (shown - kRunsOverRule * given) / 16.0;
    }
  EXPECT_NEAR(products / squares, kRunsOverRule, 0.5 * kRunsOverRuleError);
  EXPECT_NEAR(std::sqrt(left * 16.0 / squares), kRunsOverRuleError, 0.1);
  EXPECT_GT(std::sqrt(beyond_sum), 0.04);
  EXPECT_LT(std::sqrt(left), 0.012);
}

} // namespace
