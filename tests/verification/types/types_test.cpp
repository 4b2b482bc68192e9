// SPDX-License-Identifier: GPL-2.0-or-later
// Requirements: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

// Properties of that many types, all the same material but for the last one's modulus.
std::string materials(int types, const std::string &last_modulus) {
  std::ostringstream text;
  const auto give = [&](const char *id, const char *name, const char *value, bool of_pairs) {
    text << "fix " << id << " all property/global " << name
         << (of_pairs ? " peratomtypepair " + std::to_string(types) : " peratomtype");
    for (int n = 0; n < (of_pairs ? types * types : types); ++n)
      text << " " << value;
    text << "\n";
  };
  text << "fix youngs all property/global youngsModulus peratomtype";
  for (int n = 1; n < types; ++n)
    text << " ${Ey}";
  text << " " << last_modulus << "\n";
  give("poisson", "poissonsRatio", "${nu}", false);
  give("restit", "coefficientRestitution", "${restitution}", true);
  give("frict", "coefficientFriction", "${friction}", true);
  give("cohesion", "cohesionEnergyDensity", "${ced}", true);
  return text.str();
}

// A bonded pair that falls onto a wall, and a sphere that meets it.
CaseRun fall(int types, const Settings &settings, const std::string &more = "",
             const std::string &last_modulus = "${Ey}") {
  Files files = files_of({{{3.0, 3.0, 0.9}, 0.795, 1, {0.3, 0.0, -2.0}},
                          {{4.3, 3.0, 0.9}, 0.795, 1, {0.3, 0.0, -2.0}},
                          {{5.92, 3.2, 0.9}, 0.795, 0, {-1.0, 0.0, -2.0}}},
                         {0, 0, 0}, {8, 8, 8});
  std::string &data = files["atoms.data"];
  data.replace(data.find("1 atom types"), 1, std::to_string(types));
  files["materials.in"] = materials(types, last_modulus);
  files["more.in"] = more + "\n";
  return CaseRun("types/in.types", settings, 1, files);
}

std::string outcome(const CaseRun &run) {
  EXPECT_TRUE(run.finished()) << run.why();
  EXPECT_EQ(run.rows("check.csv").size(), 5u);
  return run.text("check.csv") + run.text("spheres.dump");
}

} // namespace

TEST(VerificationTypes, TypesThatNobodyUsesChangeNothing) {
  for (const char *contact : {"hertz", "hertz_effects"})
    for (const char *fused : {"on", "off"}) {
      const Settings settings = {{"contact", contact}, {"fused", fused}};
      const std::string alone = outcome(fall(1, settings));
      EXPECT_EQ(outcome(fall(2, settings)), alone) << contact << ", fused " << fused;
      EXPECT_EQ(outcome(fall(5, settings)), alone) << contact << ", fused " << fused;
    }
}

TEST(VerificationTypes, AWallMayHaveATypeOfItsOwn) {
  for (const char *fused : {"on", "off"})
    EXPECT_EQ(outcome(fall(4, {{"fused", fused}, {"wall", "2"}})),
              outcome(fall(1, {{"fused", fused}})));
}

TEST(VerificationTypes, NanoporesOfATypeThatNobodyUses) {
  outcome(fall(3, {{"cbd", "3"}}));
  outcome(fall(3, {{"cbd", "3"}, {"wall", "2"}}));
}

TEST(VerificationTypes, ATypeThatComesLaterIsKnownAtTheNextSetUp) {
  const std::string change = "set atom 3 type 2\nrun 100";
  for (const char *fused : {"on", "off"}) {
    const CaseRun known = fall(2, {{"fused", fused}}, change);
    EXPECT_TRUE(known.finished()) << known.why();
    const CaseRun unknown = fall(2, {{"fused", fused}}, change + " pre no");
    EXPECT_FALSE(unknown.finished());
    EXPECT_NE(unknown.why().find("particle 3 is of atom type 2, and this run was set up for types "
                                 "1 to 1"),
              std::string::npos)
        << unknown.why();
  }
}

// The wall's type is known, and of another material. Both loops: rounding of sums.
TEST(VerificationTypes, ATypeMayChangeBetweenRunsThatAreNotSetUp) {
  const std::string modulus = "1e7", go_on = "run 100 pre no";
  std::vector<std::vector<Row>> ends;
  for (const char *fused : {"on", "off"})
    for (const std::string change : {"", "set atom 3 type 2\n"}) {
      const CaseRun run = fall(2, {{"fused", fused}, {"wall", "2"}}, change + go_on, modulus);
      ASSERT_TRUE(run.finished()) << run.why();
      ends.push_back(run.frames().back());
    }
  for (size_t sphere = 0; sphere < 3; ++sphere)
    for (const auto &[column, value] : ends[3][sphere])
      EXPECT_NEAR(ends[1][sphere].at(column), value, 1e-9) << sphere << " " << column;
  EXPECT_GT(std::fabs(ends[1][1].at("vx") - ends[0][1].at("vx")),
            1e-3); // of the pair that it meets
}

TEST(VerificationTypes, ATypeThatIsInsertedIsKnown) {
  const std::string insert =
      "fix seed all particletemplate/sphere 15485863 atom_type 2 density constant 4.65 radius "
      "constant 0.7\nfix mix all particledistribution/discrete 15485867 1 seed 1.0\n"
      "region up block 1 7 1 7 4 7 units box\n"
      "fix ins all insert/pack seed 32452843 distributiontemplate mix vel constant 0 0 -2 "
      "insert_every once overlapcheck yes all_in yes particles_in_region 5 region up\nrun 500";
  for (const char *fused : {"on", "off"}) {
    const CaseRun run = fall(3, {{"fused", fused}}, insert);
    EXPECT_TRUE(run.finished()) << run.why();
    EXPECT_EQ(run.frames().back().size(), 8u);
  }
}
