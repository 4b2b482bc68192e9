// SPDX-License-Identifier: GPL-2.0-or-later
#include "surface_insets.h"
#include "physics/surface_inset.h"
#include <algorithm>

using namespace LAMMPS_NS;

void SurfaceInsets::begin_count() { inset_.assign(atom->nmax, 0.0); }

void SurfaceInsets::count(int i, int j) {
  ++inset_[i];
  if (j < atom->nlocal)
    ++inset_[j];
}

void SurfaceInsets::end_count(const BondSettings &settings, const int *body) {
  for (int i = 0; i < atom->nlocal; ++i)
    inset_[i] = body[i] > 0 ? calendem::surface_inset(settings.surface_inset, settings.inset_fading,
                                                      inset_[i])
                            : 0.0;
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
