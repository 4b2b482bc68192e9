// SPDX-License-Identifier: GPL-2.0-or-later
// One key of a TOML file and what it may hold. A setting of the calendering case is such a key with
// the name that the input scripts know it by.
#ifndef CALENDEM_REGISTRY_KEY_H
#define CALENDEM_REGISTRY_KEY_H

#include <string>

namespace calendem {

/// `choices` not empty, or `text`: a string; otherwise a number in [low, high].
struct Key {
  std::string name;     ///< dotted, as in the file: "bond.radius_ratio"
  std::string variable; ///< of the LIGGGHTS script, empty if none
  std::string fallback; ///< default as text; empty: the key is required
  double low = 0.0;
  double high = 0.0;
  std::string unit;
  std::string meaning;
  std::string choices = ""; ///< "a|b|c"
  bool text = false;
  bool whole = false;       ///< a whole number
  std::string same_as = ""; ///< a key before it, whose value is the default, in place of `fallback`
};

} // namespace calendem

#endif
