// SPDX-License-Identifier: GPL-2.0-or-later
#include "bond_command.h"
#include "error.h"
#include "fix.h"
#include "material_checks.h"
#include "words.h"
#include <cstring>
#include <map>

using namespace LAMMPS_NS;
using calendem::FailureCriterion;

int BondCommand::read_strength(int narg, char **arg) {
  for (const calendem::BondStrengthLaw &law : calendem::bond_strength_laws()) {
    if (strcmp(arg[0], law.keyword) != 0)
      continue;
    const int numbers = static_cast<int>(law.numbers.size());
    const NumberReader number(error, owner_);
    char message[256];
    snprintf(message, sizeof message, "'%s' needs %d number(s)", law.keyword, numbers);
    if (narg <= numbers)
      error->fix_error(FLERR, owner_, message);
    for (int k = 0; k < numbers; ++k) {
      const calendem::BondStrengthLaw::Number &n = law.numbers[k];
      const std::string name = std::string(law.keyword) + ", number " + std::to_string(k + 1);
      settings.strengths.*n.value = number(name, arg[k + 1], between(n.least, n.most));
    }
    return 1 + numbers;
  }
  return 0;
}

bool BondCommand::read_number(const std::string &key, const char *value) {
  const std::map<std::string, std::pair<double *, NumberRange>> numbers = {
      {"youngs_modulus", {&settings.material.youngs_modulus, kPositive}},
      {"nu", {&poisson_, between(0.0, 0.5)}},
      {"radius_ratio", {&settings.material.radius_ratio, kBondRadius}},
      {"damping", {&settings.material.damping, kFraction}}, // of critical
      {"tensile", {&settings.strength.tensile, kPositive}},
      {"shear", {&settings.strength.shear, kPositive}},
      {"weibull", {&settings.strengths.weibull_modulus, kNotNegative}},
      {"reach", {&settings.reach, between(1.0, kContactDistanceFactor)}},
      {"contact_diameter", {&settings.contact_diameter, kPositive}},
      {"surface_inset", {&settings.surface_inset, kNotNegative}},
      {"inset_fading", {&settings.inset_fading, kFraction}}};
  const auto found = numbers.find(key);
  if (found == numbers.end())
    return false;
  *found->second.first = NumberReader(error, owner_)(key, value, found->second.second);
  return true;
}

bool BondCommand::read_word(const std::string &key, const std::string &value) {
  const std::map<std::string, std::string *> files = {
      {"bodies", &bodies}, {"log", &log}, {"pressure", &platen}};
  const std::map<std::string, FailureCriterion> criteria = {
      {"signed", FailureCriterion::Signed},
      {"unsigned", FailureCriterion::Unsigned},
      {"as_printed", FailureCriterion::AsPrinted}};
  if (files.count(key))
    *files.at(key) = value;
  else if (key == "breakable" && (value == "yes" || value == "no"))
    settings.breakable = value == "yes";
  else if (key == "criterion" && criteria.count(value))
    settings.criterion = criteria.at(value);
  else
    return false;
  return true;
}

// Returns how many words it takes.
int BondCommand::read_keyword(int narg, char **arg) {
  if (const int words = read_strength(narg, arg))
    return words;
  const std::string key = arg[0];
  const int values = key == "weibull" ? 2 : 1;
  if (narg <= values) {
    const std::string message = "keyword '" + key + "' lacks its value";
    error->fix_error(FLERR, owner_, message.c_str());
  }
  if (!read_number(key, arg[1]) && !read_word(key, arg[1])) {
    std::string message =
        "unknown setting '" + key + " " + arg[1] +
        "'; known: bodies FILE, youngs_modulus, nu, radius_ratio, tensile, shear, criterion "
        "signed|unsigned|as_printed, damping, weibull MODULUS SEED, breakable yes|no, log FILE, "
        "pressure FIX, reach, contact_diameter, surface_inset, inset_fading";
    for (const calendem::BondStrengthLaw &law : calendem::bond_strength_laws())
      message += std::string(", ") + law.keyword;
    error->fix_error(FLERR, owner_, message.c_str());
  }
  if (key == "weibull")
    settings.strengths.seed = static_cast<std::uint64_t>(
        NumberReader(error, owner_)("weibull seed", arg[2], whole_between(0.0, 4294967295.0)));
  return 1 + values;
}

void BondCommand::read(int narg, char **arg) {
  for (int iarg = 3; iarg < narg;)
    iarg += read_keyword(narg - iarg, arg + iarg);
  check();
}

void BondCommand::check() {
  calendem::BondMaterial &m = settings.material;
  if (m.youngs_modulus <= 0.0 || poisson_ < 0.0 || bodies.empty())
    error->fix_error(FLERR, owner_, "needs at least 'bodies FILE youngs_modulus E nu NU'");
  MaterialChecks(lmp, owner_).check_modulus("'youngs_modulus'", m.youngs_modulus);
  if (settings.contact_diameter > 1.0)
    error->fix_error(FLERR, owner_,
                     "'contact_diameter' is in sums of radii; it must be at most 1, which is the "
                     "spheres' own");
  m.shear_modulus = calendem::shear_modulus(m.youngs_modulus, poisson_);
  if (settings.breakable && (settings.strength.tensile <= 0.0 || settings.strength.shear <= 0.0))
    error->fix_error(FLERR, owner_,
                     "breakable bonds need 'tensile' and 'shear' strengths (kPa) > 0");
}
