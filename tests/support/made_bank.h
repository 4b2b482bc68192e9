// SPDX-License-Identifier: GPL-2.0-or-later
// A bank's table from formulas, in the true format, for tests of what learns from such tables.
// Nothing in it is physics: porosity falls with the logarithm of pressure, friction holds it up.
#ifndef CALENDEM_TESTS_MADE_BANK_H
#define CALENDEM_TESTS_MADE_BANK_H

#include "base/random.h"
#include "diagnose/bank/bank_table.h"
#include <algorithm>
#include <cmath>

namespace calendem_test {

using namespace calendem;

constexpr double kSolidColumn = 9.0; // um

/// base: stiffness (1 to 2), strength (150 to 400); `value`: friction.
inline SimulatedRun made_run(const BankPoint &point, double target) {
  Random packing(std::uint64_t(point.packing), 5);
  const double scatter = 0.0005 * packing.normal();
  const double friction = point.effect == "friction" ? point.value : 0.0;
  const auto porosity = [&](double pressure) {
    return 0.48 + scatter - 0.09 / point.base[0] * std::log1p(pressure / 5.0) +
           0.12 * friction * std::exp(-pressure / 40.0);
  };
  SimulatedRun r;
  r.control = "pressure";
  r.target = r.max_pressure = target;
  r.solid_column = kSolidColumn;
  r.porosity_initial = 0.48;
  r.porosity_at_max = porosity(target);
  r.porosity_after = r.porosity_at_max + 0.03 / point.base[0];
  r.thickness_at_max = r.solid_column / (1.0 - r.porosity_at_max);
  r.thickness_after = r.solid_column / (1.0 - r.porosity_after);
  r.cracked_fraction = std::clamp(0.8 * target / point.base[1] + 2.0 * scatter, 0.0, 1.0);
  r.porosity_slope = (porosity(target) - porosity(0.9 * target)) / (0.1 * target);
  for (double p = 1.0; p <= target; p += 1.0) {
    r.pressure.push_back(p);
    r.displacement.push_back(kSolidColumn * (1.0 / 0.52 - 1.0 / (1.0 - porosity(p))) + 1.0);
  }
  return r;
}

/// 24 points of the base model on 8 packings, friction beside 12 of them, runs to 30 and 60 MPa.
inline BankTable made_bank() {
  BankTable table;
  BankSpec &spec = table.spec;
  spec.name = "from formulas";
  spec.pressures = {30.0, 60.0};
  spec.packings = 8;
  spec.base_points = 24;
  spec.effect_points = 12;
  spec.parameters = {{"stiffness", {"case.material.cbd.youngs_modulus_GPa"}, 1.0, 2.0, {}},
                     {"strength", {"case.bond.tensile_strength_MPa"}, 150.0, 400.0, {}}};
  spec.effects = {"friction", "thickness_zero"};
  for (const BankPoint &point : bank_points(spec))
    for (const double target : spec.pressures)
      table.rows.push_back({point, made_run(point, target)});
  return table;
}

/// Every run releases to 0.6 of its largest displacement, linear in pressure.
inline BankTable with_release(BankTable table) {
  for (BankRow &row : table.rows)
    for (const double share : {0.1, 0.25, 0.5, 0.75, 1.0}) {
      row.run.release_pressure.push_back(share * row.run.target);
      row.run.release_displacement.push_back(row.run.displacement.back() * (0.6 + 0.4 * share));
    }
  return table;
}

/// Gives the experiment's film the bank's solid column.
inline void set_film(Experiment &e) {
  e.recipe.am_weight = 1.0;
  e.recipe.am_density = 4.0;
  e.recipe.cbd_solid_density = 1.8;
  e.recipe.loading = 0.1 * 4.0 * kSolidColumn;
}

/// A sample at 30 and one at 60 MPa, measured without error: what a point of the bank would show.
inline Experiment made_experiment(const BankPoint &truth) {
  Experiment e;
  e.name = "from formulas";
  set_film(e);
  for (const double target : {30.0, 60.0}) {
    const SimulatedRun run = made_run(truth, target);
    Condition c;
    c.id = "p" + std::to_string(int(target));
    c.control = "pressure";
    c.max_pressure_MPa = Measured{target, 0.0};
    c.porosity_after_percent = Measured{100.0 * run.porosity_after, 0.1};
    c.thickness_at_max_um = Measured{run.thickness_at_max, 0.03};
    c.cracked_bodies_fraction = Measured{run.cracked_fraction, 0.02};
    e.conditions.push_back(c);
  }
  return e;
}

} // namespace calendem_test

#endif
