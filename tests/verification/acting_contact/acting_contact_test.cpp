// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "physics/nanopore_collapse.h"
#include "physics/sjkr_cohesion.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e6, nu = 0.3, R = 0.658, kWay = 1e-3; // [um] of a step
const double E_eff = effective_modulus(E, nu, E, nu);

// Two spheres, and the overlap from which their contact counts.
struct Pair {
  const char *name, *bonds; ///< settings of fix bond/bpm
  int bodies[2];            ///< 0: none
  double reference;         ///< [um]
  int start;                ///< acting gap at first, in ways
  int out;                  ///< away before they meet, in ways
  bool bonded, inside;      ///< in the end; of the row of contacts inside bodies
  double follows;           ///< part of the radii's shrinking by which the overlap gets smaller
};

const Pair kPlain = {"plain", "breakable no", {1, 2}, 0.0, 50, 0, false, false, 1.0};
const Pair kLattice = {"contact_diameter of the lattice",
                       "breakable no contact_diameter 0.9",
                       {1, 1},
                       0.1 * 2.0 * R,
                       200,
                       0,
                       false,
                       false,
                       0.9};
const Pair kPairs[] = {
    kPlain,
    {"inset of one", "breakable no surface_inset 0.1", {1, 0}, 0.1, 50, 0, false, false, 1.0},
    {"inset of both", "breakable no surface_inset 0.05", {1, 2}, 0.1, 50, 0, false, false, 1.0},
    kLattice,
    {"bonded", "breakable no", {1, 1}, 0.116, 0, 20, true, true, 0.0},
    {"bonded, with inset", "breakable no surface_inset 0.1", {1, 1}, 0.116, 0, 20, true, true, 0.0},
    {"broken", "tensile 1e-3 shear 1e-3", {1, 1}, 0.116, 0, 20, false, true, 0.0}};

// At rest with an acting overlap of so many ways.
Row at_rest(const Pair &pair, int overlap, Settings settings, int ranks = 1) {
  const double x = 2.0 * R - pair.reference + kWay * pair.start;
  const Files files =
      files_of({{{-0.5, 0, 0}, R, pair.bodies[0]}, {{x - 0.5, 0, 0}, R, pair.bodies[1]}},
               {-4, -4, -4}, {4, 4, 4});
  settings.insert({{"bonds", "\"" + std::string(pair.bonds) + "\""},
                   {"Ey", number(E)},
                   {"friction", "0"},
                   {"out", std::to_string(pair.out)},
                   {"in", std::to_string(pair.out + pair.start + overlap)},
                   {"px", std::to_string(ranks)}});
  const CaseRun run("acting_contact/in.approach", settings, ranks, files);
  EXPECT_TRUE(run.finished()) << pair.name << run.why();
  const std::vector<Row> rows = run.rows("contact.csv");
  EXPECT_FALSE(rows.empty()) << pair.name;
  return rows.empty() ? Row() : rows.back();
}

struct Worst {
  double of = 0.0;
  void near(const char *pair, double found, double expected, double scale) {
    const double off = std::fabs(found - expected) / scale;
    EXPECT_LT(off, 1e-10) << pair << ": " << found << ", by hand " << expected;
    of = std::fmax(of, off);
  }
};

// By hand, from the acting overlap alone.
void expect_by_hand(const Pair &pair, double overlap, double ced, const Row &found, Worst &worst) {
  const double distance = 2.0 * R - overlap, d = std::fmax(overlap, 0.0);
  const double push = hertz_force(E_eff, 0.5 * R, d);
  const double pull = pair.bonded ? 0.0 : sjkr_force(ced, distance, R, R);
  const double cohesive = pair.bonded ? 0.0 : sjkr_potential(ced, distance, R, R);
  const double length = 2.0 * R - pair.reference; // of a bond
  const double tension = pair.bonded ? -E * kPi * R * R * overlap / length : 0.0;
  const double force = hertz_force(E_eff, 0.5 * R, 0.03), energy = 0.4 * 0.03 * force;
  worst.near(pair.name, found.at("fx"), push - pull - tension, force);
  worst.near(pair.name, found.at("elastic"), hertz_energy(E_eff, 0.5 * R, d), energy);
  worst.near(pair.name, found.at("cohesive"), cohesive, energy);
  worst.near(pair.name, found.at("pushing"), pair.inside ? 0.0 : push, force);
  worst.near(pair.name, found.at("in_body"), pair.inside ? push : 0.0, force);
  worst.near(pair.name, found.at("pressure"), mean_pressure(push - pull, R),
             mean_pressure(force, R));
  EXPECT_EQ(found.at("met") + found.at("inside"), d > 0.0 ? 1.0 : 0.0) << pair.name;
}

// Nanoporosity in the end: the one that its own pressure leads to, by bisection.
double collapsed(const Pair &pair, const NanoporeCollapse &law, double overlap) {
  double low = law.floor, high = law.initial;
  for (int n = 0; n < 100; ++n) {
    const double phi = 0.5 * (low + high), r = law.radius(R, phi);
    const double d = overlap - 2.0 * pair.follows * (R - r);
    const double p = mean_pressure(hertz_force(E_eff, 0.5 * r, std::fmax(d, 0.0)), r);
    (phi < law.target(p) ? low : high) = phi;
  }
  return low;
}

} // namespace

TEST(VerificationActingContact, EveryReaderTakesTheOverlapBeyondTheReference) {
  const double ced = 1e4;
  Worst worst;
  for (const char *fused : {"on", "off"})
    for (const Pair &pair : kPairs)
      for (const int ways : {-15, 30}) // the spheres overlap and do not act; they act
        expect_by_hand(pair, kWay * ways, ced,
                       at_rest(pair, ways, {{"ced", number(ced)}, {"fused", fused}}), worst);
  std::printf("forces, energies, range, mean pressure: %.1e off\n", worst.of);
}

TEST(VerificationActingContact, OnTwoRanks) {
  const double ced = 1e4;
  Worst worst;
  for (const Pair &pair : kPairs)
    expect_by_hand(pair, 0.03, ced, at_rest(pair, 30, {{"ced", number(ced)}}, 2), worst);
}

// A pair with a reference is the plain pair that is as much further apart, whatever law it follows,
// for the bound of the time step too.
TEST(VerificationActingContact, EveryLawTakesTheOverlapBeyondTheReference) {
  const Settings laws[] = {
      {},
      {{"contact", "hertz_effects"}, {"yield", "1e5"}, {"hardening", "1e5"}},
      {{"contact", "hertz_effects"}, {"relaxed", "0.4"}, {"relaxation", "0.05"}},
      {{"contact", "hertz_effects"}, {"bulk", "2e6"}, {"free_surface", "0.9"}},
      {{"contact", "hertz_effects"}, {"hardness", "1.2e5"}}}; // its spheres grow as they give way
  Worst worst;
  for (const Settings &law : laws)
    for (const int ways : {-15, 100}) {
      Settings settings = law;
      settings.insert({{"ced", "1e3"}});
      const Row plain = at_rest(kPlain, ways, settings);
      EXPECT_EQ(plain.at("grown") > 0.0, law.count("hardness") == 1 && ways > 0);
      for (const Pair &pair : kPairs) {
        if (pair.inside)
          continue; // Hertz, whatever the surfaces' law
        const Row found = at_rest(pair, ways, settings);
        for (const auto &[what, value] : plain)
          if (value == 0.0 || std::isinf(value)) // no contact, and no bound of the step
            EXPECT_EQ(found.at(what), value) << pair.name << " " << what;
          else
            worst.near(pair.name, found.at(what), value, std::fabs(value));
      }
    }
  std::printf("each law, with the bound of the step: %.1e off\n", worst.of);
}

TEST(VerificationActingContact, NanoporesFollowThePressureOfTheActingContact) {
  const NanoporeCollapse law = {0.5, 0.27, 100.0, 5e3, 0.01};
  double worst = 0.0;
  for (const Pair &pair : kPairs) {
    const Settings settings = {
        {"ced", "0"}, {"law", "\"yield 100 hardening 5e3\""}, {"hold", "4000"}};
    EXPECT_EQ(at_rest(pair, -15, settings).at("phi"), law.initial) << pair.name;
    const double phi = at_rest(pair, 60, settings).at("phi"), hand = collapsed(pair, law, 0.06);
    EXPECT_LT(hand, 0.48) << pair.name;
    EXPECT_NEAR(phi, hand, 1e-6) << pair.name;
    worst = std::fmax(worst, std::fabs(phi - hand));
  }
  std::printf("nanoporosity after collapse: %.1e off\n", worst);
}
