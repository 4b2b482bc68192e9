// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/error_terms.h"
#include <algorithm>
#include <cmath>

namespace calendem {
using inference::Matrix;
using inference::Vector;
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
    if (columns.size() > 0 && columns.cwiseAbs().maxCoeff() > 0.0)
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
    add("drift of the curve of " + all[k].condition.id,
        each(all, [&](const auto &c, const auto &o) {
          return &c == &all[k] && !o.curve.empty() ? o.by_drift : 0.0;
        }));
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
