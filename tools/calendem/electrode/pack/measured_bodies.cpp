// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/measured_bodies.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "electrode/pack/body.h"
#include "electrode/structure/separated_particles.h"
#include "electrode/structure/slices.h"
#include "physics/pi.h"
#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

constexpr int kNeighbours = 4; // on either side in the list by size

double equivalent_diameter(double volume) { return std::cbrt(6.0 / kPi * volume); }

// One of the shapes nearest in size.
const MeasuredShape &choose(const ShapeLibrary &l, double diameter, Random &random) {
  const auto above =
      std::lower_bound(l.shapes.begin(), l.shapes.end(), diameter,
                       [](const MeasuredShape &s, double d) { return s.equivalent_diameter < d; });
  const int size = int(l.shapes.size()), at = int(above - l.shapes.begin());
  const int first = std::clamp(at - kNeighbours, 0, std::max(0, size - 2 * kNeighbours - 1));
  const int choices = std::min(2 * kNeighbours + 1, size);
  return l.shapes[first + std::min(choices - 1, int(random.uniform() * choices))];
}

// Diameters of the measured law below the limit of the cell.
std::vector<double> measured_diameters(const Recipe &r, const ShapeLibrary &l, double volume,
                                       Random &random) {
  const double limit = largest_diameter(r, l);
  if (limit < l.shapes.front().equivalent_diameter)
    throw Failure(kBadInput,
                  fmt::format("no measured particle fits a cell of {} x {} um: the smallest is "
                              "{:.2f} um, the largest allowed {:.2f} um. Make the cell larger",
                              r.cell_x, r.cell_y, l.shapes.front().equivalent_diameter, limit));
  const double share = l.number_below(limit);
  return draw_diameters([&](double q) { return std::min(limit, l.quantile(q * share)); }, volume,
                        random);
}

} // namespace

ShapeLibrary library_of(const Recipe &r) {
  if (r.shapes.image.empty())
    return read_library(r.shapes.library);
  LabelImage image = read_label_image(r.shapes.image, r.shapes.voxel_um);
  if (r.shapes.phases.given())
    image = separate_particles(image, r.shapes.phases, r.shapes.neck);
  ShapeLibrary l =
      make_library(image, r.shapes.phases.given() ? 0 : r.shapes.background, r.shapes.image);
  l.source_hash = hash_of_image(r.shapes.image);
  return l;
}

namespace {

double mean_sphericity(const ShapeLibrary &l) {
  double sum = 0.0;
  for (const MeasuredShape &s : l.shapes)
    sum += s.sphericity / double(l.shapes.size());
  return sum;
}

struct Neck {
  double neck;
  ShapeLibrary library;
};

std::string table_of(const std::vector<Neck> &necks) {
  std::string out = "neck,particles,whole,cut_by_border,fewer_than_200_voxels,D10_um,D50_um,D90_um,"
                    "sphericity\n";
  for (const auto &[neck, l] : necks)
    out += fmt::format("{:g},{},{},{},{},{:.3f},{:.3f},{:.3f},{:.4f}\n", neck, l.labels,
                       l.shapes.size(), l.cut.size(), l.coarse.size(), l.volume_quantile(0.1),
                       l.volume_quantile(0.5), l.volume_quantile(0.9), mean_sphericity(l));
  return out;
}

// The recipe's neck, one narrower and one wider: where they give like numbers, the cuts are real.
std::vector<Neck> separate_at_necks(const Recipe &r, const LabelImage &image,
                                    const std::string &folder) {
  constexpr double kStep = 0.05;
  std::vector<Neck> out;
  for (const double neck : {r.shapes.neck - kStep, r.shapes.neck, r.shapes.neck + kStep}) {
    if (neck >= 1.0)
      continue;
    const LabelImage particles = separate_particles(image, r.shapes.phases, neck);
    out.push_back({neck, make_library(particles, 0, r.shapes.image)});
    if (neck != r.shapes.neck)
      continue;
    write_library(out.back().library, folder);
    write_label_image(particles, folder + "/particles.tif");
    draw_particles(image, r.shapes.phases, particles, folder + "/slices.png");
  }
  return out;
}

} // namespace

void write_shapes(const Recipe &r, const std::string &folder) {
  if (r.shapes.image.empty())
    throw Failure(kBadInput, fmt::format("{}: it has no shapes.image that shapes could be taken "
                                         "from. Give one, or leave --shapes-only out.",
                                         r.file));
  make_output_folder(folder);
  const std::string shapes = folder + "/shapes";
  if (!r.shapes.phases.given()) {
    const ShapeLibrary library = library_of(r);
    write_library(library, shapes);
    fmt::print("pack: {} shapes of {} labels: {}/shapes.csv\n", library.shapes.size(),
               library.labels, shapes);
    return;
  }
  const std::string table =
      table_of(separate_at_necks(r, read_label_image(r.shapes.image, r.shapes.voxel_um), shapes));
  write_file(shapes + "/necks.csv", table);
  fmt::print("{0}pack: shapes of neck {1:g}: {2}/shapes.csv, outlines: {2}/slices.png, labels: "
             "{2}/particles.tif\n",
             table, r.shapes.neck, shapes);
}

std::string hash_of_shapes(const Recipe &r) {
  if (!r.shapes.image.empty())
    return hash_of_image(r.shapes.image);
  return r.shapes.library.empty() ? "" : hash_of_folder(r.shapes.library);
}

double largest_diameter(const Recipe &r, const ShapeLibrary &l) {
  double elongation = 0.0; // width over equivalent diameter
  for (const MeasuredShape &s : l.shapes)
    elongation += 2.0 * s.reach / s.equivalent_diameter / double(l.shapes.size());
  return (r.widest_body() - r.primary_diameter) / std::max(1.0, elongation);
}

Body make_body(const Recipe &recipe, const ShapeLibrary &library, int count, Random &random) {
  const double diameter = std::cbrt(6.0 / kPi * count) * recipe.lattice;
  return make_body(recipe, count, random, [&](Random &r) {
    const MeasuredShape &shape = choose(library, diameter, r);
    const double scale = diameter / shape.equivalent_diameter;
    const auto depth = [&shape, scale](const Eigen::Vector3d &x) {
      return shape.depth_at(x / scale);
    };
    return Hull{depth, scale * shape.reach + recipe.lattice, [&shape] { return shape.sphericity; },
                shape.name};
  });
}

std::vector<int> draw_counts(const Recipe &recipe, const ShapeLibrary &library) {
  const double volume = recipe.area() * recipe.am_column();
  Random sizes(recipe.seed, 1);
  const std::vector<double> diameters = recipe.shapes.measured_sizes
                                            ? measured_diameters(recipe, library, volume, sizes)
                                            : draw_diameters(recipe, volume, sizes);
  const int total = static_cast<int>(std::lround(volume / std::pow(recipe.lattice, 3)));
  return primary_counts(diameters, recipe.lattice, total);
}

std::vector<Body> make_bodies(const Recipe &recipe, const ShapeLibrary &library) {
  Random shapes(recipe.seed, 2);
  std::vector<Body> bodies;
  for (int count : draw_counts(recipe, library))
    bodies.push_back(make_body(recipe, library, count, shapes));
  return bodies;
}

nlohmann::json describe_shapes(const Recipe &r, const ShapeLibrary &l,
                               const std::vector<Body> &bodies) {
  double packed_volume = 0.0;
  std::vector<double> volumes;
  for (const Body &b : bodies) {
    volumes.push_back(b.volume);
    packed_volume += b.volume;
  }
  std::sort(volumes.begin(), volumes.end());
  nlohmann::json measured, packed;
  for (const double q : {0.1, 0.5, 0.9}) {
    const std::string name = fmt::format("D{:.0f}", 100 * q);
    measured[name] = l.volume_quantile(q);
    double sum = 0.0;
    for (const double v : volumes)
      if ((sum += v) >= q * packed_volume) {
        packed[name] = equivalent_diameter(v);
        break;
      }
  }
  return {{"source", l.source},
          {"source_hash", l.source_hash},
          {"labels", l.labels},
          {"shapes", l.shapes.size()},
          {"cut_by_border", l.cut.size()},
          {"too_few_voxels", l.coarse.size()},
          {"sphericity_mean", mean_sphericity(l)},
          {"sizes", r.structure.given()       ? "structure"
                    : r.shapes.measured_sizes ? "measured"
                                              : "recipe"},
          {"volume_percentiles_measured_um", measured},
          {"volume_percentiles_packed_um", packed}};
}

std::string shapes_used(const ShapeLibrary &l, const std::vector<Body> &bodies) {
  std::string out = "body,shape,scale\n";
  for (size_t k = 0; k < bodies.size(); ++k) {
    const auto shape = std::find_if(l.shapes.begin(), l.shapes.end(), [&](const MeasuredShape &s) {
      return s.name == bodies[k].shape;
    });
    out += fmt::format("{},{},{:.4f}\n", k + 1, shape->name,
                       equivalent_diameter(bodies[k].volume) / shape->equivalent_diameter);
  }
  return out;
}

} // namespace calendem
