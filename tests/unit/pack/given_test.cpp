// SPDX-License-Identifier: GPL-2.0-or-later
// From an existing structure to bodies and places: nothing is lost, doubled or lighter than before.
#include "electrode/pack/electrode_files.h"
#include "electrode/pack/from_structure.h"
#include "electrode/pack/pack.h"
#include "physics/pi.h"
#include "support.h"
#include <fmt/format.h>
#include <set>
#include <sstream>

namespace {
using namespace calendem;
using calendem_test::test_folder;

const std::string kTable = "[structure]\nfile = \"a.data\"\nunits = \"micro\"\n"
                           "am_types = \"1 2\"\ncbd_types = \"3\"\n";
const std::string kClusters =
    "[structure]\nfile = \"" CALENDEM_TEST_DATA "/lammps_cluster.data\"\nunits = \"micro\"\n"
    "atom_style = \"hybrid\"\nam_types = \"1 2\"\ncbd_types = \"3\"\nbodies = \"clusters\"\n"
    "[coating]\nporosity_total_percent = 60\n";

// A film of 10 x 11 um: AM of 6 x 4 and 8 x 3 um, some of which touch or overlap, and 6 CBD spheres
// of 1.2 um, the first inside an AM sphere.
std::string film() {
  const double large[6][3] = {{2, 2, 2},     {7, 2, 2},     {2, 7.5, 2.1},
                              {7, 7.5, 2.2}, {4.5, 5, 5.5}, {9.5, 5, 5.8}};
  const double small[8][3] = {{4.5, 4.8, 1.6}, {9.4, 4.8, 1.6}, {4.5, 9.8, 1.5}, {9.5, 9.9, 1.5},
                              {2, 2, 5.4},     {7, 2, 5.5},     {2, 8, 5.5},     {7, 8, 5.5}};
  std::string rows;
  int id = 0;
  const auto add = [&](int type, double d, double rho, const double *x) {
    rows += fmt::format("{} {} {} {} {} {} {}\n", ++id, type, d, rho, x[0], x[1], x[2]);
  };
  for (const auto &x : large)
    add(1, 4.0, 4.5, x);
  for (const auto &x : small)
    add(2, 3.0, 4.5, x);
  for (int k = 0; k < 6; ++k) {
    const double x[3] = {1.5 + 1.4 * k, k == 0 ? 2.0 : 5.5, k == 0 ? 2.0 : 0.6};
    add(3, 1.2, 0.9, x);
  }
  return fmt::format("t\n\n{} atoms\n3 atom types\n\n0 10 xlo xhi\n0 11 ylo yhi\n0 30 zlo zhi\n\n"
                     "Atoms # sphere\n\n{}",
                     id, rows);
}
constexpr double kBall = kPi / 6.0; // of diameter 1
const double kAmVolume = kBall * (6 * 64 + 8 * 27), kCbdVolume = kBall * 6 * 1.728;

Recipe recipe_with(const std::string &lines) {
  const std::filesystem::path folder = test_folder();
  std::ofstream(folder / "a.data") << film();
  std::ofstream(folder / "recipe.toml") << lines;
  return read_recipe((folder / "recipe.toml").string());
}
PackInput input(const std::string &lines) { return read_input(recipe_with(lines)); }

std::string refusal(const std::string &lines) {
  try {
    const PackInput in = input(lines);
    bodies_of_clusters(in.recipe, in.structure);
  } catch (const Failure &e) {
    EXPECT_EQ(e.exit_status(), kBadInput);
    return e.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}
void expect_parts(const std::string &text, const std::vector<std::string> &parts) {
  for (const std::string &part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in\n" << text;
}

TEST(Adopt, CellLoadingAndCompositionAreTheStructures) {
  const Recipe r = input(kTable).recipe;
  const double am = 4.5 * kAmVolume, cbd = 0.9 * kCbdVolume;
  EXPECT_EQ(r.cell_x, 10.0);
  EXPECT_EQ(r.cell_y, 11.0);
  EXPECT_NEAR(r.am_density, 4.5, 1e-9);
  EXPECT_NEAR(r.loading, 0.1 * (am + cbd) / 110.0, 1e-9);
  EXPECT_NEAR(r.am_weight, am / (am + cbd), 1e-9);
  EXPECT_NEAR(r.nanoporosity, 1.0 - 0.9 / 1.83, 1e-9);
  EXPECT_EQ(r.cbd_diameter, 1.2);
  // from the lowest sphere's bottom at 0 to the highest one's top at 7.8
  EXPECT_NEAR(r.thickness(), 7.8, 1e-6);
  EXPECT_NEAR(r.area() * r.am_column(), kAmVolume, 1e-6);
  EXPECT_NEAR(r.settings.number("composition.carbon_weight_percent"), 50.0 * (1.0 - r.am_weight),
              1e-6);
}

TEST(Adopt, DensitiesOfTheRecipeReplaceTheFilesOnDemand) {
  const Recipe r = input(kTable + "densities = \"recipe\"\n").recipe;
  EXPECT_EQ(r.am_density, 4.65);
  EXPECT_EQ(r.nanoporosity, 0.5);
  EXPECT_NEAR(r.am_weight, 4.65 * kAmVolume / (4.65 * kAmVolume + 0.915 * kCbdVolume), 1e-9);
}

TEST(Adopt, APorosityOfTheRecipeIsWhatTheFilmIsPackedTo) {
  const Recipe r = input(kTable + "[coating]\nporosity_total_percent = 50\n").recipe;
  EXPECT_NEAR(r.porosity_total, 0.5, 1e-12);
}

TEST(Adopt, ValuesOfTheRecipeThatTheStructureContradictsAreNamedAtOnce) {
  expect_parts(refusal(kTable + "[cell]\nx_um = 15\n[density]\nam_g_cm3 = 4.65\n[composition]\n"
                                "am_weight_percent = 90\ncarbon_weight_percent = 5\n"
                                "binder_weight_percent = 5\n[coating]\nloading_mg_cm2 = 1.32\n"
                                "[cbd]\ndiameter_um = 1.316\nnanoporosity_percent = 27\n"),
               {"recipe.toml:7: cell.x_um is 15, but the structure has 10 um",
                ":9: density.am_g_cm3 is 4.65, but the structure has 4.5 g/cm3",
                ":11: composition.am_weight_percent is 90", ":13: carbon and binder are 10 %",
                ":15: coating.loading_mg_cm2 is 1.32", ":17: cbd.diameter_um is 1.316",
                ":18: cbd.nanoporosity_percent is 27"});
  EXPECT_NO_THROW(input(kTable + "[density]\nam_g_cm3 = 4.49\n[cell]\nx_um = 10\n"));
}

TEST(Adopt, WhatNoElectrodeCanHaveIsRefused) {
  expect_parts(refusal(kTable + "[particles]\nprimary_diameter_um = 5\nlattice_um = 4\n"),
               {"8 spheres of the structure have less than half", "particle 7 of 3 um",
                "14 spheres of the structure are too large"});
  expect_parts(refusal(kTable + "[particles]\nmax_width_fraction = 0.5\n"),
               {"6 spheres of the structure are too large", "particle 1 of 4 um"});
  expect_parts(refusal(kTable + "[density]\ncbd_solid_g_cm3 = 0.8\n"), {"CBD weighs 0.9 g/cm3"});
  expect_parts(refusal(kTable + "bodies = \"clusters\"\natom_style = \"sphere\"\n"),
               {"no molecule ids"});
}

class GivenFilm : public testing::Test {
protected:
  void SetUp() override {
    in = input(kTable);
    start = make_bodies_to_pack(in, test_folder().string());
  }
  double mass(int type) const {
    double sum = 0.0;
    for (const Particle &p : start.placed.loose.particles)
      sum += p.type == type ? p.density * kBall * std::pow(p.diameter, 3) : 0.0;
    return sum;
  }
  PackInput in;
  BodiesToPack start;
};

TEST_F(GivenFilm, EachSphereBecomesOneBodyAndEachPhaseKeepsItsMass) {
  ASSERT_EQ(start.made.bodies.size(), 14u);
  std::set<long> ids;
  for (size_t k = 0; k < 14; ++k) {
    ASSERT_EQ(start.made.ids[k].size(), 1u);
    ids.insert(start.made.ids[k][0]);
    const double V = kBall * std::pow(in.structure.am[start.made.ids[k][0] - 1].diameter, 3);
    EXPECT_NEAR(start.made.bodies[k].volume, V, std::pow(in.recipe.lattice, 3)) << k;
  }
  EXPECT_EQ(ids.size(), 14u);
  EXPECT_EQ(*ids.rbegin(), 14);
  EXPECT_NEAR(mass(1), 4.5 * kAmVolume, 0.5 * 4.5 * std::pow(in.recipe.lattice, 3));
  EXPECT_NEAR(mass(2), 0.9 * kCbdVolume, 1e-9);
}

TEST_F(GivenFilm, NothingOverlapsOrLeavesTheCell) {
  const std::vector<Particle> &all = start.placed.loose.particles;
  for (const Particle &p : all) {
    EXPECT_GE(p.x.z(), 0.5 * p.diameter - 1e-9);
    EXPECT_LE(p.x.z(), start.placed.loose.height - 0.5 * p.diameter);
    for (const Particle &q : all)
      if (p.tag < q.tag && (p.body == 0 || p.body != q.body)) {
        ASSERT_GE(periodic_difference(in.recipe, p.x, q.x).norm(),
                  0.5 * (p.diameter + q.diameter) - 1e-9)
            << p.tag << " " << q.tag;
      }
  }
}

// Only those that hit another leave their place, and none goes farther than a sphere is wide.
TEST_F(GivenFilm, PlacesAreTheStructuresWithTheHeightsStretched) {
  size_t tag = 0;
  long there = 0;
  for (size_t k = 0; k < start.made.bodies.size(); ++k) {
    const Body &b = start.made.bodies[k];
    const Eigen::Vector3d at = start.placed.loose.particles[tag].x - b.primaries[0];
    tag += b.primaries.size();
    Eigen::Vector3d home = start.made.at[k];
    home.z() = std::max(home.z() * start.placed.stretch, b.reach);
    there += periodic_difference(in.recipe, at, home).norm() < 1e-9;
  }
  EXPECT_GE(there, 6);
  EXPECT_LE(start.placed.moved, 14 - there + 6);
  EXPECT_GE(start.placed.moved, 14 - there);
  EXPECT_LT(start.placed.largest_move_um, 4.0);
  EXPECT_GT(start.placed.stretch, 1.5);
}

TEST_F(GivenFilm, TheOrderOfTheRowsDoesNotMatter) {
  std::string text = film(), backwards;
  const size_t rows = text.find("# sphere\n\n") + 10;
  std::istringstream lines(text.substr(rows));
  for (std::string line; std::getline(lines, line);)
    backwards.insert(0, line + "\n");
  const Recipe recipe = recipe_with(kTable);
  std::ofstream(recipe.structure.file) << text.substr(0, rows) << backwards;
  const PackInput other = read_input(recipe);
  const BodiesToPack again = make_bodies_to_pack(other, test_folder().string());
  EXPECT_EQ(data_file(other.recipe, again.placed.loose.particles, 1.0),
            data_file(in.recipe, start.placed.loose.particles, 1.0));
}

TEST_F(GivenFilm, TheTableNamesTheTagsOfEveryParticle) {
  std::istringstream table(structure_table(in.structure, start.made));
  std::string line;
  std::getline(table, line);
  std::vector<int> owners(start.placed.loose.particles.size() + 1, 0);
  int rows = 0;
  for (; std::getline(table, line); ++rows) {
    const size_t comma = line.rfind(',', line.rfind(',') - 1);
    const int first = std::stoi(line.substr(comma + 1)),
              last = std::stoi(line.substr(line.rfind(',') + 1));
    for (int tag = first; tag <= last; ++tag)
      ++owners.at(tag);
  }
  EXPECT_EQ(rows, 20);
  EXPECT_EQ(std::count(owners.begin() + 1, owners.end(), 1), long(owners.size()) - 1);
}

TEST_F(GivenFilm, LossDoublingAndLostMassAreNoticed) {
  const std::vector<Particle> &all = start.placed.loose.particles;
  const std::vector<Pose> poses = find_poses(in.recipe, start.made.bodies, all);
  const auto said_of = [&](const BodiesOfStructure &made, const std::vector<Particle> &particles) {
    const nlohmann::json j =
        describe_structure(in.recipe, in.structure, made, start.placed, poses, particles);
    try {
      check_kept(j, "folder");
    } catch (const Failure &e) {
      EXPECT_EQ(e.exit_status(), kCheckFailed);
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(said_of(start.made, all), "");
  std::vector<Particle> fewer(all.begin(), all.end() - 1);
  expect_parts(said_of(start.made, fewer), {"cbd: 6 in the structure, 5", "mass of CBD differs"});
  fewer.assign(all.begin() + 1, all.end());
  expect_parts(said_of(start.made, fewer), {"active material's mass differs by -"});
  BodiesOfStructure doubled = start.made;
  doubled.ids[3] = doubled.ids[4];
  expect_parts(said_of(doubled, all), {"in no body or in two"});
}

TEST(GivenSlurry, IsNotCompressedBeforeItFalls) {
  std::string text = film();
  text = text.replace(text.find("0 30 zlo"), 4, "0 99");
  const size_t row = text.find("\n6 1 4 ");
  text = text.replace(row, text.find('\n', row + 1) - row, "\n6 1 4 4.5 3 8 95");
  const Recipe recipe = recipe_with(kTable + "[coating]\nporosity_total_percent = 60\n");
  std::ofstream(recipe.structure.file) << text;
  const PackInput in = read_input(recipe);
  const BodiesToPack start = make_bodies_to_pack(in, test_folder().string());
  EXPECT_EQ(start.placed.stretch, 1.0);
}

TEST(GivenClusters, AreKeptAcrossAPeriodicFace) {
  const PackInput in = input(kClusters);
  EXPECT_NEAR(in.recipe.lattice, 1.28, 1e-4); // of mass: 4.633 g/cm3 in a sphere, 4.65 in a cell
  EXPECT_EQ(in.recipe.primary_diameter, 1.59);
  const BodiesOfStructure made = bodies_of_clusters(in.recipe, in.structure);
  ASSERT_EQ(made.bodies.size(), 3u);
  EXPECT_EQ(made.bodies[0].primaries.size(), 19u);
  EXPECT_EQ(made.bodies[1].primaries.size(), 10u);
  const Body &star = made.bodies[2]; // a primary with its six neighbours
  ASSERT_EQ(star.primaries.size(), 7u);
  EXPECT_NEAR(in_cell(in.recipe, made.at[2]).x(), 0.26, 1e-9);
  EXPECT_NEAR(star.width, 2.56 + 1.59, 1e-9);
  EXPECT_NEAR(star.reach, 1.28 + 0.795, 1e-9);
  int pairs = 0;
  for (const Eigen::Vector3d &p : star.primaries) {
    EXPECT_TRUE(p.norm() < 1e-9 || std::fabs(p.norm() - 1.28) < 1e-9);
    for (const Eigen::Vector3d &q : star.primaries)
      pairs += (p - q).norm() < 1.59;
  }
  EXPECT_EQ((pairs - 7) / 2, 6);
  for (const Body &b : made.bodies) { // the lattice lies along x, y and z
    const Eigen::Matrix3d R = b.lattice.toRotationMatrix().cwiseAbs();
    EXPECT_NEAR(R.maxCoeff(), 1.0, 1e-9);
    EXPECT_NEAR(R.sum(), 3.0, 1e-9);
  }
  EXPECT_GT(made.bodies[0].sphericity, star.sphericity);
  EXPECT_LT(made.bodies[0].sphericity, 1.0);
}

TEST(GivenClusters, AreNotTurned) {
  const PackInput in = input(kClusters);
  const BodiesToPack start = make_bodies_to_pack(in, test_folder().string());
  const auto &p = start.placed.loose.particles;
  ASSERT_EQ(p.size(), 38u);
  const BodiesOfStructure made = bodies_of_clusters(in.recipe, in.structure);
  for (int k = 1; k < 19; ++k)
    EXPECT_NEAR((periodic_difference(in.recipe, p[k].x, p[0].x) -
                 (made.bodies[0].primaries[k] - made.bodies[0].primaries[0]))
                    .norm(),
                0.0, 1e-9);
}

TEST(GivenClusters, ThatFallApartOrDifferAreRefused) {
  const std::string map = (test_folder() / "bodies.map").string();
  std::string rows;
  for (int id = 1; id <= 36; ++id)
    rows += fmt::format("{} {}\n", id, id < 3 ? 1 : 2); // joins parts of both clusters
  std::ofstream(map) << rows;
  std::string table = kClusters;
  table.insert(table.find("[coating]"), "body_map = \"" + map + "\"\n");
  const Recipe recipe = calendem_test::recipe_of("seed = 1\n");
  std::ofstream(map) << rows; // recipe_of() empties the folder
  std::ofstream(recipe.file) << table;
  const PackInput in = read_input(read_recipe(recipe.file));
  try {
    bodies_of_clusters(in.recipe, in.structure);
    ADD_FAILURE() << "nothing was refused";
  } catch (const Failure &e) {
    expect_parts(e.what(), {"cluster 1 falls apart: 1 of its 2", "cluster 2 falls apart: "});
  }
}

} // namespace
