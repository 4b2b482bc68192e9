// SPDX-License-Identifier: GPL-2.0-or-later
// A TOML file against a table of keys: a new key is one row of that table. A line that is no TOML is
// a mistake and is left out, so that the mistakes of the other lines are found in the same go. A file
// of another kind than the wanted one (a recipe given to a verb that takes a case) is one message, not
// one for each of its keys.
#ifndef CALENDEM_BASE_TOML_READER_H
#define CALENDEM_BASE_TOML_READER_H

#include "base/messages.h"
#include "base/registry.h"
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <toml++/toml.h>
#include <vector>

namespace calendem {

struct TomlFile {
  toml::table root;
  bool whole = false; ///< every line could be read: a key that is not there is missing
};

/// Missing, unreadable and empty files are mistakes too.
TomlFile parse_toml(const std::string &file, Mistakes &mistakes);

inline int line_of(const toml::node &node) { return static_cast<int>(node.source().begin.line); }

/// A value as a message shows it: `"text"`, `3.5`, `a table`.
std::string shown(const toml::node &node);

enum class FileKind { Recipe, Film, Tomogram, Case, Experiment, Study, Bank, Material };

/// As parse_toml. Throws Failure(2) if the file's tables are those of another kind.
TomlFile parse_toml(const std::string &file, FileKind wanted, Mistakes &mistakes);

/// Values by key name, as text exactly as given (numbers: shortest form that reads back).
class Settings {
public:
  double number(const std::string &name) const;
  const std::string &text(const std::string &name) const { return values_.at(name); }
  /// Keys that follow this one keep up with it; a key that is set follows no other.
  void set(const std::string &name, const std::string &value);
  /// The key has the value of another, and keeps up with it.
  void follow(const std::string &name, const std::string &other);
  /// The key that this one follows; empty: none.
  std::string followed_by(const std::string &name) const;
  /// The key is 100 - sum(others), updated with them; all of them have values.
  void set_as_remainder(const std::string &name, const std::vector<std::string> &others);
  const std::map<std::string, std::string> &all() const { return values_; }

  /// Line of the file that gives the key, 0 if it has its default.
  int line(const std::string &name) const;
  /// None of these was given a value that is a mistake: what depends on them can be checked.
  bool sound(std::initializer_list<std::string> names) const;
  void note(const std::string &name, int line, bool wrong);

private:
  std::map<std::string, std::string> values_;
  std::map<std::string, std::string> follows_;                   ///< key, the one it follows
  std::map<std::string, std::vector<std::string>> remainder_of_; ///< key, the others
  std::map<std::string, int> lines_;
  std::set<std::string> wrong_;

  void update_remainders();
};

/// All mistakes go to `mistakes`; what could be read is returned, defaults filled in.
Settings read_toml(const std::string &file, FileKind kind, const std::vector<Key> &keys,
                   Mistakes &mistakes);

/// What is wrong with a value for this key, and the value as Settings hold it.
std::optional<std::string> wrong_value(const Key &key, const toml::node &node);
std::string value_text(const toml::node &node);

/// Sets the keys that have no value yet to their fallback, or lets them follow another.
void fill_in(const std::vector<Key> &keys, Settings &settings);

/// The path that a key gives, relative to the file it stands in, as an absolute one; empty for
/// "none".
std::string path_of(const Settings &settings, const std::string &key, const std::string &file);

/// Writes the settings as a TOML file that reads back the same.
std::string write_toml(const Settings &settings, const std::vector<Key> &keys,
                       const std::string &heading);

/// One line per key for --help: name, default, unit, range or choices, meaning.
std::string list_of_keys(const std::vector<Key> &keys);

} // namespace calendem

#endif
