// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "effects/effects.h"
#include "predict/files.h"
#include "predict/film_sheet.h"
#include "predict/learnt.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

namespace calendem {

using Json = nlohmann::ordered_json;

namespace {

template <class Value>
double middle_of(const std::vector<const Draw *> &draws, const Value &value) {
  std::vector<double> values;
  for (const Draw *d : draws)
    values.push_back(value(*d));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// Empty where the bank takes the nanoporosity for known.
std::string nanoporosity_line(const FilmBank &bank, const std::vector<const Draw *> &draws,
                              std::size_t material) {
  if (bank.spec().nanoporosity_within <= 0.0)
    return "";
  const double points =
      middle_of(draws, [&](const Draw &d) { return d.materials[material].parameters.back(); });
  return fmt::format("# In the recipe: cbd.nanoporosity_percent {:.1f} {}\n", std::fabs(points),
                     points < 0.0 ? "lower" : "higher");
}

/// Lines of a case, each key once: the first that is added stays.
class CaseLines {
public:
  explicit CaseLines(const Settings &of_bank) : of_bank_(of_bank) {}

  void add(const std::string &key, double value) { add_text(key, fmt::format("{:.4g}", value)); }
  /// Keeps those that the bank's case gives.
  void keep(const std::vector<Key> &keys) {
    for (const Key &key : keys)
      if (of_bank_.line(key.name) > 0)
        keep(key);
  }
  /// All that the material of an electrode could give otherwise: an effect that is off too.
  void keep_material() {
    const auto switches = [](const Key &key) {
      return std::any_of(effects().begin(), effects().end(), [&](const Effect &e) {
        return !e.settings.empty() && e.settings.front().name == key.name;
      });
    };
    for (const Key &key : case_keys())
      if (describes_material(key, false) && of_bank_.followed_by(key.name).empty() &&
          (key.name.rfind("effects.", 0) != 0 || switches(key) || of_bank_.line(key.name) > 0))
        keep(key);
  }
  std::string text() const {
    std::string out;
    for (const auto &[table, lines] : tables_)
      out += fmt::format("\n[{}]\n{}", table, lines);
    return out;
  }

private:
  Settings of_bank_;
  std::map<std::string, std::string> tables_;
  std::set<std::string> there_;

  void keep(const Key &key) {
    const std::string &value = of_bank_.text(key.name);
    add_text(key.name, wants_text(key) ? Json(value).dump() : value);
  }
  void add_text(const std::string &key, const std::string &value) {
    if (!there_.insert(key).second)
      return;
    const std::size_t dot = key.rfind('.');
    tables_[key.substr(0, dot)] += fmt::format("{} = {}\n", key.substr(dot + 1), value);
  }
};

EffectSet most_probable(const FilmBank &bank, const Calibration &c, std::size_t material) {
  const std::vector<EffectSet> sets = effect_sets_of(bank, c);
  return *std::max_element(sets.begin(), sets.end(), [&](const EffectSet &a, const EffectSet &b) {
    return a.probability[material] < b.probability[material];
  });
}

} // namespace

std::string case_of(const FilmBank &bank, const Calibration &c, std::size_t of_those) {
  const EffectSet best = most_probable(bank, c, of_those);
  const std::vector<int> &effects = best.effects;
  std::vector<const Draw *> of;
  for (const Draw &d : c.draws)
    if (effects_of(d.materials[of_those]) == effects)
      of.push_back(&d);
  const auto middle = [&](const auto &value) { return middle_of(of, value); };
  CaseLines lines(read_case(bank.spec().case_file, bank.recipe()));
  std::size_t material = 0;
  for (const bank::Input &p : bank.spec().design.inputs)
    if (!p.is_film() && !p.is_effect()) {
      const double value =
          middle([&](const Draw &d) { return d.materials[of_those].parameters[material]; });
      ++material;
      for (const std::string &key : p.keys)
        lines.add(key.substr(5), value);
    }
  std::string of_recipe = nanoporosity_line(bank, of, of_those);
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const Effect effect = find_effect(bank.effects()[std::size_t(effects[k])].name);
    const double value =
        middle([&](const Draw &d) { return key_value(bank, d.materials[of_those].effects[k]); });
    for (const std::string &key : effect.parameter.keys)
      if (effect.in_recipe)
        of_recipe += fmt::format("# In the recipe: {} = {:.4g}\n", key, value);
      else
        lines.add(key, value);
    if (!effect.in_recipe)
      lines.keep(effect.settings);
  }
  for (const inference::Parameter &e : bank.effects()) // of a material that has it on
    if (const Effect &off = find_effect(e.name); !off.in_recipe)
      for (const std::string &key : off.parameter.keys)
        lines.add(key, std::stod(off.parameter.off));
  lines.keep_material();
  std::string out = fmt::format(
      "{}{} ({}, {:.0f} %): the middle of its draws, each\n"
      "# parameter by itself. Put the folder of your electrode here.\nelectrode = \"electrode\"\n",
      kHeadOfCase, of_material(c, of_those), best.name, 100.0 * best.probability[of_those]);
  return out + of_recipe + lines.text();
}

} // namespace calendem
