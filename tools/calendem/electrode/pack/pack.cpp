// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/pack.h"
#include "base/liggghts_job.h"
#include "base/material_notes.h"
#include "base/output_folder.h"
#include "base/particle_sizes.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "electrode/pack/electrode_files.h"
#include "electrode/pack/from_image.h"
#include "electrode/pack/measured_bodies.h"
#include "physics/pi.h"
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace calendem {

namespace fs = std::filesystem;
namespace {

constexpr std::chrono::seconds kBetweenLines(30); // of progress, as `calendem run` has it

/// In one line of a terminal that changes, or line after line in a file.
void show_progress(const PackOptions &o, const Recipe &r, bool terminal, std::string &shown) {
  const LastRow row = last_row(o.folder + "/packing.csv");
  const std::string text =
      fmt::format("packing: gap {:.1f} um of {:.1f}, platen {:.3f} MPa, kinetic {:.3g} fJ",
                  row.gap_um, r.thickness(), row.pressure_MPa, row.kinetic_fJ);
  if (row.gap_um > 0.0 && text != shown)
    std::cout << (terminal ? "\r\033[K" : "") << text << (terminal ? "" : "\n") << std::flush;
  shown = text;
}

// A film in its places comes down by 0.1 um only. Bodies that overlap leave each other without flying:
// speeds decay within 50 steps.
std::vector<std::pair<std::string, std::string>> variables_in_place(const Recipe &r) {
  constexpr double kDecay = 0.02; // us, 50 steps of in.pack
  const auto mass = [](double d, double density) { return density * kPi / 6.0 * d * d * d; };
  const double primary = mass(r.primary_diameter, primary_density(r)),
               cbd = mass(r.cbd_diameter, cbd_density(r));
  return {{"collapse_um_us", "6"},
          {"drag", fmt::format("{:.6g}", primary / kDecay)},
          {"drag_cbd", fmt::format("{:.6g}", cbd / primary)}};
}

void densify(const PackOptions &o, const Recipe &r) {
  const FinalMaterial m(r.material);
  LiggghtsJob job;
  job.program = o.liggghts;
  job.ranks = o.ranks;
  job.script = input_scripts() + "/in.pack";
  job.log = o.folder + "/packing.log";
  job.screen = o.folder + "/packing.screen";
  job.variables = {{"out", o.folder},
                   {"scripts", input_scripts()},
                   {"E_am_GPa", fmt::format("{}", m.E_am_GPa)},
                   {"E_cbd_GPa", fmt::format("{}", m.E_cbd_GPa)},
                   {"nu_am", fmt::format("{}", m.nu_am)},
                   {"nu_cbd", fmt::format("{}", m.nu_cbd)},
                   {"ced_am_J_m3", fmt::format("{}", m.ced_am_J_m3)},
                   {"ced_cbd_J_m3", fmt::format("{}", m.ced_cbd_J_m3)}};
  if (r.structure.of_image)
    for (const auto &variable : variables_in_place(r))
      job.variables.push_back(variable);
  const bool terminal = isatty(1);
  std::string shown;
  auto last = std::chrono::steady_clock::now();
  run_liggghts(job, [&] {
    const auto now = std::chrono::steady_clock::now();
    if (!terminal && now - last < kBetweenLines)
      return;
    last = now;
    show_progress(o, r, terminal, shown);
  });
  if (terminal)
    std::cout << "\r\033[K";
}

void check_machine(const Recipe &r, const PackOptions &o) {
  Mistakes mistakes("pack");
  const int most = most_ranks(r.cell_x, r.cell_y, std::max(r.primary_diameter, r.cbd_diameter));
  if (o.ranks > most)
    mistakes.add(0,
                 fmt::format("--ranks {}: a cell of {} x {} um can be shared by at most {} ranks "
                             "whose parts are wider than a cut-off.",
                             o.ranks, r.cell_x, r.cell_y, most));
  if (const std::string wrong = wrong_program(o.liggghts); !wrong.empty())
    mistakes.add(0, wrong);
  constexpr double kMost = 2e6;
  const double primaries = r.am_column() * r.area() / std::pow(r.lattice, 3),
               spheres = primaries + r.cbd_solid_column() * r.area() /
                                         (kPi / 6.0 * std::pow(r.cbd_diameter, 3));
  if (!r.structure.given() && spheres > kMost)
    mistakes.add(
        0, fmt::format("a cell of {} x {} um needs about {:.2g} spheres; at most {:g} are allowed. "
                       "Make the cell smaller, or the spheres larger.",
                       r.cell_x, r.cell_y, spheres, kMost));
  mistakes.stop_if_any();
}

nlohmann::json finish(const PackInput &in, BodiesToPack &start, const std::string &folder) {
  const Recipe &recipe = in.recipe;
  const std::vector<Body> &bodies = start.made.bodies;
  std::vector<Particle> &particles = start.placed.loose.particles;
  read_positions(folder + "/packed.dump", particles);
  const PackingState state = examine(recipe, bodies, particles, FinalMaterial(recipe.material));
  const std::vector<Pose> poses = find_poses(recipe, bodies, particles);
  const double height = std::max(recipe.thickness(), state.highest_um) + 1.0;
  write_file(folder + "/electrode.data", data_file(recipe, particles, height));
  write_file(folder + "/bodies.csv", bodies_table(bodies, poses, state));
  write_file(folder + "/vtk/electrode.vtp", picture_file(particles));
  nlohmann::json j =
      describe({recipe, bodies, particles, poses, state, last_row(folder + "/packing.csv")});
  add_origin(j, in, start, poses);
  j["material"] = to_json(recipe.material);
  j[kMaterialNotes] = notes_of(recipe);
  return j;
}

/// A run keeps a copy of its electrode's electrode.json, and a bodies.csv of its own.
void stop_if_run(const std::string &folder) {
  if (fs::exists(folder + "/summary.json"))
    throw Failure(kBadInput, fmt::format("'{}' holds a run, whose bodies.csv would be replaced. "
                                         "Give another folder with -o.",
                                         folder));
}

bool is_whole(const std::string &folder) {
  for (const char *name : {"electrode.data", "bodies.csv", "bodies.map"})
    if (!fs::exists(fs::path(folder) / name))
      return false;
  return true;
}

// Throws Failure(4).
void check(const nlohmann::json &electrode, const Recipe &recipe, const std::string &folder) {
  if (recipe.structure.given())
    check_kept(electrode["structure"], folder);
  check_targets(electrode, recipe, folder);
}

} // namespace

std::string packing_tools(const std::string &liggghts) {
  return version() + hash_of_file(liggghts) + hash_of_file(input_scripts() + "/in.pack");
}

namespace {

/// The settings that a packing depends on.
std::map<std::string, std::string> settings_of(const Recipe &recipe) {
  std::map<std::string, std::string> out;
  for (const auto &[key, value] : recipe.settings.all())
    if ((recipe.shapes.given() || key.rfind("shapes.", 0) != 0) &&
        (recipe.structure.given() || key.rfind("structure.", 0) != 0))
      out[key] = value;
  return out;
}

std::string hash_of_sources(const Recipe &recipe) {
  return hash_of_shapes(recipe) + hash_of_structure(recipe.structure);
}

/// Another program makes the same electrode; one of another recipe would be lost.
void stop_if_of_another_recipe(const std::string &folder, const Recipe &recipe) {
  const nlohmann::json old = RunFolder(folder).object("electrode.json");
  if (!old.is_object() || !old.contains(kRecipeGiven))
    return;
  const auto then = old[kRecipeGiven].get<std::map<std::string, std::string>>();
  std::string text;
  for (const auto &[key, now] : settings_of(recipe))
    if (const auto at = then.find(key); at != then.end() && at->second != now)
      text += fmt::format("\n  {}: then {}, now {}", key, at->second, now);
  const std::string sources = hash_of_sources(recipe);
  if (text.empty() && old.value("sources", sources) != sources)
    text = "\n  the files of [shapes] or [structure]";
  if (!text.empty())
    throw Failure(kBadInput, fmt::format("'{}' holds an electrode of another recipe. Give another "
                                         "-o, or --force to overwrite it. What differs:{}",
                                         folder, text));
}

} // namespace

std::string packing_identity(const Recipe &recipe, const std::string &tools) {
  std::string text = tools;
  for (const auto &[key, value] : settings_of(recipe))
    text += fmt::format("{}={}\n", key, value);
  for (const auto &[key, value] : recipe.material.values) // not their sources
    text += fmt::format("{}={}\n", key, value.text);
  return hash_of_text(text + hash_of_sources(recipe));
}

namespace {

void say(const nlohmann::json &electrode) {
  const auto number = [&](const char *key) { return electrode[key].get<double>(); };
  fmt::print("pack: loading {:.2f} mg/cm2, total porosity {:.2f} %, platen {:.3f} MPa, largest "
             "force between bodies {:.0f} nN, {:.0f} s\n",
             number("loading_mg_cm2"), 100 * number("porosity_total"),
             number("platen_pressure_MPa"), number("largest_body_force_nN"),
             number("wall_clock_s"));
  for (const std::string &warning : warnings_of_electrode(electrode))
    fmt::print(stderr, "warning: {}\n", warning);
}

} // namespace

void pack_electrode(const Recipe &as_given, PackOptions o) {
  o.folder = fs::absolute(o.folder).lexically_normal().string(); // LIGGGHTS runs in that folder
  o.liggghts = fs::absolute(o.liggghts).lexically_normal().string();
  const std::string summary = o.folder + "/electrode.json",
                    identity = packing_identity(as_given, packing_tools(o.liggghts));
  stop_if_run(o.folder);
  if (made_of(summary, identity) && is_whole(o.folder)) {
    fmt::print("pack: {} already holds this electrode\n", o.folder);
    return;
  }
  if (!o.force)
    stop_if_of_another_recipe(o.folder, as_given);
  const auto begin = std::chrono::steady_clock::now();
  const PackInput in = read_input(as_given);
  check_machine(in.recipe, o);
  make_output_folder(o.folder);
  const FolderLock lock(o.folder);
  fs::create_directories(o.folder + "/vtk");
  std::error_code none;
  fs::remove(summary, none);
  fs::remove(o.folder + "/electrode.rejected.json", none);
  BodiesToPack start = make_bodies_to_pack(in, o.folder);
  densify(o, in.recipe);
  nlohmann::json j = finish(in, start, o.folder);
  j["wall_clock_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  j["ranks"] = o.ranks;
  say(j);
  try {
    check(j, in.recipe, o.folder);
  } catch (const Failure &) {
    write_file(o.folder + "/electrode.rejected.json", j.dump(2) + "\n");
    throw;
  }
  j["identity"] = identity;
  j[kRecipeGiven] = settings_of(as_given);
  if (const std::string sources = hash_of_sources(as_given); !sources.empty())
    j["sources"] = sources;
  write_file(summary, j.dump(2) + "\n");
}

namespace {

ShapeLibrary open_library(const Recipe &recipe, const std::string &folder) {
  ShapeLibrary library = library_of(recipe);
  fmt::print("pack: {} shapes of {} labels; the border cuts {}, {} have too few voxels\n",
             library.shapes.size(), library.labels, library.cut.size(), library.coarse.size());
  if (!recipe.shapes.image.empty())
    write_library(library, folder + "/shapes");
  return library;
}

BodiesOfStructure bodies_with(const PackInput &in, const ShapeLibrary *library) {
  const Recipe &r = in.recipe;
  if (!r.structure.given())
    return {library ? make_bodies(r, *library) : make_bodies(r), {}, {}};
  if (r.structure.clusters)
    return bodies_of_clusters(r, in.structure);
  return bodies_of_spheres(r, in.structure,
                           [&](const ExistingSphere &sphere, int count, Random &random) {
                             return in.image  ? make_body(r, *in.image, sphere, count, random)
                                    : library ? make_body(r, *library, count, random)
                                              : make_body(r, count, random);
                           });
}

// Bodies and, with measured shapes, what electrode.json says of them.
BodiesToPack make_all_bodies(const PackInput &in, const std::string &folder) {
  const Recipe &r = in.recipe;
  BodiesToPack out;
  if (!r.shapes.given() || in.image) {
    out.made = bodies_with(in, nullptr);
    return out;
  }
  const ShapeLibrary library = open_library(r, folder);
  out.made = bodies_with(in, &library);
  write_file(folder + "/shapes_used.csv", shapes_used(library, out.made.bodies));
  out.shapes = describe_shapes(r, library, out.made.bodies);
  if (r.shapes.measured_sizes && !r.structure.given()) {
    const double limit = largest_diameter(r, library);
    out.shapes[kLargestAllowed] = limit;
    out.shapes[kCutOff] = library.volume_above(limit);
  }
  return out;
}

} // namespace

BodiesToPack make_bodies_to_pack(const PackInput &in, const std::string &folder) {
  const Recipe &r = in.recipe;
  BodiesToPack out = make_all_bodies(in, folder);
  if (r.structure.given()) {
    out.placed = in.image ? place_in_place(r, in.structure, out.made)
                          : place_as_in_structure(r, in.structure, out.made);
    write_file(folder + "/structure.csv", structure_table(in.structure, out.made));
  } else
    out.placed.loose = place(r, out.made.bodies);
  const Placement &loose = out.placed.loose;
  if (const std::string sizes = sizes_in_words(r); !sizes.empty())
    fmt::print("pack: {}\n", sizes);
  fmt::print("pack: {} bodies, {} spheres, densifying from {:.0f} to {:.1f} um\n",
             out.made.bodies.size(), loose.particles.size(), loose.height, r.thickness());
  std::cout << std::flush;
  write_file(folder + "/start.data", data_file(r, loose.particles, loose.height));
  write_file(folder + "/bodies.map", body_map(loose.particles));
  write_file(folder + "/electrode.in", script_variables(r, r.thickness()));
  return out;
}

void add_origin(nlohmann::json &electrode, const PackInput &in, const BodiesToPack &start,
                const std::vector<Pose> &poses) {
  const Recipe &r = in.recipe;
  nlohmann::json shapes = start.shapes;
  for (const char *key : {kLargestAllowed, kCutOff})
    if (shapes.contains(key)) {
      electrode[key] = shapes[key];
      shapes.erase(key);
    }
  if (!shapes.is_null() || r.structure.clusters)
    electrode["sphericity_how"] =
        fmt::format("surface of the sphere of equal volume over the smoothed surface of the {}",
                    r.structure.clusters ? "given cluster" : "measured particle");
  if (!shapes.is_null())
    electrode["shapes"] = shapes;
  if (!r.structure.given())
    return;
  for (const char *key : {kLargestAllowed, kCutOff}) // a structure comes through whole
    electrode.erase(key);
  if (in.image)
    electrode["image"] = describe_image(r, *in.image, start.placed.loose.particles);
  electrode["structure"] = describe_structure(r, in.structure, start.made, start.placed, poses,
                                              start.placed.loose.particles);
}

} // namespace calendem
