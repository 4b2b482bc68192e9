// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/experiment.h"
#include "base/recipe.h"
#include "base/registry.h"
#include "commands/commands.h"
#include "effects/settings.h"
#include "electrode/slurry/dry.h"
#include "electrode/tomogram.h"
#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <regex>
#include <utility>

namespace calendem {
namespace {

constexpr double kAnyWhole = 1e9; // no limit that a reader needs

constexpr const char *kMadePage =
    "<!-- Made from the rows of the program by `calendem registry`; not to be edited. -->\n\n";

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
std::string typeset(std::string text) {
  static const std::pair<std::regex, const char *> rules[] = {
      {std::regex("\\bum\\b"), "µm"},
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

std::string page(const std::string &title, const std::string &text, const std::string &rest) {
  return kMadePage + fmt::format("# {}\n\n{}\n{}", title, text, rest);
}

std::string case_page() {
  return page(
      "Keys of a case",
      "A case is a TOML file that describes what `calendem run` simulates. Only `electrode` "
      "is required.\nPaths are relative to the file. The folder of a run contains "
      "`case.toml` with every default filled in.\n\n"
      "Keys under `[effects...]` switch on physics that the base model leaves out: see "
      "[Effects](effects.md).\nThe input scripts have the same settings, by the names in "
      "`input_scripts/common/defaults.in`, except a line load and\nits tolerance, and the "
      "thickness zero.",
      tables(case_keys()));
}

std::string recipe_page() {
  return page("Keys of a recipe",
              "A recipe is a TOML file from which `calendem pack` makes an electrode. No key is "
              "required: the defaults\ngive the electrode of the paper in a cell of 15 × 15 µm.\n"
              "`[shapes]` takes the shapes of particles from a tomogram, `[structure]` takes all "
              "particles from a data file of\nLAMMPS or LIGGGHTS. `calendem dry` reads a recipe "
              "with two more tables: see [Keys of a film](film.md).",
              tables(recipe_keys()));
}

std::string film_page() {
  std::vector<Key> keys;
  for (const Key &key : film_keys())
    if (const std::string table = table_of(key); table == "slurry" || table == "drying")
      keys.push_back(key);
  return page("Keys of a film",
              "The recipe of a film that `calendem dry` makes by simulating slurry and drying has "
              "the keys of a\n[recipe](recipe.md) except `[structure]` and "
              "`[effects.cbd_gradient]`, and these.",
              tables(keys));
}

std::string tomogram_page() {
  return page("Keys of a synthetic tomogram",
              "`calendem tomogram` makes a label image whose particles are known, to try the "
              "steps from an image to an\nelectrode.",
              tables(tomogram_keys()));
}

std::string experiment_page() {
  std::vector<Key> measured;
  for (const Quantity &q : quantities())
    measured.push_back(q.key);
  const auto rows = [](const std::vector<Key> &keys) {
    std::string out = kHead;
    for (const Key &key : keys)
      out += row(key);
    return out;
  };
  return page(
      "Keys of an experiment",
      "An experiment file contains the measured data for `calendem compare`, "
      "`calendem diagnose` and\n`calendem calibrate`. `calendem validate` reports every "
      "mistake in it.",
      "\n## `[experiment]`\n\n" + rows(head_keys()) +
          "| `split` | none | `{ train = [ids], test = [ids] }` | ids of the conditions to "
          "calibrate on, and of those held out |\n"
          "\n## `[[condition]]`\n\nOne table for each sample or pressure.\n\n" +
          rows(condition_keys()) +
          "\n### Measured values of a condition\n\nA number, `{ value, sd }` or "
          "`{ value, sd_relative }`. `mass_mg` and `thickness_after_um` also take\n"
          "`includes_foil`: a mass includes the foil unless it says otherwise, a thickness "
          "does not.\nA mass must be 0.5 to 100 mg/cm² on the disc. A coating must be as "
          "thick as its solid and have at most 90 % of pores; 6 µm\nfor a wrong zero of the "
          "gauge and three standard deviations are allowed for.\n\n" +
          rows(measured) +
          "\n## `[[crushed_particle]]`\n\nSingle particles of the powder, crushed one by "
          "one between two plates. `calendem calibrate` learns the strength of\nthe bonds "
          "from them, the other verbs do not compare them.\n\n" +
          rows(crushed_keys()));
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
            typeset(at->second.text +
                    (at->second.sd > 0.0 ? fmt::format(" +- {:g}", at->second.sd) : "") +
                    (key.unit.empty() ? "" : " " + key.unit)),
            in_cell(typeset(at->second.source)));
  return out;
}

std::string materials_page() {
  std::string sections;
  for (const std::string &name : known_materials())
    sections += material_section(name);
  return page(
      "Materials",
      "A [recipe](recipe.md) names what its electrode is made of by the key `material`: one "
      "of these, or the path of a file of\nyour own. Its values stand between the keys' "
      "defaults and what recipe and case give; each has its source. `pack` keeps\nthem in "
      "`electrode.json`, and writes what the input scripts need into `electrode.in`.\n\n"
      "A file has `name`, `also_called`, `calibrated_on` (lists; an empty one: not "
      "calibrated), may take the values of another\nby `base = \"nmc111\"`, and gives keys "
      "of the [case](case.md) (`material`, `bond`, effects of contacts and bonds) and "
      "of the\nrecipe (densities, primaries, irregularity, nanoporosity) as `{ value = 0.15, "
      "sd = 0.05, source = \"doi:...\" }`.\n`calendem validate` checks it.",
      sections);
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

std::string effects_page() {
  std::string list = "\n| effect | what it is |\n|---|---|\n", sections;
  for (const Effect &e : effects()) {
    list += fmt::format("| [`{0}`](#{0}) | {1} |\n", e.name, e.what);
    sections += effect_section(e);
  }
  return page(
      "Effects",
      "Effects are physics that the base model leaves out. Each is off by default, has its law in "
      "`src_plugin/physics`,\nand is switched on by a key of the [case](case.md) or of the "
      "[recipe](recipe.md).\n`calendem effects NAME` prints the same. Equations are in "
      "[How the model works](../model/effects.md).\n\n"
      "A contact follows one law. Of the effects with a contact law (the plasticities, "
      "`cbd_viscoelasticity`, the confinements,\n`collector_indentation`) only one kind of law can "
      "act on the same pair of phases. Friction, collapse and bridges combine\nwith them; collapse "
      "and bridges exclude each other. The prior is that of the diagnosis; a key may have values "
      "outside it.",
      list + sections);
}

} // namespace

std::vector<GeneratedFile> reference_pages() {
  const std::string folder = "docs/reference/";
  return {{folder + "case.md", case_page()},
          {folder + "recipe.md", recipe_page()},
          {folder + "film.md", film_page()},
          {folder + "tomogram.md", tomogram_page()},
          {folder + "experiment.md", experiment_page()},
          {folder + "effects.md", effects_page()},
          {folder + "materials.md", materials_page()}};
}

} // namespace calendem
