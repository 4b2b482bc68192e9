// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/registry.h"
#include "base/messages.h"
#include "base/recipe.h"
#include "base/shown.h"
#include "effects/settings.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <utility>

namespace calendem {

namespace {

// A value out of range that would be in range in another unit of the same kind.
std::string unit_hint(const Key &key, double value) {
  static const std::vector<std::pair<const char *, std::vector<std::pair<const char *, double>>>>
      kinds = {{"GPa", {{"MPa", 1e3}, {"kPa", 1e6}, {"Pa", 1e9}}},
               {"MPa", {{"Pa", 1e6}, {"kPa", 1e3}, {"GPa", 1e-3}}},
               {"um", {{"mm", 1e-3}, {"nm", 1e3}, {"m", 1e-6}}},
               {"mm", {{"um", 1e3}, {"cm", 0.1}, {"m", 1e-3}}},
               {"us", {{"ms", 1e-3}, {"s", 1e-6}, {"ns", 1e3}}},
               {"m/s", {{"mm/s", 1e3}, {"um/s", 1e6}}},
               {"mg", {{"g", 1e-3}, {"ug", 1e3}}},
               {"mg/cm2", {{"g/m2", 10.0}, {"g/cm2", 1e-3}, {"kg/m2", 1e-2}}},
               {"g/cm3", {{"kg/m3", 1e3}}},
               {"%", {{"a fraction", 1e-2}}},
               {"fraction", {{"percent", 100.0}}}};
  for (const auto &[unit, others] : kinds)
    if (key.unit == unit)
      for (const auto &[other, factor] : others)
        if (value / factor >= key.low && value / factor <= key.high)
          return fmt::format(" It looks like a value in {}; here it would be {:.6g} {}.", other,
                             value / factor, unit);
  return "";
}

} // namespace

const Key *find_key(const std::vector<Key> &keys, const std::string &name) {
  const auto at =
      std::find_if(keys.begin(), keys.end(), [&](const Key &k) { return k.name == name; });
  return at == keys.end() ? nullptr : &*at;
}

std::optional<std::string> wrong_number(const Key &key, double value) {
  const std::string unit = key.unit.empty() ? "" : " " + key.unit;
  if (!std::isfinite(value))
    return fmt::format("{} is {}; it must be a finite number between {:.6g} and {:.6g}{}.",
                       key.name, value, key.low, key.high, unit);
  if (value < key.low || value > key.high)
    return fmt::format("{} is {:.10g}; allowed is {:.6g} to {:.6g}{} ({}).{}", key.name, value,
                       key.low, key.high, unit, key.meaning, unit_hint(key, value));
  if (key.whole && value != std::floor(value))
    return fmt::format("{} is {:.10g}; it must be a whole number ({}).", key.name, value,
                       key.meaning);
  return std::nullopt;
}

std::optional<std::string> wrong_text(const Key &key, const std::string &value) {
  if (key.choices.empty())
    return value.empty()
               ? std::optional(fmt::format("{} is empty; give a text ({}).", key.name, key.meaning))
               : std::nullopt;
  std::vector<std::string> choices;
  std::istringstream list(key.choices);
  for (std::string choice; std::getline(list, choice, '|');)
    choices.push_back(choice);
  if (std::find(choices.begin(), choices.end(), value) != choices.end())
    return std::nullopt;
  return fmt::format("{} is \"{}\"; it must be one of {}. The closest is \"{}\".", key.name, value,
                     key.choices, closest(value, choices));
}

bool wants_text(const Key &key) { return key.text || !key.choices.empty(); }

std::optional<std::string> wrong_cell(const Key &key, const std::string &cell) {
  if (wants_text(key))
    return wrong_text(key, cell);
  char *end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  if (cell.empty() || *end != '\0')
    return fmt::format("{} is '{}'; it must be a number ({}).", key.name, cell, key.meaning);
  return wrong_number(key, value);
}

std::string last_part(const std::string &name) { return name.substr(name.rfind('.') + 1); }

int edit_distance(const std::string &a, const std::string &b) {
  std::vector<int> row(b.size() + 1);
  for (size_t j = 0; j < row.size(); ++j)
    row[j] = static_cast<int>(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const int up = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = up;
    }
  }
  return row[b.size()];
}

std::string closest(const std::string &word, const std::vector<std::string> &words) {
  return *std::min_element(words.begin(), words.end(),
                           [&](const std::string &a, const std::string &b) {
                             return edit_distance(word, a) < edit_distance(word, b);
                           });
}

std::string did_you_mean(const std::string &typed, const std::string &meant) {
  const NameAndUnit words = in_words(meant);
  const std::string stem = meant.substr(0, words.name.size()) + "_";
  const bool unit_differs = !words.unit.empty() && typed.rfind(stem, 0) == 0;
  return fmt::format("Did you mean '{}'?{}", meant,
                     unit_differs ? " Its unit is" + words.unit + "." : "");
}

namespace {

constexpr int kMostTypingErrors = 2;

std::set<std::string> words_of(const std::string &name) {
  std::set<std::string> words{""};
  std::string word;
  for (char c : name + '.')
    if (c == '.' || c == '_')
      words.insert(std::exchange(word, ""));
    else
      word += c;
  return words;
}

/// Letters of the words that both names have.
size_t in_common(const std::string &a, const std::string &b) {
  const std::set<std::string> words = words_of(a);
  size_t letters = 0;
  for (const std::string &word : words_of(b))
    letters += words.count(word) != 0U ? word.size() : 0;
  return letters;
}

} // namespace

std::string likely_meant(const std::string &name, const std::vector<Key> &keys) {
  const std::string last = last_part(name), table = name.substr(0, name.size() - last.size());
  const std::set<std::string> words = words_of(last);
  std::vector<std::string> longer, same, all, like;
  size_t most = 0;
  for (const Key &key : keys) {
    const std::set<std::string> of_key = words_of(last_part(key.name));
    if (key.name.rfind(table, 0) == 0 &&
        std::includes(of_key.begin(), of_key.end(), words.begin(), words.end()))
      longer.push_back(key.name);
    if (last_part(key.name) == last || key.variable == last)
      same.push_back(key.name);
    all.push_back(key.name);
    most = std::max(most, in_common(name, key.name));
  }
  for (const auto &candidates : {longer, same})
    if (!candidates.empty())
      return closest(name, candidates);
  const std::string spelt = closest(name, all);
  if (edit_distance(name, spelt) <= kMostTypingErrors)
    return spelt;
  for (const std::string &other : all)
    if (in_common(name, other) == most)
      like.push_back(other);
  return closest(name, like);
}

const Effect &find_effect(const std::string &name) {
  const auto at = std::find_if(effects().begin(), effects().end(),
                               [&](const Effect &e) { return e.name == name; });
  if (at != effects().end())
    return *at;
  std::vector<std::string> names;
  for (const Effect &e : effects())
    names.push_back(e.name);
  throw Failure(kBadInput, "there is no effect '{}'. Did you mean '{}'? Known are {}.", name,
                closest(name, names), fmt::join(names, ", "));
}

const Key &key_of(const Effect &e) {
  return *find_key(e.in_recipe ? recipe_keys() : case_keys(), e.parameter.keys.front());
}

std::string folder_of_tests(const Effect &e) {
  const bool bare = e.verification.find('/') == std::string::npos;
  return (bare ? "verification/" : "") + e.verification;
}

nlohmann::json to_json(const Effect &e) {
  const EffectParameter &a = e.parameter;
  return {{"name", e.name},
          {"layer", e.layer},
          {"what", e.what},
          {"keys", a.keys},
          {"keys_of", e.in_recipe ? "recipe" : "case"},
          {"off", a.off},
          {"low", a.low},
          {"high", a.high},
          {"prior", a.spread == Spread::Uniform ? "uniform" : "log-uniform"},
          {"stronger_when", a.scale == AmplitudeScale::Reciprocal ? "smaller" : "larger"},
          {"simulated", !e.instrument},
          {"moves", e.moves},
          {"source", e.source},
          {"law", "src_plugin/physics/" + e.law},
          {"verification", e.verification}};
}

} // namespace calendem
