// SPDX-License-Identifier: GPL-2.0-or-later
// From phases to particles: necks whose width is known, a synthetic tomogram whose particles are.
#include "electrode/pack/measured_bodies.h"
#include "electrode/structure/measured_shape.h"
#include "electrode/structure/separated_particles.h"
#include "electrode/structure/slices.h"
#include "electrode/tomogram.h"
#include "support.h"
#include <fmt/format.h>
#include <map>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPointData.h>

namespace {
using namespace calendem;
using namespace calendem_test;
namespace fs = std::filesystem;

constexpr PhaseLabels kBinary{0, 1, 0};

// Two balls of R voxels whose centres are `apart` voxels from each other.
LabelImage two_balls(double R, double apart) {
  LabelImage image = empty_image(60, 32, 32, 0.5);
  add_sphere(image, {30 - 0.5 * apart, 16, 16}, R, 1);
  add_sphere(image, {30 + 0.5 * apart, 16, 16}, R, 1);
  return image;
}

int particles_in(const LabelImage &image) { return int(find_regions(image, 0).size()); }

// Their neck is a circle of radius sqrt(R^2 - L^2/4). A distance on voxels is half a voxel wrong at
// most, so the ratio (neck + 1)/(R + 1) is known to 0.5 (1 + ratio)/(R + 1).
TEST(SeparatedParticles, TheNeckDecides) {
  const double R = 12.0, apart = 18.0;
  const double ratio = (std::sqrt(R * R - 0.25 * apart * apart) + 1.0) / (R + 1.0);
  const double error = 0.5 * (1.0 + ratio) / (R + 1.0);
  const LabelImage image = two_balls(R, apart);
  EXPECT_EQ(particles_in(separate_particles(image, kBinary, ratio - error)), 1);
  EXPECT_EQ(particles_in(separate_particles(image, kBinary, ratio + error)), 2);
}

// The cut is the plane between them: the halves differ by half a layer of the neck at most, to
// either side.
TEST(SeparatedParticles, EqualBallsAreCutInEqualParts) {
  const double R = 12.0, apart = 20.0;
  const LabelImage image = two_balls(R, apart);
  const LabelImage particles = separate_particles(image, kBinary, 0.9);
  const std::vector<Region> parts = find_regions(particles, 0);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_LE(std::labs(parts[0].voxels - parts[1].voxels),
            long(kPi * (R * R - 0.25 * apart * apart)));
  EXPECT_LT(parts[0].low[0], parts[1].low[0]); // numbered from the first voxel on
  for (size_t p = 0; p < image.label.size(); ++p)
    EXPECT_EQ(particles.label[p] > 0, image.label[p] == 1);
}

// Balls above each other, slices twice as far apart as their voxels are wide: the ratio 0.69 of their neck is
// known to 0.13 by half a slice. Counted in voxels the balls would be flatter than their neck is wide.
TEST(SeparatedParticles, SidesOfAVoxelMayDiffer) {
  LabelImage image = empty_image(32, 32, 30, 0.5);
  image.voxel.z() = 1.0;
  for (int k = 0; k < 30; ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i)
        for (const double z : {10.5, 19.5})
          if (Eigen::Vector3d(i - 15.5, j - 15.5, 2.0 * (k + 0.5 - z)).norm() < 12.0)
            image.label[image.index(i, j, k)] = 1;
  EXPECT_EQ(particles_in(separate_particles(image, kBinary, 0.55)), 1);
  EXPECT_EQ(particles_in(separate_particles(image, kBinary, 0.85)), 2);
}

TEST(SeparatedParticles, AParticleIsNotCutAtItsPores) {
  LabelImage image = empty_image(40, 40, 40, 0.5);
  add_sphere(image, {20, 20, 20}, 15, 1);
  add_sphere(image, {14, 20, 20}, 4, 0);
  add_sphere(image, {26, 22, 20}, 3, 0);
  const LabelImage particles = separate_particles(image, kBinary, 0.95);
  EXPECT_EQ(particles_in(particles), 1);
  EXPECT_EQ(particles.at(14, 20, 20), 0);
}

// Share of the whole true particles that one separated particle covers, and is covered by, to more
// than two thirds.
double found_again(const LabelImage &truth, const LabelImage &particles) {
  std::map<std::int32_t, std::map<std::int32_t, long>> shared;
  std::map<std::int32_t, long> of_particle;
  for (size_t p = 0; p < truth.label.size(); ++p) {
    ++of_particle[particles.label[p]];
    if (truth.label[p] > 0)
      ++shared[truth.label[p]][particles.label[p]];
  }
  int found = 0, whole = 0;
  for (const Region &r : find_regions(truth, 0)) {
    if (r.cut || r.voxels < kFewestVoxels)
      continue;
    ++whole;
    for (const auto &[label, voxels] : shared[r.label])
      found += 3 * voxels > 2 * r.voxels && 3 * voxels > 2 * of_particle[label];
  }
  return double(found) / whole;
}

// Irregular particles with pores and ragged borders, most of them pushed against another: more than
// nine of ten come back, at every neck near the default.
TEST(SeparatedParticles, ThoseOfATomogramAreFoundAgain) {
  const std::string file = (test_folder() / "tomogram.toml").string();
  std::ofstream(file) << "[image]\nx_um = 28\ny_um = 28\nz_um = 28\n";
  const LabelImage truth = make_tomogram(read_tomogram_spec(file)).image;
  LabelImage phases = truth;
  for (std::int32_t &label : phases.label)
    label = label > 0;
  for (const double neck : {0.8, 0.9})
    EXPECT_GT(found_again(truth, separate_particles(phases, kBinary, neck)), 0.9) << neck;
}

TEST(SeparatedParticles, PhasesThatTheImageDoesNotHaveAreNamedAtOnce) {
  LabelImage image = two_balls(5, 12);
  image.file = "phases.tif";
  image.label[0] = 7;
  expect_parts(refusal([&] {
                 separate_particles(image, {0, 2, 3}, 0.9);
               }),
               {"phases.tif: the labels 1 (", ", 7 (",
                "none of shapes.phases (pore 0, am 2, cbd 3)",
                "no voxel has the label 2 of shapes.phases.am", "leave cbd out"});
}

TEST(SeparatedParticles, TheRecipesPhasesAreChecked) {
  const std::string file = (test_folder() / "recipe.toml").string();
  const auto said = [&](const std::string &lines) {
    std::ofstream(file) << "[shapes]\n" << lines;
    return refusal([&] { read_recipe(file); });
  };
  write_label_image(two_balls(12, 20), (test_folder() / "phases.tif").string());
  const std::string image = "image = \"phases.tif\"\n";
  expect_parts(said(image + "phases = { pore = 1, am = 1 }\nbackground = 1\n"
                            "neck = 1.0\n"),
               {"neck is 1", "0.5 to 0.99"});
  expect_parts(said(image + "phases = { pore = 0, cbd = 2 }\n"),
               {"recipe.toml:3: shapes.phases.am is 0, as shapes.phases.pore"});
  expect_parts(said(image + "phases = { pore = 0, am = 2, cbd = 2 }\nbackground = 0\n"),
               {"am and cbd are both 2", "shapes.background is for images of particles"});
  expect_parts(said("phases = { am = 2 }\n"), {"shapes.image, which is missing"});
}

TEST(SeparatedParticles, WhatShowsThemIsWritten) {
  const fs::path folder = test_folder();
  write_label_image(two_balls(12, 20), (folder / "phases.tif").string());
  std::ofstream(folder / "recipe.toml")
      << "[shapes]\nimage = \"phases.tif\"\nphases = { pore = 0, am = 1 }\nneck = 0.9\n";
  write_shapes(read_recipe((folder / "recipe.toml").string()), (folder / "out").string());
  const fs::path shapes = folder / "out/shapes";
  EXPECT_EQ(read_library(shapes.string()).shapes.size(), 2u);
  EXPECT_EQ(particles_in(read_label_image((shapes / "particles.tif").string())), 2);
  EXPECT_EQ(bytes_of(shapes / "slices.png").substr(1, 3), "PNG");
  const std::string necks = bytes_of(shapes / "necks.csv");
  expect_parts(necks, {"\n0.85,2,2,0,0,", "\n0.9,2,2,0,0,", "\n0.95,2,2,0,0,"});
}

std::map<std::string, long> colours_of(const std::string &file) {
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkDataArray &values = *reader->GetOutput()->GetPointData()->GetScalars();
  std::map<std::string, long> out;
  for (vtkIdType p = 0; p < values.GetNumberOfTuples(); ++p)
    ++out[fmt::format("{} {} {}", values.GetComponent(p, 0), values.GetComponent(p, 1),
                      values.GetComponent(p, 2))];
  return out;
}

// The middle slice of a ball: outlines of whole particles are red, of those that are cut blue.
TEST(SeparatedParticles, OutlinesTellWholeFromCutOnes) {
  for (const bool cut : {false, true}) {
    LabelImage image = empty_image(60, 32, 32, 0.5);
    add_sphere(image, {cut ? 4.0 : 20.0, 16, 16}, 8, 1);
    const std::string file = (test_folder() / "slices.png").string();
    draw_particles(image, kBinary, image, file);
    const std::map<std::string, long> pixels = colours_of(file);
    EXPECT_EQ(pixels.count("200 30 30"), cut ? 0u : 1u);
    EXPECT_EQ(pixels.count("30 90 200"), cut ? 1u : 0u);
    EXPECT_GT(pixels.at("200 200 200"), pixels.at(cut ? "30 90 200" : "200 30 30"));
  }
}

} // namespace
