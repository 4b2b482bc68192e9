// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/experiment.h"
#include "base/provenance.h"
#include "base/recipe.h"
#include "base/registry.h"
#include "commands/commands.h"
#include "effects/settings.h"
#include "electrode/slurry/dry.h"
#include "electrode/tomogram.h"
#include <cctype>
#include <fmt/format.h>
#include <map>
#include <regex>
#include <utility>

namespace calendem {
namespace {

constexpr double kAnyWhole = 1e9; // no limit that a reader needs

std::string table_of(const Key &key) {
  const std::size_t dot = key.name.rfind('.');
  return dot == std::string::npos ? "" : key.name.substr(0, dot);
}

std::string in_table(const Key &key) { return key.name.substr(key.name.rfind('.') + 1); }

std::string default_on_page(const Key &key) {
  if (!key.same_as.empty())
    return fmt::format("that of `{}`", key.same_as);
  if (key.fallback == "-" || key.fallback == "none")
    return "none";
  return key.fallback.empty() ? "**required**" : fmt::format("`{}`", key.fallback);
}

/// Text of the rows as print has it: µm, g/cm³, a minus before a number, a dash between two.
std::string typeset_words(std::string text) {
  static const std::pair<std::regex, const char *> rules[] = {
      {std::regex("\\bum([23]?)\\b"), "µm$1"},
      {std::regex("\\bus\\b"), "µs"},
      {std::regex("\\b(m|cm|µm)2\\b"), "$1²"},
      {std::regex("\\b(m|cm|µm)3\\b"), "$1³"},
      {std::regex("/s2\\b"), "/s²"},
      {std::regex("([0-9])-([0-9])"), "$1–$2"},
      {std::regex("(^|[ (^])-([0-9a-z])"), "$1−$2"},
      {std::regex("e\\+0*([0-9])"), "e$1"},
      {std::regex("\\+-"), "±"}};
  for (const auto &[what, by] : rules)
    text = std::regex_replace(text, what, by);
  return text;
}

/// Typeset, but for DOIs, whose hyphens are part of an address.
std::string typeset(const std::string &text) {
  static const std::regex doi("doi:[^ ]*");
  std::string out;
  std::size_t at = 0;
  for (std::sregex_iterator found(text.begin(), text.end(), doi), end; found != end; ++found) {
    const auto begin = static_cast<std::size_t>(found->position());
    out += typeset_words(text.substr(at, begin - at)) + found->str();
    at = begin + static_cast<std::size_t>(found->length());
  }
  return out + typeset_words(text.substr(at));
}

std::string range_of(const Key &key) {
  if (!key.choices.empty()) {
    std::string out = "`" + key.choices + "`";
    for (std::size_t at = 0; (at = out.find('|', at)) != std::string::npos; at += 4)
      out.replace(at, 1, "`, `");
    return out;
  }
  if (key.text)
    return "text";
  if (key.whole && key.high >= kAnyWhole)
    return "whole number";
  const std::string range = fmt::format("{:g} to {:g}", key.low, key.high);
  return typeset(range + (key.unit.empty() ? "" : " " + key.unit)) + (key.whole ? ", whole" : "");
}

/// In a cell of a table a bar would end it.
std::string in_cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.insert(at, "\\");
  return text;
}

const char *const kHead = "| key | default | range | meaning |\n|---|---|---|---|\n";

std::string row(const Key &key) {
  return fmt::format("| `{}` | {} | {} | {} |\n", in_table(key), default_on_page(key),
                     range_of(key), in_cell(typeset(key.meaning)));
}

/// A heading and a table for each TOML table of the keys.
std::string tables(const std::vector<Key> &keys) {
  std::string out, table = "-";
  for (const Key &key : keys) {
    if (table_of(key) != table) {
      table = table_of(key);
      out += fmt::format("\n## {}\n\n{}",
                         table.empty() ? "Top of the file" : fmt::format("`[{}]`", table), kHead);
    }
    out += row(key);
  }
  return out;
}

/// The page with `made` between its marks; the text around them is written by hand.
GeneratedFile page(const std::string &top, const std::string &name,
                   const std::map<std::string, std::string> &made) {
  GeneratedFile out{fmt::format("docs/reference/{}.md", name), ""};
  out.text = text_of_file(top + "/" + out.path);
  for (const auto &[part, text] : made) {
    const std::string begin = fmt::format("<!-- {}, made by calendem registry -->\n", part),
                      end = fmt::format("\n<!-- end of {} -->\n", part);
    const std::size_t from = out.text.find(begin), to = out.text.find(end);
    if (from == std::string::npos || to == std::string::npos || to < from)
      throw Failure(kBadInput, "{}: the lines '{}' and '{}' are missing: put them where the {} go.",
                    out.path, begin.substr(0, begin.size() - 1), end.substr(1, end.size() - 2),
                    part);
    out.text.replace(from + begin.size(), to - from - begin.size(), text);
  }
  return out;
}

GeneratedFile film_page(const std::string &top) {
  std::vector<Key> keys;
  for (const Key &key : film_keys())
    if (const std::string table = table_of(key); table == "slurry" || table == "drying")
      keys.push_back(key);
  return page(top, "film", {{"keys", tables(keys)}});
}

GeneratedFile experiment_page(const std::string &top) {
  std::vector<Key> measured;
  for (const Quantity &q : quantities())
    measured.push_back(q.key);
  const auto rows = [](const std::vector<Key> &keys) {
    std::string out = std::string("\n") + kHead;
    for (const Key &key : keys)
      out += row(key);
    return out;
  };
  return page(top, "experiment",
              {{"keys of the experiment",
                rows(head_keys()) + "| `split` | none | `{ train = [ids], test = [ids] }` | ids of "
                                    "the conditions to calibrate on, and of those held out |\n"},
               {"keys of a condition", rows(condition_keys())},
               {"measured values", rows(measured)},
               {"keys of a crushed particle", rows(crushed_keys())}});
}

/// 600000000 as 6e8.
std::string without_many_zeros(const std::string &number) {
  const std::size_t zeros = number.size() - 1 - number.find_last_not_of('0');
  return number.find('.') == std::string::npos && zeros > 5 && zeros < number.size()
             ? fmt::format("{}e{}", number.substr(0, number.size() - zeros), zeros)
             : number;
}

std::string material_section(const std::string &name) {
  const ReferenceMaterial m = read_material(material_path(name, ""));
  std::string out = fmt::format(
      "\n## `{}`\n\n{}{}{}; {}.\n\n| key | value | source |\n|---|---|---|\n", name, m.name,
      m.also_called.empty() ? "" : ", also called ", fmt::join(m.also_called, ", "),
      m.calibrated() ? fmt::format("calibrated on: {}", fmt::join(m.calibrated_on, "; "))
                     : "**not calibrated**");
  for (const bool of_recipe : {true, false})
    for (const Key &key : of_recipe ? recipe_keys() : case_keys())
      if (const auto at = m.values.find(key.name); at != m.values.end())
        out += fmt::format(
            "| `{}` | {} | {} |\n", key.name,
            typeset(without_many_zeros(at->second.text) +
                    (at->second.sd > 0.0 ? fmt::format(" +- {:g}", at->second.sd) : "") +
                    (key.unit.empty() ? "" : " " + key.unit)),
            in_cell(typeset(at->second.source)));
  return out;
}

GeneratedFile materials_page(const std::string &top) {
  std::string sections;
  for (const std::string &name : known_materials())
    sections += material_section(name);
  return page(top, "materials", {{"materials", sections}});
}

std::string unit_of(const Effect &e) {
  const std::string unit = key_of(e).unit;
  return unit.empty() ? "" : " " + unit;
}

std::string effect_section(const Effect &e) {
  const EffectParameter &p = e.parameter;
  std::string what = e.what;
  what[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(what[0])));
  std::string out = fmt::format("\n## `{}`\n\n{} (layer: {}).\n\n", e.name, what, e.layer);
  if (!e.settings.empty()) {
    out += kHead;
    for (const Key &key : e.settings)
      out += row(key);
    out += "\n";
  }
  out += "Switched on by\n: ";
  for (const std::string &key : p.keys)
    out += (key == p.keys.front() ? "`" : ", `") + key + "`";
  out += fmt::format("{}; off at {}\n\n", e.in_recipe ? " of the recipe" : "", p.off);
  out += fmt::format(
      "Prior of the diagnosis\n: {}, {}{}\n\n",
      typeset(fmt::format("{:g} to {:g}{}", p.low, p.high, unit_of(e))),
      p.spread == Spread::Uniform ? "uniform" : "log-uniform",
      p.scale == AmplitudeScale::Reciprocal ? "; a smaller value is a stronger effect" : "");
  out += fmt::format("What it changes\n: {}\n\n", typeset(e.moves));
  out += fmt::format("Source\n: {}\n\n", typeset(e.source));
  out += fmt::format("Law and verification\n: `src_plugin/physics/{}`, `tests/{}`\n", e.law,
                     folder_of_tests(e));
  return out;
}

GeneratedFile effects_page(const std::string &top) {
  std::string list = "\n| effect | what it is |\n|---|---|\n", sections;
  for (const Effect &e : effects()) {
    list += fmt::format("| [`{0}`](#{0}) | {1} |\n", e.name, e.what);
    sections += effect_section(e);
  }
  return page(top, "effects", {{"effects", list + sections}});
}

} // namespace

std::vector<GeneratedFile> reference_pages(const std::string &top) {
  return {page(top, "case", {{"keys", tables(case_keys())}}),
          page(top, "recipe", {{"keys", tables(recipe_keys())}}),
          film_page(top),
          page(top, "tomogram", {{"keys", tables(tomogram_keys())}}),
          experiment_page(top),
          effects_page(top),
          materials_page(top)};
}

} // namespace calendem
