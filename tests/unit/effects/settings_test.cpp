// SPDX-License-Identifier: GPL-2.0-or-later
// The rows of settings and contact laws: what they need to be scripts and keys.
#include "base/case.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "support/test_folder.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <tuple>

namespace {

using namespace calendem;

Settings case_of(const std::string &text) {
  const std::string file = (calendem_test::test_folder() / "case.toml").string();
  write_file(file, "electrode = \"none\"\n" + text);
  return read_case(file);
}

// Requirement: the paper's E_p and E_b are one number; they part only when asked.
TEST(Settings, ABondIsAsStiffAsItsParticles) {
  Settings s = case_of("[material.am]\nyoungs_modulus_GPa = 150\npoisson = 0.2\n");
  EXPECT_EQ(s.number("bond.youngs_modulus_GPa"), 150.0);
  EXPECT_EQ(s.number("bond.poisson"), 0.2);
  s.set("material.am.youngs_modulus_GPa", "120"); // as a study or a bank does
  EXPECT_EQ(s.number("bond.youngs_modulus_GPa"), 120.0);
  s.set("bond.youngs_modulus_GPa", "30");
  s.set("material.am.youngs_modulus_GPa", "140");
  EXPECT_EQ(s.number("bond.youngs_modulus_GPa"), 30.0);
}

TEST(Settings, ABondMayBeGivenItsOwn) {
  Settings s = case_of("[material.am]\nyoungs_modulus_GPa = 150\n"
                       "[bond]\nyoungs_modulus_GPa = 200\n");
  EXPECT_EQ(s.number("bond.youngs_modulus_GPa"), 200.0);
  s.set("material.am.youngs_modulus_GPa", "120");
  EXPECT_EQ(s.number("bond.youngs_modulus_GPa"), 200.0);
}

// Requirement: a run's case.toml states what it was run with.
TEST(Settings, TheCaseAsRunStatesTheModulusOfTheBond) {
  const Settings s = case_of("[material.am]\nyoungs_modulus_GPa = 150\n");
  const std::string written = write_toml(s, case_keys(), "");
  const std::size_t bond = written.find("[bond]");
  ASSERT_NE(bond, std::string::npos);
  EXPECT_EQ(written.find("youngs_modulus_GPa = 150 ", bond), bond + 7);
}

TEST(Settings, NamesAndVariablesAreUnique) {
  std::set<std::string> names, variables;
  for (const Key &key : case_keys()) {
    EXPECT_TRUE(names.insert(key.name).second) << key.name;
    EXPECT_TRUE(key.variable.empty() || variables.insert(key.variable).second) << key.variable;
    EXPECT_TRUE(key.same_as.empty() || names.count(key.same_as)) << key.name; // stands before
  }
}

// Requirement: every property of a contact law is a setting, or may be 0 and is; no two effects of
// one law have the same pair of phases.
TEST(Settings, ContactLawsHaveTheirSettings) {
  std::set<std::tuple<const ContactLaw *, int, int>> taken;
  for (const Effect &e : effects()) {
    if (!e.contact.law)
      continue;
    ASSERT_LE(e.settings.size(), e.contact.law->size) << e.name;
    for (std::size_t k = e.settings.size(); k < e.contact.law->size; ++k)
      EXPECT_TRUE(e.contact.law->properties.at(k).may_be_zero) << e.name;
    EXPECT_EQ(e.law, e.contact.law->header) << e.name;
    EXPECT_EQ(e.settings[0].name, e.parameter.keys.at(0)) << e.name;
    for (const auto &[a, b] : e.contact.between)
      EXPECT_TRUE(
          taken.emplace(e.contact.law, std::min(int(a), int(b)), std::max(int(a), int(b))).second)
          << e.name;
  }
}

std::string refusal(const std::string &text) {
  try {
    case_of(text);
  } catch (const Failure &e) {
    return e.what();
  }
  return "";
}

// Requirement: a contact follows one law; effects whose contacts do not meet go together.
TEST(Settings, AContactFollowsOneLaw) {
  const std::string relaxes = "[effects.cbd_viscoelasticity]\nrelaxed_fraction = 0.2\n",
                    yields = "[effects.cbd_plasticity]\nyield_pressure_GPa = 0.6\n",
                    encloses = "[effects.nmc_confinement]\nbulk_modulus_GPa = 100\n";
  EXPECT_NE(refusal(relaxes + yields).find("a contact follows one law"), std::string::npos);
  EXPECT_EQ(refusal(relaxes + encloses), "");
  EXPECT_EQ(refusal(yields + encloses), "");
}

// Requirement: hardening at most 0.159 E*: 17.47 GPa between AM spheres, 0.418 between AM and CBD,
// 0.209 between CBD spheres.
TEST(Settings, HardeningIsAPartOfTheModulus) {
  const std::string nmc = "[effects.nmc_plasticity]\nyield_pressure_GPa = 3\nhardening_GPa = ",
                    cbd = "[effects.cbd_plasticity]\nyield_pressure_GPa = 1\nhardening_GPa = ";
  EXPECT_EQ(refusal(nmc + "17.4\n"), "");
  EXPECT_NE(refusal(nmc + "17.5\n").find("Give at most 17.5"), std::string::npos);
  EXPECT_EQ(refusal(cbd + "0.209\n"), "");
  EXPECT_NE(refusal(cbd + "0.21\n").find("between cbd and cbd"), std::string::npos);
}

// Requirement: limits are those of the laws' heads, in the key's unit, at the key's line.
TEST(Settings, LimitsOfContactLawsCountCohesion) {
  const std::string yields = "[effects.nmc_plasticity]\nyield_pressure_GPa = ";
  EXPECT_NE(refusal(yields + "1.49\n").find(":3: "), std::string::npos);
  EXPECT_EQ(refusal(yields + "1.51\n"), ""); // 2.5 x 0.6 GPa
  EXPECT_EQ(refusal("[effects.collector_indentation]\nyield_pressure_GPa = 0.1\n"), "");
  // AM and CBD: 2.5 x 0.205 GPa, of which 2 x 0.205 may be left out
  const std::string binder = "[effects.cbd_plasticity]\nyield_pressure_GPa = ";
  EXPECT_NE(refusal(binder + "0.5\n").find("at least 0.512 GPa"), std::string::npos);
  EXPECT_NE(refusal(binder + "0.1\nbeyond_cohesion = 1\n").find("at least 0.102 GPa"),
            std::string::npos);
  EXPECT_EQ(refusal(binder + "0.103\nbeyond_cohesion = 1\n"), "");
  // AM and CBD: CED sqrt(6e5 7e4) kPa, 1/E* = 0.91/2e8 + 0.7599/2e6 1/kPa, overlap 0.0689 R
  const std::string relaxes = "[effects.cbd_viscoelasticity]\nrelaxed_fraction = ";
  EXPECT_EQ(refusal(relaxes + "0.52\n"), "");
  EXPECT_NE(refusal(relaxes + "0.54\n").find("at most 0.5"), std::string::npos);
}

// Requirement: a law acts on a pair of types either way round, and on no other.
TEST(Settings, ContactLawsInTheScriptAreSymmetric) {
  std::istringstream script(generated_files(CALENDEM_SOURCE_DIR)[2].text);
  const std::string begin = "peratomtypepair 4 ";
  std::string line;
  std::size_t properties = 0;
  while (std::getline(script, line)) {
    const std::size_t at = line.find(begin);
    if (at == std::string::npos)
      continue;
    ++properties;
    std::istringstream rest(line.substr(at + begin.size(), line.rfind('"') - at - begin.size()));
    std::vector<std::string> v;
    for (std::string word; rest >> word;)
      v.push_back(word);
    ASSERT_EQ(v.size(), 16u) << line;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        EXPECT_EQ(v[4 * i + j], v[4 * j + i]) << line;
    EXPECT_EQ(v[15], "0") << line; // nothing acts between platens
  }
  std::size_t due = 0;
  for (const ContactLaw *law : kContactLaws)
    due += law->size;
  EXPECT_EQ(properties, due);
}

// Requirement: every setting of a script is defined and written down by it.
TEST(Settings, ScriptsHaveEverySetting) {
  const std::vector<GeneratedFile> files = generated_files(CALENDEM_SOURCE_DIR);
  for (const Key &key : case_keys())
    if (!key.variable.empty()) {
      EXPECT_NE(files[0].text.find("variable " + key.variable + " "), std::string::npos);
      EXPECT_NE(files[1].text.find("\"variable " + key.variable + " index ${"), std::string::npos);
    }
}

// Requirement: what has nothing to act on is a mistake, which says what to do.
TEST(Settings, DryingStressNeedsBinderBridges) {
  const std::string shrinks = "[effects.drying_stress]\nshrinkage = 0.005\n";
  EXPECT_NE(refusal(shrinks).find("only binder bridges can shrink. Give that a value above 0"),
            std::string::npos);
  EXPECT_EQ(refusal("[effects.binder_bridges]\nstrength_MPa = 10\n" + shrinks), "");
  EXPECT_EQ(refusal("[effects.drying_stress]\nshrinkage = 0\n"), "");
}

} // namespace
