// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/csv_table.h"
#include "base/messages.h"
#include "diagnose/inference/bank.h"
#include <fmt/format.h>

namespace calendem::inference {
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
