// SPDX-License-Identifier: GPL-2.0-or-later
// A small bank's file, with the recipe and the case that it names.
#ifndef CALENDEM_TESTS_UNIT_BANK_BANK_FILE_H
#define CALENDEM_TESTS_UNIT_BANK_BANK_FILE_H

#include "diagnose/bank/bank_table.h"
#include "support/test_folder.h"
#include <fstream>
#include <string>

namespace calendem_test {

using namespace calendem;

inline const std::string kBank =
    "[bank]\nrecipe = \"electrode.toml\"\ncase = \"case.toml\"\npressures_MPa = "
    "[150, 80]\npackings = 3\nbase_points = 8\neffect_points = 4\n";
inline const std::string kParameters =
    "[[parameter]]\nname = \"E\"\nkeys = [\"case.material.am.youngs_modulus_GPa\"]\nlow = "
    "100\nhigh "
    "= 300\nprior = \"log-uniform\"\n[[parameter]]\nname = \"s\"\nkeys = "
    "[\"case.bond.tensile_strength_MPa\", \"case.bond.shear_strength_MPa\"]\nlow = 300\nhigh = "
    "900\n";

inline std::string write_bank(const std::string &text) {
  const auto folder = test_folder();
  std::ofstream(folder / "electrode.toml") << "[cell]\nx_um = 12\ny_um = 12\n";
  std::ofstream(folder / "case.toml") << "electrode = \"any\"\n";
  std::ofstream(folder / "bank.toml") << text;
  return (folder / "bank.toml").string();
}

inline BankSpec spec_of(const std::string &text) { return read_bank_spec(write_bank(text)); }

} // namespace calendem_test

#endif
