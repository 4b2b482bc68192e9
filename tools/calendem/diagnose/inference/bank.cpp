// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/bank.h"
#include "base/csv_table.h"
#include "base/messages.h"
#include "inference/numerics.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem::inference {

namespace {

const ModelledEffect *effect_named(const Bank &bank, const std::string &name) {
  for (const ModelledEffect &e : bank.effects)
    if (e.name == name)
      return &e;
  return nullptr;
}

void check_run(const Bank &bank, int number, const std::vector<bool> &may_lack,
               Mistakes &mistakes) {
  const BankRun &r = bank.runs[number];
  const ModelledEffect *effect = effect_named(bank, r.effect);
  const auto add = [&](const std::string &text) {
    mistakes.add(0, fmt::format("run {}: {}", number + 1, text));
  };
  if (!r.effect.empty() && !effect)
    return add(fmt::format("effect '{}' is not in the table of effects", r.effect));
  if (r.base.size() != Eigen::Index(bank.base.size()) ||
      r.values.size() != Eigen::Index(bank.observables.size()) ||
      r.amplitudes.size() != Eigen::Index(effect ? effect->parameters.size() : 0))
    return add(fmt::format("{} base parameters, {} amplitudes, {} observables; {}, {}, {} are due",
                           r.base.size(), r.amplitudes.size(), r.values.size(), bank.base.size(),
                           effect ? effect->parameters.size() : 0, bank.observables.size()));
  if (!r.base.allFinite() || !r.amplitudes.allFinite())
    add("a parameter is not a number");
  for (Eigen::Index i = 0; i < r.values.size(); ++i)
    if (!std::isfinite(r.values[i]) && !may_lack[std::size_t(i)])
      return add(key_of(bank.observables[i]) + " is not a number; leave the run out, or the "
                                               "observable in all runs and the experiment");
}

} // namespace

std::vector<std::pair<int, int>> pairs_of(const Bank &bank, const std::string &effect) {
  std::vector<std::pair<int, int>> pairs;
  for (int on = 0; on < int(bank.runs.size()); ++on) {
    if (bank.runs[on].effect != effect)
      continue;
    for (int off = 0; off < int(bank.runs.size()); ++off)
      if (bank.runs[off].effect.empty() && bank.runs[off].packing == bank.runs[on].packing &&
          bank.runs[off].base == bank.runs[on].base) {
        pairs.emplace_back(off, on);
        break;
      }
  }
  return pairs;
}

std::vector<int> runs_that_have(const Bank &bank, const std::vector<int> &observables) {
  std::vector<bool> has;
  for (const BankRun &run : bank.runs)
    has.push_back(run.values(observables).allFinite());
  for (const ModelledEffect &e : bank.effects)
    for (const auto &[off, on] : pairs_of(bank, e.name))
      has[std::size_t(on)] = has[std::size_t(on)] && has[std::size_t(off)];
  std::vector<int> out;
  for (std::size_t k = 0; k < has.size(); ++k)
    if (has[k])
      out.push_back(int(k));
  return out;
}

void check(const Bank &bank, const std::vector<int> &may_lack) {
  std::vector<bool> lacks(bank.observables.size(), false);
  for (const int k : may_lack)
    lacks[std::size_t(k)] = true;
  for (const Parameter &p : bank.base)
    check(p);
  Mistakes mistakes("bank of simulations", 10);
  for (const ModelledEffect &e : bank.effects) {
    bool amplitude = false;
    for (const Parameter &p : e.parameters) {
      check(p);
      amplitude |= p.amplitude;
    }
    if (!amplitude)
      mistakes.add(0, fmt::format("effect '{}' has no amplitude that switches it off", e.name));
  }
  for (int i = 0; i < int(bank.runs.size()); ++i)
    check_run(bank, i, lacks, mistakes);
  mistakes.stop_if_any();
  const auto count = [&](const std::string &effect) {
    return int(std::count_if(bank.runs.begin(), bank.runs.end(),
                             [&](const BankRun &r) { return r.effect == effect; }));
  };
  const int fewest = int(bank.base.size()) + kFewestRuns;
  if (count("") < fewest)
    mistakes.add(0, fmt::format("{} runs of the base model; at least {} for {} parameters",
                                count(""), fewest, bank.base.size()));
  for (const ModelledEffect &e : bank.effects) {
    const int pairs = int(pairs_of(bank, e.name).size());
    if (pairs < count(e.name))
      mistakes.add(0, fmt::format("effect '{}': {} of its {} runs have no base run of the same "
                                  "parameters and packing",
                                  e.name, count(e.name) - pairs, count(e.name)));
    if (pairs < kFewestRuns)
      mistakes.add(
          0, fmt::format("effect '{}': {} paired runs; at least {}", e.name, pairs, kFewestRuns));
  }
  mistakes.stop_if_any();
}

void add_measurement_fault(Bank &bank, const ModelledEffect &fault, const FaultAction &action) {
  const int parameters = int(fault.parameters.size());
  std::vector<int> base_runs;
  for (int i = 0; i < int(bank.runs.size()); ++i)
    if (bank.runs[i].effect.empty())
      base_runs.push_back(i);
  const Matrix points = sobol_points(parameters, int(base_runs.size()), 0);
  for (int k = 0; k < int(base_runs.size()); ++k) {
    BankRun shown = bank.runs[base_runs[k]];
    shown.effect = fault.name;
    shown.amplitudes.resize(parameters);
    for (int j = 0; j < parameters; ++j)
      shown.amplitudes[j] = fault.parameters[j].prior.value(normal_quantile(points(j, k)));
    shown.values = action(bank.observables, shown.values, shown.amplitudes);
    bank.runs.push_back(std::move(shown));
  }
  bank.effects.push_back(fault);
  bank.effects.back().computed = true;
}

namespace {

std::string column(const ModelledEffect &effect, const Parameter &parameter) {
  return effect.name + "." + parameter.name;
}

std::vector<std::string> number_columns(const Bank &bank) {
  std::vector<std::string> columns;
  for (const Parameter &p : bank.base)
    columns.push_back(p.name);
  for (const ModelledEffect &e : bank.effects)
    for (const Parameter &p : e.parameters)
      columns.push_back(column(e, p));
  for (const ObservableId &o : bank.observables)
    columns.push_back(key_of(o));
  return columns;
}

void check_columns(const Bank &bank, const CsvTable &table, Mistakes &mistakes) {
  for (const char *name : {"effect", "packing"})
    if (!table.has(name))
      mistakes.add(1, fmt::format("column '{}' is missing", name));
  for (const std::string &name : number_columns(bank))
    if (!table.has(name))
      mistakes.add(1, fmt::format("column '{}' is missing; make the bank again", name));
  if (const std::string wrong = table.ambiguous(); !wrong.empty())
    mistakes.add(1, "the table " + wrong);
  for (const int line : table.bad_lines())
    mistakes.add(line, fmt::format("not as many cells as the header's {}", table.header().size()));
}

} // namespace

std::string write_table(const Bank &bank) {
  std::string text = "effect,packing";
  for (const std::string &name : number_columns(bank))
    text += "," + name;
  text += "\n";
  for (const BankRun &r : bank.runs) {
    text += r.effect + "," + r.packing;
    for (const double v : r.base)
      text += fmt::format(",{:.17g}", v);
    for (const ModelledEffect &e : bank.effects)
      for (int j = 0; j < int(e.parameters.size()); ++j)
        text += e.name == r.effect ? fmt::format(",{:.17g}", r.amplitudes[j]) : ",";
    for (const double v : r.values)
      text += fmt::format(",{:.17g}", v);
    text += "\n";
  }
  return text;
}

void read_table(Bank &bank, const std::string &text, const std::string &file) {
  const CsvTable table = CsvTable::parse(text);
  Mistakes mistakes(file, 10);
  check_columns(bank, table, mistakes);
  mistakes.stop_if_any();
  const auto effects = table.texts("effect"), packings = table.texts("packing");
  bank.runs.assign(table.rows(), {});
  for (std::size_t i = 0; i < table.rows(); ++i) {
    bank.runs[i].effect = effects[i];
    bank.runs[i].packing = packings[i];
    bank.runs[i].base.resize(Eigen::Index(bank.base.size()));
    bank.runs[i].values.resize(Eigen::Index(bank.observables.size()));
  }
  const auto fill = [&](const std::string &name, const auto &place) {
    const auto numbers = table.numbers(name);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      place(bank.runs[i], numbers[i]);
  };
  for (std::size_t j = 0; j < bank.base.size(); ++j)
    fill(bank.base[j].name, [&](BankRun &r, double v) { r.base[Eigen::Index(j)] = v; });
  for (const ModelledEffect &e : bank.effects)
    for (std::size_t j = 0; j < e.parameters.size(); ++j)
      fill(column(e, e.parameters[j]), [&](BankRun &r, double v) {
        if (r.effect != e.name)
          return;
        r.amplitudes.conservativeResize(Eigen::Index(e.parameters.size()));
        r.amplitudes[Eigen::Index(j)] = v;
      });
  for (std::size_t j = 0; j < bank.observables.size(); ++j)
    fill(key_of(bank.observables[j]), [&](BankRun &r, double v) { r.values[Eigen::Index(j)] = v; });
}

} // namespace calendem::inference
