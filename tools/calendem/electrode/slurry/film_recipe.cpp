// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/placement.h"
#include "electrode/slurry/dry.h"
#include "physics/pi.h"
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

// Above it spheres of these sizes jam instead of flowing (random close packing is 0.64 and more).
constexpr double kJams = 0.6;

// The swollen spheres are to fill what AM leaves of the stated fraction.
void check_swelling(const Settings &s, const FilmRecipe &f, Mistakes &mistakes) {
  const double h = f.slurry_thickness();
  const double dry = (f.recipe.am_column() + f.cbd_dry_envelope()) / h;
  const double most = (f.recipe.am_column() + f.recipe.cbd_solid_column() + f.solvent_column()) / h;
  if (f.sphere_fraction > dry && f.sphere_fraction < std::min(most, kJams + 1e-9))
    return;
  mistakes.add(s.line("slurry.sphere_fraction"),
               fmt::format("slurry.sphere_fraction is {}: dry spheres fill {:.3f} of a slurry of "
                           "{} % solids already, and above {} they jam. Give a value between, or "
                           "lower slurry.solid_content_percent.",
                           f.sphere_fraction, dry, 100.0 * f.solid_content, kJams));
}

} // namespace

const std::vector<Key> &film_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all;
    for (const Key &key : recipe_keys())
      if (key.name.rfind("structure.", 0) != 0)
        all.push_back(key);
    const std::vector<Key> own = {
        {"slurry.solid_content_percent", "", "69", 20, 90, "%", "mass of solids in the slurry"},
        {"slurry.solvent_density_g_cm3", "", "1.028", 0.5, 2, "g/cm3", "NMP at 25 C"},
        {"slurry.sphere_fraction", "", "0.55", 0.1, 0.6, "",
         "of the slurry's volume: AM and CBD spheres swollen with solvent"},
        {"drying.stop", "", "thickness", 0, 0, "",
         "what ends it: the recipe's thickness, or the film bears the capillary pressure",
         "thickness|pressure"},
        {"drying.capillary_pressure_MPa", "", "0.1", 1e-3, 10, "MPa",
         "the most that the liquid's surface presses with"},
        {"drying.porosity_tolerance_points", "", "0", 0, 20, "",
         "of total porosity against the recipe's, percentage points; 0: one CBD diameter of "
         "thickness"},
    };
    all.insert(all.end(), own.begin(), own.end());
    return all;
  }();
  return keys;
}

double FilmRecipe::solvent_column() const {
  return 10.0 * recipe.loading * (1.0 / solid_content - 1.0) / solvent_density;
}
double FilmRecipe::slurry_thickness() const {
  return recipe.am_column() + recipe.cbd_solid_column() + solvent_column();
}
double FilmRecipe::slurry_density() const {
  return 10.0 * recipe.loading / solid_content / slurry_thickness();
}
double FilmRecipe::cbd_dry_envelope() const {
  return recipe.cbd_solid_column() / (1.0 - recipe.nanoporosity);
}
double FilmRecipe::wet_diameter() const {
  const double column = sphere_fraction * slurry_thickness() - recipe.am_column();
  return recipe.cbd_diameter * std::cbrt(column / cbd_dry_envelope());
}
double FilmRecipe::wet_density() const {
  const double growth = std::pow(wet_diameter() / recipe.cbd_diameter, 3);
  const double solid = (1.0 - recipe.nanoporosity) / growth;
  return solid * recipe.cbd_solid_density + (1.0 - solid) * solvent_density;
}

FilmRecipe read_film_recipe(const std::string &file) {
  Mistakes mistakes(file);
  const Settings s = read_toml(file, FileKind::Film, film_keys(), mistakes);
  FilmRecipe f;
  f.recipe = recipe_of(s);
  f.recipe.file = file;
  f.recipe.shapes = read_shapes(s, file, mistakes);
  check_recipe(s, f.recipe, mistakes);
  if (f.recipe.cbd_gradient.slope != 0.0)
    mistakes.add(0,
                 "effects.cbd_gradient places the spheres of an electrode that is packed from its "
                 "recipe; in a film they are where it dries. Leave it out.");
  f.solid_content = s.number("slurry.solid_content_percent") / 100.0;
  f.solvent_density = s.number("slurry.solvent_density_g_cm3");
  f.sphere_fraction = s.number("slurry.sphere_fraction");
  f.to_thickness = s.text("drying.stop") == "thickness";
  f.capillary_MPa = s.number("drying.capillary_pressure_MPa");
  f.tolerance_points = s.number("drying.porosity_tolerance_points");
  if (f.tolerance_points == 0.0) // the highest particle is that near to the surface
    f.tolerance_points =
        100.0 * (1.0 - f.recipe.porosity_total) * f.recipe.cbd_diameter / f.recipe.thickness();
  if (s.sound({"slurry.solid_content_percent", "slurry.solvent_density_g_cm3",
               "slurry.sphere_fraction", "coating.loading_mg_cm2"}))
    check_swelling(s, f, mistakes);
  if (mistakes.empty() && cbd_count(f.recipe) == 0)
    mistakes.add(0, "the recipe has no carbon and binder: nothing would take up solvent. Give "
                    "composition.carbon_weight_percent or binder_weight_percent.");
  mistakes.stop_if_any();
  return f;
}

} // namespace calendem
