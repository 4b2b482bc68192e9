// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank/bank_spec.h"
#include "spec/key.h"
#include "spec/toml_file.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

namespace calendem {
namespace fs = std::filesystem;
namespace {

const std::vector<Key> &head_keys() {
  static const std::vector<Key> keys = {
      {"name", "", "bank", 0, 0, "", "for reports", "", true},
      {"recipe", "", "", 0, 0, "", "electrode recipe", "", true},
      {"case", "", "", 0, 0, "", "case; its electrode is replaced", "", true},
      {"packings", "", "12", 2, 1000, "", "seeds of the recipe", "", false, true},
      {"base_points", "", "48", 4, 10000, "", "without effects", "", false, true},
      {"effect_points", "", "24", 2, 10000, "", "of every effect", "", false, true},
      {"seed", "", "1", 0, 4e9, "", "of the design", "", false, true}};
  return keys;
}

class Reader {
public:
  Reader(const std::string &file, Mistakes &mistakes)
      : folder_(fs::absolute(file).parent_path()), mistakes_(mistakes) {}

  void read_head(const toml::table &t, BankSpec &out) {
    stop_at_unknown(t, {"name", "recipe", "case", "packings", "base_points", "effect_points",
                        "seed", "pressures_MPa", "effects"});
    out.name = text(t, head_keys()[0]);
    out.recipe_file = path(t, head_keys()[1]);
    out.case_file = path(t, head_keys()[2]);
    out.packings = int(number(t, head_keys()[3]));
    out.base_points = int(number(t, head_keys()[4]));
    out.effect_points = int(number(t, head_keys()[5]));
    out.seed = static_cast<unsigned long>(number(t, head_keys()[6]));
    if (out.effect_points > out.base_points)
      mistakes_.add(0, fmt::format("effect_points is {}, base_points {}: every point of an effect "
                                   "needs a base point of its own.",
                                   out.effect_points, out.base_points));
    read_pressures(t, out);
    read_effects(t, out);
  }

  BankParameter read_parameter(const toml::node &node) {
    BankParameter p;
    const toml::table *t = node.as_table();
    if (!t) {
      mistakes_.add(line_of(node), "write a parameter as a table: [[parameter]].");
      return p;
    }
    stop_at_unknown(*t, {"name", "keys", "low", "high", "prior"});
    p.name = text(*t, {"name", "", "", 0, 0, "", "of the parameter", "", true});
    p.low = number(*t, {"low", "", "", -1e300, 1e300, "", "end of the prior"});
    p.high = number(*t, {"high", "", "", -1e300, 1e300, "", "end of the prior"});
    const std::string prior =
        text(*t, {"prior", "", "uniform", 0, 0, "", "", "uniform|log-uniform"});
    p.spread = prior == "log-uniform" ? Spread::LogUniform : Spread::Uniform;
    if (p.low >= p.high || (p.spread == Spread::LogUniform && p.low <= 0.0))
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

private:
  fs::path folder_;
  Mistakes &mistakes_;

  void stop_at_unknown(const toml::table &t, const std::vector<std::string> &known) {
    for (const auto &[key, node] : t)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        mistakes_.add(line_of(node), fmt::format("unknown key '{}'. Did you mean '{}'?", key.str(),
                                                 closest(std::string(key.str()), known)));
  }

  std::string text(const toml::table &t, const Key &key) {
    const toml::node *node = t.get(key.name);
    if (!node) {
      if (key.fallback.empty())
        mistakes_.add(0, fmt::format("key '{}' is missing ({}).", key.name, key.meaning));
      return key.fallback;
    }
    if (!node->is_string())
      mistakes_.add(line_of(*node),
                    fmt::format("{} must be a text in quotes, not {}.", key.name, shown(*node)));
    else if (const auto wrong = wrong_text(key, **node->as_string()))
      mistakes_.add(line_of(*node), *wrong);
    else
      return **node->as_string();
    return key.fallback;
  }

  double number(const toml::table &t, const Key &key) {
    const toml::node *node = t.get(key.name);
    if (!node) {
      if (key.fallback.empty())
        mistakes_.add(0, fmt::format("key '{}' is missing ({}).", key.name, key.meaning));
      return key.fallback.empty() ? 0.0 : std::stod(key.fallback);
    }
    if (!node->is_number())
      mistakes_.add(line_of(*node),
                    fmt::format("{} must be a number, not {}.", key.name, shown(*node)));
    else if (const auto wrong = wrong_number(key, *node->value<double>()))
      mistakes_.add(line_of(*node), *wrong);
    else
      return *node->value<double>();
    return 0.0;
  }

  std::string path(const toml::table &t, const Key &key) {
    const std::string given = text(t, key);
    return given.empty() ? "" : (folder_ / given).lexically_normal().string();
  }

  std::vector<std::string> texts(const toml::table &t, const char *key) {
    std::vector<std::string> out;
    if (const toml::array *list = t[key].as_array())
      for (const toml::node &n : *list)
        if (n.is_string())
          out.push_back(**n.as_string());
    return out;
  }

  void read_pressures(const toml::table &t, BankSpec &out) {
    static const Key key = {"pressures_MPa", "", "", 0.1, 2000, "MPa", "maximum of a run"};
    if (const toml::array *list = t["pressures_MPa"].as_array())
      for (const toml::node &n : *list)
        if (const auto wrong = n.is_number() ? wrong_number(key, *n.value<double>())
                                             : std::optional(shown(n) + " is no number."))
          mistakes_.add(line_of(n), *wrong);
        else
          out.pressures.push_back(*n.value<double>());
    std::sort(out.pressures.begin(), out.pressures.end());
    if (out.pressures.empty())
      mistakes_.add(0, "[bank] needs a list pressures_MPa.");
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

BankSpec read_bank_spec(const std::string &file) {
  Mistakes mistakes(file, 20);
  BankSpec out;
  out.file = file;
  const TomlFile parsed = parse_toml(file, mistakes);
  Reader reader(file, mistakes);
  for (const auto &[key, node] : parsed.root) {
    if (key.str() == "bank" && node.is_table())
      reader.read_head(*node.as_table(), out);
    else if (key.str() == "parameter" && node.is_array())
      for (const toml::node &parameter : *node.as_array())
        out.parameters.push_back(reader.read_parameter(parameter));
    else
      mistakes.add(line_of(node), fmt::format("unknown '{}'; a bank has a table [bank] and tables "
                                              "[[parameter]].",
                                              key.str()));
  }
  if (parsed.whole && !parsed.root.contains("bank"))
    mistakes.add(0, "has no table [bank].");
  std::set<std::string> names;
  for (const BankParameter &p : out.parameters)
    if (!names.insert(p.name).second)
      mistakes.add(0, fmt::format("two parameters are called '{}'.", p.name));
  if (out.parameters.empty() && parsed.whole)
    mistakes.add(0, "has no [[parameter]]: there would be nothing to recalibrate.");
  mistakes.stop_if_any();
  return out;
}

} // namespace calendem
