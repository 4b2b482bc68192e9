// SPDX-License-Identifier: GPL-2.0-or-later
// Data files written by LAMMPS and by LIGGGHTS themselves, and what is wrong with spoilt ones.
#include "electrode/structure/particle_data.h"
#include "support.h"
#include <algorithm>
#include <map>
#include <zlib.h>

namespace {
using namespace calendem;
using namespace calendem_test;

ParticleData read_file(const std::string &file, const DataFormat &format = {}) {
  Mistakes mistakes(file, 10);
  ParticleData data = read_particle_data(file, format, mistakes);
  mistakes.stop_if_any();
  std::sort(data.particles.begin(), data.particles.end(),
            [](const auto &a, const auto &b) { return a.id < b.id; });
  return data;
}

std::string file_of(const std::string &text) {
  const std::string file = (test_folder() / "a.data").string();
  std::ofstream(file, std::ios::binary) << text;
  return file;
}
ParticleData read_text(const std::string &text, const DataFormat &format = {}) {
  return read_file(file_of(text), format);
}
DataFormat style(const std::string &atom_style) { return {atom_style, 1.0, 1.0, false}; }

const std::string kHead = "two spheres\n\n2 atoms\n2 atom types\n\n-6 6 xlo xhi\n0 12 ylo yhi\n"
                          "-1 9 zlo zhi\n\nAtoms # sphere\n\n"; // 11 lines
const std::string kGood = kHead + "1 1 4.4 4.65 0 2 3\n7 2 1.3 0.9 5 11 8\n";

TEST(ParticleData, LammpsAndLiggghtsWriteTheSameSpheres) {
  const ParticleData a = read_file(kData + "lammps_micro.data");
  const ParticleData b = read_file(kData + "liggghts_micro.data", style("granular"));
  ASSERT_EQ(a.particles.size(), 6u);
  ASSERT_EQ(b.particles.size(), 6u);
  EXPECT_EQ(a.box, Eigen::Vector3d(12, 12, 10));
  EXPECT_FALSE(a.molecules);
  EXPECT_EQ(a.particles[1].x, Eigen::Vector3d(11.8, 6, 3.2));
  EXPECT_EQ(a.particles[1].diameter, 4.4);
  EXPECT_EQ(a.particles[5].type, 3);
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(a.particles[k].id, b.particles[k].id);
    EXPECT_EQ(a.particles[k].type, b.particles[k].type);
    EXPECT_NEAR(a.particles[k].diameter, b.particles[k].diameter, 1e-12);
    EXPECT_NEAR(a.particles[k].density, b.particles[k].density, 1e-12);
    EXPECT_NEAR((a.particles[k].x - b.particles[k].x).norm(), 0.0, 1e-12);
  }
}

TEST(ParticleData, HybridStyleHasThePlaceFirstAndMoleculesLast) {
  const ParticleData a = read_file(kData + "lammps_cluster.data", style("hybrid"));
  ASSERT_EQ(a.particles.size(), 38u);
  EXPECT_TRUE(a.molecules);
  std::map<long, int> members;
  for (const DataParticle &p : a.particles)
    ++members[p.molecule];
  EXPECT_EQ(members, (std::map<long, int>{{0, 2}, {5, 10}, {7, 19}, {11, 7}}));
  EXPECT_EQ(a.particles[2].x, Eigen::Vector3d(6.98, 2.56, 2.56));
  EXPECT_EQ(a.particles[2].diameter, 1.59);
  EXPECT_EQ(a.particles[2].density, 4.633);
}

TEST(ParticleData, UnitsAreConverted) {
  const ParticleData si =
      read_file(kData + "liggghts_hybrid_si.data", {"hybrid", 1e6, 1e-3, false});
  ASSERT_EQ(si.particles.size(), 2u);
  EXPECT_NEAR(si.box.z(), 10.0, 1e-12);
  EXPECT_NEAR((si.particles[0].x - Eigen::Vector3d(2.5, 2.5, 3)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(si.particles[0].diameter, 1.59, 1e-12);
  EXPECT_NEAR(si.particles[0].density, 4.633, 1e-12);
  EXPECT_EQ(si.particles[0].molecule, 4);
}

TEST(ParticleData, PlacesAreInTheBoxWhereItIsPeriodic) {
  const std::string unwrapped = kHead + "1 1 4.4 4.65 -31 2 3 0 0 0\n7 2 1.3 0.9 5 23.5 11 0 1 0\n";
  const ParticleData d = read_text(unwrapped, {"sphere", 1.0, 1.0, true});
  EXPECT_NEAR((d.particles[0].x - Eigen::Vector3d(11, 2, 4)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((d.particles[1].x - Eigen::Vector3d(11, 11.5, 2)).norm(), 0.0, 1e-12);
  expect_parts(
      refusal([&] { read_text(unwrapped); }),
      {"a.data:13: particle 7 lies outside the box: z = 11", "-1 and 9", "structure.boundary"});
}

TEST(ParticleData, CommentsBlanksAndWindowsLineEndsDoNotMatter) {
  std::string text = "title\n\n2 atoms # all\n  2   atom types\n0 bonds\n\n-6\t6 xlo xhi\n"
                     "0 12 ylo yhi # periodic\n-1 9 zlo zhi\n0 0 0 xy xz yz\n\nMasses\n\n1 1\n2 "
                     "1\n\nPair Coeffs # gran\n\n1 0.3\n\nAtoms\n\n  1 1 4.4 4.65 0 2 3 # big\n\n"
                     "7 2 1.3 9e-1 5 11 8\n\nVelocities\n\n1 0 0 0 0 0 0\n7 0 0 0 0 0 0";
  const ParticleData a = read_text(text);
  for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.insert(at, "\r");
  const ParticleData b = read_text(text), c = read_text(kGood);
  ASSERT_EQ(a.particles.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(a.particles[k].x, c.particles[k].x);
    EXPECT_EQ(b.particles[k].x, c.particles[k].x);
    EXPECT_EQ(b.particles[k].density, c.particles[k].density);
  }
}

struct Spoilt {
  const char *name, *what, *with;
  std::vector<std::string> parts;
};
class SpoiltData : public testing::TestWithParam<Spoilt> {};

TEST_P(SpoiltData, IsRefusedWithItsLine) {
  expect_parts(refusal([] { read_text(replaced(kGood, GetParam().what, GetParam().with)); }),
               GetParam().parts);
}

INSTANTIATE_TEST_SUITE_P(
    All, SpoiltData,
    testing::Values(
        Spoilt{"twice", "7 2 1.3", "1 2 1.3", {":13: particle 1 occurs twice", "line 12"}},
        Spoilt{"type", "7 2 1.3", "7 3 1.3", {":13: type 3 is not between 1 and 2"}},
        Spoilt{"type_word", "7 2 1.3", "7 CBD 1.3", {":13: type 'CBD' is not a whole number"}},
        Spoilt{"id", "7 2 1.3", "0 2 1.3", {":13: id 0 is not between 1"}},
        Spoilt{"diameter", "7 2 1.3", "7 2 0", {":13: diameter 0 is not above 0"}},
        Spoilt{"density", "1.3 0.9", "1.3 -0.9", {":13: density -0.9 is not above 0"}},
        Spoilt{"nan", "5 11 8", "5 nan 8", {":13: y 'nan' is not a finite number"}},
        Spoilt{"infinite", "5 11 8", "1e999 11 8", {":13: x '1e999' is not a finite number"}},
        Spoilt{"all_of_a_row", "7 2 1.3 0.9", "7 9 -1 x", {":13: type 9", "diameter -1", "'x'"}},
        Spoilt{"outside", "5 11 8", "5 11 -3", {":13: particle 7 lies outside", "z = -3"}},
        Spoilt{"far_away", "5 11 8", "5 1e200 8", {":13: particle 7 lies outside", "10000 boxes"}},
        Spoilt{"cut_in_row", "5 11 8\n", "5 1", {":13: the row has 6 columns", "whole file"}},
        Spoilt{"cut_in_number", "5 11 8\n", "5 11 8", {":13: the last row", "may be cut"}},
        Spoilt{"cut_before_row", "7 2 1.3 0.9 5 11 8\n", "", {"line 3 announces 2 atoms", "1 row"}},
        Spoilt{"row_too_many", "2 atoms", "1 atoms", {"announces 1 atoms", "2 rows"}},
        Spoilt{"columns_differ", "5 11 8", "5 11 8 0 0 0", {":13:", "10 columns", "before it 7"}},
        Spoilt{"no_atoms_line", "2 atoms\n", "\n", {"no line 'N atoms'"}},
        Spoilt{"no_types_line", "2 atom types\n", "\n", {"no line 'N atom types'"}},
        Spoilt{"no_side", "-1 9 zlo zhi", "", {"no line 'lo hi zlo zhi'"}},
        Spoilt{"side_inside_out", "-1 9 zlo", "9 -1 zlo", {":8: the box side", "lower first"}},
        Spoilt{"side_of_one", "-1 9 zlo", "9 zlo", {":8: the box side '9 zlo zhi'"}},
        Spoilt{"atoms_of_half", "2 atoms", "1.5 atoms", {":3: the number of atoms is '1.5'"}},
        Spoilt{"tilt", "-1 9 zlo zhi", "-1 9 zlo zhi\n1 0 0 xy xz yz", {":9: the box is tilted"}},
        Spoilt{
            "header_word", "2 atom types", "2 atom tipes", {":4: '2 atom tipes' is not a header"}},
        Spoilt{"section_word", "Atoms # sphere", "Atom", {":10: 'Atom' is neither", "no section"}},
        Spoilt{"no_section", "Atoms # sphere", "", {":12: '1 1 4.4", "no section Atoms"}},
        Spoilt{"second_section", "7 2 1.3", "Atoms\n\n7 2 1.3", {":13: a second section Atoms"}},
        Spoilt{"velocities_cut",
               "5 11 8\n",
               "5 11 8\n\nVelocities\n\n1 0 0 0 0 0 0\n",
               {"Velocities has 1 rows for 2 atoms"}},
        Spoilt{"no_spheres", "# sphere", "# atomic", {"'Atoms # atomic'", "atom_style sphere"}},
        Spoilt{"another_style", "# sphere", "# hybrid", {"structure.atom_style = \"hybrid\""}}),
    [](const auto &test) { return std::string(test.param.name); });

TEST(ParticleData, FilesThatAreNoneAreRefused) {
  expect_parts(refusal([] { read_text(""); }), {"empty"});
  for (const char *text :
       {"displacement_um;pressure_MPa\n0,1;2\n0,2;3\n", "displacement_um;pressure_MPa\n",
        "0 0 0 1\n1 1 1 2\n", "[experiment]\nname = \"x\"\n"}) {
    const std::string said = refusal([&] { read_text(text); });
    expect_parts(said, {"a.data: this is no data file of LAMMPS", "no dump", "no table of spheres",
                        "It begins with '" + std::string(text, 5)});
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << said;
  }
  expect_parts(refusal([] { read_text("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\n"); }),
               {"the frame of the dump is cut"});
}

TEST(ParticleData, TheFirstTenMistakesAreReportedTheOthersCounted) {
  std::string text = replaced(replaced(kHead, "2 atoms", "30 atoms"), "Atoms # sphere", "Atoms");
  for (int k = 1; k <= 30; ++k)
    text += std::to_string(k) + " 1 -4.4 4.65 0 2 3\n";
  const std::string said = refusal([&] { read_text(text); });
  expect_parts(said, {":12: diameter -4.4", ":21: diameter -4.4", "a.data: ... and 20 more"});
  EXPECT_EQ(said.find(":22:"), std::string::npos);
}

// Without '# hybrid' the columns of the other style are inferred from their contents.
TEST(ParticleData, ColumnsOfAnotherStyleAreFoundOut) {
  std::string text = bytes_of(kData + "lammps_cluster.data");
  text = replaced(text, "Atoms # hybrid", "Atoms");
  expect_parts(refusal([&] { read_text(text); }),
               {"11 columns", "look like those of atom_style hybrid", "id type x y z diameter"});
  std::string rows = replaced(kHead, "2 atoms", "4 atoms");
  rows = replaced(replaced(rows, "Atoms # sphere", "Atoms"), "-6 6", "0 12");
  rows += "1 1 2.5 2.6 3 1.59 4.6\n2 1 5.5 5.6 3 1.59 4.6\n3 2 8.5 8.7 2 1.3 0.9\n"
          "4 2 1.5 9.6 7 1.3 0.9\n"; // every number could be that of a sphere
  expect_parts(refusal([&] { read_text(rows); }), {"atom_style hybrid", "densities differ"});
  EXPECT_EQ(read_text(rows, style("hybrid")).particles.size(), 4u);
}

TEST(ParticleData, UnitsThatCannotBeAreNamedWithThoseThatCan) {
  expect_parts(refusal([] { read_file(kData + "liggghts_hybrid_si.data", style("hybrid")); }),
               {"e-06 um", "structure.units", "In units si it would be 1.59 um and 4.633 g/cm3"});
  expect_parts(refusal([] {
                 read_file(kData + "lammps_micro.data", {"sphere", 1e4, 1.0, false});
               }),
               {"In units micro"});
}

void expect_good(const ParticleData &d) {
  const ParticleData right = read_text(kGood);
  ASSERT_EQ(d.particles.size(), 2u);
  EXPECT_EQ(d.box, right.box);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(d.particles[k].type, right.particles[k].type);
    EXPECT_EQ(d.particles[k].x, right.particles[k].x);
  }
}

TEST(ParticleData, TypesMayHaveLabels) {
  const std::string text =
      replaced(replaced(kGood, "1 1 4.4", "1 AM 4.4"), "7 2 1.3", "7 binder 1.3");
  expect_good(read_text(
      replaced(text, "Atoms # sphere", "Atom Type Labels\n\n1 AM\n2 binder\n\nAtoms # sphere")));
  expect_parts(refusal([&] { read_text(text); }), {"type 'AM' is not a whole number"});
}

TEST(ParticleData, GeneralBoxesWithRightAnglesAreRead) {
  const std::string box = "-6 6 xlo xhi\n0 12 ylo yhi\n-1 9 zlo zhi\n",
                    edges = "12 0 0 avec\n0 12 0 bvec\n0 0 10 cvec\n-6 0 -1 abc origin\n";
  expect_good(read_text(replaced(kGood, box, edges)));
  expect_parts(
      refusal([&] { read_text(replaced(kGood, box, replaced(edges, "0 12 0", "3 12 0"))); }),
      {":7: ", "the box is tilted ('3 12 0 bvec')"});
  expect_parts(
      refusal([&] { read_text(replaced(kGood, box, replaced(edges, "0 0 10 cvec\n", ""))); }),
      {"no line 'lo hi zlo zhi'"});
}

TEST(ParticleData, FilesPackedByGzipAreRead) {
  const std::string file = (test_folder() / "a.data.gz").string();
  gzFile out = gzopen(file.c_str(), "wb");
  gzwrite(out, kGood.data(), unsigned(kGood.size()));
  gzclose(out);
  const ParticleData whole = read_file(file);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 12);
  expect_parts(refusal([&] { read_file(file); }), {"does not unpack (gzip)"});
  expect_good(whole);
}

TEST(ParticleData, FilesOfAnotherKindAreNamed) {
  const auto said = [](const std::string &text) { return refusal([&] { read_text(text); }); };
  expect_parts(said("type,x,y,z,r\n1,0.1,0.2,0.3,0.006\n"), {"a table of spheres has no box"});
  expect_parts(said("PK\3\4"), {"ZIP archive"});
}

} // namespace
