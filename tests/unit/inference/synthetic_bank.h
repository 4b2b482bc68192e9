// SPDX-License-Identifier: GPL-2.0-or-later
// A bank from formulas: a press without simulation, with curvature, packings and three effects.
#ifndef CALENDEM_TESTS_DIAGNOSE_SYNTHETIC_BANK_H
#define CALENDEM_TESTS_DIAGNOSE_SYNTHETIC_BANK_H

#include "base/random.h"
#include "diagnose/inference/bank.h"
#include "inference/numerics.h"

namespace calendem::inference {

constexpr int kCurve = 12;

/// A pressure curve of 12 points, porosity after, springback, broken fraction.
inline std::vector<ObservableId> synthetic_observables() {
  std::vector<ObservableId> all;
  for (int k = 0; k < kCurve; ++k)
    all.push_back({"ln pressure", "compression", "p150", k / (kCurve - 1.0)});
  all.push_back({"porosity_after", "relaxation", "p150"});
  all.push_back({"springback", "relaxation", "p150"});
  all.push_back({"broken", "compression", "p150"});
  all.push_back({"dwell decay", "dwell", "p150"});
  return all;
}

/// Base parameters and amplitudes about -1..1 and 0..1. `scatter`: standard deviation of a packing.
inline Vector synthetic_values(double stiffness, double strength, const std::string &effect,
                               double a, Random &packing, double scatter) {
  Vector v(kCurve + 4);
  const double b0 = packing.normal(), b1 = packing.normal();
  for (int k = 0; k < kCurve; ++k) {
    const double x = k / (kCurve - 1.0);
    v[k] = 3.0 * x + stiffness * (0.5 + 0.3 * x) + 0.1 * stiffness * stiffness * x +
           scatter * (b0 + b1 * x);
    v[k] -= effect == "plasticity" ? 0.8 * a * x * x : 0.0;
    v[k] += effect == "friction" ? 0.8 * a * (1.0 - x) * (1.0 - x) : 0.0;
    v[k] += effect == "oscillation" ? 0.5 * a * std::sin(20.0 * x) : 0.0;
  }
  v[kCurve] = 0.3 * stiffness - 0.2 * strength + scatter * packing.normal();
  v[kCurve + 1] = -0.4 * stiffness + 0.1 * stiffness * strength + scatter * packing.normal();
  v[kCurve + 2] = -0.7 * strength + 0.1 * strength * strength + scatter * packing.normal();
  v[kCurve + 3] = 0.05 * stiffness + scatter * packing.normal();
  if (effect == "plasticity") {
    v[kCurve] -= 0.5 * a + 0.2 * a * a;
    v[kCurve + 1] -= 0.6 * a;
  }
  if (effect == "viscous") { // looks like plasticity but for the dwell
    for (int k = 0; k < kCurve; ++k)
      v[k] -= 0.8 * a * std::pow(k / (kCurve - 1.0), 2);
    v[kCurve] -= 0.5 * a + 0.2 * a * a;
    v[kCurve + 1] -= 0.6 * a;
    v[kCurve + 3] += 0.9 * a;
  }
  return v;
}

inline Bank synthetic_bank(int runs, double scatter) {
  Bank bank;
  bank.base = {{"stiffness", {Prior::uniform, -1.0, 1.0}, false},
               {"strength", {Prior::normal, 0.0, 0.5}, false}};
  for (const char *name : {"plasticity", "friction", "viscous"})
    bank.effects.push_back({name, {{"amplitude", {Prior::uniform, 0.0, 1.0}, true}}});
  bank.observables = synthetic_observables();
  const Matrix points = sobol_points(2, runs, 0), amplitudes = sobol_points(1, runs, 5);
  for (int i = 0; i < runs; ++i) {
    const double stiffness = 2.0 * points(0, i) - 1.0, strength = 2.0 * points(1, i) - 1.0;
    for (int e = -1; e < 3; ++e) {
      Random packing(std::uint64_t(i), 77);
      BankRun r;
      r.packing = "p" + std::to_string(i);
      r.effect = e < 0 ? "" : bank.effects[e].name;
      r.base = Eigen::Vector2d(stiffness, strength);
      r.amplitudes = e < 0 ? Vector() : Vector::Constant(1, amplitudes(0, i));
      r.values =
          synthetic_values(stiffness, strength, r.effect, amplitudes(0, i), packing, scatter);
      bank.runs.push_back(r);
    }
  }
  return bank;
}

/// An experiment with the first 15 observables: no dwell.
inline ObservableVector synthetic_experiment(const std::string &effect, double a,
                                             std::uint64_t seed, double scatter, double noise) {
  Random random(seed, 99);
  ObservableVector e;
  e.of = synthetic_observables();
  e.of.pop_back();
  const double stiffness = 1.6 * random.uniform() - 0.8, strength = 0.4 * random.normal();
  e.values = synthetic_values(stiffness, strength, effect, a, random, scatter).head(kCurve + 3);
  for (double &v : e.values)
    v += noise * random.normal();
  e.covariance = noise * noise * Matrix::Identity(kCurve + 3, kCurve + 3);
  return e;
}

} // namespace calendem::inference

#endif
