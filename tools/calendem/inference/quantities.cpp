// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/quantities.h"
#include "base/messages.h"
#include "base/normal_law.h"
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace calendem::inference {

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

namespace {

const boost::math::normal kStandardNormal;
constexpr double kOutermost = 1e-12; // probability beyond which a bounded parameter is its bound

} // namespace

double Prior::value(double score) const {
  if (kind == normal)
    return a + b * score;
  const double share = normal_cdf(score);
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

double Parameter::input(double value) const {
  return power == 1.0 ? prior.scaled(value) : 2.0 * strength(value) - 1.0;
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

CredibleRange credible_range(const std::vector<double> &values,
                             const std::vector<double> &weights) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  const auto at = [&](double share) {
    double passed = 0.0;
    for (const std::size_t k : order)
      if ((passed += weights[k]) >= share * total)
        return values[k];
    return std::nan("");
  };
  return {at(0.5), at(0.05), at(0.95)};
}

} // namespace calendem::inference
