// SPDX-License-Identifier: GPL-2.0-or-later
// The whole way: a synthetic tomogram with known particles, its file, the shapes, the bodies.
#include "electrode/pack/measured_bodies.h"
#include "electrode/tomogram.h"
#include "support.h"
#include <cmath>
#include <nlohmann/json.hpp>

namespace {
using namespace calendem;
using namespace calendem_test;

TomogramSpec tomogram_of(const std::string &lines) {
  const std::string file = (test_folder() / "tomogram.toml").string();
  std::ofstream(file) << lines;
  return read_tomogram_spec(file);
}

struct Errors {
  int particles = 0;
  double mean_volume = 0.0, worst_volume = 0.0, worst_diameter = 0.0;
};

// Through the file, as a user's image comes.
Errors recover(const Tomogram &t, ShapeLibrary &library) {
  const std::string file = (test_folder() / "image.mhd").string();
  write_label_image(t.image, file);
  library = make_library(read_label_image(file), 0, file);
  Errors e;
  for (const MeasuredShape &s : library.shapes) {
    const TrueParticle &truth = t.truth.at(s.label - 1);
    const double dv = s.volume / truth.volume - 1.0;
    e.mean_volume += dv / double(library.shapes.size());
    e.worst_volume = std::max(e.worst_volume, std::fabs(dv));
    e.worst_diameter = std::max(e.worst_diameter,
                                std::fabs(s.equivalent_diameter / truth.equivalent_diameter - 1.0));
    ++e.particles;
  }
  return e;
}

class Tomograms : public testing::TestWithParam<const char *> {};

TEST_P(Tomograms, VolumesAndDiametersAreRecoveredWithinThreePercent) {
  const Tomogram t = make_tomogram(tomogram_of(GetParam()));
  ShapeLibrary library;
  const Errors e = recover(t, library);
  RecordProperty("worst_volume_error", std::to_string(e.worst_volume));
  EXPECT_GE(e.particles, 3);
  EXPECT_LT(e.worst_volume, 0.03);
  EXPECT_LT(e.worst_diameter, 0.01);
  EXPECT_LT(std::fabs(e.mean_volume), 0.01);
  double pores = 0.0;
  for (const MeasuredShape &s : library.shapes)
    pores += s.closed_pore_fraction;
  EXPECT_GT(pores, 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    BothResolutions, Tomograms,
    testing::Values("seed = 1\n[image]\nvoxel_um = 0.3\n",
                    "seed = 2\n[image]\nvoxel_um = 0.041\nx_um = 10\ny_um = 10\nz_um = 10\n"
                    "[particles]\nmax_um = 4.5\n"));

TEST(Tomogram, SameSpecSameVoxels) {
  const std::string lines = "[image]\nx_um = 12\ny_um = 12\nz_um = 12\n";
  EXPECT_EQ(make_tomogram(tomogram_of(lines)).image.label,
            make_tomogram(tomogram_of(lines)).image.label);
  EXPECT_NE(make_tomogram(tomogram_of(lines)).image.label,
            make_tomogram(tomogram_of("seed = 5\n" + lines)).image.label);
}

TEST(Tomogram, MistakesOfItsSpecAreNamed) {
  expect_parts(refusal([] { tomogram_of("[image]\nvoxel_um = 9\nxum = 3\n"); }),
               {"image.voxel_um is 9", "image.xum", "image.x_um"});
  expect_parts(refusal([] { tomogram_of("[particles]\nmin_um = 12\n"); }), {"12", "max_um"});
  expect_parts(refusal([] { tomogram_of("[particles]\npores = 2.7\n"); }),
               {"particles.pores is 2.7", "whole number"});
  expect_parts(refusal([] { tomogram_of("[image]\nvoxel_um = 0.3\n[particles]\nmin_um = 0.5\n"); }),
               {"0.5", "two voxels of 0.3 um"});
  expect_parts(refusal([] { tomogram_of("[image]\nvoxel_um = 0.01\n"); }), {"2.7e+10", "1e9"});
}

Recipe recipe_of_cell(double side) {
  const std::string file = (test_folder() / "recipe.toml").string();
  std::ofstream(file) << "[cell]\nx_um = " << side << "\ny_um = " << side << "\n";
  return read_recipe(file);
}

void expect_loading_and_width(const Recipe &recipe, const std::vector<Body> &bodies) {
  double volume = 0.0;
  for (const Body &b : bodies) {
    volume += b.volume;
    EXPECT_LE(b.width, 14.0);
    EXPECT_FALSE(b.shape.empty());
  }
  const double wanted = recipe.area() * recipe.am_column();
  EXPECT_NEAR(volume, wanted, 0.5 * std::pow(recipe.lattice, 3) + 1e-9);
}

void expect_same_bodies_again(const Recipe &recipe, const ShapeLibrary &library) {
  const std::vector<Body> once = make_bodies(recipe, library), again = make_bodies(recipe, library);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t k = 0; k < once.size(); ++k)
    EXPECT_EQ(once[k].primaries, again[k].primaries);
}

// One body's volume is rounded to whole lattice cells; D10-D90 then agree within 5 %.
void expect_measured_sizes(const Recipe &recipe, const ShapeLibrary &library,
                           const std::vector<Body> &bodies) {
  const nlohmann::json j = describe_shapes(recipe, library, bodies);
  for (const char *q : {"D10", "D50", "D90"})
    EXPECT_NEAR(j["volume_percentiles_packed_um"][q].get<double>() /
                    j["volume_percentiles_measured_um"][q].get<double>(),
                1.0, 0.06)
        << q;
}

// Primaries lie where the scaled shape is: their hull has its reach in every direction.
void expect_form_of_its_shape(Recipe recipe, const ShapeLibrary &library) {
  recipe.lattice = 0.5;
  recipe.primary_diameter = 0.62;
  Random random(1, 2);
  const double D = library.shapes.back().equivalent_diameter;
  const int count = int(kPi / 6.0 * std::pow(D / recipe.lattice, 3));
  const Body b = make_body(recipe, library, count, random);
  const MeasuredShape *shape = nullptr;
  for (const MeasuredShape &s : library.shapes)
    if (s.name == b.shape)
      shape = &s;
  ASSERT_NE(shape, nullptr);
  const double scale = D / shape->equivalent_diameter;
  EXPECT_NEAR(b.reach, scale * shape->reach, 0.08 * b.reach);
  int outside = 0;
  for (const Eigen::Vector3d &p : b.primaries)
    outside += shape->depth_at(p / scale) * scale > recipe.lattice;
  EXPECT_EQ(outside, 0);
}

// One image for all: to measure it takes most of the time.
TEST(FromImage, BodiesHaveItsSizesAndFormsAndFillTheLoading) {
  ShapeLibrary library;
  recover(make_tomogram(tomogram_of("seed = 1\n[image]\nx_um = 24\ny_um = 24\nz_um = 24\n")),
          library);
  const Recipe recipe = recipe_of_cell(30);
  const std::vector<Body> bodies = make_bodies(recipe, library);
  expect_loading_and_width(recipe, bodies);
  expect_same_bodies_again(recipe_of_cell(10), library);
  expect_measured_sizes(recipe, library, bodies);
  expect_form_of_its_shape(recipe, library);
}

TEST(RecipeShapes, MistakesOfTheSectionAreNamedAtOnce) {
  const std::string file = (test_folder() / "recipe.toml").string();
  std::ofstream(file) << "[shapes]\nimage = \"no.mhd\"\nlibrary = \"nowhere\"\nbackground = 0.5\n";
  expect_parts(refusal([&] { read_recipe(file); }),
               {"both", "no.mhd' is not there", "nowhere' is not there", "background is 0.5"});
  std::ofstream(file) << "[shapes]\nsizes = \"mine\"\n";
  expect_parts(refusal([&] { read_recipe(file); }), {"recipe.toml:2", "measured|recipe"});
}

} // namespace
