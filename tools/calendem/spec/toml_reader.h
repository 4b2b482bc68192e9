// SPDX-License-Identifier: GPL-2.0-or-later
// Reads a TOML file against a table of keys: a new key is one row of that table.
#ifndef CALENDEM_SPEC_TOML_READER_H
#define CALENDEM_SPEC_TOML_READER_H

#include "spec/messages.h"
#include <map>
#include <string>
#include <vector>

namespace calendem {

/// A key of a file. `choices` not empty, or `text`: a string; otherwise a number in [low, high].
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
};

/// Values by key name, as text exactly as given (numbers: shortest form that reads back).
class Settings {
public:
  double number(const std::string &name) const;
  const std::string &text(const std::string &name) const { return values_.at(name); }
  void set(const std::string &name, const std::string &value) { values_[name] = value; }
  const std::map<std::string, std::string> &all() const { return values_; }

private:
  std::map<std::string, std::string> values_;
};

/// All mistakes go to `mistakes`; what could be read is returned, defaults filled in.
Settings read_toml(const std::string &file, const std::vector<Key> &keys, Mistakes &mistakes);

/// Writes the settings as a TOML file that reads back the same.
std::string write_toml(const Settings &settings, const std::vector<Key> &keys,
                       const std::string &heading);

/// One line per key for --help: name, default, unit, range or choices, meaning.
std::string list_of_keys(const std::vector<Key> &keys);

} // namespace calendem

#endif
