// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/particle_sizes.h"
#include "base/normal_law.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr double kAgree = 0.10;
constexpr double kMostBeyond = 0.2; // of the volume, beyond particles.max_um
constexpr double kNormal90 = 1.2815515655446004;
const char *const kMedian = "particles.median_um", *const kSigma = "particles.sigma_ln",
                  *const kLargest = "particles.max_um";

struct Percentile {
  std::string key;
  double z; ///< of the normal law
  double ln;
};

std::vector<Percentile> percentiles_of(const Settings &s) {
  std::vector<Percentile> out;
  const double z[] = {-kNormal90, 0.0, kNormal90};
  const std::vector<Key> keys = volume_percentile_keys();
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (s.sound({keys[k].name}) && s.number(keys[k].name) > 0.0)
      out.push_back({keys[k].name, z[k], std::log(s.number(keys[k].name))});
  return out;
}

/// ln D50 by volume and sigma that are nearest to them; of one, beside `sigma`.
struct Law {
  double ln_median, sigma;
};

Law law_of(const std::vector<Percentile> &p, double sigma) {
  double z = 0.0, ln = 0.0, zz = 0.0, zl = 0.0;
  for (const Percentile &x : p) {
    z += x.z / double(p.size());
    ln += x.ln / double(p.size());
  }
  for (const Percentile &x : p) {
    zz += (x.z - z) * (x.z - z);
    zl += (x.z - z) * (x.ln - ln);
  }
  const double slope = p.size() > 1 ? zl / zz : sigma;
  return {ln - slope * z, slope};
}

/// What the percentiles are, with other keys or each other, in words; empty: nothing is wrong.
std::string contradiction(const Settings &s, const std::vector<Percentile> &p, const Law &law) {
  if (s.line(kMedian) > 0)
    return fmt::format("gives the powder by volume, and {} = {} by number. Give one of them.",
                       kMedian, s.text(kMedian));
  if (p.size() > 1 && s.line(kSigma) > 0)
    return fmt::format("fixes the width together with {}, and {} = {} gives it again. Leave one of "
                       "them out.",
                       p.front().key, kSigma, s.text(kSigma));
  if (law.sigma <= 0.0)
    return "is not above the lower percentile. D10 < D50 < D90 is meant, in um by volume.";
  for (const Percentile &x : p)
    if (const double fitted = law.ln_median + law.sigma * x.z;
        std::fabs(x.ln - fitted) > std::log1p(kAgree))
      return fmt::format("does not lie on one lognormal law with the others: {} is {:g} um, the "
                         "nearest law has {:.3g} um, at most {:.0f} % are allowed. Leave out the "
                         "one that matters least.",
                         x.key, std::exp(x.ln), std::exp(fitted), 100.0 * kAgree);
  return "";
}

// Quantile of a truncated lognormal law with ln-mean mu, by bisection.
double truncated_quantile(double q, double mu, double sigma, double low, double high) {
  const double a = normal_cdf((std::log(low) - mu) / sigma);
  const double b = normal_cdf((std::log(high) - mu) / sigma);
  if (!(b - a > 1e-12)) // the law lies beyond one of the limits
    return mu > std::log(low) ? high : low;
  const double wanted = a + q * (b - a);
  double lo = std::log(low), hi = std::log(high);
  for (int i = 0; i < 80; ++i) {
    const double mid = 0.5 * (lo + hi);
    (normal_cdf((mid - mu) / sigma) < wanted ? lo : hi) = mid;
  }
  return std::exp(0.5 * (lo + hi));
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

std::vector<Key> volume_percentile_keys() {
  std::vector<Key> out;
  for (const int percent : {10, 50, 90})
    out.push_back(setting(fmt::format("particles.d{}_volume_um", percent), "", "0")
                      .range(0, 200, "um")
                      .means(fmt::format("D{} by volume; two of D10, D50, D90, or one beside "
                                         "sigma_ln, in place of median_um; 0: not given",
                                         percent)));
  return out;
}

std::vector<Key> with_volume_percentiles(std::vector<Key> keys) {
  const auto width =
      std::find_if(keys.begin(), keys.end(), [](const Key &k) { return k.name == kSigma; });
  const std::vector<Key> percentiles = volume_percentile_keys();
  keys.insert(width + 1, percentiles.begin(), percentiles.end());
  return keys;
}

void take_sizes_by_volume(Settings &s, const std::vector<Key> &keys, Mistakes &mistakes) {
  const std::vector<Percentile> given = percentiles_of(s);
  if (given.empty() || !s.sound({kMedian, kSigma, kLargest}))
    return;
  const Law law = law_of(given, s.number(kSigma));
  const std::string &last = given.back().key;
  const double median = std::exp(law.ln_median - 3.0 * law.sigma * law.sigma);
  std::string wrong = contradiction(s, given, law);
  for (const auto &[key, value] : {std::pair(kSigma, law.sigma), std::pair(kMedian, median)})
    if (const auto out_of_range = wrong_number(*find_key(keys, key), value);
        wrong.empty() && out_of_range)
      wrong = "gives a law that is not allowed: " +
              out_of_range->substr(0, out_of_range->find(" It looks"));
  const double z = (std::log(s.number(kLargest)) - law.ln_median) / law.sigma,
               beyond = normal_cdf(-z);
  if (wrong.empty() && beyond > kMostBeyond)
    wrong = fmt::format("gives a powder {:.0f} % of whose volume lies above {} = {} um; at most "
                        "{:.0f} % are left out without a word. Give a larger {}: its D90 is {:.3g} "
                        "um.",
                        100.0 * beyond, kLargest, s.text(kLargest), 100.0 * kMostBeyond, kLargest,
                        std::exp(law.ln_median + kNormal90 * law.sigma));
  if (!wrong.empty())
    return mistakes.add(s.line(last), "{} = {} {}", last, s.text(last), wrong);
  s.set(kMedian, fmt::format("{:.6g}", median));
  s.set(kSigma, fmt::format("{:.6g}", law.sigma));
  for (const Percentile &p : given)
    s.set(p.key, "0");
}

std::string sizes_in_words(const Recipe &r) {
  if (r.structure.given() || (r.shapes.given() && r.shapes.measured_sizes))
    return "";
  return fmt::format("particles: median {:.3g} um by number, D50 {:.3g} um by volume (lognormal, "
                     "sigma_ln {:.3g})",
                     r.median, r.median * std::exp(3.0 * r.sigma_ln * r.sigma_ln), r.sigma_ln);
}

} // namespace calendem
