// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/compare/gap.h"
#include "diagnose/rerun.h"
#include "diagnose/sample_film.h"
#include <algorithm>
#include <boost/random/chi_squared_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>

namespace calendem {

namespace {

constexpr double kOtherFilm = 0.1; // of the film: more than a bank varies it

/// Mean over the base model's runs to the bank's pressure next to this one.
double usual(const BankTable &table, double pressure,
             const std::function<double(const SimulatedRun &)> &value) {
  double sum = 0.0, n = 0.0, apart = INFINITY;
  for (const BankRow &row : table.rows)
    if (row.point.effect.empty())
      apart = std::min(apart, std::fabs(row.run.target - pressure));
  for (const BankRow &row : table.rows)
    if (row.point.effect.empty() && std::fabs(row.run.target - pressure) <= apart) {
      sum += value(row.run);
      n += 1.0;
    }
  return sum / n;
}

const MeasurementPrice &price_of(const BankSpec &spec, const std::string &name) {
  return *std::find_if(spec.prices.begin(), spec.prices.end(),
                       [&](const MeasurementPrice &p) { return p.name == name; });
}

/// What only is measured on it: the sample's loading and its pressure stay.
Condition bare(const Condition &c) {
  Condition out;
  out.id = c.id;
  out.specimen = c.specimen;
  out.control = c.control;
  out.max_pressure_MPa = c.max_pressure_MPa;
  out.loading_mg_cm2 = c.loading_mg_cm2;
  out.mass_mg = c.mass_mg;
  return out;
}

Condition with_loading(const Experiment &e, const Condition &c, const BankTable &table,
                       std::vector<std::string> &not_said) {
  const double other = 1.0 / film_ratio(e, table);
  return loading_of(e, c) || !(std::fabs(other - 1.0) > kOtherFilm)
             ? c
             : with_loading_of_recipe(e, c, not_said);
}

/// The measurements of one kind: on each condition that lacks it.
class Kind {
public:
  Kind(const Experiment &e, const BankTable &table, const std::string &name)
      : experiment_(e), table_(table), price_(price_of(table.spec, name)) {
    out_.what = price_.what;
  }
  void add(const Condition &c, const std::vector<Observable> &observables) {
    out_.of.push_back({c, c.max_pressure_MPa->value, observables});
    out_.what += (out_.of.size() == 1 ? ": " : ", ") + c.id;
    out_.hours += price_.hours;
  }
  void add(const Condition &c) {
    std::vector<std::string> not_said;
    add(c, observables_of(experiment_, c, not_said));
  }
  /// Measured to the price's deviation at what the bank usually gives.
  Measured expected(const Condition &c,
                    const std::function<double(const SimulatedRun &)> &value) const {
    return {usual(table_, c.max_pressure_MPa->value, value), price_.sd};
  }
  double sd() const { return price_.sd; }
  void finish(std::vector<Further> &list) const {
    if (!out_.of.empty())
      list.push_back(out_);
  }

private:
  const Experiment &experiment_;
  const BankTable &table_;
  const MeasurementPrice &price_;
  Further out_;
};

void add_porosity(Kind &kind, Condition c) {
  c.porosity_after_percent =
      kind.expected(c, [](const SimulatedRun &r) { return 100.0 * r.porosity_after; });
  kind.add(c);
}

void add_thickness(Kind &kind, const Experiment &e, Condition c) {
  if (const auto loading = loading_of(e, c)) {
    c.thickness_at_max_um =
        kind.expected(c, [](const SimulatedRun &r) { return r.thickness_at_max / r.solid_column; });
    c.thickness_at_max_um->value *= solid_thickness_um(e, loading->value);
  } else {
    c.thickness_at_max_um =
        kind.expected(c, [](const SimulatedRun &r) { return r.thickness_at_max; });
  }
  kind.add(c);
}

void add_curve(Kind &kind, const Experiment &e, const Condition &c, Branch branch) {
  const auto loading = loading_of(e, c);
  const double solid = loading ? solid_thickness_um(e, loading->value) : 1.0;
  std::vector<Observable> points = points_of_curve(e, c, c.max_pressure_MPa->value, branch);
  for (Observable &o : points) {
    o.sd = kind.sd() / solid;
    o.by_loading =
        loading ? -kind.expected(c, o.simulated).value * loading->sd / loading->value : 0.0;
  }
  kind.add(c, points);
}

bool of_release(const Observable &o) { return !o.curve.empty() && o.stage == "relaxation"; }

/// Another specimen at a pressure of the bank, read as well as those of the experiment.
Condition at_pressure(double pressure, const std::vector<CoveredCondition> &covered) {
  double relative = 0.0;
  for (const CoveredCondition &c : covered)
    relative += c.condition.max_pressure_MPa->sd / c.pressure / double(covered.size());
  Condition out;
  out.id = out.specimen = fmt::format("{:g} MPa", pressure);
  out.control = "pressure";
  out.max_pressure_MPa = Measured{pressure, relative * pressure};
  return out;
}

} // namespace

std::vector<CoveredCondition> covered_conditions(const Experiment &e, const BankTable &table,
                                                 const std::vector<std::string> &wanted,
                                                 std::vector<std::string> &not_said) {
  const std::vector<double> whole = pressures_learnt(table, true),
                            reached = pressures_learnt(table, false);
  std::vector<CoveredCondition> out;
  for (const Condition &c : e.conditions) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), c.id) == wanted.end())
      continue;
    if (!by_pressure(c)) {
      not_said.push_back(fmt::format("{}: control = \"{}\" is not in the bank, whose runs go to a "
                                     "pressure; the condition is left out.",
                                     c.id, c.control));
      continue;
    }
    const double p = c.max_pressure_MPa->value;
    std::vector<double> runs = beside(p, whole);
    if (runs.empty())
      runs = beside(p, reached);
    if (reached.empty()) {
      not_said.push_back(fmt::format("{}: the bank's table has no runs.", c.id));
      continue;
    }
    if (runs.empty()) {
      not_said.push_back(fmt::format("{}: {:g} MPa lies outside the bank's {:g} to {:g} MPa; the "
                                     "condition is left out. Another bank may reach it (--bank).",
                                     c.id, p, reached.front(), reached.back()));
      continue;
    }
    if (c.dwell_s > 0.0)
      not_said.push_back(fmt::format("{}: the bank's runs do not dwell; its {:g} s at the target "
                                     "are left out.",
                                     c.id, c.dwell_s));
    if (has_images(c))
      not_said.push_back(fmt::format(
          "{}: label images have no part in which effect it is: the bank keeps no frames. Those of "
          "a held-out condition are set beside the models that are run again; calendem compare "
          "sets any beside runs.",
          c.id));
    const Condition known = with_loading(e, c, table, not_said);
    std::vector<Observable> seen = observables_of(e, known, not_said);
    if (!has_release(table) && std::any_of(seen.begin(), seen.end(), of_release)) {
      seen.erase(std::remove_if(seen.begin(), seen.end(), of_release), seen.end());
      not_said.push_back(fmt::format("{}: the bank's table has no displacements on release; the "
                                     "unloading curve is left out.",
                                     c.id));
    }
    out.push_back({known, p, seen, 1, runs});
  }
  return out;
}

std::vector<Further> further_measurements(const Experiment &e, const BankTable &table,
                                          const std::vector<CoveredCondition> &covered) {
  Kind porosity(e, table, "porosity_after"), thickness(e, table, "thickness_at_max"),
      cracked(e, table, "cracked_bodies"), curve(e, table, "loading_curve"),
      release(e, table, kUnloadingCurve);
  for (const CoveredCondition &c : covered) {
    const Condition without = bare(c.condition);
    if (!c.condition.porosity_after_percent && !c.condition.thickness_after_um)
      add_porosity(porosity, without);
    if (!c.condition.thickness_at_max_um)
      add_thickness(thickness, e, without);
    if (!c.condition.cracked_bodies_fraction) {
      Condition counted = without;
      counted.cracked_bodies_fraction =
          cracked.expected(without, [](const SimulatedRun &r) { return r.cracked_fraction; });
      cracked.add(counted);
    }
    if (c.condition.curve.empty())
      add_curve(curve, e, without, Branch::Loading);
    if (has_release(table) && std::none_of(c.observables.begin(), c.observables.end(), of_release))
      add_curve(release, e, without, Branch::Release);
  }
  std::vector<Further> list;
  for (const Kind *kind : {&porosity, &thickness, &cracked, &curve, &release})
    kind->finish(list);
  for (const double p : pressures_learnt(table, true)) {
    Kind other(e, table, "porosity_after");
    if (std::none_of(covered.begin(), covered.end(),
                     [&](const CoveredCondition &c) { return same_pressure(c.pressure, p); }))
      add_porosity(other, at_pressure(p, covered));
    other.finish(list);
  }
  for (Further &f : list)
    for (CoveredCondition &c : f.of) {
      const auto at =
          std::find_if(covered.begin(), covered.end(), [&](const CoveredCondition &had) {
            return had.condition.id == c.condition.id;
          });
      c.runs = at == covered.end() ? std::vector<double>{c.pressure} : at->runs;
    }
  return list;
}

using inference::Matrix;
using inference::Vector;
namespace {

constexpr int kResamples = 1000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Vector squared_error_of_mean(const Matrix &packings) {
  const Eigen::Index n = packings.cols();
  if (n < 2)
    return Vector::Zero(packings.rows());
  const Matrix centred = packings.colwise() - packings.rowwise().mean();
  return centred.rowwise().squaredNorm() / double(n - 1) / double(n);
}

double shrunk(double before, double after) { return before > 0.0 ? 1.0 - after / before : kNaN; }

/// A mean that other packings could have given: normal packings' means are t-distributed about the
/// one found. `weights`: a number for each packing.
Vector mean_of(const Matrix &packings, const Vector &weights) {
  const double n = double(packings.cols());
  const Vector mean = packings.rowwise().mean();
  return mean + (packings.colwise() - mean) * weights / std::sqrt(n * (n - 1.0));
}

/// A resample: its measured values and the weights of its packings.
using OfResample = std::function<double(const HeldOut &, const Vector &)>;

std::vector<double> resampled(const HeldOut &held_out, int packings, const OfResample &value) {
  boost::random::mt19937 random(1);
  boost::random::normal_distribution<double> normal;
  boost::random::chi_squared_distribution<double> square(packings - 1);
  std::vector<double> out;
  for (int k = 0; k < kResamples; ++k) {
    HeldOut again = held_out;
    for (Eigen::Index i = 0; i < again.measured.size(); ++i)
      again.measured[i] += again.sd[i] * normal(random);
    const double spread = std::sqrt((packings - 1) / square(random));
    Vector weights(packings);
    for (double &w : weights)
      w = spread * normal(random);
    out.push_back(value(again, weights));
  }
  return out;
}

} // namespace

void add_sample_scatter(const std::vector<Matrix> &models, double cells, HeldOut &held_out) {
  Vector variance = Vector::Zero(held_out.sd.size());
  for (const Matrix &packings : models)
    variance += squared_error_of_mean(packings) * double(packings.cols()) / double(models.size());
  held_out.sd = (held_out.sd.cwiseAbs2() + variance / cells).cwiseSqrt();
}

double gap_of(const HeldOut &held_out, const Vector &mean, const Vector &scatter, double noises) {
  const Vector variance = held_out.sd.cwiseAbs2();
  const Vector excess = ((mean - held_out.measured).cwiseAbs2() - noises * (variance + scatter))
                            .cwiseQuotient(variance);
  double sum = 0.0;
  for (const inference::Block &b : held_out.blocks)
    sum += excess(b.members).mean();
  return std::sqrt(std::max(0.0, sum / double(held_out.blocks.size())));
}

Estimate interval_of(double value, std::vector<double> draws) {
  draws.erase(std::remove_if(draws.begin(), draws.end(), [](double d) { return std::isnan(d); }),
              draws.end());
  if (draws.empty())
    return {value, kNaN, kNaN};
  std::sort(draws.begin(), draws.end());
  const auto quantile = [&](double share) {
    return draws[std::size_t(std::lround(share * double(draws.size() - 1)))];
  };
  return {value, quantile(0.05), quantile(0.95)};
}

Estimate gap_of_packings(const HeldOut &held_out, const Matrix &simulated) {
  const Vector scatter = squared_error_of_mean(simulated);
  // a resample holds noise and scatter twice: the data's and its own
  const auto again = [&](const HeldOut &h, const Vector &weights) {
    return gap_of(h, mean_of(simulated, weights), scatter, 2.0);
  };
  return interval_of(gap_of(held_out, simulated.rowwise().mean(), scatter),
                     resampled(held_out, int(simulated.cols()), again));
}

double noise_floor(const HeldOut &held_out, const Matrix &simulated) {
  const Vector scatter = squared_error_of_mean(simulated);
  HeldOut without = held_out;
  without.measured = simulated.rowwise().mean();
  const auto again = [&](const HeldOut &h, const Vector &weights) {
    return gap_of(h, mean_of(simulated, weights), scatter);
  };
  return interval_of(0.0, resampled(without, int(simulated.cols()), again)).high90;
}

Estimate shrinkage_of(const HeldOut &held_out, const Matrix &before, const Matrix &after) {
  const Vector scatter_before = squared_error_of_mean(before),
               scatter_after = squared_error_of_mean(after);
  const auto again = [&](const HeldOut &h, const Vector &weights) {
    return shrunk(gap_of(h, mean_of(before, weights), scatter_before, 2.0),
                  gap_of(h, mean_of(after, weights), scatter_after, 2.0));
  };
  const double value = shrunk(gap_of(held_out, before.rowwise().mean(), scatter_before),
                              gap_of(held_out, after.rowwise().mean(), scatter_after));
  return interval_of(value, resampled(held_out, int(before.cols()), again));
}

} // namespace calendem
