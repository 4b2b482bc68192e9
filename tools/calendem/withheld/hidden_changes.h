// SPDX-License-Identifier: GPL-2.0-or-later
// What only the maker of truths can do: changes that are no effect of the table, so that no
// diagnosis can name them, and other numerics.
#ifndef CALENDEM_WITHHELD_HIDDEN_CHANGES_H
#define CALENDEM_WITHHELD_HIDDEN_CHANGES_H

#include <string>
#include <vector>

namespace calendem {

struct ChangedKey {
  std::string key;   ///< "case.…" or "recipe.…"
  std::string value; ///< empty: what stands there times `factor`
  double factor = 1.0;
};

struct HiddenChange {
  std::string name, what;
  bool numerics = false; ///< the physics is the same: the right answer is not changed by it
  std::vector<ChangedKey> keys;
  double displacement_factor = 1.0; ///< of what the press shows
};

const std::vector<HiddenChange> &hidden_changes();

/// nullptr: there is none of that name.
const HiddenChange *find_hidden(const std::string &name);

} // namespace calendem

#endif
