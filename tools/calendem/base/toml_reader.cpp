// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/toml_reader.h"
#include "base/plain_text.h"
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

namespace calendem {

namespace fs = std::filesystem;
namespace {

constexpr int kMostSyntaxErrors = 20;

/// The file's text; empty, with a mistake, if there is none.
std::string read_text(const std::string &file, Mistakes &mistakes) {
  std::error_code none;
  std::string text;
  if (!fs::exists(file, none)) {
    mistakes.add(0, "no such file. Give the path of a TOML file that exists.");
    return text;
  }
  if (fs::is_directory(file, none)) {
    mistakes.add(0, "is a folder; a TOML file is expected here.");
    return text;
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    mistakes.add(0, "cannot be read: {}.", std::strerror(errno));
    return text;
  }
  const PlainText read = plain_text({std::istreambuf_iterator<char>(in), {}});
  if (!read.wrong.empty())
    mistakes.add(0, "the file " + read.wrong);
  else if (read.text.find_first_not_of(" \t\n\v\f") == std::string::npos)
    mistakes.add(0, "the file is empty. input_scripts/cases/ has examples to start from.");
  else
    text = read.text;
  return text;
}
/// Start and end, without its newline, of line number `line` (from 1).
std::pair<size_t, size_t> place_of(const std::string &text, int line) {
  size_t begin = 0;
  for (int k = 1; k < line && begin != std::string::npos; ++k) {
    begin = text.find('\n', begin);
    begin += begin != std::string::npos;
  }
  if (begin == std::string::npos)
    return {text.size(), text.size()};
  return {begin, std::min(text.find('\n', begin), text.size())};
}

/// A line has a key, right or wrong, before its '='. Titles of other files have a sentence there,
/// comments of a CSV a '#'.
bool has_keys(const std::string &text) {
  constexpr long kMostWords = 3;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line.substr(0, line.find('=')));
    const long n = std::distance(std::istream_iterator<std::string>(words), {});
    const size_t first = line.find_first_not_of(" \t");
    if (line.find('=') != std::string::npos && line[first] != '#' && n <= kMostWords)
      return true;
  }
  return false;
}

} // namespace

TomlFile parse_toml(const std::string &file, Mistakes &mistakes) {
  std::string text = read_text(file, mistakes);
  if (text.empty())
    return {};
  const bool keys = has_keys(text);
  for (int errors = 0; errors < kMostSyntaxErrors; ++errors)
    try {
      return {toml::parse(text, file), errors == 0};
    } catch (const toml::parse_error &e) {
      if (!keys) {
        mistakes.add(0, "this is no TOML file: no line is KEY = VALUE. It begins with '{}'.",
                     text.substr(0, std::min<size_t>(text.find('\n'), 60)));
        return {};
      }
      const int line = static_cast<int>(e.source().begin.line);
      const auto [begin, end] = place_of(text, line);
      const std::string content = text.substr(begin, std::min<size_t>(end - begin, 60));
      mistakes.add(line, "not valid TOML: {}. The line is: {}", e.description(),
                   content.empty() ? "(the file's end)" : content);
      const size_t first = content.find_first_not_of(" \t");
      // Without a table's head the keys below it would be taken for those of the table above.
      if (first == std::string::npos || content[first] == '[')
        break;
      text.replace(begin, end - begin, end - begin, ' ');
    }
  return {};
}

std::string shown(const toml::node &node) {
  if (node.is_table())
    return "a table";
  if (node.is_array())
    return "a list";
  if (node.is_string())
    return "\"" + **node.as_string() + "\"";
  if (node.is_boolean())
    return **node.as_boolean() ? "true" : "false";
  if (node.is_number())
    return fmt::format("{:.10g}", *node.value<double>());
  return "a date or time";
}

namespace {

struct Described {
  FileKind kind;
  const char *what, *verbs,
      *tables; ///< and keys that identify it, alone or together, each in blanks
};
const Described kKinds[] = {
    {FileKind::Recipe, "an electrode's recipe", "pack", " coating cell structure shapes "},
    {FileKind::Film, "the recipe of a film", "dry", " coating cell shapes slurry drying "},
    {FileKind::Tomogram, "the description of a tomogram", "tomogram", " image "},
    {FileKind::Case, "a case", "run", " electrode platen bond material numerics "},
    {FileKind::Experiment, "an experiment", "compare, diagnose or calibrate",
     " experiment condition "},
    {FileKind::Study, "a study", "study", " study vary "},
    {FileKind::Bank, "a bank", "bank", " bank larger_cell numerics "},
    {FileKind::Material, "a material", "validate, or its path to the key 'material' of a recipe",
     " also_called calibrated_on base material bond "}};

bool has(const Described &d, std::string_view table) {
  return std::string(d.tables).find(" " + std::string(table) + " ") != std::string::npos;
}

/// Tables and keys of the file that identify its kind. A recipe names its material, which in a case
/// is a table.
std::vector<std::string> identifying_keys(const toml::table &root) {
  std::vector<std::string> out;
  for (const auto &[key, node] : root)
    if (!(key.str() == "material" && node.is_string()) &&
        std::any_of(std::begin(kKinds), std::end(kKinds),
                    [name = key.str()](const Described &d) { return has(d, name); }))
      out.emplace_back(key.str());
  return out;
}

} // namespace

TomlFile parse_toml(const std::string &file, FileKind wanted, Mistakes &mistakes) {
  TomlFile out = parse_toml(file, mistakes);
  const std::vector<std::string> found = identifying_keys(out.root);
  const auto fits = [&](const Described &d) {
    return std::all_of(found.begin(), found.end(),
                       [&](const std::string &name) { return has(d, name); });
  };
  const auto is_wanted = [&](const Described &d) { return d.kind == wanted; };
  const auto *right = std::find_if(std::begin(kKinds), std::end(kKinds), is_wanted);
  const auto *is = std::find_if(std::begin(kKinds), std::end(kKinds), fits);
  if (!found.empty() && is != std::end(kKinds) && !fits(*right))
    throw Failure(kBadInput,
                  "{}: this is {} (it has '{}'); {} is expected here. Give this file to calendem "
                  "{}; input_scripts/cases/ has examples of each.",
                  file, is->what, fmt::join(found, "', '"), right->what, is->verbs);
  return out;
}

std::optional<std::string> wrong_value(const Key &key, const toml::node &node) {
  if (wants_text(key) && node.is_string())
    return wrong_text(key, **node.as_string());
  if (!wants_text(key) && node.is_number())
    return wrong_number(key, *node.value<double>());
  return fmt::format("{} must be a {} ({}), not {}.", key.name,
                     wants_text(key) ? "text in quotes" : "number without quotes", key.meaning,
                     shown(node));
}

std::string value_text(const toml::node &node) {
  return node.is_string() ? **node.as_string() : fmt::format("{}", *node.value<double>());
}

namespace {

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
      if (const Key *key = find_key(keys_, name))
        read(*key, node);
      else if (node.is_table())
        enter(name, *node.as_table());
      else
        mistakes_.add(line_of(node), unknown_key(name));
    }
  }

private:
  std::string unknown_key(const std::string &name) const {
    return name.rfind("coating.thickness", 0) == 0
               ? fmt::format("unknown key '{}': the thickness follows from "
                             "coating.loading_mg_cm2 and coating.porosity_total_percent.",
                             name)
               : fmt::format("unknown key '{}'. {}", name,
                             did_you_mean(name, likely_meant(name, keys_)));
  }

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
      out_.set(key.name, value_text(node));
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
  remainder_of_.erase(name);
  values_[name] = value;
  for (const auto &[follower, other] : follows_)
    if (other == name)
      values_[follower] = value;
  update_remainders();
}

void Settings::update_remainders() {
  for (const auto &[name, others] : remainder_of_) {
    double left = 100.0;
    for (const std::string &other : others)
      left -= number(other);
    values_[name] = fmt::format("{:.10g}", left);
  }
}

void Settings::set_as_remainder(const std::string &name, const std::vector<std::string> &others) {
  remainder_of_[name] = others;
  update_remainders();
}

void Settings::follow(const std::string &name, const std::string &other) {
  values_[name] = values_.at(other);
  follows_[name] = other;
}

std::string Settings::followed_by(const std::string &name) const {
  const auto at = follows_.find(name);
  return at == follows_.end() ? "" : at->second;
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

void fill_in(const std::vector<Key> &keys, Settings &out) {
  for (const Key &key : keys)
    if (out.all().count(key.name))
      continue;
    else if (!key.same_as.empty())
      out.follow(key.name, key.same_as);
    else {
      const bool is_number = !key.fallback.empty() && !wants_text(key);
      out.set(key.name, is_number ? fmt::format("{}", std::stod(key.fallback)) : key.fallback);
    }
}

Settings read_toml(const std::string &file, FileKind kind, const std::vector<Key> &keys,
                   Mistakes &mistakes) {
  Settings out;
  const TomlFile parsed = parse_toml(file, kind, mistakes);
  Reader(keys, out, mistakes).walk("", parsed.root);
  for (const Key &key : keys) {
    if (out.all().count(key.name) || !key.fallback.empty() || !key.same_as.empty() ||
        out.line(key.name) > 0) // given, be it wrong
      continue;
    if (parsed.whole && !parsed.root.empty())
      mistakes.add(0, "key '{}' is missing ({}).", key.name, key.meaning);
    out.note(key.name, 0, true);
  }
  fill_in(keys, out);
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
