// SPDX-License-Identifier: GPL-2.0-or-later
// One key of a TOML file, what it may hold, and the messages when it holds something else.
#ifndef CALENDEM_SPEC_KEY_H
#define CALENDEM_SPEC_KEY_H

#include <optional>
#include <string>
#include <vector>

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
  bool whole = false; ///< a whole number
};

/// What is wrong with a number or text for this key; nothing if it is good.
std::optional<std::string> wrong_number(const Key &key, double value);
std::optional<std::string> wrong_text(const Key &key, const std::string &value);

/// What is wrong with a value that stands in a file without types (CSV).
std::optional<std::string> wrong_cell(const Key &key, const std::string &cell);
/// The key holds a text, not a number.
bool wants_text(const Key &key);

/// The word of `words` that is the fewest typing errors away from `word`; `words` is not empty.
std::string closest(const std::string &word, const std::vector<std::string> &words);
int edit_distance(const std::string &a, const std::string &b);

/// The key that a user who wrote `name` most likely meant: the same last part in another table, the
/// input scripts' name of it, else the closest spelling.
std::string likely_meant(const std::string &name, const std::vector<Key> &keys);

} // namespace calendem

#endif
