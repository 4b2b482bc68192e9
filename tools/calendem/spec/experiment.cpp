// SPDX-License-Identifier: GPL-2.0-or-later
#include "spec/experiment.h"
#include "spec/toml_file.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

namespace calendem {
namespace fs = std::filesystem;
namespace {

constexpr double kPi = 3.14159265358979323846;

const std::vector<Key> &head_keys() {
  static const std::vector<Key> keys = {
      {"name", "", "", 0, 0, "", "a name for reports", "", true},
      {"electrode", "", "", 0, 0, "", "recipe of the electrode before calendering", "", true},
      {"sample_diameter_mm", "", "0", 1, 1000, "mm", "of the punched disc"},
      {"foil_thickness_um", "", "0", 1, 100, "um", "of the current collector"},
      {"foil_density_g_cm3", "", "0", 0.5, 20, "g/cm3", "aluminium 2.70, copper 8.96"},
  };
  return keys;
}

const std::vector<Key> &condition_keys() {
  static const std::vector<Key> keys = {
      {"id", "", "", 0, 0, "", "name of the condition, as in split", "", true},
      {"control", "", "", 0, 0, "", "what the calender was set to",
       "pressure|displacement|thickness|roll_gap"},
      {"curve", "", "-", 0, 0, "", "CSV: displacement_um,pressure_MPa[,stage]", "", true},
      {"labels_before", "", "-", 0, 0, "", "label image before calendering", "", true},
      {"labels_after", "", "-", 0, 0, "", "label image after calendering", "", true},
      {"dwell_s", "", "0", 0, 1e6, "s", "time at the target"},
  };
  return keys;
}

struct Quantity {
  Key key;
  std::optional<Measured> Condition::*field;
};

const std::vector<Quantity> &quantities() {
  static const std::vector<Quantity> list = {
      {{"roll_gap_um", "", "-", 0, 1000, "um", "between the rolls"}, &Condition::roll_gap_um},
      {{"displacement_um", "", "-", 0.01, 1000, "um", "of the platen, from first touch"},
       &Condition::displacement_um},
      {{"thickness_at_max_um", "", "-", 1, 1000, "um", "of the loaded coating, without foil"},
       &Condition::thickness_at_max_um},
      {{"max_pressure_MPa", "", "-", 0.1, 2000, "MPa", "at the maximum"},
       &Condition::max_pressure_MPa},
      {{"loading_mg_cm2", "", "-", 0.5, 100, "mg/cm2", "of this sample, without foil"},
       &Condition::loading_mg_cm2},
      {{"porosity_after_percent", "", "-", 1, 90, "%", "total, after calendering"},
       &Condition::porosity_after_percent},
      {{"thickness_after_um", "", "-", 1, 1000, "um", "after calendering"},
       &Condition::thickness_after_um},
      {{"mass_mg", "", "-", 0.01, 1e5, "mg", "of the sample"}, &Condition::mass_mg},
      {{"cracked_bodies_fraction", "", "-", 0, 1, "fraction", "of secondary particles"},
       &Condition::cracked_bodies_fraction},
  };
  return list;
}

/// Reads one file; every message goes to `mistakes`.
class ExperimentReader {
public:
  ExperimentReader(const std::string &file, Mistakes &mistakes)
      : folder_(fs::absolute(file).parent_path()), mistakes_(mistakes) {}

  Experiment read(const TomlFile &file) {
    whole_ = file.whole;
    for (const auto &[key, node] : file.root)
      if (key.str() != "experiment" && key.str() != "condition")
        unknown(std::string(key.str()), line_of(node), {"experiment", "condition"});
    const toml::table *head = file.root["experiment"].as_table();
    if (head)
      read_head(*head);
    else if (whole_)
      mistakes_.add(0, "there is no table [experiment].");
    const toml::array *list = file.root["condition"].as_array();
    if (!list || list->empty())
      mistakes_.add(0, "there is no [[condition]]: an experiment needs at least one.");
    else
      for (const toml::node &node : *list)
        read_condition(node);
    if (head && list)
      read_split(*head);
    return e_;
  }

private:
  fs::path folder_;
  Mistakes &mistakes_;
  Experiment e_;
  bool whole_ = true;

  void unknown(const std::string &name, int line, const std::vector<std::string> &known) {
    mistakes_.add(line,
                  fmt::format("unknown key '{}'. Did you mean '{}'?", name, closest(name, known)));
  }

  std::string text(const toml::table &t, const Key &key) {
    const toml::node *node = t.get(key.name);
    if (!node) {
      if (key.fallback.empty() && whole_)
        mistakes_.add(line_of(t), fmt::format("key '{}' is missing ({}).", key.name, key.meaning));
      return "";
    }
    if (!node->is_string())
      mistakes_.add(line_of(*node), fmt::format("{} must be a text in quotes ({}), not {}.",
                                                key.name, key.meaning, shown(*node)));
    else if (const auto wrong = wrong_text(key, **node->as_string()))
      mistakes_.add(line_of(*node), *wrong);
    else
      return **node->as_string();
    return "";
  }

  std::optional<double> number(const toml::node &node, const Key &key) {
    if (!node.is_number())
      mistakes_.add(line_of(node), fmt::format("{} must be a number without quotes ({}), not {}.",
                                               key.name, key.meaning, shown(node)));
    else if (const auto wrong = wrong_number(key, *node.value<double>()))
      mistakes_.add(line_of(node), *wrong);
    else
      return *node.value<double>();
    return std::nullopt;
  }

  double number(const toml::table &t, const Key &key) {
    const toml::node *node = t.get(key.name);
    return node ? number(*node, key).value_or(0.0) : 0.0;
  }

  /// Absolute path of a file that must exist; empty if it is not given.
  std::string existing(const toml::table &t, const Key &key) {
    const std::string name = text(t, key);
    if (name.empty())
      return "";
    const std::string path = (folder_ / name).lexically_normal().string();
    std::error_code none;
    if (!fs::exists(path, none))
      mistakes_.add(line_of(*t.get(key.name)),
                    fmt::format("{} = \"{}\": there is no file '{}'. Paths are relative to this "
                                "file.",
                                key.name, name, path));
    else if (fs::is_directory(path, none))
      mistakes_.add(line_of(*t.get(key.name)),
                    fmt::format("{} = \"{}\" is a folder; a file is wanted.", key.name, name));
    else
      return path;
    return "";
  }

  void read_head(const toml::table &head) {
    std::vector<std::string> known = {"split"};
    for (const Key &key : head_keys())
      known.push_back(key.name);
    for (const auto &[key, node] : head)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        unknown("experiment." + std::string(key.str()), line_of(node), known);
    e_.name = text(head, head_keys()[0]);
    e_.electrode = existing(head, head_keys()[1]);
    e_.sample_diameter_mm = number(head, head_keys()[2]);
    e_.foil_thickness_um = number(head, head_keys()[3]);
    e_.foil_density_g_cm3 = number(head, head_keys()[4]);
    if (!e_.electrode.empty())
      try {
        e_.recipe = read_recipe(e_.electrode);
      } catch (const Failure &f) {
        mistakes_.add(line_of(*head.get("electrode")),
                      fmt::format("the recipe has mistakes of its own:\n{}", f.what()));
      }
  }

  void read_condition(const toml::node &node) {
    const toml::table *t = node.as_table();
    if (!t) {
      mistakes_.add(line_of(node), "write a condition as a table: [[condition]].");
      return;
    }
    std::vector<std::string> known;
    for (const Key &key : condition_keys())
      known.push_back(key.name);
    for (const Quantity &q : quantities())
      known.push_back(q.key.name);
    for (const auto &[key, value] : *t)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        unknown("condition." + std::string(key.str()), line_of(value), known);
    Condition c;
    c.id = text(*t, condition_keys()[0]);
    c.control = text(*t, condition_keys()[1]);
    c.curve = existing(*t, condition_keys()[2]);
    c.labels_before = existing(*t, condition_keys()[3]);
    c.labels_after = existing(*t, condition_keys()[4]);
    c.dwell_s = number(*t, condition_keys()[5]);
    for (const Quantity &q : quantities())
      if (const toml::node *value = t->get(q.key.name))
        c.*(q.field) = measured(*value, q.key);
    check_condition(c, *t);
    e_.conditions.push_back(c);
  }

  std::optional<Measured> measured(const toml::node &node, const Key &key) {
    Measured m;
    m.includes_foil = key.name == "mass_mg";
    const toml::table *t = node.as_table();
    if (!t) {
      const auto value = number(node, key);
      m.value = value.value_or(0.0);
      return value ? std::optional(m) : std::nullopt;
    }
    const bool has_foil = key.name == "mass_mg" || key.name == "thickness_after_um";
    std::vector<std::string> known = {"value", "sd", "sd_relative"};
    if (has_foil)
      known.push_back("includes_foil");
    for (const auto &[k, part] : *t)
      if (std::find(known.begin(), known.end(), k.str()) == known.end())
        unknown(key.name + "." + std::string(k.str()), line_of(part), known);
    if (const toml::node *foil = t->get("includes_foil"); foil && has_foil)
      read_foil(*foil, key, m);
    const toml::node *value = t->get("value");
    if (!value) {
      mistakes_.add(line_of(*t), fmt::format("{} has no 'value'.", key.name));
      return std::nullopt;
    }
    const auto read = number(*value, key);
    m.value = read.value_or(0.0);
    const bool good = read_sd(*t, key, m);
    return read && good ? std::optional(m) : std::nullopt;
  }

  void read_foil(const toml::node &node, const Key &key, Measured &m) {
    if (node.is_boolean())
      m.includes_foil = **node.as_boolean();
    else
      mistakes_.add(line_of(node), fmt::format("{}.includes_foil must be true or false, not {}.",
                                               key.name, shown(node)));
  }

  bool read_sd(const toml::table &t, const Key &key, Measured &m) {
    const toml::node *sd = t.get("sd"), *relative = t.get("sd_relative");
    if (sd && relative) {
      mistakes_.add(line_of(*sd), fmt::format("{} has both 'sd' and 'sd_relative'; give one of "
                                              "them.",
                                              key.name));
      return false;
    }
    if (!sd && !relative)
      return true;
    const Key rule =
        sd ? Key{key.name + ".sd", "", "", 0, key.high - key.low, key.unit, "standard deviation"}
           : Key{key.name + ".sd_relative", "", "", 0, 1, "fraction", "sd over the value"};
    const auto read = number(sd ? *sd : *relative, rule);
    m.sd = read.value_or(0.0) * (sd ? 1.0 : std::fabs(m.value));
    return read.has_value();
  }

  void check_condition(const Condition &c, const toml::table &t) {
    const std::string who = c.id.empty() ? "this condition" : "condition \"" + c.id + "\"";
    const auto needs = [&](bool there, const char *key) {
      if (!there && whole_)
        mistakes_.add(line_of(t),
                      fmt::format("{} has control = \"{}\" but no {}.", who, c.control, key));
    };
    if (c.control == "pressure")
      needs(t.contains("max_pressure_MPa"), "max_pressure_MPa");
    if (c.control == "displacement")
      needs(t.contains("displacement_um") || t.contains("curve"), "displacement_um and no curve");
    if (c.control == "thickness")
      needs(t.contains("thickness_at_max_um"), "thickness_at_max_um");
    if (c.control == "roll_gap")
      needs(t.contains("roll_gap_um"), "roll_gap_um");
    check_foil(c, who, line_of(t));
    if (!c.curve.empty())
      check_curve(c.curve, line_of(*t.get("curve")));
    for (const Condition &other : e_.conditions)
      if (!c.id.empty() && other.id == c.id)
        mistakes_.add(line_of(t),
                      fmt::format("the id \"{}\" is taken by another condition.", c.id));
  }

  void check_foil(const Condition &c, const std::string &who, int line) {
    const bool on_thickness = c.thickness_after_um && c.thickness_after_um->includes_foil;
    const bool on_mass = c.mass_mg && c.mass_mg->includes_foil;
    std::vector<std::string> missing;
    if (c.mass_mg && e_.sample_diameter_mm == 0.0)
      missing.push_back("sample_diameter_mm");
    if ((on_thickness || on_mass) && e_.foil_thickness_um == 0.0)
      missing.push_back("foil_thickness_um");
    if (on_mass && e_.foil_density_g_cm3 == 0.0)
      missing.push_back("foil_density_g_cm3");
    if (!missing.empty()) {
      mistakes_.add(line,
                    fmt::format("{} gives a mass, or a thickness with foil: [experiment] must "
                                "have {}.",
                                who, fmt::join(missing, ", ")));
      return;
    }
    if (on_thickness && coating_thickness_um(e_, *c.thickness_after_um) <= 0.0)
      mistakes_.add(line,
                    fmt::format("{}: thickness_after_um = {} includes a foil of {} um: nothing "
                                "is left for the coating.",
                                who, c.thickness_after_um->value, e_.foil_thickness_um));
    if (on_mass && coating_loading_mg_cm2(e_, *c.mass_mg) <= 0.0)
      mistakes_.add(line, fmt::format("{}: mass_mg = {} is less than that of the foil ({:.2f} mg).",
                                      who, c.mass_mg->value,
                                      c.mass_mg->value - coating_loading_mg_cm2(e_, *c.mass_mg) *
                                                             kPi / 400.0 * e_.sample_diameter_mm *
                                                             e_.sample_diameter_mm));
  }

  void check_curve(const std::string &path, int line) {
    std::ifstream in(path);
    std::string head;
    std::getline(in, head);
    for (const char *column : {"displacement_um", "pressure_MPa"})
      if (("," + head + ",").find(std::string(",") + column + ",") == std::string::npos &&
          ("," + head).find(std::string(",") + column + "\r") == std::string::npos)
        mistakes_.add(line, fmt::format("'{}' has no column '{}' in its first line: {}", path,
                                        column, head.empty() ? "(empty)" : head.substr(0, 60)));
  }

  void read_split(const toml::table &head) {
    const toml::node *node = head.get("split");
    if (!node)
      return;
    const toml::table *split = node->as_table();
    if (!split) {
      mistakes_.add(line_of(*node), "split must be { train = [\"id\"], test = [\"id\"] }.");
      return;
    }
    for (const auto &[key, ids] : *split)
      if (key.str() == "train" || key.str() == "test")
        read_ids(ids, std::string(key.str()), key.str() == "train" ? e_.train : e_.test);
      else
        unknown("split." + std::string(key.str()), line_of(ids), {"train", "test"});
    for (const std::string &id : e_.test)
      if (std::find(e_.train.begin(), e_.train.end(), id) != e_.train.end())
        mistakes_.add(line_of(*node),
                      fmt::format("\"{}\" is in both train and test of split.", id));
  }

  void read_ids(const toml::node &node, const std::string &part, std::vector<std::string> &out) {
    const toml::array *list = node.as_array();
    if (!list) {
      mistakes_.add(line_of(node), fmt::format("split.{} must be a list of ids in quotes, not {}.",
                                               part, shown(node)));
      return;
    }
    std::vector<std::string> known;
    for (const Condition &c : e_.conditions)
      if (!c.id.empty())
        known.push_back(c.id);
    for (const toml::node &id : *list)
      if (!id.is_string())
        mistakes_.add(line_of(id),
                      fmt::format("split.{} holds {}; ids are texts in quotes.", part, shown(id)));
      else if (std::find(known.begin(), known.end(), **id.as_string()) == known.end())
        mistakes_.add(
            line_of(id),
            fmt::format("split.{} names \"{}\", which is no [[condition]]; there are: {}.", part,
                        **id.as_string(), fmt::join(known, ", ")));
      else
        out.push_back(**id.as_string());
  }
};

double area_cm2(const Experiment &e) { return kPi / 400.0 * std::pow(e.sample_diameter_mm, 2); }

} // namespace

Experiment read_experiment(const std::string &file) {
  Mistakes mistakes(file);
  const TomlFile parsed = parse_toml(file, mistakes);
  Experiment e;
  if (!parsed.root.empty())
    e = ExperimentReader(file, mistakes).read(parsed);
  mistakes.stop_if_any();
  return e;
}

double coating_thickness_um(const Experiment &e, const Measured &thickness) {
  return thickness.value - (thickness.includes_foil ? e.foil_thickness_um : 0.0);
}

double coating_loading_mg_cm2(const Experiment &e, const Measured &mass) {
  const double foil = 0.1 * e.foil_thickness_um * e.foil_density_g_cm3; // um g/cm3 -> mg/cm2
  return mass.value / area_cm2(e) - (mass.includes_foil ? foil : 0.0);
}

double total_porosity(const Experiment &e, double loading_mg_cm2, double thickness_um) {
  const double solid_per_mass = e.recipe.am_weight / e.recipe.am_density +
                                (1.0 - e.recipe.am_weight) / e.recipe.cbd_solid_density;
  return 1.0 - 10.0 * loading_mg_cm2 * solid_per_mass / thickness_um;
}

std::string list_of_experiment_keys() {
  std::string text = "Keys of an experiment file: name, unit, range, meaning\n";
  const auto rows = [&](const char *table, const std::vector<Key> &keys) {
    text += fmt::format(" {}\n", table);
    for (const Key &k : keys)
      text += fmt::format("  {:<26} {:<8} {:<14} {}\n", k.name, k.unit,
                          k.text || !k.choices.empty() ? "text"
                                                       : fmt::format("{:g}..{:g}", k.low, k.high),
                          k.choices.empty() ? k.meaning : k.choices);
  };
  rows("[experiment]", head_keys());
  text += "  split                                      { train = [ids], test = [ids] }\n";
  rows("[[condition]]", condition_keys());
  std::vector<Key> measured;
  for (const Quantity &q : quantities())
    measured.push_back(q.key);
  rows(
      "[[condition]], a number or { value, sd } or { value, sd_relative }; mass and thickness also "
      "includes_foil",
      measured);
  return text;
}

} // namespace calendem
