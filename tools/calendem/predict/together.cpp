// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/together.h"
#include <algorithm>

namespace calendem {
namespace {

constexpr double kLeast = 0.001; // springback, 0-1: an emulator may be below 0

double under_load(const Response &r) { return 1.0 - (1.0 - r.porosity) * (1.0 + r.springback); }

double product_of(const Response &base, const std::vector<Response> &changes) {
  const double alone = std::max(kLeast, base.springback);
  double out = alone;
  for (const Response &c : changes)
    out *= std::max(kLeast, base.springback + c.springback) / alone;
  return out;
}

} // namespace

double springback_beyond_sum(const Response &base, const std::vector<Response> &changes) {
  double sum = base.springback;
  for (const Response &c : changes)
    sum += c.springback;
  return product_of(base, changes) - sum;
}

double porosity_beyond_sum(const Response &base, const std::vector<Response> &changes) {
  double load = under_load(base), sum = base.porosity;
  for (const Response &c : changes) {
    load +=
        under_load({base.porosity + c.porosity, base.springback + c.springback}) - under_load(base);
    sum += c.porosity;
  }
  return 1.0 - (1.0 - load) / (1.0 + product_of(base, changes)) - sum;
}

} // namespace calendem
