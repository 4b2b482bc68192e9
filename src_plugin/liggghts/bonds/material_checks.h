// SPDX-License-Identifier: GPL-2.0-or-later
// Stops a run whose material cannot be meant: a modulus in the wrong unit, a cohesion that would
// let the packing collapse.
#ifndef CALENDEM_MATERIAL_CHECKS_H
#define CALENDEM_MATERIAL_CHECKS_H

#include "pointers.h"

namespace LAMMPS_NS {

class MaterialChecks : protected Pointers {
public:
  /// Messages name the fix `owner`.
  MaterialChecks(class LAMMPS *lmp, class Fix *owner) : Pointers(lmp), owner_(owner) {}

  /// `value` in kPa, where units are micro.
  void check_modulus(const char *what, double value) const;
  /// What the script gives atom types and pairs of them.
  void check_properties() const;

private:
  class Fix *owner_;

  class FixPropertyGlobal *property(const char *name, const char *kind) const;
  void check_not_negative(const char *name) const;
  void check_collapse(int i, int j, double ced, double effective_modulus) const;
  [[noreturn]] void refuse(const char *what, double value, int i, int j, const char *why) const;
};

} // namespace LAMMPS_NS

#endif
