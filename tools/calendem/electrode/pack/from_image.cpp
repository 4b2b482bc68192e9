// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/from_image.h"
#include "electrode/pack/grains.h"
#include "electrode/structure/separated_particles.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <numeric>
#include <tuple>

namespace calendem {
namespace {

double sphere_diameter(double volume) { return std::cbrt(6.0 / kPi * volume); }

// Bottom and top of the crop, in voxels.
std::array<int, 2> heights_of(const Recipe &r, const LabelImage &image) {
  const double dz = image.voxel.z(), top = image.n[2] * dz;
  const double high = r.shapes.high > 0.0 ? r.shapes.high : top;
  if (high > top + 0.5 * dz || r.shapes.low > high - dz)
    throw Failure(kBadInput, fmt::format("{}: shapes.crop is from {:g} to {:g} um high; the image "
                                         "ends at {:.4g} um. Give heights inside it.",
                                         r.file, r.shapes.low, high, top));
  return {int(std::lround(r.shapes.low / dz)), std::min(image.n[2], int(std::lround(high / dz)))};
}

struct Side {
  int first, voxels;
  double length; ///< [um]
};

Side side_of(const Recipe &r, const LabelImage &image, int axis) {
  const double d = image.voxel[axis], whole = image.n[axis] * d;
  const double given = axis == 0 ? r.structure.side_x : r.structure.side_y;
  const double middle = axis == 0 ? r.shapes.middle_x : r.shapes.middle_y;
  const double length = given > 0.0 ? given : whole, from = 0.5 * (whole - length) + middle;
  if (from < -0.5 * d || from + length > whole + 0.5 * d)
    throw Failure(
        kBadInput,
        fmt::format("{}: the crop is from {:.4g} to {:.4g} um along {}; the image from 0 "
                    "to {:.4g} um. Give a smaller cell.{}_um, or another shapes.crop.{}_um.",
                    r.file, from, from + length, "xy"[axis], whole, "xy"[axis], "xy"[axis]));
  const int first = std::max(0, int(std::lround(from / d)));
  return {first, std::min(image.n[axis] - first, std::max(1, int(std::lround(length / d)))),
          length};
}

LabelImage between(const LabelImage &image, const std::array<int, 2> &heights) {
  LabelImage out = image;
  out.n[2] = heights[1] - heights[0];
  const size_t layer = size_t(image.n[0]) * image.n[1];
  out.label.assign(image.label.begin() + long(layer * heights[0]),
                   image.label.begin() + long(layer * heights[1]));
  return out;
}

struct Candidate {
  const Region *region;
  double inside;      ///< share of it in the crop
  double taken = 0.0; ///< share of it whose place others have, across the crop's sides
};

// The particles, and the way from the image to the film.
class Cutter {
public:
  Cutter(const Recipe &recipe, const LabelImage &image)
      : recipe_(recipe), x_(side_of(recipe, image, 0)), y_(side_of(recipe, image, 1)) {
    const std::array<int, 2> z = heights_of(recipe, image);
    const PhaseLabels &phases = recipe.shapes.phases;
    if (!phases.given())
      refuse_negative_labels(image, {recipe.shapes.background});
    const LabelImage particles =
        phases.given() ? separate_particles(image, phases, recipe.shapes.neck) : image;
    background_ = phases.given() ? 0 : recipe.shapes.background;
    slab_ = between(particles, z);
    film_.corner = {x_.first, y_.first, z[0]};
    film_.structure.lx = x_.length;
    film_.structure.ly = y_.length;
    film_.structure.extent = film_.structure.thickness = slab_.n[2] * slab_.voxel.z();
    film_.cbd_of_image = phases.given() && phases.cbd != phases.pore;
    cut_phases(between(image, z));
  }

  FilmOfImage film() {
    add_particles();
    add_cbd();
    return std::move(film_);
  }

private:
  const Recipe &recipe_;
  Side x_, y_;
  std::int32_t background_ = 0;
  LabelImage slab_; ///< particles, as wide as the image, as high as the film
  FilmOfImage film_;

  double volume() const {
    const ExistingStructure &g = film_.structure;
    return g.lx * g.ly * g.thickness;
  }

  void cut_phases(const LabelImage &phases) {
    film_.phases = empty_phases({x_.voxels, y_.voxels, slab_.n[2]}, slab_.voxel, true);
    size_t at = 0;
    for (int k = 0; k < slab_.n[2]; ++k)
      for (int j = 0; j < y_.voxels; ++j)
        for (int i = 0; i < x_.voxels; ++i, ++at) {
          const size_t there = slab_.index(i + x_.first, j + y_.first, k);
          film_.phases.label[at] =
              slab_.label[there] != background_                                        ? 1
              : film_.cbd_of_image && phases.label[there] == recipe_.shapes.phases.cbd ? kCbdLabel
                                                                                       : kPoreLabel;
        }
  }

  bool in_crop(int i, int j) const {
    return i >= x_.first && i < x_.first + x_.voxels && j >= y_.first && j < y_.first + y_.voxels;
  }

  double share_inside(const Region &r) const {
    long inside = 0;
    each_voxel(r, [&](int i, int j, int) { inside += in_crop(i, j); });
    return double(inside) / double(r.voxels);
  }

  // The crop's own sides stand for voxels that are cut in half at its border.
  double voxel_volume() const { return volume() / double(film_.phases.label.size()); }

  void add_particles() {
    const std::vector<Region> regions = find_regions(slab_, background_);
    std::vector<Candidate> all;
    const double least = 0.5001 * std::pow(recipe_.lattice, 3);
    double am = 0.0, small = 0.0;
    for (const Region &r : regions) {
      const double inside = share_inside(r);
      am += inside * double(r.voxels);
      if (inside > 0.0 && double(r.voxels) * voxel_volume() > least)
        all.push_back({&r, inside});
      else if (inside > 0.0) {
        ++film_.small;
        small += inside * double(r.voxels);
      }
    }
    film_.small_volume = am > 0.0 ? small / am : 0.0;
    const std::vector<Candidate> chosen = choose(all, am);
    if (chosen.empty())
      throw Failure(kBadInput, fmt::format("{}: the crop has no particle as large as half a "
                                           "primary, {:.3g} um3. Give another crop, or finer "
                                           "primaries (particles.lattice_um).",
                                           recipe_.file, least));
    double taken = 0.0, volume = 0.0;
    for (const Candidate &c : chosen) {
      add(c);
      taken += c.taken * double(c.region->voxels);
      volume += double(c.region->voxels);
    }
    film_.overlap = taken / volume;
    film_.left_out = long(all.size() - chosen.size());
  }

  template <class Visit> void each_voxel(const Region &r, Visit visit) const {
    for (int k = r.low[2]; k <= r.high[2]; ++k)
      for (int j = r.low[1]; j <= r.high[1]; ++j)
        for (int i = r.low[0]; i <= r.high[0]; ++i)
          if (slab_.at(i, j, k) == r.label)
            visit(i, j, k);
  }

  // In the crop, across its sides.
  size_t place(int i, int j, int k) const {
    const auto within = [](int v, const Side &s) {
      return ((v - s.first) % s.voxels + s.voxels) % s.voxels;
    };
    return film_.phases.index(within(i, x_), within(j, y_), k);
  }

  // The ones inside, and of the others, one by one, the one that finds most of its place free, until all
  // have `voxels`, as nearly as whole ones can.
  std::vector<Candidate> choose(std::vector<Candidate> all, double voxels) const {
    std::vector<char> taken(film_.phases.label.size(), 0);
    std::vector<Candidate> out;
    const auto share_taken = [&](const Candidate &c) {
      long count = 0;
      each_voxel(*c.region, [&](int i, int j, int k) { count += taken[place(i, j, k)]; });
      return double(count) / double(c.region->voxels);
    };
    // The worst first: places only get fewer, so one that is still the best when looked at again is.
    const auto worse = [](const Candidate &a, const Candidate &b) {
      return std::tuple(-a.taken, a.inside, b.region->label) <
             std::tuple(-b.taken, b.inside, a.region->label);
    };
    std::make_heap(all.begin(), all.end(), worse);
    while (!all.empty()) {
      std::pop_heap(all.begin(), all.end(), worse);
      Candidate &best = all.back();
      if (const double now = share_taken(best); now > best.taken) {
        best.taken = now;
        std::push_heap(all.begin(), all.end(), worse);
        continue;
      }
      if (voxels < 0.5 * double(best.region->voxels))
        break;
      voxels -= double(best.region->voxels);
      each_voxel(*best.region, [&](int i, int j, int k) { taken[place(i, j, k)] = 1; });
      out.push_back(best);
      all.pop_back();
    }
    return out;
  }

  void add(const Candidate &c) {
    const ParticleMask mask = extract_particle(slab_, *c.region);
    MeasuredShape shape = make_shape(mask);
    ExistingSphere s;
    s.id = long(film_.shapes.size()) + 1;
    shape.name = fmt::format("{}", c.region->label);
    s.type = 1;
    s.diameter = sphere_diameter(double(c.region->voxels) * voxel_volume());
    s.density = recipe_.am_density;
    const Eigen::Vector3d corner(c.region->low[0] - 1 - x_.first, c.region->low[1] - 1 - y_.first,
                                 c.region->low[2] - 1);
    s.x = corner.cwiseProduct(slab_.voxel) + shape.centre -
          Eigen::Vector3d::Constant(shape.cell); // that the shape's box has more than the mask's
    film_.structure.am.push_back(s);
    film_.shapes.push_back(std::move(shape));
    (c.inside < 1.0 ? film_.across : film_.whole) += 1;
    film_.cut += c.region->cut;
  }

  void add_cbd() {
    const double d = recipe_.cbd_diameter, sphere = kPi / 6.0 * d * d * d;
    const std::vector<Eigen::Vector3d> voxels =
        centres_of(film_.cbd_of_image ? kCbdLabel : kPoreLabel);
    const double am =
        std::accumulate(film_.structure.am.begin(), film_.structure.am.end(), 0.0,
                        [](double sum, const ExistingSphere &s) { return sum + s.mass(); });
    const double wanted = film_.cbd_of_image
                              ? double(voxels.size()) * voxel_volume()
                              : am * (1.0 / recipe_.am_weight - 1.0) / cbd_density(recipe_);
    const int count = std::min(int(voxels.size()), int(std::lround(wanted / sphere)));
    if (count == 0)
      return;
    Random random(recipe_.seed, 6);
    const double width = std::cbrt(double(voxels.size()) * voxel_volume() / count);
    for (const Eigen::Vector3d &x : spread_centres(voxels, count, width, random)) {
      ExistingSphere s;
      s.id = long(film_.structure.am.size() + film_.structure.cbd.size()) + 1;
      s.type = 2;
      s.diameter = d;
      s.density = cbd_density(recipe_);
      s.x = x;
      film_.structure.cbd.push_back(s);
    }
  }

  std::vector<Eigen::Vector3d> centres_of(std::int32_t label) const {
    std::vector<Eigen::Vector3d> out;
    const PhaseImage &p = film_.phases;
    for (size_t v = 0; v < p.label.size(); ++v)
      if (p.label[v] == label) {
        const size_t x = v % p.n[0], y = v / p.n[0] % p.n[1], z = v / p.n[0] / p.n[1];
        const Eigen::Array3d at(x, y, z);
        out.push_back((at + 0.5) * p.voxel.array());
      }
    return out;
  }
};

} // namespace

FilmOfImage read_film_of_image(const Recipe &recipe) {
  const LabelImage image =
      turned(read_label_image(recipe.shapes.image, recipe.shapes.voxel_um), recipe.shapes.upwards);
  return Cutter(recipe, image).film();
}

Body make_body(const Recipe &recipe, const FilmOfImage &film, const ExistingSphere &sphere,
               int count, Random &random) {
  const MeasuredShape &shape = film.shapes[sphere.id - 1];
  return make_body(recipe, count, random, [&](Random &) {
    return Hull{[&](const Eigen::Vector3d &x) { return shape.depth_at(x); },
                shape.reach + recipe.lattice, [&] { return shape.sphericity; }, shape.name};
  });
}

namespace {

struct Shares {
  double pore = 0.0, am = 0.0, cbd = 0.0;
};

Shares shares_of(const PhaseImage &image) {
  std::array<long, 3> count = {0, 0, 0};
  for (size_t v = 0; v < image.label.size(); ++v)
    ++count[int(image.phase(v))];
  const double all = double(image.label.size());
  return {double(count[0]) / all, double(count[1]) / all, double(count[2]) / all};
}

// Share of the crop's active material that is active material in the film, heights in proportion.
double in_place(const PhaseImage &crop, const PhaseImage &film) {
  long am = 0, kept = 0;
  for (size_t v = 0; v < crop.label.size(); ++v) {
    if (crop.phase(v) != VoxelPhase::am)
      continue;
    const std::array<size_t, 3> at = {v % crop.n[0], v / crop.n[0] % crop.n[1],
                                      v / crop.n[0] / crop.n[1]};
    std::array<int, 3> there;
    for (int axis = 0; axis < 3; ++axis)
      there[axis] = int((double(at[axis]) + 0.5) / crop.n[axis] * film.n[axis]);
    ++am;
    kept += film.phase(film.index(there[0], there[1], there[2])) == VoxelPhase::am;
  }
  return double(kept) / double(am);
}

} // namespace

nlohmann::json describe_image(const Recipe &recipe, const FilmOfImage &film,
                              const std::vector<Particle> &particles) {
  std::vector<Sphere> spheres;
  for (const Particle &p : particles)
    spheres.push_back({p.x, 0.5 * p.diameter, p.body});
  const ExistingStructure &g = film.structure;
  const PhaseImage packed = voxelise(spheres, {g.lx, g.ly, recipe.thickness()}, recipe.lattice,
                                     film.phases.voxel.maxCoeff());
  const Shares crop = shares_of(film.phases), now = shares_of(packed);
  const double nano = recipe.nanoporosity;
  return {{"crop_from_voxel", film.corner},
          {"crop_voxels", film.phases.n},
          {"voxel_um", {film.phases.voxel.x(), film.phases.voxel.y(), film.phases.voxel.z()}},
          {"particles_inside", film.whole},
          {"particles_across_sides", film.across},
          {"particles_across_sides_left_out", film.left_out},
          {"particles_cut_by_top_bottom_or_border", film.cut},
          {"am_that_overlaps_across_sides", film.overlap},
          {"labels_below_half_a_primary", film.small},
          {"their_share_of_am", film.small_volume},
          {"cbd", film.cbd_of_image ? "of the image" : "of the recipe, at random places in pores"},
          {"porosity_macro_image", crop.pore},
          {"porosity_macro", now.pore},
          {"porosity_total_image", crop.pore + nano * crop.cbd},
          {"am_fraction_image", crop.am},
          {"am_fraction", now.am},
          {"cbd_fraction_image", crop.cbd},
          {"cbd_fraction", now.cbd},
          {"am_in_place", in_place(film.phases, packed)}};
}

} // namespace calendem
