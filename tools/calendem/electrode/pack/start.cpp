// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/start.h"
#include "base/provenance.h"
#include "electrode/pack/electrode_files.h"
#include "electrode/pack/given_description.h"
#include "electrode/pack/measured_bodies.h"
#include <filesystem>
#include <fmt/format.h>
#include <iostream>

namespace calendem {
namespace fs = std::filesystem;
namespace {

const char *const kLargest = "largest_equivalent_diameter_allowed_um";
const char *const kCutOff = "volume_fraction_cut_off_by_size_limit";

ShapeLibrary open_library(const Recipe &recipe, const std::string &folder) {
  ShapeLibrary library = library_of(recipe);
  fmt::print("pack: {} shapes of {} labels; the border cuts {}, {} have too few voxels\n",
             library.shapes.size(), library.labels, library.cut.size(), library.coarse.size());
  if (!recipe.shapes.image.empty())
    write_library(library, folder + "/shapes");
  return library;
}

GivenBodies bodies_with(const PackInput &in, const ShapeLibrary *library) {
  const Recipe &r = in.recipe;
  if (!r.structure.given())
    return {library ? make_bodies(r, *library) : make_bodies(r), {}, {}};
  if (r.structure.clusters)
    return bodies_of_clusters(r, in.structure);
  return bodies_of_spheres(r, in.structure, [&](int count, Random &random) {
    return library ? make_body(r, *library, count, random) : make_body(r, count, random);
  });
}

// Bodies and, with measured shapes, what electrode.json says of them.
Start make_all_bodies(const PackInput &in, const std::string &folder) {
  const Recipe &r = in.recipe;
  Start out;
  if (!r.shapes.given()) {
    out.made = bodies_with(in, nullptr);
    return out;
  }
  const ShapeLibrary library = open_library(r, folder);
  out.made = bodies_with(in, &library);
  write_file(folder + "/shapes_used.csv", shapes_used(library, out.made.bodies));
  out.shapes = describe_shapes(r, library, out.made.bodies);
  if (r.shapes.measured_sizes && !r.structure.given()) {
    const double limit = largest_diameter(r, library);
    out.shapes[kLargest] = limit;
    out.shapes[kCutOff] = library.volume_above(limit);
  }
  return out;
}

} // namespace

Start make_start(const PackInput &in, const std::string &folder) {
  const Recipe &r = in.recipe;
  Start out = make_all_bodies(in, folder);
  if (r.structure.given()) {
    out.placed = place_as_given(r, in.structure, out.made);
    write_file(folder + "/structure.csv", structure_table(in.structure, out.made));
  } else
    out.placed.loose = place(r, out.made.bodies);
  const Placement &loose = out.placed.loose;
  fmt::print("pack: {} bodies, {} particles, densifying from {:.0f} to {:.1f} um\n",
             out.made.bodies.size(), loose.particles.size(), loose.height, r.thickness());
  std::cout << std::flush;
  write_file(folder + "/start.data", data_file(r, loose.particles, loose.height));
  write_file(folder + "/bodies.map", body_map(loose.particles));
  write_file(folder + "/electrode.in", script_variables(r, r.thickness()));
  return out;
}

void add_origin(nlohmann::json &electrode, const PackInput &in, const Start &start,
                const std::vector<Pose> &poses) {
  const Recipe &r = in.recipe;
  nlohmann::json shapes = start.shapes;
  for (const char *key : {kLargest, kCutOff})
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
  for (const char *key : {kLargest, kCutOff}) // a structure comes through whole
    electrode.erase(key);
  electrode["structure"] = describe_structure(r, in.structure, start.made, start.placed, poses,
                                              start.placed.loose.particles);
}

} // namespace calendem
