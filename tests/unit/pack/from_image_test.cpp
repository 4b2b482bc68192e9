// SPDX-License-Identifier: GPL-2.0-or-later
// An image as the electrode: particles and carbon-binder where the image has them, none lost or doubled.
#include "electrode/pack/from_image.h"
#include "electrode/pack/from_structure.h"
#include "support.h"
#include "support/refusal.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace {
using namespace calendem;
using namespace calendem_test;

constexpr double kVoxel = 0.25;
struct Ball {
  Eigen::Vector3d at;
  double radius;
};
// In a block of 20 x 20 x 12 um: two in the middle, one across the crop's side x = 15, one on its
// bottom, one outside. The crop is 10 um wide.
const std::vector<Ball> kBalls = {{{7.6, 8.0, 4.0}, 2.0},
                                  {{10.8, 12.0, 8.0}, 2.2},
                                  {{14.6, 7.0, 9.0}, 1.8},
                                  {{11.5, 8.5, 0.0}, 2.0},
                                  {{17.9, 17.0, 6.0}, 1.9}};

bool in(const Ball &ball, const Eigen::Vector3d &x) { return (x - ball.at).norm() < ball.radius; }

// Carbon and binder (label 2) fill a slab of 10 % of the crop beside the balls.
void write_image(const std::string &file, bool with_cbd) {
  LabelImage image;
  image.n = {80, 80, 48};
  image.voxel.setConstant(kVoxel);
  for (int k = 0; k < image.n[2]; ++k)
    for (int j = 0; j < image.n[1]; ++j)
      for (int i = 0; i < image.n[0]; ++i) {
        const Eigen::Vector3d x = kVoxel * (Eigen::Vector3d(i, j, k).array() + 0.5).matrix();
        const bool am =
            std::any_of(kBalls.begin(), kBalls.end(), [&](const Ball &b) { return in(b, x); });
        image.label.push_back(am ? 1 : with_cbd && x.y() > 5.5 && x.y() < 6.5 ? 2 : 0);
      }
  write_label_image(image, file);
}

const std::string kShapes = "[shapes]\nimage = \"image.mha\"\nplaces = \"image\"\n";
const std::string kPhases = "phases = { pore = 0, am = 1, cbd = 2 }\n";
const std::string kCell = "[cell]\nx_um = 10\ny_um = 10\n";
const std::string kFine = "[particles]\nlattice_um = 0.8\nprimary_diameter_um = 1\n";

Recipe recipe_of_image(const std::string &lines, bool with_cbd = true) {
  const std::filesystem::path folder = test_folder();
  write_image((folder / "image.mha").string(), with_cbd);
  std::ofstream(folder / "recipe.toml") << "material = \"xu2023\"\n" << lines;
  return read_recipe((folder / "recipe.toml").string());
}

std::string refusal_of_image(const std::string &lines) {
  return refusal([&] { read_input(recipe_of_image(lines)); });
}

struct Made {
  PackInput in;
  BodiesOfStructure bodies;
};

Made made_of_image(const std::string &lines, bool with_cbd = true) {
  Made m{read_input(recipe_of_image(lines, with_cbd)), {}};
  m.bodies = bodies_of_spheres(m.in.recipe, m.in.structure,
                               [&](const ExistingSphere &s, int count, Random &random) {
                                 return make_body(m.in.recipe, *m.in.image, s, count, random);
                               });
  return m;
}

TEST(ImageAsElectrode, CompositionLoadingAndPorosityAreTheCrops) {
  const Made m = made_of_image(kCell + kFine + kShapes + kPhases);
  const Recipe &r = m.in.recipe;
  const PhaseImage &crop = m.in.image->phases;
  EXPECT_EQ(crop.n, (std::array{40, 40, 48}));
  const auto share = [&](std::int32_t label) {
    return double(std::count(crop.label.begin(), crop.label.end(), label)) /
           double(crop.label.size());
  };
  const double half_a_ball = 0.5 * (4.0 / 3.0 * kPi * 1.8 * 1.8 * 1.8) / 1200.0;
  EXPECT_NEAR(r.am_column() / 12.0, share(1), half_a_ball);
  // the porosity that the image has without its material's nanopores, to half a CBD sphere of 1.316 um
  EXPECT_NEAR(r.porosity_total, 1.0 - r.am_column() / 12.0 - 0.5 * share(kCbdLabel), 0.6 / 1200.0);
  EXPECT_NEAR(r.thickness(), 12.0, 1e-9);
  EXPECT_EQ(r.cell_x, 10.0);
}

TEST(ImageAsElectrode, BodiesLieWhereTheImageHasThem) {
  const Made m = made_of_image(kCell + kFine + kShapes + kPhases);
  ASSERT_EQ(m.bodies.bodies.size(), 4U); // the one outside is not there, the others once
  EXPECT_EQ(m.in.image->across, 1);
  EXPECT_EQ(m.in.image->cut, 1);
  for (size_t k = 0; k < m.bodies.bodies.size(); ++k) {
    const Eigen::Vector3d at = m.bodies.at[k] + Eigen::Vector3d(5.0, 5.0, 0.0);
    const auto same = std::find_if(kBalls.begin(), kBalls.end(), [&](const Ball &b) {
      const double dz = b.at.z() == 0.0 ? 3.0 / 8.0 * b.radius : 0.0; // of half a ball
      return (at - b.at - Eigen::Vector3d(0, 0, dz)).norm() < 0.5 * kVoxel;
    });
    ASSERT_NE(same, kBalls.end()) << at.transpose();
    const double whole = 4.0 / 3.0 * kPi * std::pow(same->radius, 3);
    EXPECT_NEAR(m.bodies.bodies[k].volume, same->at.z() == 0.0 ? 0.5 * whole : whole, 0.05 * whole);
  }
}

TEST(ImageAsElectrode, PrimariesFillTheShapeAsItLies) {
  const Made m = made_of_image(kCell + kFine + kShapes + kPhases);
  const auto flat = std::find_if(m.bodies.at.begin(), m.bodies.at.end(),
                                 [](const Eigen::Vector3d &x) { return x.z() < 1.5; });
  ASSERT_NE(flat, m.bodies.at.end());
  const Body &b = m.bodies.bodies[flat - m.bodies.at.begin()];
  for (const Eigen::Vector3d &p : b.primaries) {
    EXPECT_GT((*flat + p).z(), 0.0);
    EXPECT_LT((*flat + p - Eigen::Vector3d(6.5, 3.5, 0.0)).norm(), 2.1);
  }
}

TEST(ImageAsElectrode, CarbonBinderLiesInItsVoxels) {
  const Made m = made_of_image(kCell + kFine + kShapes + kPhases);
  ASSERT_GT(m.in.structure.cbd.size(), 50U);
  for (const ExistingSphere &s : m.in.structure.cbd) {
    EXPECT_GT(s.x.y(), 0.5);
    EXPECT_LT(s.x.y(), 1.5);
  }
}

TEST(ImageAsElectrode, CarbonBinderOfTheRecipeGoesIntoThePores) {
  const Made m =
      made_of_image(kCell + kFine + kShapes + "phases = { pore = 0, am = 1 }\n" +
                        "[composition]\ncarbon_weight_percent = 2\nbinder_weight_percent = 3\n",
                    false);
  EXPECT_FALSE(m.in.image->cbd_of_image);
  EXPECT_NEAR(m.in.recipe.am_weight, 0.95, 0.001);
  for (const ExistingSphere &s : m.in.structure.cbd)
    for (const Ball &b : kBalls)
      EXPECT_GT((s.x + Eigen::Vector3d(5, 5, 0) - b.at).norm(), 0.6 * b.radius);
}

// Requirement: an image whose film stands along another axis, or upside down, gives the same film.
TEST(ImageAsElectrode, AnyAxisMayLeadUpFromTheCollector) {
  const Recipe recipe = recipe_of_image(kCell + kFine + kShapes + kPhases);
  const PackInput right = read_input(recipe);
  const LabelImage image = read_label_image(recipe.shapes.image);
  // upwards, and what makes such an image of the right one: its inverse turn
  for (const auto &[upwards, inverse] :
       {std::pair("x", "y"), std::pair("y", "x"), std::pair("-z", "-z")}) {
    write_label_image(turned(image, inverse), recipe.shapes.image);
    Recipe other = recipe;
    other.shapes.upwards = upwards;
    const PackInput in = read_input(other);
    EXPECT_EQ(in.image->phases.label, right.image->phases.label) << upwards;
    EXPECT_EQ(in.structure.thickness, 12.0) << upwards;
  }
  const LabelImage down = turned(image, "-y");
  EXPECT_EQ(down.n, (std::array{48, 80, 80})); // the image's z, and its x and y backwards
  for (int k = 0; k < 80; ++k)
    for (int j = 0; j < 80; ++j)
      for (int i = 0; i < 48; ++i)
        ASSERT_EQ(down.at(i, j, k), image.at(80 - 1 - j, 80 - 1 - k, i));
}

TEST(ImageAsElectrode, MistakesAreNamed) {
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {kShapes + kPhases + "[cell]\nx_um = 30\n",
       "from -5 to 25 um along x; the image from 0 to 20"},
      {kCell + kShapes + kPhases + "crop.y_um = 6\n", "from 11 to 21 um along y"},
      {kCell + kShapes + kPhases + "crop.high_um = 15\n", "ends at 12 um"},
      {kCell + kShapes + kPhases + "upwards = \"-x\"\ncrop.high_um = 21\n", "ends at 20 um"},
      {kCell + kShapes + kPhases + "crop.low_um = 5\ncrop.high_um = 4\n", "above low_um, 5"},
      {"[shapes]\nimage = \"image.mha\"\ncrop.x_um = 1\n", "shapes.places = \"image\""},
      {"[shapes]\nimage = \"image.mha\"\nupwards = \"x\"\n", "shapes.upwards is of an image that"},
      {"[shapes]\nplaces = \"image\"\n", "shapes.image is missing"},
      {kCell + kShapes + kPhases + "[particles]\nmedian_um = 5\n",
       "no effect beside shapes.places"},
      {kCell + kShapes + kPhases + "[coating]\nloading_mg_cm2 = 3\n", "loading_mg_cm2 is 3"},
      {kCell + kShapes + "phases = { pore = 0, am = 1, cbd = 3 }\n", "labels 2 (4.8 %)"}};
  for (const auto &[lines, part] : wrong)
    EXPECT_NE(refusal_of_image(lines).find(part), std::string::npos) << part << " in\n"
                                                                     << refusal_of_image(lines);
}

TEST(ImageAsElectrode, ALabelBelowZeroIsNoParticle) {
  const Recipe recipe = recipe_of_image(kCell + kFine + kShapes);
  LabelImage image = read_label_image(recipe.shapes.image);
  std::replace(image.label.begin(), image.label.end(), 2, -1);
  write_label_image(image, recipe.shapes.image);
  expect_parts(refusal([&] { read_input(recipe); }), {"has the label -1; a particle's is above 0"});
}

double largest_overlap(const Recipe &r, const std::vector<Particle> &particles) {
  double most = 0.0;
  for (const Particle &p : particles)
    for (const Particle &q : particles)
      if (p.type == 1 && q.type == 1 && p.body < q.body)
        most = std::max(most, r.primary_diameter - periodic_difference(r, p.x, q.x).norm());
  return most;
}

TEST(ImageAsElectrode, OverlapsGoAndWhatIsFreeStays) {
  Made m = made_of_image(kCell + kFine + kShapes + kPhases);
  m.in.structure.cbd.clear();
  const PlacementOfStructure free = place_in_place(m.in.recipe, m.in.structure, m.bodies);
  EXPECT_LT(free.largest_move_um, 0.6); // off the bottom, where primaries stand out of the shape
  m.bodies.at[0] = m.bodies.at[1] + Eigen::Vector3d(9.0, 1.0, 0.5); // inside it across x
  const PlacementOfStructure apart = place_in_place(m.in.recipe, m.in.structure, m.bodies);
  EXPECT_LT(largest_overlap(m.in.recipe, apart.loose.particles),
            0.42 * 0.5);                 // what is left to LIGGGHTS
  EXPECT_LT(apart.largest_move_um, 4.2); // the sum of their radii
  for (const Particle &p : apart.loose.particles) {
    EXPECT_GT(p.x.z(), 0.5 - 0.01);
    EXPECT_LT(p.x.z(), m.in.recipe.thickness() - 0.5 + 0.01);
  }
}

TEST(ImageAsElectrode, WhatIsInPlaceIsCounted) {
  Made m = made_of_image(kCell + kFine + kShapes + kPhases);
  m.in.structure.cbd.clear();
  std::vector<Particle> there =
      place_in_place(m.in.recipe, m.in.structure, m.bodies).loose.particles;
  const auto in_place = [&] {
    return describe_image(m.in.recipe, *m.in.image, there)["am_in_place"].get<double>();
  };
  EXPECT_GT(in_place(), 0.8);
  for (Particle &p : there)
    p.x = in_cell(m.in.recipe, p.x + Eigen::Vector3d(5.0, 5.0, 0.0));
  EXPECT_LT(in_place(), 0.2);
}

} // namespace
