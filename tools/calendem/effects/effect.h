// SPDX-License-Identifier: GPL-2.0-or-later
// The row of an effect: physics, or measurement, that the base model leaves out and that can be
// switched on in the simulation. From it come its keys of the case with their checks, the variables
// and fixes of the input scripts, `calendem effects`, and all that banks and the diagnosis know.
// A row names what it sets: see effects_of_bonds.h.
#ifndef CALENDEM_EFFECTS_EFFECT_H
#define CALENDEM_EFFECTS_EFFECT_H

#include "effects/key.h"
#include "laws/contact_laws.h"
#include "laws/phases.h"
#include "physics/press_instruments.h"
#include <cmath>
#include <string>
#include <utility>
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

/// A setting of the case that an effect moves, and what is known of it before any measurement.
struct EffectParameter {
  std::vector<std::string> keys = {}; ///< of case.toml; all get the same value
  std::string off = "";               ///< the value without the effect: the key's default
  double low = 0.0, high = 0.0;       ///< in the key's unit
  Spread spread = Spread::Uniform;
  AmplitudeScale scale = AmplitudeScale::Difference;
  /// The response grows about as this power of the amplitude; 0: as the logarithm of its ratio to
  /// the weakest of `low` and `high`, where it ends. Chosen by how well emulators predict packings
  /// that are left out.
  double power = 1.0;

  double amplitude(double value) const;
  double value(double amplitude) const;

  EffectParameter &uniform(double from, double to) { return between(Spread::Uniform, from, to); }
  EffectParameter &log_uniform(double from, double to) {
    return between(Spread::LogUniform, from, to);
  }
  EffectParameter &in_reciprocal() { return on(AmplitudeScale::Reciprocal); }
  EffectParameter &in_logarithm() { return on(AmplitudeScale::Logarithm); }
  EffectParameter &with_power(double p) {
    power = p;
    return *this;
  }

private:
  EffectParameter &between(Spread how, double from, double to) {
    spread = how;
    low = from;
    high = to;
    return *this;
  }
  EffectParameter &on(AmplitudeScale s) {
    scale = s;
    return *this;
  }
};

/// A contact law between some phases, with the settings of the effect as its properties, in order.
struct LawBetween {
  const ContactLaw *law = nullptr;
  std::vector<std::pair<Phase, Phase>> between; ///< either way round
};

/// A value in a setting's unit, times this, is in the units of the input scripts (um, us, kPa).
inline double script_units(const std::string &unit) {
  return unit == "GPa" ? 1e6 : unit == "MPa" ? 1e3 : unit == "J/m3" ? 1e-3 : 1.0;
}

/// What two keys of the case may not be together.
struct Relation {
  enum class Is {
    AtMost,  ///< `part` of the other
    NotBoth, ///< above 0
    Needs    ///< above 0 only if the other is
  };
  std::string key;
  Is is;
  std::string other;
  std::string why; ///< what is wrong if they are, and what to give
  double part = 1.0;
};

struct Effect {
  std::string name, layer; ///< contact, bond, coating, boundary, measurement
  std::string what;        ///< one sentence
  /// Keys of its own, the one that `parameter` moves first; none: it moves the base model's.
  std::vector<Key> settings;
  EffectParameter parameter;
  LawBetween contact;                        ///< if it is a law of contacts
  std::string bond_law;                      ///< of fix bond/bpm, which takes the settings in order
  double PressInstruments::*shown = nullptr; ///< what of the press's instruments it sets
  /// Only what the press shows changes: no run of its own is needed to know what it does.
  bool instrument = false;
  /// Its keys are the recipe's, not the case's: another electrode is packed, and pressed alike.
  bool in_recipe = false;
  std::vector<Relation> relations;
  std::string moves; ///< the observables it should move, and how
  std::string source;
  std::string law;          ///< file in src_plugin/physics
  std::string verification; ///< folder of tests/verification, or the unit test where the host has
                            ///< no part in it

  /// A key's name where recipe and case are varied together.
  std::string column(const std::string &key) const {
    return (in_recipe ? "recipe." : "case.") + key;
  }
};

/// Begins a row: its name, its layer, and what it is.
inline Effect effect(const std::string &name, const std::string &layer, const std::string &what) {
  Effect e;
  e.name = name;
  e.layer = layer;
  e.what = what;
  return e;
}

/// The parameter of an effect: keys that exist already, or its own.
inline EffectParameter strength(std::vector<std::string> keys, std::string off) {
  EffectParameter parameter;
  parameter.keys = std::move(keys);
  parameter.off = std::move(off);
  return parameter;
}
inline EffectParameter strength(const Key &key) { return strength({key.name}, key.fallback); }

inline double EffectParameter::amplitude(double value) const {
  switch (scale) {
  case AmplitudeScale::Reciprocal:
    return value > 0.0 ? 1.0 / value : 0.0;
  case AmplitudeScale::Logarithm:
    return std::log(value);
  default:
    return value - std::stod(off);
  }
}

inline double EffectParameter::value(double amplitude) const {
  switch (scale) {
  case AmplitudeScale::Reciprocal:
    return amplitude > 0.0 ? 1.0 / amplitude : 0.0;
  case AmplitudeScale::Logarithm:
    return std::exp(amplitude);
  default:
    return amplitude + std::stod(off);
  }
}

} // namespace calendem

#endif
