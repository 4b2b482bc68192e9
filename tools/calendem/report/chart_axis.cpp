// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/chart_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace calendem::report {

void Range::include(double value) {
  if (!std::isfinite(value))
    return;
  low = any ? std::min(low, value) : value;
  high = any ? std::max(high, value) : value;
  any = true;
}

Axis axis_for(double low, double high, int count) {
  if (!(high > low))
    high = low + std::max(std::abs(low) * 0.1, 1.0);
  const double raw = (high - low) / std::max(count, 1);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  constexpr double kSlack = 1e-6; // a value on a tick does not open the next interval
  return {std::floor(low / step + kSlack) * step, std::ceil(high / step - kSlack) * step, step};
}

std::vector<double> Axis::ticks() const {
  std::vector<double> values;
  const int count = static_cast<int>(std::lround((high - low) / step));
  for (int i = 0; i <= count; ++i)
    values.push_back(low + i * step);
  return values;
}

std::string Axis::label(double tick) const {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  if (std::abs(tick) < step * 1e-6)
    tick = 0; // no "-0"
  char text[48];
  if (step >= 1e6)
    std::snprintf(text, sizeof text, "%.3g", tick);
  else
    std::snprintf(text, sizeof text, "%.*f", decimals, tick);
  return text;
}

double Axis::place(double value, double begin, double end) const {
  return begin + (value - low) / (high - low) * (end - begin);
}

} // namespace calendem::report
