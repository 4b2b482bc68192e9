// SPDX-License-Identifier: GPL-2.0-or-later
#include "pack/body.h"
#include <algorithm>
#include <map>
#include <numeric>

namespace calendem {
namespace {

constexpr double kPi = 3.14159265358979323846;

double legendre(int degree, double x) {
  double before = 1.0, p = x;
  for (int n = 2; n <= degree; ++n) {
    const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
    before = p;
    p = next;
  }
  return degree == 0 ? 1.0 : p;
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// Quantile of the lognormal law truncated to [low, high], by bisection.
double truncated_quantile(double q, double mu, double sigma, double low, double high) {
  const double a = normal_cdf((std::log(low) - mu) / sigma);
  const double b = normal_cdf((std::log(high) - mu) / sigma);
  const double wanted = a + q * (b - a);
  double lo = std::log(low), hi = std::log(high);
  for (int i = 0; i < 80; ++i) {
    const double mid = 0.5 * (lo + hi);
    (normal_cdf((mid - mu) / sigma) < wanted ? lo : hi) = mid;
  }
  return std::exp(0.5 * (lo + hi));
}

// Share of a truncated law's volume above `limit`: the third moment of a lognormal shifts mu by 3
// s^2.
double volume_above(double limit, double mu, double sigma, double low, double high) {
  const double m = mu + 3.0 * sigma * sigma;
  const auto F = [&](double d) { return normal_cdf((std::log(d) - m) / sigma); };
  return limit >= high ? 0.0 : (F(high) - F(limit)) / (F(high) - F(low));
}

double sphere_volume(double d) { return kPi / 6.0 * d * d * d; }

// Lattice points of the smallest scaled radii; grown from the innermost so that the body is
// connected.
std::vector<Eigen::Vector3d> fill(const Shape &shape, const Eigen::Quaterniond &turn,
                                  const Eigen::Vector3d &offset, double s, int count, double R0) {
  struct Site {
    double measure;
    Eigen::Vector3i index;
  };
  const int n = static_cast<int>(std::ceil(1.8 * R0 / s)) + 2;
  std::vector<Site> sites;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -n; k <= n; ++k) {
        const Eigen::Vector3d p = turn * (s * (Eigen::Vector3d(i, j, k) + offset));
        const double r = p.norm();
        const Eigen::Vector3d u = r > 0.0 ? Eigen::Vector3d(p / r) : Eigen::Vector3d(1.0, 0.0, 0.0);
        sites.push_back({r / shape.radius(u), Eigen::Vector3i(i, j, k)});
      }
  std::sort(sites.begin(), sites.end(),
            [](const Site &a, const Site &b) { return a.measure < b.measure; });
  const auto key = [](const Eigen::Vector3i &v) { return std::array<int, 3>{v.x(), v.y(), v.z()}; };
  std::map<std::array<int, 3>, bool> in;
  std::vector<Eigen::Vector3d> points;
  std::vector<bool> used(sites.size(), false);
  while (static_cast<int>(points.size()) < count) {
    bool grew = false;
    for (size_t q = 0; q < sites.size() && static_cast<int>(points.size()) < count; ++q) {
      if (used[q])
        continue;
      bool touches = points.empty();
      for (int axis = 0; axis < 3 && !touches; ++axis)
        for (int side : {-1, 1}) {
          Eigen::Vector3i v = sites[q].index;
          v[axis] += side;
          touches = touches || in.count(key(v));
        }
      if (!touches)
        continue;
      used[q] = grew = true;
      in[key(sites[q].index)] = true;
      points.push_back(turn * (s * (sites[q].index.cast<double>() + offset)));
      break; // always the innermost site that touches the body
    }
    if (!grew)
      break;
  }
  return points;
}

std::vector<int> primary_counts(const std::vector<double> &diameters, double s, int total) {
  std::vector<double> ideal;
  for (double d : diameters)
    ideal.push_back(sphere_volume(d) / (s * s * s));
  const double scale = total / std::accumulate(ideal.begin(), ideal.end(), 0.0);
  std::vector<int> counts;
  double carried = 0.0; // rounding is carried on, so the sum is exact
  for (double v : ideal) {
    const double wanted = v * scale + carried;
    const int n = std::max(1, static_cast<int>(std::lround(wanted)));
    carried = wanted - n;
    counts.push_back(n);
  }
  counts.front() += total - std::accumulate(counts.begin(), counts.end(), 0);
  return counts;
}

} // namespace

Shape::Shape(Random &random, double irregularity) {
  for (int degree = 2; degree <= 5; ++degree)
    for (int copy = 0; copy < 3; ++copy) {
      // P_l has variance 1/(2l+1) over the sphere; degree l is given the share 1/l of the roughness
      const double share = irregularity / std::sqrt(3.0 * 4.0) * 2.0 / degree;
      terms_.push_back(
          {random.direction(), degree, share * std::sqrt(2.0 * degree + 1.0) * random.normal()});
    }
}

double Shape::radius(const Eigen::Vector3d &u) const {
  double f = 1.0;
  for (const Term &t : terms_)
    f += t.weight * legendre(t.degree, std::clamp(u.dot(t.axis), -1.0, 1.0));
  return std::max(f, 0.4);
}

double Shape::sphericity() const {
  const int nt = 48, np = 96;
  const auto point = [&](int i, int j) {
    const double theta = kPi * i / nt, phi = 2.0 * kPi * j / np;
    const Eigen::Vector3d u(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                            std::cos(theta));
    return Eigen::Vector3d(radius(u) * u);
  };
  double area = 0.0, volume = 0.0;
  const auto add = [&](const Eigen::Vector3d &a, const Eigen::Vector3d &b,
                       const Eigen::Vector3d &c) {
    area += 0.5 * (b - a).cross(c - a).norm();
    volume += a.dot(b.cross(c)) / 6.0;
  };
  for (int i = 0; i < nt; ++i)
    for (int j = 0; j < np; ++j) {
      add(point(i, j), point(i + 1, j), point(i + 1, j + 1));
      add(point(i, j), point(i + 1, j + 1), point(i, j + 1));
    }
  return std::cbrt(kPi) * std::pow(6.0 * volume, 2.0 / 3.0) / area;
}

std::vector<double> draw_diameters(const Recipe &recipe, double volume, Random &random,
                                   BodyReport &report) {
  const double mu = std::log(recipe.median), high = recipe.largest_body();
  report.volume_cut_off_fraction =
      volume_above(high, mu, recipe.sigma_ln, recipe.min_diameter, recipe.max_diameter);
  std::vector<double> best;
  double best_error = HUGE_VAL;
  const double jitter = random.uniform();
  const double mean = [&] {
    double sum = 0.0;
    for (int k = 0; k < 2000; ++k)
      sum += sphere_volume(
          truncated_quantile((k + 0.5) / 2000, mu, recipe.sigma_ln, recipe.min_diameter, high));
    return sum / 2000;
  }();
  const int guess = std::max(2, static_cast<int>(std::lround(volume / mean)));
  for (int n = std::max(2, guess * 9 / 10); n <= guess * 11 / 10 + 1; ++n) {
    std::vector<double> d;
    double sum = 0.0;
    for (int k = 0; k < n; ++k) {
      d.push_back(
          truncated_quantile((k + jitter) / n, mu, recipe.sigma_ln, recipe.min_diameter, high));
      sum += sphere_volume(d.back());
    }
    if (std::fabs(sum - volume) < best_error) {
      best_error = std::fabs(sum - volume);
      best = d;
    }
  }
  std::sort(best.rbegin(), best.rend());
  report.below_3_um =
      static_cast<int>(std::count_if(best.begin(), best.end(), [](double d) { return d < 3.0; }));
  return best;
}

std::vector<Body> make_bodies(const Recipe &recipe, BodyReport &report) {
  const double s = recipe.lattice, volume = recipe.area() * recipe.am_column();
  Random sizes(recipe.seed, 1), shapes(recipe.seed, 2);
  const std::vector<double> diameters = draw_diameters(recipe, volume, sizes, report);
  const int total = static_cast<int>(std::lround(volume / (s * s * s)));
  const std::vector<int> counts = primary_counts(diameters, s, total);
  std::vector<Body> bodies;
  for (int n : counts) {
    const Shape shape(shapes, recipe.irregularity);
    Body b;
    b.lattice = shapes.rotation();
    const Eigen::Vector3d offset(shapes.uniform() - 0.5, shapes.uniform() - 0.5,
                                 shapes.uniform() - 0.5);
    b.primaries = fill(shape, b.lattice, offset, s, n, std::cbrt(0.75 / kPi * n) * s);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d &p : b.primaries)
      mean += p / b.primaries.size();
    for (Eigen::Vector3d &p : b.primaries) {
      p -= mean;
      b.reach = std::max(b.reach, p.norm() + 0.5 * recipe.primary_diameter);
    }
    b.volume = n * s * s * s;
    b.sphericity = n == 1 ? 1.0 : shape.sphericity();
    bodies.push_back(b);
  }
  return bodies;
}

} // namespace calendem
