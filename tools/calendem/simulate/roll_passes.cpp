// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/collect.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {
namespace {

using Rows = std::vector<RawRow>;

/// Rows of each pass: it begins with a compression and ends with a release.
std::vector<Rows> passes_of(const Rows &rows) {
  std::vector<Rows> passes;
  for (const RawRow &r : rows) {
    if (passes.empty() || (r.stage < 1.5 && passes.back().back().stage > 2.5))
      passes.emplace_back();
    passes.back().push_back(r);
  }
  return passes;
}

/// Along the web [um] with pressure above `least`, and line load [MPa um = N/m], of one side of the
/// nip.
struct Side {
  double length = 0.0, load = 0.0;
};

Side side_of(const Rows &pass, bool way_out, const RollNip &nip, double gap, double least) {
  Side side;
  const RawRow *last = nullptr;
  for (const RawRow &r : pass) {
    if ((r.stage > 2.5) != way_out)
      continue;
    if (last) {
      const double way = std::fabs(nip.distance(r.gap - gap) - nip.distance(last->gap - gap));
      side.load += 0.5 * (r.p_top + last->p_top) * way;
      if (std::max(r.p_top, last->p_top) > least)
        side.length += way;
    }
    last = &r;
  }
  return side;
}

nlohmann::json pass_of(const Rows &pass, const RollNip &nip, double lost) {
  double gap = pass.front().gap, largest = 0.0;
  for (const RawRow &r : pass) {
    gap = std::min(gap, r.gap);
    largest = std::max(largest, r.p_top);
  }
  const Side in = side_of(pass, false, nip, gap, lost * largest),
             out = side_of(pass, true, nip, gap, lost * largest);
  return {{"gap_um", gap},
          {"max_pressure_MPa", largest},
          {"line_load_N_mm", 1e-3 * (in.load + out.load)},
          {"line_load_before_the_nip_N_mm", 1e-3 * in.load},
          {"contact_length_um", in.length + out.length},
          {"contact_length_before_the_nip_um", in.length}};
}

} // namespace

RollNip roll_nip(const Settings &s) {
  return {1e3 * s.number("roll.radius_mm"), 1e3 * s.number("roll.counter_radius_mm"),
          s.number("roll.slip")};
}

nlohmann::json roll_passes(const std::vector<RawRow> &rows, const Settings &s) {
  const RollNip nip = roll_nip(s);
  nlohmann::json passes = nlohmann::json::array();
  for (const Rows &pass : passes_of(rows))
    passes.push_back(pass_of(pass, nip, s.number("platen.contact_lost_fraction")));
  const double way = rows.front().gap + rows.front().displacement - s.number("platen.roll_gap_um");
  const double web_speed = s.number("roll.line_speed_m_min") / 60.0; // m/s
  return {{"passes", passes},
          {"web_speed_of_the_run_m_s", nip.web_speed(s.number("platen.speed_m_s"), way)},
          {"run_faster_by", nip.web_speed(s.number("platen.speed_m_s"), way) / web_speed},
          {"time_in_the_last_nip_ms",
           1e-3 * passes.back()["contact_length_um"].get<double>() / web_speed}};
}

bool add_elongation(const std::string &folder, std::vector<RawRow> &rows) {
  const auto known = rows_by_step(folder + "/elongation_raw.csv", 3);
  for (RawRow &r : rows)
    if (const auto at = known.find(static_cast<long>(r.step)); at != known.end()) {
      r.elongation = at->second[1];
      r.work_elongation = at->second[2];
    }
  return !known.empty();
}

double elongation_at(const std::vector<RawRow> &rows, double time) {
  const auto above = std::lower_bound(rows.begin(), rows.end(), time,
                                      [](const RawRow &r, double t) { return r.time < t; });
  if (above == rows.end())
    return rows.back().elongation;
  if (above == rows.begin())
    return above->elongation;
  const RawRow &a = *(above - 1), &b = *above;
  return a.elongation + (b.elongation - a.elongation) * (time - a.time) / (b.time - a.time);
}

std::string elongation_columns() { return ",elongation_percent,cell_x_um,work_elongation_fJ"; }

std::string elongation_cells(const RawRow &row, const ElectrodeFacts &e) {
  return fmt::format(",{:.6f},{:.9f},{:.6g}", 100.0 * row.elongation,
                     e.elongated(row.elongation).lx, row.work_elongation);
}

nlohmann::json elongation_of(const RawRow &top, const RawRow &last, const ElectrodeFacts &e) {
  return {{"percent_at_max", 100.0 * top.elongation},
          {"percent_after", 100.0 * last.elongation},
          {"cell_x_after_um", e.elongated(last.elongation).lx}};
}

} // namespace calendem
