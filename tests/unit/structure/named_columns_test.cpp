// SPDX-License-Identifier: GPL-2.0-or-later
// Dumps of LAMMPS and LIGGGHTS and tables of spheres give the particles that a data file gives.
#include "base/recipe.h"
#include "electrode/structure/existing_structure.h"
#include "electrode/structure/particle_data.h"
#include "support.h"
#include <algorithm>
#include <fmt/format.h>

namespace {
using namespace calendem;
using namespace calendem_test;

ParticleData read_named(const std::string &text, const DataFormat &format = {}) {
  const std::string file = (test_folder() / "dump.txt").string();
  std::ofstream(file, std::ios::binary) << text;
  Mistakes mistakes(file, 10);
  ParticleData data = read_particle_data(file, format, mistakes);
  mistakes.stop_if_any();
  return data;
}
std::string said_of(const std::string &text, const DataFormat &format = {}) {
  return refusal([&] { read_named(text, format); });
}
DataFormat frame_of(const std::string &step) {
  DataFormat f;
  f.frame = step;
  return f;
}
DataFormat without_densities() {
  DataFormat f;
  f.densities = false;
  return f;
}

// One frame; the box is 12 x 12 x 10 from (-6, 0, -1).
std::string dump(const std::string &columns, const std::string &rows, int step = 0,
                 const std::string &boundary = "pp pp ff") {
  return fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {}\n-6 6\n"
                     "0 12\n-1 9\nITEM: ATOMS {} \n{}",
                     step, std::count(rows.begin(), rows.end(), '\n'), boundary, columns, rows);
}

void expect_two_spheres(const ParticleData &d) {
  ASSERT_EQ(d.particles.size(), 2u);
  EXPECT_EQ(d.box, Eigen::Vector3d(12, 12, 10));
  EXPECT_EQ(d.particles[0].id, 1);
  EXPECT_EQ(d.particles[1].id, 7);
  EXPECT_EQ(d.particles[1].type, 2);
  const double places[2][3] = {{6, 2, 4}, {11, 11, 9}};
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(d.particles[k].diameter, k == 0 ? 4.4 : 1.3, 1e-12);
    EXPECT_NEAR(d.particles[k].density, k == 0 ? 4.65 : 0.9, 1e-12);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(d.particles[k].x[axis], places[k][axis], 1e-12) << k << axis;
  }
}

// Mass: pi/6 d^3 times the density.
TEST(Dumps, SizesPlacesAndDensitiesMayBeGivenInSeveralWays) {
  expect_two_spheres(read_named(
      dump("id type x y z diameter density", "1 1 0 2 3 4.4 4.65\n7 2 5 11 8 1.3 0.9\n")));
  expect_two_spheres(
      read_named(dump("density radius zs ys xs vx type id",
                      "4.65 2.2 0.4 0.16666666666666666 0.5 9 1 1\n"
                      "0.9 0.65 0.9 0.91666666666666663 0.91666666666666663 9 2 7\n")));
  const double volume = kPi / 6.0;
  expect_two_spheres(read_named(
      dump("id type mol mass radius xu yu z ix iy iz",
           fmt::format("1 1 3 {:.17g} 2.2 -24 14 3 -2 1 0\n7 2 0 {:.17g} 0.65 17 -1 8 1 -1 0\n",
                       4.65 * volume * std::pow(4.4, 3), 0.9 * volume * std::pow(1.3, 3)))));
}

TEST(Dumps, TheLastFrameIsTakenOrTheOneThatIsNamed) {
  const std::string columns = "id type x y z radius density";
  const std::string text = dump(columns, "1 1 1 1 1 2 4\n", 0) +
                           dump(columns, "1 1 2 1 1 2 4\n", 500) +
                           dump(columns, "1 1 3 1 1 2 4\n", 1000);
  EXPECT_NEAR(read_named(text).particles[0].x.x(), 9.0, 1e-12);
  EXPECT_NEAR(read_named(text, frame_of("500")).particles[0].x.x(), 8.0, 1e-12);
  EXPECT_NEAR(read_named(text, frame_of("0")).particles[0].x.x(), 7.0, 1e-12);
  expect_parts(said_of(text, frame_of("7")),
               {"structure.frame is \"7\"", "0, 500, 1000", "\"last\""});
  const std::string cut = text.substr(0, text.size() - 3); // in the last row
  expect_parts(said_of(cut), {"the frame of the dump is cut", "Name an earlier one"});
  EXPECT_NEAR(read_named(cut, frame_of("500")).particles[0].x.x(), 8.0, 1e-12);
}

struct SpoiltFrame {
  const char *name, *what, *with;
  std::vector<std::string> parts;
};
class SpoiltDump : public testing::TestWithParam<SpoiltFrame> {};

TEST_P(SpoiltDump, IsRefused) {
  const std::string good = dump("id type x y z radius density", "1 1 0 2 3 2.2 4.65\n");
  EXPECT_EQ(read_named(good).particles.size(), 1u);
  expect_parts(said_of(replaced(good, GetParam().what, GetParam().with)), GetParam().parts);
}

INSTANTIATE_TEST_SUITE_P(
    All, SpoiltDump,
    testing::Values(
        SpoiltFrame{
            "no_id", "ATOMS id", "ATOMS tag", {":9: the dump has no column id", "'tag type x"}},
        SpoiltFrame{"no_size", "radius", "c_1", {"no column radius or diameter", "dump custom"}},
        SpoiltFrame{"no_density", "density", "q", {"no column density", "densities = \"recipe\""}},
        SpoiltFrame{"no_place", "x y z", "x y vz", {"no column z"}},
        SpoiltFrame{
            "not_periodic", "pp pp ff", "ff pp ff", {":5: the dump's box is not periodic along x"}},
        SpoiltFrame{
            "periodic", "pp pp ff", "pp pp pp", {"is periodic along z", "structure.boundary"}},
        SpoiltFrame{"tilted", "-6 6", "-6 6 1", {":6: the box is tilted ('-6 6 1')"}},
        SpoiltFrame{"inside_out", "-6 6", "6 -6", {":6: the box side '6 -6'", "lower first"}},
        SpoiltFrame{"more_rows", "ATOMS\n1\n", "ATOMS\n2\n", {"announces 2 atoms and has 1 rows"}},
        SpoiltFrame{
            "short_row", "2.2 4.65", "2.2", {":10: the row has 6 columns, ITEM: ATOMS names 7"}},
        SpoiltFrame{
            "no_number", "2.2", "2.2x", {":10: diameter '2.2x' is not a finite", "id type x y z"}},
        SpoiltFrame{"outside", "0 2 3", "0 2 30", {":10: particle 1 lies outside the box: z = 30"}},
        SpoiltFrame{
            "no_bounds", "ITEM: BOX", "ITEM: OX", {"needs ITEM: NUMBER OF ATOMS, BOX BOUNDS"}}),
    [](const auto &test) { return std::string(test.param.name); });

TEST(Dumps, DensitiesMayBeTheRecipes) {
  const ParticleData d =
      read_named(dump("id type x y z radius", "1 1 0 2 3 2.2\n"), without_densities());
  EXPECT_EQ(d.particles[0].density, 1.0);
  EXPECT_EQ(d.particles[0].diameter, 4.4);
}

// The data file's image flags are gone: bodies across a face are joined without them.
TEST(Dumps, OfClustersGiveTheStructureOfTheDataFile) {
  StructureSource source;
  source.file = kData + "lammps_cluster.data";
  source.atom_style = "hybrid";
  source.am_types = {"1", "2"};
  source.cbd_types = {"3"};
  source.clusters = true;
  const ExistingStructure data = read_structure(source);
  std::string rows;
  for (const auto *phase : {&data.am, &data.cbd})
    for (const ExistingSphere &p : *phase)
      rows += fmt::format("{} {} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", p.id, p.type,
                          p.cluster, 0.5 * p.diameter, p.density, p.x.x() + 3.0 * data.lx,
                          p.x.y() - data.ly, p.x.z());
  source.file = (test_folder() / "clusters.dump").string();
  std::ofstream(source.file) << replaced(
      replaced(replaced(dump("id type mol radius density xu yu zu", rows), "-6 6",
                        fmt::format("0 {}", data.lx)),
               "0 12", fmt::format("0 {}", data.ly)),
      "-1 9", "0 20");
  const ExistingStructure again = read_structure(source);
  ASSERT_EQ(again.am.size(), data.am.size());
  for (size_t k = 0; k < data.am.size(); ++k) {
    EXPECT_EQ(again.am[k].cluster, data.am[k].cluster);
    EXPECT_NEAR((again.am[k].x - data.am[k].x).norm(), 0.0, 1e-9);
  }
}

DataFormat cell_of(double x, double y) {
  DataFormat f;
  f.side_x = x;
  f.side_y = y;
  return f;
}

TEST(SphereTables, HaveTheBoxOfTheRecipe) {
  DataFormat format = cell_of(12, 10);
  for (const char *text : {"x,y,z,r,density\n13,2,3,2.2,4.65\n5,-1,8,0.65,0.9\n",
                           "# x y z r density\n13 2 3 2.2 4.65\n5 -1 8 0.65 0.9\n",
                           "Z;D;Y;X;rho\n3;4,4;2;13;4,65\n8;1,3;-1;5;0,9\n"}) {
    const ParticleData d = read_named(text, format);
    ASSERT_EQ(d.particles.size(), 2u) << text;
    EXPECT_EQ(d.box.x(), 12.0);
    EXPECT_EQ(d.box.y(), 10.0);
    EXPECT_EQ(d.particles[1].id, 2);
    EXPECT_EQ(d.particles[1].type, 1);
    EXPECT_NEAR(d.particles[0].x.x(), 1.0, 1e-12);
    EXPECT_NEAR(d.particles[1].x.y(), 9.0, 1e-12);
    EXPECT_NEAR(d.particles[1].x.z() - d.particles[0].x.z(), 5.0, 1e-12);
    EXPECT_NEAR(d.particles[0].diameter, 4.4, 1e-12);
    EXPECT_NEAR(d.particles[1].density, 0.9, 1e-12);
  }
}

// calendem pack writes such a title.
TEST(SphereTables, ADataFileWhoseTitleNamesItsColumnsIsNone) {
  const ParticleData d = read_named("film; micro units: id type diameter density x y z\n\n1 atoms\n"
                                    "1 atom types\n0 9 xlo xhi\n0 8 ylo yhi\n0 7 zlo zhi\n\n"
                                    "Atoms\n\n1 1 4 4.65 1 2 3\n");
  ASSERT_EQ(d.particles.size(), 1u);
  EXPECT_EQ(d.box, Eigen::Vector3d(9, 8, 7));
}

TEST(SphereTables, SayWhatTheyLack) {
  const std::string text = "type,x,y,z,r\n1,1,2,3,2.2\n";
  expect_parts(said_of(text), {"no box", "cell.x_um and cell.y_um",
                               ":1: the table has no column density or mass", "\"recipe\""});
  DataFormat format = cell_of(12, 12);
  format.densities = false;
  EXPECT_EQ(read_named(text, format).particles.size(), 1u);
  expect_parts(said_of("type,x,y,z,r\n1,1,2,3\n1,1,2,3,2.2\n", format), {":2: the row has other"});
  expect_parts(said_of("type,x,y,z,r\n1,1,2,top,2.2\n", format), {":2: z 'nan' is not a finite"});
  format.z_periodic = true;
  expect_parts(said_of(text, format), {"structure.boundary = \"p p f\""});
  format = cell_of(12, 12);
  format.frame = "5";
  expect_parts(said_of("x,y,z,r,rho\n1,1,2,1,4\n", format), {"structure.frame is for dumps"});
  expect_parts(said_of("t\n\n1 atoms\n", format), {"a data file has one frame"});
}

TEST(SphereTables, TheRecipesCellIsHandedOn) {
  const std::string file = (test_folder() / "recipe.toml").string();
  std::ofstream(test_folder() / "s.csv") << "x,y,z,r\n1,2,3,2\n5,6,3,2\n";
  std::ofstream(file) << "[cell]\nx_um = 20\ny_um = 21\n[structure]\nfile = \"s.csv\"\n"
                         "units = \"micro\"\nam_types = \"1\"\ncbd_types = \"none\"\n"
                         "densities = \"recipe\"\n";
  const ExistingStructure g = read_structure(read_recipe(file).structure);
  EXPECT_EQ(g.am.size(), 2u);
  EXPECT_EQ(g.lx, 20.0);
  EXPECT_EQ(g.ly, 21.0);
  EXPECT_EQ(g.extent, 4.0);
}

} // namespace
