// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "physics/body_strength.h"
#include "physics/pre_cracks.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double kModulus = 5.0, kMean = 2e5, kLength = 1.28, E = 2e8; // -, kPa, um, kPa
constexpr std::uint64_t kSeed = 7;

// `chains` chains of `bonds` bonds along x on a square grid, one body each; tags run along y and z
// first, so that sphere k of chain c has the tag k chains + c + 1.
Files chains_of(int bonds, int chains) {
  const int row = static_cast<int>(std::ceil(std::sqrt(chains)));
  std::vector<BodySphere> all;
  for (int k = 0; k <= bonds; ++k)
    for (int c = 0; c < chains; ++c) {
      const int y = c % row, z = c / row;
      all.push_back({{k * kLength, 3.0 * y, 3.0 * z}, 0.795, c + 1});
    }
  const double wide = 3.0 * row;
  return files_of(all, {-5, -5, -5}, {bonds * kLength + 5, wide, wide});
}

// Every bond is stretched alike (v = rate x) up to a stress of `upto` x kMean in `steps` steps.
CaseRun stretch(int bonds, int chains, double upto, int steps,
                const std::string &law = "pre_cracks 0") {
  const double dt = 1e-4, rate = upto * kMean / E / (steps * dt);
  Files files = chains_of(bonds, chains);
  files["start.in"] += "unfix integrate\nvariable v atom " + number(rate) +
                       "*x\nfix pull all move variable NULL NULL NULL v_v NULL NULL units box\n";
  return CaseRun("in.body",
                 {{"Ey", "1e3"},
                  {"restitution", "1"},
                  {"friction", "0"},
                  {"ced", "0"},
                  {"breakable", "yes"},
                  {"weibull", number(kModulus)},
                  {"seed", std::to_string(kSeed)},
                  {"bond_laws", "'" + law + "'"},
                  {"skin", "0.15"},
                  {"dt", number(dt)},
                  {"steps", std::to_string(steps)},
                  {"every", std::to_string(steps)}},
                 1, files);
}

struct Weibull {
  double modulus, scale;
};

// Maximum likelihood: bisection on the modulus.
Weibull fitted(const std::vector<double> &x) {
  const auto slope = [&](double m) {
    double p = 0.0, pl = 0.0, l = 0.0;
    for (const double v : x) {
      p += std::pow(v, m);
      pl += std::pow(v, m) * std::log(v);
      l += std::log(v);
    }
    return pl / p - 1.0 / m - l / x.size();
  };
  double low = 0.5, high = 50.0;
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (slope(middle) < 0.0 ? low : high) = middle;
  }
  double p = 0.0;
  for (const double v : x)
    p += std::pow(v, low);
  return {low, std::pow(p / x.size(), 1.0 / low)};
}

// Bodies of 2, 4, 8, 16 unequal spheres: chains whose bonds are all as strong as their body.
constexpr int kBodies = 400, kSteps = 800;
constexpr double kExponent = 1.2, kScatter = 0.2, kReference = 3.0, kUpto = 4.0; // -, -, um, -

int spheres_of(int body) { return 2 << (body - 1) % 4; }
double radius_of(int k) { return 0.72 + 0.025 * (k % 4); }

Files bodies_of_four_sizes(const std::string &before = "") {
  std::vector<BodySphere> all;
  for (int body = 1; body <= kBodies; ++body)
    for (int k = 0; k < spheres_of(body); ++k) {
      const int y = body % 20, z = body / 20;
      all.push_back({{k * kLength, 3.0 * y, 3.0 * z}, radius_of(k), body});
    }
  Files files = files_of(all, {-5, -5, -5}, {16 * kLength + 5, 65, 65});
  const double rate = kUpto * kMean / E / (kSteps * 1e-4);
  files["start.in"] += "unfix integrate\nvariable v atom " + number(rate) +
                       "*x\nfix pull all move variable NULL NULL NULL v_v NULL NULL units box\n" +
                       before;
  return files;
}

const std::string kBodyLaws = "body_scatter " + number(kScatter) + " body_size " +
                              number(kExponent) + " " + number(kReference);

CaseRun stretch_bodies(const std::string &laws, int ranks, int steps, const Files &files,
                       bool restart = false, double modulus = 0.0) {
  return CaseRun("in.body",
                 {{"Ey", "1e3"},
                  {"restitution", "1"},
                  {"friction", "0"},
                  {"ced", "0"},
                  {"breakable", "yes"},
                  {"weibull", number(modulus)},
                  {"seed", std::to_string(kSeed)},
                  {"bond_laws", "'" + laws + "'"},
                  {"restart", restart ? "1" : "0"},
                  {"gx", std::to_string(ranks)}, // across the bodies
                  {"skin", "0.15"},
                  {"dt", "1e-4"},
                  {"steps", std::to_string(steps)},
                  {"every", std::to_string(steps)}},
                 ranks, files);
}

// First break of each body in kMean, less half a step's increment.
std::map<int, double> first_breaks(const CaseRun &run) {
  std::map<int, double> first; // the log is in the order of time
  for (const Row &b : run.rows("breaks.csv"))
    first.insert(
        {std::lround(b.at("body")), 1e3 * b.at("sigma_MPa") / kMean - 0.5 * kUpto / kSteps});
  return first;
}

double diameter_of(int body) {
  double cubes = 0.0;
  for (int k = 0; k < spheres_of(body); ++k)
    cubes += std::pow(2.0 * radius_of(k), 3);
  return std::cbrt(cubes);
}

} // namespace

TEST(VerificationStrength, BodiesBreakAtTheirOwnStrength) {
  const CaseRun run = stretch_bodies(kBodyLaws, 1, kSteps, bodies_of_four_sizes());
  const std::map<int, double> first = first_breaks(run);
  ASSERT_EQ(first.size(), static_cast<size_t>(kBodies)) << run.why();
  Eigen::Matrix<double, kBodies, 2> A;
  Eigen::VectorXd strength(kBodies);
  double worst = 0.0, mean = 0.0; // distance in increments; of z
  for (const auto &[body, found] : first) {
    const double size = std::pow(diameter_of(body) / kReference, -kExponent);
    const double own = size * body_scatter_factor(kScatter, kSeed, body);
    worst = std::fmax(worst, std::fabs(found - own) / (kUpto / kSteps));
    A.row(body - 1) << 1.0, -std::log(diameter_of(body) / kReference);
    strength(body - 1) = std::log(found);
    mean += (std::log(found / size) + 0.5 * kScatter * kScatter) / kScatter / kBodies;
  }
  EXPECT_LT(worst, 0.52); // within the step; 0.02 for the length that a step adds to and six digits
  const Eigen::Vector2d fit = (A.transpose() * A).inverse() * (A.transpose() * strength);
  const double sd = (strength - A * fit).norm() / std::sqrt(kBodies - 2.0);
  const double spread =
      (A.col(1).array() - A.col(1).mean()).matrix().norm(); // of ln d, times sqrt(n)
  const double z_exponent = (fit(1) - kExponent) * spread / kScatter;
  const double z_scatter = (sd / kScatter - 1.0) * std::sqrt(2.0 * kBodies);
  const double z_mean = mean * std::sqrt(double(kBodies));
  std::printf("bodies: exponent %.4f of %g (%.2f standard errors), scatter %.4f of %g (%.2f), mean "
              "%.2f; first break at most %.3f increments from the middle of its step\n",
              fit(1), kExponent, z_exponent, sd, kScatter, z_scatter, z_mean, worst);
  for (const double z : {z_exponent, z_scatter, z_mean})
    EXPECT_LT(std::fabs(z), 3.0);
}

TEST(VerificationStrength, BodiesAreTheSameOnTwoRanksAndAfterARestart) {
  const int half = kSteps / 2;
  const Files files =
      bodies_of_four_sizes("run " + std::to_string(half) + "\nwrite_restart half.restart\n");
  const CaseRun one = stretch_bodies(kBodyLaws, 1, half, files);
  const CaseRun two = stretch_bodies(kBodyLaws, 2, half, files);
  const std::string log = one.text("breaks.csv");
  ASSERT_EQ(first_breaks(one).size(), static_cast<size_t>(kBodies)) << one.why();
  EXPECT_EQ(log, two.text("breaks.csv")) << two.why();
  Files rest = bodies_of_four_sizes();
  rest["half.restart"] = one.text("half.restart");
  // without the laws: what was drawn at the creation is in the file
  EXPECT_EQ(log, stretch_bodies("pre_cracks 0", 1, half, rest, true).text("breaks.csv"));
}

TEST(VerificationStrength, BodiesThatAreOffChangeNoBit) {
  const Files files = bodies_of_four_sizes();
  const CaseRun without = stretch_bodies("pre_cracks 0", 1, kSteps, files, false, kModulus);
  const CaseRun off =
      stretch_bodies("body_scatter 0 body_size 0 3", 1, kSteps, files, false, kModulus);
  ASSERT_EQ(first_breaks(without).size(), static_cast<size_t>(kBodies)) << without.why();
  for (const char *file : {"breaks.csv", "spheres.dump", "curve.csv"})
    EXPECT_EQ(without.text(file), off.text(file)) << off.why();
}

TEST(VerificationStrength, WeibullFromTenThousandBonds) {
  const int bonds = 10000, steps = 1000;
  const double upto = 2.0, increment = upto * kMean / steps;
  const CaseRun run = stretch(1, bonds, upto, steps);
  const std::vector<Row> breaks = run.rows("breaks.csv");
  ASSERT_EQ(breaks.size(), static_cast<size_t>(bonds)) << run.why();
  std::vector<double> strengths;
  double worst = 0.0; // distance of the stress at the break beyond the bond's own strength
  for (const Row &b : breaks) {
    const double sigma = 1e3 * b.at("sigma_MPa");
    const double own = kMean * weibull_factor(kModulus, kSeed, std::lround(b.at("tag_i")),
                                              std::lround(b.at("tag_j")));
    EXPECT_GE(sigma, own * (1.0 - 1e-5)); // six digits in the log
    worst = std::fmax(worst, (sigma - own) / increment);
    strengths.push_back((sigma - 0.5 * increment) / kMean);
  }
  const Weibull w = fitted(strengths);
  const double scale = 1.0 / std::tgamma(1.0 + 1.0 / kModulus), root = std::sqrt(double(bonds));
  const double z_modulus = (w.modulus / kModulus - 1.0) * root / 0.7797;
  const double z_scale = (w.scale / scale - 1.0) * root * kModulus / 1.0526;
  std::printf(
      "Weibull: modulus %.4f of %g (%.2f standard errors), scale %.5f of %.5f (%.2f); break "
      "at most %.3f increments late\n",
      w.modulus, kModulus, z_modulus, w.scale, scale, z_scale, worst);
  EXPECT_LT(std::fabs(z_modulus), 3.0);
  EXPECT_LT(std::fabs(z_scale), 3.0);
  EXPECT_LT(worst, 1.02);
}

TEST(VerificationStrength, AChainIsAsStrongAsItsWeakestBond) {
  const int chains = 300, steps = 400;
  for (const int bonds : {4, 32}) {
    const CaseRun run = stretch(bonds, chains, 1.6, steps);
    std::map<int, double> first; // by body; the log is in the order of time
    for (const Row &b : run.rows("breaks.csv"))
      first.insert({std::lround(b.at("body")), 1e3 * b.at("sigma_MPa") - 0.8 * kMean / steps});
    ASSERT_EQ(first.size(), static_cast<size_t>(chains)) << run.why();
    std::vector<double> strengths;
    double mean = 0.0;
    for (const auto &f : first) {
      strengths.push_back(f.second / kMean);
      mean += f.second / kMean / chains;
    }
    const double expected = std::pow(bonds, -1.0 / kModulus);
    const double variation = std::sqrt(
        std::tgamma(1.0 + 2.0 / kModulus) / std::pow(std::tgamma(1.0 + 1.0 / kModulus), 2) - 1.0);
    const double z = (mean / expected - 1.0) * std::sqrt(double(chains)) / variation;
    std::printf("chains of %d: strength %.4f, N^(-1/m) %.4f (%.2f standard errors), modulus %.2f\n",
                bonds, mean, expected, z, fitted(strengths).modulus);
    EXPECT_LT(std::fabs(z), 3.0);
    EXPECT_NEAR(fitted(strengths).modulus / kModulus, 1.0,
                3.0 * 0.7797 / std::sqrt(double(chains)));
  }
}

TEST(VerificationStrength, CrackedBondsBreakAtTheFirstLoadAndNoOther) {
  const int bonds = 1000, steps = 100;
  const double fraction = 0.2;
  const CaseRun run = // sound ones need 0.26 kMean or more
      stretch(1, bonds, 0.2, steps, "pre_cracks " + number(fraction));
  std::set<std::pair<long, long>> expected, found;
  for (int c = 1; c <= bonds; ++c)
    if (pre_crack_factor(fraction, kSeed, c, c + bonds) < 1.0)
      expected.insert({c, c + bonds});
  double last = 0.0;
  for (const Row &b : run.rows("breaks.csv")) {
    found.insert({std::lround(b.at("tag_i")), std::lround(b.at("tag_j"))});
    last = std::fmax(last, b.at("sigma_MPa"));
  }
  std::printf("pre-cracks: %zu of %d bonds, the last at %.3g MPa\n", found.size(), bonds, last);
  EXPECT_EQ(found, expected) << run.why();
  EXPECT_LT(last, 1e-3 * 0.2 * kMean / steps * 1.01); // the first step's stress
}
