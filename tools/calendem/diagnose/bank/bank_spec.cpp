// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/bank/bank_spec.h"
#include "base/messages.h"
#include "base/table_reader.h"
#include "base/toml_reader.h"
#include "diagnose/bank/bank_table.h"
#include "simulate/study_file.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <set>
#include <tuple>

namespace calendem {

namespace {

const std::vector<Key> &head_keys() {
  static const std::vector<Key> keys = {
      {"name", "", "bank", 0, 0, "", "for reports", "", true},
      {"recipe", "", "", 0, 0, "", "electrode recipe", "", true},
      {"case", "", "", 0, 0, "", "case; its electrode is replaced", "", true},
      {"packings", "", "12", 2, 1000, "", "seeds of the recipe", "", false, true},
      {"base_points", "", "48", 4, 10000, "", "without effects", "", false, true},
      {"effect_points", "", "24", 2, 10000, "", "of every effect", "", false, true},
      {"seed", "", "1", 0, 4e9, "", "of the design", "", false, true},
      {"pressures_MPa", "", "", 0.1, 2000, "MPa", "a run for each at every point"},
      {"first_point", "", "0", 0, 5000, "", "number of the first base point", "", false, true},
      {"tortuosity", "", "no", 0, 0, "", "of the pores after release", "yes|no"},
      {"nanoporosity_within_points", "", "0", 0, 20, "%", "to either side of a recipe's"},
      {"crushing", "", "-", 0, 0, "", "loads of single particles (CSV)", "", true},
      {"further_table", "", "-", 0, 0, "", "more of its runs (CSV)", "", true},
      {"chosen_points", "", "-", 0, 0, "", "more points of effects (CSV)", "", true}};
  return keys;
}

class Reader : TableReader {
public:
  using TableReader::TableReader;

  void read_head(const toml::table &t, BankSpec &out) {
    report_unknown(t, {"name", "recipe", "case", "packings", "base_points", "effect_points", "seed",
                       "first_point", "tortuosity", "nanoporosity_within_points", "crushing",
                       "further_table", "chosen_points", "pressures_MPa", "effects"});
    out.name = text(t, head_keys()[0]);
    out.recipe_file = path(t, head_keys()[1]);
    out.case_file = path(t, head_keys()[2]);
    out.packings = int(number(t, head_keys()[3]));
    out.base_points = int(number(t, head_keys()[4]));
    out.effect_points = int(number(t, head_keys()[5]));
    out.seed = static_cast<unsigned long>(number(t, head_keys()[6]));
    out.first_point = int(number(t, head_keys()[8]));
    out.tortuosity = text(t, head_keys()[9]) == "yes";
    out.nanoporosity_within = number(t, head_keys()[10]);
    out.crushing_file = path(t, head_keys()[11]);
    out.further_table = path(t, head_keys()[12]);
    out.chosen_file = path(t, head_keys()[13]);
    if (out.effect_points > out.base_points)
      mistakes_.add(0, fmt::format("effect_points is {}, base_points {}: every point of an effect "
                                   "needs a base point of its own.",
                                   out.effect_points, out.base_points));
    out.pressures = numbers(t, head_keys()[7]);
    std::sort(out.pressures.begin(), out.pressures.end());
    read_effects(t, out);
  }

  BankParameter read_parameter(const toml::node &node) {
    BankParameter p;
    const toml::table *t = node.as_table();
    if (!t) {
      mistakes_.add(line_of(node), "write a parameter as a table: [[parameter]].");
      return p;
    }
    report_unknown(*t, {"name", "keys", "low", "high", "prior"});
    p.name = column_name(*t, node, "", "parameter");
    p.low = number(*t, {"low", "", "", -1e300, 1e300, "", "end of the prior"});
    p.high = number(*t, {"high", "", "", -1e300, 1e300, "", "end of the prior"});
    const std::string prior =
        text(*t, {"prior", "", "uniform", 0, 0, "", "", "uniform|log-uniform"});
    p.spread = prior == "log-uniform" ? Spread::LogUniform : Spread::Uniform;
    const bool both = t->contains("low") && t->contains("high");
    if (both && (p.low >= p.high || (p.spread == Spread::LogUniform && p.low <= 0.0)))
      mistakes_.add(line_of(node),
                    fmt::format("parameter '{}' goes from {} to {}; low must be below "
                                "high, and above 0 for a log-uniform prior.",
                                p.name, p.low, p.high));
    p.keys = texts(*t, "keys");
    if (p.keys.empty())
      mistakes_.add(line_of(node),
                    fmt::format("parameter '{}' needs a list 'keys' of texts.", p.name));
    return p;
  }

  void read_full_cell(const toml::table &t, BankSpec &out) {
    report_unknown(t, {"recipe", "case", "points", "other_electrode"});
    out.full_cell.recipe_file =
        path(t, {"recipe", "", "", 0, 0, "", "recipe of the cell", "", true});
    out.full_cell.case_file = path(t, {"case", "", "", 0, 0, "", "its case", "", true});
    out.full_cell.points =
        int(number(t, {"points", "", "", 2, 1000, "", "base points run on it", "", false, true}));
    out.full_cell.other_electrode =
        text(t, {"other_electrode", "", "no", 0, 0, "", "not a larger cell", "yes|no"}) == "yes";
    if (out.full_cell.points > out.base_points)
      mistakes_.add(line_of(*t.get("points")),
                    fmt::format("points is {}; there are {} base points.", out.full_cell.points,
                                out.base_points));
  }

  /// The widest range: that of the effect's prior; what yields may be ten times as soft.
  static EffectParameter at_most(EffectParameter p) {
    if (p.scale == AmplitudeScale::Reciprocal)
      p.low *= 0.1;
    return p;
  }

  /// Range and number of points of one of the bank's effects.
  void read_range(const toml::node &node, BankSpec &out) {
    const toml::table *t = node.as_table();
    if (!t)
      return mistakes_.add(line_of(node), "write an effect's range as a table: [[effect]].");
    report_unknown(*t, {"name", "low", "high", "points"});
    const int before = mistakes_.count();
    const std::string name = text(*t, {"name", "", "", 0, 0, "", "of the effect",
                                       fmt::format("{}", fmt::join(out.effects, "|"))});
    if (mistakes_.count() > before)
      return;
    if (t->contains("points")) {
      const int points = int(number(*t, {"points", "", "", 2, double(out.base_points), "",
                                         "of the effect", "", false, true}));
      if (!out.points.emplace(name, points).second)
        mistakes_.add(line_of(node), fmt::format("{} has two numbers of points; keep one.", name));
      if (!t->contains("low") && !t->contains("high"))
        return;
    }
    const EffectParameter table = at_most(find_effect(name).parameter);
    const double low = number(*t, {"low", "", "", table.low, table.high, "", "end of the range"}),
                 high = number(*t, {"high", "", "", table.low, table.high, "", "end of it"});
    if (mistakes_.count() == before && low >= high)
      mistakes_.add(line_of(node),
                    fmt::format("the range of {} goes from {:g} to {:g}; low must be "
                                "below high.",
                                name, low, high));
    if (!out.ranges.emplace(name, std::pair(low, high)).second)
      mistakes_.add(line_of(node), fmt::format("{} has two ranges; keep one.", name));
  }

  /// Changes the price that has this name.
  void read_price(const toml::node &node, std::vector<MeasurementPrice> &prices) {
    const toml::table *t = node.as_table();
    if (!t)
      return mistakes_.add(line_of(node), "write a measurement as a table: [[measurement]].");
    report_unknown(*t, {"name", "hours", "sd"});
    std::string names;
    for (const MeasurementPrice &p : prices)
      names += (names.empty() ? "" : "|") + p.name;
    const int before = mistakes_.count();
    const std::string name = text(*t, {"name", "", "", 0, 0, "", "of the measurement", names});
    for (MeasurementPrice &p : prices)
      if (mistakes_.count() == before && p.name == name) {
        p.hours = number(*t, {"hours", "", fmt::format("{}", p.hours), 0.01, 1e4, "h", "of work"});
        if (t->contains("sd") && p.unit.empty())
          mistakes_.add(line_of(node),
                        fmt::format("'{}' takes no sd: the bank's table cannot predict it.", name));
        else if (t->contains("sd"))
          p.sd = number(*t, {"sd", "", "", 1e-6, 1e3, p.unit, "of the result"});
      }
  }

  void read_pressing(const toml::node &node, BankSpec &out) {
    const toml::table *t = node.as_table();
    if (!t)
      return mistakes_.add(line_of(node), "write a way of pressing as a table: [[pressing]].");
    report_unknown(*t,
                   {"name", "what", "settings", "pressures_MPa", "base_points", "effect_points"});
    BankPressing p;
    p.name = column_name(*t, node, "-", "way of pressing");
    p.what = text(*t, {"what", "", "-", 0, 0, "", "the same in words", "", true});
    p.pressures = numbers(*t, {"pressures_MPa", "", "", 0.1, 2000, "MPa", "a run for each"});
    std::sort(p.pressures.begin(), p.pressures.end());
    p.base_points = int(number(
        *t, {"base_points", "", "", 2, double(out.base_points), "", "the first", "", false, true}));
    p.effect_points = int(number(*t, {"effect_points", "", "", 2, double(out.base_points), "",
                                      "of every effect", "", false, true}));
    if (const toml::node *settings = t->get("settings"))
      read_settings(*settings, p);
    if (p.name.empty() == !p.settings.empty() || p.name.empty() == !p.what.empty())
      mistakes_.add(line_of(node),
                    "a way of pressing has a 'name', 'what' it is in words and 'settings' such as "
                    "{ \"platen.presses\" = 2 }; without all three its runs are usual ones, to "
                    "further pressures.");
    for (const BankPressing &other : out.pressings)
      if (!p.name.empty() && (other.name == p.name || other.what == p.what))
        mistakes_.add(line_of(node), fmt::format("two ways of pressing are called '{}'.", p.name));
    check_pressures(p, line_of(node), out);
    out.pressings.push_back(p);
  }

  /// After all else: its points are none of those that the other keys give.
  void read_chosen_points(BankSpec &out) {
    if (!out.chosen_file.empty() && mistakes_.empty())
      read_chosen(out.chosen_file, out, mistakes_);
  }

  Numerics read_numerics(const toml::node &node) {
    const toml::table *t = node.as_table();
    if (!t) {
      mistakes_.add(line_of(node), "write an error of the runs as a table: [[numerics]].");
      return {};
    }
    report_unknown(*t, {"name", "porosity_points"});
    return {text(*t, {"name", "", "", 0, 0, "", "of the error", "", true}),
            number(*t, {"porosity_points", "", "", 0, 20, "%", "of the porosity under pressure"})};
  }

private:
  std::string column_name(const toml::table &t, const toml::node &node, const std::string &fallback,
                          const std::string &of) {
    const std::string name = text(t, {"name", "", fallback, 0, 0, "", "of the " + of, "", true});
    if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") !=
            std::string::npos ||
        name == "pressing")
      mistakes_.add(line_of(node),
                    fmt::format("{} '{}': a name has letters, digits and _ only, and is not "
                                "'pressing': it stands in the table.",
                                of, name));
    return name;
  }

  void read_settings(const toml::node &node, BankPressing &out) {
    const toml::table *settings = node.as_table();
    if (!settings)
      return mistakes_.add(line_of(node), "write settings as { \"platen.presses\" = 2 }.");
    for (const auto &[key, value] : *settings) {
      out.settings.emplace_back(key.str(), fmt::format("{}", value.value_or(NAN)));
      if (!value.is_number())
        mistakes_.add(line_of(value), fmt::format("settings: '{}' is no number. Write the whole "
                                                  "key in quotes: {{ \"platen.presses\" = 2 }}.",
                                                  key.str()));
    }
  }

  /// A run that is asked for twice would count twice.
  void check_pressures(const BankPressing &p, int line, const BankSpec &out) {
    std::vector<double> had = p.name.empty() ? out.pressures : std::vector<double>();
    for (const BankPressing &other : out.pressings)
      if (other.name == p.name)
        had.insert(had.end(), other.pressures.begin(), other.pressures.end());
    for (const double pressure : p.pressures) {
      if (std::any_of(had.begin(), had.end(), [&](double h) { return same_pressure(h, pressure); }))
        mistakes_.add(line, fmt::format("pressures_MPa: {:g} MPa is there already.", pressure));
      had.push_back(pressure);
    }
  }

  void read_effects(const toml::table &t, BankSpec &out) {
    out.effects = texts(t, "effects");
    for (const std::string &name : out.effects)
      try {
        find_effect(name);
      } catch (const Failure &e) {
        mistakes_.add(line_of(*t.get("effects")), e.what());
      }
    if (!t.contains("effects"))
      for (const Effect &e : effects())
        out.effects.push_back(e.name);
  }
};

} // namespace

int points_of(const BankSpec &spec, const std::string &effect) {
  const auto own = spec.points.find(effect);
  return own == spec.points.end() ? spec.effect_points : own->second;
}

std::string table_of(const BankSpec &spec) {
  return std::filesystem::path(spec.file).replace_extension("csv").string();
}

const BankPressing *find_pressing(const BankSpec &spec, const std::string &name) {
  const auto at =
      std::find_if(spec.pressings.begin(), spec.pressings.end(),
                   [&](const BankPressing &p) { return !name.empty() && p.name == name; });
  return at == spec.pressings.end() ? nullptr : &*at;
}

Effect effect_of(const BankSpec &spec, const std::string &name) {
  Effect effect = find_effect(name);
  if (const auto range = spec.ranges.find(name); range != spec.ranges.end())
    std::tie(effect.parameter.low, effect.parameter.high) = range->second;
  return effect;
}

namespace {

/// Keys of the case that nothing else of the bank sets.
void check_settings(const BankSpec &spec, const BankPressing &pressing, Mistakes &mistakes) {
  std::set<std::string> taken = {"case.platen.max_pressure_MPa"};
  for (const BankParameter &p : spec.parameters)
    taken.insert(p.keys.begin(), p.keys.end());
  for (const std::string &name : spec.effects)
    if (const Effect &e = find_effect(name); !e.instrument)
      for (const std::string &key : e.parameter.keys)
        taken.insert(e.column(key));
  for (const auto &[key, value] : pressing.settings) {
    check_column("case." + key, mistakes);
    if (taken.count("case." + key) > 0)
      mistakes.add(0, fmt::format("pressing '{}': '{}' is set by a pressure, a parameter or an "
                                  "effect of the bank. Leave it out of settings.",
                                  pressing.name, key));
  }
}

} // namespace

BankSpec read_bank_spec(const std::string &file) {
  Mistakes mistakes(file, 20);
  BankSpec out;
  out.file = file;
  const TomlFile parsed = parse_toml(file, FileKind::Bank, mistakes);
  Reader reader(file, parsed.whole, mistakes);
  for (const auto &[key, node] : parsed.root) {
    if (key.str() == "bank" && node.is_table())
      reader.read_head(*node.as_table(), out);
    else if (key.str() == "parameter" && node.is_array())
      for (const toml::node &parameter : *node.as_array())
        out.parameters.push_back(reader.read_parameter(parameter));
    else if (key.str() == "numerics" && node.is_array())
      for (const toml::node &numerics : *node.as_array())
        out.numerics.push_back(reader.read_numerics(numerics));
    else if (key.str() == "measurement" && node.is_array())
      for (const toml::node &measurement : *node.as_array())
        reader.read_price(measurement, out.prices);
    else if ((key.str() != "full_cell" || !node.is_table()) &&
             (key.str() != "effect" || !node.is_array()) &&
             (key.str() != "pressing" || !node.is_array()))
      mistakes.add(line_of(node),
                   fmt::format("unknown '{}'; a bank has tables [bank], [full_cell], "
                               "[[parameter]], [[effect]], [[pressing]], [[measurement]] and "
                               "[[numerics]].",
                               key.str()));
  }
  if (const toml::array *ranges = parsed.root["effect"].as_array())
    for (const toml::node &range : *ranges)
      reader.read_range(range, out); // after [bank]: of its effects
  if (const toml::array *pressings = parsed.root["pressing"].as_array())
    for (const toml::node &pressing : *pressings)
      reader.read_pressing(pressing, out);
  if (const toml::table *full_cell = parsed.root["full_cell"].as_table())
    reader.read_full_cell(*full_cell, out); // after [bank]: its points are some of the bank's
  if (parsed.whole && !parsed.root.contains("bank"))
    mistakes.add(0, "has no table [bank].");
  std::set<std::string> names;
  for (const BankParameter &p : out.parameters)
    if (!names.insert(p.name).second)
      mistakes.add(0, fmt::format("two parameters are called '{}'.", p.name));
  if (out.parameters.empty() && parsed.whole)
    mistakes.add(0, "has no [[parameter]]: there would be nothing to recalibrate.");
  for (const BankPressing &pressing : out.pressings)
    check_settings(out, pressing, mistakes);
  reader.read_chosen_points(out);
  mistakes.stop_if_any();
  return out;
}

const std::vector<MeasurementPrice> &usual_prices() {
  static const std::vector<MeasurementPrice> prices = {
      {"porosity_after", "porosity after release, by mass and thickness", 3.0, 0.5, "%"},
      {"thickness_at_max", "thickness under the largest pressure", 2.0, 1.0, "um"},
      {"cracked_bodies", "share of cracked particles in a cross-section", 8.0, 0.05, "fraction"},
      {"loading_curve", "displacement while the pressure rises", 1.0, 0.5, "um"},
      {kUnloadingCurve, "displacement while the pressure falls", 1.0, 0.5, "um"},
      {"dwell", "decay of pressure at constant gap", 2.0, 0.0, ""},
      {"second_speed", "the same pressures at a tenth of the speed", 3.0, 0.0, ""},
      {"thickness_series", "coatings of several loadings at one pressure", 6.0, 0.0, ""},
      {"temperature_series", "the same pressures at 25 and 60 degrees C", 8.0, 0.0, ""},
      {"higher_pressure", "the same coating at twice the largest pressure", 2.0, 0.0, ""},
      {"tomogram", "X-ray tomogram before and after", 40.0, 0.0, ""}};
  return prices;
}

} // namespace calendem
