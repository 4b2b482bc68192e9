// SPDX-License-Identifier: GPL-2.0-or-later
// What a bank of simulations is made of (bank.toml):
//   [bank]
//   name = "small cells"
//   recipe = "electrode.toml"        # paths are relative to this file
//   case = "case.toml"
//   pressures_MPa = [80, 150]        # a run for each at every point
//   packings = 12                    # seeds 1, 2, ... of the recipe
//   base_points = 48                 # of the base parameters, without effects
//   effect_points = 24               # of every effect, each beside a base point's run
//   effects = ["friction"]           # default: all
//   seed = 1                         # of the design
//   first_point = 0                  # number of the first base point, where tables are joined
//   tortuosity = "yes"               # of the pores after release; default: no
//   nanoporosity_within_points = 10  # how far that of CBD may lie from the recipe's; default: 0
//   further_table = "further.csv"    # more of its runs than the table beside this file has
//   chosen_points = "chosen.csv"     # more points of effects, chosen for an experiment
//   crushing = "crushing.csv"        # loads of single particles, for calibrate; default: none
//   [[parameter]]                    # of the base model, recalibrated by the diagnosis
//   name = "E_am"
//   keys = ["case.material.am.youngs_modulus_GPa"]
//   low = 100
//   high = 300
//   prior = "log-uniform"            # or "uniform"
//   [[effect]]                       # optional, of one effect:
//   name = "friction"
//   low = 0.1                        # another range, in its key's unit
//   high = 0.4
//   points = 32                      # another number of points
//   [full_cell]                      # optional: what the bank's small cell does to the observables
//   recipe = "../demo/electrode.toml"
//   case = "case.toml"
//   points = 3                       # base points that are run on that cell too
//   other_electrode = "yes"          # not a larger cell but another electrode, for which the bank
//                                    # then stands; default: no
//   [[measurement]]                  # optional: what a further measurement costs
//   name = "cracked_bodies"          # of usual_prices()
//   hours = 8                        # of work for one sample
//   sd = 0.05                        # of the result
//   [[pressing]]                     # optional: some of the points run to further pressures,
//   name = "again"                   # or, with a name, pressed in another way
//   what = "pressed twice"           # of a name: in words
//   settings = { "platen.presses" = 2 }  # of a name: keys of the case
//   pressures_MPa = [80]
//   base_points = 32                 # the first of them
//   effect_points = 8                # of every effect, the first
//   [[numerics]]                     # optional: an error of the bank's runs, of known size
//   name = "speed"
//   porosity_points = 1.0            # of the porosity under pressure (standard deviation)
#ifndef CALENDEM_DIAGNOSE_BANK_BANK_SPEC_H
#define CALENDEM_DIAGNOSE_BANK_BANK_SPEC_H

#include "base/messages.h"
#include "base/registry.h"
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace calendem {

// Measurements that a laboratory could make next, and what each costs.

struct MeasurementPrice {
  std::string name;   ///< [[measurement]] name in a bank's file
  std::string what;   ///< what is done
  double hours = 0.0; ///< work for one sample
  double sd = 0.0;    ///< standard deviation of the result, in `unit`
  std::string unit;   ///< empty: the bank's table has no such result, so nothing is predicted
};

constexpr const char *kUnloadingCurve = "unloading_curve"; ///< a bank may lack it

/// Hours and deviations are estimates of this project, from no source; a bank's file changes them.
const std::vector<MeasurementPrice> &usual_prices();

struct BankParameter {
  std::string name;
  std::vector<std::string> keys; ///< "case.…" or "recipe.…"; all get the same value
  double low = 0.0, high = 0.0;  ///< in the keys' unit
  Spread spread = Spread::Uniform;
};

/// The cell, or the electrode, that the bank's stands for.
struct FullCell {
  std::string recipe_file, case_file;
  int points = 0;               ///< 0: none
  bool other_electrode = false; ///< its change counts for any loading
};

/// Pressures closer than this share of them are the same.
constexpr double kSamePressure = 0.02;
inline bool same_pressure(double a, double b) { return std::fabs(a - b) <= kSamePressure * b; }

/// How a film is pressed: keys of the case and their values.
using Pressing = std::vector<std::pair<std::string, std::string>>;

/// Runs of the first points of the base model and of each effect to further pressures, or pressed
/// in another way.
struct BankPressing {
  std::string name, what; ///< of the way, and in words; empty: the usual one
  Pressing settings;
  std::vector<double> pressures; ///< MPa, increasing
  int base_points = 0, effect_points = 0;
};

/// A point of an effect that was chosen for what it tells (choose_runs), beside a base point.
struct ChosenRun {
  std::string effect;
  int base_point = 0;
  double value = 0.0; ///< of the effect's key
};

/// An error that all of the bank's runs share: too fast, too small a cell, too coarse.
struct Numerics {
  std::string name;
  double porosity_points = 0.0; ///< standard deviation [%]
};

struct BankSpec {
  std::string file, name, recipe_file, case_file;
  std::vector<double> pressures; ///< MPa, increasing
  int packings = 12, base_points = 48, effect_points = 24;
  unsigned long seed = 1;
  int first_point = 0;     ///< number of the first base point
  bool tortuosity = false; ///< of the pores after release, of every run
  /// How far the nanoporosity of a measured film's CBD may lie from its recipe's [%], to either
  /// side; 0: known. No laboratory measures it.
  double nanoporosity_within = 0.0;
  std::string crushing_file; ///< loads at which single particles broke; empty: none
  std::string further_table; ///< more of its runs, beside the table of its name; empty: none
  std::string chosen_file;   ///< the points in `chosen`; empty: none
  std::vector<BankParameter> parameters;
  std::vector<std::string> effects;
  std::map<std::string, std::pair<double, double>> ranges; ///< of effects, where not the table's
  std::map<std::string, int> points;                       ///< of effects, where not effect_points
  std::vector<ChosenRun> chosen;                           ///< beside the effects' own points
  std::vector<BankPressing> pressings;                     ///< beside the usual one to `pressures`
  FullCell full_cell;
  std::vector<MeasurementPrice> prices = usual_prices();
  std::vector<Numerics> numerics;
};

/// Throws Failure(2) with every mistake of the file. Recipe and case are read when runs are made.
BankSpec read_bank_spec(const std::string &file);

/// The table beside the bank's file, with its name.
std::string table_of(const BankSpec &spec);

/// The way that has this name; null: there is none. The usual one has no name.
const BankPressing *find_pressing(const BankSpec &spec, const std::string &name);

/// How many points the effect has.
int points_of(const BankSpec &spec, const std::string &effect);

/// CSV: effect, base_point, value.
std::string write_chosen(const std::vector<ChosenRun> &chosen);

/// Adds what the file holds to the bank, whose other keys have been read.
void read_chosen(const std::string &file, BankSpec &spec, Mistakes &mistakes);

/// As find_effect, with the bank's range.
Effect effect_of(const BankSpec &spec, const std::string &name);

} // namespace calendem

#endif
