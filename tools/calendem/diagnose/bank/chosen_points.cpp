// SPDX-License-Identifier: GPL-2.0-or-later
// The file of a bank's chosen points.
#include "base/csv_table.h"
#include "base/provenance.h"
#include "diagnose/bank/bank_spec.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

namespace calendem {
namespace {

/// What is wrong with a point; empty: nothing.
std::string mistake_of(const std::string &effect, double base_point, double value,
                       const BankSpec &spec) {
  const bool of_bank =
      std::find(spec.effects.begin(), spec.effects.end(), effect) != spec.effects.end();
  if (!of_bank || find_effect(effect).instrument)
    return fmt::format("'{}' is no simulated effect of the bank.", effect);
  const int first = spec.first_point + points_of(spec, effect),
            last = spec.first_point + spec.base_points - 1;
  if (!(base_point >= first && base_point <= last && base_point == int(base_point)))
    return fmt::format("base_point is {:g}. {} has points of its own beside the first {}; a chosen "
                       "one stands beside one of {} to {}. Take the line out, or give the effect "
                       "fewer points.",
                       base_point, effect, points_of(spec, effect), first, last);
  const EffectParameter p = effect_of(spec, effect).parameter;
  if (!(value >= p.low && value <= p.high))
    return fmt::format("value is {:g}; {} goes from {:g} to {:g}.", value, effect, p.low, p.high);
  return "";
}

} // namespace

std::string write_chosen(const std::vector<ChosenRun> &chosen) {
  std::string out = "effect,base_point,value\n";
  for (const ChosenRun &c : chosen)
    out += fmt::format("{},{},{}\n", c.effect, c.base_point, c.value);
  return out;
}

void read_chosen(const std::string &file, BankSpec &spec, Mistakes &all) {
  Mistakes mistakes(file, 10);
  const bool there = std::filesystem::is_regular_file(file);
  if (!there)
    mistakes.add(0, "no such file. calendem bank --choose makes one. Copy it along with a bank's "
                    "file, or leave chosen_points out.");
  const CsvTable t = CsvTable::parse(there ? text_of_file(file) : "");
  for (const char *column : {"effect", "base_point", "value"})
    if (there && !t.has(column))
      mistakes.add(0, fmt::format("column '{}' is missing.", column));
  for (const int line : t.bad_lines())
    mistakes.add(line, "the row has another number of cells than the header.");
  if (const std::string wrong = t.ambiguous(); !wrong.empty())
    mistakes.add(0, "the table " + wrong);
  if (mistakes.empty()) {
    const std::vector<std::string> effect = t.texts("effect");
    const std::vector<double> base_point = t.numbers("base_point"), value = t.numbers("value");
    std::set<std::pair<std::string, double>> had;
    for (std::size_t k = 0; k < t.rows(); ++k) {
      const int line = t.line_of(k);
      if (const std::string wrong = mistake_of(effect[k], base_point[k], value[k], spec);
          !wrong.empty())
        mistakes.add(line, wrong);
      else if (!had.emplace(effect[k], base_point[k]).second)
        mistakes.add(line, fmt::format("{} has two points beside base point {:g}; keep one.",
                                       effect[k], base_point[k]));
      else
        spec.chosen.push_back({effect[k], int(base_point[k]), value[k]});
    }
  }
  all.add(mistakes);
}

} // namespace calendem
