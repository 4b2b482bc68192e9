// SPDX-License-Identifier: GPL-2.0-or-later
// write_restart/whole FILE keep OLD
// As write_restart, but FILE is replaced only by a file that is whole, and what it was before is
// kept as OLD. The host does not notice a full disk: it then truncates the file silently. Here a
// warning is given, and FILE and OLD stay as they are.
#ifdef COMMAND_CLASS

CommandStyle(write_restart/whole, WriteRestartWhole)

#else
#ifndef LMP_WRITE_RESTART_WHOLE_H
#define LMP_WRITE_RESTART_WHOLE_H

#include "pointers.h"

namespace LAMMPS_NS {

class WriteRestartWhole : protected Pointers {
public:
  explicit WriteRestartWhole(class LAMMPS *lmp) : Pointers(lmp) {}
  void command(int narg, char **arg);
};

} // namespace LAMMPS_NS

#endif
#endif
