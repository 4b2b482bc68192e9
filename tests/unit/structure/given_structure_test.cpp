// SPDX-License-Identifier: GPL-2.0-or-later
// Phases, heights and clusters of an existing structure; the [structure] table of a recipe.
#include "base/recipe.h"
#include "electrode/structure/existing_structure.h"
#include "support.h"

namespace {
using namespace calendem;
using namespace calendem_test;
namespace fs = std::filesystem;

StructureSource source(const std::string &file, const std::set<std::string> &am,
                       const std::set<std::string> &cbd) {
  StructureSource s;
  s.file = file;
  s.atom_style = "sphere";
  s.am_types = am;
  s.cbd_types = cbd;
  return s;
}
StructureSource clusters(const std::string &body_map = "") {
  StructureSource s = source(kData + "lammps_cluster.data", {"1", "2"}, {"3"});
  s.atom_style = "hybrid";
  s.clusters = true;
  s.body_map = body_map;
  return s;
}

TEST(ExistingStructure, PhasesFollowTheTypesAndHeightsTheLowestPoint) {
  const ExistingStructure g =
      read_structure(source(kData + "lammps_micro.data", {"1", "2"}, {"3"}));
  ASSERT_EQ(g.am.size(), 3u);
  ASSERT_EQ(g.cbd.size(), 3u);
  EXPECT_EQ(g.cbd[0].id, 4);
  EXPECT_EQ(g.lx, 12.0);
  // the lowest point is that of the CBD spheres at z = 1, the highest of the one at z = 8
  EXPECT_NEAR(g.cbd[0].x.z(), 0.658, 1e-12);
  EXPECT_NEAR(g.am[0].x.z(), 3.0 - 0.342, 1e-12);
  EXPECT_NEAR(g.extent, 8.658 - 0.342, 1e-12);
  EXPECT_EQ(g.thickness, g.extent);
}

TEST(ExistingStructure, AFileWithoutActiveMaterialIsRefused) {
  expect_parts(refusal([] {
                 read_structure(source(kData + "lammps_micro.data", {}, {"1", "2", "3"}));
               }),
               {"has no particle of active material", "structure.am_types"});
  StructureSource s = source((test_folder() / "a.csv").string(), {"1"}, {});
  std::ofstream(s.file) << "x y z r\n";
  s.densities_of_file = false;
  s.side_x = s.side_y = 12.0;
  expect_parts(refusal([&] { read_structure(s); }), {"has no particle of active material"});
}

TEST(ExistingStructure, TypesAreNamedByTheLabelsOfTheFile) {
  const std::string file = (test_folder() / "labels.data").string();
  std::ofstream(file) << "t\n\n3 atoms\n3 atom types\n\n0 9 xlo xhi\n0 9 ylo yhi\n0 6 zlo zhi\n\n"
                         "Atom Type Labels\n\n1 AM\n2 cb\n3 wall\n\nAtoms # sphere\n\n"
                         "1 AM 4 4.65 1 1 2\n2 cb 1 0.9 5 5 2\n3 wall 1 0.9 8 8 2\n";
  StructureSource s = source(file, {"AM"}, {"cb"});
  s.left_out_types = {"3"};
  const ExistingStructure g = read_structure(s);
  ASSERT_EQ(g.am.size(), 1u);
  ASSERT_EQ(g.cbd.size(), 1u);
  EXPECT_EQ(g.am[0].id, 1);
  EXPECT_EQ(g.cbd[0].id, 2);
  EXPECT_EQ(g.left_out, 1);
  s.am_types = {"1", "AN"};
  s.left_out_types = {"AM", "3"};
  expect_parts(refusal([&] { read_structure(s); }),
               {"structure.am_types names 'AN'; the file's Atom Type Labels are AM, cb, wall.",
                "structure.left_out_types: 'AM' is type 1, which is named before"});
  expect_parts(refusal([&] { read_structure(source(kData + "lammps_micro.data", {"AM"}, {"3"})); }),
               {"names 'AM'; the file's Atom Type Labels are none: give the type's number"});
}

TEST(ExistingStructure, AFilmThatIsPeriodicInHeightIsAsThickAsTheBox) {
  StructureSource s = source((test_folder() / "a.data").string(), {"1"}, {});
  std::ofstream(s.file) << "t\n2 atoms\n1 atom types\n0 9 xlo xhi\n0 9 ylo yhi\n0 6 zlo zhi\n"
                           "Atoms\n\n1 1 4 4.65 1 1 0\n2 1 4 4.65 5 5 7\n";
  s.z_periodic = true;
  const ExistingStructure g = read_structure(s);
  EXPECT_NEAR(g.am[1].x.z(), 3.0, 1e-12); // z = 7 is at 1, the lowest point at -2
  EXPECT_NEAR(g.extent, 5.0, 1e-12);
  EXPECT_NEAR(g.thickness, 5.0, 1e-12);
  std::ofstream(s.file) << "t\n2 atoms\n1 atom types\n0 9 xlo xhi\n0 9 ylo yhi\n0 6 zlo zhi\n"
                           "Atoms\n\n1 1 4 4.65 1 1 0\n2 1 4 4.65 5 5 5\n";
  EXPECT_NEAR(read_structure(s).extent, 9.0, 1e-12);
  EXPECT_NEAR(read_structure(s).thickness, 6.0, 1e-12);
}

TEST(ExistingStructure, EveryTypeHasItsPhase) {
  expect_parts(refusal([] {
                 read_structure(source(kData + "lammps_micro.data", {"1", "7"}, {"3"}));
               }),
               {"type 2 (particles: 1, first in line 16)", "left_out_types",
                "structure.am_types names type 7"});
  StructureSource s = source(kData + "lammps_micro.data", {"1"}, {"3"});
  s.left_out_types = {"2"};
  const ExistingStructure g = read_structure(s);
  EXPECT_EQ(g.am.size() + g.cbd.size(), 5u);
  EXPECT_EQ(g.left_out, 1);
}

TEST(ExistingStructure, ClustersComeFromMoleculesOrFromAMap) {
  const ExistingStructure g = read_structure(clusters());
  EXPECT_EQ(g.am.front().cluster, 11);
  EXPECT_EQ(g.am.back().cluster, 7);
  const std::string map = (test_folder() / "bodies.map").string();
  {
    std::ofstream out(map);
    out << "# id body, 36 rows\n";
    for (int id = 1; id <= 36; ++id)
      out << id << " " << (id <= 7 ? 1 : 2) << "\r\n";
  }
  const ExistingStructure m = read_structure(clusters(map));
  EXPECT_EQ(m.am.front().cluster, 1);
  EXPECT_EQ(m.am.back().cluster, 2);
  EXPECT_NE(hash_of_structure(clusters()), hash_of_structure(clusters(map)));
  StructureSource no_ids = source(kData + "lammps_micro.data", {"1", "2"}, {"3"});
  no_ids.clusters = true;
  expect_parts(refusal([&] { read_structure(no_ids); }), {"no molecule ids", "body_map"});
}

TEST(ExistingStructure, AMapOfAnotherFileIsRefused) {
  const std::string map = (test_folder() / "bodies.map").string();
  const auto said_of = [&](const std::string &text) {
    std::ofstream(map) << text;
    return refusal([&] { read_structure(clusters(map)); });
  };
  expect_parts(said_of("1 1\n2 1\n37 1\n99 2\n"),
               {"bodies.map: particle 3 of the active material is not in the map",
                "2 rows name particles that are not active material", "first 37"});
  expect_parts(said_of("1 1\n1 2\n2\n3 x\n"),
               {"bodies.map:2: particle 1 occurs twice", "bodies.map:3: '2' is not a row 'id body'",
                "bodies.map:4:"});
  expect_parts(said_of(""), {"holds no rows"});
}

Recipe recipe_of(const std::string &lines) {
  const fs::path folder = test_folder();
  std::ofstream(folder / "a.data") << "x";
  std::ofstream(folder / "recipe.toml") << lines;
  return read_recipe((folder / "recipe.toml").string());
}

TEST(StructureTable, SaysWhereAndHowToRead) {
  const StructureSource s =
      recipe_of("[structure]\nfile = \"a.data\"\natom_style = \"granular\"\nunits = \"si\"\n"
                "boundary = \"p p p\"\nam_types = \"2 3, 4\"\ncbd_types = \"1\"\n"
                "densities = \"recipe\"\n")
          .structure;
  EXPECT_TRUE(s.given());
  EXPECT_EQ(fs::path(s.file).filename(), "a.data");
  EXPECT_EQ(s.am_types, (std::set<std::string>{"2", "3", "4"}));
  EXPECT_EQ(s.cbd_types, (std::set<std::string>{"1"}));
  EXPECT_EQ(s.length_um, 1e6);
  EXPECT_EQ(s.density_g_cm3, 1e-3);
  EXPECT_TRUE(s.z_periodic);
  EXPECT_FALSE(s.densities_of_file);
  EXPECT_FALSE(recipe_of("seed = 2\n").structure.given());
}

TEST(StructureTable, UnitsOfLennardJonesNeedTheirScale) {
  const std::string table =
      "[structure]\nfile = \"a.data\"\nunits = \"lj\"\nam_types = \"1\"\ncbd_types = \"none\"\n";
  expect_parts(refusal([&] { recipe_of(table); }), {"recipe.toml:3:", "structure.lj_length_um"});
  const StructureSource s =
      recipe_of(table + "lj_length_um = 2.5\nlj_density_g_cm3 = 4.65\n").structure;
  EXPECT_EQ(s.length_um, 2.5);
  EXPECT_EQ(s.density_g_cm3, 4.65);
}

TEST(StructureTable, EveryMistakeIsNamedAtOnce) {
  expect_parts(
      refusal([] {
        recipe_of("[structure]\nfile = \"b.data\"\natom_style = \"spere\"\nam_types = \"1 -x\"\n"
                  "cbd_types = \"2\"\nleft_out_types = \"2 3\"\nbody_map = \"m\"\n"
                  "lj_length_um = 1\n[particles]\nmedian_um = 5\n");
      }),
      {":2: structure.file", "b.data' is not there", ":3: structure.atom_style is \"spere\"",
       "The closest is \"sphere\"", ":4: structure.am_types is \"1 -x\"",
       ":6: structure.left_out_types: type 2 is in another list", ":7: structure.body_map",
       "structure.units is missing", "lj_length_um", ":10: particles.median_um has no effect"});
  expect_parts(refusal([] { recipe_of("[structure]\nfile = \"a.data\"\nunits = \"micro\"\n"); }),
               {"structure.am_types is missing", "structure.cbd_types is missing"});
  expect_parts(refusal([] { recipe_of("[structure]\nunits = \"si\"\n"); }),
               {":2: [structure] needs structure.file"});
}

} // namespace
