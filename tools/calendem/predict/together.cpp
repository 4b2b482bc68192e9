// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/together.h"
#include <algorithm>
#include <cmath>

namespace calendem {
namespace {

constexpr double kLeast = 0.001; // springback, 0-1: an emulator may be below 0

double under_load(const Response &r) { return 1.0 - (1.0 - r.porosity) * (1.0 + r.springback); }

double springback_of(double alone, const std::vector<Response> &changes) {
  const double base = std::max(kLeast, alone);
  double strongest = 1.0, others = 1.0, rises = 0.0;
  for (const Response &c : changes) {
    const double left = std::max(kLeast, alone + c.springback) / base;
    others *= std::min(1.0, left);
    strongest = std::min(strongest, left);
    rises += std::max(0.0, c.springback);
  }
  return base * strongest * std::pow(others / strongest, kOthers) + rises;
}

double load_of(const Response &base, const std::vector<Response> &changes) {
  double fall = 0.0, rises = 0.0;
  for (const Response &c : changes) {
    const double change =
        under_load({base.porosity + c.porosity, base.springback + c.springback}) - under_load(base);
    fall = std::min(fall, change);
    rises += std::max(0.0, change);
  }
  return under_load(base) + fall + rises;
}

} // namespace

Response beyond_sum(const Response &base, const std::vector<Response> &changes) {
  Response sum = base;
  for (const Response &c : changes) {
    sum.porosity += c.porosity;
    sum.springback += c.springback;
  }
  const double springback = springback_of(base.springback, changes);
  const double porosity = 1.0 - (1.0 - load_of(base, changes)) / (1.0 + springback);
  return {porosity - sum.porosity, springback - sum.springback};
}

} // namespace calendem
