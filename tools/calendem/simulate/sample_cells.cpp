// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/sample.h"
#include <algorithm>
#include <limits>

namespace calendem {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Linear between points of rising x; `below` before the first, the last y beyond the last.
double value_at(const std::vector<double> &x, const std::vector<double> &y, double at,
                double below) {
  const auto next = std::lower_bound(x.begin(), x.end(), at);
  if (next == x.end())
    return y.back();
  const std::size_t k = std::size_t(next - x.begin());
  if (x[k] == at)
    return y[k];
  return k == 0 ? below : y[k - 1] + (y[k] - y[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]);
}

std::vector<double> turned(std::vector<double> v) {
  std::reverse(v.begin(), v.end());
  return v;
}

/// A path as gaps against rising pressure: where each is met for the first time.
struct GapOfPressure {
  std::vector<double> pressure, gap;

  GapOfPressure(const std::vector<double> &p, const std::vector<double> &h) {
    for (std::size_t k = 0; k < p.size(); ++k)
      if (pressure.empty() || p[k] > pressure.back()) {
        pressure.push_back(p[k]);
        gap.push_back(h[k]);
      }
  }
  double at(double p) const { return value_at(pressure, gap, p, gap.front()); }
};

/// Down, a cell bears nothing before its first point; up, nothing after its last.
double pressure_down(const PressedCell &c, double gap) {
  return gap > c.down.gap.front()
             ? 0.0
             : value_at(turned(c.down.gap), turned(c.down.pressure), gap, c.down.pressure.back());
}
double pressure_up(const PressedCell &c, double gap) {
  return gap > c.up.gap.back() ? 0.0
                               : value_at(c.up.gap, c.up.pressure, gap, c.up.pressure.front());
}

template <class Cells, class Value> double mean(const Cells &cells, Value value) {
  double sum = 0.0;
  for (const auto &c : cells)
    sum += value(c);
  return sum / double(cells.size());
}

template <class Value> double largest(const std::vector<PressedCell> &cells, Value value) {
  double out = -kEndless;
  for (const PressedCell &c : cells)
    out = std::max(out, value(c));
  return out;
}

/// The different ones from `low` to `high`, rising.
std::vector<double> between(std::vector<double> v, double low, double high) {
  v.erase(std::remove_if(v.begin(), v.end(), [&](double x) { return x < low || x > high; }),
          v.end());
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
  return v;
}

} // namespace

PressPath monotone(const PressPath &path, bool rises) {
  PressPath out;
  for (std::size_t k = 0; k < path.gap.size(); ++k)
    if (out.gap.empty() || (rises ? path.gap[k] > out.gap.back() : path.gap[k] < out.gap.back())) {
      out.gap.push_back(path.gap[k]);
      out.pressure.push_back(path.pressure[k]);
    }
  return out;
}

std::vector<SampleRow> under_one_gap(const std::vector<PressedCell> &cells) {
  const double turn = largest(cells, [](const PressedCell &c) { return c.down.gap.back(); });
  std::vector<double> down, up;
  for (const PressedCell &c : cells) {
    down.push_back(c.thickness);
    down.insert(down.end(), c.down.gap.begin(), c.down.gap.end());
    up.insert(up.end(), c.up.gap.begin(), c.up.gap.end());
  }
  std::vector<SampleRow> out;
  for (const double gap : turned(between(down, turn, kEndless)))
    out.push_back(
        {false, gap, mean(cells, [&](const PressedCell &c) { return pressure_down(c, gap); })});
  for (const double gap : between(up, turn, kEndless))
    out.push_back(
        {true, gap, mean(cells, [&](const PressedCell &c) { return pressure_up(c, gap); })});
  return out;
}

std::vector<SampleRow> under_one_pressure(const std::vector<PressedCell> &cells) {
  std::vector<GapOfPressure> down, up;
  std::vector<double> down_to, up_from;
  double turn = kEndless, end = -kEndless;
  for (const PressedCell &c : cells) {
    down.push_back({c.down.pressure, c.down.gap});
    up.push_back({turned(c.up.pressure), turned(c.up.gap)});
    down_to.insert(down_to.end(), down.back().pressure.begin(), down.back().pressure.end());
    up_from.insert(up_from.end(), up.back().pressure.begin(), up.back().pressure.end());
    turn = std::min(turn, down.back().pressure.back());
    end = std::max(end, up.back().pressure.front());
  }
  std::vector<SampleRow> out;
  for (const double p : between(down_to, -kEndless, turn))
    out.push_back({false, mean(down, [&](const GapOfPressure &g) { return g.at(p); }), p});
  for (const double p : turned(between(up_from, end, turn)))
    out.push_back({true, mean(up, [&](const GapOfPressure &g) { return g.at(p); }), p});
  return out;
}

} // namespace calendem
