// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/recipe.h"
#include "base/particle_sizes.h"
#include "effects/effects.h"
#include "physics/bond_pair.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {

namespace {

const char *const kGradient = "effects.cbd_gradient.slope";
constexpr double kLeastAm = 50.0; // %
const char *const kAmWeight = "composition.am_weight_percent";
const char *const kCarbonWeight = "composition.carbon_weight_percent";
const char *const kBinderWeight = "composition.binder_weight_percent";

std::vector<Key> own_keys() {
  return {
      {"name", "", "electrode", 0, 0, "", "name for reports", "", true},
      {"seed", "", "1", 0, 4e9, "", "seed of all random numbers", "", false, true},
      {"material", "", "nmc111", 0, 0, "",
       "what the electrode is made of: a name of input_scripts/materials, or the path of a file, "
       "relative to this one",
       "", true},
      {kAmWeight, "", "96", kLeastAm, 100, "%",
       "active material in the dry coating; if not given, the remainder of carbon and binder"},
      {kCarbonWeight, "", "2", 0, 50, "%", "carbon black"},
      {kBinderWeight, "", "2", 0, 50, "%", "binder"},
      {"density.am_g_cm3", "", "4.65", 0.5, 20, "g/cm3", "true density of the active material"},
      {"density.cbd_solid_g_cm3", "", "1.83", 0.5, 5, "g/cm3",
       "density of carbon and binder without pores"},
      {"coating.loading_mg_cm2", "", "17.46", 0.1, 100, "mg/cm2",
       "mass of dry coating per area, without foil"},
      {"coating.porosity_total_percent", "", "47.97", 20, 90, "%",
       "total porosity before calendering"},
      {"particles.median_um", "", "4.35", 1, 50, "um",
       "median diameter of secondary particles, by number"},
      {"particles.sigma_ln", "", "0.487", 0.01, 1, "", "width of the lognormal size distribution"},
      {"particles.min_um", "", "1.3", 0.5, 50, "um", "diameter of the smallest secondary particle"},
      {"particles.max_um", "", "16.2", 1, 100, "um", "diameter of the largest secondary particle"},
      {"particles.max_width_fraction", "", "0.7", 0.1, 0.7, "",
       "largest width of a particle, as a fraction of the shortest periodic side"},
      {"particles.irregularity", "", "0.1", 0, 0.3, "",
       "relative rms roughness of the particles' radius"},
      {"particles.primary_diameter_um", "", "1.59", 0.1, 10, "um", "diameter of a primary"},
      {"particles.grains", "", "lattice", 0, 0, "",
       "primaries of a particle: cells of a centroidal Voronoi tessellation, or a cubic lattice",
       "voronoi|lattice"},
      {"particles.lattice_um", "", "1.28", 0.1, 10, "um",
       "cube root of a primary's share of the particle's volume; spacing of the lattice"},
      {"cbd.nanoporosity_percent", "", "50", 0, 80, "%", "pores inside a CBD sphere"},
      {"cbd.diameter_um", "", "1.316", 0.1, 10, "um", "diameter of a CBD sphere"},
      {"cell.x_um", "", "15", 5, 1000, "um", "periodic side of the cell"},
      {"cell.y_um", "", "15", 5, 1000, "um", "periodic side of the cell"},
  };
}

Key label_key(const std::string &phase, const std::string &meaning) {
  return setting("shapes.phases." + phase, "", "0")
      .range(-2147483647, 2147483647)
      .is_whole()
      .means(meaning);
}

std::vector<Key> shape_keys() {
  return {
      {"shapes.image", "", "none", 0, 0, "",
       "label image from which the shapes of particles are taken", "", true},
      {"shapes.library", "", "none", 0, 0, "", "folder of shapes made earlier from an image", "",
       true},
      {"shapes.voxel_size_um", "", "0", 0, 10, "um", "voxel size of the image; 0: from the file"},
      {"shapes.background", "", "0", -2147483647, 2147483647, "", "label of the background", "",
       false, true},
      {"shapes.neck", "", "0.9", 0.5, 0.99, "",
       "parts of the active material are two particles where the neck between them is narrower "
       "than "
       "this fraction of the smaller part's inscribed radius"},
      {"shapes.sizes", "", "measured", 0, 0, "",
       "size distribution of the bodies: that of the image or that of the recipe",
       "measured|recipe"},
      {"shapes.places", "", "packed", 0, 0, "",
       "packed: particles of the image at new places; image: a crop of the image is the electrode, "
       "its particles and its carbon-binder where they are",
       "packed|image"},
      {"shapes.upwards", "", "z", 0, 0, "",
       "axis of the image that runs from the collector up; with - it runs down", "z|x|y|-z|-x|-y"},
      {"shapes.crop.x_um", "", "0", -1000, 1000, "um",
       "offset of the crop's middle from the image's; its sides are those of the cell, or the "
       "image's"},
      {"shapes.crop.y_um", "", "0", -1000, 1000, "um",
       "offset of the crop's middle from the image's; its sides are those of the cell, or the "
       "image's"},
      {"shapes.crop.low_um", "", "0", 0, 1000, "um", "height in the image where the crop begins"},
      {"shapes.crop.high_um", "", "0", 0, 1000, "um",
       "height in the image where the crop ends; 0: its top"},
      label_key("pore", "label of the pores in an image of phases"),
      label_key("am", "label of the active material, which is separated into particles; if it is "
                      "that of the pores, the image's labels are particles"),
      label_key("cbd", "label of carbon and binder; if it is that of the pores, there is none"),
  };
}

} // namespace

const std::vector<Key> &recipe_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all = with_volume_percentiles(own_keys());
    const std::vector<Key> of_shapes = shape_keys();
    all.insert(all.end(), of_shapes.begin(), of_shapes.end());
    add_settings_of_effects(true, all);
    all.insert(all.end(), structure_keys().begin(), structure_keys().end());
    return all;
  }();
  return keys;
}

double Recipe::am_column() const { return 10.0 * loading * am_weight / am_density; }
double Recipe::cbd_solid_column() const {
  return 10.0 * loading * (1.0 - am_weight) / cbd_solid_density;
}
double Recipe::thickness() const {
  return (am_column() + cbd_solid_column()) / (1.0 - porosity_total);
}
double Recipe::bond_distance() const { return kBondReach * primary_diameter; }
double Recipe::widest_body() const { return max_width_fraction * std::min(cell_x, cell_y); }
double Recipe::largest_body() const {
  return std::min(max_diameter, (widest_body() - primary_diameter) / (1.0 + 0.5 * irregularity));
}

namespace {

void check_composition(const Settings &s, Mistakes &mistakes) {
  if (!s.sound({kAmWeight, kCarbonWeight, kBinderWeight}))
    return;
  const double am = s.number(kAmWeight), carbon = s.number(kCarbonWeight),
               binder = s.number(kBinderWeight), sum = am + carbon + binder;
  const bool fractions = carbon + binder > 0.0 && carbon + binder <= 0.5;
  const char *const hint = fractions ? " Carbon and binder look like fractions." : "";
  if (std::fabs(sum - 100.0) > 0.01)
    mistakes.add(s.line(kAmWeight),
                 "[composition] adds up to {:.6g} % (active material {:.6g}, carbon {:.6g}, binder "
                 "{:.6g}); it must be 100 %.{}",
                 sum, am, carbon, binder, hint);
  else if (const int line = std::max(s.line(kCarbonWeight), s.line(kBinderWeight));
           line > 0 && s.line(kAmWeight) == 0 && (am < kLeastAm || fractions))
    mistakes.add(line,
                 "carbon ({:.6g} %) and binder ({:.6g} %) leave {:.6g} % of active material; "
                 "allowed is {:g} to 100 %.{}",
                 carbon, binder, am, kLeastAm, hint);
}

void check_spheres(const Settings &s, const Recipe &r, Mistakes &mistakes) {
  const double nano = s.number("cbd.nanoporosity_percent");
  if (s.sound({"cbd.nanoporosity_percent"}) && nano > 0.0 && nano < 1.0)
    mistakes.add(s.line("cbd.nanoporosity_percent"),
                 "cbd.nanoporosity_percent is {}, which looks like a fraction; give {:.4g} for {} "
                 "of the sphere's volume, or 0.",
                 nano, 100.0 * nano, nano);
  if (s.sound({"particles.lattice_um", "particles.primary_diameter_um"}) &&
      (r.lattice >= r.primary_diameter || r.bond_distance() >= std::sqrt(2.0) * r.lattice))
    mistakes.add(s.line("particles.primary_diameter_um"),
                 "particles.primary_diameter_um = {} must lie between 1 and {:.4g} times "
                 "lattice_um = {}, so that primaries are bonded along the lattice's axes only.",
                 r.primary_diameter, std::sqrt(2.0) / kBondReach, r.lattice);
}

/// The pores inside the CBD are part of the total porosity.
void check_porosity(const Settings &s, const Recipe &r, Mistakes &mistakes) {
  if (r.structure.given() ||
      !s.sound({"coating.loading_mg_cm2", "coating.porosity_total_percent",
                "cbd.nanoporosity_percent", "density.am_g_cm3", "density.cbd_solid_g_cm3"}) ||
      !(r.am_weight > 0.0 && r.am_weight <= 1.0))
    return;
  const double pores = r.cbd_solid_column() * r.nanoporosity / (1.0 - r.nanoporosity),
               least = pores / (pores + r.am_column() + r.cbd_solid_column());
  if (r.porosity_total < least)
    mistakes.add(s.line("coating.porosity_total_percent"),
                 "coating.porosity_total_percent is {:g}; the pores inside the CBD alone "
                 "(cbd.nanoporosity_percent = {:g}) are {:.1f} % of the coating. Raise the one, "
                 "lower the other, or take less carbon and binder.",
                 100.0 * r.porosity_total, 100.0 * r.nanoporosity, 100.0 * least);
}

void check_cell(const Settings &s, const Recipe &r, Mistakes &mistakes) {
  if (!s.sound({"cell.x_um", "cell.y_um", "particles.primary_diameter_um", "cbd.diameter_um"}))
    return;
  const double side = std::min(r.cell_x, r.cell_y);
  const double cut_off = neighbour_cut_off(std::max(r.primary_diameter, r.cbd_diameter));
  const int line = s.line(r.cell_x <= r.cell_y ? "cell.x_um" : "cell.y_um");
  if (side < 2.0 * cut_off)
    mistakes.add(line,
                 "a periodic side of {} um is shorter than two cut-offs ({:.2f} um): a particle "
                 "would touch two images of another. Make the cell larger.",
                 side, 2.0 * cut_off);
  if (s.sound({"particles.min_um", "particles.max_um", "particles.max_width_fraction"}) &&
      r.min_diameter >= r.largest_body())
    mistakes.add(std::max({s.line("particles.min_um"), s.line("particles.max_um"), line}),
                 "no particle fits: particles.min_um is {:g}, and the largest that "
                 "particles.max_um and this "
                 "cell allow {:.4g} um. Make the cell larger, lower particles.min_um or raise "
                 "particles.max_um.",
                 r.min_diameter, r.largest_body());
}

PhaseLabels read_phases(const Settings &s, const std::string &image, Mistakes &mistakes) {
  const auto label = [&](const char *phase) {
    return static_cast<std::int32_t>(s.number(std::string("shapes.phases.") + phase));
  };
  const PhaseLabels out{label("pore"), label("am"), label("cbd")};
  const auto line = [&](const char *key) { return s.line(std::string("shapes.") + key); };
  const int given = std::max({line("phases.pore"), line("phases.am"), line("phases.cbd")});
  if (!out.given() && (out.cbd != out.pore || (given > 0 && line("phases.am") == 0)))
    mistakes.add(given,
                 "shapes.phases.am is {0}, as shapes.phases.pore. Give the label of the active "
                 "material: phases = {{ pore = {0}, am = {1}, cbd = {2} }}.",
                 out.pore, out.pore + 1, out.pore + 2);
  else if (out.given() && out.cbd == out.am)
    mistakes.add(given,
                 "shapes.phases.am and cbd are both {}. Give each phase its own label, cbd that of "
                 "the pores if there is none.",
                 out.am);
  if (out.given() && image.empty())
    mistakes.add(given,
                 "shapes.phases names the labels of shapes.image, which is missing. Give the "
                 "image, or remove shapes.phases.");
  if (out.given() && line("background") > 0)
    mistakes.add(line("background"),
                 "shapes.background is for images of particles; of phases it is "
                 "shapes.phases.pore. Remove one of them.");
  return out;
}

void read_crop(const Settings &s, ShapeSource &out, Mistakes &mistakes) {
  out.in_place = s.text("shapes.places") == "image";
  out.upwards = s.text("shapes.upwards");
  out.middle_x = s.number("shapes.crop.x_um");
  out.middle_y = s.number("shapes.crop.y_um");
  out.low = s.number("shapes.crop.low_um");
  out.high = s.number("shapes.crop.high_um");
  for (const std::string key : {"shapes.upwards", "shapes.crop.x_um", "shapes.crop.y_um",
                                "shapes.crop.low_um", "shapes.crop.high_um"})
    if (const int line = s.line(key); line > 0 && !out.in_place)
      return mistakes.add(line,
                          "{} is of an image that becomes the electrode. Give "
                          "shapes.places = \"image\", or remove it.",
                          key);
  if (out.in_place && out.image.empty())
    mistakes.add(s.line("shapes.places"),
                 "shapes.places is \"image\", but shapes.image is missing. Give the image that "
                 "becomes the electrode.");
  if (out.high > 0.0 && out.high <= out.low)
    mistakes.add(
        s.line("shapes.crop.high_um"),
        fmt::format("shapes.crop.high_um is {}; it must be above low_um, {}.", out.high, out.low));
}

} // namespace

ShapeSource read_shapes(const Settings &s, const std::string &file, Mistakes &mistakes) {
  namespace fs = std::filesystem;
  ShapeSource out;
  out.image = path_of(s, "shapes.image", file);
  out.library = path_of(s, "shapes.library", file);
  out.voxel_um = s.number("shapes.voxel_size_um");
  out.background = static_cast<std::int32_t>(s.number("shapes.background"));
  out.phases = read_phases(s, out.image, mistakes);
  out.neck = s.number("shapes.neck");
  out.measured_sizes = s.text("shapes.sizes") == "measured";
  read_crop(s, out, mistakes);
  if (!out.image.empty() && !out.library.empty())
    mistakes.add(s.line("shapes.library"),
                 "[shapes] gives both an image and a library; give one of them.");
  if (!out.image.empty() && out.image.find('%') == std::string::npos &&
      !fs::is_regular_file(out.image))
    mistakes.add(
        s.line("shapes.image"),
        "shapes.image '{}' is not there. Give the path of a label image, relative to this file.",
        out.image);
  if (!out.library.empty() && !fs::is_directory(out.library))
    mistakes.add(s.line("shapes.library"),
                 "shapes.library '{}' is not there. Give the folder, relative to this file.",
                 out.library);
  return out;
}

ReferenceMaterial take_material(Settings &s, const std::string &file, const std::vector<Key> &keys,
                                Mistakes &mistakes) {
  if (!s.sound({"material"}))
    return {};
  try {
    const ReferenceMaterial material = read_material(material_path(s.text("material"), file));
    take_values(material, keys, s);
    return material;
  } catch (const Failure &f) {
    s.note("material", s.line("material"), true);
    mistakes.add(s.line("material"), "material: {}", f.what());
    return {};
  }
}

Recipe recipe_of(const Settings &s) {
  Recipe r;
  r.settings = s;
  r.am_weight = s.number(kAmWeight) / 100.0;
  r.am_density = s.number("density.am_g_cm3");
  r.cbd_solid_density = s.number("density.cbd_solid_g_cm3");
  r.loading = s.number("coating.loading_mg_cm2");
  r.porosity_total = s.number("coating.porosity_total_percent") / 100.0;
  r.median = s.number("particles.median_um");
  r.sigma_ln = s.number("particles.sigma_ln");
  r.min_diameter = s.number("particles.min_um");
  r.max_diameter = s.number("particles.max_um");
  r.max_width_fraction = s.number("particles.max_width_fraction");
  r.irregularity = s.number("particles.irregularity");
  r.primary_diameter = s.number("particles.primary_diameter_um");
  r.grains = s.text("particles.grains") == "voronoi" ? GrainShape::Voronoi : GrainShape::Lattice;
  r.lattice = s.number("particles.lattice_um");
  r.nanoporosity = s.number("cbd.nanoporosity_percent") / 100.0;
  r.cbd_diameter = s.number("cbd.diameter_um");
  r.cbd_gradient.slope = s.number(kGradient);
  r.cell_x = s.number("cell.x_um");
  r.cell_y = s.number("cell.y_um");
  r.seed = static_cast<unsigned long>(s.number("seed"));
  return r;
}

void check_recipe(const Settings &s, const Recipe &r, Mistakes &mistakes) {
  check_composition(s, mistakes);
  check_spheres(s, r, mistakes);
  check_porosity(s, r, mistakes);
  check_cell(s, r, mistakes);
  if (r.structure.given() && r.cbd_gradient.slope != 0.0)
    mistakes.add(
        s.line(kGradient),
        "{} is {}, but the structure has its carbon-binder where it is. Give 0, or leave it out.",
        kGradient, s.text(kGradient));
}

double neighbour_cut_off(double diameter) { return 1.1 * diameter + 0.25; }

int most_ranks(double lx, double ly, double diameter) {
  const double cut_off = neighbour_cut_off(diameter);
  return std::max(1, int(lx / cut_off)) * std::max(1, int(ly / cut_off));
}

Recipe read_recipe(const std::string &file) {
  Mistakes mistakes(file);
  Settings s = read_toml(file, FileKind::Recipe, recipe_keys(), mistakes);
  if (s.line(kAmWeight) == 0)
    s.set_as_remainder(kAmWeight, {kCarbonWeight, kBinderWeight});
  const ReferenceMaterial material = take_material(s, file, recipe_keys(), mistakes);
  take_sizes_by_volume(s, recipe_keys(), mistakes);
  Recipe r = recipe_of(s);
  r.file = file;
  r.material = material;
  r.shapes = read_shapes(s, file, mistakes);
  r.structure = read_structure_source(s, file, mistakes);
  take_places_of_image(s, r, mistakes);
  check_recipe(s, r, mistakes);
  mistakes.stop_if_any();
  return r;
}

namespace {

/// Name of the file that the particles' places come from; empty: they are packed.
std::string origin_of(const std::map<std::string, std::string> &recipe) {
  const auto text = [&](const char *key) {
    const auto at = recipe.find(key);
    return at == recipe.end() || at->second == "none" ? "" : at->second;
  };
  const std::string file =
      text("shapes.places") == "image" ? text("shapes.image") : text("structure.file");
  return std::filesystem::path(file).filename().string();
}

std::string shown_origin(const std::string &origin) {
  return origin.empty() ? "the recipe's" : "those of " + origin;
}

} // namespace

std::vector<std::string> other_electrode(const std::map<std::string, std::string> &wanted,
                                         const std::map<std::string, std::string> &recipe) {
  constexpr double kSame = 0.02;
  std::vector<std::string> out;
  const std::string from = origin_of(recipe), wanted_from = origin_of(wanted);
  const auto places = recipe.find("shapes.places");
  const bool of_image = places != recipe.end() && places->second == "image";
  if (!wanted_from.empty() && from == wanted_from)
    return out;
  if (!wanted_from.empty() || of_image)
    out.push_back(fmt::format("its particles are {} instead of {}", shown_origin(from),
                              shown_origin(wanted_from)));
  if (!wanted_from.empty()) // its recipe does not say what the structure is made of
    return out;
  for (const char *key :
       {kAmWeight, kCarbonWeight, kBinderWeight, "density.am_g_cm3", "density.cbd_solid_g_cm3",
        "coating.porosity_total_percent", "particles.median_um", "particles.sigma_ln",
        "cbd.nanoporosity_percent", "cbd.diameter_um"}) {
    const auto a = wanted.find(key), b = recipe.find(key);
    const bool of_sizes = std::string(key).rfind("particles.", 0) == 0;
    if (a == wanted.end() || b == recipe.end() || (of_sizes && !from.empty()))
      continue;
    const double x = std::stod(a->second), y = std::stod(b->second);
    if (std::fabs(x - y) > kSame * std::max(std::fabs(x), std::fabs(y)))
      out.push_back(fmt::format("{}: {} instead of {}", key, b->second, a->second));
  }
  return out;
}

} // namespace calendem
