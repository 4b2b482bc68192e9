// SPDX-License-Identifier: GPL-2.0-or-later
// The bound against the exact limit, from the eigenvalues of the assembled cluster.
#include "physics/time_step_bound.h"

#include <algorithm>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "random_vector.h"

using namespace calendem;

namespace {

struct Sphere {
  Vec3 x;
  double radius;
  double mass() const { return 4.65 * 4.0 / 3.0 * kPi * radius * radius * radius; }
};

/// Largest |eigenvalue|: the 2^40th root of the norm of that power (Gelfand's formula). Eigen's own solvers take
/// twenty seconds to compile.
double spectral_radius(Eigen::MatrixXd power) {
  double log_radius = 0.0;
  for (int squared = 0; squared <= 40; ++squared) {
    const double norm = power.norm();
    log_radius += std::ldexp(std::log(norm), -squared);
    power /= norm;
    power = Eigen::MatrixXd(power * power);
  }
  return std::exp(log_radius);
}

struct Cluster {
  BondMaterial material;
  std::vector<Sphere> spheres;
  std::vector<std::pair<int, int>> bonds;

  BondStiffness stiffness(const std::pair<int, int> &b, BondCoefficients *damping = nullptr) const {
    const Sphere &i = spheres[b.first], &j = spheres[b.second];
    const double least = std::min(i.radius, j.radius);
    const BondSection section(material.radius_ratio * least);
    const BondStiffness k(material, section, norm(i.x - j.x));
    const double mass = i.mass() * j.mass() / (i.mass() + j.mass());
    if (damping)
      *damping = BondDamping(material, section, k, mass, least);
    return k;
  }
  double bound() const {
    std::vector<SphereBlock> k(spheres.size()), c(spheres.size());
    for (const auto &b : bonds) {
      BondCoefficients damping;
      const BondStiffness stiff = stiffness(b, &damping);
      const Vec3 d = spheres[b.first].x - spheres[b.second].x;
      const Vec3 n = (1.0 / norm(d)) * d;
      k[b.first].add(stiff, n, norm(d));
      c[b.first].add(damping, n, norm(d));
      k[b.second].add(stiff, -n, norm(d));
      c[b.second].add(damping, -n, norm(d));
    }
    double least = HUGE_VAL;
    for (size_t a = 0; a < spheres.size(); ++a)
      least = stable_step(k[a], c[a], spheres[a].mass(), spheres[a].radius, least);
    return least;
  }
  /// Turned about `axis` by that angle.
  Cluster turned(const Vec3 &axis, double angle) const {
    Cluster c = *this;
    for (Sphere &s : c.spheres)
      s.x =
          turn(s.x, std::tan(0.5 * angle) * axis, 2.0 / (1.0 + std::pow(std::tan(0.5 * angle), 2)));
    return c;
  }
  // Mass-scaled matrix (6 rows per sphere) of one kind of coefficients.
  Eigen::MatrixXd matrix(bool damping) const;
  double exact_limit() const { // undamped: 2/omega_max
    return 2.0 / std::sqrt(spectral_radius(matrix(false)));
  }
  // Largest |eigenvalue| of one step of the host's integrator, whose forces see the velocity of the
  // half step before: v' = v - dt (K x + C v), x' = x + dt v'.
  double growth(double dt) const {
    const Eigen::MatrixXd K = matrix(false), C = matrix(true);
    const Eigen::Index n = K.rows();
    Eigen::MatrixXd step(2 * n, 2 * n);
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
    step.topLeftCorner(n, n) = one - dt * C;
    step.topRightCorner(n, n) = -dt * K;
    step.bottomLeftCorner(n, n) = dt * (one - dt * C);
    step.bottomRightCorner(n, n) = one - dt * dt * K;
    return spectral_radius(step);
  }
};

// Column by column from the law itself: move or turn one sphere at unit velocity for one unit of
// time and read the forces. `advance` with d, v given is linear in v; tension is added by hand.
Eigen::MatrixXd Cluster::matrix(bool damping) const {
  const Eigen::Index n = 6 * static_cast<Eigen::Index>(spheres.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (const auto &b : bonds) {
    BondCoefficients coefficients = stiffness(b);
    if (damping)
      stiffness(b, &coefficients);
    const Vec3 d = spheres[b.first].x - spheres[b.second].x;
    for (int column = 0; column < 12; ++column) {
      double q[12] = {};
      q[column] = 1.0;
      const PairMotion m = {d,           load(q) - load(q + 6), load(q + 3),
                            load(q + 9), (1.0 / norm(d)) * d,   norm(d)};
      BondDamping c;
      static_cast<BondCoefficients &>(c) = coefficients;
      const BondAction a = action({}, 0.0, m, c); // viscous law = elastic law per unit of motion
      const Vec3 rows[4] = {a.force, a.torque_i, -a.force, a.torque_j};
      for (int r = 0; r < 12; ++r) {
        const double f[3] = {rows[r / 3].x, rows[r / 3].y, rows[r / 3].z};
        K(6 * (r < 6 ? b.first : b.second) + r % 6,
          6 * (column < 6 ? b.first : b.second) + column % 6) -= f[r % 3];
      }
    }
  }
  Eigen::VectorXd scale(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const Sphere &s = spheres[r / 6];
    scale[r] = 1.0 / std::sqrt(r % 6 < 3 ? s.mass() : 0.4 * s.mass() * s.radius * s.radius);
  }
  return scale.asDiagonal() * K * scale.asDiagonal();
}

Cluster cubic(int side, double damping, double radius_ratio = 1.0, double spacing = 1.28) {
  Cluster c;
  c.material = {2e8, shear_modulus(2e8, 0.3), radius_ratio, damping};
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z)
        c.spheres.push_back({{spacing * x, spacing * y, spacing * z}, 0.795});
  for (size_t i = 0; i < c.spheres.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (norm(c.spheres[i].x - c.spheres[j].x) < 1.1 * spacing)
        c.bonds.push_back({static_cast<int>(i), static_cast<int>(j)});
  return c;
}

// Bonds between neighbours of a block of the cubic lattice; of 1 x 1 x n a chain, of 1 x n x n a plate.
Cluster block(int nx, int ny, int nz, double damping, double radius_ratio, double spacing) {
  Cluster c = cubic(std::max({nx, ny, nz}), damping, radius_ratio, spacing);
  std::vector<int> kept(c.spheres.size(), -1);
  std::vector<Sphere> spheres;
  for (size_t n = 0; n < c.spheres.size(); ++n) {
    const Vec3 x = (1.0 / spacing) * c.spheres[n].x;
    if (x.x > nx - 0.5 || x.y > ny - 0.5 || x.z > nz - 0.5)
      continue;
    kept[n] = static_cast<int>(spheres.size());
    spheres.push_back(c.spheres[n]);
  }
  std::vector<std::pair<int, int>> bonds;
  for (const auto &b : c.bonds)
    if (kept[b.first] >= 0 && kept[b.second] >= 0)
      bonds.push_back({kept[b.first], kept[b.second]});
  c.spheres = spheres;
  c.bonds = bonds;
  return c;
}

Cluster random_cluster(RandomVectors &random, double radius_ratio, double poisson) {
  Cluster c;
  c.material = {2e8, shear_modulus(2e8, poisson), radius_ratio, 0.0};
  for (int n = 0; n < 12; ++n)
    c.spheres.push_back({random.vector(1.5), random.number(0.4, 0.8)});
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < i; ++j) {
      const double r = norm(c.spheres[i].x - c.spheres[j].x);
      if (r > 0.4 && r < c.spheres[i].radius + c.spheres[j].radius)
        c.bonds.push_back({i, j});
    }
  return c;
}

} // namespace

// Requirement: the row's closed form is the exact limit of one oscillator with lagged damping: at
// it an eigenvalue of the step leaves the unit circle (1e-9 either side).
TEST(TimeStepBound, OneOscillator) {
  for (double C : {0.0, 0.3, 3.0}) {
    const double K = 2.0, dt = stable_step(K, C);
    const auto radius = [&](double h) {
      Eigen::Matrix2d step;
      step << 1.0 - h * C, -h * K, h * (1.0 - h * C), 1.0 - h * h * K;
      return step.eigenvalues().cwiseAbs().maxCoeff();
    };
    EXPECT_LE(radius(dt * (1.0 - 1e-9)), 1.0 + 1e-12);
    EXPECT_GT(radius(dt * (1.0 + 1e-6)), 1.0 + 1e-9);
  }
  EXPECT_DOUBLE_EQ(stable_step(2.0, 0.0), 2.0 / std::sqrt(2.0));
  EXPECT_EQ(stable_step(0.0, 0.0), HUGE_VAL);
}

// Requirement: a cubic body is stable at the bound, and the bound does not waste much: the exact
// limit is at most 1.35 times it.
TEST(TimeStepBound, CubicBody) {
  for (int side : {2, 3, 5}) {
    const Cluster c = cubic(side, 0.0);
    const double ratio = c.exact_limit() / c.bound();
    std::printf("%d^3 body: bound %.4g us, exact %.4g us, ratio %.3f\n", side, c.bound(),
                c.exact_limit(), ratio);
    EXPECT_GT(ratio, 1.0);
    EXPECT_LT(ratio, 1.35);
  }
}

// Requirement: with bond damping the body is stable at the bound (spectral radius 1; 1e-8: a rigid
// body's defective eigenvalue 1 is found to the square root of round-off) and unstable at 1.5
// times.
TEST(TimeStepBound, DampedCubicBody) {
  for (double damping : {0.02, 0.1, 0.3}) {
    const Cluster c = cubic(2, damping);
    EXPECT_LT(c.bound(), cubic(2, 0.0).bound());
    EXPECT_LT(c.growth(c.bound()), 1.0 + 1e-6);
    EXPECT_GT(c.growth(1.5 * c.bound()), 1.01);
  }
}

// Requirement: the bound holds for irregular clusters of unequal spheres, also with thin bonds.
TEST(TimeStepBound, IrregularClusters) {
  RandomVectors random(8);
  for (const double radius_ratio : {1.5, 1.0, 0.5, 0.2}) {
    double least = HUGE_VAL, most = 0.0;
    for (int n = 0; n < 40; ++n) {
      const Cluster c = random_cluster(random, radius_ratio, 0.3);
      const double ratio = c.exact_limit() / c.bound();
      least = std::min(least, ratio);
      most = std::max(most, ratio);
    }
    std::printf("irregular clusters, lambda %g: exact/bound %.3f to %.3f\n", radius_ratio, least,
                most);
    EXPECT_GE(least, 1.0 - 1e-7);
    EXPECT_LT(most, 1.5);
  }
}

// Requirement: however a pair, a chain, a plate or a body is turned, the exact limit is not below the
// bound, and the bound is the same, to the 24 digits that it has and the round-off of a turn.
TEST(TimeStepBound, TurnedPairsChainsAndPlates) {
  RandomVectors random(5);
  const int sizes[][3] = {{1, 1, 2}, {1, 1, 4}, {1, 3, 3}, {2, 2, 2}};
  for (const auto &n : sizes)
    for (const double radius_ratio : {1.5, 1.0, 0.6, 0.5, 0.3})
      for (const double spacing : {1.28, 1.59}) {
        const Cluster straight = block(n[0], n[1], n[2], 0.0, radius_ratio, spacing);
        const double limit = straight.exact_limit(), bound = straight.bound();
        EXPECT_GE(limit, (1.0 - 1e-7) * bound);
        EXPECT_LT(limit, 1.5 * bound) << n[0] << n[1] << n[2] << " lambda " << radius_ratio;
        for (int k = 0; k < 100; ++k) {
          const Cluster turned = straight.turned(random.unit(), random.number(0.0, 3.0));
          EXPECT_NEAR(turned.bound(), bound, 2e-7 * bound);
        }
      }
}

// Requirement: for a pair along [111] the bound is close to the exact limit: its thin bonds resist
// along the line, which no axis shows by itself.
TEST(TimeStepBound, PairAlongTheDiagonal) {
  for (const double radius_ratio : {1.5, 1.0, 0.6, 0.5, 0.3}) {
    Cluster pair = block(1, 1, 2, 0.0, radius_ratio, 1.59);
    pair.spheres[1].x = (1.59 / std::sqrt(3.0)) * Vec3{1.0, 1.0, 1.0};
    const double ratio = pair.exact_limit() / pair.bound();
    std::printf("pair along [111], lambda %g: exact/bound %.4f\n", radius_ratio, ratio);
    EXPECT_GE(ratio, 1.0 - 1e-7);
    EXPECT_LT(ratio, 1.35);
  }
}

// Requirement: with damping too, turned, at the bound no mode grows (1e-6 as above).
TEST(TimeStepBound, TurnedDampedClusters) {
  RandomVectors random(6);
  const int sizes[][3] = {{1, 1, 2}, {1, 1, 4}, {1, 2, 2}};
  for (const auto &n : sizes)
    for (const double radius_ratio : {1.0, 0.5})
      for (const double damping : {0.02, 0.3, 1.0}) {
        const Cluster c = block(n[0], n[1], n[2], damping, radius_ratio, 1.59)
                              .turned(random.unit(), random.number(0.0, 3.0));
        EXPECT_LT(c.growth(c.bound()), 1.0 + 1e-6) << n[1] << n[2] << " damping " << damping;
        EXPECT_GT(c.growth(2.0 * c.bound()), 1.01) << n[1] << n[2] << " damping " << damping;
      }
}

// Requirement: and for thinner bonds, from a pair to a body.
TEST(TimeStepBound, ThinBonds) {
  for (double ratio : {1.0, 0.91, 0.8})
    for (double spacing : {1.28, 1.59}) {
      Cluster pair = cubic(2, 0.0, ratio, spacing);
      pair.spheres.resize(2);
      pair.bonds = {{0, 1}};
      EXPECT_GT(pair.exact_limit() / pair.bound(), 1.0 - 1e-9)
          << "pair, lambda " << ratio << ", spacing " << spacing;
      const Cluster body = cubic(3, 0.0, ratio, spacing);
      EXPECT_GT(body.exact_limit() / body.bound(), 1.0)
          << "body, lambda " << ratio << ", spacing " << spacing;
    }
}

// Requirement: a sphere with two contacts per axis, without damping: per axis 2 k_n + 4 k_t against
// the mass, four arms R against the inertia, doubled by neighbours in opposition; dt = 2/sqrt(K).
// With damping the step is shorter, and near the critical one much.
TEST(TimeStepBound, SphereWithSixContacts) {
  const double E = 1e8, G = 2e7, a = 0.1, m = 9.0, R = 0.8;
  const BondCoefficients k = contact_stiffness(E, G, a), none;
  EXPECT_DOUBLE_EQ(k.normal, 2e7);
  EXPECT_DOUBLE_EQ(k.shear, 1.6e7);
  const double K = std::max(2.0 * (2.0 * k.normal + 4.0 * k.shear) / m,
                            2.0 * 4.0 * k.shear * R * R / (0.4 * m * R * R));
  const double limit = 2.0 / std::sqrt(K); // 1e-7: of 24 digits
  EXPECT_NEAR(stable_step_of_contacts(k, none, m, R), limit, 1e-7 * limit);
  const BondCoefficients c = contact_damping(k, -0.5, 0.5 * m);
  EXPECT_DOUBLE_EQ(c.normal, std::sqrt(5.0 / 6.0) * std::sqrt(k.normal * 0.5 * m));
  EXPECT_DOUBLE_EQ(c.shear, std::sqrt(5.0 / 6.0) * std::sqrt(k.shear * 0.5 * m));
  SphereBlock beside; // softer bonds, of a quarter of the contacts' stiffness
  for (const Vec3 &n : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    for (const double sign : {1.0, -1.0})
      beside.add({0.25 * k.normal, 0.25 * k.shear, 0.0, 0.0}, sign * n, 2.0 * R);
  EXPECT_NEAR(stable_step_of_contacts(k, none, m, R, beside), limit / std::sqrt(1.25),
              1e-7 * limit);
  EXPECT_LT(stable_step_of_contacts(k, c, m, R), 0.6 * stable_step_of_contacts(k, none, m, R));
}

// Requirement: the mean force gives the pressure back: P = n F 2R/3 with n = Z phi/(2 V) contacts
// per volume, Z = 6, phi = 0.6.
TEST(TimeStepBound, MeanContactForce) {
  const double R = 0.8, P = 1e5, volume = 4.0 / 3.0 * kPi * R * R * R;
  const double n = 6.0 * 0.6 / (2.0 * volume);
  EXPECT_DOUBLE_EQ(n * mean_contact_force(P, R) * 2.0 * R / 3.0, P);
}

// Requirement: Rayleigh time of NMC (2e8 kPa, 0.3, 4.65 g/cm3, 0.795 um), worked out by hand:
// pi R sqrt(rho/G) / (0.1631 nu + 0.8766) = 2.49757 * 2.45866e-4 / 0.92553.
TEST(TimeStepBound, RayleighTime) {
  EXPECT_NEAR(rayleigh_time(0.795, 4.65, 2e8, 0.3), 6.6347e-4, 1e-7);
}
