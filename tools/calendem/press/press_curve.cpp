// SPDX-License-Identifier: GPL-2.0-or-later
#include "press/press_curve.h"
#include "base/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr double kTurn = 0.05; // of the highest pressure: less than that is noise

std::size_t first_contact(const std::string &file, const std::vector<double> &p, double contact) {
  constexpr std::size_t kRows = 3; // a single reading may be noise
  for (std::size_t k = 0; k + kRows <= p.size(); ++k)
    if (std::all_of(p.begin() + long(k), p.begin() + long(k + kRows),
                    [&](double v) { return v > contact; }))
      return k;
  throw Failure(kBadInput,
                "{}: the pressure never stays above {:g} MPa, where contact is taken to begin; its "
                "highest is {:.4g}. Are force, unit and diameter right? Else give --contact-MPa.",
                file, contact, *std::max_element(p.begin(), p.end()));
}

/// Loading up to each maximum of the pressure behind which the platen goes back, unloading down to
/// each minimum.
void find_stages(PressCurve &c) {
  const double noise = kTurn * c.highest();
  bool loading = true;
  std::size_t extreme = 0;
  c.stage.assign(c.pressure.size(), "loading");
  for (std::size_t k = 1; k < c.pressure.size(); ++k) {
    const double beyond = (loading ? 1.0 : -1.0) * (c.pressure[k] - c.pressure[extreme]);
    c.stage[k] = c.stage[k - 1];
    if (beyond > 0.0)
      extreme = k;
    const bool back = (c.displacement[k] < c.displacement[extreme]) == loading;
    if (beyond >= -noise || !back) // pressure that falls as the film gives way is no turn
      continue;
    loading = !loading;
    std::fill(c.stage.begin() + long(extreme) + 1, c.stage.begin() + long(k) + 1,
              loading ? "loading" : "unloading");
    extreme = k;
  }
  for (std::size_t k = extreme + 1; k < c.pressure.size() && loading; ++k) // less than a turn
    c.stage[k] = "unloading";
}

void count_cycles(PressCurve &c) {
  c.cycle.assign(c.stage.size(), 1);
  for (std::size_t k = 1; k < c.stage.size(); ++k)
    c.cycle[k] = c.cycle[k - 1] + (c.stage[k] == "loading" && c.stage[k - 1] == "unloading");
}

template <class T> std::vector<T> part(const std::vector<T> &v, std::size_t from, std::size_t to) {
  return v.empty() ? v : std::vector<T>(v.begin() + long(from), v.begin() + long(to));
}

/// Behind the last row in contact: where the platen has left the film its place says nothing.
std::size_t last_contact(const std::vector<double> &p, double contact) {
  std::size_t end = p.size();
  while (end > 0 && p[end - 1] < contact)
    --end;
  return std::min(end + 1, p.size());
}

} // namespace

double PressCurve::highest() const { return *std::max_element(pressure.begin(), pressure.end()); }

double PressCurve::displacement_at(double p) const {
  for (std::size_t k = 1; k < pressure.size(); ++k)
    if (pressure[k] >= p && pressure[k] > pressure[k - 1])
      return displacement[k - 1] +
             (displacement[k] - displacement[k - 1]) *
                 std::clamp((p - pressure[k - 1]) / (pressure[k] - pressure[k - 1]), 0.0, 1.0);
  return NAN;
}

PressCurve make_press_curve(const std::string &file, const PressExport &from, double contact_MPa) {
  PressCurve c;
  c.contact = first_contact(file, from.pressure, contact_MPa);
  const std::size_t end = last_contact(from.pressure, contact_MPa);
  c.pressure = part(from.pressure, c.contact, end);
  c.displacement = part(from.displacement, c.contact, end);
  c.time = part(from.time, c.contact, end);
  c.stage = part(from.stage, c.contact, end);
  const auto top = std::max_element(c.pressure.begin(), c.pressure.end()) - c.pressure.begin();
  const double zero = c.displacement.front(),
               sign = c.displacement[std::size_t(top)] < zero ? -1.0 : 1.0;
  for (double &d : c.displacement)
    d = sign * (d - zero) + 0.0; // no -0
  if (c.stage.empty())
    find_stages(c);
  count_cycles(c);
  c.said.push_back(
      fmt::format("first contact in row {} at {:.3g} MPa{}; the displacement counts {}",
                  c.contact + 1, c.pressure.front(),
                  c.contact == 0 ? " (the file begins in contact: what came before is "
                                   "unknown, state curve_zero_um)"
                                 : "",
                  sign < 0.0 ? "down" : "up"));
  c.said.push_back(
      fmt::format("{} of loading to {:.4g} MPa, {:.4g} um; the last row at {:.3g} MPa",
                  c.cycle.back() == 1 ? "one cycle" : fmt::format("{} cycles", c.cycle.back()),
                  c.highest(), c.displacement[std::size_t(top)], c.pressure.back()));
  return c;
}

void subtract_machine(PressCurve &curve, const PressCurve &blank) {
  constexpr double kShort = 0.98; // of the highest pressure; the rest is the last value
  const double most = blank.highest();
  if (most < kShort * curve.highest())
    throw Failure(kBadInput,
                  "the blank run ends at {:.4g} MPa, the curve at {:.4g}: what the press gives way "
                  "above is unknown. Press the blank as far.",
                  most, curve.highest());
  const double first = blank.pressure.front();
  const auto way = [&](double p) { // below the blank's first contact as steep as just above
    return p < first ? blank.displacement_at(2.0 * first) * (p - first) / first
                     : blank.displacement_at(std::min(p, most));
  };
  const double zero = way(curve.pressure.front());
  for (std::size_t k = 0; k < curve.pressure.size(); ++k) {
    curve.machine.push_back(way(curve.pressure[k]) - zero);
    curve.displacement[k] -= curve.machine.back();
  }
  curve.said.push_back(
      fmt::format("the press gives way by {:.3g} um at {:.4g} MPa, by the blank run; taken off",
                  way(curve.highest()), curve.highest()));
}

std::string curve_table(const PressCurve &c, const std::string &head) {
  const bool cycles = c.cycle.back() > 1;
  std::string out = head + "displacement_um,pressure_MPa,stage";
  out += std::string(cycles ? ",cycle" : "") + (c.time.empty() ? "\n" : ",time_s\n");
  for (std::size_t k = 0; k < c.pressure.size(); ++k) {
    out += fmt::format("{:.3f},{:.4f},{}", c.displacement[k], c.pressure[k], c.stage[k]);
    out += cycles ? fmt::format(",{}", c.cycle[k]) : "";
    out += c.time.empty() ? "\n" : fmt::format(",{:.6g}\n", c.time[k]);
  }
  return out;
}

} // namespace calendem
