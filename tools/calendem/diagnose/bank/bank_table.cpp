// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/bank/bank_table.h"
#include "base/csv_table.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "physics/press_instruments.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>

namespace calendem {
namespace {

constexpr int kFirstEnd = 180; // MPa: where the grid ended in an earlier table

/// Pressures at which displacements are kept [MPa]. Thin films yield in steps; a straight line
/// between two pressures misses what lies between them by 0.02 um (root mean square over 141 films
/// of the shipped bank's base points) up to 80 MPa, and by 0.01 and 0.02 um in the coarser steps
/// above; steps of 20 MPa miss 0.19, 0.10 and 0.06 um. A measured curve is good to about 0.02 um,
/// and the diagnosis compares two curves of one film.
std::vector<double> grid() {
  std::vector<double> pressures;
  for (int p = 1; p <= 80; ++p)
    pressures.push_back(p);
  for (int p = 82; p <= kFirstEnd; p += 2)
    pressures.push_back(p);
  for (int p = kFirstEnd + 5; p <= 360; p += 5)
    pressures.push_back(p);
  return pressures;
}

/// Shares of the largest pressure at which the release is kept.
std::vector<double> released() {
  std::vector<double> shares;
  for (int percent = 5; percent < 100; percent += 5)
    shares.push_back(0.01 * percent);
  return shares;
}

constexpr int kMostCounted = 10000; // base points that a bank may have

struct Number {
  const char *column;
  double SimulatedRun::*field;
};
constexpr Number kNumbers[] = {{"target_MPa", &SimulatedRun::target},
                               {"max_pressure_MPa", &SimulatedRun::max_pressure},
                               {"thickness_at_max_um", &SimulatedRun::thickness_at_max},
                               {"thickness_after_um", &SimulatedRun::thickness_after},
                               {"porosity_initial", &SimulatedRun::porosity_initial},
                               {"porosity_at_max", &SimulatedRun::porosity_at_max},
                               {"porosity_after", &SimulatedRun::porosity_after},
                               {"solid_column_um", &SimulatedRun::solid_column},
                               {"cracked_fraction", &SimulatedRun::cracked_fraction},
                               {"porosity_slope_per_MPa", &SimulatedRun::porosity_slope}};

/// Cells of these may be empty; a table whose runs all lack one does not have its column.
constexpr Number kMoreNumbers[] = {{"broken_fraction", &SimulatedRun::broken_fraction},
                                   {"inverse_tortuosity", &SimulatedRun::inverse_tortuosity},
                                   {"cbd_nanoporosity_after", &SimulatedRun::cbd_nanoporosity},
                                   {"pressure_left", &SimulatedRun::pressure_left}};

std::string cell(double v) { return std::isfinite(v) ? fmt::format("{:.8g}", v) : ""; }
/// Nanometres to which displacements are kept: a measured curve is good to about 20, and the slope
/// of a release is read from differences.
constexpr int kCurve = 10, kRelease = 1;

/// A displacement v [um] to `nanometres`.
std::string rounded(double v, int nanometres) {
  return cell(0.001 * nanometres * std::round(v / (0.001 * nanometres)));
}
std::string grid_column(double pressure) {
  return fmt::format("displacement_um_at_{:g}_MPa", pressure);
}

std::string release_column(double share) {
  return fmt::format("displacement_um_released_to_{:g}_percent", 100.0 * share);
}

/// Columns that hold a number in every row.
std::vector<std::string> due_columns(const BankSpec &spec) {
  std::vector<std::string> due = {"base_point", "packing"};
  for (const BankParameter &p : spec.parameters)
    due.push_back(p.name);
  for (const Number &n : kNumbers)
    due.push_back(n.column);
  return due;
}

using Columns = std::map<std::string, std::vector<double>>;

BankRow row_at(const BankSpec &spec, const Columns &t, std::size_t k, const std::string &effect) {
  BankRow row;
  const auto number = [&](const std::string &column) { return t.at(column)[k]; };
  row.point.effect = effect;
  row.point.base_point = int(number("base_point"));
  row.point.packing = int(number("packing"));
  for (const BankParameter &p : spec.parameters)
    row.point.base.push_back(number(p.name));
  const bool base = effect.empty() || effect == kFullCell;
  row.point.value = base ? 0.0 : number("value");
  row.run.control = "pressure";
  for (const Number &n : kNumbers)
    row.run.*(n.field) = number(n.column);
  for (const Number &n : kMoreNumbers)
    row.run.*(n.field) = number(n.column);
  for (const double p : grid())
    if (const double d = number(grid_column(p)); std::isfinite(d)) {
      row.run.pressure.push_back(p);
      row.run.displacement.push_back(d);
    }
  for (const double share : released())
    if (const double d = number(release_column(share)); std::isfinite(d)) {
      row.run.release_pressure.push_back(share * row.run.target);
      row.run.release_displacement.push_back(d);
    }
  return row;
}

/// How each row is pressed, which must be one of the bank's.
std::vector<std::string> pressings_of(const BankSpec &spec, const CsvTable &t, Mistakes &mistakes) {
  if (!t.has("pressing"))
    return std::vector<std::string>(t.rows());
  std::vector<std::string> out = t.texts("pressing");
  for (std::size_t k = 0; k < out.size(); ++k)
    if (!out[k].empty() && !find_pressing(spec, out[k]))
      mistakes.add(t.line_of(k), fmt::format("pressing '{}' is no [[pressing]] of {}. Is this its "
                                             "table?",
                                             out[k], spec.file));
  return out;
}

/// What row k must hold: numbers in the columns `due`, points and packings that can be counted, an
/// effect that is known.
void check_row(const Columns &t, std::size_t k, int line, const std::string &effect,
               const std::vector<std::string> &due, Mistakes &mistakes) {
  for (const std::string &column : due)
    if (!std::isfinite(t.at(column)[k]))
      mistakes.add(line, fmt::format("'{}' is no number.", column));
  const bool on = !effect.empty() && effect != kFullCell;
  if (on && !std::isfinite(t.at("value")[k]))
    mistakes.add(line, "'value' is no number; it is the effect's.");
  for (const auto &[column, lowest] : {std::pair("base_point", 0), std::pair("packing", 1)})
    if (const double v = t.at(column)[k];
        std::isfinite(v) && (v != std::floor(v) || v < lowest || v > kMostCounted))
      mistakes.add(line, fmt::format("'{}' is {}; it is a whole number from {} to {}.", column, v,
                                     lowest, kMostCounted));
  try {
    if (on)
      find_effect(effect);
  } catch (const Failure &e) {
    mistakes.add(line, e.what());
  }
}

} // namespace

std::string write_bank_table(const BankTable &table) {
  std::vector<Number> more;
  for (const Number &n : kMoreNumbers)
    if (std::any_of(table.rows.begin(), table.rows.end(),
                    [&](const BankRow &row) { return std::isfinite(row.run.*(n.field)); }))
      more.push_back(n);
  const bool pressings = std::any_of(table.rows.begin(), table.rows.end(),
                                     [](const BankRow &row) { return !row.run.pressing.empty(); });
  std::string out = pressings ? "effect,base_point,packing,pressing" : "effect,base_point,packing";
  for (const BankParameter &p : table.spec.parameters)
    out += "," + p.name;
  out += ",value";
  for (const Number &n : kNumbers)
    out += std::string(",") + n.column;
  for (const Number &n : more)
    out += std::string(",") + n.column;
  for (const double p : grid())
    out += "," + grid_column(p);
  for (const double share : released())
    out += "," + release_column(share);
  out += "\n";
  for (const BankRow &row : table.rows) {
    out += fmt::format("{},{},{}", row.point.effect, row.point.base_point, row.point.packing);
    if (pressings)
      out += "," + row.run.pressing;
    for (const double v : row.point.base)
      out += "," + cell(v);
    const bool base = row.point.effect.empty() || row.point.effect == kFullCell;
    out += "," + (base ? "" : cell(row.point.value));
    for (const Number &n : kNumbers)
      out += "," + cell(row.run.*(n.field));
    for (const Number &n : more)
      out += "," + cell(row.run.*(n.field));
    for (const double p : grid())
      out += "," + rounded(displacement_at(row.run.pressure, row.run.displacement, p), kCurve);
    for (const double share : released())
      out += "," + rounded(displacement_at(row.run.release_pressure, row.run.release_displacement,
                                           share * row.run.target),
                           kRelease);
    out += "\n";
  }
  return out;
}

namespace {

std::vector<BankRow> rows_of(const BankSpec &spec, const std::string &file) {
  Mistakes mistakes(file, 10);
  const bool there = std::filesystem::is_regular_file(file);
  if (!there)
    mistakes.add(0, fmt::format("no such file. Make it with calendem bank {} -o DIR; it is then "
                                "DIR/bank.csv.",
                                spec.file));
  const CsvTable t = CsvTable::parse(there ? text_of_file(file) : "");
  const std::vector<std::string> due = due_columns(spec);
  std::vector<std::string> wanted = due;
  wanted.insert(wanted.end(), {"effect", "value"});
  for (const double p : grid())
    if (p <= kFirstEnd)
      wanted.push_back(grid_column(p));
  for (const std::string &column : wanted)
    if (there && !t.has(column))
      mistakes.add(
          0, fmt::format("column '{}' is missing. Is this the table of {}?", column, spec.file));
  if (const std::string wrong = t.ambiguous(); !wrong.empty())
    mistakes.add(0, "the table " + wrong);
  for (const int line : t.bad_lines())
    mistakes.add(line, "the row has another number of cells than the header.");
  mistakes.stop_if_any();
  Columns numbers;
  for (const std::string &column : wanted)
    numbers[column] = t.numbers(column);
  const auto if_there = [&](const std::string &column) {
    numbers[column] =
        t.has(column) ? t.numbers(column) : std::vector<double>(t.rows(), std::nan(""));
  };
  for (const Number &n : kMoreNumbers)
    if_there(n.column);
  for (const double p : grid())
    if (p > kFirstEnd)
      if_there(grid_column(p));
  for (const double share : released())
    if_there(release_column(share));
  const std::vector<std::string> effect = t.texts("effect");
  for (std::size_t k = 0; k < t.rows(); ++k)
    check_row(numbers, k, t.line_of(k), effect[k], due, mistakes);
  const std::vector<std::string> pressing = pressings_of(spec, t, mistakes);
  mistakes.stop_if_any();
  std::vector<BankRow> out;
  for (std::size_t k = 0; k < t.rows(); ++k) {
    out.push_back(row_at(spec, numbers, k, effect[k]));
    out.back().run.pressing = pressing[k];
  }
  return out;
}

} // namespace

BankTable read_bank_table(const BankSpec &spec, const std::string &file) {
  BankTable out = {spec, rows_of(spec, file)};
  std::error_code none;
  if (!spec.further_table.empty() && std::filesystem::equivalent(file, table_of(spec), none))
    for (const BankRow &row : rows_of(spec, spec.further_table))
      out.rows.push_back(row);
  return out;
}

bool has_release(const BankTable &table) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [](const BankRow &row) { return !row.run.release_pressure.empty(); });
}

SimulatedRun shown_with(const Effect &effect, double value, const SimulatedRun &run) {
  PressInstruments press; // MPa, um
  if (effect.shown)
    press.*effect.shown = value;
  SimulatedRun out = run;
  out.thickness_at_max = press.thickness_shown(run.thickness_at_max);
  out.thickness_after = press.thickness_shown(run.thickness_after);
  const double before = run.solid_column / (1.0 - run.porosity_initial);
  out.porosity_initial = 1.0 - run.solid_column / press.thickness_shown(before);
  out.porosity_after = 1.0 - run.solid_column / out.thickness_after;
  for (std::size_t k = 0; k < run.pressure.size(); ++k)
    out.displacement[k] = press.displacement_shown(run.displacement[k], run.pressure[k]);
  for (std::size_t k = 0; k < run.release_pressure.size(); ++k)
    out.release_displacement[k] =
        press.displacement_shown(run.release_displacement[k], run.release_pressure[k]);
  return out;
}

namespace {

/// Adds to `displacement`, at `pressures`, what curves of `pairs` differ by on average.
void add_mean_change(const std::vector<double> &pressures,
                     const std::vector<std::pair<SimulatedRun, SimulatedRun>> &pairs,
                     std::vector<double> SimulatedRun::*pressure,
                     std::vector<double> SimulatedRun::*displacement, std::vector<double> &out) {
  const auto at = [&](const SimulatedRun &run, double p) {
    return displacement_at(run.*pressure, run.*displacement, p);
  };
  double last = 0.0;
  for (std::size_t k = 0; k < pressures.size(); ++k) {
    double change = 0.0;
    for (const auto &[first, second] : pairs)
      change += (at(second, pressures[k]) - at(first, pressures[k])) / double(pairs.size());
    if (std::isfinite(change))
      last = change;
    out[k] += last;
  }
}

} // namespace

SimulatedRun with_mean_change(const SimulatedRun &run,
                              const std::vector<std::pair<SimulatedRun, SimulatedRun>> &pairs) {
  SimulatedRun out = run;
  if (pairs.empty())
    return out;
  for (const Number &n : kNumbers)
    for (const auto &[first, second] : pairs)
      out.*(n.field) += (second.*(n.field) - first.*(n.field)) / double(pairs.size());
  out.target = run.target;
  out.max_pressure = run.max_pressure;
  add_mean_change(run.pressure, pairs, &SimulatedRun::pressure, &SimulatedRun::displacement,
                  out.displacement);
  add_mean_change(run.release_pressure, pairs, &SimulatedRun::release_pressure,
                  &SimulatedRun::release_displacement, out.release_displacement);
  return out;
}

SimulatedRun between_runs(const SimulatedRun &lower, const SimulatedRun &upper, double pressure) {
  const auto share_in = [&](double (*of)(double)) {
    return (of(pressure) - of(lower.target)) / (of(upper.target) - of(lower.target));
  };
  const double share = share_in([](double p) { return std::log(p); });
  SimulatedRun out = upper;
  for (const Number &n : kNumbers)
    out.*(n.field) = lower.*(n.field) + share * (upper.*(n.field) - lower.*(n.field));
  for (const Number &n : kMoreNumbers)
    out.*(n.field) = lower.*(n.field) + share * (upper.*(n.field) - lower.*(n.field));
  for (std::size_t k = 0; k < upper.release_pressure.size(); ++k) {
    const double of_largest = upper.release_pressure[k] / upper.target;
    const double below = displacement_at(lower.release_pressure, lower.release_displacement,
                                         of_largest * lower.target);
    out.release_pressure[k] = of_largest * pressure;
    out.release_displacement[k] = below + share * (upper.release_displacement[k] - below);
  }
  const double of_pressure = share_in([](double p) { return p; });
  out.target = pressure;
  out.max_pressure = lower.max_pressure + of_pressure * (upper.max_pressure - lower.max_pressure);
  return out;
}

BetweenRuns error_between_runs(double lower, double upper, double pressure) {
  const double along = std::log(pressure / lower) * std::log(upper / pressure);
  return {0.007 * along, 0.02 * along, 0.12 * along};
}

} // namespace calendem
