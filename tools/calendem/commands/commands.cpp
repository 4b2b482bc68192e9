// SPDX-License-Identifier: GPL-2.0-or-later
#include "commands/commands.h"
#include "base/registry.h"
#include "effects/effects_of_temperature.h"
#include "effects/settings.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace calendem {

namespace {

constexpr const char *kMade = "# Made by `calendem registry`; not to be edited.\n";

std::string default_of(const Key &key) {
  return key.same_as.empty() ? key.fallback
                             : fmt::format("${{{}}}", find_key(case_keys(), key.same_as)->variable);
}

std::string meaning_of(const Key &key) {
  return (key.unit.empty() ? "" : key.unit + ", ") + key.meaning +
         (key.choices.empty() ? "" : ": " + key.choices) +
         (key.same_as.empty() ? "" : "; " + key.same_as + " unless given");
}

std::string defaults_in() {
  std::string out = "# Every tunable of the calendering scripts; override with `-var NAME VALUE` "
                    "on the command line.\n";
  out += kMade;
  out += "# Units in the names; stresses are turned into kPa (units micro) in common/model.in.\n"
         "variable electrode            index build/electrode   # folder made by calendem pack\n"
         "variable out                  index .                 # where results go\n"
         "variable scripts              index input_scripts     # this folder\n"
         "variable resuming             index 0                 # 1: go on from "
         "${out}/running.restart\n";
  std::string table;
  for (const Key &key : case_keys()) {
    if (key.variable.empty() || (key.fallback.empty() && key.same_as.empty()))
      continue;
    const std::string in = key.name.substr(0, key.name.rfind('.'));
    if (in != table)
      out += fmt::format("# {}\n", in);
    table = in;
    out += fmt::format("variable {:<20} index {:<15} # {}\n", key.variable, default_of(key),
                       meaning_of(key));
  }
  return out;
}

std::string settings_in() {
  std::string out =
      "# Writes the run's settings into ${out}/settings.txt: for in.relaxation, for a "
      "run that goes on, and for\n# `calendem collect`.\n";
  out += kMade;
  const char *how = "file";
  for (const Key &key : case_keys()) {
    if (key.variable.empty())
      continue;
    out +=
        fmt::format("print \"variable {0} index ${{{0}}}\" {1} ${{out}}/settings.txt screen no\n",
                    key.variable, how);
    how = "append";
  }
  return out;
}

/// A law's effects, and the script's short names of their settings.
struct LawInScript {
  const ContactLaw *law;
  std::vector<const Effect *> effects;
};

std::vector<LawInScript> laws_in_script() {
  std::vector<LawInScript> out;
  for (const ContactLaw *law : kContactLaws) {
    out.push_back({law, {}});
    for (const Effect &e : effects())
      if (e.contact.law == law)
        out.back().effects.push_back(&e);
  }
  return out;
}

/// Names c1, c2 ... of the settings of contact laws, by their variables.
std::map<std::string, std::string> short_names() {
  std::map<std::string, std::string> out;
  for (const LawInScript &l : laws_in_script())
    for (const Effect *e : l.effects)
      for (const Key &key : e->settings)
        out.emplace(key.variable, fmt::format("c{}", out.size() + 1));
  return out;
}

/// The property by pairs of types: the setting of the effect that acts there, 0 elsewhere and for
/// an effect that leaves it out.
std::string matrix(const LawInScript &l, std::size_t property) {
  static const std::map<std::string, std::string> name = short_names();
  constexpr int kTypes = 4;
  std::string cell[kTypes][kTypes], out;
  for (const Effect *e : l.effects) {
    if (property >= e->settings.size())
      continue;
    for (const auto &[a, b] : e->contact.between)
      cell[int(a) - 1][int(b) - 1] = cell[int(b) - 1][int(a) - 1] =
          "${" + name.at(e->settings[property].variable) + "}";
  }
  for (const auto &row : cell)
    for (const std::string &value : row)
      out += " " + (value.empty() ? std::string("0") : value);
  return out;
}

/// "${nmc_yield_GPa}*1e6"
std::string in_script_units(const Key &key) {
  const double factor = script_units(key.unit);
  const std::string value = fmt::format("${{{}}}", key.variable),
                    softened = softens(key.name) ? "*${cbd_soft}" : "";
  return (factor == 1.0 ? value : fmt::format("{}*1e{:.0f}", value, std::log10(factor))) + softened;
}

std::string law_in_script(const LawInScript &l, int number) {
  const auto name = short_names();
  std::string out = fmt::format("# {} (physics/{})\n", l.law->name, l.law->header), on, fixes;
  for (const Effect *e : l.effects)
    for (const Key &key : e->settings)
      out += fmt::format("variable {} equal {:<30} # {}\n", name.at(key.variable),
                         in_script_units(key), e->name);
  for (const Effect *e : l.effects)
    on += fmt::format("{}(v_{} > 0)", on.empty() ? "" : " || ",
                      name.at(e->settings.front().variable));
  for (std::size_t k = 0; k < l.law->size; ++k)
    fixes += fmt::format(" &\n    \"fix {0} all property/global {0} peratomtypepair 4{1}\"",
                         l.law->properties[k].name, matrix(l, k));
  out += fmt::format(
      "variable law{0} equal \"{1}\"\n"
      "if \"${{law{0}}} > 0\" then \"variable contact string hertz_effects\"{2}{3}\n",
      number, on, l.law->stiffens ? " &\n    \"variable n_check equal 2000\"" : "", fixes);
  return out;
}

std::string effects_in() {
  std::string out = "# Contact laws that the base model leaves out, each off at 0. With none of "
                    "them ${contact} is the host's hertz\n"
                    "# and nothing here acts. Types: 1 AM, 2 CBD, 3 collector, 4 platen.\n";
  out += kMade;
  out += "variable contact string hertz\nvariable n_check equal 1000000\n";
  int number = 0;
  for (const LawInScript &l : laws_in_script())
    if (!l.effects.empty())
      out += law_in_script(l, ++number);
  return out;
}

std::string bond_laws_in() {
  std::string out = "# Laws of bond strength that the base model leaves out, each off at 0.\n";
  out += kMade;
  for (const Effect &e : effects()) {
    if (e.bond_law.empty())
      continue;
    out += "fix_modify bonds " + e.bond_law;
    for (const Key &key : e.settings)
      out += fmt::format(" ${{{}}}", key.variable);
    out += fmt::format(" # {} (physics/{})\n", e.name, e.law);
  }
  return out;
}

} // namespace

std::vector<GeneratedFile> generated_files(const std::string &top) {
  std::vector<GeneratedFile> all = reference_pages(top);
  all.insert(all.begin(), {{"input_scripts/common/defaults.in", defaults_in()},
                           {"input_scripts/common/settings.in", settings_in()},
                           {"input_scripts/common/effects.in", effects_in()},
                           {"input_scripts/common/bond_laws.in", bond_laws_in()}});
  return all;
}

CLI::Validator finite_range(double low, double high, const std::string &unit) {
  const std::string range =
      fmt::format("in [{:g} - {:g}]{}{}", low, high, unit.empty() ? "" : " ", unit);
  return {[=](std::string &text) {
            double value = 0.0;
            const bool good =
                CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
            return good ? std::string() : fmt::format("{} is not a number {}", text, range);
          },
          "FLOAT " + range};
}

} // namespace calendem
