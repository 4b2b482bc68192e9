// SPDX-License-Identifier: GPL-2.0-or-later
// The effects: physics, or measurement, that the base model leaves out and that can be switched on
// in the simulation. One row of the table for each; `calendem effects` prints it, the diagnosis
// reads it.
#ifndef CALENDEM_EFFECTS_EFFECTS_H
#define CALENDEM_EFFECTS_EFFECTS_H

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace calendem {

/// How an effect's strength is spread before anything is measured, between `low` and `high`.
enum class Spread { Uniform, LogUniform };

/// The amplitude of an effect as a function of its key's value v; 0 when the effect is off.
enum class AmplitudeScale {
  Difference, ///< v - off
  Reciprocal, ///< 1/v, off: key 0
  Logarithm   ///< ln v, off: key 1
};

/// A setting of the case that an effect moves.
struct EffectParameter {
  std::vector<std::string> keys; ///< of case.toml; all get the same value
  std::string off;               ///< the value without the effect: the key's default
  double low = 0.0, high = 0.0;  ///< in the key's unit
  Spread spread = Spread::Uniform;
  AmplitudeScale scale = AmplitudeScale::Difference;
  /// What the effect does grows about with this power of the amplitude; 0: with the logarithm of
  /// its ratio to the weakest of `low` and `high`, where it ceases. Chosen by how well emulators
  /// foretell packings that are left out.
  double power = 1.0;

  double amplitude(double value) const;
  double value(double amplitude) const;
};

struct Effect {
  std::string name, layer; ///< contact, bond, boundary, measurement
  std::string what;        ///< one sentence
  EffectParameter parameter;
  /// Only what the press shows changes: no run of its own is needed to know what it does.
  bool instrument = false;
  std::string moves; ///< the observables it should move, and how
  std::string source;
  std::string law;          ///< file in src_plugin/physics
  std::string verification; ///< folder of tests/verification, or the unit test where the host has
                            ///< no part in it
};

const std::vector<Effect> &effects();

/// Throws Failure(2) with the names there are.
const Effect &find_effect(const std::string &name);

nlohmann::json to_json(const Effect &effect);

} // namespace calendem

#endif
