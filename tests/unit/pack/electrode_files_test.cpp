// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/electrode_files.h"
#include "support.h"
#include <sstream>

namespace {
using namespace calendem;
using calendem_test::cell;
using calendem_test::test_folder;

std::vector<Particle> three() {
  return {{1, 1, 1.59, 4.6, {1, 2, 3}, 1},
          {2, 1, 1.59, 4.6, {2.28, 2, 3}, 1},
          {3, 2, 1.316, 0.915, {7, 8, 9}, 0}};
}

TEST(DataFile, HoldsEveryParticleAndTheBox) {
  std::istringstream text(data_file(cell(15.0), three(), 80.0));
  std::string line, all;
  int rows = 0;
  while (std::getline(text, line)) {
    std::istringstream row(line);
    std::vector<double> v;
    for (double x; row >> x;)
      v.push_back(x);
    rows += v.size() == 7;
    all += line + "\n";
  }
  EXPECT_EQ(rows, 3);
  for (const char *part : {"3 atoms\n", "4 atom types\n", "0 15 xlo xhi\n", "0 80 zlo zhi\n"})
    EXPECT_NE(all.find(part), std::string::npos) << part;
}

TEST(BodyMap, HasPrimariesOnly) { EXPECT_EQ(body_map(three()), "# tag body, 2 rows\n1 1\n2 1\n"); }

TEST(ScriptVariables, AgreeWithTheRecipe) {
  const Recipe recipe = cell(15.0);
  EXPECT_NEAR(recipe.thickness(), 76.5, 0.2);
  const std::string text = script_variables(recipe, recipe.thickness());
  for (const char *name : {"thickness_um", "area_um2", "solid_volume_um3", "primary_diameter_um",
                           "lattice_um", "cbd_diameter_um"})
    EXPECT_NE(text.find(std::string("variable ") + name + " equal "), std::string::npos) << name;
}

TEST(ReadPositions, TakesRowsInAnyOrderAndRefusesACutFile) {
  const std::string file = (test_folder() / "packed.dump").string();
  const std::string head = "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n3\nITEM: ATOMS id x y z \n";
  std::vector<Particle> particles = three();
  std::ofstream(file) << head << "3 0.5 0.25 0.125\n1 1 1 1\n2 2 2 2\n";
  read_positions(file, particles);
  EXPECT_EQ(particles[2].x, Eigen::Vector3d(0.5, 0.25, 0.125));
  for (const char *rows :
       {"1 1 1 1\n2 2 2 2\n", "1 1 1 1\n2 2 2 2\n3 0.5 0.25", "", "1 1 1 1\n2 2 2 2\n2 2 2 2\n"}) {
    std::ofstream(file) << head << rows;
    EXPECT_THROW(read_positions(file, particles), Failure) << rows;
  }
  EXPECT_THROW(read_positions(file + ".missing", particles), Failure);
}

TEST(PictureFile, HasOnePointPerParticle) {
  const std::string text = picture_file(three());
  EXPECT_NE(text.find("NumberOfPoints=\"3\""), std::string::npos);
  EXPECT_NE(text.find("7 8 9\n"), std::string::npos);
}

} // namespace
