// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/error_model.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

using inference::Matrix;
using inference::Vector;

namespace {

constexpr double kSame = 0.02;       // of the pressure
constexpr double kPrior = 4.0;       // values that the stated scatter is worth
constexpr double kDegrees = 4.0;     // of the t distribution of single values
constexpr double kStandsOut = 0.3;   // weight below which a value is reported
constexpr double kTimesStated = 2.0; // scatter over the stated from which on it is reported

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  const std::size_t n = v.size();
  return 0.5 * (v[(n - 1) / 2] + v[n / 2]);
}

bool same(const Observable &a, const Observable &b) {
  return a.stage == b.stage && a.curve == b.curve && a.unit == b.unit &&
         (a.curve.empty() ? a.name == b.name : a.coordinate == b.coordinate);
}

const Observable *find(const CoveredCondition &c, const Observable &like) {
  for (const Observable &o : c.observables)
    if (same(o, like) && std::isfinite(o.measured))
      return &o;
  return nullptr;
}

/// By what specimens may differ in this observable, beside the reading's own error; the bank says
/// what a porosity does to it only later: a point of porosity is about 2 % of a thickness.
double of_specimen(const Experiment &e, const Observable &o) {
  const bool of_porosity = o.per_porosity || o.per_initial_porosity;
  const double porosity = !of_porosity ? 0.0
                          : o.unit == "%"
                              ? e.specimen_porosity_points
                              : 0.02 * e.specimen_porosity_points * std::fabs(o.measured);
  const double thickness =
      o.unit == "um" ? 0.01 * e.specimen_thickness_percent * std::fabs(o.measured) : 0.0;
  return std::hypot(porosity, std::hypot(thickness, o.by_loading));
}

/// The mean of one observable over the specimens that have it.
Observable mean_of(const Experiment &e, const std::vector<CoveredCondition> &group,
                   const Observable &like, std::vector<std::string> &not_said) {
  std::vector<double> values;
  std::vector<std::string> ids;
  double own = 0.0, loading = 0.0, drift = 0.0, zero = 0.0;
  for (const CoveredCondition &c : group)
    if (const Observable *o = find(c, like)) {
      values.push_back(o->measured);
      ids.push_back(c.condition.id);
      own += o->sd * o->sd;
      loading += o->by_loading;
      drift += o->by_drift;
      zero += o->by_zero;
    }
  const double n = double(values.size());
  const double stated = std::hypot(std::sqrt(own / n), of_specimen(e, like));
  const RobustMean mean = robust_mean(values, stated);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (mean.weights[k] < kStandsOut)
      not_said.push_back(fmt::format("{}: {} = {:.4g} stands out from the other specimens' {:.4g} "
                                     "± {:.2g}; it counts {:.2f} of a reading. Look at it again.",
                                     ids[k], like.name, values[k], mean.value, mean.sd,
                                     mean.weights[k]));
  if (mean.sd > kTimesStated * stated)
    not_said.push_back(fmt::format("{}: {} scatters by {:.2g} between specimens, {:.2g} is stated; "
                                   "taken is what they do.",
                                   ids.front(), like.name, mean.sd, stated));
  Observable out = like;
  out.measured = mean.value;
  out.by_loading = loading / n / std::sqrt(mean.count);
  out.by_drift = drift / n / std::sqrt(mean.count);
  out.by_zero = zero / n / std::sqrt(mean.count);
  // what specimens are allowed to differ by is a term of its own; more than that is the reading's
  const double more = mean.sd * mean.sd - stated * stated;
  out.sd = std::sqrt(std::max(own / n, own / n + more) / mean.count);
  return out;
}

CoveredCondition pooled(const Experiment &e, const std::vector<CoveredCondition> &group,
                        std::vector<std::string> &not_said) {
  CoveredCondition out = group.front();
  out.observables.clear();
  out.specimens = int(group.size());
  for (const CoveredCondition &c : group)
    for (const Observable &o : c.observables)
      if (std::none_of(out.observables.begin(), out.observables.end(),
                       [&](const Observable &had) { return same(had, o); }))
        out.observables.push_back(mean_of(e, group, o, not_said));
  return out;
}

} // namespace

RobustMean robust_mean(const std::vector<double> &values, double sd) {
  RobustMean out;
  const double n = double(values.size());
  out.value = median(values);
  std::vector<double> off;
  for (const double v : values)
    off.push_back(std::fabs(v - out.value));
  const double by_median = 1.4826 * median(off);
  out.sd = std::sqrt((kPrior * sd * sd + n * by_median * by_median) / (kPrior + n));
  out.weights.assign(values.size(), 1.0);
  out.count = n;
  if (values.size() < 2 || !(out.sd > 0.0))
    return out;
  for (int pass = 0; pass < 50; ++pass) {
    double sum = 0.0, squares = 0.0;
    out.count = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double z = (values[k] - out.value) / out.sd;
      out.weights[k] = std::min(1.0, (kDegrees + 1.0) / (kDegrees + z * z));
      out.count += out.weights[k];
      sum += out.weights[k] * values[k];
    }
    out.value = sum / out.count;
    for (std::size_t k = 0; k < values.size(); ++k)
      squares += out.weights[k] * std::pow(values[k] - out.value, 2);
    out.sd = std::sqrt((kPrior * sd * sd + squares) / (kPrior + n - 1.0));
  }
  return out;
}

std::vector<CoveredCondition> pooled_repeats(const Experiment &e,
                                             const std::vector<CoveredCondition> &all,
                                             std::vector<std::string> &not_said) {
  std::vector<CoveredCondition> out;
  std::vector<bool> taken(all.size(), false);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (taken[k])
      continue;
    std::vector<CoveredCondition> group;
    std::vector<std::string> ids;
    for (std::size_t j = k; j < all.size(); ++j) {
      const Condition &c = all[j].condition;
      const bool other =
          j == k || (!c.specimen.empty() &&
                     std::none_of(group.begin(), group.end(), [&](const CoveredCondition &g) {
                       return g.condition.specimen == c.specimen;
                     }));
      if (taken[j] || !other || c.pressing != all[k].condition.pressing ||
          std::fabs(all[j].pressure - all[k].pressure) > kSame * all[k].pressure)
        continue;
      taken[j] = true;
      group.push_back(all[j]);
      ids.push_back(c.id);
    }
    out.push_back(group.size() == 1 ? group.front() : pooled(e, group, not_said));
    if (group.size() > 1)
      not_said.push_back(fmt::format("{} are {} specimens pressed alike: their means are compared.",
                                     fmt::join(ids, ", "), group.size()));
  }
  return out;
}

namespace {

/// One number for each observable of each condition.
template <class Value> Vector each(const std::vector<CoveredCondition> &all, const Value &value) {
  std::vector<double> out;
  for (const CoveredCondition &c : all)
    for (const Observable &o : c.observables)
      out.push_back(value(c, o));
  return Eigen::Map<Vector>(out.data(), Eigen::Index(out.size()));
}

/// A column for each specimen; conditions without one share none.
Matrix by_specimen(const std::vector<CoveredCondition> &all, const Vector &size) {
  std::vector<std::string> specimens;
  std::vector<std::size_t> of;
  for (const CoveredCondition &c : all) {
    const std::string &name = c.condition.specimen.empty() ? c.condition.id : c.condition.specimen;
    const auto at = std::find(specimens.begin(), specimens.end(), name);
    of.insert(of.end(), c.observables.size(), std::size_t(at - specimens.begin()));
    if (at == specimens.end())
      specimens.push_back(name);
  }
  Matrix columns = Matrix::Zero(size.size(), Eigen::Index(specimens.size()));
  for (Eigen::Index k = 0; k < size.size(); ++k)
    columns(k, Eigen::Index(of[std::size_t(k)])) = size[k];
  return columns;
}

/// Three errors of each condition between two of the bank's runs: of what is seen after release, of
/// thicknesses under load, of the share of cracked particles.
Matrix by_interpolation(const std::vector<CoveredCondition> &all, const Vector &density) {
  Matrix columns = Matrix::Zero(density.size(), 3 * Eigen::Index(all.size()));
  Eigen::Index row = 0, column = 0;
  for (const CoveredCondition &c : all) {
    BetweenRuns by;
    if (!c.runs.empty() && c.runs.front() < c.runs.back())
      by = error_between_runs(c.runs.front(), c.runs.back(), c.pressure);
    for (const Observable &o : c.observables) {
      if (o.name == "cracked bodies")
        columns(row, column) = by.cracked;
      else if (o.stage == "relaxation")
        columns(row, column + 1) = by.porosity_after * density[row];
      else if (o.stage != kBefore && o.curve.empty()) // a loading is that of the longer run
        columns(row, column + 2) = by.porosity_at_max * density[row];
      ++row;
    }
    column += 3;
  }
  return columns;
}

/// Mean over the repeats that a condition stands for.
double shared(const CoveredCondition &c) { return 1.0 / std::sqrt(double(c.specimens)); }

} // namespace

std::vector<ErrorTerm> error_terms(const Experiment &e, const BankSpec &bank,
                                   const std::vector<CoveredCondition> &all,
                                   const std::vector<PointRuns> &points) {
  const auto of_base = [&](auto what) { // mean change per unit
    return mean_of_base(all, points,
                        [what](const Observable &o) -> const Derivative & { return o.*what; });
  };
  const Vector density = of_base(&Observable::per_porosity),
               start = of_base(&Observable::per_initial_porosity);
  const Vector few = each(all, [](const auto &c, const auto &) { return shared(c); });
  const double points_of_porosity = 0.01 * e.specimen_porosity_points;
  std::vector<ErrorTerm> terms;
  const auto add = [&](const std::string &name, const Matrix &columns) {
    if (columns.size() > 0 && (columns.array().abs() > 0.0).any())
      terms.push_back({name, columns});
  };
  add(kPressureOfThePress, by_pressure(all, points));
  add("loading of the specimen",
      by_specimen(all, each(all, [](const auto &, const auto &o) { return o.by_loading; })));
  add("initial porosity of the specimen",
      by_specimen(all, points_of_porosity * few.cwiseProduct(start)));
  add("porosity of the specimen under pressure",
      by_specimen(all, points_of_porosity * few.cwiseProduct(density)));
  const Vector usual = of_base(&Observable::simulated), // not as measured: errors know no value
      in_um = each(all, [](const auto &, const auto &o) { return o.unit == "um" ? 1.0 : 0.0; });
  add("thickness of the specimen",
      by_specimen(all, 0.01 * e.specimen_thickness_percent *
                           few.cwiseProduct(usual.cwiseProduct(in_um))));
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const auto &[name, size] : {std::pair("first touch of ", &Observable::by_zero),
                                     std::pair("drift of the curve of ", &Observable::by_drift)}) {
      const auto by = size;
      add(name + all[k].condition.id, each(all, [&, by](const auto &c, const auto &o) {
            return &c == &all[k] && !o.curve.empty() ? o.*by : 0.0;
          }));
    }
  add("numerics: between the bank's pressures", by_interpolation(all, density));
  if (e.on_press)
    for (const Numerics &n : bank.numerics)
      add("numerics: " + n.name, 0.01 * n.porosity_points * density);
  return terms;
}

Matrix covariance_of(const std::vector<ErrorTerm> &terms, Eigen::Index observables) {
  Matrix sum = Matrix::Zero(observables, observables);
  for (const ErrorTerm &t : terms)
    sum += t.columns * t.columns.transpose();
  return sum;
}

} // namespace calendem
