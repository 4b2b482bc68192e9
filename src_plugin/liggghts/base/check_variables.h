// SPDX-License-Identifier: GPL-2.0-or-later
// check_variables FILE...
// Stops the run if the command line sets a variable (-var NAME VALUE) that no line
// `variable NAME index` of these scripts declares: a mistyped name would change nothing. The
// command line is the one that the system shows in /proc; without it nothing is checked.
#ifdef COMMAND_CLASS

CommandStyle(check_variables, CheckVariables)

#else
#ifndef LMP_CHECK_VARIABLES_H
#define LMP_CHECK_VARIABLES_H

#include "pointers.h"

namespace LAMMPS_NS {

class CheckVariables : protected Pointers {
public:
  explicit CheckVariables(class LAMMPS *lmp) : Pointers(lmp) {}
  void command(int narg, char **arg);
};

} // namespace LAMMPS_NS

#endif
#endif
