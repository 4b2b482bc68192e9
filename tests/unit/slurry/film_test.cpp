// SPDX-License-Identifier: GPL-2.0-or-later
// The slurry of a recipe: volumes and densities by hand, spheres that keep its mass, mixing,
// checks.
#include "electrode/pack/body.h"
#include "electrode/pack/packing_state.h"
#include "electrode/slurry/dry.h"
#include "physics/pi.h"
#include "support/test_folder.h"
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

FilmRecipe film_of(const std::string &lines) {
  const std::filesystem::path file = calendem_test::test_folder() / "film.toml";
  std::ofstream(file) << lines;
  return read_film_recipe(file.string());
}
const char *const kPaper = "[particles]\nmax_um = 4.5\n[cell]\nx_um = 10\ny_um = 10\n";

std::string mistakes_of(const std::string &lines) {
  try {
    film_of(lines);
  } catch (const Failure &e) {
    EXPECT_EQ(e.exit_status(), kBadInput);
    return e.what();
  }
  return "";
}

// 17.46 mg/cm2 at 69 % solids hold 7.8443 mg/cm2 of NMP: 76.307 um. Solids: 36.046 + 3.816 um.
TEST(Slurry, VolumesByHand) {
  const FilmRecipe f = film_of(kPaper);
  EXPECT_NEAR(f.solvent_column(), 76.307, 1e-3);
  EXPECT_NEAR(f.slurry_thickness(), 116.169, 2e-3);
  EXPECT_NEAR(f.slurry_density(), 253.043 / 116.169, 1e-4); // 25.3043 mg/cm2
}

// AM and swollen CBD fill the stated fraction, and the CBD's solid does not change by swelling.
TEST(Slurry, SwollenCbdFillsAndKeepsItsSolid) {
  const FilmRecipe f = film_of(kPaper);
  const double wet = cbd_count(f.recipe) * kPi / 6.0 * std::pow(f.wet_diameter(), 3);
  const double am = f.recipe.am_column() * f.recipe.area();
  EXPECT_NEAR((am + wet) / (f.slurry_thickness() * f.recipe.area()), 0.55, 5e-4); // whole spheres
  const double dry_volume = kPi / 6.0 * std::pow(f.recipe.cbd_diameter, 3);
  const double wet_volume = kPi / 6.0 * std::pow(f.wet_diameter(), 3);
  const double solvent = f.wet_density() * wet_volume - cbd_density(f.recipe) * dry_volume;
  EXPECT_NEAR(solvent / f.solvent_density, wet_volume - 0.5 * dry_volume, 1e-9);
}

TEST(Slurry, SpheresHaveTheRecipesMassAndDoNotOverlap) {
  const FilmRecipe f = film_of(kPaper);
  const std::vector<int> counts = draw_counts(f.recipe);
  const Placement p = place_spheres(f, counts);
  ASSERT_EQ(p.particles.size(), counts.size() + cbd_count(f.recipe));
  double volume = 0.0, nearest = HUGE_VAL;
  for (size_t i = 0; i < p.particles.size(); ++i) {
    const Particle &a = p.particles[i];
    EXPECT_EQ(a.tag, int(i) + 1);
    if (a.type == 1)
      volume += kPi / 6.0 * std::pow(a.diameter, 3);
    EXPECT_GE(a.x.z(), 0.5 * a.diameter);
    EXPECT_LE(a.x.z(), p.height - 0.5 * a.diameter);
    for (size_t j = 0; j < i; ++j)
      nearest = std::min(nearest, periodic_difference(f.recipe, a.x, p.particles[j].x).norm() -
                                      0.5 * (a.diameter + p.particles[j].diameter));
  }
  EXPECT_GE(nearest, 0.0);
  const double wanted = f.recipe.am_column() * f.recipe.area();
  EXPECT_NEAR(volume, wanted, 0.5 * std::pow(f.recipe.lattice, 3) * (1.0 + 1e-9));
}

TEST(Slurry, MixingIndexOfKnownMixtures) {
  std::vector<Particle> particles;
  for (int k = 0; k < 400; ++k) {
    Particle p;
    p.x.z() = 0.1 * k + 0.05;
    p.type = k < 200 ? 1 : 2;
    particles.push_back(p);
  }
  EXPECT_NEAR(mixing_index(particles, 40.0, 8), 0.0, 1e-12); // parted
  for (int k = 0; k < 400; ++k)
    particles[k].type = 1 + k % 2; // even: better than random by sr^2/(s0^2 - sr^2) = 1/49
  EXPECT_NEAR(mixing_index(particles, 40.0, 8), 1.0 + 1.0 / 49.0, 1e-12);
}

TEST(Slurry, MistakesOfTheFileAreReported) {
  const std::string cell = kPaper;
  EXPECT_NE(mistakes_of(cell + "[slurry]\nsphere_fraction = 0.3\n").find("dry spheres fill 0.376"),
            std::string::npos);
  EXPECT_NE(mistakes_of(cell + "[slurry]\nsolid_content_percent = 0.69\n").find("0.69"),
            std::string::npos);
  EXPECT_NE(mistakes_of(cell + "[drying]\nstop = \"porosity\"\n").find("thickness"),
            std::string::npos);
  EXPECT_NE(mistakes_of(cell + "[effects.cbd_gradient]\nslope = 0.3\n").find("where it dries"),
            std::string::npos);
  EXPECT_NE(mistakes_of(cell + "[structure]\nfile = \"x\"\n").find("structure"), std::string::npos);
  EXPECT_NE(mistakes_of(cell + "[composition]\nam_weight_percent = 100\ncarbon_weight_percent = "
                               "0\nbinder_weight_percent = 0\n"),
            "");
}

// A film of known spheres: 1 - solid/(area thickness), and what is reported when it is not the
// recipe's.
TEST(DriedFilm, PorosityOfKnownSpheresAndItsCheck) {
  const FilmRecipe f = film_of(kPaper);
  Placement p = place_spheres(f, draw_counts(f.recipe));
  const double squeeze = f.recipe.thickness() / p.height;
  double low = HUGE_VAL, high = 0.0;
  for (Particle &s : p.particles) {
    s.x.z() *= squeeze;
    low = std::min(low, s.x.z() - 0.5 * s.diameter);
    high = std::max(high, s.x.z() + 0.5 * s.diameter);
  }
  const LastRow stop{f.recipe.thickness(), 0.02, 0.0}, end;
  nlohmann::json j = describe_film(f, p.particles, stop, end);
  const double solid = (f.recipe.am_column() + f.recipe.cbd_solid_column()) / (high - low);
  EXPECT_NEAR(j["porosity_total"].get<double>(), 1.0 - solid, 3e-4); // whole spheres
  EXPECT_EQ(j["stopped_by"], "thickness");
  EXPECT_NO_THROW(check_film(j, f, "film"));
  j["porosity_difference_points"] = -1.01 * f.tolerance_points;
  EXPECT_THROW(check_film(j, f, "film"), Failure);
  j["porosity_difference_points"] = 0.0;
  j["mixing_index"] = 0.5;
  EXPECT_THROW(check_film(j, f, "film"), Failure);
}

// What a script leaves is taken only if every particle is there once and has its size.
TEST(DriedFilm, StateOfADumpIsChecked) {
  const FilmRecipe f = film_of(kPaper);
  const std::string dump = (calendem_test::test_folder() / "a.dump").string();
  const std::vector<Particle> two = {{1, 1, 4.0, 4.65, {1, 1, 1}, 0},
                                     {2, 2, 1.316, 0.9, {5, 5, 5}, 0}};
  const auto read = [&](const std::string &rows) {
    std::ofstream(dump) << "ITEM: ATOMS id x y z radius\n" << rows;
    std::vector<Particle> particles = two;
    read_state(f, dump, particles);
    return particles;
  };
  EXPECT_DOUBLE_EQ(read("2 11 3 4 0.658\n1 -1 2 3 2\n")[0].x.x(),
                   9.0); // back into the cell of 10 um
  for (const char *wrong :
       {"1 1 2 3 2\n", "1 1 2 3 2\n1 1 2 3 2\n2 1 3 4 0.658\n", "1 1 2 3 2\n2 1 3 4 1.0\n"})
    try {
      read(wrong);
      ADD_FAILURE() << wrong;
    } catch (const Failure &e) {
      EXPECT_EQ(e.exit_status(), kSimulationFailed);
    }
}

} // namespace
} // namespace calendem
