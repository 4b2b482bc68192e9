// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "physics/plastic_contact.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double kSpacing = 1.28, R = 0.795, kSpeed = 0.5, kStep = 8e-5, kLoad = 1000.0;
constexpr int kSpheres = 4; // of a row
const double kLattice = kSpacing / (2.0 * R);

Settings settings(double meet) {
  return {{"meet", number(meet)}, {"dt", number(kStep)}, {"friction", "0"}, {"ced", "0"}};
}

// The upper row, of that body, at that height; of no body a single sphere, or they would push each
// other away.
Files two_rows(int body = 1, double height = kSpacing) {
  std::vector<BodySphere> rows;
  for (const bool upper : {false, true})
    for (int n = 0; n < (upper && body == 0 ? 1 : kSpheres); ++n)
      rows.push_back({{(n + 0.25) * kSpacing, 0, upper ? height : 0.0}, R, upper ? body : 1});
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

// Height of a row that has slid by `way`, over the spheres of the other; the one below it at first
// was bonded.
double height(double way, double first, double later) {
  double highest = 0.0;
  for (int n = -1; n <= 4; ++n)
    highest = std::max(highest, resting(n == 0 ? first : later, way - n * kSpacing));
  return highest;
}

// Distance of `way` from the cusps, where the row passes from one sphere to the next.
double from_cusp(double way, double first, double later) {
  const double from_first_on =
      (kSpacing * kSpacing + first * first - later * later) / (2 * kSpacing);
  double nearest = std::fabs(way - from_first_on);
  for (const double cusp : {1.5, 2.5})
    nearest = std::min(nearest, std::fabs(way - cusp * kSpacing));
  return nearest;
}

struct Slip {
  double worst = 0.0;  ///< largest difference of height from the closed form, away from cusps [um]
  double mean = 0.0;   ///< height over the second spacing [um]
  double at_one = 0.0; ///< height after one spacing [um]
};

Slip slip(double first, double later, const std::vector<Row> &rows) {
  Slip s;
  int counted = 0;
  for (const Row &row : rows) {
    const double way = row.at("step") * kStep * kSpeed, found = row.at("height");
    if (way >= 0.02 && from_cusp(way, first, later) > 0.02)
      s.worst = std::fmax(s.worst, std::fabs(found - height(way, first, later)));
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

void expect_closed_form(const CaseRun &run, double first, double later) {
  ASSERT_TRUE(run.finished()) << run.why();
  const std::vector<Row> rows = run.rows("curve.csv");
  ASSERT_EQ(rows.size(), 160u);
  const Slip s = slip(first, later, rows);
  std::printf(
      "meeting at %.2f um: height %.1e um off; after one spacing %.4f, mean over the second "
      "%.4f um above the lattice\n",
      later, s.worst, s.at_one - kSpacing, s.mean - kSpacing);
  EXPECT_LT(s.worst, 1e-5);
  EXPECT_NEAR(s.mean, rigid_mean(later), 2e-3);
}

} // namespace

TEST(VerificationSlip, RowsMeetAtTheSumOfRadii) {
  const CaseRun run("slip/in.slip", settings(1.0), 1, two_rows());
  expect_closed_form(run, kSpacing, 2.0 * R);
}

TEST(VerificationSlip, RowsMeetAtTheLattice) {
  const CaseRun run("slip/in.slip", settings(kLattice), 1, two_rows());
  expect_closed_form(run, kSpacing, kSpacing);
}

TEST(VerificationSlip, RowsOfTwoBodiesMeetAtTheSumOfRadii) {
  const CaseRun run("slip/in.slip", settings(kLattice), 1, two_rows(2, 2.0 * R));
  expect_closed_form(run, 2.0 * R, 2.0 * R);
}

// Others are of another body, or of none, as CBD; the body's own meet as before.
TEST(VerificationSlip, SurfacesLieInsideThePrimariesForOthers) {
  constexpr double kInset = 0.12;
  Settings s = settings(kLattice);
  s["inset"] = number(kInset);
  for (const auto &[body, distance] :
       {std::pair{2, 2.0 * R - 2.0 * kInset}, std::pair{0, 2.0 * R - kInset}}) {
    SCOPED_TRACE(body);
    const CaseRun run("slip/in.slip", s, 1, two_rows(body, distance));
    expect_closed_form(run, distance, distance);
  }
  const CaseRun own("slip/in.slip", s, 1, two_rows());
  expect_closed_form(own, kSpacing, kSpacing);
}

// A yielded contact opens while the primaries still overlap, and closes again.
TEST(VerificationSlip, ContactsOfInsetSurfacesAreTheSameInEitherLoop) {
  constexpr double kInset = 0.15;
  const double distance = 2.0 * (R - kInset), way = 22000 * kStep * kSpeed;
  ASSERT_LT(std::hypot(way, distance), 2.0 * R) << "they would part altogether";
  std::vector<double> ends;
  for (const char *fused : {"on", "off"}) {
    Settings s = settings(1.0);
    s["inset"] = number(kInset);
    s["contact"] = "hertz_effects";
    s["yield"] = "1e6";
    s["fused"] = fused;
    s["half"] = s["rest"] = "22000";
    s["back"] = "1";
    const CaseRun run("slip/in.slip", s, 1, two_rows(2, distance));
    ASSERT_TRUE(run.finished()) << run.why();
    ends.push_back(run.rows("curve.csv").back().at("height"));
  }
  EXPECT_NEAR(ends[0], ends[1], 1e-9);
  EXPECT_LT(ends[0], distance - 1e-4) << "nothing yields";
}

// The primaries overlap throughout. Pressed to 0.05 um, their surfaces are parted by 0.025 and
// pressed to 0.025 um: as new ones, not as ones that keep a dent of nearly 0.05.
TEST(VerificationSlip, InsetSurfacesThatPartedMeetAsNewOnes) {
  constexpr double kInset = 0.15, kYield = 1e6;
  const double distance = 2.0 * (R - kInset);
  const PlasticContact law(effective_modulus(2e8, 0.3, 2e8, 0.3), effective_radius(R, R), kYield);
  for (const char *fused : {"on", "off"}) {
    Settings s = settings(1.0);
    s["inset"] = number(kInset);
    s["contact"] = "hertz_effects";
    s["yield"] = number(kYield);
    s["fused"] = fused;
    s["dt"] = "5e-5";
    s["restitution"] = "1";
    const CaseRun run(
        "slip/in.part", s, 1,
        files_of({{{0, 0, 0}, R, 1}, {{0, 0, distance}, R, 2}}, {-5, -5, -5}, {5, 5, 5}));
    ASSERT_TRUE(run.finished()) << run.why();
    const std::vector<Row> rows = run.rows("curve.csv");
    const auto expect_force = [&](long step, double overlap) {
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row &r) {
        return std::lround(r.at("step")) == step;
      });
      ASSERT_NE(row, rows.end()) << step;
      EXPECT_NEAR(distance - row->at("height"), overlap, 1e-9);
      const double force = overlap > 0.0 ? law.loading_force(overlap) : 0.0;
      EXPECT_NEAR(row->at("force"), force, 1e-6 * force) << step;
    };
    expect_force(1000, 0.05);
    expect_force(2500, -0.025);
    expect_force(3500, 0.025);
  }
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

// Spheres that have come apart, but are still in each other's reach, meet as new ones do.
TEST(VerificationSlip, PartedSpheresMeetAsNewOnes) {
  for (const auto &[meet, way] : {std::pair{1.0, 0.75}, std::pair{kLattice, 1.1}}) {
    Settings s = settings(meet);
    s["half"] = s["rest"] = std::to_string(std::lround(way / (kSpeed * kStep)));
    s["back"] = "1";
    const CaseRun run("slip/in.slip", s, 1, two_rows());
    ASSERT_TRUE(run.finished()) << run.why();
    const double distance = std::hypot(way, height(way, kSpacing, 2.0 * R * meet));
    EXPECT_GT(distance, 2.0 * R);
    EXPECT_LT(distance, 1.1 * 2.0 * R) << "their history would be lost";
    const Row end = run.rows("curve.csv").back();
    const double left = 2.0 * way - end.at("step") * kStep * kSpeed;
    EXPECT_NEAR(end.at("height"), resting(2.0 * R * meet, left), 1e-5) << meet;
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

// The inset of a primary with that many bonds; six are a whole one's.
double faded(double inset, double fading, int bonds) {
  return inset * (1.0 - fading * (1.0 - bonds / 6.0));
}

// A body of three primaries in a row around `middle`, and one of another body above the one in the
// middle: kGap above where their surfaces meet, and nearer than without the inset of bonds that are yet to be made.
constexpr double kGap = 0.01; // um
Files row_and_one(double middle, double inset, double fading) {
  std::vector<BodySphere> all;
  for (const double x : {0.0, kSpacing, -kSpacing})
    all.push_back({{middle + x, 0, 0}, R, 1});
  const double meeting = 2.0 * R - faded(inset, fading, 2) - faded(inset, fading, 0);
  all.push_back({{middle, 0, meeting + kGap}, R, 2});
  return files_of(all, {-6, -6, -6}, {6, 6, 6});
}

// The primary in the middle loses one of its two bonds; the other one has none. What has come in
// contact before keeps its overlap; on the way up the surface follows as far as it may.
TEST(VerificationSlip, AnInsetFadesWithTheBonds) {
  constexpr double inset = 0.1;
  const double E = effective_modulus(2e8, 0.3, 2e8, 0.3), R_eff = effective_radius(R, R);
  for (const double fading : {0.0, 0.5, 1.0})
    for (const char *fused : {"on", "off"}) {
      Settings s = settings(1.0);
      s.insert({{"inset", number(inset)}, {"fading", number(fading)}, {"fused", fused}});
      s["dt"] = "1e-4";
      s["restitution"] = "1";
      const CaseRun run("slip/in.fade", s, 1, row_and_one(0.0, inset, fading));
      ASSERT_TRUE(run.finished()) << run.why();
      const double upper = faded(inset, fading, 0),
                   later = 2.0 * R - upper - faded(inset, fading, 1);
      double meeting = 2.0 * R - upper - faded(inset, fading, 2), last = 0.0;
      for (const Row &row : run.rows("curve.csv")) {
        const double r = row.at("height");
        ASSERT_EQ(row.at("intact"), row.at("step") > 1000 ? 1 : 2) << row.at("step");
        if (row.at("step") > 1000)
          meeting = std::fmax(meeting, std::fmin(later, r));
        last = hertz_force(E, R_eff, meeting - r);
        EXPECT_NEAR(row.at("force"), last, 1e-9 * hertz_force(E, R_eff, 0.1)) << row.at("step");
      }
      EXPECT_EQ(meeting, later);
      EXPECT_NEAR(last, hertz_force(E, R_eff, 0.1 - kGap + fading * inset / 6.0), 1e-6 * last);
    }
}

TEST(VerificationSlip, AFadedInsetIsTheSameOnTwoRanksAndAfterARestart) {
  Settings s = settings(1.0);
  s.insert({{"inset", "0.1"}, {"fading", "1"}});
  s["dt"] = "1e-4";
  for (const double middle : {-0.6, 0.6}) { // the border cuts the broken bond, or the intact one
    Files files = row_and_one(middle, 0.1, 1.0);
    s["from"] = "0";
    s["px"] = "1";
    const CaseRun one("slip/in.fade", s, 1, files);
    ASSERT_TRUE(one.finished()) << one.why();
    s["px"] = "2";
    const CaseRun two("slip/in.fade", s, 2, files);
    EXPECT_EQ(two.text("curve.csv"), one.text("curve.csv")) << two.why();
    s["from"] = "1";
    files["half.restart"] = one.text("half.restart");
    files["breaks.csv"] = one.text("breaks.csv");
    const CaseRun later("slip/in.fade", s, 2, files);
    ASSERT_TRUE(later.finished()) << later.why();
    EXPECT_EQ(later.rows("curve.csv").back(), one.rows("curve.csv").back());
  }
}

// The surface of the first lists, which hold until spheres have moved, is that of the bonds which the set-up makes later.
TEST(VerificationSlip, AnInsetCountsBondsThatAreYetToBeMade) {
  Settings s = settings(1.0);
  s.insert({{"inset", "0.1"}, {"fading", "1"}, {"check", "yes"}});
  s["dt"] = "1e-4";
  const CaseRun run("slip/in.fade", s, 1, row_and_one(0.0, 0.1, 1.0));
  ASSERT_TRUE(run.finished()) << run.why();
  EXPECT_EQ(run.rows("curve.csv").front().at("force"), 0.0); // of step 10, when 0.009 um are left
}

TEST(VerificationSlip, ARestartWithAnotherDiameterStops) {
  Settings s = settings(kLattice);
  s["half"] = s["rest"] = "100";
  const CaseRun one("slip/in.slip", s, 1, two_rows());
  ASSERT_TRUE(one.finished()) << one.why();
  Files files = two_rows();
  files["half.restart"] = one.text("half.restart");
  s["from"] = "1";
  EXPECT_TRUE(CaseRun("slip/in.slip", s, 1, files).finished());
  s["meet"] = "1";
  const CaseRun other("slip/in.slip", s, 1, files);
  EXPECT_FALSE(other.finished());
  EXPECT_NE(other.why().find("contact_diameter is 1, and the run that goes on from this restart "
                             "file began with 0.805031"),
            std::string::npos)
      << other.why();
  s["meet"] = number(kLattice);
  s["inset"] = "0.1";
  EXPECT_NE(CaseRun("slip/in.slip", s, 1, files).why().find("surface_inset is 0.1, and"),
            std::string::npos);
}

TEST(VerificationSlip, AFadingStaysAsItWasAndIsAFraction) {
  Settings s = settings(1.0);
  s.insert({{"inset", "0.1"}, {"fading", "1"}});
  s["dt"] = "1e-4";
  Files files = row_and_one(0.0, 0.1, 1.0);
  const CaseRun one("slip/in.fade", s, 1, files);
  files["half.restart"] = one.text("half.restart");
  s["from"] = "1";
  s["fading"] = "0.5";
  EXPECT_NE(CaseRun("slip/in.fade", s, 1, files).why().find("inset_fading is 0.5, and"),
            std::string::npos);
  s["fading"] = "1.5";
  EXPECT_NE(CaseRun("slip/in.fade", s, 1, files).why().find("'inset_fading' is '1.5'; it must be"),
            std::string::npos);
}

TEST(VerificationSlip, AnInsetOfHalfARadiusStops) {
  Settings s = settings(1.0);
  s["inset"] = "0.4";
  const CaseRun run("slip/in.slip", s, 1, two_rows());
  EXPECT_FALSE(run.finished());
  EXPECT_NE(run.why().find("'surface_inset' is more than half of the smallest radius"),
            std::string::npos)
      << run.why();
}
