// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/random.h"
#include "electrode/pack/electrode_files.h"
#include "electrode/pack/packing_state.h"
#include "electrode/slurry/dry.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace calendem {

namespace {

constexpr int kSlabs = 8;
// Particles that are mixed at random have 1 +- (2/slabs)^0.5 slabs/particles: 0.02 for 200.
constexpr double kWellMixed = 0.9;
constexpr double kFreeSlurry_MPa = 0.01; // far below what drying presses with
constexpr double kAtRest_m_s = 0.01;     // 0.4 um in the 40 us of the last relaxation

double mass(const std::vector<Particle> &particles) {
  double sum = 0.0;
  for (const Particle &p : particles)
    sum += p.density * kPi / 6.0 * std::pow(p.diameter, 3);
  return sum;
}

double solid_volume(const FilmRecipe &f, const std::vector<Particle> &particles) {
  double sum = 0.0;
  for (const Particle &p : particles)
    sum += kPi / 6.0 * std::pow(p.diameter, 3) * (p.type == 1 ? 1.0 : 1.0 - f.recipe.nanoporosity);
  return sum;
}

double rms_speed(const LastRow &end, const std::vector<Particle> &particles) {
  return std::sqrt(2.0 * end.kinetic_fJ / mass(particles));
}

void at_most(Mistakes &missed, const char *what, double value, double limit, const char *advice) {
  if (!(value <= limit))
    missed.add(0, "{} {:.4g}; at most {:.4g} is allowed. {}", what, value, limit, advice);
}

void stop(const Mistakes &missed, const char *what) {
  if (!missed.empty())
    throw Failure(kCheckFailed, "{} misses its targets; its files are kept for inspection\n{}",
                  what, missed.text());
}

} // namespace

std::string film_variables(const FilmRecipe &f, double height) {
  const Recipe &r = f.recipe;
  const double stop = f.to_thickness ? r.thickness() : r.am_column() + f.cbd_dry_envelope();
  return fmt::format("# what in.slurry and in.drying need to know of this film\n"
                     "variable h_start_um equal {:.10g}\nvariable h_slurry_um equal {:.10g}\n"
                     "variable h_dry_um equal {:.10g}\nvariable h_stop_um equal {:.10g}\n"
                     "variable capillary_MPa equal {}\n"
                     "variable side_x_um equal {}\nvariable side_y_um equal {}\n"
                     "variable cbd_dry_um equal {}\nvariable cbd_wet_um equal {:.10g}\n"
                     "variable cbd_dry_g_cm3 equal {:.10g}\n"
                     "variable cbd_wet_g_cm3 equal {:.10g}\n",
                     height, f.slurry_thickness(), r.thickness(), stop, f.capillary_MPa, r.cell_x,
                     r.cell_y, r.cbd_diameter, f.wet_diameter(), cbd_density(r), f.wet_density());
}

void read_state(const FilmRecipe &f, const std::string &dump, std::vector<Particle> &particles) {
  read_positions(dump, particles);
  std::ifstream in(dump);
  std::string line;
  while (std::getline(in, line) && line.rfind("ITEM: ATOMS", 0) != 0)
    ;
  while (std::getline(in, line)) {
    std::istringstream row(line);
    int tag = 0;
    double x = 0, y = 0, z = 0, radius = 0;
    if (!(row >> tag >> x >> y >> z >> radius))
      continue;
    const Particle &p = particles.at(tag - 1);
    if (!(std::fabs(2.0 * radius - p.diameter) <= 1e-6 * p.diameter))
      throw Failure(kSimulationFailed,
                    "'{}': particle {} is {:.6g} um wide instead of {:.6g}: the input script did "
                    "not give it its size",
                    dump, tag, 2.0 * radius, p.diameter);
  }
  for (Particle &p : particles)
    p.x = in_cell(f.recipe, p.x);
}

nlohmann::json describe_slurry(const FilmRecipe &f, const std::vector<Particle> &particles,
                               const LastRow &end) {
  const Recipe &r = f.recipe;
  const double solvent = r.area() * f.solvent_column() * f.solvent_density;
  const double solids = 10.0 * r.loading * r.area();
  return {{"solid_content", solids / (solids + solvent)},
          {"thickness_um", end.gap_um},
          {"density_g_cm3", (solids + solvent) / r.area() / end.gap_um},
          {"density_ideal_g_cm3", f.slurry_density()},
          {"sphere_fraction", f.sphere_fraction},
          {"cbd_diameter_um", f.wet_diameter()},
          {"surface_pressure_MPa", end.pressure_MPa + 0.0},
          {"rms_speed_m_s", rms_speed(end, particles)},
          {"mixing_index", mixing_index(particles, end.gap_um, kSlabs)}};
}

nlohmann::json describe_film(const FilmRecipe &f, const std::vector<Particle> &particles,
                             const LastRow &stop, const LastRow &end) {
  const Recipe &r = f.recipe;
  double low = HUGE_VAL, high = 0.0;
  for (const Particle &p : particles) {
    low = std::min(low, p.x.z() - 0.5 * p.diameter);
    high = std::max(high, p.x.z() + 0.5 * p.diameter);
  }
  const double porosity = 1.0 - solid_volume(f, particles) / (r.area() * (high - low));
  const bool at_target = stop.gap_um <= r.thickness() + 0.01;
  return {{"thickness_um", high - low},
          {"thickness_recipe_um", r.thickness()},
          {"porosity_total", porosity},
          {"porosity_recipe", r.porosity_total},
          {"porosity_difference_points", 100.0 * (porosity - r.porosity_total)},
          {"loading_mg_cm2", mass(particles) / r.area() / 10.0},
          {"loading_recipe_mg_cm2", r.loading},
          {"stopped_by", at_target && f.to_thickness ? "thickness" : "capillary pressure"},
          {"surface_um_at_stop", stop.gap_um},
          {"surface_pressure_MPa_at_stop", stop.pressure_MPa + 0.0},
          {"rms_speed_m_s", rms_speed(end, particles)},
          {"mixing_index", mixing_index(particles, high, kSlabs)}};
}

void check_slurry(const nlohmann::json &s, const std::string &folder) {
  Mistakes missed(folder);
  at_most(
      missed, "relative error of the slurry's density is",
      std::fabs(s["density_g_cm3"].get<double>() / s["density_ideal_g_cm3"].get<double>() - 1.0),
      0.01, "The surface did not come down: lower slurry.sphere_fraction.");
  at_most(missed, "pressure of the slurry on its surface in MPa is", s["surface_pressure_MPa"],
          kFreeSlurry_MPa, "The particles jam: lower slurry.sphere_fraction.");
  at_most(missed, "rms speed of the slurry's particles in m/s is", s["rms_speed_m_s"], kAtRest_m_s,
          "Let it rest longer (rest_us in in.slurry).");
  at_most(missed, "1 - mixing index of the slurry is", 1.0 - s["mixing_index"].get<double>(),
          1.0 - kWellMixed, "Stir longer (stir_us in in.slurry).");
  stop(missed, "the slurry");
}

void check_film(const nlohmann::json &d, const FilmRecipe &f, const std::string &folder) {
  Mistakes missed(folder);
  const double difference = d["porosity_difference_points"];
  if (f.to_thickness && !(std::fabs(difference) <= f.tolerance_points))
    missed.add(0,
               "the dried film has {:.2f} % total porosity and {:.2f} um, the recipe {:.2f} % and "
               "{:.2f} um: {:+.2f} points, at most {:.2f} are allowed; drying ended by the {}. "
               "Correct the recipe's porosity, raise drying.capillary_pressure_MPa or "
               "drying.porosity_tolerance_points.",
               100.0 * d["porosity_total"].get<double>(), d["thickness_um"].get<double>(),
               100.0 * f.recipe.porosity_total, f.recipe.thickness(), difference,
               f.tolerance_points, d["stopped_by"].get<std::string>());
  at_most(missed, "relative error of the film's loading is",
          std::fabs(d["loading_mg_cm2"].get<double>() / f.recipe.loading - 1.0), 0.01,
          "Make the cell larger: whole particles cannot come nearer.");
  at_most(missed, "rms speed of the film's particles in m/s is", d["rms_speed_m_s"], kAtRest_m_s,
          "Let it relax longer (relax_us in in.drying).");
  at_most(missed, "1 - mixing index of the film is", 1.0 - d["mixing_index"].get<double>(),
          1.0 - kWellMixed,
          "Active material and carbon binder separated: dry more slowly (dry_m_s).");
  stop(missed, "the dried film");
}

namespace {

/// A name as it is; a file's path so that it holds in another folder.
std::string material_of(const Recipe &r) {
  const std::string given = r.settings.text("material");
  const bool is_name = given.find_first_of("/.") == std::string::npos;
  return is_name ? given : std::filesystem::absolute(material_path(given, r.file)).string();
}

} // namespace

std::string hand_over(const FilmRecipe &f) {
  const Recipe &r = f.recipe;
  std::string out = fmt::format(
      "# The film that `calendem dry` left in dried.data, for `calendem pack`: cell, loading and "
      "composition are\n# the film's. film.csv gives each particle's position in the slurry.\n"
      "name = \"{}, slurry and drying simulated\"\nmaterial = \"{}\"\nseed = {}\n\n",
      r.settings.text("name"), material_of(r), r.seed);
  if (f.to_thickness) // what the film misses by less than the tolerance
    out += fmt::format("[coating]\nporosity_total_percent = {}\n\n",
                       r.settings.text("coating.porosity_total_percent"));
  out +=
      fmt::format("[density]\ncbd_solid_g_cm3 = {}\n\n[particles]\nprimary_diameter_um = {}\n"
                  "lattice_um = {}\ngrains = \"{}\"\nirregularity = {}\nmax_width_fraction = {}\n\n"
                  "[structure]\nfile = \"dried.data\"\natom_style = \"granular\"\n"
                  "units = \"micro\"\nboundary = \"p p f\"\nam_types = \"1\"\n"
                  "cbd_types = \"2\"\n",
                  r.cbd_solid_density, r.primary_diameter, r.lattice,
                  r.settings.text("particles.grains"), r.irregularity, r.max_width_fraction);
  return r.shapes.given() ? out + "\n[shapes]\nlibrary = \"shapes\"\n" : out;
}

std::string film_table(const std::vector<Particle> &slurry, const std::vector<Particle> &dried) {
  std::string out = "id,phase,diameter_um,slurry_x_um,slurry_y_um,slurry_z_um,x_um,y_um,z_um\n";
  for (size_t k = 0; k < dried.size(); ++k) {
    const Eigen::Vector3d &a = slurry[k].x, &b = dried[k].x;
    out += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", dried[k].tag,
                       dried[k].type == 1 ? "am" : "cbd", dried[k].diameter, a.x(), a.y(), a.z(),
                       b.x(), b.y(), b.z());
  }
  return out;
}

Placement place_spheres(const FilmRecipe &film, const std::vector<int> &counts) {
  const Recipe &r = film.recipe;
  const auto diameter = [&](int count) { return r.lattice * std::cbrt(6.0 / kPi * count); };
  Random random(r.seed, 5);
  Placement out;
  out.height = 1.5 * film.slurry_thickness();
  SphereBins bins(r, 1.02 * std::max(diameter(counts.front()), r.cbd_diameter));
  const auto add = [&](int type, double d, double density) {
    Eigen::Vector3d x;
    int tries = 0;
    do {
      const Eigen::Vector3d u = random.uniform3();
      x = {r.cell_x * u.x(), r.cell_y * u.y(), 0.5 * d + (out.height - d) * u.z()};
      if (++tries % 20000 == 0)
        out.height *= 1.1; // no room: a taller cell
    } while (bins.hits(x, 0.5 * d));
    bins.add(x, 0.5 * d);
    out.particles.push_back({int(out.particles.size()) + 1, type, d, density, x, 0});
  };
  for (const int count : counts)
    add(1, diameter(count), r.am_density);
  for (int n = cbd_count(r); n > 0; --n)
    add(2, r.cbd_diameter, cbd_density(r));
  return out;
}

double mixing_index(const std::vector<Particle> &particles, double height, int slabs) {
  std::vector<double> all(slabs, 0.0), cbd(slabs, 0.0);
  double total = 0.0, total_cbd = 0.0;
  for (const Particle &p : particles) {
    const int k = std::min(slabs - 1, std::max(0, int(slabs * p.x.z() / height)));
    all[k] += 1.0;
    total += 1.0;
    if (p.type == 2) {
      cbd[k] += 1.0;
      total_cbd += 1.0;
    }
  }
  const double share = total_cbd / total, separated = share * (1.0 - share);
  const double random = separated * slabs / total;
  double variance = 0.0;
  for (int k = 0; k < slabs; ++k)
    if (all[k] > 0.0)
      variance += all[k] / total * std::pow(cbd[k] / all[k] - share, 2);
  return (separated - variance) / (separated - random);
}

} // namespace calendem
