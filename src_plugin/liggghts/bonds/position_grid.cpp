// SPDX-License-Identifier: GPL-2.0-or-later
#include "position_grid.h"
#include "atom.h"
#include "cell_growth.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "neighbor.h"
#include "physics/fixed_point.h"
#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

void PositionGrid::choose() {
  const CellGrowth *cell = CellGrowth::find(lmp);
  for (int k = 0; k < 3; ++k) {
    spacing_[k] = 0.0;
    if (!domain->periodicity[k])
      continue;
    const double largest = std::max(std::fabs(domain->boxlo[k]), std::fabs(domain->boxhi[k]));
    const double growth = cell && k == 0 ? cell->growth_to_come() : 0.0;
    spacing_[k] = calendem::exact_spacing((1.0 + growth) * (largest + 0.5 * domain->prd[k]));
    domain->boxlo[k] = calendem::nearest_multiple(domain->boxlo[k], spacing_[k]);
    domain->boxhi[k] = calendem::nearest_multiple(domain->boxhi[k], spacing_[k]);
  }
  domain->set_global_box();
  domain->set_local_box();
}

void PositionGrid::check_box(Fix *owner) const {
  const double cut = 2.0 * neighbor->cutneighmax;
  for (int k = 0; k < 3; ++k)
    if (domain->periodicity[k] && domain->prd[k] < cut) {
      char message[256];
      snprintf(message, sizeof message,
               "periodic box side %c is %g, shorter than two neighbour cut-offs (%g): a particle "
               "would touch two images of another. Make the cell larger or the skin smaller",
               "xyz"[k], domain -> prd[k], cut);
      error->fix_error(FLERR, owner, message);
    }
}

void PositionGrid::put_atoms_on() {
  for (int k = 0; k < 3; ++k) {
    const double spacing = spacing_[k], per_spacing = 1.0 / spacing; // powers of two
    for (int i = 0; spacing > 0.0 && i < atom->nlocal; ++i)
      atom->x[i][k] = std::rint(atom->x[i][k] * per_spacing) * spacing;
  }
}
