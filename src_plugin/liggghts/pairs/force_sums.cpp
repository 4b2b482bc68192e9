// SPDX-License-Identifier: GPL-2.0-or-later
#include "force_sums.h"
#include "fix.h"
#include "modify.h"
#include "stop_run.h"
#include <algorithm>

using namespace LAMMPS_NS;

// Spheres that are there, and those that fixes will insert.
double ForceSums::largest_radius(int types) const {
  double mine = 0.0, largest = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    mine = std::max(mine, atom->radius[i]);
  for (int k = 0; k < modify->nfix; ++k)
    for (int type = 1; type <= types; ++type)
      if (modify->fix[k]->use_rad_for_cut_neigh_and_ghost())
        mine = std::max(mine, modify->fix[k]->max_rad(type));
  MPI_Allreduce(&mine, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
  return largest;
}

// A force of E R^2 would press a sphere into another by its radius; a bond of larger radius bears
// more. The largest radius that there ever was restarts: a run that goes on has the same units.
void ForceSums::choose_units(const double *const *moduli, int types) {
  const double largest = bonds_->largest_radius(largest_radius(types));
  const calendem::BondMaterial &bond = bonds_->settings().material,
                               &bridge = bonds_->bridge_settings().material;
  const double section = largest * std::max({1.0, bond.radius_ratio, bridge.radius_ratio});
  double modulus = std::max(bond.youngs_modulus, bridge.youngs_modulus);
  for (int a = 1; a <= types; ++a)
    for (int b = 1; b <= types; ++b)
      modulus = std::max(modulus, moduli[a][b]);
  const double force = modulus * section * section;
  if (force > 0.0) {
    force_unit_ = calendem::FixedPoint(force);
    torque_unit_ = calendem::FixedPoint(force * section);
  }
}

void ForceSums::clear(int atoms) {
  if (atoms > static_cast<int>(sums_.size()))
    sums_.resize(atoms + atoms / 8);
  std::fill(sums_.begin(), sums_.begin() + atoms, WholeForce());
}

void ForceSums::add_tile(const PairTile &t, PairStep &s) {
  if (!round_off(t.size, s, force_unit_, torque_unit_))
    report_overflow(t, s);
  for (int p = 0; p < t.size; ++p) {
    WholeForce &on_i = sums_[t.i[p]], &on_j = sums_[t.j[p]];
    for (int k = 0; k < 4; ++k)
      on_i.force[k] += s.whole[0][p][k];
    for (int k = 0; k < 4; ++k)
      on_i.torque[k] += s.whole[1][p][k];
    for (int k = 0; k < 4; ++k)
      on_j.force[k] -= s.whole[0][p][k];
    for (int k = 0; k < 4; ++k)
      on_j.torque[k] += s.whole[2][p][k];
  }
}

void ForceSums::report_overflow(const PairTile &t, const PairStep &s) {
  for (int p = 0; p < t.size; ++p)
    for (const auto &of : s.whole)
      if (!calendem::SumCheck::can_be_added(static_cast<double>(static_cast<long long>(of[p][3]))))
        bonds_->report_overflow(atom->tag[t.i[p]]);
}

void ForceSums::add_to_atoms(PairGran *pair) {
  for (int i = 0; i < atom->nlocal; ++i) {
    const double relax = pair->relax(i);
    const WholeForce &sum = sums_[i];
    if (!calendem::SumCheck::fits(sum.force) || !calendem::SumCheck::fits(sum.torque))
      bonds_->report_overflow(atom->tag[i]);
    for (int k = 0; k < 3; ++k) {
      atom->f[i][k] += relax * force_unit_.value(static_cast<long long>(sum.force[k]));
      atom->torque[i][k] += relax * torque_unit_.value(static_cast<long long>(sum.torque[k]));
    }
  }
}

void ForceSums::stop_overflow(int tag) const {
  const double most = calendem::SumCheck::kMost;
  char message[400];
  snprintf(message, sizeof message,
           "particle %d is under a force or torque of more than the units of its sum hold: %.3g, "
           "%.3g (in the script's units), more than pressing one sphere into another by its radius "
           "takes. The time step is too large, or something moves too fast: lower the timestep or "
           "the speed",
           tag, most * force_unit_.unit, most * torque_unit_.unit);
  stop_run(lmp, FLERR, message);
}
