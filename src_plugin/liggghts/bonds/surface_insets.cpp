// SPDX-License-Identifier: GPL-2.0-or-later
#include "surface_insets.h"
#include <algorithm>

using namespace LAMMPS_NS;

void SurfaceInsets::find(const BondSettings &settings, const BondPairs &pairs, const int *body,
                         const int *broken) {
  inset_.assign(atom->nmax, 0.0);
  if (settings.surface_inset == 0.0)
    return;
  if (settings.inset_fading > 0.0)
    pairs.for_each_neighbor([this](int i, int j, const BondHistory &bond) {
      if (bond.state() != kIntact)
        return;
      ++inset_[i];
      if (j < atom->nlocal)
        ++inset_[j];
    });
  for (int i = 0; i < atom->nlocal; ++i) {
    const double lost = broken[i] == 0 ? 0.0 : broken[i] / (inset_[i] + broken[i]);
    inset_[i] = body[i] > 0 ? settings.surface_inset * (1.0 - settings.inset_fading * lost) : 0.0;
  }
}

void SurfaceInsets::set(int i, double inset) {
  if (static_cast<int>(inset_.size()) <= i)
    inset_.resize(i + 1, 0.0);
  inset_[i] = inset;
}

double SurfaceInsets::not_into_contact(int i, int j, double before, double length) const {
  if (length > 0.0 || before >= length)
    return length;
  const double r = norm(calendem::load(atom->x[i]) - calendem::load(atom->x[j]));
  return std::max(before, std::min(length, r - atom->radius[i] - atom->radius[j]));
}
