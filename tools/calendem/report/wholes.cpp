// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/wholes.h"

#include <cmath>

namespace calendem::report {
namespace {

constexpr double kTurn = 6.283185307179586;

} // namespace

std::array<double, 2> period_of(const Run &run) {
  const nlohmann::json cell = run.electrode.value("cell_um", nlohmann::json());
  if (cell.is_array() && cell.size() == 2 && cell[0].is_number() && cell[1].is_number())
    return {cell[0], cell[1]};
  return {0.0, 0.0};
}

Wholes::Wholes(const ParticleFrame &frame, const std::array<double, 2> &period) : period_(period) {
  if (!(period[0] > 0.0 && period[1] > 0.0))
    return;
  std::map<int, std::array<double, 4>> sums; // cosines and sines of x and y as angles
  for (std::size_t i = 0; i < frame.centre.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      const double angle = kTurn * frame.centre[i][k] / period_[k];
      sums[frame.body[i]][k] += std::cos(angle);
      sums[frame.body[i]][2 + k] += std::sin(angle);
    }
  for (const auto &[body, s] : sums)
    for (int k = 0; k < 2; ++k)
      centre_[body][k] = period_[k] / kTurn * std::atan2(s[2 + k], s[k]);
}

Point Wholes::place(Point p, int body) const {
  const auto found = centre_.find(body);
  if (body <= 0 || found == centre_.end())
    return p;
  for (int k = 0; k < 2; ++k) { // the centre in the cell, the point at its nearest image
    const double c = found->second[k] - period_[k] * std::floor(found->second[k] / period_[k]);
    p[k] -= period_[k] * std::round((p[k] - c) / period_[k]);
  }
  return p;
}

} // namespace calendem::report
