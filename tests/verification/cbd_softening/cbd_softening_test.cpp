// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/cbd_softening.h"
#include "physics/hertz_contact.h"
#include "run_case.h"

using namespace calendem;

namespace {

constexpr double kDiameter = 1.316, kSide = 5.0, kModulus = 2.0, kWall = 200.0; // um, GPa

/// Four CBD spheres, and one of active material that nothing touches.
Files layer() {
  std::ostringstream data;
  data << "layer\n\n5 atoms\n4 atom types\n\n0 5 xlo xhi\n0 5 ylo yhi\n0 4 zlo zhi\n\nAtoms\n\n"
       << "5 1 0.4 4.65 0.3 0.3 0.6\n";
  for (int n = 0; n < 4; ++n) {
    const int column = n % 2, row = n / 2;
    data << n + 1 << " 2 " << kDiameter << " 0.915 " << 1.25 + 2.5 * column << " "
         << 1.25 + 2.5 * row << " " << 0.5 * kDiameter << "\n";
  }
  return {{"electrode.data", data.str()},
          {"bodies.map", "5 1\n"},
          {"electrode.in",
           "variable thickness_um equal 1.316\nvariable area_um2 equal 25\n"
           "variable solid_volume_um3 equal 2.4\n"
           "variable primary_diameter_um equal 0.4\n"
           "variable lattice_um equal 0.3\nvariable cbd_diameter_um equal 1.316\n"}};
}

std::vector<Row> pressed(Settings settings) {
  settings.insert({{"scripts", CALENDEM_CASES "/../../input_scripts"},
                   {"electrode", "."},
                   {"out", "."},
                   {"control", "displacement"},
                   {"d_target_um", "0.08"},
                   {"speed_m_s", "0.1"},
                   {"touch_speed_m_s", "0.1"},
                   {"ramp_us", "0"},
                   {"ced_cbd_J_m3", "0"},
                   {"E_cbd_GPa", number(kModulus)},
                   {"E_col_GPa", number(kWall)},
                   {"E_plt_GPa", number(kWall)},
                   {"gravity_m_s2", "0"},
                   {"average_us", "0.01"},
                   {"every_us", "0.02"}});
  const CaseRun run("../../input_scripts/in.compression", settings, 1, layer());
  EXPECT_TRUE(run.finished()) << run.why();
  return run.rows("curve_raw.csv");
}

} // namespace

// Requirement: Hertz's law with the softened modulus, as well at 25 C with the material's own.
TEST(CbdSofteningCase, ALayerFollowsHertzAtBothTemperatures) {
  for (const double temperature : {25.0, 80.0}) {
    const std::vector<Row> rows = pressed({{"temperature_C", number(temperature)}});
    ASSERT_GT(rows.size(), 10u);
    const Row &end = rows.back();
    const double E = 1e6 * kModulus * CbdSoftening::factor(temperature), // kPa
        force = hertz_force(effective_modulus(E, 0.49, 1e6 * kWall, 0.3), 0.5 * kDiameter,
                            0.5 * (kDiameter - end.at("gap_um"))),
                 pressure = 1e-3 * 4.0 * force / (kSide * kSide);
    EXPECT_NEAR(end.at("pressure_MPa") / pressure, 1.0, 5e-3) << temperature;
  }
}

// Requirement: limits of contacts and of nanopores are softened with the modulus.
TEST(CbdSofteningCase, LimitsAndCollapseAreThoseOfValuesByHand) {
  const double f = CbdSoftening::factor(80.0);
  for (const bool ductile : {false, true}) {
    const auto values = [&](double by) {
      Settings s = {{"E_cbd_GPa", number(by * kModulus)}, {"d_target_um", "0.06"}};
      if (ductile)
        s["cbd_hardness_GPa"] = number(by * 0.1);
      else
        s.insert({{"cbd_contact_yield_GPa", number(by * 0.2)},
                  {"cbd_contact_hardening_GPa", number(by * 0.1)},
                  {"cbd_yield_MPa", number(by * 5.0)},
                  {"cbd_hardening_MPa", number(by * 20.0)}});
      return s;
    };
    Settings warm = values(1.0);
    warm["temperature_C"] = "80";
    const std::vector<Row> by_law = pressed(warm), by_hand = pressed(values(f));
    ASSERT_EQ(by_law.size(), by_hand.size());
    const double most = by_hand.back().at("pressure_MPa");
    for (std::size_t k = 0; k < by_law.size(); ++k)
      EXPECT_NEAR(by_law[k].at("pressure_MPa"), by_hand[k].at("pressure_MPa"), 1e-7 * most);
  }
}
