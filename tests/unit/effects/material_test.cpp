// SPDX-License-Identifier: GPL-2.0-or-later
// Files of materials: what they hold, what stands above and below them, what is refused.
#include "base/case.h"
#include "base/material.h"
#include "base/provenance.h"
#include "base/recipe.h"
#include "support/refusal.h"
#include "support/test_folder.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using namespace calendem;

const std::string kHead = "name = \"mine\"\nalso_called = []\ncalibrated_on = []\n";

/// Files in a folder of the test.
class Materials : public testing::Test {
protected:
  const std::filesystem::path folder_ = calendem_test::test_folder();

  std::string written(const std::string &name, const std::string &text) const {
    const std::filesystem::path file = folder_ / name;
    std::filesystem::create_directories(file.parent_path());
    write_file(file.string(), text);
    return file.string();
  }
  std::string refused(const std::string &text) const {
    const std::string file = written("mine.toml", text);
    return calendem_test::refusal([&] { read_material(file); });
  }
};

// Requirement: every number of a shipped material has its source.
TEST_F(Materials, ShippedOnesAreWholeAndTraced) {
  const std::vector<std::string> known = known_materials();
  for (const char *wanted : {"nmc111", "nmc622", "nmc811", "xu2023"})
    EXPECT_EQ(std::count(known.begin(), known.end(), wanted), 1) << wanted;
  for (const std::string &name : known) {
    const ReferenceMaterial m = read_material(material_path(name, ""));
    EXPECT_FALSE(m.values.empty());
    for (const auto &[key, v] : m.values)
      EXPECT_GT(v.source.size(), 3u) << name << " " << key;
  }
}

// Requirement: the paper's material is the keys' fallbacks, each of them that is not another key's.
TEST_F(Materials, ThePaperSIsWhatKeysFallBackTo) {
  const ReferenceMaterial m = read_material(material_path("xu2023", ""));
  for (const bool of_recipe : {false, true})
    for (const Key &key : of_recipe ? recipe_keys() : case_keys()) {
      const auto at = m.values.find(key.name);
      if (at == m.values.end()) {
        EXPECT_TRUE(!describes_material(key, of_recipe) || !key.same_as.empty() ||
                    key.name.rfind("effects.", 0) == 0)
            << key.name;
        continue;
      }
      if (wants_text(key))
        EXPECT_EQ(at->second.text, key.fallback);
      else
        EXPECT_EQ(std::stod(at->second.text), std::stod(key.fallback)) << key.name;
    }
}

// Requirement: fallback < material < recipe, and a recipe's own file is found beside it.
TEST_F(Materials, ARecipeTakesTheValuesThatItDoesNotGive) {
  written("mine.toml", kHead + "[density]\nam_g_cm3 = { value = 2.24, source = \"a\" }\n"
                               "[cbd]\nnanoporosity_percent = { value = 40, source = \"b\" }\n");
  const Recipe r = read_recipe(
      written("recipe.toml", "material = \"mine.toml\"\n[cbd]\nnanoporosity_percent = 45\n"));
  EXPECT_EQ(r.am_density, 2.24);
  EXPECT_EQ(r.nanoporosity, 0.45);
  EXPECT_EQ(r.cbd_solid_density, 1.83);
  EXPECT_EQ(r.material.name, "mine");
}

// Requirement: a case has the values of its electrode's material where it gives none, and a bond
// those of its particles.
TEST_F(Materials, ACaseTakesThoseOfItsElectrode) {
  const std::string file = written(
      "mine.toml", kHead + "[material.am]\nyoungs_modulus_GPa = { value = 100, sd = 9, "
                           "source = \"a\" }\nfriction = { value = 0.3, source = \"b\" }\n");
  const nlohmann::ordered_json electrode = {{"material", to_json(read_material(file))}};
  written("film/electrode.json", electrode.dump());
  const Settings s =
      read_case(written("case.toml", "electrode = \"film\"\n[material.am]\nfriction = 0.4\n"));
  EXPECT_EQ(s.number("material.am.youngs_modulus_GPa"), 100.0);
  EXPECT_EQ(s.number("bond.youngs_modulus_GPa"), 100.0);
  EXPECT_EQ(s.number("material.am.friction"), 0.4);
  EXPECT_EQ(s.number("material.cbd.friction"), 0.001);
  const ReferenceMaterial again = material_of_electrode((folder_ / "film").string());
  EXPECT_EQ(again.hash(), read_material(file).hash());
}

// Requirement: an electrode of an older version, without a material, is pressed as it was.
TEST_F(Materials, AnElectrodeWithoutOneHasTheFallbacks) {
  written("film/electrode.json", "{\"bodies\": 3}");
  const Settings s = read_case(written("case.toml", "electrode = \"film\"\n"));
  EXPECT_EQ(s.number("material.am.youngs_modulus_GPa"), 200.0);
}

TEST_F(Materials, ABaseGivesWhatTheFileLeavesOut) {
  written("base.toml", kHead + "[density]\nam_g_cm3 = { value = 4.7, source = \"a\" }\n"
                               "cbd_solid_g_cm3 = { value = 1.9, source = \"a\" }\n");
  const ReferenceMaterial m = read_material(
      written("mine.toml", kHead + "base = \"base.toml\"\n"
                                   "[density]\nam_g_cm3 = { value = 4.8, source = \"b\" }\n"));
  EXPECT_EQ(m.values.at("density.am_g_cm3").text, "4.8");
  EXPECT_EQ(m.values.at("density.am_g_cm3").source, "b");
  EXPECT_EQ(m.values.at("density.cbd_solid_g_cm3").text, "1.9");
  calendem_test::expect_parts(refused(kHead + "base = \"mine.toml\"\n"),
                              {"leads back to this file"});
}

TEST_F(Materials, WhatIsWrongIsSaidWithItsLine) {
  calendem_test::expect_parts(
      refused(kHead + "[density]\nam_g_cm3 = 4.7\n"),
      {"mine.toml:5:", "density.am_g_cm3 needs a value and its source", "value = 4.7"});
  calendem_test::expect_parts(
      refused(kHead + "[material.am]\nfriction = { value = -1, source = \"a\" }\n"),
      {":5:", "material.am.friction is -1", "0 to 2"});
  calendem_test::expect_parts(
      refused(kHead + "[platen]\nspeed_m_s = { value = 1, source = \"a\" }\n"),
      {":5:", "unknown key 'platen.speed_m_s' of a material"});
  calendem_test::expect_parts(
      refused(kHead + "[material.cbd]\nced_J_m3 = { value = 7e8, source = \"a\" }\n"),
      {":5:", "cohesion would collapse the packing"});
  calendem_test::expect_parts(refused("name = \"mine\"\ncalibrated_on = []\n"),
                              {"'also_called' is missing"});
  const std::string recipe = written("recipe.toml", "material = \"nmc11\"\n");
  calendem_test::expect_parts(
      calendem_test::refusal([&] { read_recipe(recipe); }),
      {"recipe.toml:1:", "no material 'nmc11'", "nmc111", "xu2023", "file of your own"});
}

} // namespace
