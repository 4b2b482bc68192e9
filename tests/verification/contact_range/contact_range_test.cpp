// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, set-up and tolerances: README.md of this folder.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "physics/contact_range.h"
#include "physics/hertz_contact.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E[] = {2e8, 2e6}, nu[] = {0.3, 0.49}, R[] = {0.795, 0.5};

struct Placed {
  int type; ///< 1 or 2
  Vec3 x;
  int body;
};

// Pairs: 1-1 across the border of two ranks, 1-2 across the periodic face, 2-2, bonded pressed
// together, bonded pulled apart; and one sphere at the wall in z = -9.9.
const std::vector<Placed> kSpheres = {
    {1, {-0.7, -7, 0}, 0},  {1, {0.7, -7, 0}, 0},  // overlap 0.19
    {1, {-9.8, -3, 0}, 0},  {2, {9.2, -3, 0}, 0},  // 0.295
    {2, {4, 1, 0}, 0},      {2, {4.96, 1, 0}, 0},  // 0.04
    {1, {-4, 1, 0}, 1},     {1, {-2.72, 1, 0}, 1}, // 0.31 at creation, then 0.1 more
    {1, {-0.64, 5, 0}, 2},  {1, {0.64, 5, 0}, 2},  // 0.31 at creation, then 0.02 less
    {2, {5, 5, -9.475}, 0},                        // 0.075
};

Files files() {
  std::ostringstream data, map;
  data << "known overlaps\n\n"
       << kSpheres.size() << " atoms\n2 atom types\n"
       << "-10 10 xlo xhi\n-10 10 ylo yhi\n-10 10 zlo zhi\n\nAtoms\n\n";
  for (size_t n = 0; n < kSpheres.size(); ++n) {
    const Placed &s = kSpheres[n];
    data << n + 1 << " " << s.type << " " << 2.0 * R[s.type - 1] << " " << kDensity << " " << s.x.x
         << " " << s.x.y << " " << s.x.z << "\n";
    map << n + 1 << " " << (s.body > 0 ? s.body : 100 + int(n)) << "\n";
  }
  return {{"atoms.data", data.str()},
          {"bodies.map", map.str()},
          {"start.in", "group in id 8\ndisplace_atoms in move -0.1 0 0 units box\n"
                       "group out id 10\ndisplace_atoms out move 0.02 0 0 units box\n"}};
}

double hertz(int i, int j, double overlap) { // j 0: a wall of type 1
  const int other = j > 0 ? j - 1 : 0;
  return hertz_force(effective_modulus(E[i - 1], nu[i - 1], E[other], nu[other]),
                     j > 0 ? effective_radius(R[i - 1], R[j - 1]) : R[i - 1], overlap);
}

/// By hand: file of the row -> what must stand in it.
std::map<std::string, ContactRange> expected() {
  std::map<std::string, ContactRange> rows;
  const auto add = [&](const char *row, int i, int j, double overlap) {
    const double smaller = j > 0 ? std::min(R[i - 1], R[j - 1]) : R[i - 1];
    for (const char *of : {row, "all"})
      rows[of].add(overlap, smaller, hertz(i, j, overlap));
  };
  add("11", 1, 1, 0.19);                           // 0.239 R
  rows["inside"].add(0.1, R[0], hertz(1, 1, 0.1)); // 0.126 R: beyond the reference
  add("12", 1, 2, 0.295);                          // 0.59 R
  add("22", 2, 2, 0.04);                           // 0.08 R
  add("wall", 2, 0, 0.075);
  return rows;
}

void expect_by_hand(const CaseRun &run) {
  ASSERT_TRUE(run.finished()) << run.why();
  double worst = 0.0;
  for (const auto &entry : expected()) {
    const std::string &file = entry.first;
    const ContactRange &r = entry.second;
    const Row row = run.rows(file + ".csv").back();
    EXPECT_EQ(row.at("contacts"), r.of[ContactRange::kContacts]) << file;
    const auto near = [&](const char *what, double by_hand) {
      if (by_hand == 0.0)
        EXPECT_EQ(row.at(what), 0.0) << what << " in " << file;
      else
        worst = std::fmax(worst, std::fabs(row.at(what) / by_hand - 1.0));
    };
    near("force", r.of[ContactRange::kForce]);
    near("mean", r.mean());
    near("largest", r.largest);
    for (int k = 0; k < kRangeLimits; ++k) {
      const std::string n = std::to_string(k + 1);
      EXPECT_EQ(row.at("n" + n), r.of[ContactRange::kBeyond + k]) << file;
      near(("f" + n).c_str(), r.of[ContactRange::kForceBeyond + k]);
    }
  }
  std::printf("overlaps and forces by hand: %.1e\n", worst);
  EXPECT_LT(worst, 1e-12);
}

} // namespace

TEST(VerificationContactRange, KnownOverlaps) {
  const CaseRun run("contact_range/in.range", {}, 1, files());
  expect_by_hand(run);
  // and the host's own forces: of each pair twice, of the wall once
  double pairs = 0.0, wall = 0.0;
  const std::vector<Row> spheres = run.frames().back();
  for (size_t n = 0; n < kSpheres.size(); ++n)
    if (kSpheres[n].body == 0)
      (n == kSpheres.size() - 1 ? wall : pairs) +=
          std::hypot(spheres[n].at("fx"), spheres[n].at("fy"), spheres[n].at("fz"));
  const double counted = run.rows("all.csv").back().at("force");
  EXPECT_NEAR(counted / (0.5 * pairs + wall), 1.0, 1e-12);
}

TEST(VerificationContactRange, EachPairOnceOnTwoRanks) {
  expect_by_hand(CaseRun("contact_range/in.range", {{"gx", "2"}}, 2, files()));
}
