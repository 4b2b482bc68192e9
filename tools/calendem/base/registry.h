// SPDX-License-Identifier: GPL-2.0-or-later
// What the registry knows, for messages: what a key may hold, and an effect by its name, as JSON.
#ifndef CALENDEM_BASE_REGISTRY_H
#define CALENDEM_BASE_REGISTRY_H

#include "effects/effects.h"
#include "effects/key.h"
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace calendem {

/// The key of that name; null: there is none.
const Key *find_key(const std::vector<Key> &keys, const std::string &name);

/// What is wrong with a number or text for this key; nothing if it is good.
std::optional<std::string> wrong_number(const Key &key, double value);
std::optional<std::string> wrong_text(const Key &key, const std::string &value);

/// What is wrong with a value that stands in a file without types (CSV).
std::optional<std::string> wrong_cell(const Key &key, const std::string &cell);
/// The key holds a text, not a number.
bool wants_text(const Key &key);

/// The word of `words` that is the fewest typing errors away from `word`; `words` is not empty.
std::string closest(const std::string &word, const std::vector<std::string> &words);
/// "Did you mean 'meant'?", and its unit where only that differs.
std::string did_you_mean(const std::string &typed, const std::string &meant);
int edit_distance(const std::string &a, const std::string &b);
/// What stands behind the last dot of a key's name.
std::string last_part(const std::string &name);

/// The key that a user who wrote `name` most likely meant: all its words in its table, its last part
/// in another, the input scripts' name of it, a typing error, else most words in common.
std::string likely_meant(const std::string &name, const std::vector<Key> &keys);

/// Throws Failure(2) with the names there are.
const Effect &find_effect(const std::string &name);

/// The first key that its parameter moves, of the case or of the recipe.
const Key &key_of(const Effect &effect);

/// Folder in tests/ that checks it.
std::string folder_of_tests(const Effect &effect);

nlohmann::json to_json(const Effect &effect);

} // namespace calendem

#endif
