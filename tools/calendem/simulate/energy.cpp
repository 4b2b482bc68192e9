// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/collect.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
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
