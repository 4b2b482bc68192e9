// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/material.h"
#include "base/case.h"
#include "base/provenance.h"
#include "base/recipe.h"
#include "base/table_reader.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace calendem {

namespace fs = std::filesystem;
namespace {

const char *const kOwnFile = "the path of a file of your own, relative to this one";

bool is_path(const std::string &given) {
  return given.find('/') != std::string::npos || fs::path(given).extension() == ".toml";
}

bool of_contacts_or_bonds(const std::string &key) {
  return std::any_of(effects().begin(), effects().end(), [&](const Effect &e) {
    return (e.contact.law || e.layer == "contact" || e.layer == "bond") &&
           std::any_of(e.settings.begin(), e.settings.end(),
                       [&](const Key &k) { return k.name == key; });
  });
}

std::vector<Key> keys_of_materials() {
  std::vector<Key> out;
  for (const Key &key : case_keys())
    if (describes_material(key, false))
      out.push_back(key);
  for (const Key &key : recipe_keys())
    if (describes_material(key, true))
      out.push_back(key);
  return out;
}

class MaterialReader : TableReader {
public:
  using TableReader::TableReader;

  void read(const toml::table &root, ReferenceMaterial &out) {
    out.name = text(root, {"name", "", "", 0, 0, "", "for reports", "", true});
    out.also_called = texts(root, "also_called");
    out.calibrated_on = texts(root, "calibrated_on");
    base_ = text(root, {"base", "", "-", 0, 0, "",
                        "material whose values it has unless it gives "
                        "them: a name or a path",
                        "", true});
    walk("", root, out);
  }
  const std::string &base() const { return base_; }
  /// The lines of the values, for what they contradict.
  const Settings &lines() const { return lines_; }

private:
  const std::vector<Key> keys_ = keys_of_materials();
  std::string base_;
  Settings lines_;

  void walk(const std::string &prefix, const toml::table &table, ReferenceMaterial &out) {
    for (const auto &[k, node] : table) {
      const std::string name = prefix + std::string(k.str());
      const toml::table *inner = node.as_table();
      if (const Key *key = find_key(keys_, name))
        take(*key, node, out);
      else if (inner && !inner->contains("value"))
        walk(name + ".", *inner, out);
      else if (!prefix.empty() || (name != "name" && name != "also_called" &&
                                   name != "calibrated_on" && name != "base"))
        refuse(node, "unknown key '{}' of a material. {}", name,
               did_you_mean(name, likely_meant(name, keys_)));
    }
  }

  void take(const Key &key, const toml::node &node, ReferenceMaterial &out) {
    const toml::table *t = node.as_table();
    const toml::node *value = t ? t->get("value") : nullptr;
    lines_.note(key.name, line_of(node), false);
    if (!value || !t->contains("source"))
      return refuse(node,
                    "{} needs a value and its source: write {{ value = {}, source = \"doi:...\" }} "
                    "or source = \"calibrated on ...\".",
                    key.name,
                    t && value ? shown(*value)
                    : t        ? "..."
                               : shown(node));
    report_unknown(*t, {"value", "sd", "source"}, key.name + ".");
    MaterialValue v;
    v.source = text(*t, {"source", "", "", 0, 0, "", "of the value", "", true});
    v.sd = number(*t, {"sd", "", "0", 0, 1e12, key.unit, "standard deviation"});
    if (const auto wrong = wrong_value(key, *value))
      return refuse(*value, "{}", *wrong);
    v.text = value_text(*value);
    out.values[key.name] = v;
  }
};

/// Its values with the fallbacks of all other keys of a case must make a case.
void check_values(const ReferenceMaterial &m, Settings lines, Mistakes &mistakes) {
  for (const Key &key : case_keys())
    if (const auto at = m.values.find(key.name); at != m.values.end())
      lines.set(key.name, at->second.text);
  fill_in(case_keys(), lines);
  check_case(lines, mistakes);
}

ReferenceMaterial read_above(const std::string &file, std::vector<std::string> above);

void inherit(const std::string &given, const std::string &file,
             const std::vector<std::string> &above, ReferenceMaterial &out, Mistakes &mistakes) {
  const std::string base = material_path(given, file);
  if (std::find(above.begin(), above.end(), base) != above.end())
    return mistakes.add(
        0, "base = \"{}\" leads back to this file. Give another base, or leave it out.", given);
  try {
    const ReferenceMaterial from = read_above(base, above);
    out.values.insert(from.values.begin(), from.values.end());
  } catch (const Failure &f) {
    mistakes.add(f);
  }
}

ReferenceMaterial read_above(const std::string &file, std::vector<std::string> above) {
  above.push_back(file);
  Mistakes mistakes(file);
  const TomlFile parsed = parse_toml(file, FileKind::Material, mistakes);
  MaterialReader reader(file, parsed.whole, mistakes);
  ReferenceMaterial out;
  reader.read(parsed.root, out);
  for (const char *list : {"also_called", "calibrated_on"})
    if (parsed.whole && !parsed.root.empty() && !parsed.root.contains(list))
      mistakes.add(0, "the list '{}' is missing; give [] if there is nothing.", list);
  if (!reader.base().empty())
    inherit(reader.base(), file, above, out, mistakes);
  if (mistakes.empty())
    check_values(out, reader.lines(), mistakes);
  mistakes.stop_if_any();
  return out;
}

} // namespace

std::string ReferenceMaterial::hash() const {
  std::string all = name;
  for (const auto &[key, v] : values)
    all += fmt::format("\n{}={} {} {}", key, v.text, v.sd, v.source);
  return hash_of_text(all);
}

bool describes_material(const Key &key, bool of_recipe) {
  static const char *const kOfRecipe[] = {
      "density.am_g_cm3",        "density.cbd_solid_g_cm3", "particles.primary_diameter_um",
      "particles.lattice_um",    "particles.grains",        "particles.irregularity",
      "cbd.nanoporosity_percent"};
  const std::string &name = key.name;
  if (of_recipe)
    return std::find(std::begin(kOfRecipe), std::end(kOfRecipe), name) != std::end(kOfRecipe);
  return name.rfind("material.", 0) == 0 ||
         (name.rfind("bond.", 0) == 0 && name != "bond.seed" && name != "bond.breakable") ||
         of_contacts_or_bonds(name);
}

std::vector<std::string> known_materials() {
  std::vector<std::string> out;
  std::error_code none;
  for (const auto &entry : fs::directory_iterator(input_scripts() + "/materials", none))
    if (entry.path().extension() == ".toml")
      out.push_back(entry.path().stem().string());
  std::sort(out.begin(), out.end());
  return out;
}

std::string material_path(const std::string &given, const std::string &file) {
  return is_path(given) ? (fs::absolute(file).parent_path() / given).lexically_normal().string()
                        : fmt::format("{}/materials/{}.toml", input_scripts(), given);
}

ReferenceMaterial read_material(const std::string &file) {
  const fs::path path(file);
  if (std::error_code none; !fs::exists(path, none))
    throw Failure(kBadInput, "there is no material '{}'. Known are {}; or give {}.",
                  fs::path(input_scripts() + "/materials") == path.parent_path()
                      ? path.stem().string()
                      : file,
                  fmt::join(known_materials(), ", "), kOwnFile);
  return read_above(file, {});
}

void take_values(const ReferenceMaterial &m, const std::vector<Key> &keys, Settings &s) {
  for (const Key &key : keys)
    if (const auto at = m.values.find(key.name); at != m.values.end() && s.line(key.name) == 0)
      s.set(key.name, at->second.text);
}

nlohmann::ordered_json to_json(const ReferenceMaterial &m) {
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (const auto &[key, v] : m.values) {
    values[key] = {{"value", v.text}, {"source", v.source}};
    if (v.sd > 0.0)
      values[key]["sd"] = v.sd;
  }
  return {{"name", m.name},
          {"also_called", m.also_called},
          {"calibrated_on", m.calibrated_on},
          {"hash", m.hash()},
          {"values", values}};
}

ReferenceMaterial material_of_electrode(const std::string &folder) {
  ReferenceMaterial out;
  try {
    std::ifstream in(folder + "/electrode.json");
    const nlohmann::json j = nlohmann::json::parse(in).at("material");
    for (const auto &[key, v] : j.at("values").items())
      out.values[key] = {v.at("value"), v.at("source"), v.value("sd", 0.0)};
    out.also_called = j.at("also_called").get<std::vector<std::string>>();
    out.calibrated_on = j.at("calibrated_on").get<std::vector<std::string>>();
    out.name = j.at("name");
  } catch (const nlohmann::json::exception &) { // read_electrode says what is wrong with it
    return {};
  }
  return out;
}

} // namespace calendem
