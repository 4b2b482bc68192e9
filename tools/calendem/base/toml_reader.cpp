// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/toml_reader.h"
#include "base/toml_file.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

std::optional<std::string> wrong_value(const Key &key, const toml::node &node) {
  if (wants_text(key) && node.is_string())
    return wrong_text(key, **node.as_string());
  if (!wants_text(key) && node.is_number())
    return wrong_number(key, *node.value<double>());
  return fmt::format("{} must be a {} ({}), not {}.", key.name,
                     wants_text(key) ? "text in quotes" : "number without quotes", key.meaning,
                     shown(node));
}

/// The tables that the keys stand in: "material", "material.am", ...
std::vector<std::string> tables_of(const std::vector<Key> &keys) {
  std::vector<std::string> tables;
  for (const Key &key : keys)
    for (size_t dot = key.name.find('.'); dot != std::string::npos;
         dot = key.name.find('.', dot + 1))
      if (const std::string table = key.name.substr(0, dot);
          std::find(tables.begin(), tables.end(), table) == tables.end())
        tables.push_back(table);
  return tables;
}

/// Goes through a file, table by table.
class Reader {
public:
  Reader(const std::vector<Key> &keys, Settings &out, Mistakes &mistakes)
      : keys_(keys), tables_(tables_of(keys)), out_(out), mistakes_(mistakes) {}

  void walk(const std::string &prefix, const toml::table &table) {
    for (const auto &[k, node] : table) {
      const std::string name = prefix + std::string(k.str());
      const auto key =
          std::find_if(keys_.begin(), keys_.end(), [&](const Key &x) { return x.name == name; });
      if (key != keys_.end())
        read(*key, node);
      else if (node.is_table())
        enter(name, *node.as_table());
      else
        mistakes_.add(line_of(node), fmt::format("unknown key '{}'. Did you mean '{}'?", name,
                                                 likely_meant(name, keys_)));
    }
  }

private:
  const std::vector<Key> &keys_;
  std::vector<std::string> tables_;
  Settings &out_;
  Mistakes &mistakes_;

  void read(const Key &key, const toml::node &node) {
    const auto wrong = wrong_value(key, node);
    out_.note(key.name, line_of(node), wrong.has_value());
    if (wrong)
      mistakes_.add(line_of(node), *wrong);
    else
      out_.set(key.name,
               node.is_string() ? **node.as_string() : fmt::format("{}", *node.value<double>()));
  }

  // The keys of a misspelt table are checked as those of the table that was meant.
  void enter(const std::string &name, const toml::table &table) {
    if (std::find(tables_.begin(), tables_.end(), name) != tables_.end())
      return walk(name + ".", table);
    const std::string meant = tables_.empty() ? name : closest(name, tables_);
    const bool misspelt = edit_distance(name, meant) <= 2;
    mistakes_.add(line_of(table),
                  misspelt ? fmt::format("unknown table [{}]. Did you mean [{}]?", name, meant)
                           : fmt::format("unknown table [{}]; known are [{}].", name,
                                         fmt::join(tables_, "], [")));
    if (misspelt)
      walk(meant + ".", table);
  }
};

} // namespace

double Settings::number(const std::string &name) const { return std::stod(values_.at(name)); }

void Settings::set(const std::string &name, const std::string &value) {
  follows_.erase(name);
  left_by_.erase(name);
  values_[name] = value;
  for (const auto &[follower, other] : follows_)
    if (other == name)
      values_[follower] = value;
  update_rests();
}

void Settings::update_rests() {
  for (const auto &[name, others] : left_by_) {
    double left = 100.0;
    for (const std::string &other : others)
      left -= number(other);
    values_[name] = fmt::format("{:.10g}", left);
  }
}

void Settings::leave(const std::string &name, const std::vector<std::string> &others) {
  left_by_[name] = others;
  update_rests();
}

void Settings::follow(const std::string &name, const std::string &other) {
  values_[name] = values_.at(other);
  follows_[name] = other;
}

int Settings::line(const std::string &name) const {
  const auto at = lines_.find(name);
  return at == lines_.end() ? 0 : at->second;
}

bool Settings::sound(std::initializer_list<std::string> names) const {
  return std::none_of(names.begin(), names.end(),
                      [this](const std::string &name) { return wrong_.count(name) > 0; });
}

void Settings::note(const std::string &name, int line, bool wrong) {
  lines_[name] = line;
  if (wrong)
    wrong_.insert(name);
}

std::string path_of(const Settings &s, const std::string &key, const std::string &file) {
  const std::filesystem::path given = s.text(key);
  return given == "none"
             ? ""
             : (std::filesystem::absolute(file).parent_path() / given).lexically_normal().string();
}

Settings read_toml(const std::string &file, FileKind kind, const std::vector<Key> &keys,
                   Mistakes &mistakes) {
  Settings out;
  const TomlFile parsed = parse_toml(file, kind, mistakes);
  Reader(keys, out, mistakes).walk("", parsed.root);
  for (const Key &key : keys) {
    if (out.all().count(key.name))
      continue;
    if (!key.same_as.empty()) {
      out.follow(key.name, key.same_as);
      continue;
    }
    const bool is_number = !key.fallback.empty() && !wants_text(key);
    out.set(key.name, is_number ? fmt::format("{}", std::stod(key.fallback)) : key.fallback);
    if (!key.fallback.empty())
      continue;
    if (out.line(key.name) > 0) // given, but wrong
      continue;
    if (parsed.whole && !parsed.root.empty())
      mistakes.add(0, fmt::format("key '{}' is missing ({}).", key.name, key.meaning));
    out.note(key.name, 0, true);
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
    const std::string unit = key.unit.empty() ? "" : key.unit + ", ";
    out += fmt::format("{} = {}  # {}{}\n", key.name.substr(dot == std::string::npos ? 0 : dot + 1),
                       wants_text(key) ? nlohmann::json(value).dump() : value, unit, key.meaning);
  }
  return heading + out;
}

std::string list_of_keys(const std::vector<Key> &keys) {
  std::string text = "Keys of the file: name, default, unit, range, meaning\n";
  for (const Key &k : keys) {
    std::string range = k.choices;
    if (range.empty() && !k.text)
      range = fmt::format("{:g}..{:g}", k.low, k.high);
    const std::string fallback = !k.same_as.empty() ? "same" : k.fallback;
    text += fmt::format("  {:<36} {:>8} {:<7} {:<27} {}{}\n", k.name,
                        fallback.empty() ? "required" : fallback, k.unit, range, k.meaning,
                        k.same_as.empty() ? "" : "; that of " + k.same_as + " unless given");
  }
  return text;
}

} // namespace calendem
