// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/sizes.h"
#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace calendem {
namespace {

double sphere_volume(double d) { return 3.14159265358979323846 / 6.0 * d * d * d; }

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// Quantile of a truncated lognormal law with ln-mean mu, by bisection.
double truncated_quantile(double q, double mu, double sigma, double low, double high) {
  const double a = normal_cdf((std::log(low) - mu) / sigma);
  const double b = normal_cdf((std::log(high) - mu) / sigma);
  const double wanted = a + q * (b - a);
  double lo = std::log(low), hi = std::log(high);
  for (int i = 0; i < 80; ++i) {
    const double mid = 0.5 * (lo + hi);
    (normal_cdf((mid - mu) / sigma) < wanted ? lo : hi) = mid;
  }
  return std::exp(0.5 * (lo + hi));
}

// n quantiles in equal steps of number.
std::vector<double> stratified(const Quantile &law, int n, double offset) {
  std::vector<double> d;
  for (int k = 0; k < n; ++k)
    d.push_back(law((k + offset) / n));
  return d;
}

double total_volume(const std::vector<double> &d) {
  return std::accumulate(d.begin(), d.end(), 0.0,
                         [](double sum, double x) { return sum + sphere_volume(x); });
}

} // namespace

double SizeLaw::quantile(double q) const {
  return truncated_quantile(q, std::log(median), sigma_ln, low, high);
}

double SizeLaw::volume_quantile(double q) const {
  return truncated_quantile(q, std::log(median) + 3.0 * sigma_ln * sigma_ln, sigma_ln, low, high);
}

double SizeLaw::volume_above(double limit) const {
  if (limit >= high)
    return 0.0;
  const double mu = std::log(median) + 3.0 * sigma_ln * sigma_ln;
  const auto F = [&](double d) { return normal_cdf((std::log(d) - mu) / sigma_ln); };
  return (F(high) - F(std::max(limit, low))) / (F(high) - F(low));
}

SizeLaw measured_law(const Recipe &r) {
  return {r.median, r.sigma_ln, r.min_diameter, r.max_diameter};
}

std::vector<double> draw_diameters(const Recipe &recipe, double volume, Random &random) {
  SizeLaw law = measured_law(recipe);
  law.high = recipe.largest_body();
  if (law.high <= law.low)
    throw Failure(kBadInput, fmt::format("no secondary particle fits a cell of {} x {} um: the "
                                         "smallest is {} um, the largest allowed {:.2f} um. Make "
                                         "the cell larger",
                                         recipe.cell_x, recipe.cell_y, law.low, law.high));
  return draw_diameters([&](double q) { return law.quantile(q); }, volume, random);
}

std::vector<double> draw_diameters(const Quantile &law, double volume, Random &random) {
  const int fine = 2000;
  const int guess = static_cast<int>(volume / (total_volume(stratified(law, fine, 0.5)) / fine));
  const double offset = random.uniform();
  std::vector<double> best;
  double best_error = HUGE_VAL;
  for (int n = std::max(1, guess * 9 / 10); n <= guess * 11 / 10 + 2; ++n) {
    std::vector<double> d = stratified(law, n, offset);
    const double error = std::fabs(total_volume(d) - volume);
    if (error < best_error) {
      best_error = error;
      best = std::move(d);
    }
  }
  std::sort(best.rbegin(), best.rend());
  return best;
}

std::vector<int> primary_counts(const std::vector<double> &diameters, double lattice, int total) {
  const double scale = total * std::pow(lattice, 3) / total_volume(diameters);
  std::vector<int> counts;
  double carried = 0.0;
  for (double d : diameters) {
    const double wanted = sphere_volume(d) / std::pow(lattice, 3) * scale + carried;
    counts.push_back(std::max(1, static_cast<int>(std::lround(wanted))));
    carried = wanted - counts.back();
  }
  // Where small bodies became one whole primary, there are too many: the largest give theirs, then
  // bodies of one are left out.
  int excess = std::accumulate(counts.begin(), counts.end(), 0) - total;
  for (; excess > 0; --excess) {
    const auto largest = std::max_element(counts.begin(), counts.end());
    if (*largest > 1)
      --*largest;
    else
      counts.pop_back();
  }
  counts.front() -= excess;
  return counts;
}

} // namespace calendem
