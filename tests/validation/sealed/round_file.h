// SPDX-License-Identifier: GPL-2.0-or-later
// A round of the sealed check (round.toml): how many truths of which kind, how well they are
// measured.
//   [round]
//   name = "round 1"
//   bank = "../bank/bank.toml"       # relative to this file
//   null_packings = 12               # nothing is left out of the base model
//   null_draws = 100                 # of noise, over these packings
//   samples = 4                      # of one truth, each as large as the bank's cell; their means
//                                    # are handed out. [2, 2, 10]: truths get these in turn
//   shared_samples = "yes"           # truths with a cause are pressed on the samples of the nulls, in turn, by their
//                                    # press and with their base parameters: one run without a cause serves them all
//   repeats = 4                      # specimens at each pressure, each of samples of its own
//   amplitudes = 3                   # truths of every effect of the bank, each in its own part of
//                                    # the prior
//   open = ["cohesion"]              # changes that are no effect of the table (hidden_changes.cpp)
//   pairs = ["friction + pre_cracks"]
//   faults = ["thickness_zero", "noise"]          # noise: the errors stated are too small
//   other_numerics = ["half_time_step + friction"] # truths from another resolution
//   interventions = ["friction", "nothing"]       # experiments in pairs, before and after a change
//   interventions_on = "other specimens"          # or "the same specimens"
//   [noise]                          # standard deviations of what is handed out
//   pressure_percent = 1             # of the press's calibration, one for all pressures
//   displacement_um = 0.02
//   thickness_um = 0.05
//   porosity_percent = 0.3
//   cracked_fraction = 0.03
//   understated_by = [2.5, 4]        # in the fault "noise"
#ifndef CALENDEM_TESTS_VALIDATION_SEALED_ROUND_FILE_H
#define CALENDEM_TESTS_VALIDATION_SEALED_ROUND_FILE_H

#include "diagnose/bank/bank_spec.h"
#include "diagnose/measured_runs.h"
#include <string>
#include <vector>

namespace calendem {

struct Round {
  std::string file, name;
  BankSpec bank;
  int null_packings = 12, null_draws = 100, amplitudes = 3, repeats = 1;
  std::vector<int> samples = {1};      ///< truths get these in turn
  bool disc_for_each_pressure = false; ///< as on a press: packings of its own for each pressure
  bool shared_samples =
      false; ///< truths with a cause are pressed on the samples of the nulls, in turn
  bool paired_runs = false; ///< truths are run without their effects too: their gap is known then
  /// Each a list of names: effects of the bank, hidden changes, "noise".
  std::vector<std::vector<std::string>> open, pairs, faults, other_numerics;
  std::vector<std::vector<std::string>> interventions; ///< "nothing" instead of "noise"
  bool same_specimens_after = false; ///< of an intervention: those that were pressed before it
  MeasurementNoise noise;
  double least_understated = 2.5, most_understated = 4.0; ///< factors of the fault "noise"
};

/// The block of experiments in pairs, and what an intervention without any change is called.
inline constexpr char kIntervention[] = "intervention", kNothing[] = "nothing";

/// Throws Failure(2) with every mistake of the file, or of the bank that it names.
Round read_round(const std::string &file);

/// "a + b" as a list of names, and back.
std::vector<std::string> names_in(const std::string &joined);
std::string joined(const std::vector<std::string> &names);

// What only the maker of truths can do: changes that are no effect of the table, so that no
// diagnosis can name them, and other numerics.

struct ChangedKey {
  std::string key;   ///< "case.…" or "recipe.…"
  std::string value; ///< empty: what stands there times `factor`
  double factor = 1.0;
};

struct HiddenChange {
  std::string name, what;
  std::vector<ChangedKey> keys = {};
  bool numerics = false; ///< the physics is the same: the right answer is not changed by it
  PressErrors press = {};
};

const std::vector<HiddenChange> &hidden_changes();

/// nullptr: there is none of that name.
const HiddenChange *find_hidden(const std::string &name);

} // namespace calendem

#endif
