// SPDX-License-Identifier: GPL-2.0-or-later
// One key of a TOML file and what it may hold. A setting of the calendering case is such a key with
// the name that the input scripts know it by.
#ifndef CALENDEM_EFFECTS_KEY_H
#define CALENDEM_EFFECTS_KEY_H

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

  Key &follows(const std::string &key) { return set(same_as, key); }
  Key &means(const std::string &what) { return set(meaning, what); }
  Key &one_of(const std::string &words) { return set(choices, words); }
  Key &is_text() { return set(text, true); }
  Key &is_whole() { return set(whole, true); }
  Key &range(double from, double to, const std::string &in = "") {
    low = from;
    high = to;
    return set(unit, in);
  }

private:
  template <class T> Key &set(T &member, const T &value) {
    member = value;
    return *this;
  }
};

/// Begins a row that names what it sets: setting("bond.seed", ...).range(0, 4e9).is_whole().means("...").
/// @param variable of the script @param fallback its default; "": the key is required
inline Key setting(const std::string &name, const std::string &variable = "",
                   const std::string &fallback = "") {
  Key key;
  key.name = name;
  key.variable = variable;
  key.fallback = fallback;
  return key;
}

/// A row of a number: its range in `unit`, and what it means.
inline Key number(const std::string &name, const std::string &variable, const std::string &fallback,
                  double low, double high, const std::string &unit, const std::string &meaning) {
  return setting(name, variable, fallback).range(low, high, unit).means(meaning);
}

} // namespace calendem

#endif
