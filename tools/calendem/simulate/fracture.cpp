// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/fracture.h"
#include "base/csv_table.h"
#include "base/provenance.h"
#include "simulate/collect.h"
#include <algorithm>
#include <array>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

namespace {

std::vector<double> times_of(const BodyBonds &body) {
  std::vector<double> times;
  for (const BodyBond &b : body.bonds)
    if (std::isfinite(b.broken_us))
      times.push_back(b.broken_us);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

// Broken bonds only become more, fragments too: what holds once holds from then on.
template <class Holds> double since(const BodyBonds &body, Holds holds) {
  const std::vector<double> times = times_of(body);
  const auto first = std::partition_point(times.begin(), times.end(),
                                          [&](double t) { return !holds(state_at(body, t)); });
  return first == times.end() ? HUGE_VAL : *first;
}

struct Totals {
  int apart = 0, cracked = 0, split = 0, broken = 0, parting = 0;
  void add(const FractureState &s, int sign) {
    apart += sign * s.apart();
    cracked += sign * is_cracked(s);
    split += sign * is_split(s);
    broken += sign * s.broken;
    parting += sign * s.parting;
  }
};

} // namespace

FractureState state_at(const BodyBonds &body, double time_us) {
  FractureState s;
  boost::disjoint_sets_with_storage<> fragments(static_cast<std::size_t>(body.primaries));
  std::vector<int> size(body.primaries, 0);
  s.bonds = static_cast<int>(body.bonds.size());
  for (const BodyBond &b : body.bonds)
    if (b.broken_us <= time_us)
      ++s.broken;
    else
      fragments.union_set(b.i, b.j);
  for (const BodyBond &b : body.bonds)
    s.parting += b.broken_us <= time_us && fragments.find_set(b.i) != fragments.find_set(b.j);
  for (int i = 0; i < body.primaries; ++i)
    ++size[fragments.find_set(i)];
  s.fragments =
      static_cast<int>(std::count_if(size.begin(), size.end(), [](int n) { return n > 0; }));
  s.largest = double(*std::max_element(size.begin(), size.end())) / body.primaries;
  return s;
}

double cracked_since(const BodyBonds &body) { return since(body, is_cracked); }
double apart_since(const BodyBonds &body) {
  return since(body, [](const FractureState &s) { return s.apart(); });
}

std::string cracks_table(const std::vector<BodyBonds> &bodies,
                         const std::vector<MomentOfRun> &moments, double face_um2) {
  struct Event {
    double time;
    size_t body;
  };
  std::vector<Event> events;
  std::vector<FractureState> now;
  int bonded = 0;
  for (size_t k = 0; k < bodies.size(); ++k) {
    bonded += !bodies[k].bonds.empty();
    now.push_back(state_at(bodies[k], -HUGE_VAL));
    for (double t : times_of(bodies[k]))
      events.push_back({t, k});
  }
  std::sort(events.begin(), events.end(),
            [](const Event &a, const Event &b) { return a.time < b.time; });
  std::string out = "time_us,stage,pressure_MPa,bodies_with_bonds,bodies_apart,bodies_cracked,"
                    "bodies_split,cracked_fraction,crack_surface_um2,parted_surface_um2\n";
  Totals sum;
  for (const FractureState &s : now)
    sum.add(s, 1);
  auto next = events.begin();
  for (const MomentOfRun &m : moments) {
    for (; next != events.end() && next->time <= m.time_us; ++next) {
      FractureState &s = now[next->body];
      sum.add(s, -1);
      s = state_at(bodies[next->body], next->time);
      sum.add(s, 1);
    }
    out += fmt::format("{:.6f},{},{:.6g},{},{},{},{},{:.6f},{:.6g},{:.6g}\n", m.time_us, m.stage,
                       m.pressure_MPa, bonded, sum.apart, sum.cracked, sum.split,
                       bonded > 0 ? double(sum.cracked) / bonded : 0.0, sum.broken * face_um2,
                       sum.parting * face_um2);
  }
  return out;
}

std::vector<ThresholdRow> test_thresholds(const std::vector<BodyBonds> &bodies, double time_us) {
  std::vector<ThresholdRow> rows;
  for (int percent = 5; percent <= 20; ++percent)
    rows.push_back({percent});
  for (const BodyBonds &body : bodies) {
    if (body.bonds.empty())
      continue;
    const FractureState s = state_at(body, time_us);
    for (ThresholdRow &r : rows) {
      const bool above = 100 * s.broken >= r.percent * s.bonds;
      ++(s.apart() ? (above ? r.above_apart : r.below_apart)
                   : (above ? r.above_whole : r.below_whole));
      if (is_split(s))
        ++(above ? r.above_split : r.below_split);
    }
  }
  return rows;
}

std::string thresholds_table(const std::vector<ThresholdRow> &rows) {
  std::string out = "threshold_percent,above_apart,above_whole,below_apart,below_whole,"
                    "above_split,below_split,agreement,agreement_split\n";
  for (const ThresholdRow &r : rows) {
    const int above = r.above_apart + r.above_whole, below = r.below_apart + r.below_whole;
    const double all = std::max(1, above + below);
    out += fmt::format("{},{},{},{},{},{},{},{:.6f},{:.6f}\n", r.percent, r.above_apart,
                       r.above_whole, r.below_apart, r.below_whole, r.above_split, r.below_split,
                       (r.above_apart + r.below_whole) / all,
                       (r.above_split + below - r.below_split) / all);
  }
  return out;
}

namespace {

/// Made to AM, CBD, collector; broken likewise.
using Counts = std::array<long, 6>;
const char *const kTo[] = {"am", "cbd", "collector"};

nlohmann::json by_kind(const Counts &counts, int first) {
  nlohmann::json out;
  for (int k = 0; k < 3; ++k)
    out[kTo[k]] = counts[first + k];
  return out;
}

} // namespace

nlohmann::json write_bridges(const std::string &folder, const std::vector<RawRow> &rows,
                             const RawRow &top) {
  const auto counts = rows_by_step(folder + "/bridges_raw.csv", 7);
  if (counts.empty())
    return nullptr;
  std::string out = "time_us,pressure_MPa,thickness_um,made_am,made_cbd,made_collector,broken_am,"
                    "broken_cbd,broken_collector\n";
  Counts at_top = {}, last = {};
  for (const RawRow &r : rows) {
    const auto found = counts.find(static_cast<long>(r.step));
    if (found == counts.end())
      continue;
    std::copy(found->second.begin() + 1, found->second.end(), last.begin());
    at_top = r.step == top.step ? last : at_top;
    out += fmt::format("{:.6f},{:.6g},{:.6f},{}\n", r.time, r.p_top, r.gap, fmt::join(last, ","));
  }
  write_file(folder + "/bridges.csv", out);
  return {{"made", by_kind(last, 0)},
          {"broken_at_max", by_kind(at_top, 3)},
          {"broken_after", by_kind(last, 3)}};
}

nlohmann::json dried_film(const std::string &folder) {
  const CsvTable rows = CsvTable::parse(text_of_file(folder + "/drying.csv"));
  if (rows.rows() == 0)
    return nullptr;
  const auto last = [&](const char *column) { return rows.numbers(column).back(); };
  double left = 0.0;
  for (const double x : rows.numbers("left_over_fJ"))
    left = std::isnan(x) ? x : std::max(left, std::fabs(x));
  return {{"shrinkage", last("shrinkage")},
          {"film_tension_MPa", last("film_tension_MPa")},
          {"height_of_top_um", last("top_um")},
          {"bridges_broken",
           {{"am", static_cast<long>(last("broken_am"))},
            {"cbd", static_cast<long>(last("broken_cbd"))},
            {"collector", static_cast<long>(last("broken_collector"))}}},
          {"kinetic_fJ", last("kinetic_fJ")},
          {"work_of_shrinking_fJ", last("shrinking_fJ")},
          {"unaccounted_fraction", left / last("shrinking_fJ")}};
}

} // namespace calendem
