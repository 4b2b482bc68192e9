// SPDX-License-Identifier: GPL-2.0-or-later
#include "effects/effects.h"
#include "spec/key.h"
#include "spec/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {

double EffectParameter::amplitude(double value) const {
  switch (scale) {
  case AmplitudeScale::Reciprocal:
    return value > 0.0 ? 1.0 / value : 0.0;
  case AmplitudeScale::Logarithm:
    return std::log(value);
  default:
    return value - std::stod(off);
  }
}

double EffectParameter::value(double amplitude) const {
  switch (scale) {
  case AmplitudeScale::Reciprocal:
    return amplitude > 0.0 ? 1.0 / amplitude : 0.0;
  case AmplitudeScale::Logarithm:
    return std::exp(amplitude);
  default:
    return amplitude + std::stod(off);
  }
}

const std::vector<Effect> &effects() {
  static const std::vector<Effect> table = {
      {"friction",
       "contact",
       "Coulomb friction between particles at a physical level",
       {{"material.am.friction", "material.cbd.friction"},
        "0.001",
        0.05,
        0.6,
        Spread::Uniform,
        AmplitudeScale::Difference,
        0.7},
       false,
       "more pressure from 1 to 30 MPa on, more hysteresis, a gradient through the thickness",
       "public calendering decks use 0.001; 0.3-0.6 is usual for dry mineral grains",
       "hertz_contact.h",
       "collision"},
      {"nmc_plasticity",
       "contact",
       "contacts of primaries yield at a limiting pressure: elastic-plastic, stiff unloading",
       {{"effects.nmc_plasticity.yield_pressure_GPa"},
        "0",
        1.5,
        12,
        Spread::LogUniform,
        AmplitudeScale::Reciprocal,
        0.0},
       false,
       "lower pressure above some 50 MPa, steeper unloading, no more breaks",
       "Thornton 1997; hardness of NMC grains 1-12 GPa is an unsourced prior",
       "plastic_contact.h",
       "plastic_contact"},
      {"cbd_collapse",
       "contact",
       "nanopores of the carbon-binder domain collapse under pressure and stay so",
       {{"effects.cbd_collapse.yield_pressure_MPa"},
        "0",
        5,
        300,
        Spread::LogUniform,
        AmplitudeScale::Reciprocal,
        0.0},
       false,
       "total porosity falls by some points at a given pressure, and does not come back",
       "Heckel 1961; from 50 % to 27 % nanoporosity as Xu et al. impose it",
       "nanopore_collapse.h",
       "nanopore_collapse"},
      {"cbd_viscoelasticity",
       "contact",
       "contacts with the carbon-binder domain relax (Prony series of one term)",
       {{"effects.cbd_viscoelasticity.relaxed_fraction"},
        "0",
        0.05,
        0.35,
        Spread::Uniform,
        AmplitudeScale::Difference},
       false,
       "pressure depends on speed and decays in a dwell; springback is delayed",
       "Christensen, Theory of Viscoelasticity, ch. 1",
       "viscous_contact.h",
       "viscous_contact"},
      {"collector_indentation",
       "boundary",
       "primaries press into the collector's foil beyond a limiting pressure",
       {{"effects.collector_indentation.yield_pressure_GPa"},
        "0",
        0.1,
        1.5,
        Spread::LogUniform,
        AmplitudeScale::Reciprocal},
       false,
       "a lasting offset of some tenths of a micrometre; fewer breaks near the collector",
       "Thornton 1997; some three times the yield stress of an aluminium foil, an unsourced prior",
       "plastic_contact.h",
       "plastic_contact"},
      {"weibull_strength",
       "bond",
       "strength of bonds scattered by a Weibull law of the same mean",
       {{"bond.weibull_modulus"}, "0", 1.5, 10, Spread::LogUniform, AmplitudeScale::Reciprocal},
       false,
       "breaks begin earlier and spread over more of the curve; porosity hardly changes",
       "Weibull 1951; a modulus of 3-8 is an unsourced prior for NMC, widened here",
       "weibull_strength.h",
       "strength"},
      {"pre_cracks",
       "bond",
       "a fraction of the bonds has no strength from the start",
       {{"effects.pre_cracks.fraction"},
        "0",
        0.02,
        0.5,
        Spread::LogUniform,
        AmplitudeScale::Difference},
       false,
       "weaker bodies from the first load on: lower pressure at a displacement, more cracked "
       "bodies",
       "a random choice of bonds; tomograms show pores and cracks in NMC, an unsourced prior",
       "pre_cracks.h",
       "strength"},
      {"machine_compliance",
       "boundary",
       "frame and rolls give way in proportion to the pressure",
       {{"effects.machine_compliance.um_per_MPa"},
        "0",
        0.005,
        0.2,
        Spread::LogUniform,
        AmplitudeScale::Difference},
       true,
       "displacement shown grows with pressure on both ways; thickness after relaxation does not",
       "Oliver & Pharr 1992: frame and sample as springs in series; an unsourced prior",
       "press_instruments.h",
       "platen"},
      {"pressure_calibration",
       "measurement",
       "the pressure shown is the pressure times a factor",
       {{"effects.pressure_calibration.factor"},
        "1",
        0.6,
        1.6,
        Spread::LogUniform,
        AmplitudeScale::Logarithm},
       false,
       "stretches the pressure axis of every curve, and nothing else",
       "pressures converted from a roll gap: 10-25 % systematic is plausible; unsourced, widened "
       "here",
       "press_instruments.h",
       "unit/physics"},
      {"thickness_zero",
       "measurement",
       "the thickness shown is off by a constant",
       {{"effects.thickness_zero.offset_um"},
        "0",
        -6,
        6,
        Spread::Uniform,
        AmplitudeScale::Difference},
       true,
       "the same shift of every thickness and its porosity, at any pressure",
       "micrometre zero, foil thickness; table 1 states 0.8 um between samples",
       "press_instruments.h",
       "unit/physics"},
  };
  return table;
}

const Effect &find_effect(const std::string &name) {
  const auto at = std::find_if(effects().begin(), effects().end(),
                               [&](const Effect &e) { return e.name == name; });
  if (at != effects().end())
    return *at;
  std::vector<std::string> names;
  for (const Effect &e : effects())
    names.push_back(e.name);
  throw Failure(kBadInput, fmt::format("there is no effect '{}'. Did you mean '{}'? Known are {}.",
                                       name, closest(name, names), fmt::join(names, ", ")));
}

nlohmann::json to_json(const Effect &e) {
  const EffectParameter &a = e.parameter;
  return {{"name", e.name},
          {"layer", e.layer},
          {"what", e.what},
          {"keys", a.keys},
          {"off", a.off},
          {"low", a.low},
          {"high", a.high},
          {"prior", a.spread == Spread::Uniform ? "uniform" : "log-uniform"},
          {"stronger_when", a.scale == AmplitudeScale::Reciprocal ? "smaller" : "larger"},
          {"simulated", !e.instrument},
          {"moves", e.moves},
          {"source", e.source},
          {"law", "src_plugin/physics/" + e.law},
          {"verification", e.verification}};
}

} // namespace calendem
