// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_cbd_growth.h"
#include "atom.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_property_atom.h"
#include "fix_wall_gran_platen.h"
#include "modify.h"
#include "neighbor.h"
#include "words.h"
#include <cmath>
#include <string>

using namespace LAMMPS_NS;
using namespace FixConst;
using calendem::Cap;
using calendem::KeptVolume;

FixCbdGrowth::FixCbdGrowth(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), type_(0), growth_(NULL), bonds_(NULL) {
  const NumberReader number(error, this);
  nevery = 50;
  for (int i = 3; i < narg; i += 2) {
    const std::string key = arg[i];
    const char *value = i + 1 < narg ? arg[i + 1] : "";
    if (key == "type")
      type_ = static_cast<int>(number(key, value, whole_between(1, atom->ntypes)));
    else if (key == "every")
      nevery = static_cast<int>(number(key, value, whole_between(1, 1e6)));
    else
      error->fix_error(FLERR, this, ("unknown setting '" + key + "'; known: type, every").c_str());
  }
  if (type_ == 0)
    error->fix_error(FLERR, this, "needs 'type T', the atom type of the spheres that grow");
  vector_flag = 1;
  size_vector = 3;
  global_freq = 1;
}

void FixCbdGrowth::post_create() {
  const char *name = ContactEffects::kGrowth;
  std::vector<std::string> words = {
      name, "all", "property/atom", name, "vector", "yes", "yes", "no", "0.", "0."};
  std::vector<char *> arg;
  for (std::string &word : words)
    arg.push_back(&word[0]);
  modify->add_fix(static_cast<int>(arg.size()), arg.data());
  growth_ = static_cast<FixPropertyAtom *>(
      modify->find_fix_property(name, "property/atom", "vector", 2, 0, style));
}

void FixCbdGrowth::pre_delete(bool unfixflag) {
  if (unfixflag)
    modify->delete_fix(ContactEffects::kGrowth);
}

int FixCbdGrowth::setmask() { return PRE_FORCE | END_OF_STEP; }

void FixCbdGrowth::init() {
  bonds_ = FixBondBpm::find(lmp, "fix cbd/growth");
  walls_ = FixWallGranPlaten::all(*modify);
}

// Ghosts are new whenever neighbours are listed.
void FixCbdGrowth::setup_pre_force(int) { growth_->do_forward_comm(); }
void FixCbdGrowth::pre_force(int) {
  if (neighbor->ago == 0)
    growth_->do_forward_comm();
}

bool FixCbdGrowth::is_mine(int i) const { return i < atom->nlocal && atom->type[i] == type_; }

KeptVolume FixCbdGrowth::of(int i) const {
  KeptVolume kept;
  kept.growth = growth_->array_atom[i][0];
  kept.full = growth_->array_atom[i][1] == ContactEffects::kFull;
  return kept;
}

void FixCbdGrowth::add(std::vector<Caps> &caps, int i, double overlap, double R_eff,
                       int soft_spheres) const {
  if (!is_mine(i) || overlap <= 0.0)
    return;
  const double R = atom->radius[i];
  const Cap cap(R + of(i).growth, R - calendem::flat_depth(overlap, R_eff, R, soft_spheres));
  caps[i].volume.add(cap.volume);
  caps[i].area.add(cap.area);
}

void FixCbdGrowth::add_pairs(std::vector<Caps> &caps) const {
  const double *R = atom->radius;
  const int *type = atom->type;
  bonds_->pairs().for_each_touching_copy([&](int i, int j, double r, const BondHistory &bond) {
    if (!is_mine(i) && !is_mine(j))
      return;
    const double overlap = bond.contact(r, R[i] + R[j]).overlap;
    const double R_eff = calendem::effective_radius(R[i], R[j]);
    const int soft = type[i] == type[j] ? 2 : 1;
    add(caps, i, overlap, R_eff, soft);
    add(caps, j, overlap, R_eff, soft);
  });
}

void FixCbdGrowth::add_walls(std::vector<Caps> &caps) const {
  for (FixWallGranPlaten *wall : walls_)
    for (int i = 0; i < atom->nlocal; ++i)
      add(caps, i, wall->contact(i).overlap, atom->radius[i], 1);
}

void FixCbdGrowth::end_of_step() {
  std::vector<Caps> caps(atom->nlocal);
  add_pairs(caps);
  add_walls(caps);
  for (int i = 0; i < atom->nlocal; ++i)
    if (is_mine(i)) {
      KeptVolume kept = of(i);
      kept.update(atom->radius[i], caps[i].volume.value(), caps[i].area.value());
      growth_->array_atom[i][0] = kept.growth;
      growth_->array_atom[i][1] = kept.full ? ContactEffects::kFull : ContactEffects::kFree;
    }
  growth_->do_forward_comm();
}

double FixCbdGrowth::compute_vector(int n) {
  double sums[3] = {0.0, 0.0, 0.0}, largest = 0.0; // spheres, growth, full
  for (int i = 0; i < atom->nlocal; ++i)
    if (is_mine(i)) {
      const double part = of(i).growth / atom->radius[i];
      sums[0] += 1.0;
      sums[1] += part;
      sums[2] += of(i).full ? 1.0 : 0.0;
      largest = std::fmax(largest, part);
    }
  double all[3], most;
  MPI_Allreduce(sums, all, 3, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(&largest, &most, 1, MPI_DOUBLE, MPI_MAX, world);
  const double spheres = std::fmax(all[0], 1.0);
  const double values[] = {all[1] / spheres, most, all[2] / spheres};
  return values[n];
}
