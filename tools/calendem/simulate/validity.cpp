// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/collect.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

namespace {

const char *const kKindNames[kKindsOfContact] = {"wall", "inside_bodies", "am_am", "am_cbd",
                                                 "cbd_cbd"};

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// All contacts of a row but those inside bodies, which hold the bodies' own stress.
RangeOfContacts all_contacts(const RawRow &row) {
  RangeOfContacts all = {};
  for (const int kind : {kWallContacts, kAmAm, kAmCbd, kCbdCbd}) {
    const RangeOfContacts &r = row.ranges[kind];
    all.contacts += r.contacts;
    all.force += r.force;
    all.mean += r.contacts * r.mean;
    all.largest = std::max(all.largest, r.largest);
    for (int k = 0; k < kRangeLimits; ++k) {
      all.beyond[k] += r.beyond[k];
      all.force_beyond[k] += r.force_beyond[k];
    }
  }
  all.mean = share(all.mean, all.contacts);
  return all;
}

double kinetic_to_elastic(const RawRow &r) {
  const double elastic = r.strain + r.contact_elastic;
  return elastic > 0.0 ? r.kinetic / elastic : std::nan("");
}

double inertial_number_of(const RawRow &r, const MeanSphere &primary) {
  return inertial_number(r.speed, r.gap, primary, 1e3 * r.p_top); // MPa -> kPa
}

constexpr int kOwnLaw = kRangeLimits - 1;

std::string limit_name(int k) {
  return k == kOwnLaw ? "beyond_law" : fmt::format("beyond_{:g}_R", kRangeLimit[k]);
}

nlohmann::json shares(const RangeOfContacts &r) {
  nlohmann::json out = {{"contacts", static_cast<long>(r.contacts)},
                        {"force_nN", r.force},
                        {"overlap_mean", r.mean},
                        {"overlap_largest", r.largest}};
  for (int k = 0; k < kRangeLimits; ++k) {
    out["contacts_" + limit_name(k)] = share(r.beyond[k], r.contacts);
    out["force_" + limit_name(k)] = share(r.force_beyond[k], r.force);
  }
  return out;
}

nlohmann::json by_kind(const RawRow &row) {
  nlohmann::json out = {{"all", shares(all_contacts(row))}};
  for (int kind = 0; kind < kKindsOfContact; ++kind)
    out[kKindNames[kind]] = shares(row.ranges[kind]);
  return out;
}

/// Raises every number of `largest` to that of `other`.
void raise(nlohmann::json &largest, const nlohmann::json &other) {
  for (auto &[key, value] : largest.items())
    if (value.is_object())
      raise(value, other[key]);
    else if (other[key] > value)
      value = other[key];
}

} // namespace

std::string validity_columns() {
  std::string out = ",inertial_number,kinetic_to_elastic";
  for (const char *what : {"contacts", "force"})
    for (int k = 0; k < kRangeLimits; ++k)
      out += fmt::format(",{}_{}", what, limit_name(k));
  for (const char *kind : kKindNames)
    out += fmt::format(",{0}_overlap_mean,{0}_overlap_largest,{0}_contacts_{1},{0}_force_{1}", kind,
                       limit_name(kWarnedLimit));
  return out;
}

std::string validity_cells(const RawRow &row, const MeanSphere &primary) {
  std::string out =
      fmt::format(",{:.4g},{:.4g}", inertial_number_of(row, primary), kinetic_to_elastic(row));
  const RangeOfContacts all = all_contacts(row);
  for (const double n : all.beyond)
    out += fmt::format(",{:.6g}", share(n, all.contacts));
  for (const double f : all.force_beyond)
    out += fmt::format(",{:.6g}", share(f, all.force));
  for (const RangeOfContacts &r : row.ranges)
    out += fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g}", r.mean, r.largest,
                       share(r.beyond[kWarnedLimit], r.contacts),
                       share(r.force_beyond[kWarnedLimit], r.force));
  return out;
}

nlohmann::json inertia(const std::vector<RawRow> &rows, const RawRow &top,
                       const MeanSphere &primary) {
  double number = 0.0, ratio = 0.0;
  for (const RawRow &r : rows)
    if (r.stage < 2.5 && r.p_top > 5.0) {
      number = std::max(number, inertial_number_of(r, primary));
      ratio = std::max(ratio, kinetic_to_elastic(r));
    }
  return {{"primary_diameter_um", primary.diameter},
          {"primary_density_g_cm3", primary.density},
          {"inertial_number_limit", kQuasiStaticInertialNumber},
          {"inertial_number_at_max_pressure", inertial_number_of(top, primary)},
          {"inertial_number_max_above_5_MPa", number},
          {"kinetic_to_elastic_at_max_pressure", kinetic_to_elastic(top)},
          {"kinetic_to_elastic_max_above_5_MPa", ratio}};
}

nlohmann::json contact_range(const std::vector<RawRow> &rows, const RawRow &top) {
  nlohmann::json largest = by_kind(top);
  for (const RawRow &r : rows)
    raise(largest, by_kind(r));
  return {{"R", "smaller radius of the pair; the sphere's at a wall"},
          {"all", "without the contacts inside bodies"},
          {"beyond_law", "beyond the range of the contact's own law"},
          {"at_max_pressure", by_kind(top)},
          {"largest_of_any_row", largest}};
}

std::string range_warning(const nlohmann::json &range) {
  const nlohmann::json &all = range["at_max_pressure"]["all"];
  const double force = all["force_" + limit_name(kOwnLaw)];
  if (force <= kWarnedShare)
    return "";
  return fmt::format("at maximum pressure {:.0f} % of the contact force is carried by overlaps "
                     "beyond the range of their contact law (the largest is {:.2f} of the smaller "
                     "radius): pressures and porosities there are uncertain. Give CBD "
                     "effects.cbd_ductility; see contact_range in summary.json",
                     100.0 * force, all["overlap_largest"].get<double>());
}

namespace {

struct Term {
  const char *name;
  double RawRow::*value;
};
const Term kTerms[] = {
    {"kinetic", &RawRow::kinetic},
    {"elastic_in_bonds", &RawRow::strain},
    {"elastic_in_contacts", &RawRow::contact_elastic},
    {"cohesion", &RawRow::cohesion},
    {"damped", &RawRow::damped},
    {"friction", &RawRow::friction},
    {"lost_in_breaks", &RawRow::work_lost},
};

double work(const RawRow &from, const RawRow &to) {
  return to.work_platen + to.work_collector + to.work_elongation - from.work_platen -
         from.work_collector - from.work_elongation;
}

double rest(const RawRow &from, const RawRow &to) {
  double left = work(from, to);
  for (const Term &t : kTerms)
    left -= to.*t.value - from.*t.value;
  return left;
}

nlohmann::json terms(const RawRow &from, const RawRow &to) {
  const double elongation = to.work_elongation - from.work_elongation;
  nlohmann::json out = {{"work_of_platen", work(from, to) - elongation}};
  if (elongation != 0.0)
    out["work_of_elongation"] = elongation;
  for (const Term &t : kTerms)
    out[t.name] = to.*t.value - from.*t.value;
  out["rest"] = rest(from, to);
  return out;
}

} // namespace

nlohmann::json energy_ledger(const std::vector<RawRow> &rows, const RawRow &top) {
  double largest = 0.0, worst = 0.0;
  for (const RawRow &r : rows) {
    const double left = std::fabs(rest(rows.front(), r));
    largest = std::max(largest, work(rows.front(), r));
    worst = left > worst || std::isnan(left) ? left : worst;
  }
  const double fraction = worst / largest;
  nlohmann::json out = {{"since_us", rows.front().time},
                        {"at_max_pressure", terms(rows.front(), top)},
                        {"at_end", terms(rows.front(), rows.back())},
                        {"unaccounted_fraction", fraction},
                        {"limit", kLedgerLimit}};
  if (std::isfinite(fraction))
    out["closes"] = fraction <= kLedgerLimit;
  return out;
}

std::string ledger_warning(const nlohmann::json &energy) {
  if (energy.value("closes", true))
    return "";
  return fmt::format(
      "the energy ledger leaves {:.3g} % of the platen's work unaccounted for, more "
      "than {:g} %: the time step is too long for the contacts or a force is missing "
      "in the ledger. Try half the step and look at energy_fJ in summary.json",
      100 * energy["unaccounted_fraction"].get<double>(), 100 * kLedgerLimit);
}

} // namespace calendem
