// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank/bank_file.h"
#include "base/registry.h"
#include "base/table_reader.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

namespace calendem::bank {
namespace {

/// The widest range of an effect: that of its prior, and weaker; what yields may be ten times as soft.
EffectParameter at_most(EffectParameter p) {
  if (p.scale == AmplitudeScale::Reciprocal)
    p.low *= 0.1;
  else if (p.scale == AmplitudeScale::Difference)
    p.low = std::min(p.low, std::stod(p.off));
  return p;
}

bool have_one_law(const Effect &a, const Effect &b) {
  const auto phases = [](const std::pair<Phase, Phase> &p) {
    return std::minmax(p.first, p.second);
  };
  for (const auto &pair : a.contact.between)
    for (const auto &other : b.contact.between)
      if (phases(pair) == phases(other))
        return true;
  return false;
}

/// By a relation of one of them, either way round.
bool are_not_both(const Effect &a, const Effect &b) {
  const auto is_of = [](const Effect &e, const std::string &key) {
    return std::any_of(e.settings.begin(), e.settings.end(),
                       [&](const Key &own) { return own.name == key; });
  };
  const auto says_so = [&](const Effect &e, const Effect &other) {
    return std::any_of(e.relations.begin(), e.relations.end(), [&](const Relation &r) {
      return r.is == Relation::Is::NotBoth && ((is_of(e, r.key) && is_of(other, r.other)) ||
                                               (is_of(other, r.key) && is_of(e, r.other)));
    });
  };
  return says_so(a, b) || says_so(b, a);
}

class Reader : TableReader {
public:
  using TableReader::TableReader;

  void read_head(const toml::table &t, Bank &out) {
    report_unknown(t, {"name", "recipe", "case", "points", "packings", "seed", "faults",
                       "nanoporosity_within_points", "crushing"});
    out.name = text(t, {"name", "", "bank", 0, 0, "", "for reports", "", true});
    out.recipe_file = path(t, {"recipe", "", "", 0, 0, "", "electrode recipe", "", true});
    out.case_file =
        path(t, {"case", "", "", 0, 0, "", "case; its electrode is replaced", "", true});
    out.design.points = int(number(t, {"points", "", "", 4, 16384, "", "runs", "", false, true}));
    out.design.packings =
        int(number(t, {"packings", "", "24", 2, 1000, "", "seeds of the recipe", "", false, true}));
    out.design.seed = static_cast<std::uint64_t>(
        number(t, {"seed", "", "1", 0, 4e9, "", "of the design", "", false, true}));
    out.nanoporosity_within = number(
        t, {"nanoporosity_within_points", "", "0", 0, 20, "%", "to either side of a recipe's"});
    out.crushing_file =
        path(t, {"crushing", "", "-", 0, 0, "", "loads of single particles (CSV)", "", true});
    out.faults = texts(t, "faults");
    for (const std::string &name : out.faults)
      if (const Effect *e = effect(name, *t.get("faults")); e && !e->shown)
        refuse(*t.get("faults"),
               "'{}' changes the film, not what the press shows: it needs runs. Give it a table "
               "[[effect]].",
               name);
  }

  void read_input(const toml::table &t, Bank &out) {
    report_unknown(t, {"name", "keys", "low", "high", "prior"});
    Input input;
    input.name = text(t, {"name", "", "", 0, 0, "", "of the input", "", true});
    input.keys = texts(t, "keys");
    input.low = number(t, {"low", "", "", -1e300, 1e300, "", "end of the range"});
    input.high = number(t, {"high", "", "", -1e300, 1e300, "", "end of the range"});
    if (text(t, {"prior", "", "uniform", 0, 0, "", "", "uniform|log-uniform"}) == "log-uniform")
      input.spread = Spread::LogUniform;
    if (input.keys.empty())
      refuse(t, "input '{}' needs a list 'keys' of texts.", input.name);
    add(t, input, out);
  }

  void read_effect(const toml::table &t, Bank &out) {
    report_unknown(t, {"name", "share", "low", "high"});
    Input input;
    input.name = text(t, {"name", "", "", 0, 0, "", "of the effect", "", true});
    input.share = number(t, {"share", "", "", 0.01, 0.99, "", "of the points where it acts"});
    const Effect *e = effect(input.name, t);
    if (!e)
      return;
    const EffectParameter &p = e->parameter, most = at_most(p);
    for (const std::string &key : p.keys)
      input.keys.push_back(e->column(key));
    input.low = number(t, {"low", "", fmt::format("{}", p.low), most.low, most.high, "", "of it"});
    input.high =
        number(t, {"high", "", fmt::format("{}", p.high), most.low, most.high, "", "of it"});
    input.spread = p.spread;
    input.off = p.off;
    for (const Input &before : out.design.inputs)
      if (before.is_effect())
        if (const Effect &other = find_effect(before.name);
            have_one_law(*e, other) || are_not_both(*e, other))
          input.excludes.push_back(before.name);
    add(t, input, out);
  }

  void read_lists(const toml::table &root, Bank &out) {
    each_table(root, "input", [&](const toml::table &t) { read_input(t, out); });
    each_table(root, "effect", [&](const toml::table &t) { read_effect(t, out); });
    each_table(root, "numerics", [&](const toml::table &t) { read_numerics(t, out); });
  }

  void read_larger_cell(const toml::table &t, Bank &out) {
    report_unknown(t, {"share", "recipe"});
    out.design.larger.share = number(t, {"share", "", "", 0.001, 0.5, "", "of the points"});
    const toml::table *recipe = t["recipe"].as_table();
    if (!recipe || recipe->empty())
      return refuse(t, "[larger_cell] needs recipe = {{ \"cell.x_um\" = 12 }}.");
    for (const auto &[key, value] : *recipe)
      if (const auto v = number(value, {"recipe", "", "", -1e300, 1e300, "", "a key's value"}))
        out.design.larger.recipe[std::string(key.str())] = fmt::format("{}", *v);
  }

  void read_numerics(const toml::table &t, Bank &out) {
    report_unknown(t, {"name", "porosity_points"});
    out.numerics.push_back(
        {text(t, {"name", "", "", 0, 0, "", "of the error", "", true}),
         number(t, {"porosity_points", "", "", 0, 20, "%", "of the porosity under pressure"})});
  }

private:
  const Effect *effect(const std::string &name, const toml::node &at) {
    try {
      return name.empty() ? nullptr : &find_effect(name);
    } catch (const Failure &e) {
      refuse(at, "{}", e.what());
      return nullptr;
    }
  }

  void add(const toml::node &node, const Input &input, Bank &out) {
    if (input.low >= input.high || (input.spread == Spread::LogUniform && input.low <= 0.0))
      refuse(
          node,
          "'{}' goes from {} to {}; low must be below high, and above 0 for a log-uniform prior.",
          input.name, input.low, input.high);
    for (const Input &other : out.design.inputs)
      if (other.name == input.name)
        refuse(node, "two inputs are called '{}'.", input.name);
    out.design.inputs.push_back(input);
  }
};

} // namespace

Bank read_bank(const std::string &file) {
  Mistakes mistakes(file, 20);
  Bank out;
  out.file = file;
  const TomlFile parsed = parse_toml(file, FileKind::Bank, mistakes);
  Reader reader(file, parsed.whole, mistakes);
  if (const toml::table *head = parsed.root["bank"].as_table())
    reader.read_head(*head, out);
  else if (parsed.whole)
    mistakes.add(0, "has no table [bank].");
  reader.read_lists(parsed.root, out);
  if (const toml::table *larger = parsed.root["larger_cell"].as_table())
    reader.read_larger_cell(*larger, out);
  const std::set<std::string> known = {"bank", "input", "effect", "numerics", "larger_cell"};
  for (const auto &[key, node] : parsed.root)
    if (known.count(std::string(key.str())) == 0)
      mistakes.add(line_of(node),
                   "unknown '{}'; a bank has tables [bank], [larger_cell], [[input]], [[effect]] "
                   "and [[numerics]].",
                   key.str());
  if (out.design.inputs.empty() && parsed.whole)
    mistakes.add(0, "has no [[input]]: its points would not differ.");
  mistakes.stop_if_any();
  return out;
}

std::string table_of(const Bank &bank) {
  return std::filesystem::path(bank.file).replace_extension("csv").string();
}

Study study_of(const Bank &bank, const std::vector<Point> &points) {
  return study_of(bank,
                  columns_of(bank.design, points, read_recipe(bank.recipe_file).settings.all()));
}

Study study_of(const Bank &bank, const Columns &columns) {
  Study study;
  study.file = bank.file;
  study.name = bank.name;
  study.recipe_file = bank.recipe_file;
  study.case_file = bank.case_file;
  study.keep_all = false;
  study.measured = true;
  study.columns = columns.names;
  Mistakes mistakes(study.file, 20);
  for (const std::string &name : study.columns)
    check_column(name, mistakes);
  mistakes.stop_if_any();
  add_runs(study, columns.rows, mistakes);
  mistakes.stop_if_any();
  return study;
}

} // namespace calendem::bank
