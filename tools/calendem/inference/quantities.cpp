// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/quantities.h"
#include "base/messages.h"
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem::inference {

std::string key_of(const ObservableId &o) {
  return fmt::format("{}|{}|{}|{:.6g}", o.name, o.stage, o.condition, o.coordinate);
}

std::vector<Block> blocks_of(const std::vector<ObservableId> &all) {
  std::vector<Block> blocks;
  for (int i = 0; i < int(all.size()); ++i) {
    const ObservableId &o = all[i];
    auto at = blocks.begin();
    while (at != blocks.end() &&
           !(at->name == o.name && at->stage == o.stage && at->condition == o.condition))
      ++at;
    if (at == blocks.end())
      at = blocks.insert(at, {o.name, o.stage, o.condition, {}});
    at->members.push_back(i);
  }
  return blocks;
}

std::vector<int> places_in(const std::vector<ObservableId> &all,
                           const std::vector<ObservableId> &wanted) {
  std::map<std::string, int> place;
  for (int i = 0; i < int(all.size()); ++i)
    place.emplace(key_of(all[i]), i);
  std::vector<int> places;
  std::string missing;
  for (const ObservableId &o : wanted) {
    const auto at = place.find(key_of(o));
    if (at == place.end())
      missing += "\n  " + key_of(o);
    else
      places.push_back(at->second);
  }
  if (!missing.empty())
    throw Failure(kBadInput, "the bank of simulations lacks observables of the experiment. Make "
                             "it again with them, or leave them out:" +
                                 missing);
  return places;
}

void check(const ObservableVector &e) {
  const auto n = Eigen::Index(e.of.size());
  if (n == 0 || e.values.size() != n || e.covariance.rows() != n || e.covariance.cols() != n)
    throw Failure(kBadInput,
                  fmt::format("{} observables with {} values and a covariance of {} x {}: give at "
                              "least one, and as many values and rows",
                              n, e.values.size(), e.covariance.rows(), e.covariance.cols()));
  for (Eigen::Index i = 0; i < n; ++i)
    if (!std::isfinite(e.values[i]) || !(e.covariance(i, i) > 0.0))
      throw Failure(kBadInput, fmt::format("{}: value {:g}, variance {:g}; a number and a variance "
                                           "above 0 are needed. Leave out what was not measured",
                                           key_of(e.of[i]), e.values[i], e.covariance(i, i)));
  const bool symmetric = e.covariance.isApprox(e.covariance.transpose(), 1e-10);
  if (!symmetric || Cholesky(e.covariance).info() != Eigen::Success)
    throw Failure(kBadInput, "the covariance of the measurement is not symmetric and positive "
                             "definite: no correlation may reach 1");
}

namespace {

const boost::math::normal kStandardNormal;
constexpr double kOutermost = 1e-12; // probability beyond which a bounded parameter is its bound

} // namespace

double Prior::value(double score) const {
  if (kind == normal)
    return a + b * score;
  const double share = 0.5 * std::erfc(-score / std::sqrt(2.0));
  return kind == uniform ? a + (b - a) * share : a * std::pow(b / a, share);
}

double Prior::score(double value) const {
  if (kind == normal)
    return (value - a) / b;
  const double share = 0.5 * (scaled(value) + 1.0);
  return quantile(kStandardNormal, std::clamp(share, kOutermost, 1.0 - kOutermost));
}

double Prior::scaled(double value) const {
  if (kind == normal)
    return (value - a) / (2.0 * b);
  const double share =
      kind == uniform ? (value - a) / (b - a) : std::log(value / a) / std::log(b / a);
  return 2.0 * share - 1.0;
}

double Prior::value_slope(double score) const {
  if (kind == normal)
    return b;
  return pdf(kStandardNormal, score) * (kind == uniform ? b - a : value(score) * std::log(b / a));
}

double Prior::scaled_slope(double score) const {
  return kind == normal ? 0.5 : 2.0 * pdf(kStandardNormal, score);
}

double Prior::density(double value) const {
  if (kind == normal)
    return pdf(kStandardNormal, (value - a) / b) / b;
  return kind == uniform ? 1.0 / (b - a) : 1.0 / (std::clamp(value, a, b) * std::log(b / a));
}

double Prior::upper() const { return kind == normal ? a + 2.0 * b : b; }

double Parameter::strength(double value) const {
  if (power == 1.0)
    return value / prior.upper();
  return power > 0.0 ? std::pow(value / prior.upper(), power)
                     : std::log(value / nothing) / std::log(prior.upper() / nothing);
}

double Parameter::strength_slope(double value) const {
  return power > 0.0 ? power * std::pow(value / prior.upper(), power - 1.0) / prior.upper()
                     : 1.0 / (value * std::log(prior.upper() / nothing));
}

double Parameter::input(double value) const {
  return power == 1.0 ? prior.scaled(value) : 2.0 * strength(value) - 1.0;
}

double Parameter::input_slope(double score) const {
  return power == 1.0 ? prior.scaled_slope(score)
                      : 2.0 * strength_slope(prior.value(score)) * prior.value_slope(score);
}

void check(const Parameter &p) {
  const bool spread = p.prior.kind == Prior::normal ? p.prior.b > 0.0 : p.prior.b > p.prior.a;
  if (!std::isfinite(p.prior.a) || !std::isfinite(p.prior.b) || !spread ||
      (p.prior.kind == Prior::log_uniform && p.prior.a <= 0.0))
    throw Failure(
        kBadInput,
        fmt::format("{}: prior ({:g}, {:g}); a normal one needs a standard deviation above "
                    "0, a uniform one an upper bound above the lower, a log-uniform one "
                    "bounds above 0",
                    p.name, p.prior.a, p.prior.b));
  if (p.power == 0.0 && !(p.nothing > 0.0 && p.nothing < p.prior.upper()))
    throw Failure(kBadInput, fmt::format("{}: ceases at {:g}; that must be between 0 and the upper "
                                         "end of its prior, {:g}",
                                         p.name, p.nothing, p.prior.upper()));
  if (p.amplitude && !(p.prior.upper() > 0.0))
    throw Failure(kBadInput, fmt::format("{}: an amplitude that reaches {:g}; it must go above 0",
                                         p.name, p.prior.upper()));
}

} // namespace calendem::inference
