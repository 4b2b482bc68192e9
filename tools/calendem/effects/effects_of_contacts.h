// SPDX-License-Identifier: GPL-2.0-or-later
// Effects at the contacts of particles, with each other and with the walls: a function returns a
// row.
#ifndef CALENDEM_EFFECTS_EFFECTS_OF_CONTACTS_H
#define CALENDEM_EFFECTS_EFFECTS_OF_CONTACTS_H

#include "effects/effect.h"
#include "physics/binder_bridge.h"

namespace calendem {

inline Key hardening(const std::string &key, const std::string &variable) {
  return setting(key, variable, "0")
      .range(0, 1000, "GPa")
      .means("increase of this limit with the plastic overlap divided by the effective radius");
}

/// The contacts of the carbon-binder domain.
inline std::vector<std::pair<Phase, Phase>> all_of_cbd() {
  return {{Phase::Am, Phase::Cbd},
          {Phase::Cbd, Phase::Cbd},
          {Phase::Cbd, Phase::Collector},
          {Phase::Cbd, Phase::Platen}};
}

inline Effect friction() {
  Effect e =
      effect("friction", "contact", "Coulomb friction between particles at a realistic level");
  e.parameter = strength({"material.am.friction", "material.cbd.friction"}, "0.001")
                    .uniform(0.05, 0.6)
                    .with_power(0.7);
  e.moves =
      "higher pressure from 1 to 30 MPa on, more hysteresis, a gradient through the thickness";
  e.source = "public calendering scripts use 0.001; 0.3-0.6 is usual for dry mineral grains";
  e.law = "hertz_mindlin.h";
  e.verification = "collision";
  return e;
}

inline Effect nmc_plasticity() {
  Effect e = effect(
      "nmc_plasticity", "contact",
      "contacts of primaries yield at a limiting pressure: elastic-plastic, with stiff unloading");
  e.settings = {
      number("effects.nmc_plasticity.yield_pressure_GPa", "nmc_yield_GPa", "0", 0, 1000, "GPa",
             "limit of the contact pressure between bodies and at the platen; 0: elastic"),
      hardening("effects.nmc_plasticity.hardening_GPa", "nmc_yield_hardening_GPa")};
  e.parameter = strength(e.settings[0]).log_uniform(1.5, 12).in_reciprocal().with_power(0);
  e.contact = {&kContactLaw<PlasticContact>, {{Phase::Am, Phase::Am}, {Phase::Am, Phase::Platen}}};
  e.moves = "lower pressure above about 50 MPa, steeper unloading, fewer cracked particles";
  e.source = "Thornton 1997; the range is an unsourced prior; indented, NMC532 has a hardness of "
             "8.6 +- 1.3 GPa (Xu et al., J. Electrochem. Soc. 164 (2017) A3333)";
  e.law = PlasticContact::kHeader;
  e.verification = "plastic_contact";
  return e;
}

inline Effect cbd_collapse() {
  Effect e = effect("cbd_collapse", "contact",
                    "nanopores of the carbon-binder domain collapse permanently under pressure");
  const std::string at = "effects.cbd_collapse.";
  e.settings = {
      number(at + "yield_pressure_MPa", "cbd_yield_MPa", "0", 0, 1e5, "MPa",
             "mean pressure on a CBD sphere at which its nanopores begin to collapse; 0: never"),
      number(at + "hardening_MPa", "cbd_hardening_MPa", "50", 0.1, 1e5, "MPa",
             "pressure scale of the decrease above the yield pressure"),
      number(at + "initial_nanoporosity", "cbd_initial_phi", "0.5", 0, 0.95, "fraction",
             "nanoporosity at the start; must agree with the recipe's cbd.nanoporosity_percent"),
      number(at + "floor_nanoporosity", "cbd_floor_phi", "0.27", 0, 0.95, "fraction",
             "lower limit of the nanoporosity"),
      number(at + "relaxation_us", "cbd_collapse_us", "0.1", 1e-3, 1e3, "us",
             "time constant with which nanopores follow their pressure; a few transits of a "
             "pressure wave"),
      setting(at + "every_steps", "cbd_collapse_steps", "50")
          .range(1, 1e6, "steps")
          .is_whole()
          .means("steps between updates of the nanopores")};
  e.parameter = strength(e.settings[0]).log_uniform(5, 300).in_reciprocal().with_power(0);
  e.relations = {{at + "floor_nanoporosity", Relation::Is::AtMost, at + "initial_nanoporosity",
                  "pores would open under pressure"},
                 {"imposed.cbd_nanoporosity_until_MPa", Relation::Is::NotBoth,
                  at + "yield_pressure_MPa",
                  "nanoporosity follows either the pressure of each sphere or the platen's"}};
  e.moves = "total porosity falls by a few points at a given pressure, and does not recover";
  e.source = "Heckel 1961; from 50 % to 27 % nanoporosity as Xu et al. impose it";
  e.law = "nanopore_collapse.h";
  e.verification = "nanopore_collapse";
  return e;
}

inline Effect cbd_viscoelasticity() {
  Effect e = effect("cbd_viscoelasticity", "contact",
                    "contacts with the carbon-binder domain relax (Prony series of one term)");
  e.settings = {
      number("effects.cbd_viscoelasticity.relaxed_fraction", "cbd_relaxed_fraction", "0", 0, 0.95,
             "fraction", "fraction of the stiffness of contacts with CBD that relaxes; 0: elastic"),
      number("effects.cbd_viscoelasticity.time_us", "cbd_relaxation_us", "1", 1e-3, 1e6, "us",
             "relaxation time, in the time of the simulation, see platen.speed_m_s")};
  e.parameter = strength(e.settings[0]).uniform(0.05, 0.35);
  e.contact = {&kContactLaw<ViscousContact>, all_of_cbd()};
  e.moves = "pressure depends on speed and decays during a dwell; springback is delayed";
  e.source = "Christensen, Theory of Viscoelasticity, ch. 1";
  e.law = ViscousContact::kHeader;
  e.verification = "viscous_contact";
  return e;
}

inline Effect cbd_plasticity() {
  Effect e =
      effect("cbd_plasticity", "contact",
             "contacts with the carbon-binder domain yield at a limiting pressure, and may harden");
  const std::string at = "effects.cbd_plasticity.";
  e.settings = {
      number(at + "yield_pressure_GPa", "cbd_contact_yield_GPa", "0", 0, 1000, "GPa",
             "limit of the contact pressure of CBD on all phases and walls; 0: elastic"),
      hardening(at + "hardening_GPa", "cbd_contact_hardening_GPa"),
      number(
          at + "beyond_cohesion", "cbd_beyond_cohesion", "0", 0, 1, "fraction",
          "how much of the pressure of cohesion, 2 c_CED, comes on top of the limit; 0: none, the "
          "limit is of the whole contact pressure; 1: all of it, as for an indenter that does "
          "not stick"),
      number(at + "flattening", "cbd_flattening", "1", 0, 1, "fraction",
             "how a sphere's contact with a wall widens as it gets deep; 1: as the sphere's volume "
             "demands; 0: no more than a shallow one's, so that it may sink through")};
  e.parameter = strength(e.settings[0]).log_uniform(0.55, 3).in_reciprocal().with_power(0);
  e.contact = {&kContactLaw<PlasticContact>, all_of_cbd()};
  e.moves =
      "lower pressure and less springback where CBD carries load; because of the cohesion between "
      "AM and CBD the yield pressure cannot be below 0.5 GPa, or 0.1 GPa beyond cohesion";
  e.source = "Thornton 1997; the range is what cohesion allows, an unsourced prior; indented, a "
             "matrix of carbon black and PVdF has a hardness of 0.043 +- 0.010 GPa (Xu et al., J. "
             "Electrochem. Soc. 164 (2017) A3333)";
  e.law = PlasticContact::kHeader;
  e.verification = "plastic_contact";
  return e;
}

inline Effect cbd_ductility() {
  Effect e = effect("cbd_ductility", "contact",
                    "carbon-binder domain flows at its hardness, keeps its volume, and resists "
                    "with its bulk modulus once it has filled its surroundings");
  const std::string at = "effects.cbd_ductility.";
  e.settings = {
      number(at + "hardness_GPa", "cbd_hardness_GPa", "0", 0, 1000, "GPa",
             "indentation hardness of CBD, at its contacts with all phases and walls; 0: elastic"),
      number(at + "bulk_modulus_GPa", "cbd_full_GPa", "1.7", 1e-3, 1000, "GPa",
             "bulk modulus of a sphere without free surface; 1.7: E/3(1 - 2 nu) of 2 GPa and nu = "
             "0.3"),
      number(at + "beyond_cohesion", "cbd_hardness_beyond_cohesion", "1", 0, 1, "fraction",
             "part of the pressure of cohesion that comes on top of the hardness; 1: an indenter "
             "that does not stick has measured it")};
  e.parameter = strength(e.settings[0]).log_uniform(0.02, 0.4).in_reciprocal().with_power(0);
  e.contact = {&kContactLaw<DuctileContact>, all_of_cbd()};
  e.moves = "lower pressure where CBD carries load, until it has filled its pores, and little "
            "springback";
  e.source =
      "Zunker & Kamrin 2024 (MDR); indented, a matrix of carbon black and PVdF has a hardness "
      "of 0.043 +- 0.010 GPa (Xu et al., J. Electrochem. Soc. 164 (2017) A3333); the range "
      "is from half of it to ten times it, an unsourced prior";
  e.law = DuctileContact::kHeader;
  e.verification = "ductile_contact";
  return e;
}

/// Contacts at large overlap; `most`, `least`: of the prior [GPa].
inline Effect confinement(const std::string &phase, const std::string &what, double least,
                          double most) {
  Effect e = effect(phase + "_confinement", "contact", what);
  const std::string at = "effects." + e.name + ".";
  e.settings = {
      number(at + "bulk_modulus_GPa", phase + "_bulk_GPa", "0", 0, 1000, "GPa",
             "bulk modulus of a sphere confined by its contacts; 0: Hertz at any overlap"),
      number(at + "free_surface", phase + "_free_surface", "0.5", 0.01, 0.99, "fraction",
             "free fraction of the sphere's surface at which its bulk begins to resist")};
  e.parameter = strength(e.settings[0]).log_uniform(least, most);
  e.moves =
      "higher pressure at high density, where overlaps are large, and more springback from there";
  e.source = "Zunker & Kamrin 2024 (MDR, part II); from the bulk modulus of a half-porous solid to "
             "that of the solid, an unsourced prior";
  e.law = ConfinedContact::kHeader;
  e.verification = "confined_contact";
  return e;
}

inline Effect cbd_confinement() {
  Effect e = confinement("cbd",
                         "carbon-binder domain confined by its contacts resists with its bulk "
                         "modulus, beyond the range of Hertz",
                         0.5, 35);
  e.contact = {&kContactLaw<ConfinedContact>, all_of_cbd()};
  return e;
}

inline Effect nmc_confinement() {
  Effect e = confinement("nmc",
                         "primaries confined by their contacts resist with their bulk modulus, "
                         "beyond the range of Hertz",
                         20, 200);
  e.contact = {&kContactLaw<ConfinedContact>, {{Phase::Am, Phase::Am}, {Phase::Am, Phase::Platen}}};
  return e;
}

inline Effect collector_indentation() {
  Effect e = effect("collector_indentation", "boundary",
                    "primaries indent the collector above a limiting pressure");
  e.settings = {number("effects.collector_indentation.yield_pressure_GPa", "collector_yield_GPa",
                       "0", 0, 1000, "GPa",
                       "limit of the contact pressure of bodies on the collector; 0: elastic")};
  e.parameter = strength(e.settings[0]).log_uniform(0.1, 1.5).in_reciprocal();
  e.contact = {&kContactLaw<PlasticContact>, {{Phase::Am, Phase::Collector}}};
  e.moves = "a permanent offset of some tenths of a micrometre; fewer breaks near the collector";
  e.source =
      "Thornton 1997; about three times the yield stress of an aluminium foil, an unsourced prior";
  e.law = PlasticContact::kHeader;
  e.verification = "plastic_contact";
  return e;
}

inline Key bridge_strength(const std::string &phase, const std::string &meaning) {
  return setting("effects.binder_bridges." + phase + "_strength_MPa", "bridge_" + phase + "_MPa")
      .follows("effects.binder_bridges.strength_MPa")
      .range(0, 1000, "MPa")
      .means(meaning);
}

inline Effect binder_bridges() {
  Effect e = effect(
      "binder_bridges", "contact",
      "the binder connects CBD to CBD, active material and collector by bonds that can break");
  const std::string at = "effects.binder_bridges.";
  e.settings = {
      number(at + "strength_MPa", "bridge_MPa", "0", 0, 1000, "MPa",
             "tensile strength of bridges from CBD to CBD; 0: none"),
      bridge_strength("am", "tensile strength of bridges from CBD to active material"),
      bridge_strength("collector", "tensile strength of bridges from CBD to the collector"),
      number(at + "shear_ratio", "bridge_shear_ratio", "2", 0.1, 10, "",
             "shear strength divided by tensile strength of a bridge"),
      number(at + "modulus_GPa", "bridge_GPa", "1", 0.01, 100, "GPa", "modulus of a bridge"),
      number(at + "radius_ratio", "bridge_radius_ratio", "0.5", 0.05, 1.5, "",
             "radius of a bridge divided by the smaller radius of its spheres (on the collector, "
             "by that of the sphere)"),
      number(at + "gap_um", "bridge_gap_um", "0.02", 0, BinderBridges::kMostGap, "um",
             "largest gap between spheres that is bridged at the start")};
  e.parameter = strength(e.settings[0]).log_uniform(1, 25);
  for (const char *key : {"strength_MPa", "am_strength_MPa", "collector_strength_MPa"}) {
    e.relations.push_back({at + key, Relation::Is::AtMost, at + "modulus_GPa",
                           "bridges would stretch too far before they break",
                           BinderBridges::kMostStrain});
    for (const char *shrinks :
         {"effects.cbd_collapse.yield_pressure_MPa", "imposed.cbd_nanoporosity_until_MPa"})
      e.relations.push_back({at + key, Relation::Is::NotBoth, shrinks,
                             "a bridge keeps its length while its spheres would shrink"});
  }
  e.moves = "stiffer film below about 20 MPa, and less springback; the only tensile and adhesive "
            "strength of the coating if cohesion is 0";
  e.source = "Potyondy & Cundall 2004; shear over tensile strength: Luo et al. 2018, of a coating "
             "on its foil; strength below 0.2 GPa, a third of the hardness of the binder phase "
             "(Iyer et al. 2023, doi:10.1016/j.msea.2023.145352), and below 0.1 of the modulus "
             "(Chen et al. 2003), within that unsourced priors";
  e.law = "binder_bridge.h";
  e.verification = "binder_bridges";
  return e;
}

inline std::vector<Effect> effects_of_contacts() {
  return {friction(),
          nmc_plasticity(),
          cbd_collapse(),
          cbd_viscoelasticity(),
          cbd_plasticity(),
          cbd_ductility(),
          cbd_confinement(),
          nmc_confinement(),
          collector_indentation(),
          binder_bridges()};
}

} // namespace calendem

#endif
