// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/body.h"
#include "electrode/pack/grains.h"
#include "physics/pi.h"
#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <set>

namespace calendem {

namespace {

double sphere_volume(double d) { return kPi / 6.0 * d * d * d; }

// n quantiles in equal steps of number.
std::vector<double> stratified(const Quantile &law, int n, double offset) {
  std::vector<double> d;
  for (int k = 0; k < n; ++k)
    d.push_back(law((k + offset) / n));
  return d;
}

double total_volume(const std::vector<double> &d) {
  return std::accumulate(d.begin(), d.end(), 0.0,
                         [](double sum, double x) { return sum + sphere_volume(x); });
}

} // namespace

std::vector<double> draw_diameters(const Recipe &recipe, double volume, Random &random) {
  SizeLaw law = measured_law(recipe);
  law.high = recipe.largest_body();
  if (law.high <= law.low)
    throw Failure(kBadInput, fmt::format("no secondary particle fits a cell of {} x {} um: the "
                                         "smallest is {} um, the largest allowed {:.2f} um. Make "
                                         "the cell larger",
                                         recipe.cell_x, recipe.cell_y, law.low, law.high));
  return draw_diameters([&](double q) { return law.quantile(q); }, volume, random);
}

std::vector<double> draw_diameters(const Quantile &law, double volume, Random &random) {
  const int fine = 2000;
  const int guess = static_cast<int>(volume / (total_volume(stratified(law, fine, 0.5)) / fine));
  const double offset = random.uniform();
  std::vector<double> best;
  double best_error = HUGE_VAL;
  for (int n = std::max(1, guess * 9 / 10); n <= guess * 11 / 10 + 2; ++n) {
    std::vector<double> d = stratified(law, n, offset);
    const double error = std::fabs(total_volume(d) - volume);
    if (error < best_error) {
      best_error = error;
      best = std::move(d);
    }
  }
  std::sort(best.rbegin(), best.rend());
  return best;
}

std::vector<int> primary_counts(const std::vector<double> &diameters, double lattice, int total) {
  const double scale = total * std::pow(lattice, 3) / total_volume(diameters);
  std::vector<int> counts;
  double carried = 0.0;
  for (double d : diameters) {
    const double wanted = sphere_volume(d) / std::pow(lattice, 3) * scale + carried;
    counts.push_back(std::max(1, static_cast<int>(std::lround(wanted))));
    carried = wanted - counts.back();
  }
  // Where small bodies became one whole primary, there are too many: the largest give theirs, then
  // bodies of one are left out.
  int excess = std::accumulate(counts.begin(), counts.end(), 0) - total;
  for (; excess > 0; --excess) {
    const auto largest = std::max_element(counts.begin(), counts.end());
    if (*largest > 1)
      --*largest;
    else
      counts.pop_back();
  }
  counts.front() -= excess;
  return counts;
}

namespace {

double legendre(int degree, double x) {
  double before = 1.0, p = x;
  for (int n = 2; n <= degree; ++n) {
    const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
    before = p;
    p = next;
  }
  return degree == 0 ? 1.0 : p;
}

using Site = std::array<int, 3>;

// Lattice sites by their depth in the hull, innermost first; none beyond `farthest` from the
// centre.
std::vector<Site> sites_by_depth(const Hull &hull, const Lattice &lattice, double farthest) {
  const int n = static_cast<int>(std::ceil(hull.reach / lattice.spacing)) + 2;
  std::vector<std::pair<double, Site>> sites;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -n; k <= n; ++k) {
        const Eigen::Vector3d p = lattice.point({i, j, k});
        if (p.norm() <= farthest)
          sites.push_back({hull.depth(p), {i, j, k}});
      }
  std::sort(sites.begin(), sites.end());
  std::vector<Site> out;
  for (const auto &[depth, site] : sites)
    out.push_back(site);
  return out;
}

bool touches(const Site &site, const std::set<Site> &body) {
  for (int axis = 0; axis < 3; ++axis)
    for (int side : {-1, 1}) {
      Site next = site;
      next[axis] += side;
      if (body.count(next))
        return true;
    }
  return false;
}

// `count` sites, each time the innermost that touches the body, so that it is 6-connected; fewer if
// there are no more.
std::vector<Eigen::Vector3d> fill(const Hull &hull, const Lattice &lattice, int count,
                                  double farthest) {
  const std::vector<Site> sites = sites_by_depth(hull, lattice, farthest);
  std::set<Site> body;
  std::vector<Eigen::Vector3d> points;
  while (static_cast<int>(points.size()) < count) {
    const auto next = std::find_if(sites.begin(), sites.end(), [&](const Site &s) {
      return !body.count(s) && (body.empty() || touches(s, body));
    });
    if (next == sites.end())
      break;
    body.insert(*next);
    points.push_back(lattice.point(*next));
  }
  return points;
}

void fill_lattice(Body &b, const Hull &hull, const Recipe &recipe, int count, double farthest,
                  Random &random) {
  const Lattice lattice{random.rotation(), random.uniform3() - Eigen::Vector3d::Constant(0.5),
                        recipe.lattice};
  b.primaries = fill(hull, lattice, count, farthest);
  b.facet = recipe.lattice * recipe.lattice;
  b.lattice = lattice.turn;
}

void fill(Body &b, const Hull &hull, const Recipe &recipe, int count, double farthest,
          Random &random) {
  if (recipe.grains == GrainShape::Voronoi && count >= kFewestGrains) {
    Grains grains = make_grains(hull, count, std::pow(recipe.lattice, 3), farthest,
                                recipe.bond_distance(), random);
    b.primaries = std::move(grains.centres);
    b.facet = grains.facet;
    b.lattice.setIdentity();
  } else
    fill_lattice(b, hull, recipe, count, farthest, random);
}

void centre_on_mass(Body &b) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d &p : b.primaries)
    mean += p / static_cast<double>(b.primaries.size());
  for (Eigen::Vector3d &p : b.primaries)
    p -= mean;
}

} // namespace

double width_of(const std::vector<Eigen::Vector3d> &centres, double diameter) {
  double most = 0.0;
  for (const Eigen::Vector3d &a : centres)
    for (const Eigen::Vector3d &b : centres)
      most = std::max(most, (a - b).squaredNorm());
  return std::sqrt(most) + diameter;
}

Shape::Shape(Random &random, double irregularity) {
  constexpr int kCopies = 3, kHighest = 5;
  double variance = 0.0;
  for (int degree = 2; degree <= kHighest; ++degree)
    variance += 1.0 / (degree * degree);
  for (int degree = 2; degree <= kHighest; ++degree)
    for (int copy = 0; copy < kCopies; ++copy) {
      // P_l has the variance 1/(2l+1) over the sphere; degree l takes part in proportion to 1/l
      const double rms = irregularity / (degree * std::sqrt(variance * kCopies));
      const Eigen::Vector3d axis = random.direction();
      terms_.push_back({axis, degree, rms * std::sqrt(2.0 * degree + 1.0) * random.normal()});
    }
}

double Shape::radius(const Eigen::Vector3d &u) const {
  double f = 1.0;
  for (const Term &t : terms_)
    f += t.weight * legendre(t.degree, std::clamp(u.dot(t.axis), -1.0, 1.0));
  return std::max(f, 0.4);
}

Shape::Mesh Shape::measure(int nt, int np) const {
  const auto point = [&](int i, int j) {
    const double theta = kPi * i / nt, phi = 2.0 * kPi * j / np;
    const Eigen::Vector3d u(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                            std::cos(theta));
    return Eigen::Vector3d(radius(u) * u);
  };
  Mesh m;
  const auto add = [&](const Eigen::Vector3d &a, const Eigen::Vector3d &b,
                       const Eigen::Vector3d &c) {
    m.area += 0.5 * (b - a).cross(c - a).norm();
    m.volume += a.dot(b.cross(c)) / 6.0;
  };
  for (int i = 0; i < nt; ++i)
    for (int j = 0; j < np; ++j) {
      add(point(i, j), point(i + 1, j), point(i + 1, j + 1));
      add(point(i, j), point(i + 1, j + 1), point(i, j + 1));
    }
  return m;
}

double Shape::sphericity() const {
  const Mesh m = measure(48, 96);
  return std::cbrt(kPi) * std::pow(6.0 * m.volume, 2.0 / 3.0) / m.area;
}

double Shape::volume_ratio() const { return measure(120, 240).volume / (4.0 / 3.0 * kPi); }

Body make_body(const Recipe &recipe, int count, Random &random, const DrawHull &draw) {
  constexpr int kTries = 100;
  const double widest = recipe.widest_body();
  Body b;
  for (int tries = 0; tries <= kTries; ++tries) {
    // the last try cuts the shape off where the limit of the width is
    const double farthest = tries < kTries ? HUGE_VAL : 0.5 * (widest - recipe.primary_diameter);
    const Hull hull = draw(random);
    fill(b, hull, recipe, count, farthest, random);
    if (tries == kTries && static_cast<int>(b.primaries.size()) < count)
      fill_lattice(b, hull, recipe, count, farthest, random); // grains of a thin shape fall apart
    b.sphericity = count == 1 ? 1.0 : hull.sphericity();
    b.shape = hull.name;
    b.width = width_of(b.primaries, recipe.primary_diameter);
    b.redrawn = tries;
    if (static_cast<int>(b.primaries.size()) == count && b.width <= widest)
      break;
  }
  if (static_cast<int>(b.primaries.size()) != count)
    throw Failure(kBadInput,
                  fmt::format("a secondary particle of {} primaries cannot be kept below "
                              "a width of {:.2f} um. Make the cell larger or the "
                              "particles less irregular",
                              count, widest));
  centre_on_mass(b);
  for (const Eigen::Vector3d &p : b.primaries)
    b.reach = std::max(b.reach, p.norm() + 0.5 * recipe.primary_diameter);
  b.volume = count * std::pow(recipe.lattice, 3);
  return b;
}

Body make_body(const Recipe &recipe, int count, Random &random) {
  const double R0 = std::cbrt(0.75 / kPi * count) * recipe.lattice;
  return make_body(recipe, count, random, [&](Random &r) {
    const Shape shape(r, recipe.irregularity);
    const auto depth = [shape](const Eigen::Vector3d &p) {
      const double distance = p.norm();
      return distance > 0.0 ? distance / shape.radius(p / distance) : 0.0;
    };
    return Hull{depth, 1.8 * R0, [shape] { return shape.sphericity(); }, ""};
  });
}

std::vector<int> draw_counts(const Recipe &recipe) {
  const double volume = recipe.area() * recipe.am_column();
  Random sizes(recipe.seed, 1);
  const std::vector<double> diameters = draw_diameters(recipe, volume, sizes);
  const int total = static_cast<int>(std::lround(volume / std::pow(recipe.lattice, 3)));
  return primary_counts(diameters, recipe.lattice, total);
}

std::vector<Body> make_bodies(const Recipe &recipe) {
  Random shapes(recipe.seed, 2);
  std::vector<Body> bodies;
  for (int count : draw_counts(recipe))
    bodies.push_back(make_body(recipe, count, shapes));
  return bodies;
}

} // namespace calendem
