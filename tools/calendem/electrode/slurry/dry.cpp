// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/slurry/dry.h"
#include "base/liggghts_job.h"
#include "base/output_folder.h"
#include "base/particle_sizes.h"
#include "base/provenance.h"
#include "electrode/pack/electrode_files.h"
#include "electrode/pack/measured_bodies.h"
#include "electrode/pack/packing_state.h"
#include "physics/pi.h"
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace calendem {

namespace fs = std::filesystem;
namespace {

// Everything that the result of the steps so far depends on.
std::string identity_of(const FilmRecipe &f, const std::string &liggghts,
                        std::initializer_list<const char *> steps) {
  std::string text = version() + hash_of_file(liggghts);
  for (const char *step : steps)
    text += hash_of_file(input_scripts() + "/in." + step);
  for (const auto &[key, value] : f.recipe.settings.all())
    text.append(key).append("=").append(value).append("\n");
  return hash_of_text(text + hash_of_shapes(f.recipe));
}

// Runs input_scripts/in.STEP; its progress is the last row of STEP.csv.
void simulate(const DryOptions &o, const std::string &step) {
  LiggghtsJob job;
  job.program = o.liggghts;
  job.ranks = o.ranks;
  job.script = input_scripts() + "/in." + step;
  job.log = o.folder + "/" + step + ".log";
  job.screen = o.folder + "/" + step + ".screen";
  job.variables = {{"out", o.folder}, {"scripts", input_scripts()}};
  const bool terminal = isatty(1);
  run_liggghts(job, [&] {
    const LastRow row = last_row(o.folder + "/" + step + ".csv");
    if (terminal && row.gap_um > 0.0)
      std::cout << fmt::format("\r\033[K{}: surface at {:.1f} um, {:.3f} MPa", step, row.gap_um,
                               row.pressure_MPa)
                << std::flush;
  });
  if (terminal)
    std::cout << "\r\033[K";
}

// A sphere must not reach two images of another.
void check_cell(const FilmRecipe &f, const DryOptions &o, double largest) {
  Mistakes mistakes(f.recipe.file);
  const double cut_off = largest + 0.3, side = std::min(f.recipe.cell_x, f.recipe.cell_y);
  if (side < 2.0 * cut_off)
    mistakes.add(0,
                 "the largest sphere of the slurry is {:.2f} um wide, but in a cell of {} x {} um "
                 "at most {:.2f} um are allowed: it would touch two images of another. Make the "
                 "cell larger or lower particles.max_um.",
                 largest, f.recipe.cell_x, f.recipe.cell_y, 0.5 * side - 0.3);
  else if (const int most = int(f.recipe.cell_x / cut_off) * int(f.recipe.cell_y / cut_off);
           o.ranks > most)
    mistakes.add(0,
                 "--ranks {}: a cell of {} x {} um can be shared by at most {} ranks whose parts "
                 "are wider than a cut-off of {:.2f} um.",
                 o.ranks, f.recipe.cell_x, f.recipe.cell_y, most, cut_off);
  if (const std::string wrong = wrong_program(o.liggghts); !wrong.empty())
    mistakes.add(0, wrong);
  mistakes.stop_if_any();
}

void write_slurry(const FilmRecipe &f, const DryOptions &o, const std::vector<Particle> &particles,
                  const std::string &identity) {
  nlohmann::json j = describe_slurry(f, particles, last_row(o.folder + "/slurry.csv"));
  fmt::print("dry: slurry of {:.3f} g/cm3 ({:.3f} by its parts), {:.1f} um, mixing index {:.3f}\n",
             j["density_g_cm3"].get<double>(), f.slurry_density(), j["thickness_um"].get<double>(),
             j["mixing_index"].get<double>());
  check_slurry(j, o.folder);
  write_file(o.folder + "/slurry.data",
             data_file(f.recipe, particles, f.slurry_thickness(), "Slurry made by calendem dry"));
  write_file(o.folder + "/slurry.vtp", picture_file(particles));
  j["identity"] = identity;
  write_file(o.folder + "/slurry.json", j.dump(2) + "\n");
}

// The slurry's particles: made, or as a run before left them.
std::vector<Particle> make_slurry(const FilmRecipe &f, const DryOptions &o, const Placement &start,
                                  const std::string &identity) {
  const bool there = made_of(o.folder + "/slurry.json", identity);
  fmt::print("dry: {} AM and {} CBD spheres{}\n", start.particles.size() - cbd_count(f.recipe),
             cbd_count(f.recipe), there ? "; their slurry is there already" : "");
  std::cout << std::flush;
  if (!there) {
    write_file(o.folder + "/start.data",
               data_file(f.recipe, start.particles, start.height, "Made by calendem dry"));
    simulate(o, "slurry");
  }
  std::vector<Particle> particles = start.particles;
  for (Particle &p : particles)
    if (p.type == 2) {
      p.diameter = f.wet_diameter();
      p.density = f.wet_density();
    }
  read_state(f, o.folder + "/slurry.dump", particles);
  if (!there)
    write_slurry(f, o, particles, identity);
  return particles;
}

nlohmann::json hand_over_film(const FilmRecipe &f, const DryOptions &o,
                              const std::vector<Particle> &slurry, std::vector<Particle> dried) {
  read_state(f, o.folder + "/dried.dump", dried);
  double top = f.recipe.thickness();
  for (const Particle &p : dried)
    top = std::max(top, p.x.z() + 0.5 * p.diameter);
  write_file(o.folder + "/dried.data",
             data_file(f.recipe, dried, top + 1.0, "Dried film made by calendem dry"));
  write_file(o.folder + "/dried.vtp", picture_file(dried));
  write_file(o.folder + "/film.csv", film_table(slurry, dried));
  write_file(o.folder + "/electrode.toml", hand_over(f));
  nlohmann::json j;
  j["am"] = dried.size() - cbd_count(f.recipe);
  j["cbd"] = cbd_count(f.recipe);
  j["dried"] =
      describe_film(f, dried, last_row(o.folder + "/stop.csv"), last_row(o.folder + "/rest.csv"));
  return j;
}

} // namespace

void dry_film(const FilmRecipe &f, DryOptions o) {
  o.folder = fs::absolute(o.folder).lexically_normal().string(); // LIGGGHTS runs in that folder
  o.liggghts = fs::absolute(o.liggghts).lexically_normal().string();
  const std::string identity = identity_of(f, o.liggghts, {"slurry", "drying"}),
                    of_slurry = identity_of(f, o.liggghts, {"slurry"}),
                    summary = o.folder + "/film.json";
  if (made_of(summary, identity)) {
    fmt::print("dry: {} already holds this film\n", o.folder);
    return;
  }
  const auto begin = std::chrono::steady_clock::now();
  const bool shaped = f.recipe.shapes.given();
  const ShapeLibrary library = shaped ? library_of(f.recipe) : ShapeLibrary{};
  const Placement start =
      place_spheres(f, shaped ? draw_counts(f.recipe, library) : draw_counts(f.recipe));
  check_cell(f, o, start.particles.front().diameter);
  make_output_folder(o.folder);
  require_own_file(o.folder + "/electrode.toml", "# The film that `calendem dry` left");
  std::error_code none;
  fs::remove(summary, none);
  if (shaped)
    write_library(library, o.folder + "/shapes");
  write_file(o.folder + "/film.in", film_variables(f, start.height));
  const std::vector<Particle> slurry = make_slurry(f, o, start, of_slurry);
  simulate(o, "drying");
  nlohmann::json j = hand_over_film(f, o, slurry, start.particles);
  const nlohmann::json &d = j["dried"];
  fmt::print("dry: film of {:.2f} um, total porosity {:.2f} % ({:+.2f} points from the recipe's), "
             "ended by the {} at {:.3f} MPa\n",
             d["thickness_um"].get<double>(), 100.0 * d["porosity_total"].get<double>(),
             d["porosity_difference_points"].get<double>(), d["stopped_by"].get<std::string>(),
             d["surface_pressure_MPa_at_stop"].get<double>());
  j["recipe"] = f.recipe.settings.all();
  j["provenance"] = {{"calendem", version()}, {"seed", f.recipe.seed}};
  j["wall_clock_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  try {
    check_film(d, f, o.folder);
  } catch (const Failure &) {
    write_file(o.folder + "/film.rejected.json", j.dump(2) + "\n");
    throw;
  }
  fs::remove(o.folder + "/film.rejected.json", none);
  j["identity"] = identity;
  write_file(summary, j.dump(2) + "\n");
}

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
  mistakes.add(
      s.line("slurry.sphere_fraction"),
      "slurry.sphere_fraction is {}: dry spheres fill {:.3f} of a slurry of {} % solids already, "
      "and above {} they jam. Give a value between, or lower slurry.solid_content_percent.",
      f.sphere_fraction, dry, 100.0 * f.solid_content, kJams);
}

} // namespace

const std::vector<Key> &film_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all;
    for (const Key &key : recipe_keys())
      if (key.name.rfind("structure.", 0) != 0)
        all.push_back(key);
    const std::vector<Key> own = {
        {"slurry.solid_content_percent", "", "69", 20, 90, "%",
         "mass fraction of solids in the slurry"},
        {"slurry.solvent_density_g_cm3", "", "1.028", 0.5, 2, "g/cm3",
         "density of the solvent; default: NMP at 25 C"},
        {"slurry.sphere_fraction", "", "0.55", 0.1, 0.6, "",
         "volume fraction of AM and CBD spheres, swollen with solvent, in the slurry"},
        {"drying.stop", "", "thickness", 0, 0, "",
         "what ends drying: the recipe's thickness is reached, or the film carries the capillary "
         "pressure",
         "thickness|pressure"},
        {"drying.capillary_pressure_MPa", "", "0.1", 1e-3, 10, "MPa",
         "largest pressure of the liquid's surface on the particles"},
        {"drying.porosity_tolerance_points", "", "0", 0, 20, "",
         "allowed difference of total porosity from the recipe's, in percentage points; 0: what "
         "one CBD diameter of thickness makes"},
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
  Settings s = read_toml(file, FileKind::Film, film_keys(), mistakes);
  const ReferenceMaterial material = take_material(s, file, film_keys(), mistakes);
  take_sizes_by_volume(s, film_keys(), mistakes);
  FilmRecipe f;
  f.recipe = recipe_of(s);
  f.recipe.material = material;
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
