// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/distance.h"
#include <algorithm>
#include <cmath>

namespace calendem {
namespace {

constexpr double kFar = 1e12; // squared, in cells: no seed on the line

// Lower envelope of the parabolas f[q] + (p - q)^2 at p = 0..n-1.
void transform_line(std::vector<double> &f) {
  const int n = static_cast<int>(f.size());
  std::vector<int> vertex(n);
  std::vector<double> from(n + 1), out(n);
  int last = 0;
  from[0] = -HUGE_VAL;
  from[1] = HUGE_VAL;
  const auto crossing = [&](int q, int p) {
    return ((f[q] + double(q) * q) - (f[p] + double(p) * p)) / (2.0 * (q - p));
  };
  for (int q = 1; q < n; ++q) {
    while (last > 0 && crossing(q, vertex[last]) <= from[last])
      --last;
    const double at = crossing(q, vertex[last]);
    if (at > from[last]) {
      ++last;
      vertex[last] = q;
      from[last] = at;
      from[last + 1] = HUGE_VAL;
    }
  }
  for (int p = 0, k = 0; p < n; ++p) {
    while (from[k + 1] < p)
      ++k;
    out[p] = f[vertex[k]] + double(p - vertex[k]) * (p - vertex[k]);
  }
  f = std::move(out);
}

// Squared distance in cells to the nearest cell with inside == value.
std::vector<double> squared_distance(const std::vector<char> &inside, const std::array<int, 3> &n,
                                     char value) {
  std::vector<double> d(inside.size());
  std::transform(inside.begin(), inside.end(), d.begin(),
                 [&](char v) { return v == value ? 0.0 : kFar; });
  const size_t step[3] = {1, size_t(n[0]), size_t(n[0]) * n[1]};
  std::vector<double> line;
  for (int axis = 0; axis < 3; ++axis) {
    line.resize(n[axis]);
    for (size_t v = 0; v < d.size(); ++v) {
      if (v / step[axis] % n[axis] != 0)
        continue;
      for (int p = 0; p < n[axis]; ++p)
        line[p] = d[v + p * step[axis]];
      transform_line(line);
      for (int p = 0; p < n[axis]; ++p)
        d[v + p * step[axis]] = line[p];
    }
  }
  return d;
}

} // namespace

std::vector<float> signed_distance(const std::vector<char> &inside, const std::array<int, 3> &n,
                                   double cell) {
  const std::vector<double> to_inside = squared_distance(inside, n, 1);
  const std::vector<double> to_outside = squared_distance(inside, n, 0);
  std::vector<float> out(inside.size());
  for (size_t v = 0; v < out.size(); ++v)
    out[v] = static_cast<float>(
        cell * (inside[v] ? 0.5 - std::sqrt(to_outside[v]) : std::sqrt(to_inside[v]) - 0.5));
  return out;
}

} // namespace calendem
