// SPDX-License-Identifier: GPL-2.0-or-later
// Powders given by percentiles of volume.
#include "base/particle_sizes.h"
#include "electrode/pack/body.h"
#include "support.h"
#include "support/refusal.h"
#include <cmath>

namespace {

using namespace calendem;

std::string message(const std::string &particles) {
  return calendem_test::refusal([&] { calendem_test::recipe_of("[particles]\n" + particles); });
}

/// The law's diameter at a share of the volume, without limits of size.
double at_volume(const Recipe &r, double share) {
  return SizeLaw{r.median, r.sigma_ln, 1e-3, 1e3}.volume_quantile(share);
}

// Requirement: any two percentiles come out as they went in. 1e-5: the settings keep six digits.
TEST(SizesByVolume, AnyTwoFixTheLaw) {
  for (const char *given : {"d10_volume_um = 4.8\nd50_volume_um = 8\n",
                            "d50_volume_um = 8\nd90_volume_um = 13.3333333\n",
                            "d10_volume_um = 4.8\nd90_volume_um = 13.3333333\n"}) {
    const Recipe r = calendem_test::recipe_of(std::string("[particles]\n") + given);
    EXPECT_NEAR(at_volume(r, 0.1), 4.8, 5e-5) << given;
    EXPECT_NEAR(at_volume(r, 0.5), 8.0, 8e-5) << given;
    EXPECT_NEAR(at_volume(r, 0.9), 13.3333, 2e-4) << given;
  }
}

// Requirement: a D50 with a width; a powder of D50 9 um is one of 4.4 um by number.
TEST(SizesByVolume, OneAndAWidth) {
  const Recipe r = calendem_test::recipe_of("[particles]\nd50_volume_um = 9\nsigma_ln = 0.487\n");
  EXPECT_NEAR(r.median, 9.0 * std::exp(-3.0 * 0.487 * 0.487), 1e-4);
  EXPECT_EQ(r.sigma_ln, 0.487);
  EXPECT_NE(sizes_in_words(r).find("D50 9 um by volume"), std::string::npos) << sizes_in_words(r);
}

// Requirement: three percentiles near to one law are taken, the paper's own among them.
TEST(SizesByVolume, ThreeMustAgree) {
  const Recipe r = calendem_test::recipe_of("[particles]\nd10_volume_um = 4.8\nd50_volume_um = 9\n"
                                            "d90_volume_um = 13.6\n");
  EXPECT_NEAR(at_volume(r, 0.5), std::cbrt(4.8 * 9.0 * 13.6), 1e-3);
  calendem_test::expect_parts(
      message("d10_volume_um = 3\nd50_volume_um = 9\nd90_volume_um = 13.6\n"),
      {"recipe.toml:4:", "one lognormal law", "10 %"});
}

TEST(SizesByVolume, WhatContradictsIsRefused) {
  calendem_test::expect_parts(
      message("d50_volume_um = 9\nmedian_um = 4.4\n"),
      {":2:", "by volume, and particles.median_um = 4.4 by number", "Give one of them"});
  calendem_test::expect_parts(message("d50_volume_um = 9\nd90_volume_um = 13\nsigma_ln = 0.4\n"),
                              {":3:", "particles.sigma_ln = 0.4 gives it again"});
  calendem_test::expect_parts(message("d10_volume_um = 9\nd90_volume_um = 8\n"),
                              {":3:", "D10 < D50 < D90"});
  calendem_test::expect_parts(message("d50_volume_um = 20\nsigma_ln = 0.3\n"),
                              {":2:", "above particles.max_um = 16.2", "D90 is 29.4"});
  calendem_test::expect_parts(message("d10_volume_um = 0.2\nd90_volume_um = 9\n"),
                              {"not allowed", "particles.sigma_ln is 1.48"});
}

// Requirement: the law, not how it was given, makes a packing another.
TEST(SizesByVolume, SettingsHoldTheLawOnly) {
  const Recipe r =
      calendem_test::recipe_of("[particles]\nd10_volume_um = 4.8\nd90_volume_um = 13.3333333\n");
  for (const Key &key : volume_percentile_keys())
    EXPECT_EQ(r.settings.text(key.name), "0");
  EXPECT_EQ(r.settings.number("particles.median_um"), r.median);
}

} // namespace
