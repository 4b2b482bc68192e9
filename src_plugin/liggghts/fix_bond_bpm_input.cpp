// SPDX-License-Identifier: GPL-2.0-or-later
// fix bond/bpm: what it reads (command line, body map) and writes (event log).
#include "comm.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_property_global.h"
#include "modify.h"
#include "physics/hertz_contact.h"
#include "update.h"
#include "words.h"
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>

using namespace LAMMPS_NS;
using calendem::BreakMode;
using calendem::FailureCriterion;

// How many words are a law of strength and its numbers; 0: the first is the name of none.
int FixBondBpm::parse_strength(int narg, char **arg) {
  for (const calendem::BondStrengthLaw &law : calendem::bond_strength_laws()) {
    if (strcmp(arg[0], law.keyword) != 0)
      continue;
    const int numbers = static_cast<int>(law.numbers.size());
    const NumberReader number(error, this);
    char message[256];
    snprintf(message, sizeof message, "'%s' needs %d number(s)", law.keyword, numbers);
    if (narg <= numbers)
      error->fix_error(FLERR, this, message);
    for (int k = 0; k < numbers; ++k) {
      const calendem::BondStrengthLaw::Number &n = law.numbers[k];
      const std::string name = std::string(law.keyword) + ", number " + std::to_string(k + 1);
      settings_.strengths.*n.value = number(name, arg[k + 1], between(n.least, n.most));
    }
    return 1 + numbers;
  }
  return 0;
}

int FixBondBpm::parse_keyword(int iarg, int narg, char **arg) {
  if (const int words = parse_strength(narg - iarg, arg + iarg))
    return iarg + words;
  const std::string key = arg[iarg];
  const int values = key == "weibull" ? 2 : 1;
  if (iarg + values >= narg) {
    const std::string message = "keyword '" + key + "' lacks its value";
    error->fix_error(FLERR, this, message.c_str());
  }
  const char *value = arg[iarg + 1];
  const NumberReader number(error, this);
  if (key == "bodies")
    bodies_file_ = value;
  else if (key == "youngs_modulus")
    settings_.material.youngs_modulus = number(key, value, kPositive);
  else if (key == "nu")
    settings_.material.shear_modulus =
        number(key, value, between(0.0, 0.5)); // turned into G once E is known
  else if (key == "radius_ratio")
    settings_.material.radius_ratio = number(key, value, kBondRadius);
  else if (key == "damping")
    settings_.material.damping = number(key, value, kFraction); // of critical
  else if (key == "tensile")
    settings_.strength.tensile = number(key, value, kPositive);
  else if (key == "shear")
    settings_.strength.shear = number(key, value, kPositive);
  else if (key == "weibull") {
    settings_.strengths.weibull_modulus = number(key, value, kNotNegative);
    settings_.strengths.seed = static_cast<std::uint64_t>(
        number("weibull seed", arg[iarg + 2], whole_between(0.0, 4294967295.0)));
  } else if (key == "contact_diameter")
    settings_.contact_diameter = number(key, value, kPositive);
  else if (key == "surface_inset")
    settings_.surface_inset = number(key, value, kNotNegative);
  else if (key == "inset_fading")
    settings_.inset_fading = number(key, value, kFraction);
  else if (key == "log")
    log_file_ = value;
  else if (key == "pressure")
    platen_id_ = value;
  else if (key == "breakable" && (!strcmp(value, "yes") || !strcmp(value, "no")))
    settings_.breakable = !strcmp(value, "yes");
  else if (key == "criterion" && !strcmp(value, "signed"))
    settings_.criterion = FailureCriterion::Signed;
  else if (key == "criterion" && !strcmp(value, "unsigned"))
    settings_.criterion = FailureCriterion::Unsigned;
  else if (key == "criterion" && !strcmp(value, "as_printed"))
    settings_.criterion = FailureCriterion::AsPrinted;
  else {
    std::string message =
        "unknown setting '" + key + " " + value +
        "'; known: bodies FILE, youngs_modulus, nu, radius_ratio, tensile, shear, criterion "
        "signed|unsigned|as_printed, damping, weibull MODULUS SEED, breakable yes|no, log FILE, "
        "pressure FIX, contact_diameter, surface_inset, inset_fading";
    for (const calendem::BondStrengthLaw &law : calendem::bond_strength_laws())
      message += std::string(", ") + law.keyword;
    error->fix_error(FLERR, this, message.c_str());
  }
  return iarg + 1 + values;
}

int FixBondBpm::modify_param(int narg, char **arg) {
  if (!strcmp(arg[0], "bridges"))
    return parse_bridges(narg, arg);
  return !strcmp(arg[0], "shrinkage") ? parse_shrinkage(narg, arg) : parse_strength(narg, arg);
}

void FixBondBpm::parse(int narg, char **arg) {
  settings_.material.shear_modulus = -1.0;
  for (int iarg = 3; iarg < narg;)
    iarg = parse_keyword(iarg, narg, arg);
  check_settings();
}

void FixBondBpm::check_settings() {
  calendem::BondMaterial &m = settings_.material;
  const double nu = m.shear_modulus;
  if (m.youngs_modulus <= 0.0 || nu < 0.0 || bodies_file_.empty())
    error->fix_error(FLERR, this, "needs at least 'bodies FILE youngs_modulus E nu NU'");
  check_modulus("'youngs_modulus'", m.youngs_modulus);
  if (settings_.contact_diameter > 1.0)
    error->fix_error(FLERR, this,
                     "'contact_diameter' is in sums of radii; it must be at most 1, which is the "
                     "spheres' own");
  m.shear_modulus = calendem::shear_modulus(m.youngs_modulus, nu);
  if (settings_.breakable && (settings_.strength.tensile <= 0.0 || settings_.strength.shear <= 0.0))
    error->fix_error(FLERR, this, "breakable bonds need 'tensile' and 'shear' strengths (kPa) > 0");
}

// Ten times diamond in units micro, where 1 is 1 kPa: such a value is in Pa.
void FixBondBpm::check_modulus(const char *what, double value) {
  const double most = 1e10;
  char message[256];
  snprintf(message, sizeof message,
           "%s is %g kPa = %g GPa; at most %g GPa is allowed. Is it given in Pa? The input scripts "
           "take GPa",
           what, value, 1e-6 * value, 1e-6 * most);
  if (!strcmp(update->unit_style, "micro") && value > most)
    error->fix_error(FLERR, this, message);
}

void FixBondBpm::pair_error(const char *what, double value, int i, int j, const char *why) {
  char message[400];
  snprintf(message, sizeof message, "%s of atom types %d and %d is %g in the script's units; %s",
           what, i, j, value, why);
  error->fix_error(FLERR, this, message);
}

// A global property by types or by pairs of them, for as many as the script gives, which may be
// fewer than the box has; NULL if it gives none.
FixPropertyGlobal *FixBondBpm::property(const char *name, const char *kind) {
  return static_cast<FixPropertyGlobal *>(
      modify->find_fix_property(name, "property/global", kind, 0, 0, style, false));
}

void FixBondBpm::check_not_negative(const char *name) {
  FixPropertyGlobal *of_pairs = property(name, "peratomtypepair");
  for (int i = 0; of_pairs && i < of_pairs->size_array_rows; ++i)
    for (int j = i; j < of_pairs->size_array_cols; ++j)
      if (const double value = of_pairs->compute_array(i, j); !(value >= 0.0))
        pair_error(name, value, i + 1, j + 1, "it must be >= 0");
}

void FixBondBpm::check_materials() {
  FixPropertyGlobal *modulus = property("youngsModulus", "peratomtype");
  FixPropertyGlobal *poisson = property("poissonsRatio", "peratomtype");
  FixPropertyGlobal *ced = property("cohesionEnergyDensity", "peratomtypepair");
  char what[64];
  for (int i = 0; modulus && i < modulus->size_vector; ++i) {
    snprintf(what, sizeof what, "youngsModulus of atom type %d", i + 1);
    check_modulus(what, modulus->compute_vector(i));
  }
  check_not_negative("coefficientFriction");
  check_not_negative("cohesionEnergyDensity");
  if (!modulus || !poisson || !ced)
    return;
  const double *E = modulus->get_values(), *nu = poisson->get_values();
  const int n = std::min({modulus->size_vector, poisson->size_vector, ced->size_array_rows});
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j)
      check_collapse(i + 1, j + 1, ced->compute_array(i, j),
                     calendem::effective_modulus(E[i], nu[i], E[j], nu[j]));
}

// Two spheres that nothing but SJKR and Hertz act on; the overlap scales as (CED/E)^2.
void FixBondBpm::check_collapse(int i, int j, double ced, double effective_modulus) {
  const double most = 0.3; // the paper's own values give up to 0.07
  const double overlap = calendem::sjkr_equilibrium_overlap(ced, effective_modulus, 0.5);
  char message[256];
  snprintf(message, sizeof message,
           "it pulls equal spheres into each other by %.3g of their radius and at most %g is "
           "allowed, or the packing collapses. Lower it or raise youngsModulus: the overlap scales "
           "as (CED/E)^2",
           overlap, most);
  if (overlap > most)
    pair_error("cohesionEnergyDensity", ced, i, j, message);
}

// The file has rows `tag body`, body >= 1; '#' starts a comment. Atoms without a row belong to
// none. A comment `# tag body, N rows` says how many rows must follow.
void FixBondBpm::read_bodies() {
  const int highest = atom->tag_max();
  std::vector<int> &body_of = body_of_tag_;
  body_of.assign(highest + 1, 0);
  char problem[512] = "";
  if (comm->me == 0) {
    FILE *fp = fopen(bodies_file_.c_str(), "r");
    if (!fp)
      snprintf(problem, sizeof problem, "cannot open the body map '%.300s': %s",
               bodies_file_.c_str(), strerror(errno));
    char line[256];
    int announced = -1, rows = 0;
    for (int row = 1; fp && !problem[0] && fgets(line, sizeof line, fp); ++row) {
      int tag = 0, body = 0;
      char rest = 0;
      const int n = sscanf(line, "%d %d %c", &tag, &body, &rest);
      sscanf(line, "# tag body, %d rows", &announced);
      if (line[strspn(line, " \t\r\n")] == '\0' || line[strspn(line, " \t")] == '#')
        continue;
      if (n != 2 || tag < 1 || tag > highest || body < 1 || body_of[tag])
        snprintf(problem, sizeof problem,
                 "%.200s:%d: '%.60s' is not a row 'tag body' with 1 <= tag <= %d (each once) and "
                 "body >= 1",
                 bodies_file_.c_str(), row, strtok(line, "\r\n"), highest);
      else {
        body_of[tag] = body;
        ++rows;
      }
    }
    if (!problem[0] && announced >= 0 && rows != announced)
      snprintf(
          problem, sizeof problem,
          "the body map '%.300s' announces %d rows and holds %d: it is cut. Make the electrode "
          "again",
          bodies_file_.c_str(), announced, rows);
    if (fp)
      fclose(fp);
  }
  MPI_Bcast(problem, sizeof problem, MPI_CHAR, 0, world);
  if (problem[0])
    error->fix_error(FLERR, this, problem);
  MPI_Bcast(body_of.data(), highest + 1, MPI_INT, 0, world);
  bodies_ = *std::max_element(body_of.begin(), body_of.end());
  for (int i = 0; i < atom->nlocal; ++i)
    body_[i] = body_of[atom->tag[i]];
  measure_bodies();
}

// Added in the order of tags, so that no bit depends on the number of ranks: of each term all ranks
// but one have 0.
void FixBondBpm::measure_bodies() {
  const int n = static_cast<int>(body_of_tag_.size());
  std::vector<double> mine(n, 0.0), cube(n);
  for (int i = 0; i < atom->nlocal; ++i)
    mine[atom->tag[i]] = std::pow(2.0 * atom->radius[i], 3);
  MPI_Allreduce(mine.data(), cube.data(), n, MPI_DOUBLE, MPI_SUM, world);
  body_diameter_.clear();
  for (int tag = 1; tag < n; ++tag)
    body_diameter_[body_of_tag_[tag]] += cube[tag];
  for (auto &body : body_diameter_)
    body.second = std::cbrt(body.second);
}

// The log is rewritten from memory when it is opened, so that after a restart it holds exactly the
// breaks up to that moment.
void FixBondBpm::open_log() {
  log_ready_ = true;
  if (log_file_.empty())
    return;
  int ok = 1;
  if (comm->me == 0) {
    FILE *fp = fopen(log_file_.c_str(), "w");
    ok = fp != NULL;
    if (fp) {
      fprintf(fp, "time_us,tag_i,tag_j,body,mode,sigma_MPa,tau_MPa,x_um,y_um,z_um,pressure_MPa\n");
      ok = fclose(fp) == 0;
    }
  }
  MPI_Bcast(&ok, 1, MPI_INT, 0, world);
  if (!ok) {
    const std::string message = "cannot write the event log '" + log_file_ + "'";
    error->fix_error(FLERR, this, message.c_str());
  }
  std::vector<BreakEvent> known;
  known.swap(breaks_);
  log_breaks(known);
}

// Averaged, of the step; 0 without a platen.
double FixBondBpm::platen_pressure() const {
  const int platen = platen_id_.empty() ? -1 : modify->find_fix(platen_id_.c_str());
  return platen < 0 ? 0.0 : modify->fix[platen]->compute_vector(4);
}

void FixBondBpm::log_breaks(const std::vector<BreakEvent> &all) {
  FILE *fp = comm->me == 0 && !log_file_.empty() ? fopen(log_file_.c_str(), "a") : NULL;
  if (comm->me == 0 && !log_file_.empty() && !fp)
    error->warning(FLERR,
                   "cannot append to the event log of fix bond/bpm; breaks stay in restarts");
  for (const BreakEvent &e : all) {
    breaks_.push_back(e);
    if (fp)
      fprintf(fp, "%.9g,%d,%d,%d,%s,%.6g,%.6g,%.6f,%.6f,%.6f,%.6g\n", e.time,
              static_cast<int>(e.tag_low), static_cast<int>(e.tag_high), static_cast<int>(e.body),
              calendem::name_of(static_cast<BreakMode>(static_cast<int>(e.mode))), 1e-3 * e.sigma,
              1e-3 * e.tau, e.x, e.y, e.z, 1e-3 * e.pressure);
  }
  if (fp)
    fclose(fp);
}
