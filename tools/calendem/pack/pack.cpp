// SPDX-License-Identifier: GPL-2.0-or-later
#include "pack/pack.h"
#include "pack/description.h"
#include "pack/electrode_files.h"
#include "pack/measured_bodies.h"
#include "run/process.h"
#include "spec/provenance.h"
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

namespace calendem {
namespace fs = std::filesystem;
namespace {

LastRow last_row(const std::string &file) {
  std::ifstream in(file);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty() && line.find_first_of("0123456789") == 0)
      last = line;
  LastRow row;
  double step = 0;
  char comma = 0;
  std::istringstream(last) >> step >> comma >> row.gap_um >> comma >> row.pressure_MPa >> comma >>
      row.kinetic_fJ;
  return row;
}

void show_progress(const PackOptions &o, const Recipe &r, std::string &shown) {
  const LastRow row = last_row(o.folder + "/packing.csv");
  const std::string text =
      fmt::format("packing: gap {:.1f} um of {:.1f}, platen {:.3f} MPa, kinetic {:.3g} fJ",
                  row.gap_um, r.thickness(), row.pressure_MPa, row.kinetic_fJ);
  if (row.gap_um > 0.0 && text != shown)
    std::cout << "\r\033[K" << text << std::flush;
  shown = text;
}

void densify(const PackOptions &o, const Recipe &r) {
  const FinalMaterial m;
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
                   {"ced_am_J_m3", fmt::format("{}", m.ced_am_J_m3)},
                   {"ced_cbd_J_m3", fmt::format("{}", m.ced_cbd_J_m3)}};
  const bool terminal = isatty(1);
  std::string shown;
  run_liggghts(job, [&] {
    if (terminal)
      show_progress(o, r, shown);
  });
  if (terminal)
    std::cout << "\r\033[K";
}

// Everything the result depends on.
std::string identity_of(const Recipe &recipe, const std::string &liggghts) {
  std::string text =
      version() + hash_of_file(liggghts) + hash_of_file(input_scripts() + "/in.pack");
  for (const auto &[key, value] : recipe.settings.all())
    if (recipe.shapes.given() || key.rfind("shapes.", 0) != 0)
      text += key + "=" + value + "\n";
  return hash_of_text(text + hash_of_shapes(recipe));
}

bool holds_already(const std::string &summary, const std::string &identity) {
  std::ifstream in(summary);
  const nlohmann::json old = nlohmann::json::parse(in, nullptr, false);
  return old.is_object() && old.value("identity", "") == identity;
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
  mistakes.stop_if_any();
}

void make_folder(const std::string &folder) {
  std::error_code error;
  fs::create_directories(folder + "/vtk", error);
  if (error)
    throw Failure(kBadInput, fmt::format("cannot make the folder '{}': {}. Give a folder that can "
                                         "be written with -o",
                                         folder, error.message()));
}

// Bodies and CBD, placed loosely, written for in.pack.
Placement start(const Recipe &recipe, const std::vector<Body> &bodies, const std::string &folder) {
  Placement loose = place(recipe, bodies);
  fmt::print("pack: {} bodies, {} particles, densifying from {:.0f} to {:.1f} um\n", bodies.size(),
             loose.particles.size(), loose.height, recipe.thickness());
  std::cout << std::flush;
  write_file(folder + "/start.data", data_file(recipe, loose.particles, loose.height));
  write_file(folder + "/bodies.map", body_map(loose.particles));
  write_file(folder + "/electrode.in", script_variables(recipe, recipe.thickness()));
  return loose;
}

// Bodies of the recipe and, with measured shapes, what electrode.json says of them.
struct Made {
  std::vector<Body> bodies;
  nlohmann::json shapes;
};

Made bodies_of(const Recipe &recipe, const std::string &folder) {
  if (!recipe.shapes.given())
    return {make_bodies(recipe), {}};
  const ShapeLibrary library = library_of(recipe);
  fmt::print("pack: {} shapes of {} labels; the border cuts {}, {} have too few voxels\n",
             library.shapes.size(), library.labels, library.cut.size(), library.coarse.size());
  make_folder(folder);
  if (!recipe.shapes.image.empty())
    write_library(library, folder + "/shapes");
  Made made{make_bodies(recipe, library), {}};
  write_file(folder + "/shapes_used.csv", shapes_used(library, made.bodies));
  made.shapes = describe_shapes(recipe, library, made.bodies);
  if (recipe.shapes.measured_sizes) {
    const double limit = largest_diameter(recipe, library);
    made.shapes["largest_equivalent_diameter_allowed_um"] = limit;
    made.shapes["volume_fraction_cut_off_by_size_limit"] = library.volume_above(limit);
  }
  return made;
}

// What describe() says of the recipe's own shapes and sizes gives way to the measured ones.
void add_shapes(nlohmann::json &electrode, nlohmann::json shapes) {
  for (const char *key :
       {"largest_equivalent_diameter_allowed_um", "volume_fraction_cut_off_by_size_limit"})
    if (shapes.contains(key)) {
      electrode[key] = shapes[key];
      shapes.erase(key);
    }
  electrode["sphericity_how"] = "surface of the sphere of equal volume over the smoothed surface "
                                "of the measured particle";
  electrode["shapes"] = shapes;
}

nlohmann::json finish(const Recipe &recipe, const std::vector<Body> &bodies,
                      std::vector<Particle> &particles, const std::string &folder) {
  read_positions(folder + "/packed.dump", particles);
  const PackingState state = examine(recipe, bodies, particles);
  const std::vector<Pose> poses = find_poses(recipe, bodies, particles);
  const double height = std::max(recipe.thickness(), state.highest_um) + 1.0;
  write_file(folder + "/electrode.data", data_file(recipe, particles, height));
  write_file(folder + "/bodies.csv", bodies_table(bodies, poses, state));
  write_file(folder + "/vtk/electrode.vtp", picture_file(particles));
  return describe({recipe, bodies, particles, poses, state, last_row(folder + "/packing.csv")});
}

} // namespace

void pack_electrode(const Recipe &recipe, PackOptions o) {
  o.folder = fs::absolute(o.folder).lexically_normal().string(); // LIGGGHTS runs in that folder
  o.liggghts = fs::absolute(o.liggghts).lexically_normal().string();
  const std::string summary = o.folder + "/electrode.json",
                    identity = identity_of(recipe, o.liggghts);
  if (holds_already(summary, identity)) {
    fmt::print("pack: {} already holds this electrode\n", o.folder);
    return;
  }
  check_machine(recipe, o);
  const auto begin = std::chrono::steady_clock::now();
  const auto [bodies, shapes] = bodies_of(recipe, o.folder);
  make_folder(o.folder);
  std::error_code none;
  fs::remove(summary, none);
  fs::remove(o.folder + "/electrode.rejected.json", none);
  Placement loose = start(recipe, bodies, o.folder);
  densify(o, recipe);
  nlohmann::json j = finish(recipe, bodies, loose.particles, o.folder);
  if (!shapes.is_null())
    add_shapes(j, shapes);
  j["wall_clock_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  j["ranks"] = o.ranks;
  fmt::print("pack: loading {:.2f} mg/cm2, total porosity {:.2f} %, platen {:.3f} MPa, largest "
             "force between bodies {:.0f} nN, {:.0f} s\n",
             j["loading_mg_cm2"].get<double>(), 100 * j["porosity_total"].get<double>(),
             j["platen_pressure_MPa"].get<double>(), j["largest_body_force_nN"].get<double>(),
             j["wall_clock_s"].get<double>());
  try {
    check_targets(j, recipe, o.folder);
  } catch (const Failure &) {
    write_file(o.folder + "/electrode.rejected.json", j.dump(2) + "\n");
    throw;
  }
  j["identity"] = identity;
  write_file(summary, j.dump(2) + "\n");
}

} // namespace calendem
