// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/toml_file.h"
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

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
    mistakes.add(0, "is a folder; a TOML file is wanted here.");
    return text;
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    mistakes.add(0, fmt::format("cannot be read: {}.", std::strerror(errno)));
    return text;
  }
  text.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  if (std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c); })) {
    mistakes.add(0, "the file is empty. input_scripts/cases/ has examples to start from.");
    text.clear();
  }
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

} // namespace

TomlFile parse_toml(const std::string &file, Mistakes &mistakes) {
  std::string text = read_text(file, mistakes);
  if (text.empty())
    return {};
  for (int errors = 0; errors < kMostSyntaxErrors; ++errors)
    try {
      return {toml::parse(text, file), errors == 0};
    } catch (const toml::parse_error &e) {
      const int line = static_cast<int>(e.source().begin.line);
      const auto [begin, end] = place_of(text, line);
      const std::string content = text.substr(begin, std::min<size_t>(end - begin, 60));
      mistakes.add(line, fmt::format("not valid TOML: {}. The line is: {}", e.description(),
                                     content.empty() ? "(the file's end)" : content));
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
  const char *what, *verbs;
  std::vector<std::string> tables; ///< and keys that identify it, alone or together
};

const std::vector<Described> &kinds() {
  static const std::vector<Described> all = {
      {FileKind::Recipe,
       "an electrode's recipe",
       "pack",
       {"coating", "cell", "structure", "shapes"}},
      {FileKind::Film,
       "the recipe of a film",
       "dry",
       {"coating", "cell", "shapes", "slurry", "drying"}},
      {FileKind::Tomogram, "the description of a tomogram", "tomogram", {"image"}},
      {FileKind::Case, "a case", "run", {"electrode", "platen", "bond", "material", "numerics"}},
      {FileKind::Experiment, "an experiment", "compare or diagnose", {"experiment", "condition"}},
      {FileKind::Study, "a study", "study", {"study", "vary"}},
      {FileKind::Bank, "a bank", "bank", {"bank", "full_cell", "numerics"}},
      {FileKind::Round, "a withheld round", "withheld make", {"round"}}};
  return all;
}

bool has(const Described &d, std::string_view table) {
  return std::find(d.tables.begin(), d.tables.end(), table) != d.tables.end();
}

/// Tables and keys of the file that identify its kind.
std::vector<std::string> identifying_keys(const toml::table &root) {
  std::vector<std::string> out;
  for (const auto &[key, node] : root)
    if (std::any_of(kinds().begin(), kinds().end(),
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
  const auto right = std::find_if(kinds().begin(), kinds().end(), is_wanted);
  const auto is = std::find_if(kinds().begin(), kinds().end(), fits);
  if (!found.empty() && is != kinds().end() && !fits(*right))
    throw Failure(
        kBadInput,
        fmt::format("{}: this is {} (it has '{}'); {} is wanted here. Give it to calendem "
                    "{}; input_scripts/cases/ has examples of each.",
                    file, is->what, fmt::join(found, "', '"), right->what, is->verbs));
  return out;
}

} // namespace calendem
