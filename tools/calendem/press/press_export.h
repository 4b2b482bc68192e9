// SPDX-License-Identifier: GPL-2.0-or-later
// What the program of a press exports: the columns of force, displacement and so on, by their names
// in English, German or French, with their units.
#ifndef CALENDEM_PRESS_PRESS_EXPORT_H
#define CALENDEM_PRESS_PRESS_EXPORT_H

#include <map>
#include <string>
#include <vector>

namespace calendem {

/// How to read an export; columns as NAME or NUMBER, with :UNIT where the name has none. A quantity
/// that is not named is looked for.
struct PressFormat {
  std::map<std::string, std::string> columns; ///< force, displacement, pressure, time, stage
  double area_mm2 = 0.0;                      ///< of the disc; 0: not given
  char decimal = 0;                           ///< '.' or ','; 0: find out
};

struct PressExport {
  std::vector<double> pressure;     ///< [MPa], compression positive
  std::vector<double> displacement; ///< [um], as the press counts it
  std::vector<double> time;         ///< [s]; empty: none
  std::vector<std::string> stage;   ///< loading, dwell or unloading; empty: none
  std::vector<std::string> said;    ///< how the file was read
};

/// Throws Failure(2) with what is missing or can be read in two ways, and the option that settles it.
PressExport read_press_export(const std::string &file, const PressFormat &format);

} // namespace calendem

#endif
