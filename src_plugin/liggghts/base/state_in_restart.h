// SPDX-License-Identifier: GPL-2.0-or-later
// The host gives a fix its state of a restart file by style and ID, and drops without a word what
// no fix of the script has asked for before the first run. A fix that begins anew while the file
// holds the state of its style under an ID that the script does not use has lost it: an error.
#ifndef CALENDEM_STATE_IN_RESTART_H
#define CALENDEM_STATE_IN_RESTART_H

#include "error.h"
#include "fix.h"
#include "modify.h"
#include <cstring>
#include <string>
#include <vector>

namespace LAMMPS_NS {

class StateInRestart {
public:
  /// In a fix's post_create(): afterwards the host may have dropped what the file holds.
  void remember(Modify *modify, Fix *fix) {
    if (modify->have_restart_data(fix))
      return;
    for (int n = 0; n < modify->n_restart_data_global_style(fix->style); ++n)
      ids_.push_back(modify->id_restart_data_global_style(fix->style, n));
  }
  /// In its init(): by then the script has all its fixes.
  void stop_if_lost(Modify *modify, Error *error, Fix *fix) {
    for (const std::string &other : ids_) {
      const int place = modify->find_fix(other.c_str());
      if (place >= 0 && !strcmp(modify->fix[place]->style, fix->style))
        continue;
      const std::string message =
          "the restart file holds the state of this style under the ID '" + other +
          "', which no fix of the script has: it would be lost, and '" + fix->id +
          "' begin anew. Name the fix '" + other + "', or begin from a data file";
      error->fix_error(FLERR, fix, message.c_str());
    }
    ids_.clear();
  }

private:
  std::vector<std::string> ids_; ///< under which the file holds states of the style
};

} // namespace LAMMPS_NS

#endif
