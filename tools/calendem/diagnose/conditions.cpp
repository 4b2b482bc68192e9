// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/gap.h"
#include "diagnose/rerun.h"
#include "diagnose/sample_film.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>

namespace calendem {

namespace {

constexpr double kOtherFilm = 0.1; // of the film: more than a bank varies it

/// Mean over the base model's runs to the bank's pressure next to the condition's, pressed so.
double usual(const BankTable &table, const Condition &c,
             const std::function<double(const SimulatedRun &)> &value) {
  double sum = 0.0, n = 0.0, apart = INFINITY;
  const auto off = [&](const BankRow &row) {
    const bool base = row.point.effect.empty() && row.run.pressing == c.pressing;
    return base ? std::fabs(row.run.target - c.max_pressure_MPa->value) : INFINITY;
  };
  for (const BankRow &row : table.rows)
    apart = std::min(apart, off(row));
  for (const BankRow &row : table.rows)
    if (std::isfinite(apart) && off(row) <= apart) {
      sum += value(row.run);
      n += 1.0;
    }
  return sum / n;
}

const MeasurementPrice &price_of(const BankSpec &spec, const std::string &name) {
  return *std::find_if(spec.prices.begin(), spec.prices.end(),
                       [&](const MeasurementPrice &p) { return p.name == name; });
}

/// What only is measured on it: the sample's loading and its pressure stay.
Condition bare(const Condition &c) {
  Condition out;
  out.id = c.id;
  out.specimen = c.specimen;
  out.control = c.control;
  out.pressing = c.pressing;
  out.max_pressure_MPa = c.max_pressure_MPa;
  out.loading_mg_cm2 = c.loading_mg_cm2;
  out.mass_mg = c.mass_mg;
  return out;
}

Condition with_loading(const Experiment &e, const Condition &c, const BankTable &table,
                       std::vector<std::string> &not_said) {
  const double other = 1.0 / film_ratio(e, table);
  return loading_of(e, c) || !(std::fabs(other - 1.0) > kOtherFilm)
             ? c
             : with_loading_of_recipe(e, c, not_said);
}

/// The measurements of one kind: on each condition that lacks it.
class Kind {
public:
  Kind(const Experiment &e, const BankTable &table, const std::string &name)
      : experiment_(e), table_(table), price_(price_of(table.spec, name)) {
    out_.what = price_.what;
  }
  void add(const Condition &c, const std::vector<Observable> &observables) {
    out_.of.push_back({c, c.max_pressure_MPa->value, observables});
    out_.what += (out_.of.size() == 1 ? ": " : ", ") + c.id;
    out_.hours += price_.hours;
  }
  void add(const Condition &c) {
    std::vector<std::string> not_said;
    add(c, observables_of(experiment_, c, not_said));
  }
  /// Measured to the price's deviation at what the bank usually gives.
  Measured expected(const Condition &c,
                    const std::function<double(const SimulatedRun &)> &value) const {
    return {usual(table_, c, value), price_.sd};
  }
  double sd() const { return price_.sd; }
  void set_hours(double hours) { out_.hours = hours; }
  void finish(std::vector<Further> &list) const {
    if (!out_.of.empty())
      list.push_back(out_);
  }

private:
  const Experiment &experiment_;
  const BankTable &table_;
  const MeasurementPrice &price_;
  Further out_;
};

void add_porosity(Kind &kind, Condition c) {
  c.porosity_after_percent =
      kind.expected(c, [](const SimulatedRun &r) { return 100.0 * r.porosity_after; });
  kind.add(c);
}

void add_thickness(Kind &kind, const Experiment &e, Condition c) {
  if (const auto loading = loading_of(e, c)) {
    c.thickness_at_max_um =
        kind.expected(c, [](const SimulatedRun &r) { return r.thickness_at_max / r.solid_column; });
    c.thickness_at_max_um->value *= solid_thickness_um(e, loading->value);
  } else {
    c.thickness_at_max_um =
        kind.expected(c, [](const SimulatedRun &r) { return r.thickness_at_max; });
  }
  kind.add(c);
}

void add_curve(Kind &kind, const Experiment &e, const Condition &c, Branch branch) {
  const auto loading = loading_of(e, c);
  const double solid = loading ? solid_thickness_um(e, loading->value) : 1.0;
  std::vector<Observable> points = points_of_curve(e, c, c.max_pressure_MPa->value, branch);
  for (Observable &o : points) {
    o.sd = kind.sd() / solid;
    o.by_loading =
        loading ? -kind.expected(c, o.simulated).value * loading->sd / loading->value : 0.0;
  }
  kind.add(c, points);
}

/// What a dwell leaves of the pressure, on the condition that has one.
void add_porosity_and_dwell(Kind &kind, Condition c, bool rests) {
  constexpr double kReading = 1.0; // %, of the pressure left
  if (rests)
    c.pressure_left_percent = Measured{
        kind.expected(c, [](const SimulatedRun &r) { return 100.0 * r.pressure_left; }).value,
        kReading};
  add_porosity(kind, c);
}

/// The bank's runs of that way dwell.
bool rests_in(const BankTable &table, const std::string &pressing) {
  return std::any_of(table.rows.begin(), table.rows.end(), [&](const BankRow &row) {
    return row.run.pressing == pressing && std::isfinite(row.run.pressure_left);
  });
}

bool of_release(const Observable &o) { return !o.curve.empty() && o.stage == "relaxation"; }

bool among(const std::vector<CoveredCondition> &covered, double pressure,
           const std::string &pressing) {
  return std::any_of(covered.begin(), covered.end(), [&](const CoveredCondition &c) {
    return c.condition.pressing == pressing && same_pressure(c.pressure, pressure);
  });
}

/// Another specimen at a pressure of the bank, read as well as those of the experiment.
Condition at_pressure(double pressure, const std::vector<CoveredCondition> &covered) {
  double relative = 0.0;
  for (const CoveredCondition &c : covered)
    relative += c.condition.max_pressure_MPa->sd / c.pressure / double(covered.size());
  Condition out;
  out.id = out.specimen = fmt::format("{:g} MPa", pressure);
  out.control = "pressure";
  out.max_pressure_MPa = Measured{pressure, relative * pressure};
  return out;
}

} // namespace

namespace {

/// Pressures of the bank's runs for the condition; none: it is left out, and why is reported.
std::vector<double> runs_of(const Condition &c, const BankTable &table,
                            std::vector<std::string> &not_said) {
  if (!c.pressing.empty() && !find_pressing(table.spec, c.pressing)) {
    std::vector<std::string> known;
    for (const BankPressing &p : table.spec.pressings)
      if (!p.name.empty())
        known.push_back("\"" + p.name + "\"");
    not_said.push_back(fmt::format(
        "{}: pressing = \"{}\" is not in the bank, which has {}; the condition is left out.", c.id,
        c.pressing,
        known.empty() ? "the usual one only" : fmt::format("{}", fmt::join(known, ", "))));
    return {};
  }
  const double p = c.max_pressure_MPa->value;
  std::vector<double> runs = beside(p, pressures_learnt(table, true, c.pressing));
  const std::vector<double> reached = pressures_learnt(table, false, c.pressing);
  if (runs.empty())
    runs = beside(p, reached);
  const std::string so = c.pressing.empty() ? "" : fmt::format(" of \"{}\"", c.pressing);
  if (reached.empty())
    not_said.push_back(fmt::format("{}: the bank's table has no runs{}.", c.id, so));
  else if (runs.empty())
    not_said.push_back(fmt::format("{}: {:g} MPa lies outside the bank's {:g} to {:g} MPa{}; the "
                                   "condition is left out. Another bank may reach it (--bank).",
                                   c.id, p, reached.front(), reached.back(), so));
  return runs;
}

/// A film that was not pressed to a pressure, but has one.
void say_of_control(const Condition &c, std::vector<std::string> &not_said) {
  if (by_pressure(c))
    return;
  not_said.push_back(fmt::format(
      "{}: it was pressed to a {} and is set beside runs to the pressure "
      "that was measured there{}.",
      c.id, c.control, c.displacement_um ? "; displacement_um is left out, give the curve" : ""));
}

} // namespace

std::vector<CoveredCondition> covered_conditions(const Experiment &e, const BankTable &table,
                                                 const std::vector<std::string> &wanted,
                                                 std::vector<std::string> &not_said) {
  std::vector<CoveredCondition> out;
  for (Condition c : e.conditions) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), c.id) == wanted.end())
      continue;
    if (!c.max_pressure_MPa) {
      not_said.push_back(fmt::format("{}: control = \"{}\" without max_pressure_MPa: the bank's "
                                     "runs go to a pressure; the condition is left out.",
                                     c.id, c.control));
      continue;
    }
    const double p = c.max_pressure_MPa->value;
    const std::vector<double> runs = runs_of(c, table, not_said);
    if (runs.empty())
      continue;
    say_of_control(c, not_said);
    c.control = "pressure";
    const bool rests = rests_in(table, c.pressing);
    if (rests && (c.dwell_s > 0.0 || c.pressure_left_percent))
      not_said.push_back(fmt::format(
          "{}: its dwell{} is set beside the bank's{}; the share of the pressure that it leaves is "
          "taken to be the same in films of any thickness.",
          c.id, c.dwell_s > 0.0 ? fmt::format(" of {:g} s", c.dwell_s) : "",
          c.pressing.empty() ? "" : " (" + find_pressing(table.spec, c.pressing)->what + ")"));
    else if (c.dwell_s > 0.0)
      not_said.push_back(fmt::format("{}: the bank's runs do not dwell; its {:g} s at the target "
                                     "are left out.",
                                     c.id, c.dwell_s));
    if (has_images(c))
      not_said.push_back(fmt::format(
          "{}: label images have no part in which effect it is: the bank keeps no frames. Those of "
          "a held-out condition are set beside the models that are run again; calendem compare "
          "sets any beside runs.",
          c.id));
    Condition known = with_loading(e, c, table, not_said);
    if (c.pressure_left_percent && !rests) {
      known.pressure_left_percent.reset();
      not_said.push_back(fmt::format("{}: pressure_left_percent is left out: the bank's runs for "
                                     "it do not dwell. Name a [[pressing]] that does (pressing).",
                                     c.id));
    }
    std::vector<Observable> seen = observables_of(e, known, not_said);
    if (!has_release(table) && std::any_of(seen.begin(), seen.end(), of_release)) {
      seen.erase(std::remove_if(seen.begin(), seen.end(), of_release), seen.end());
      not_said.push_back(fmt::format("{}: the bank's table has no displacements on release; the "
                                     "unloading curve is left out.",
                                     c.id));
    }
    out.push_back({known, p, seen, 1, runs});
  }
  return out;
}

std::vector<Further> further_measurements(const Experiment &e, const BankTable &table,
                                          const std::vector<CoveredCondition> &covered) {
  Kind porosity(e, table, "porosity_after"), thickness(e, table, "thickness_at_max"),
      cracked(e, table, "cracked_bodies"), curve(e, table, "loading_curve"),
      release(e, table, kUnloadingCurve);
  for (const CoveredCondition &c : covered) {
    const Condition without = bare(c.condition);
    if (!c.condition.porosity_after_percent && !c.condition.thickness_after_um)
      add_porosity(porosity, without);
    if (!c.condition.thickness_at_max_um)
      add_thickness(thickness, e, without);
    if (!c.condition.cracked_bodies_fraction) {
      Condition counted = without;
      counted.cracked_bodies_fraction =
          cracked.expected(without, [](const SimulatedRun &r) { return r.cracked_fraction; });
      cracked.add(counted);
    }
    if (c.condition.curve.empty())
      add_curve(curve, e, without, Branch::Loading);
    if (has_release(table) && std::none_of(c.observables.begin(), c.observables.end(), of_release))
      add_curve(release, e, without, Branch::Release);
  }
  std::vector<Further> list;
  for (const Kind *kind : {&porosity, &thickness, &cracked, &curve, &release})
    kind->finish(list);
  for (const double p : pressures_learnt(table, true)) {
    Kind other(e, table, "porosity_after");
    if (!among(covered, p, ""))
      add_porosity(other, at_pressure(p, covered));
    other.finish(list);
  }
  for (const BankPressing &pressing : table.spec.pressings)
    for (const double p : pressing.pressures) {
      Kind other(e, table, "porosity_after");
      if (pressing.name.empty() || among(covered, p, pressing.name) || !among(covered, p, "") ||
          beside(p, pressures_learnt(table, true, pressing.name)).size() != 1)
        continue;
      Condition c = at_pressure(p, covered);
      c.id = c.specimen = fmt::format("{}, {}", c.id, pressing.what);
      c.pressing = pressing.name;
      add_porosity_and_dwell(other, c, rests_in(table, pressing.name));
      for (const MeasurementPrice &price : table.spec.prices)
        if (price.name == pressing.name)
          other.set_hours(price.hours);
      other.finish(list);
    }
  for (Further &f : list)
    for (CoveredCondition &c : f.of) {
      const auto at =
          std::find_if(covered.begin(), covered.end(), [&](const CoveredCondition &had) {
            return had.condition.id == c.condition.id;
          });
      c.runs = at == covered.end() ? std::vector<double>{c.pressure} : at->runs;
    }
  return list;
}

} // namespace calendem
