// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/from_image.h"
#include "electrode/pack/from_structure.h"
#include "electrode/pack/packing_state.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

namespace {

double volume_of(const std::vector<ExistingSphere> &spheres) {
  double sum = 0.0;
  for (const ExistingSphere &p : spheres)
    sum += p.volume();
  return sum;
}

double mass_of(const std::vector<ExistingSphere> &spheres) {
  double sum = 0.0;
  for (const ExistingSphere &p : spheres)
    sum += p.mass();
  return sum;
}

double largest(const std::vector<ExistingSphere> &spheres) {
  double d = 0.0;
  for (const ExistingSphere &p : spheres)
    d = std::max(d, p.diameter);
  return d;
}

// Puts values of the structure into the settings, and says where the recipe gives others.
class Adoption {
public:
  Adoption(const Settings &settings, Mistakes &mistakes) : s_(settings), mistakes_(mistakes) {}

  /// `tolerance` is relative.
  void take(const std::string &name, double value, double tolerance) {
    const std::vector<Key> &keys = recipe_keys();
    const Key &key =
        *std::find_if(keys.begin(), keys.end(), [&](const Key &k) { return k.name == name; });
    const int line = s_.line(name);
    if (line > 0 && !(std::fabs(s_.number(name) - value) <= tolerance * std::fabs(value)))
      mistakes_.add(line, fmt::format("{} is {}, but the structure has {:.6g} {}. Correct one of "
                                      "them, or leave the key out: then the structure's is taken.",
                                      name, s_.text(name), value, key.unit));
    else if (const auto wrong = wrong_number(key, value)) {
      mistakes_.add(0, "of the structure: " + wrong->substr(0, wrong->find(" It looks")));
      s_.note(name, 0, true);
    } else
      set(name, value);
  }
  void set(const std::string &name, double value) { s_.set(name, fmt::format("{:.12g}", value)); }
  const Settings &settings() const { return s_; }

private:
  Settings s_;
  Mistakes &mistakes_;
};

Recipe with(const Recipe &recipe, const Settings &settings) {
  Recipe r = recipe_of(settings);
  r.file = recipe.file;
  r.shapes = recipe.shapes;
  r.structure = recipe.structure;
  r.material = recipe.material;
  return r;
}

constexpr double kExact = 1e-3, kClose = 1e-2;

// What is one number in the recipe must be one in the structure: the density of spheres that become
// bodies, diameter and density of primaries.
void check_equal(const Recipe &r, const ExistingStructure &g, Mistakes &mistakes) {
  const ExistingSphere &first = g.am.front();
  const double density =
      r.structure.densities_of_file ? (r.structure.clusters ? kExact : kClose) : HUGE_VAL;
  const auto other = std::find_if(g.am.begin(), g.am.end(), [&](const ExistingSphere &p) {
    return (r.structure.clusters &&
            std::fabs(p.diameter - first.diameter) > kExact * first.diameter) ||
           std::fabs(p.density - first.density) > density * first.density;
  });
  if (other != g.am.end())
    mistakes.add(0,
                 fmt::format("{}: particle {} is {:.4g} um wide and weighs {:.4g} g/cm3, particle "
                             "{} {:.4g} um and {:.4g} g/cm3. Correct the types, or take "
                             "structure.{}.",
                             r.structure.clusters ? "the primaries of given clusters must be equal"
                                                  : "the active material must have one density",
                             first.id, first.diameter, first.density, other->id, other->diameter,
                             other->density,
                             r.structure.clusters ? "bodies = \"shapes\" for separate spheres"
                                                  : "densities = \"recipe\""));
}

// The true density, or for clusters the lattice that makes N s^3 weigh what the cluster does.
void take_am(const Recipe &r, const ExistingStructure &g, Adoption &a) {
  if (r.structure.clusters)
    a.take("particles.primary_diameter_um", g.am.front().diameter, kExact);
  if (r.structure.clusters && r.structure.densities_of_file)
    a.take("particles.lattice_um", std::cbrt(g.am.front().mass() / r.am_density), kClose);
  else if (r.structure.densities_of_file)
    a.take("density.am_g_cm3", mass_of(g.am) / volume_of(g.am), kClose);
}

void take_cbd(const Recipe &r, const ExistingStructure &g, Adoption &a, Mistakes &mistakes) {
  if (g.cbd.empty())
    return;
  a.take("cbd.diameter_um", largest(g.cbd), kClose);
  if (!r.structure.densities_of_file)
    return;
  const double density = mass_of(g.cbd) / volume_of(g.cbd);
  const double nano = 100.0 * (1.0 - density / r.cbd_solid_density);
  if (nano < -1.0)
    mistakes.add(0, fmt::format("CBD weighs {:.4g} g/cm3 in the structure, more than dense carbon "
                                "and binder (density.cbd_solid_g_cm3 = {:.4g}). Correct that, or "
                                "take structure.densities = \"recipe\".",
                                density, r.cbd_solid_density));
  else
    a.take("cbd.nanoporosity_percent", nano < 1.0 ? 0.0 : nano, 2.0 * kClose);
}

void take_composition(const Recipe &r, const ExistingStructure &g, Adoption &a,
                      Mistakes &mistakes) {
  const std::string am = "composition.am_weight_percent", loading = "coating.loading_mg_cm2",
                    carbon = "composition.carbon_weight_percent",
                    binder = "composition.binder_weight_percent",
                    porosity = "coating.porosity_total_percent";
  const double m_am = am_mass(r, g), m_cbd = cbd_mass(r, g), area = g.lx * g.ly;
  const double percent = 100.0 * m_am / (m_am + m_cbd), rest = 100.0 - percent;
  const double sum = r.settings.number(carbon) + r.settings.number(binder);
  if ((r.settings.line(carbon) > 0 || r.settings.line(binder) > 0) && std::fabs(sum - rest) > 0.5)
    mistakes.add(std::max(r.settings.line(carbon), r.settings.line(binder)),
                 fmt::format("carbon and binder are {:.6g} % in the recipe, but {:.6g} % in the "
                             "structure. Correct one of them, or leave [composition] out.",
                             sum, rest));
  const double share = sum > 0.0 ? r.settings.number(carbon) / sum : 0.5;
  if (percent < 50.0)
    mistakes.add(0,
                 "CBD outweighs the active material in the structure. If it still holds solvent, "
                 "give the dried structure.");
  a.take(am, percent, 0.005);
  a.set(carbon, rest * share);
  a.set(binder, rest * (1.0 - share));
  a.take(loading, 0.1 * (m_am + m_cbd) / area, kClose);
  const double solid = m_am / r.am_density + m_cbd / r.cbd_solid_density;
  if (r.settings.line(porosity) > 0)
    return;
  const int before = mistakes.count();
  a.take(porosity, 100.0 * (1.0 - solid / area / g.thickness), kClose);
  if (mistakes.count() > before)
    mistakes.add(0, "Give coating.porosity_total_percent, to which the film is to be packed.");
}

// Spheres of a body that can be made have between half a cell of the lattice and what the cell of
// the electrode has room for.
void check_sizes(const Recipe &r, const std::vector<ExistingSphere> &am, Mistakes &mistakes) {
  const double smallest = std::cbrt(3.0 / kPi) * r.lattice; // half a cell
  const double largest = r.widest_body() - r.primary_diameter;
  const auto count = [&](auto wrong) { return std::count_if(am.begin(), am.end(), wrong); };
  const auto small = [&](const ExistingSphere &p) { return p.diameter < smallest; };
  const auto large = [&](const ExistingSphere &p) { return p.diameter > largest; };
  if (const auto n = count(small)) {
    const ExistingSphere &p = *std::find_if(am.begin(), am.end(), small);
    mistakes.add(0, fmt::format("{} spheres of the structure have less than half the volume of a "
                                "primary's cell, first particle {} of {:.4g} um; {:.4g} um is the "
                                "minimum. Give finer primaries (particles.lattice_um and "
                                "primary_diameter_um).",
                                n, p.id, p.diameter, smallest));
  }
  if (const auto n = count(large)) {
    const ExistingSphere &p = *std::find_if(am.begin(), am.end(), large);
    mistakes.add(0,
                 fmt::format("{} spheres of the structure are too large for its cell of {:.4g} x "
                             "{:.4g} um, first particle {} of {:.4g} um; a body may be {:.4g} "
                             "um wide, its sphere {:.4g} um. Give a larger structure.",
                             n, r.cell_x, r.cell_y, p.id, p.diameter, r.widest_body(), largest));
  }
}

} // namespace

double am_mass(const Recipe &r, const ExistingStructure &g) {
  if (r.structure.densities_of_file)
    return mass_of(g.am);
  return r.structure.clusters ? double(g.am.size()) * r.am_density * std::pow(r.lattice, 3)
                              : r.am_density * volume_of(g.am);
}

double cbd_mass(const Recipe &r, const ExistingStructure &g) {
  return r.structure.densities_of_file ? mass_of(g.cbd) : cbd_density(r) * volume_of(g.cbd);
}

Recipe adopt(const Recipe &recipe, const ExistingStructure &g) {
  Mistakes mistakes(recipe.file);
  Adoption a(recipe.settings, mistakes);
  a.take("cell.x_um", g.lx, kExact);
  a.take("cell.y_um", g.ly, kExact);
  check_equal(recipe, g, mistakes);
  take_am(recipe, g, a);
  take_cbd(recipe, g, a, mistakes);
  take_composition(with(recipe, a.settings()), g, a, mistakes);
  const Recipe r = with(recipe, a.settings());
  check_recipe(a.settings(), r, mistakes);
  if (!r.structure.clusters)
    check_sizes(r, g.am, mistakes);
  mistakes.stop_if_any();
  return r;
}

PackInput read_input(const Recipe &recipe) {
  if (!recipe.structure.given())
    return {recipe, {}, nullptr};
  PackInput in;
  if (recipe.structure.of_image) {
    in.image = std::make_shared<FilmOfImage>(read_film_of_image(recipe));
    in.structure = in.image->structure;
  } else
    in.structure = read_structure(recipe.structure);
  in.recipe = adopt(recipe, in.structure);
  return in;
}

} // namespace calendem
