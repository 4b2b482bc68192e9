// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double kSpacing = 1.28, R = 0.795, kSpeed = 0.5, kStep = 8e-5, kLoad = 1000.0;
constexpr int kSpheres = 4; // of a row
const double kLattice = kSpacing / (2.0 * R);

Settings settings(double meet) {
  return {{"meet", number(meet)}, {"dt", number(kStep)}, {"friction", "0"}, {"ced", "0"}};
}

Files two_rows() {
  std::vector<BodySphere> rows;
  for (const double z : {0.0, kSpacing})
    for (int n = 0; n < kSpheres; ++n)
      rows.push_back({{(n + 0.25) * kSpacing, 0, z}, R, 1});
  return files_of(rows, {0, -5, -5}, {kSpheres * kSpacing, 5, 5});
}

// Height of a sphere that rests, `aside` from its top, on one that it meets at `distance`: the load
// is the vertical part of Hertz' force. 0: it does not reach.
double resting(double distance, double aside) {
  const double E = effective_modulus(2e8, 0.3, 2e8, 0.3), R_eff = effective_radius(R, R);
  double overlap = 0.0, height = 0.0;
  for (int n = 0; n < 50; ++n) { // a contraction: the height hardly depends on the overlap
    const double r = distance - overlap, square = r * r - aside * aside;
    if (square <= 0.0)
      return 0.0;
    height = std::sqrt(square);
    overlap = hertz_overlap(E, R_eff, kLoad * r / height);
  }
  return height;
}

// Of a row that has slid by `way`, over the spheres of the other; the one below it at first was
// bonded.
double height(double way, double first, double later) {
  double highest = 0.0;
  for (int n = -1; n <= 4; ++n)
    highest = std::max(highest, resting(n == 0 ? first : later, way - n * kSpacing));
  return highest;
}

// Distance of `way` from the cusps, where the row passes from one sphere to the next.
double from_cusp(double way, double later) {
  // on the first spacing the next sphere, met at `later`, bears from there on
  const double first = (kSpacing * kSpacing + kSpacing * kSpacing - later * later) / (2 * kSpacing);
  double nearest = std::fabs(way - first);
  for (const double cusp : {1.5, 2.5})
    nearest = std::min(nearest, std::fabs(way - cusp * kSpacing));
  return nearest;
}

struct Slip {
  double worst = 0.0;  ///< largest difference of height from the closed form, away from cusps [um]
  double mean = 0.0;   ///< height over the second spacing [um]
  double at_one = 0.0; ///< height after one spacing [um]
};

Slip slip(double meet, const std::vector<Row> &rows) {
  Slip s;
  int counted = 0;
  for (const Row &row : rows) {
    const double way = row.at("step") * kStep * kSpeed, found = row.at("height");
    if (way >= 0.02 && from_cusp(way, 2.0 * R * meet) > 0.02)
      s.worst = std::fmax(s.worst, std::fabs(found - height(way, kSpacing, 2.0 * R * meet)));
    if (way > kSpacing && ++counted)
      s.mean += found;
    if (std::fabs(way - kSpacing) < 1e-9)
      s.at_one = found;
  }
  s.mean /= counted;
  return s;
}

// Mean over a spacing of rigid spheres that meet at `distance`.
double rigid_mean(double distance) {
  const double half = 0.5 * kSpacing, h = std::sqrt(distance * distance - half * half);
  return 0.5 * (h + distance * distance / half * std::asin(half / distance));
}

void expect_closed_form(double meet, const CaseRun &run) {
  ASSERT_TRUE(run.finished()) << run.why();
  const std::vector<Row> rows = run.rows("curve.csv");
  ASSERT_EQ(rows.size(), 160u);
  EXPECT_EQ(rows[1].at("intact"), kSpheres) << "but those of the row that is held";
  const Slip s = slip(meet, rows);
  std::printf(
      "contact_diameter %.3f: height %.1e um off; after one spacing %.4f, mean over the second "
      "%.4f um above the lattice\n",
      meet, s.worst, s.at_one - kSpacing, s.mean - kSpacing);
  EXPECT_LT(s.worst, 1e-5);
  EXPECT_NEAR(s.mean, rigid_mean(2.0 * R * meet), 2e-3);
}

} // namespace

TEST(VerificationSlip, RowsMeetAtTheSumOfRadii) {
  expect_closed_form(1.0, CaseRun("slip/in.slip", settings(1.0), 1, two_rows()));
}

TEST(VerificationSlip, RowsMeetAtTheLattice) {
  expect_closed_form(kLattice, CaseRun("slip/in.slip", settings(kLattice), 1, two_rows()));
}

// Contacts that meet at the lattice follow their law, in the plugin's loop over pairs as in the
// host's.
TEST(VerificationSlip, TheHostsLoopGivesTheSame) {
  std::set<double> ends;
  for (const char *law : {"none", "yield", "relaxed"}) {
    Settings s = settings(kLattice);
    s["rest"] = "8000";
    s["contact"] = law == std::string("none") ? "hertz" : "hertz_effects";
    s[law] = law == std::string("yield") ? "1e6" : "0.4";
    s["fused"] = "on";
    const CaseRun one("slip/in.slip", s, 1, two_rows());
    s["fused"] = "off";
    const CaseRun host("slip/in.slip", s, 1, two_rows());
    ASSERT_TRUE(one.finished() && host.finished()) << one.why() << host.why();
    const double end = one.rows("curve.csv").back().at("height");
    EXPECT_NEAR(end, host.rows("curve.csv").back().at("height"), 1e-9) << law;
    EXPECT_TRUE(ends.insert(std::round(1e6 * end)).second) << law << " does not act";
  }
}

// Spheres that have come apart, but not out of each other's reach, meet as new ones do.
TEST(VerificationSlip, PartedSpheresMeetAsNewOnes) {
  for (const double meet : {1.0, kLattice}) {
    Settings s = settings(meet);
    s.insert({{"half", "27500"}, {"rest", "27500"}, {"back", "1"}}); // to 1.1 um
    const CaseRun run("slip/in.slip", s, 1, two_rows());
    ASSERT_TRUE(run.finished()) << run.why();
    std::istringstream last(run.text("final.txt").substr(run.text("final.txt").find("\n8 ")));
    double id = 0, x = 0, y = 0, z = 0;
    last >> id >> x >> y >> z;
    EXPECT_NEAR(z, resting(2.0 * R * meet, 0.0), 1e-5) << meet;
  }
}

TEST(VerificationSlip, SameBitsOnTwoRanksAndAfterARestart) {
  Settings s = settings(kLattice);
  const CaseRun one("slip/in.slip", s, 1, two_rows());
  ASSERT_TRUE(one.finished()) << one.why();
  const std::string state = one.text("final.txt");
  s["px"] = "2";
  const CaseRun two("slip/in.slip", s, 2, two_rows());
  EXPECT_EQ(two.text("final.txt"), state) << two.why();
  EXPECT_EQ(two.text("curve.csv"), one.text("curve.csv"));
  s["from"] = "1";
  Files files = two_rows();
  files["half.restart"] = one.text("half.restart");
  files["breaks.csv"] = one.text("breaks.csv");
  s["px"] = "1";
  EXPECT_EQ(CaseRun("slip/in.slip", s, 1, files).text("final.txt"), state);
  s["px"] = "2";
  EXPECT_EQ(CaseRun("slip/in.slip", s, 2, files).text("final.txt"), state);
}
