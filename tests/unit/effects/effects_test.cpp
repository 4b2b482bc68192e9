// SPDX-License-Identifier: GPL-2.0-or-later
// The table of effects against the case's keys and the files it names.
#include "base/case.h"
#include "base/messages.h"
#include "base/recipe.h"
#include "base/registry.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <set>

namespace {

using namespace calendem;
namespace fs = std::filesystem;

const fs::path kSource = CALENDEM_SOURCE_DIR;

const Key *key_named(const Effect &e, const std::string &name) {
  const std::vector<Key> &keys = e.in_recipe ? recipe_keys() : case_keys();
  const auto at =
      std::find_if(keys.begin(), keys.end(), [&](const Key &k) { return k.name == name; });
  return at == keys.end() ? nullptr : &*at;
}

TEST(Effects, NamesAreUnique) {
  std::set<std::string> names;
  for (const Effect &e : effects())
    EXPECT_TRUE(names.insert(e.name).second) << e.name;
  EXPECT_GE(names.size(), 8u);
}

TEST(Effects, OffIsTheDefaultOfTheBaseModel) {
  for (const Effect &e : effects())
    for (const std::string &name : e.parameter.keys) {
      const Key *key = key_named(e, name);
      ASSERT_TRUE(key) << e.name << ": " << name;
      EXPECT_EQ(key->fallback, e.parameter.off) << name;
    }
}

TEST(Effects, RangesAreAllowedByTheCaseOrTheRecipe) {
  for (const Effect &e : effects()) {
    const EffectParameter &a = e.parameter;
    EXPECT_LT(a.low, a.high) << e.name;
    EXPECT_TRUE(a.spread == Spread::Uniform || a.low > 0.0) << e.name;
    for (const std::string &name : a.keys)
      for (const double v : {a.low, a.high})
        EXPECT_FALSE(wrong_number(*key_named(e, name), v)) << e.name;
  }
}

TEST(Effects, AmplitudesAreZeroWhenOffAndLeadBackToTheValue) {
  for (const Effect &e : effects()) {
    const EffectParameter &a = e.parameter;
    EXPECT_EQ(a.amplitude(std::stod(a.off)), 0.0) << e.name;
    EXPECT_EQ(a.value(0.0), std::stod(a.off)) << e.name;
    for (const double v : {a.low, a.high}) {
      EXPECT_NEAR(a.value(a.amplitude(v)), v, 1e-12 * std::fabs(v)) << e.name;
      EXPECT_NE(a.amplitude(v), 0.0) << e.name;
    }
  }
}

TEST(Effects, LawAndVerificationAreThere) {
  for (const Effect &e : effects()) {
    EXPECT_TRUE(fs::exists(kSource / "src_plugin/physics" / e.law)) << e.name;
    const bool bare = e.verification.find('/') == std::string::npos;
    EXPECT_TRUE(fs::exists(kSource / "tests" / (bare ? "verification" : "") / e.verification))
        << e.name;
    EXPECT_FALSE(e.moves.empty() || e.source.empty() || e.what.empty()) << e.name;
  }
}

TEST(Effects, AnUnknownNameIsAnsweredWithTheClosest) {
  try {
    find_effect("frictoin");
    FAIL();
  } catch (const Failure &e) {
    EXPECT_NE(std::string(e.what()).find("Did you mean 'friction'"), std::string::npos);
  }
}

} // namespace
