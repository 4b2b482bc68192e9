// SPDX-License-Identifier: GPL-2.0-or-later
// The points of a bank: films, materials, the effects that act in them, and the cell they are run on.
#ifndef CALENDEM_BANK_DESIGN_H
#define CALENDEM_BANK_DESIGN_H

#include "effects/effect.h"
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace calendem::bank {

/// A quantity in which the points of a bank differ.
struct Input {
  std::string name;
  std::vector<std::string> keys; ///< "recipe.…", "case.…"; all get the same value
  double low = 0.0, high = 0.0;  ///< in the keys' unit
  Spread spread = Spread::Uniform;
  /// An effect acts in this share of the points and is off in the others; 1: no effect.
  double share = 1.0;
  std::string off; ///< the keys' value without the effect
  /// Earlier inputs that are off where this one acts: a contact follows one law.
  std::vector<std::string> excludes;

  bool is_film() const { return !keys.empty() && keys.front().rfind("recipe.", 0) == 0; }
  bool is_effect() const { return !off.empty(); }
};

/// A second, larger cell.
struct LargerCell {
  double share = 0.0;                        ///< of the points that are run on it
  std::map<std::string, std::string> recipe; ///< its keys
};

struct Design {
  std::vector<Input> inputs;
  LargerCell larger;
  int points = 0, packings = 24;
  std::uint64_t seed = 1;
};

struct Point {
  int number = 0;             ///< from 1
  int packing = 1;            ///< seed of the recipe
  std::vector<double> values; ///< of the inputs; NaN: the effect is off
  bool larger = false;        ///< on the larger cell
};

/// A Sobol sequence over the ranges of all inputs, over which effects act, and over the cells; packings
/// in turn. More points go on where fewer ended.
std::vector<Point> points_of(const Design &design);

/// Keys that differ between points, and a row of their values for each.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
};
/// `recipe`: its values, of the keys that only the larger cell has otherwise.
Columns columns_of(const Design &design, const std::vector<Point> &points,
                   const std::map<std::string, std::string> &recipe);

} // namespace calendem::bank

#endif
