// SPDX-License-Identifier: GPL-2.0-or-later
// The words of `fix ID all bond/bpm ...`, read and checked.
#ifndef CALENDEM_BOND_COMMAND_H
#define CALENDEM_BOND_COMMAND_H

#include "bond_settings.h"
#include "pointers.h"
#include <string>

namespace LAMMPS_NS {

class BondCommand : protected Pointers {
public:
  BondSettings settings;
  std::string bodies, log, platen; ///< body map, event log, ID of the fix that knows the pressure

  /// Messages name the fix `owner`.
  BondCommand(class LAMMPS *lmp, class Fix *owner) : Pointers(lmp), owner_(owner) {}

  void read(int narg, char **arg);
  /// A law of strength and its numbers; returns how many words they are, 0: it is none.
  int read_strength(int narg, char **arg);

private:
  class Fix *owner_;
  double poisson_ = -1.0;

  int read_keyword(int narg, char **arg);
  bool read_number(const std::string &key, const char *value);
  bool read_word(const std::string &key, const std::string &value);
  void check();
};

} // namespace LAMMPS_NS

#endif
