// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/experiment.h"
#include "base/image_series.h"
#include "base/table_reader.h"
#include "base/toml_reader.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace fs = std::filesystem;
namespace {

/// Reads one file; every message goes to `mistakes`.
class ExperimentReader : TableReader {
public:
  using TableReader::TableReader;

  Experiment read(const TomlFile &file) {
    report_unknown(file.root, {"experiment", "condition", "crushed_particle"});
    const toml::table *head = file.root["experiment"].as_table();
    if (head)
      read_head(*head);
    else if (whole_)
      mistakes_.add(0, "there is no table [experiment].");
    const toml::array *list = file.root["condition"].as_array();
    if (!list || list->empty())
      mistakes_.add(0, "there is no [[condition]]: an experiment needs at least one.");
    each_table(file.root, "condition", [this](const toml::table &t) { read_condition(t); });
    each_table(file.root, "crushed_particle", [this](const toml::table &t) { read_crushed(t); });
    if (head && list)
      read_split(*head);
    return e_;
  }

private:
  Experiment e_;

  /// Absolute path of a file that must exist; empty if it is not given.
  std::string existing(const toml::table &t, const Key &key) {
    const std::string path = this->path(t, key);
    if (path.empty())
      return "";
    const std::string name = **t.get(key.name)->as_string();
    std::error_code none;
    const bool image = key.name.rfind("labels_", 0) == 0;
    try {
      if (image && files_of_series(path) != std::vector<std::string>{path})
        return path;
    } catch (const Failure &f) {
      refuse(*t.get(key.name), "{}: {}", key.name, f.what());
      return "";
    }
    if (!fs::exists(path, none))
      refuse(*t.get(key.name),
             "{} = \"{}\": there is no file '{}'. Paths are relative to this file.", key.name, name,
             path);
    else if (fs::is_directory(path, none))
      refuse(*t.get(key.name), "{} = \"{}\" is a folder; give the path of a file.", key.name, name);
    else
      return path;
    return "";
  }

  /// The specimens of a simulation are alike unless the file says otherwise.
  double of_specimen(const toml::table &head, const Key &key) {
    return e_.on_press || head.contains(key.name) ? number(head, key) : 0.0;
  }

  void read_head(const toml::table &head) {
    std::vector<std::string> known = {"split"};
    for (const Key &key : head_keys())
      known.push_back(key.name);
    report_unknown(head, known, "experiment.");
    e_.name = text(head, head_keys()[0]);
    e_.electrode = existing(head, head_keys()[1]);
    e_.sample_diameter_mm = number(head, head_keys()[2]);
    e_.foil_thickness_um = number(head, head_keys()[3]);
    e_.foil_density_g_cm3 = number(head, head_keys()[4]);
    e_.labels_pore = static_cast<int>(number(head, head_keys()[5]));
    if (head.contains(head_keys()[6].name))
      e_.labels_cbd = static_cast<int>(number(head, head_keys()[6]));
    e_.labels_voxel_um = number(head, head_keys()[7]);
    e_.on_press = text(head, head_keys()[8]) == "press";
    e_.specimen_porosity_points = of_specimen(head, head_keys()[9]);
    e_.specimen_thickness_percent = of_specimen(head, head_keys()[10]);
    e_.material = text(head, head_keys()[11]);
    if (e_.labels_cbd == e_.labels_pore)
      refuse(
          *head.get("labels_cbd"),
          "labels_cbd and labels_pore are both {}: the label of CBD is that of its voxels alone. "
          "Leave labels_cbd out if the images show no CBD.",
          e_.labels_pore);
    if (!e_.electrode.empty())
      try {
        e_.recipe = read_recipe(e_.electrode);
      } catch (const Failure &f) {
        refuse(*head.get("electrode"), "the recipe has mistakes of its own:\n{}", f.what());
      }
  }

  void read_condition(const toml::table &t) {
    std::vector<std::string> known;
    for (const Key &key : condition_keys())
      known.push_back(key.name);
    for (const Quantity &q : quantities())
      known.push_back(q.key.name);
    report_unknown(t, known, "condition.");
    Condition c;
    c.id = text(t, condition_keys()[0]);
    c.control = text(t, condition_keys()[1]);
    c.curve = existing(t, condition_keys()[2]);
    c.labels_before = existing(t, condition_keys()[3]);
    c.labels_after = existing(t, condition_keys()[4]);
    c.dwell_s = number(t, condition_keys()[5]);
    c.curve_sd_um = number(t, condition_keys()[6]);
    c.curve_drift_um = number(t, condition_keys()[7]);
    c.curve_zero_um = number(t, condition_keys()[8]);
    c.specimen = text(t, condition_keys()[9]);
    c.pressing = text(t, condition_keys()[10]);
    if (c.specimen.empty())
      c.specimen = c.id;
    for (const Quantity &q : quantities())
      if (const toml::node *value = t.get(q.key.name))
        c.*(q.field) = measured(*value, q.key);
    check_condition(c, t);
    e_.conditions.push_back(c);
  }

  void read_crushed(const toml::table &t) {
    report_unknown(t, {crushed_keys()[0].name, crushed_keys()[1].name}, "crushed_particle.");
    CrushedParticles p;
    p.diameter_um = number(t, crushed_keys()[0]);
    if (const toml::node *load = t.get("load_mN"))
      p.load_mN = measured(*load, crushed_keys()[1]).value_or(Measured());
    else
      refuse(t, "a crushed particle has no load_mN.");
    e_.crushed.push_back(p);
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
    report_unknown(*t, known, key.name + ".");
    if (const toml::node *foil = t->get("includes_foil"); foil && has_foil)
      read_foil(*foil, key, m);
    const toml::node *value = t->get("value");
    if (!value) {
      refuse(*t, "{} has no 'value'.", key.name);
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
      refuse(node, "{}.includes_foil must be true or false, not {}.", key.name, shown(node));
  }

  bool read_sd(const toml::table &t, const Key &key, Measured &m) {
    const toml::node *sd = t.get("sd"), *relative = t.get("sd_relative");
    if (sd && relative) {
      refuse(*sd, "{} has both 'sd' and 'sd_relative'; give one of them.", key.name);
      return false;
    }
    if (!sd && !relative)
      return true;
    const Key rule =
        sd ? Key{key.name + ".sd", "", "", 0, key.high - key.low, key.unit, "standard deviation"}
           : Key{key.name + ".sd_relative", "", "", 0, 1, "fraction", "sd over the value"};
    const auto read = number(sd ? *sd : *relative, rule);
    if (read == 0.0) {
      refuse(sd ? *sd : *relative,
             "{} is 0: no measurement is without error. Give the standard deviation of repeats, or "
             "leave it out if it is not known.",
             rule.name);
      return false;
    }
    m.sd = read.value_or(0.0) * (sd ? 1.0 : std::fabs(m.value));
    return read.has_value();
  }

  void check_condition(const Condition &c, const toml::table &t) {
    const std::string who = c.id.empty() ? "this condition" : "condition \"" + c.id + "\"";
    const auto needs = [&](bool there, const char *key) {
      if (!there && whole_)
        refuse(t, "{} has control = \"{}\" but no {}.", who, c.control, key);
    };
    if (c.control == "pressure")
      needs(t.contains("max_pressure_MPa"), "max_pressure_MPa");
    if (c.control == "displacement")
      needs(t.contains("displacement_um") || t.contains("curve"), "displacement_um and no curve");
    if (c.control == "thickness")
      needs(t.contains("thickness_at_max_um"), "thickness_at_max_um");
    if (c.control == "roll_gap")
      needs(t.contains("roll_gap_um"), "roll_gap_um");
    check_foil(e_, c, who, line_of(t), mistakes_);
    check_thickness(e_, c, who, line_of(t), mistakes_);
    check_porosity(c, who, line_of(t));
    if (const auto &cracked = c.cracked_bodies_fraction;
        cracked && cracked->value == 0.0 && cracked->sd == 0.0)
      refuse(t,
             "{}: cracked_bodies_fraction is 0 without an sd; give {{ value = 0, sd = ... }}, 1 "
             "over the number of particles seen, for example.",
             who);
    if (!c.curve.empty())
      check_curve(e_, c, line_of(*t.get("curve")), mistakes_);
    for (const Condition &other : e_.conditions)
      if (!c.id.empty() && other.id == c.id)
        refuse(t, "the id \"{}\" is taken by another condition.", c.id);
  }

  /// Pressing makes no film more porous: far beyond the errors one of the two is another film's.
  void check_porosity(const Condition &c, const std::string &who, int line) {
    if (!c.porosity_after_percent || e_.recipe.file.empty())
      return;
    constexpr double kFar = 3.0;   // standard deviations
    constexpr double kSlip = 10.0; // points that a wrong reading may be off; repeats show it
    const Measured &after = *c.porosity_after_percent;
    const double before = c.porosity_before_percent ? c.porosity_before_percent->value
                                                    : 100.0 * e_.recipe.porosity_total,
                 sd = std::hypot(after.sd, c.porosity_before_percent ? c.porosity_before_percent->sd
                                                                     : e_.specimen_porosity_points);
    if (after.value > before + kSlip + kFar * sd)
      mistakes_.add(line,
                    "{}: porosity_after_percent is {:g}, the film has {:g} before. A film is not "
                    "more porous after pressing: correct one of them, or the recipe.",
                    who, after.value, before);
  }

  void read_split(const toml::table &head) {
    const toml::node *node = head.get("split");
    if (!node)
      return;
    const toml::table *split = node->as_table();
    if (!split) {
      refuse(*node, "split must be {{ train = [\"id\"], test = [\"id\"] }}.");
      return;
    }
    for (const auto &[key, ids] : *split)
      if (key.str() == "train" || key.str() == "test")
        read_ids(ids, std::string(key.str()), key.str() == "train" ? e_.train : e_.test);
      else
        unknown("split." + std::string(key.str()), line_of(ids), {"train", "test"});
    for (const std::string &id : e_.test)
      if (std::find(e_.train.begin(), e_.train.end(), id) != e_.train.end())
        refuse(*node, "\"{}\" is in both train and test of split.", id);
  }

  void read_ids(const toml::node &node, const std::string &part, std::vector<std::string> &out) {
    const toml::array *list = node.as_array();
    if (!list) {
      refuse(node, "split.{} must be a list of ids in quotes, not {}.", part, shown(node));
      return;
    }
    std::vector<std::string> known;
    for (const Condition &c : e_.conditions)
      if (!c.id.empty())
        known.push_back(c.id);
    for (const toml::node &id : *list)
      if (!id.is_string())
        refuse(id, "split.{} holds {}; ids are texts in quotes.", part, shown(id));
      else if (std::find(known.begin(), known.end(), **id.as_string()) == known.end())
        refuse(id, "split.{} names \"{}\", which is no [[condition]]; there are: {}.", part,
               **id.as_string(), fmt::join(known, ", "));
      else
        out.push_back(**id.as_string());
  }
};

} // namespace

Experiment read_experiment(const std::string &file) {
  Mistakes mistakes(file);
  const TomlFile parsed = parse_toml(file, FileKind::Experiment, mistakes);
  Experiment e;
  if (!parsed.root.empty())
    e = ExperimentReader(file, parsed.whole, mistakes).read(parsed);
  mistakes.stop_if_any();
  return e;
}

} // namespace calendem
