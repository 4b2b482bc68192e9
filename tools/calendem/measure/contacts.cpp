// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/measured_shape.h"
#include "measure/structure.h"
#include "physics/surface_inset.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace calendem {
namespace {

using Pairs = std::set<std::pair<int, int>>; // the lower number first

constexpr double kLargestPart = 0.95;

// Number of what a sphere belongs to: its body, or below 0 its own.
int owner(const Sphere &s, int index) { return s.body > 0 ? s.body : -1 - index; }

Pairs touching(std::vector<Sphere> spheres, const Cell &cell) {
  std::sort(spheres.begin(), spheres.end(),
            [](const Sphere &a, const Sphere &b) { return a.x.z() < b.x.z(); });
  double largest = 0.0;
  for (const Sphere &s : spheres)
    largest = std::max(largest, s.radius);
  Pairs pairs;
  for (size_t i = 0; i < spheres.size(); ++i)
    for (size_t j = i + 1; j < spheres.size(); ++j) {
      const Sphere &p = spheres[i], &q = spheres[j];
      if (q.x.z() - p.x.z() >= p.radius + largest)
        break;
      Eigen::Vector3d d = q.x - p.x;
      d.x() -= cell.lx * std::round(d.x() / cell.lx);
      d.y() -= cell.ly * std::round(d.y() / cell.ly);
      const int a = owner(p, int(i)), b = owner(q, int(j));
      if (a != b && d.squaredNorm() < std::pow(p.radius - p.inset + q.radius - q.inset, 2))
        pairs.insert(std::minmax(a, b));
    }
  return pairs;
}

/// Bodies of an image: voxels, whether a side of the image cuts them, largest connected part.
struct Seen {
  long voxels = 0, largest = 0;
  bool cut = false;
};

constexpr int kFaces[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

// Visits all voxels connected by faces to `start` that bear its label; notes what they touch. VTK's
// filter of connected parts knows neither periodic faces nor neighbours.
long visit_part(const PhaseImage &image, size_t start, std::vector<char> &done, bool &cut,
                Pairs &neighbours) {
  const std::int32_t label = image.label[start];
  std::vector<size_t> front = {start};
  done[start] = 1;
  long voxels = 0;
  while (!front.empty()) {
    const size_t v = front.back();
    front.pop_back();
    ++voxels;
    const int i = int(v % image.n[0]), j = int(v / image.n[0] % image.n[1]);
    const int k = int(v / image.n[0] / image.n[1]);
    for (const auto &f : kFaces) {
      const long w = neighbour(image, i, j, k, f[0], f[1], f[2]);
      if (w < 0) { // the platens cut nothing off a simulated body
        cut = cut || !image.periodic;
        continue;
      }
      if (image.label[w] == label && !done[w]) {
        done[w] = 1;
        front.push_back(size_t(w));
      } else if (image.label[w] > 0 && image.label[w] != label)
        neighbours.insert(std::minmax(label, image.label[w]));
    }
  }
  return voxels;
}

} // namespace

std::vector<double> surface_insets(const ParticleFrame &particles, const BondFrame &bonds,
                                   double whole, double fading) {
  std::map<int, int> intact; // by tag
  for (std::size_t k = 0; k < bonds.tags.size(); ++k)
    if (bonds.intact[k]) {
      ++intact[bonds.tags[k].first];
      ++intact[bonds.tags[k].second];
    }
  std::vector<double> out(particles.body.size(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (particles.body[i] > 0 && !particles.tag.empty())
      out[i] = surface_inset(whole, fading, intact[particles.tag[i]]);
  return out;
}

Coordination coordination(const std::vector<Sphere> &spheres, const Cell &cell) {
  Coordination c;
  std::set<int> bodies, with_am, with_any;
  for (const Sphere &s : spheres)
    if (s.body > 0)
      bodies.insert(s.body);
    else
      ++c.cbd;
  c.bodies = int(bodies.size());
  double am_am = 0.0, am_cbd = 0.0, cbd_cbd = 0.0;
  for (const auto &[a, b] : touching(spheres, cell)) {
    (a > 0 && b > 0 ? am_am : a < 0 && b < 0 ? cbd_cbd : am_cbd) += 1.0;
    for (const int x : {a, b}) {
      with_any.insert(std::max(x, 0));
      if (a > 0 && b > 0)
        with_am.insert(x);
    }
  }
  with_any.erase(0); // stands for all CBD
  if (c.bodies > 0) {
    c.am_am = 2.0 * am_am / c.bodies;
    c.am_cbd = am_cbd / c.bodies;
    c.am_without_am = 1.0 - double(with_am.size()) / c.bodies;
    c.am_without_any = 1.0 - double(with_any.size()) / c.bodies;
  }
  if (c.cbd > 0) {
    c.cbd_am = am_cbd / c.cbd;
    c.cbd_cbd = 2.0 * cbd_cbd / c.cbd;
  }
  return c;
}

VoxelBodies bodies_on_voxels(const PhaseImage &image) {
  std::map<std::int32_t, Seen> bodies;
  std::vector<char> done(image.label.size(), 0);
  Pairs neighbours;
  for (size_t v = 0; v < image.label.size(); ++v)
    if (image.label[v] > 0 && !done[v]) {
      Seen &body = bodies[image.label[v]];
      const long part = visit_part(image, v, done, body.cut, neighbours);
      body.voxels += part;
      body.largest = std::max(body.largest, part);
    }
  VoxelBodies out;
  out.bodies = int(bodies.size());
  out.am_am = out.bodies > 0 ? 2.0 * double(neighbours.size()) / out.bodies : 0.0;
  for (const auto &[label, body] : bodies)
    if (!body.cut && body.voxels >= kFewestVoxels) {
      ++out.whole;
      out.in_pieces += double(body.largest) < kLargestPart * double(body.voxels);
    }
  return out;
}

} // namespace calendem
