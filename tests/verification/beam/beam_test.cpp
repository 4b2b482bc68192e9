// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <Eigen/Dense>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, G = E / 2.6, R = 0.795, l = 1.28;
const double A = kPi * R * R, I = kPi * R * R * R * R / 4.0, J = 2.0 * I;
const double m = kDensity * 4.0 / 3.0 * kPi * R * R * R, I_s = 0.4 * m * R * R;

// n bonds along x; sphere 1 is at the origin.
std::vector<BodySphere> chain(int n) {
  std::vector<BodySphere> all;
  for (int k = 0; k <= n; ++k)
    all.push_back({{k * l, 0, 0}, R, 1});
  return all;
}

CaseRun run_chain(const std::vector<BodySphere> &spheres, const std::string &commands, double dt,
                  long steps, long every, const std::string &damping = "0") {
  Files files = files_of(spheres, {-20, -20, -20}, {60, 20, 20});
  files["start.in"] += commands;
  return CaseRun("in.body",
                 {{"Ey", "1e3"},
                  {"restitution", "1"},
                  {"friction", "0"},
                  {"ced", "0"},
                  {"damping", damping},
                  {"dt", number(dt)},
                  {"steps", std::to_string(steps)},
                  {"every", std::to_string(every)}},
                 1, files);
}

// Tip of a cantilever of n bonds under a load P.
double cantilever(int n, double P) {
  const double L = n * l;
  return P * L * L * L / (3.0 * E * I) * (1.0 - 0.25 / (n * n)) + P * L / (G * A);
}

// Drag of 0.7 of critical for the slowest mode, and the steps it takes to come to rest: exp(-28).
struct Rest {
  double drag;
  long steps;
};
Rest rest_of(int n, double stiffness, double dt) {
  const double omega = std::sqrt(stiffness / (m * (0.25 * n + 0.5)));
  return {1.4 * m * omega, std::lround(40.0 / omega / dt) + 2000};
}

std::string drag(double coefficient) {
  return "fix drag all viscous " + number(coefficient) + "\n";
}

} // namespace

TEST(VerificationBeam, Cantilever) {
  for (const int n : {1, 2, 5, 20}) {
    const double P = 1e-6 * n * l / cantilever(n, 1.0), dt = 5e-5;
    const Rest r = rest_of(n, 1.0 / cantilever(n, 1.0), dt);
    const std::string tip = std::to_string(n + 1);
    const CaseRun run =
        run_chain(chain(n),
                  "unfix integrate\ngroup base id 1\ngroup free subtract all base\n"
                  "fix integrate free nve/sphere\ngroup tip id " +
                      tip + "\nfix load tip addforce 0 0 " + number(P) + "\n" + drag(r.drag),
                  dt, r.steps, r.steps, "0.2");
    const auto frames = run.frames();
    ASSERT_EQ(frames.size(), 2u) << run.why();
    const double e = frames[1][n].at("z") / cantilever(n, P) - 1.0;
    std::printf("cantilever, %d bonds: deflection differs by %.1e\n", n, e);
    EXPECT_LT(std::fabs(e), 1e-8);
  }
}

TEST(VerificationBeam, ThreePointBending) {
  for (const int n : {2, 4, 20}) {
    const double unit = cantilever(n / 2, 0.5), P = 1e-6 * n * l / unit, dt = 5e-5;
    const Rest r = rest_of(n, 1.0 / unit, dt);
    const std::string ends = "1 " + std::to_string(n + 1), middle = std::to_string(n / 2 + 1);
    std::ostringstream bend;
    bend << "group ends id " << ends << "\ngroup middle id " << middle
         << "\nfix load middle addforce 0 0 " << number(P) << "\n"
         << drag(r.drag) << "fix supports ends setforce NULL NULL 0.0\n";
    const CaseRun run = run_chain(chain(n), bend.str(), dt, r.steps, r.steps, "0.2");
    const auto frames = run.frames();
    ASSERT_EQ(frames.size(), 2u) << run.why();
    const double e = frames[1][n / 2].at("z") / (P * unit) - 1.0;
    std::printf("three-point bending, %d bonds: deflection differs by %.1e\n", n, e);
    EXPECT_LT(std::fabs(e), 1e-8);
  }
}

// The tip is turned by hand and held; the chain passes the moment on to the clamped end.
TEST(VerificationBeam, TorsionChain) {
  for (const int n : {1, 5, 20}) {
    const double dt = 4e-5, spin = 1.0, angle = spin * 1000 * dt;
    const double slowest = 0.5 * kPi / n * std::sqrt(G * J / (l * I_s));
    const double pair = std::sqrt(2.0 * G * J / (l * I_s));
    const long steps = 1000 * std::lround(1.0 + 0.025 / (0.2 * slowest * slowest / pair) / dt);
    const std::string tip = std::to_string(n + 1);
    std::ostringstream turn;
    turn << "unfix integrate\ngroup held id 1 " << tip
         << "\ngroup free subtract all held\nfix integrate free nve/sphere\nset atom " << tip
         << " omegax " << number(spin) << "\nrun 1000\nset atom " << tip << " omegax 0\n";
    const CaseRun run = run_chain(chain(n), turn.str(), dt, steps, 1000, "0.2");
    const auto frames = run.frames();
    ASSERT_GT(frames.size(), 1u) << run.why();
    const double moment = G * J * angle / (n * l);
    const double at_tip = -frames.back()[n].at("tqx") / moment - 1.0;
    const double at_base = frames.back()[0].at("tqx") / moment - 1.0;
    std::printf("torsion, %d bonds: moment differs by %.1e at the tip, %.1e at the base\n", n,
                at_tip, at_base);
    EXPECT_LT(std::fabs(at_tip), 1e-8);
    EXPECT_LT(std::fabs(at_base), 1e-8);
  }
}

namespace {

struct FirstMode {
  double omega;
  Eigen::VectorXd shape; // deflection and slope of spheres 1..n, sphere 0 being clamped
};

// Stiffness and mass of the chain in the plane: slip and bending of each bond as in the law.
FirstMode first_mode(int n) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  Eigen::VectorXd M(2 * n);
  for (int b = 0; b < n; ++b) { // bond between spheres b and b + 1; dof of sphere s: 2 (s - 1)
    Eigen::VectorXd slip = Eigen::VectorXd::Zero(2 * n), bend = slip;
    const int j = 2 * b, i = j - 2;
    slip(j) = 1.0;
    slip(j + 1) = -0.5 * l;
    bend(j + 1) = 1.0;
    if (i >= 0) {
      slip(i) = -1.0;
      slip(i + 1) = -0.5 * l;
      bend(i + 1) = -1.0;
    }
    K += G * A / l * slip * slip.transpose() + E * I / l * bend * bend.transpose();
    M(j) = m;
    M(j + 1) = I_s;
  }
  const Eigen::VectorXd scale = M.cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(scale.asDiagonal() * K *
                                                             scale.asDiagonal());
  return {std::sqrt(modes.eigenvalues()(0)), scale.asDiagonal() * modes.eigenvectors().col(0)};
}

// First frequency over that of a slender clamped beam of n l with mass m/l.
double of_slender(int n) {
  const double L = n * l;
  return first_mode(n).omega / (3.51601526851 * std::sqrt(E * I * l / (m * L * L * L * L)));
}

} // namespace

TEST(VerificationBeam, FirstFrequency) {
  const int n = 20;
  const FirstMode mode = first_mode(n);
  std::vector<BodySphere> all = chain(n);
  const double scale = 1e-4 / mode.shape(2 * n - 2); // tip at 1e-4 um/us
  for (int s = 1; s <= n; ++s) {
    all[s].v.z = scale * mode.shape(2 * s - 2);
    all[s].omega.y = -scale * mode.shape(2 * s - 1); // a turn about +y takes +x to -z
  }
  const double dt = 8e-5;
  const long steps = std::lround(4.0 * kPi / mode.omega / dt);
  const CaseRun run = run_chain(all,
                                "unfix integrate\ngroup base id 1\ngroup free subtract all base\n"
                                "fix integrate free nve/sphere\n",
                                dt, steps, steps / 100);
  const auto frames = run.frames();
  ASSERT_GT(frames.size(), 99u) << run.why();
  double worst = 0.0;
  const long stride = steps / 100;
  for (size_t k = 0; k < frames.size(); ++k) {
    const double expected = std::cos(2.0 * std::asin(0.5 * mode.omega * dt) * k * stride);
    worst = std::fmax(worst, std::fabs(frames[k][n].at("vz") / 1e-4 - expected));
  }
  std::printf("first mode of 20 bonds, %.6g rad/us: two periods depart by %.1e\n", mode.omega,
              worst);
  EXPECT_LT(worst, 1e-6);
}

TEST(VerificationBeam, FirstFrequencyTendsToTheSlenderBeams) {
  const double half = of_slender(80), full = of_slender(160), limit = 2.0 * full - half;
  std::printf("first frequency / slender beam: %.5f (20), %.5f (80), %.5f (160), limit %.6f\n",
              of_slender(20), half, full, limit);
  EXPECT_NEAR(limit, 1.0, 2e-4);
}
