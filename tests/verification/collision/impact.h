// SPDX-License-Identifier: GPL-2.0-or-later
// Impact of a sphere on another or on a rigid plane: Hertz' closed forms, the closed form of
// sliding friction, and the equations of motion of the host's contact law by Runge and Kutta.
// Everything is written here anew; nothing of the plugin's physics is used.
#ifndef CALENDEM_TESTS_IMPACT_H
#define CALENDEM_TESTS_IMPACT_H

#include "physics/pi.h"
#include <cmath>

#include <Eigen/Dense>

namespace calendem {

struct Material {
  const char *name;
  double E, nu, density; ///< kPa, -, g/cm3
  double mu, e;          ///< friction, restitution
};

/// A sphere: radius, velocity along the plane and out of it, spin about the third axis.
struct Ball {
  double R = 0.0, vx = 0.0, vz = 0.0, spin = 0.0;
};

/// The upper sphere falls on the lower one or, where that has no radius, on a rigid plane.
struct Impact {
  Ball upper, lower;

  bool on_plane() const { return lower.R == 0.0; }
  double closing() const { return lower.vz - upper.vz; }
  /// Speed of the upper surface along the lower one.
  double slip() const { return upper.vx - lower.vx - upper.R * upper.spin - lower.R * lower.spin; }
};

inline double mass_of(const Material &m, double R) {
  return m.density * 4.0 / 3.0 * kPi * R * R * R;
}

/// Fraction of critical damping that gives the restitution e (Antypov & Elliott 2011).
inline double damping_ratio(double e) { return -std::log(e) / std::hypot(std::log(e), kPi); }

/// Effective modulus, shear modulus, radius and mass; an elastic impact in Hertz' closed forms.
struct Contact {
  double E, G, R, m;

  Contact(const Material &a, const Impact &i) {
    const double sides = i.on_plane() ? 1.0 : 2.0; // that yield
    E = a.E / (1.0 - a.nu * a.nu) / sides;
    G = a.E / (2.0 * (1.0 + a.nu)) / (2.0 - a.nu) / sides;
    const double R1 = i.upper.R, R2 = i.lower.R, m1 = mass_of(a, R1), m2 = mass_of(a, R2);
    R = i.on_plane() ? R1 : R1 * R2 / (R1 + R2);
    m = i.on_plane() ? m1 : m1 * m2 / (m1 + m2);
  }
  double depth(double v) const {
    return std::pow(15.0 * m * v * v / (16.0 * std::sqrt(R) * E), 0.4);
  }
  double time(double v) const { return 2.94327514 * depth(v) / v; }
  double force(double v) const { return 4.0 / 3.0 * E * std::sqrt(R) * std::pow(depth(v), 1.5); }
};

/// True if the surfaces slide from beginning to end.
inline bool slides_throughout(const Material &m, const Impact &i) {
  return std::fabs(i.slip()) > 3.5 * m.mu * (1.0 + m.e) * i.closing();
}

/// After friction of impulse mu m_eff (1 + e) v, with arms of one radius and a normal that stays.
inline Impact after_sliding(const Material &m, Impact i) {
  const double normal = Contact(m, i).m * (1.0 + m.e) * i.closing();
  const double along = -std::copysign(m.mu * normal, i.slip());
  const double m1 = mass_of(m, i.upper.R), m2 = mass_of(m, i.lower.R);
  i.upper.vx += along / m1;
  i.upper.vz += normal / m1;
  i.upper.spin -= 2.5 * along / (m1 * i.upper.R);
  if (!i.on_plane()) {
    i.lower.vx -= along / m2;
    i.lower.vz -= normal / m2;
    i.lower.spin -= 2.5 * along / (m2 * i.lower.R);
  }
  return i;
}

/// The impact in the plane of its motion: Hertz, damping, a spring along the contact that is held
/// to mu |F_n| and, while it is not, damped.
class Reference {
public:
  Reference(const Material &m, const Impact &i) : a_(m), i_(i), c_(m, i) {}

  /// Both when they part.
  Impact after() {
    const double h = c_.time(i_.closing()) / 40000.0;
    State y;
    y << 0.0, i_.lower.R + i_.upper.R, i_.upper.vx, i_.upper.vz, i_.upper.spin, 0.0, 0.0,
        i_.lower.vx, i_.lower.vz, i_.lower.spin, 0.0;
    do {
      const State k1 = rates(y), k2 = rates(y + 0.5 * h * k1), k3 = rates(y + 0.5 * h * k2);
      y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rates(y + h * k3));
      const Loads l = loads(y);
      most_friction_ = std::fmax(most_friction_, std::fabs(l.friction));
      const double most = l.longest * (1.0 + 1e-12); // the next step begins sliding, too
      y[10] = std::fmin(std::fmax(y[10], -most), most);
    } while (loads(y).depth > 0.0);
    return {{i_.upper.R, y[2], y[3], y[4]}, {i_.lower.R, y[7], y[8], y[9]}};
  }

  /// Largest friction on the way, known after after().
  double most_friction() const { return most_friction_; }

private:
  using State = Eigen::Matrix<double, 11, 1>; // x, z, vx, vz, spin of both; spring
  struct Loads {
    double depth, nx, nz, arm1, arm2;       // n from the lower to the upper
    double slip, normal, friction, longest; // of and on the upper; along t = (nz, -nx)
  };
  Material a_;
  Impact i_;
  Contact c_;
  double most_friction_ = 0.0;

  Loads loads(const State &y) const {
    Loads l = {};
    const double dx = y[0] - y[5], dz = y[1] - y[6];
    const double r = i_.on_plane() ? y[1] : std::hypot(dx, dz);
    l.nx = i_.on_plane() ? 0.0 : dx / r;
    l.nz = i_.on_plane() ? 1.0 : dz / r;
    l.depth = i_.upper.R + i_.lower.R - r;
    l.arm1 = i_.upper.R - 0.5 * l.depth;
    l.arm2 = i_.on_plane() ? 0.0 : i_.lower.R - 0.5 * l.depth;
    const double vx = y[2] - y[7], vz = y[3] - y[8];
    l.slip = vx * l.nz - vz * l.nx - l.arm1 * y[4] - l.arm2 * y[9];
    if (l.depth <= 0.0)
      return l;
    const double root = std::sqrt(c_.R * l.depth), kt = 8.0 * c_.G * root;
    const double c = 2.0 * std::sqrt(5.0 / 6.0) * damping_ratio(a_.e);
    l.normal = 4.0 / 3.0 * c_.E * root * l.depth -
               c * std::sqrt(2.0 * c_.E * root * c_.m) * (vx * l.nx + vz * l.nz);
    const double most = a_.mu * std::fabs(l.normal);
    l.longest = most / kt;
    l.friction = std::fabs(y[10]) > l.longest ? std::copysign(most, -y[10])
                                              : -kt * y[10] - c * std::sqrt(kt * c_.m) * l.slip;
    return l;
  }

  State rates(const State &y) const {
    const Loads l = loads(y);
    const double fx = l.normal * l.nx + l.friction * l.nz;
    const double fz = l.normal * l.nz - l.friction * l.nx;
    const double m1 = mass_of(a_, i_.upper.R), I1 = 0.4 * m1 * i_.upper.R * i_.upper.R;
    const double m2 = i_.on_plane() ? HUGE_VAL : mass_of(a_, i_.lower.R);
    const double I2 = i_.on_plane() ? HUGE_VAL : 0.4 * m2 * i_.lower.R * i_.lower.R;
    State d;
    d << y[2], y[3], fx / m1, fz / m1, -l.arm1 * l.friction / I1, y[7], y[8], -fx / m2, -fz / m2,
        -l.arm2 * l.friction / I2, l.slip;
    return d;
  }
};

} // namespace calendem

#endif
