// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/curve.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace calendem {

namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
} // namespace

std::size_t Curve::row_of_max_pressure() const {
  const Column &pressure = (*this)["pressure_MPa"];
  return static_cast<std::size_t>(std::max_element(pressure.begin(), pressure.end()) -
                                  pressure.begin());
}

std::vector<std::size_t> Curve::compression() const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < rows(); ++i)
    if (stage[i] != "relaxation")
      found.push_back(i);
  return found;
}

std::vector<std::size_t> Curve::relaxation() const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < rows(); ++i)
    if (stage[i] == "relaxation") {
      if (found.empty() && i > 0)
        found.push_back(i - 1); // the turning point belongs to both branches
      found.push_back(i);
    }
  return found;
}

double at_first_crossing(const Curve &curve, double pressure_MPa, const std::string &name) {
  if (!curve.has(name))
    return kNaN;
  const Column &p = curve["pressure_MPa"];
  const Column &v = curve[name];
  const auto rows = curve.compression();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t i = rows[k];
    if (p[i] < pressure_MPa)
      continue;
    if (k == 0 || p[i] == p[rows[k - 1]])
      return v[i];
    const std::size_t before = rows[k - 1];
    const double share = (pressure_MPa - p[before]) / (p[i] - p[before]);
    return v[before] + share * (v[i] - v[before]);
  }
  return kNaN;
}

Column imbalance(const Curve &curve) {
  if (curve.has("pressure_difference"))
    return curve["pressure_difference"];
  Column out;
  for (std::size_t i = 0; i < curve.rows(); ++i)
    out.push_back(std::abs(curve["pressure_MPa"][i] - curve["pressure_bottom_MPa"][i]) /
                  curve["pressure_MPa"][i]);
  return out;
}

double worst_imbalance(const Curve &curve, double threshold_MPa) {
  const Column difference = imbalance(curve);
  double worst = kNaN;
  for (std::size_t i = 0; i < curve.rows(); ++i)
    if (curve["pressure_MPa"][i] > threshold_MPa)
      worst = std::fmax(worst, difference[i]);
  return worst;
}

Column picked(const Column &values, const std::vector<std::size_t> &rows, double factor) {
  Column out;
  for (const std::size_t i : rows)
    out.push_back(values[i] * factor);
  return out;
}

} // namespace calendem
