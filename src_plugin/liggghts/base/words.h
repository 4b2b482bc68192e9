// SPDX-License-Identifier: GPL-2.0-or-later
// A number from a word of the script, within a range. What is no such number stops the run with the
// word, the value and what is allowed.
#ifndef CALENDEM_WORDS_H
#define CALENDEM_WORDS_H

#include "error.h"
#include "fix.h"
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace LAMMPS_NS {

struct NumberRange {
  double least = -HUGE_VAL, most = HUGE_VAL;
  bool above = false; ///< the least itself is not allowed
  bool whole = false;

  bool holds(double x) const {
    return std::isfinite(x) && (above ? x > least : x >= least) && x <= most &&
           (!whole || x == std::floor(x));
  }
  /// "a number between 0 and 1"
  std::string in_words() const {
    const bool two_sided = std::isfinite(least) && std::isfinite(most);
    char limits[80] = "";
    if (two_sided)
      snprintf(limits, sizeof limits,
               above ? " above %.10g and at most %.10g" : " between %.10g and %.10g", least, most);
    else if (std::isfinite(least))
      snprintf(limits, sizeof limits, " %s %.10g", above ? ">" : ">=", least);
    return std::string(whole       ? "a whole number"
                       : two_sided ? "a number"
                                   : "a finite number") +
           limits;
  }
};

inline NumberRange between(double least, double most) { return {least, most, false, false}; }
inline NumberRange whole_between(double least, double most) { return {least, most, false, true}; }
inline NumberRange above_and_at_most(double least, double most) {
  return {least, most, true, false};
}
const NumberRange kAnyNumber = {};
const NumberRange kPositive = {0.0, HUGE_VAL, true, false};
const NumberRange kNotNegative = {0.0, HUGE_VAL, false, false};
const NumberRange kFraction = {0.0, 1.0, false, false};
const NumberRange kBondRadius = {0.0, 1.5, true, false}; ///< over the smaller sphere's

/// Reads numbers of a fix: number("damping", arg[4], kFraction).
class NumberReader {
public:
  NumberReader(Error *error, Fix *fix) : error_(error), fix_(fix) {}

  double operator()(const std::string &name, const std::string &word,
                    const NumberRange &range) const {
    char *end = nullptr;
    const double value = strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !range.holds(value)) {
      const std::string message =
          "'" + name + "' is '" + word.substr(0, 40) + "'; it must be " + range.in_words();
      error_->fix_error(FLERR, fix_, message.c_str());
    }
    return value;
  }

private:
  Error *error_;
  Fix *fix_;
};

} // namespace LAMMPS_NS

#endif
