// SPDX-License-Identifier: GPL-2.0-or-later
#include "spec/toml_reader.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <toml++/toml.h>

namespace calendem {
namespace {

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

std::string closest(const std::string &name, const std::vector<Key> &keys) {
  const auto best = std::min_element(keys.begin(), keys.end(), [&](const Key &a, const Key &b) {
    return edit_distance(name, a.name) < edit_distance(name, b.name);
  });
  return best->name;
}

// A value far out of range that would be in range in another unit of the same kind.
std::string unit_hint(const Key &key, double value) {
  static const std::vector<std::pair<const char *, std::vector<std::pair<const char *, double>>>>
      kinds = {{"GPa", {{"MPa", 1e3}, {"kPa", 1e6}, {"Pa", 1e9}}},
               {"MPa", {{"kPa", 1e3}, {"Pa", 1e6}, {"GPa", 1e-3}}},
               {"um", {{"mm", 1e-3}, {"nm", 1e3}, {"m", 1e-6}}},
               {"us", {{"ms", 1e-3}, {"s", 1e-6}, {"ns", 1e3}}},
               {"g/cm3", {{"kg/m3", 1e3}}},
               {"%", {{"a fraction", 1e-2}}}};
  for (const auto &[unit, others] : kinds)
    if (key.unit == unit)
      for (const auto &[other, factor] : others)
        if (value / factor >= key.low && value / factor <= key.high)
          return fmt::format(" It looks like a value in {}; this key is in {}.", other, unit);
  return "";
}

void check_number(const Key &key, double value, int line, Settings &out, Mistakes &mistakes) {
  const std::string unit = key.unit.empty() ? "" : " " + key.unit;
  if (!std::isfinite(value))
    mistakes.add(line, fmt::format("{} is {}; it must be a finite number between {} and {}{}.",
                                   key.name, value, key.low, key.high, unit));
  else if (value < key.low || value > key.high)
    mistakes.add(line, fmt::format("{} is {}; allowed is {} to {}{} ({}).{}", key.name, value,
                                   key.low, key.high, unit, key.meaning, unit_hint(key, value)));
  else
    out.set(key.name, fmt::format("{}", value));
}

void check_text(const Key &key, const std::string &value, int line, Settings &out,
                Mistakes &mistakes) {
  const std::string padded = "|" + key.choices + "|";
  if (!key.choices.empty() && padded.find("|" + value + "|") == std::string::npos)
    mistakes.add(line,
                 fmt::format("{} is \"{}\"; it must be one of {}.", key.name, value, key.choices));
  else
    out.set(key.name, value);
}

void read_value(const std::string &name, const toml::node &node, const std::vector<Key> &keys,
                Settings &out, Mistakes &mistakes) {
  const int line = static_cast<int>(node.source().begin.line);
  const auto key =
      std::find_if(keys.begin(), keys.end(), [&](const Key &k) { return k.name == name; });
  if (key == keys.end()) {
    mistakes.add(line, fmt::format("unknown key '{}'. The closest known key is '{}'.", name,
                                   closest(name, keys)));
    return;
  }
  const bool wants_text = key->text || !key->choices.empty();
  if (wants_text && node.is_string())
    check_text(*key, **node.as_string(), line, out, mistakes);
  else if (!wants_text && node.is_number())
    check_number(*key, *node.value<double>(), line, out, mistakes);
  else
    mistakes.add(line, fmt::format("{} must be a {} ({}).", name,
                                   wants_text ? "text in quotes" : "number without quotes",
                                   key->meaning));
}

void walk(const std::string &prefix, const toml::table &table, const std::vector<Key> &keys,
          Settings &out, Mistakes &mistakes) {
  for (const auto &[k, node] : table) {
    const std::string name = prefix + std::string(k.str());
    if (node.is_table())
      walk(name + ".", *node.as_table(), keys, out, mistakes);
    else
      read_value(name, node, keys, out, mistakes);
  }
}

} // namespace

double Settings::number(const std::string &name) const { return std::stod(values_.at(name)); }

Settings read_toml(const std::string &file, const std::vector<Key> &keys, Mistakes &mistakes) {
  Settings out;
  if (!std::filesystem::is_regular_file(file)) {
    mistakes.add(0, "no such file. Give the path of a TOML file that exists.");
    return out;
  }
  try {
    walk("", toml::parse_file(file), keys, out, mistakes);
  } catch (const toml::parse_error &e) {
    mistakes.add(static_cast<int>(e.source().begin.line),
                 fmt::format("not valid TOML: {}.", e.description()));
    return out;
  }
  for (const Key &key : keys)
    if (!out.all().count(key.name)) {
      if (!key.fallback.empty())
        out.set(key.name, key.fallback);
      else if (mistakes.empty())
        mistakes.add(0, fmt::format("key '{}' is missing ({}).", key.name, key.meaning));
    }
  return out;
}

std::string write_toml(const Settings &settings, const std::vector<Key> &keys,
                       const std::string &heading) {
  std::string out, table;
  for (const Key &key : keys) { // keys of a table stand together in the list
    const size_t dot = key.name.rfind('.');
    const std::string in = dot == std::string::npos ? "" : key.name.substr(0, dot);
    if (in != table)
      out += fmt::format("\n[{}]\n", in);
    table = in;
    const std::string &value = settings.text(key.name);
    const bool quoted = key.text || !key.choices.empty();
    const std::string unit = key.unit.empty() ? "" : key.unit + ", ";
    out += fmt::format("{} = {}  # {}{}\n", key.name.substr(dot == std::string::npos ? 0 : dot + 1),
                       quoted ? "\"" + value + "\"" : value, unit, key.meaning);
  }
  return heading + out;
}

std::string list_of_keys(const std::vector<Key> &keys) {
  std::string text = "Keys of the file: name, default, unit, range, meaning\n";
  for (const Key &k : keys) {
    std::string range = k.choices;
    if (range.empty() && !k.text)
      range = fmt::format("{:g}..{:g}", k.low, k.high);
    text += fmt::format("  {:<36} {:>8} {:<7} {:<27} {}\n", k.name,
                        k.fallback.empty() ? "required" : k.fallback, k.unit, range, k.meaning);
  }
  return text;
}

} // namespace calendem
