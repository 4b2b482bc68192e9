// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/table_reader.h"
#include <algorithm>

namespace calendem {

void TableReader::each_table(const toml::table &root, const std::string &name,
                             const std::function<void(const toml::table &)> &read) {
  const toml::node *list = root.get(name);
  if (list && !list->is_array_of_tables())
    refuse(*list, "write each {0} as a table: [[{0}]].", name);
  else if (list)
    for (const toml::node &node : *list->as_array())
      read(*node.as_table());
}

void TableReader::unknown(const std::string &name, int line,
                          const std::vector<std::string> &known) {
  mistakes_.add(line, "unknown key '{}'. {}", name,
                did_you_mean(name, closest(last_part(name), known)));
}

void TableReader::report_unknown(const toml::table &table, const std::vector<std::string> &known,
                                 const std::string &prefix) {
  for (const auto &[key, node] : table)
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      unknown(prefix + std::string(key.str()), line_of(node), known);
}

void TableReader::report_missing(const toml::table &table, const Key &key) {
  if (key.fallback.empty() && whole_)
    refuse(table, "key '{}' is missing ({}).", key.name, key.meaning);
}

std::string TableReader::text(const toml::table &table, const Key &key) {
  const toml::node *node = table.get(key.name);
  if (!node) {
    report_missing(table, key);
    return key.fallback == "-" ? "" : key.fallback;
  }
  if (!node->is_string())
    refuse(*node, "{} must be a text in quotes ({}), not {}.", key.name, key.meaning, shown(*node));
  else if (const auto wrong = wrong_text(key, **node->as_string()))
    refuse(*node, "{}", *wrong);
  else
    return **node->as_string();
  return "";
}

std::optional<double> TableReader::number(const toml::node &node, const Key &key) {
  if (!node.is_number())
    refuse(node, "{} must be a number without quotes ({}), not {}.", key.name, key.meaning,
           shown(node));
  else if (const auto wrong = wrong_number(key, *node.value<double>()))
    refuse(node, "{}", *wrong);
  else
    return *node.value<double>();
  return std::nullopt;
}

double TableReader::number(const toml::table &table, const Key &key) {
  if (const toml::node *node = table.get(key.name))
    return number(*node, key).value_or(0.0);
  report_missing(table, key);
  return key.fallback.empty() || key.fallback == "-" ? 0.0 : std::stod(key.fallback);
}

std::vector<double> TableReader::numbers(const toml::table &table, const Key &key) {
  std::vector<double> out;
  const toml::node *node = table.get(key.name);
  if (!node) {
    report_missing(table, key);
    return out;
  }
  const toml::array *list = node->as_array();
  if (!list) {
    refuse(*node, "{} must be a list of numbers, not {}.", key.name, shown(*node));
    return out;
  }
  for (const toml::node &n : *list)
    if (const auto value = number(n, key))
      out.push_back(*value);
  return out;
}

std::vector<std::string> TableReader::texts(const toml::table &table, const std::string &key) {
  std::vector<std::string> out;
  const toml::node *node = table.get(key);
  if (!node)
    return out;
  const toml::array *list = node->as_array();
  if (!list) {
    refuse(*node, "{} must be a list of texts in quotes, not {}.", key, shown(*node));
    return out;
  }
  for (const toml::node &n : *list)
    if (n.is_string())
      out.push_back(**n.as_string());
    else
      refuse(n, "{} holds {}; it must hold texts in quotes.", key, shown(n));
  return out;
}

std::string TableReader::path(const toml::table &table, const Key &key) {
  const std::string given = text(table, key);
  return given.empty() ? "" : (folder_ / given).lexically_normal().string();
}

} // namespace calendem
