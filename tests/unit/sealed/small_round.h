// SPDX-License-Identifier: GPL-2.0-or-later
// A small round, and what the press shows of its truths.
#ifndef CALENDEM_TESTS_UNIT_SEALED_SMALL_ROUND_H
#define CALENDEM_TESTS_UNIT_SEALED_SMALL_ROUND_H

#include "sealed/make.h"
#include "sealed/round_file.h"
#include "support/test_folder.h"
#include <fstream>

namespace calendem_test {

using namespace calendem;

inline const std::string kRound =
    "[round]\nbank = \"bank.toml\"\nnull_packings = 2\nnull_draws = 5\namplitudes = 3\n"
    "samples = 3\n"
    "open = [\"cohesion\"]\npairs = [\"thickness_zero + friction\"]\nfaults = [\"noise\"]\n"
    "other_numerics = [\"larger_cell + friction\", \"half_time_step\"]\n"
    "[noise]\nunderstated_by = [3, 4]\nporosity_percent = 0.5\n";

inline Round round_of(const std::string &text) {
  const auto folder = test_folder();
  std::ofstream(folder / "electrode.toml") << "material = \"xu2023\"\n[coating]\nloading_mg_cm2 = "
                                              "4\n[cell]\nx_um = 6\ny_um = 6\n"; // 9.13 um of solid
  std::ofstream(folder / "case.toml") << "electrode = \"any\"\n";
  std::ofstream(folder / "bank.toml")
      << "[bank]\nrecipe = \"electrode.toml\"\ncase = \"case.toml\"\npressures_MPa = [30, 50]\n"
         "effects = [\"friction\", \"thickness_zero\"]\n[[parameter]]\nname = \"strength\"\nkeys = "
         "[\"case.bond.tensile_strength_MPa\", \"case.bond.shear_strength_MPa\"]\nlow = 150\nhigh "
         "= 400\n";
  std::ofstream(folder / "round.toml") << text;
  return read_round((folder / "round.toml").string());
}

/// Three samples that scatter by 0.06 um in displacement and 0.03 in porosity; their means are
/// 3 p / target and 0.43.
inline PressedSamples pressed(double target) {
  PressedSamples all;
  for (const double off : {-0.06, 0.02, 0.04}) {
    SimulatedRun s;
    s.thickness_at_max = 14.0;
    s.thickness_after = 16.0;
    s.porosity_initial = 0.48;
    s.porosity_after = 0.43 + 0.5 * off;
    s.cracked_fraction = 0.5;
    for (double p = 0.0; p <= 1.2 * target; p += 0.1) {
      s.pressure.push_back(p);
      s.displacement.push_back(3.0 * p / target + off);
      s.release_pressure.push_back(p);
      s.release_displacement.push_back(2.0 + p / target + off);
    }
    all.push_back(s);
  }
  return all;
}

} // namespace calendem_test

#endif
