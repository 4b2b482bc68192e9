// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/slurry/dry.h"
#include "base/liggghts_job.h"
#include "base/provenance.h"
#include "electrode/pack/electrode_files.h"
#include "electrode/pack/measured_bodies.h"
#include "electrode/slurry/film_files.h"
#include <chrono>
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
    text += key + "=" + value + "\n";
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
  job.variables = {{"out", o.folder}};
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
    mistakes.add(0, fmt::format("the largest sphere of the slurry is {:.2f} um wide, but in a cell "
                                "of {} x {} um at most {:.2f} um are allowed: it would touch two "
                                "images of another. Make the cell larger or lower "
                                "particles.max_um.",
                                largest, f.recipe.cell_x, f.recipe.cell_y, 0.5 * side - 0.3));
  else if (const int most = int(f.recipe.cell_x / cut_off) * int(f.recipe.cell_y / cut_off);
           o.ranks > most)
    mistakes.add(0, fmt::format("--ranks {}: a cell of {} x {} um can be shared by at most {} "
                                "ranks whose parts are wider than a cut-off of {:.2f} um.",
                                o.ranks, f.recipe.cell_x, f.recipe.cell_y, most, cut_off));
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

} // namespace calendem
