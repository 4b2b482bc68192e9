// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/tomogram.h"
#include "base/particle_sizes.h"
#include "electrode/pack/body.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {

namespace {

using Voxel = std::array<int, 3>;

// A particle as voxels about one of them, its pores, and its innermost voxels first.
struct Stamp {
  std::vector<Voxel> solid;
  std::vector<char> is_pore;
  TrueParticle truth;
};

struct Pore {
  Eigen::Vector3d centre;
  double radius;
};

// Pores well inside: their surfaces stay within 0.75 of the particle's mean radius.
std::vector<Pore> draw_pores(const TomogramSpec &s, double R, Random &random) {
  std::vector<Pore> pores;
  for (int n = 0; n < s.pores; ++n) {
    const double radius = s.pore_diameter * R * (0.5 + 0.5 * random.uniform());
    const double depth = std::max(0.0, 0.6 * R - radius) * std::cbrt(random.uniform());
    pores.push_back({depth * random.direction(), radius});
  }
  return pores;
}

Stamp draw_particle(const TomogramSpec &s, double diameter, Random &random) {
  const Shape shape(random, s.irregularity);
  const double R = 0.5 * diameter / std::cbrt(shape.volume_ratio());
  const std::vector<Pore> pores = draw_pores(s, 0.5 * diameter, random);
  const Eigen::Vector3d offset = random.uniform3() - Eigen::Vector3d::Constant(0.5);
  Stamp out;
  const int n = int(std::ceil(1.8 * R / s.voxel)) + 1;
  for (int k = -n; k <= n; ++k)
    for (int j = -n; j <= n; ++j)
      for (int i = -n; i <= n; ++i) {
        const Eigen::Vector3d x = s.voxel * (Eigen::Vector3d(i, j, k) + offset);
        const double r = x.norm();
        if (r > 0.4 * R && (r > 1.8 * R || r > R * shape.radius(x / r)))
          continue;
        out.solid.push_back({i, j, k});
        out.is_pore.push_back(std::any_of(pores.begin(), pores.end(), [&](const Pore &p) {
          return (x - p.centre).squaredNorm() < p.radius * p.radius;
        }));
      }
  out.truth.equivalent_diameter = diameter;
  out.truth.volume = kPi / 6.0 * std::pow(diameter, 3);
  out.truth.sphericity = shape.sphericity();
  out.truth.centre = -s.voxel * offset; // of the shape from the stamp's voxel (0, 0, 0)
  return out;
}

bool is_inside(const LabelImage &image, const Voxel &v) {
  return v[0] >= 0 && v[1] >= 0 && v[2] >= 0 && v[0] < image.n[0] && v[1] < image.n[1] &&
         v[2] < image.n[2];
}

// What lies beyond the image is cut off.
bool is_free(const LabelImage &image, const Stamp &stamp, const Voxel &at) {
  for (const Voxel &v : stamp.solid) {
    const Voxel p = {at[0] + v[0], at[1] + v[1], at[2] + v[2]};
    if (is_inside(image, p) && image.at(p[0], p[1], p[2]) != 0)
      return false;
  }
  return true;
}

// Moves a stamp along the line to `goal` until one more voxel would overlap.
Voxel push(const LabelImage &image, const Stamp &stamp, const Voxel &from, const Voxel &goal) {
  const Eigen::Vector3d a(from[0], from[1], from[2]), b(goal[0], goal[1], goal[2]);
  const int steps = int((b - a).norm());
  Voxel last = from;
  for (int k = 1; k <= steps; ++k) {
    const Eigen::Vector3i p = (a + (b - a) * (double(k) / steps)).array().round().cast<int>();
    const Voxel next = {p[0], p[1], p[2]};
    if (!is_free(image, stamp, next))
      break;
    last = next;
  }
  return last;
}

long put(LabelImage &image, Stamp &stamp, const Voxel &at, std::int32_t label) {
  long count = 0;
  for (size_t n = 0; n < stamp.solid.size(); ++n) {
    const Voxel &v = stamp.solid[n];
    const Voxel p = {at[0] + v[0], at[1] + v[1], at[2] + v[2]};
    if (!is_inside(image, p))
      continue;
    image.label[image.index(p[0], p[1], p[2])] = stamp.is_pore[n] ? -label : label;
    ++count;
  }
  stamp.truth.label = label;
  for (int axis = 0; axis < 3; ++axis)
    stamp.truth.centre[axis] += (at[axis] + 0.5) * image.voxel[axis];
  return count;
}

// A voxel at a surface between a particle and the background; `other` is across the surface.
struct Border {
  size_t at;
  std::int32_t own, other;
};

// Particles' voxels beside background and background beside particles; pores are left alone.
std::vector<Border> find_borders(const LabelImage &image) {
  std::vector<Border> out;
  const long step[3] = {1, image.n[0], long(image.n[0]) * image.n[1]};
  for (size_t at = 0; at < image.label.size(); ++at) {
    const std::int32_t own = image.label[at];
    if (own < 0)
      continue;
    std::int32_t other = own;
    for (int axis = 0; axis < 3; ++axis)
      for (int side : {-1, 1}) {
        const int place = int(long(at) / step[axis] % image.n[axis]) + side;
        if (place < 0 || place >= image.n[axis])
          continue;
        const std::int32_t next = image.label[at + side * step[axis]];
        if (next >= 0 && (own == 0) != (next == 0))
          other = next;
      }
    if (other != own)
      out.push_back({at, own, other});
  }
  return out;
}

// A share `noise` of a particle's voxels at the surface is lost; beside it as many are gained on
// average, so that it neither grows nor shrinks. Pores (negative until here) become background.
void roughen(LabelImage &image, double noise, Random &random) {
  const std::vector<Border> borders = find_borders(image);
  std::map<std::int32_t, std::array<double, 2>> count; // of a particle's voxels, of those beside it
  for (const Border &b : borders)
    ++count[std::max(b.own, b.other)][b.own == 0];
  for (const Border &b : borders) {
    const auto &[inner, outer] = count[std::max(b.own, b.other)];
    if (random.uniform() < (b.own == 0 ? noise * inner / outer : noise))
      image.label[b.at] = b.other;
  }
  for (std::int32_t &label : image.label)
    label = std::max(label, 0);
}

Voxel draw_place(const LabelImage &image, Random &random) {
  const Eigen::Vector3d u = random.uniform3();
  return {int(u[0] * image.n[0]), int(u[1] * image.n[1]), int(u[2] * image.n[2])};
}

} // namespace

Tomogram make_tomogram(const TomogramSpec &s) {
  Tomogram out;
  LabelImage &image = out.image;
  image.voxel.setConstant(s.voxel);
  for (int axis = 0; axis < 3; ++axis)
    image.n[axis] = std::max(3, int(std::lround(s.size[axis] / s.voxel)));
  image.label.assign(size_t(image.n[0]) * image.n[1] * image.n[2], 0);
  Random random(s.seed, 11);
  const SizeLaw law{s.median, s.sigma_ln, s.min_diameter, s.max_diameter};
  std::vector<Voxel> places;
  double filled = 0.0;
  for (int refused = 0; refused < 30 && filled < s.solid_fraction * double(image.label.size());) {
    Stamp stamp = draw_particle(s, law.quantile(random.uniform()), random);
    Voxel at = draw_place(image, random);
    for (int tries = 0; tries < 200 && !is_free(image, stamp, at); ++tries)
      at = draw_place(image, random);
    if (!is_free(image, stamp, at)) {
      ++refused;
      continue;
    }
    if (!places.empty() && random.uniform() < s.touching) {
      const auto distance = [&](const Voxel &p) {
        return std::hypot(p[0] - at[0], p[1] - at[1], p[2] - at[2]);
      };
      at = push(image, stamp, at,
                *std::min_element(places.begin(), places.end(), [&](const auto &a, const auto &b) {
                  return distance(a) < distance(b);
                }));
    }
    filled += double(put(image, stamp, at, int(places.size()) + 1));
    places.push_back(at);
    out.truth.push_back(stamp.truth);
  }
  roughen(image, s.noise, random);
  return out;
}

std::string truth_table(const std::vector<TrueParticle> &truth) {
  std::string out = "label,x_um,y_um,z_um,volume_um3,equivalent_diameter_um,sphericity\n";
  for (const TrueParticle &t : truth)
    out += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.6g},{:.6g},{:.4f}\n", t.label, t.centre.x(),
                       t.centre.y(), t.centre.z(), t.volume, t.equivalent_diameter, t.sphericity);
  return out;
}

const std::vector<Key> &tomogram_keys() {
  static const std::vector<Key> keys = with_volume_percentiles({
      {"seed", "", "1", 0, 4e9, "", "seed of all random numbers", "", false, true},
      {"image.voxel_um", "", "0.3", 0.005, 5, "um", "side of a voxel"},
      {"image.x_um", "", "30", 1, 1000, "um", "side of the image along x"},
      {"image.y_um", "", "30", 1, 1000, "um", "side of the image along y"},
      {"image.z_um", "", "30", 1, 1000, "um", "side of the image along z"},
      {"image.solid_fraction", "", "0.4", 0.01, 0.6, "",
       "particles are added up to this volume fraction"},
      {"particles.median_um", "", "4.35", 0.5, 50, "um", "median diameter, by number"},
      {"particles.sigma_ln", "", "0.487", 0.01, 1, "", "width of the lognormal size distribution"},
      {"particles.min_um", "", "3", 0.1, 50, "um", "smallest diameter"},
      {"particles.max_um", "", "10", 0.2, 100, "um", "largest diameter"},
      {"particles.irregularity", "", "0.1", 0, 0.3, "",
       "relative rms roughness of the particles' radius"},
      {"particles.touching_fraction", "", "0.7", 0, 1, "",
       "fraction of the particles that touch another one"},
      {"particles.pores", "", "3", 0, 50, "", "number of closed pores per particle", "", false,
       true},
      {"particles.pore_diameter_fraction", "", "0.12", 0.01, 0.3, "",
       "diameter of a pore, as a fraction of the particle's"},
      {"border.noise", "", "0.05", 0, 0.5, "",
       "fraction of the voxels at a surface that change sides"},
  });
  return keys;
}

TomogramSpec read_tomogram_spec(const std::string &file) {
  Mistakes mistakes(file);
  Settings s = read_toml(file, FileKind::Tomogram, tomogram_keys(), mistakes);
  take_sizes_by_volume(s, tomogram_keys(), mistakes);
  mistakes.stop_if_any();
  TomogramSpec t;
  t.seed = static_cast<unsigned long>(s.number("seed"));
  t.voxel = s.number("image.voxel_um");
  t.size = {s.number("image.x_um"), s.number("image.y_um"), s.number("image.z_um")};
  t.solid_fraction = s.number("image.solid_fraction");
  t.median = s.number("particles.median_um");
  t.sigma_ln = s.number("particles.sigma_ln");
  t.min_diameter = s.number("particles.min_um");
  t.max_diameter = s.number("particles.max_um");
  t.irregularity = s.number("particles.irregularity");
  t.touching = s.number("particles.touching_fraction");
  t.pores = static_cast<int>(s.number("particles.pores"));
  t.pore_diameter = s.number("particles.pore_diameter_fraction");
  t.noise = s.number("border.noise");
  const double voxels = t.size.prod() / (t.voxel * t.voxel * t.voxel);
  if (voxels > 1e9)
    mistakes.add(0, fmt::format("the image would have {:.2g} voxels of 4 bytes; at most 1e9 are "
                                "made. Take a smaller image or larger voxels.",
                                voxels));
  if (t.min_diameter < 2.0 * t.voxel)
    mistakes.add(0, fmt::format("particles.min_um = {} is less than two voxels of {} um: such a "
                                "particle would not be seen. Take larger particles or smaller "
                                "voxels.",
                                t.min_diameter, t.voxel));
  if (t.min_diameter >= t.max_diameter)
    mistakes.add(0, fmt::format("particles.min_um = {} must be below max_um = {}.", t.min_diameter,
                                t.max_diameter));
  mistakes.stop_if_any();
  return t;
}

} // namespace calendem
