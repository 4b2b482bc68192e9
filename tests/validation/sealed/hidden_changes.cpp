// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed/round_file.h"

namespace calendem {

namespace {

using Keys = std::vector<std::string>;

HiddenChange scaled(const char *name, const char *what, const Keys &keys, double factor) {
  HiddenChange h{name, what};
  for (const std::string &key : keys)
    h.keys.push_back({key, "", factor});
  return h;
}

HiddenChange set(const char *name, const char *what, std::vector<ChangedKey> keys) {
  HiddenChange h{name, what};
  h.keys = std::move(keys);
  return h;
}

HiddenChange shown_otherwise(const char *name, const char *what, double PressErrors::*by,
                             double size) {
  HiddenChange h{name, what};
  h.press.*by = size;
  return h;
}

HiddenChange numerics(HiddenChange h) {
  h.numerics = true;
  return h;
}

using Changes = std::vector<HiddenChange>;

Changes of_bonds_and_contacts() {
  return {
      set("unsigned_criterion", "bonds under compression break as under tension",
          {{"case.bond.criterion", "unsigned"}}),
      scaled("weak_in_shear", "bonds are weaker in shear than in tension",
             {"case.bond.shear_strength_MPa"}, 0.4),
      scaled("cohesion", "a tenth of the cohesion energy density of both phases",
             {"case.material.am.ced_J_m3", "case.material.cbd.ced_J_m3"}, 0.1),
      scaled("thin_bonds", "bonds of 0.7 of the primaries' radius", {"case.bond.radius_ratio"},
             0.7),
      scaled("compressible_binder", "carbon-binder domain that gives way sideways less",
             {"case.material.cbd.poisson"}, 0.4),
      scaled("strong_in_shear", "bonds are stronger in shear than in tension",
             {"case.bond.shear_strength_MPa"}, 2.5),
      scaled("thick_bonds", "bonds of 1.3 of the primaries' radius", {"case.bond.radius_ratio"},
             1.3),
      set("close_fragments", "separated primaries touch at the spacing of their lattice",
          {{"case.bond.contact_diameter", "lattice"}}),
      set("unbreakable", "bodies that do not break", {{"case.bond.breakable", "no"}}),
      set("lively_contacts", "contacts that lose little energy",
          {{"case.material.am.restitution", "0.9"}, {"case.material.cbd.restitution", "0.9"}}),
      scaled("sticky_binder", "carbon-binder domain of 1.4 times the cohesion energy density",
             {"case.material.cbd.ced_J_m3"}, 1.4),
      set("drying_stress", "bridges of binder that shrank as they dried",
          {{"case.effects.binder_bridges.strength_MPa", "30"},
           {"case.effects.drying_stress.shrinkage", "0.02"}}),
      set("smooth_collector", "a collector on which particles slide",
          {{"case.material.collector.friction", "0.05"}}),
      set("imprinted_collector", "a collector that particles press into for good",
          {{"case.effects.collector_indentation.yield_pressure_GPa", "1.5"}}),
      set("soft_bonds", "bonds far softer than the particles",
          {{"case.bond.youngs_modulus_GPa", "30"}}),
      scaled("sticky_particles", "active material of 1.8 times the cohesion energy density",
             {"case.material.am.ced_J_m3"}, 1.8),
  };
}

Changes of_the_coating() {
  return {
      scaled("narrow_sizes", "secondary particles of nearly one size",
             {"recipe.particles.sigma_ln"}, 0.4),
      scaled("coarse_sizes", "secondary particles larger than the recipe says",
             {"recipe.particles.median_um"}, 1.3),
      scaled("irregular_bodies", "bodies of a rougher outline", {"recipe.particles.irregularity"},
             3.0),
      scaled("denser_coating", "an initial porosity lower than the recipe says",
             {"recipe.coating.porosity_total_percent"}, 0.9),
      set("more_binder", "three times the carbon and binder that the recipe says",
          {{"recipe.composition.am_weight_percent", "88"},
           {"recipe.composition.carbon_weight_percent", "6"},
           {"recipe.composition.binder_weight_percent", "6"}}),
      set("binder_gradient", "carbon-binder domain at the surface",
          {{"recipe.effects.cbd_gradient.slope", "0.8"}}),
      scaled("dense_binder", "fewer nanopores than the recipe says",
             {"recipe.cbd.nanoporosity_percent"}, 0.6),
      scaled("large_binder", "larger spheres of carbon-binder domain", {"recipe.cbd.diameter_um"},
             1.4),
      scaled("wide_sizes", "secondary particles of more different sizes",
             {"recipe.particles.sigma_ln"}, 1.4),
      set("no_fines", "a powder without fine particles", {{"recipe.particles.min_um", "3"}}),
      set("no_coarse", "a powder without large particles", {{"recipe.particles.max_um", "5"}}),
      scaled("looser_coating", "an initial porosity higher than the recipe says",
             {"recipe.coating.porosity_total_percent"}, 1.06),
      set("less_binder", "half the carbon and binder that the recipe says",
          {{"recipe.composition.am_weight_percent", "98"},
           {"recipe.composition.carbon_weight_percent", "1"},
           {"recipe.composition.binder_weight_percent", "1"}}),
      scaled("porous_binder", "more nanopores than the recipe says",
             {"recipe.cbd.nanoporosity_percent"}, 1.2),
      scaled("small_binder", "smaller spheres of carbon-binder domain", {"recipe.cbd.diameter_um"},
             0.8),
      scaled("light_powder", "active material of closed pores, lighter than the recipe says",
             {"recipe.density.am_g_cm3"}, 0.93),
      scaled("heavy_powder", "active material heavier than the recipe says",
             {"recipe.density.am_g_cm3"}, 1.05),
      scaled("fine_particles", "secondary particles smaller than the recipe says",
             {"recipe.particles.median_um"}, 0.75),
      set("round_bodies", "bodies of a smoother outline", {{"recipe.particles.irregularity", "0"}}),
      set("binder_at_collector", "carbon-binder domain at the collector",
          {{"recipe.effects.cbd_gradient.slope", "-0.8"}}),
      scaled("light_binder", "carbon and binder lighter than the recipe says",
             {"recipe.density.cbd_solid_g_cm3"}, 0.75),
      scaled("heavy_binder", "carbon and binder heavier than the recipe says",
             {"recipe.density.cbd_solid_g_cm3"}, 1.3),
      {"coarse_rough_bodies",
       "larger particles of a rougher outline",
       {{"recipe.particles.median_um", "", 1.25}, {"recipe.particles.irregularity", "", 2.5}}},
  };
}

Changes of_the_press() {
  return {
      scaled("soft_foil", "a collector as soft as a polymer",
             {"case.material.collector.youngs_modulus_GPa"}, 0.05),
      shown_otherwise("displacement_scale", "displacements shown are 8 % too large",
                      &PressErrors::displacement_factor, 1.08),
      shown_otherwise("pressure_offset", "the press shows 4 MPa too much",
                      &PressErrors::pressure_offset_MPa, 4.0),
      shown_otherwise("frame_hysteresis", "the frame springs back late",
                      &PressErrors::release_shift_um, 0.3),
      shown_otherwise("drift", "the displacement drifts while it is recorded",
                      &PressErrors::drift_um, 0.4),
      scaled("soft_platen", "a roll with a cover of polymer",
             {"case.material.platen.youngs_modulus_GPa"}, 0.003),
      shown_otherwise("short_displacement", "displacements shown are 6 % too small",
                      &PressErrors::displacement_factor, 0.94),
      shown_otherwise("pressure_shown_low", "the press shows 4 MPa too little",
                      &PressErrors::pressure_offset_MPa, -4.0),
      shown_otherwise("release_slip", "the displacement slips when the release begins",
                      &PressErrors::release_shift_um, -0.3),
      shown_otherwise("drift_back", "the displacement drifts back while it is recorded",
                      &PressErrors::drift_um, -0.4),
      shown_otherwise("frame_springs_far", "the frame springs back by half a micrometre too late",
                      &PressErrors::release_shift_um, 0.5),
  };
}

Changes other_numerics() {
  return {
      numerics(scaled("finer_primaries", "bodies of smaller primaries on a closer lattice",
                      {"recipe.particles.primary_diameter_um", "recipe.particles.lattice_um"},
                      0.88)),
      numerics(
          scaled("half_time_step", "half the time step", {"case.numerics.timestep_fraction"}, 0.5)),
      numerics(scaled("larger_cell", "a cell of 1.3 times the sides",
                      {"recipe.cell.x_um", "recipe.cell.y_um"}, 1.3)),
      numerics(scaled(
          "half_speed", "the platen at half the speed",
          {"case.platen.speed_m_s", "case.platen.touch_speed_m_s", "case.platen.release_speed_m_s"},
          0.5)),
  };
}

} // namespace

// Sizes are chosen to be seen, none to be hard; the sources are those of the keys they change.
const std::vector<HiddenChange> &hidden_changes() {
  static const Changes table = [] {
    Changes all;
    for (const Changes &some :
         {of_bonds_and_contacts(), of_the_coating(), of_the_press(), other_numerics()})
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }();
  return table;
}

const HiddenChange *find_hidden(const std::string &name) {
  for (const HiddenChange &c : hidden_changes())
    if (c.name == name)
      return &c;
  return nullptr;
}

} // namespace calendem
