// SPDX-License-Identifier: GPL-2.0-or-later
// What a bank of simulations is made of (bank.toml):
//   [bank]
//   name = "films of NMC111"
//   recipe = "electrode.toml"        # paths are relative to this file
//   case = "case.toml"               # its presses are the bank's pressures
//   points = 600                     # one run each, through all presses
//   packings = 24                    # seeds 1, 2, ... of the recipe
//   seed = 1                         # of the design
//   faults = ["thickness_zero"]      # of the press: computed from the runs
//   nanoporosity_within_points = 10  # how far that of CBD may lie from the recipe's; default: 0
//   crushing = "crushing.csv"        # loads of single particles; default: none
//   [[input]]                        # of the film ("recipe.…") or of the material ("case.…")
//   name = "E_cbd_GPa"
//   keys = ["case.material.cbd.youngs_modulus_GPa"]
//   low = 1.6
//   high = 4
//   prior = "log-uniform"            # or "uniform"
//   [[effect]]                       # acts in a share of the points
//   name = "friction"
//   share = 0.8
//   low = 0.05                       # optional: another range, in its key's unit
//   high = 0.6
//   [larger_cell]                    # optional: a second cell
//   share = 0.07                     # of the points
//   recipe = { "cell.x_um" = 12 }    # its keys
//   [[numerics]]                     # optional: an error that all runs share
//   name = "speed"
//   porosity_points = 0.4            # standard deviation
#ifndef CALENDEM_BANK_BANK_FILE_H
#define CALENDEM_BANK_BANK_FILE_H

#include "bank/design.h"
#include "simulate/study_file.h"

namespace calendem::bank {

/// An error that all of the bank's runs share: too fast, too coarse.
struct Numerics {
  std::string name;
  double porosity_points = 0.0; ///< standard deviation [%]
};

struct Bank {
  std::string file, name, recipe_file, case_file;
  Design design;
  std::vector<std::string> faults;  ///< effects that are the press's: no run of their own
  double nanoporosity_within = 0.0; ///< [%], to either side of a recipe's; 0: known
  std::string crushing_file;        ///< empty: none
  std::vector<Numerics> numerics;
};

/// Throws Failure(2) with every mistake of the file. Recipe and case are read when runs are made.
Bank read_bank(const std::string &file);

/// The table beside the bank's file, with its name.
std::string table_of(const Bank &bank);

/// A run of the bank's recipe and case for each row. Throws Failure(2) where values are no values of
/// their keys or contradict each other.
Study study_of(const Bank &bank, const Columns &columns);
Study study_of(const Bank &bank, const std::vector<Point> &points);

} // namespace calendem::bank

#endif
