// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/study_file.h"
#include "base/case.h"
#include "base/csv_table.h"
#include "base/particle_sizes.h"
#include "base/provenance.h"
#include "base/table_reader.h"
#include "base/toml_reader.h"
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr std::size_t kMostRuns = 100000;
constexpr int kMostRunsListed = 5;
constexpr std::size_t kSettingsSaid = 6; // of a run, in a line of the terminal

/// Keys that change together; each row is one combination of their values.
struct Group {
  std::vector<std::string> keys;
  std::vector<std::vector<std::string>> rows;
};

/// The key "case.…" or "recipe.…" is the name of; null if there is none.
const Key *varied_key(const std::string &name) {
  const std::string bare = name.substr(name.find('.') + 1);
  const Key *key = name == "recipe." + bare ? find_key(recipe_keys(), bare)
                   : name == "case." + bare ? find_key(case_keys(), bare)
                                            : nullptr;
  return bare == "electrode" || bare == "material" ? nullptr : key;
}

std::string unknown_key(const std::string &name) {
  std::vector<std::string> all;
  for (const Key &k : case_keys())
    if (k.name != "electrode")
      all.push_back("case." + k.name);
  for (const Key &k : recipe_keys())
    if (k.name != "material")
      all.push_back("recipe." + k.name);
  return fmt::format("'{}' is not a key that can be varied. {}", name,
                     did_you_mean(name, closest(name, all)));
}

/// Reads the file, table by table.
class Reader : TableReader {
public:
  using TableReader::TableReader;

  void read_head(const toml::table &t, Study &out) {
    report_unknown(t, {"name", "recipe", "case", "at_pressure_MPa", "keep"});
    out.name = text(t, {"name", "", "study", 0, 0, "", "for reports", "", true});
    out.recipe_file = path(t, {"recipe", "", "", 0, 0, "", "electrode recipe", "", true});
    out.case_file = path(t, {"case", "", "", 0, 0, "", "its electrode is replaced", "", true});
    out.keep_all = text(t, {"keep", "", "all", 0, 0, "", "of each run", "all|tables"}) != "tables";
    out.at_pressure =
        numbers(t, {"at_pressure_MPa", "", "-", 1e-3, 1e4, "MPa", "columns of the table"});
    std::sort(out.at_pressure.begin(), out.at_pressure.end());
  }

  std::vector<Group> read_groups(const toml::table &root) {
    std::vector<Group> out;
    each_table(root, "vary", [&](const toml::table &t) {
      report_unknown(t, {"keys", "values", "normal", "design"});
      if (t.contains("design") && (t.contains("keys") || t.contains("values")))
        refuse(t, "give either keys and values, or a design.");
      else
        out.push_back(t.contains("design") ? read_design(t) : read_values(t, line_of(t)));
    });
    return out;
  }

private:
  /// The value as text if the key may hold it.
  std::string checked(const std::string &name, const std::string &cell, int line) {
    const Key *key = varied_key(name);
    if (const auto wrong = key ? wrong_cell(*key, cell) : std::nullopt)
      mistakes_.add(line, *wrong);
    else if (cell.find_first_of(",\n\"") != std::string::npos)
      mistakes_.add(line,
                    "{}: '{}' holds a comma, a quote or a line's end, which the table of results "
                    "cannot hold.",
                    name, cell);
    return cell;
  }

  static std::string cell_of(const toml::node &node) {
    return node.is_string() ? **node.as_string() : shown(node);
  }

  void add_row(Group &group, const toml::node &value) {
    std::vector<std::string> row;
    if (const toml::array *list = value.as_array()) {
      if (list->size() != group.keys.size())
        return refuse(value, "a row of values has {} entries for {} keys.", list->size(),
                      group.keys.size());
      for (std::size_t k = 0; k < group.keys.size(); ++k)
        row.push_back(checked(group.keys[k], cell_of((*list)[k]), line_of((*list)[k])));
    } else {
      for (const std::string &key : group.keys)
        row.push_back(checked(key, cell_of(value), line_of(value)));
    }
    group.rows.push_back(row);
  }

  /// normal = { mean, sd, cells }: the law at the middle of as many equal shares, drawn apart until
  /// the cells' standard deviation is the law's.
  void add_normal(Group &group, const toml::table &t, int line) {
    report_unknown(t, {"mean", "sd", "cells"}, "normal.");
    const double mean = number(t, {"mean", "", "", -1e9, 1e9, "", "of the cells"}),
                 sd = number(t, {"sd", "", "", 0, 1e9, "", "of the cells"});
    const int cells = int(number(t, {"cells", "", "", 2, 1000, "", "how many", "", false, true}));
    std::vector<double> score;
    double squares = 0.0;
    for (int k = 0; k < cells; ++k) {
      score.push_back(boost::math::quantile(boost::math::normal(), (k + 0.5) / cells));
      squares += score.back() * score.back() / cells;
    }
    for (const double z : score) {
      const std::string cell = fmt::format("{:.6g}", mean + sd * z / std::sqrt(squares));
      std::vector<std::string> row;
      for (const std::string &key : group.keys)
        row.push_back(checked(key, cell, line));
      group.rows.push_back(row);
    }
  }

  Group read_values(const toml::table &t, int line) {
    Group group;
    const toml::array *keys = t["keys"].as_array(), *values = t["values"].as_array();
    const toml::table *normal = t["normal"].as_table();
    if (!keys || keys->empty() || (values && !values->empty()) == (normal != nullptr)) {
      mistakes_.add(line, "a group [[vary]] needs a list 'keys' and either a list 'values' or a "
                          "table 'normal'.");
      return group;
    }
    for (const toml::node &k : *keys) {
      group.keys.push_back(cell_of(k));
      if (!varied_key(group.keys.back()))
        mistakes_.add(line_of(k), unknown_key(group.keys.back()));
    }
    if (normal)
      add_normal(group, *normal, line);
    else
      for (const toml::node &v : *values)
        add_row(group, v);
    return group;
  }

  Group read_design(const toml::table &t) {
    Group group;
    const int line = line_of(*t.get("design"));
    const std::string file = path(t, {"design", "", "", 0, 0, "", "table (CSV)", "", true});
    if (!std::filesystem::is_regular_file(file)) {
      mistakes_.add(line, "design: there is no file '{}'.", file);
      return group;
    }
    const CsvTable table = CsvTable::parse(text_of_file(file));
    if (const std::string wrong = table.ambiguous(); !wrong.empty())
      mistakes_.add(line, "{} {}", file, wrong);
    if (table.rows() == 0)
      mistakes_.add(line, "{} holds no rows.", file);
    for (const int bad : table.bad_lines())
      mistakes_.add(line, "{}:{}: the row has another number of cells than the header.", file, bad);
    for (const std::string &name : table.header())
      if (!varied_key(name))
        mistakes_.add(line, "{}: column {}", file, unknown_key(name));
    group.keys = table.header();
    group.rows.resize(table.rows());
    for (const std::string &name : group.keys) {
      const std::vector<std::string> cells = table.texts(name);
      for (std::size_t k = 0; k < cells.size(); ++k)
        group.rows[k].push_back(checked(name, cells[k], line));
    }
    return group;
  }
};

/// Paths in the recipe are relative to its file; the study writes it elsewhere.
void make_paths_absolute(Settings &s, const std::string &file) {
  if (const std::string given = s.text("material");
      material_path(given, file) != material_path(given, ""))
    s.set("material", material_path(given, file));
  for (const char *key : {"shapes.image", "shapes.library", "structure.file", "structure.body_map"})
    if (s.text(key) != "none")
      s.set(key, path_of(s, key, file));
}

/// The settings of the given combination, and what they contradict.
StudyRun make_run(const Study &study, const Recipe &recipe, const Settings &settings,
                  const std::vector<std::string> &values, Mistakes &mistakes) {
  StudyRun run;
  run.values = values;
  run.settings = settings;
  Settings changed = recipe.settings;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::string &name = study.columns[k], bare = name.substr(name.find('.') + 1);
    if (const auto wrong = wrong_cell(*varied_key(name), values[k]))
      mistakes.add(0, *wrong);
    (name[0] == 'r' ? changed : run.settings).set(bare, values[k]);
  }
  take_sizes_by_volume(changed, recipe_keys(), mistakes);
  run.recipe = recipe_of(changed);
  run.recipe.shapes = recipe.shapes;
  run.recipe.structure = recipe.structure;
  run.recipe.material = recipe.material;
  check_recipe(changed, run.recipe, mistakes);
  check_case(run.settings, mistakes);
  return run;
}

/// Every combination of the groups' rows.
std::vector<std::vector<std::string>> combinations(const std::vector<Group> &groups,
                                                   Mistakes &mistakes) {
  std::vector<std::vector<std::string>> rows(1);
  for (const Group &group : groups) {
    std::vector<std::vector<std::string>> next;
    for (const auto &head : rows)
      for (const auto &tail : group.rows) {
        next.push_back(head);
        next.back().insert(next.back().end(), tail.begin(), tail.end());
      }
    rows = next;
    if (rows.size() > kMostRuns) {
      mistakes.add(0, "the study has more than {} runs.", kMostRuns);
      return {};
    }
  }
  return rows;
}

void stop_at_twice(const std::vector<Group> &groups, Mistakes &mistakes) {
  std::vector<std::string> keys;
  for (const Group &group : groups)
    for (const std::string &key : group.keys) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end())
        mistakes.add(0, "'{}' is varied twice; a key belongs to one group.", key);
      keys.push_back(key);
    }
}

} // namespace

void check_column(const std::string &name, Mistakes &mistakes) {
  if (!varied_key(name))
    mistakes.add(0, unknown_key(name));
}

namespace {

/// The shortest end of the key, in whole parts, that no other column ends with.
std::string short_name(const std::string &key, const std::vector<std::string> &columns) {
  for (std::size_t dot = key.rfind('.'); dot != std::string::npos && dot > 0;
       dot = key.rfind('.', dot - 1)) {
    const std::string end = key.substr(dot);
    if (std::count_if(columns.begin(), columns.end(), [&](const std::string &c) {
          return c.size() >= end.size() && c.compare(c.size() - end.size(), end.size(), end) == 0;
        }) == 1)
      return end.substr(1);
  }
  return key;
}

std::string differences(const Study &study, const std::vector<std::string> &row,
                        const Settings &recipe, const Settings &settings) {
  std::vector<std::string> out;
  for (std::size_t c = 0; c < row.size(); ++c) {
    const std::string &key = study.columns[c], bare = key.substr(key.find('.') + 1);
    if (row[c] != (key[0] == 'r' ? recipe : settings).text(bare))
      out.push_back(short_name(key, study.columns) + " " + row[c]);
  }
  if (out.empty())
    return "as recipe and case";
  const auto shown = out.begin() + std::min(out.size(), kSettingsSaid);
  return fmt::format("{}{}", fmt::join(out.begin(), shown, ", "),
                     shown == out.end() ? "" : fmt::format(" and {} more", out.end() - shown));
}

} // namespace

void add_runs(Study &out, const std::vector<std::vector<std::string>> &rows, Mistakes &mistakes) {
  Recipe recipe = read_recipe(out.recipe_file);
  make_paths_absolute(recipe.settings, out.recipe_file);
  const Settings settings = read_case(out.case_file, recipe);
  int wrong = 0;
  for (const auto &row : rows) {
    Mistakes of_run(fmt::format("run {}", out.runs.size() + 1));
    out.runs.push_back(make_run(out, recipe, settings, row, of_run));
    out.runs.back().number = static_cast<int>(out.runs.size());
    if (of_run.empty())
      out.runs.back().said = differences(out, row, recipe.settings, settings);
    if (!of_run.empty() && ++wrong <= kMostRunsListed)
      mistakes.add(0, of_run.text());
  }
  if (wrong > kMostRunsListed)
    mistakes.add(0, "{} more runs have mistakes.", wrong - kMostRunsListed);
}

Study read_study(const std::string &file) {
  Mistakes mistakes(file, 20);
  Study out;
  out.file = file;
  const TomlFile parsed = parse_toml(file, FileKind::Study, mistakes);
  Reader reader(file, parsed.whole, mistakes);
  const std::vector<Group> groups = reader.read_groups(parsed.root);
  for (const auto &[key, node] : parsed.root) {
    if (key.str() == "study" && node.is_table())
      reader.read_head(*node.as_table(), out);
    else if (key.str() != "vary")
      mistakes.add(line_of(node), "unknown '{}'; a study has a table [study] and groups [[vary]].",
                   key.str());
  }
  if (parsed.whole && !parsed.root.empty() && !parsed.root.contains("study"))
    mistakes.add(0, "has no table [study].");
  stop_at_twice(groups, mistakes);
  mistakes.stop_if_any();
  for (const Group &group : groups)
    out.columns.insert(out.columns.end(), group.keys.begin(), group.keys.end());
  add_runs(out, combinations(groups, mistakes), mistakes);
  mistakes.stop_if_any();
  return out;
}

} // namespace calendem
