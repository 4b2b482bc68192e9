// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/experiment_checks.h"
#include "base/csv_table.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace calendem {

void check_foil(const Experiment &e, const Condition &c, const std::string &who, int line,
                Mistakes &mistakes) {
  const bool on_thickness = c.thickness_after_um && c.thickness_after_um->includes_foil;
  const bool on_mass = c.mass_mg && c.mass_mg->includes_foil;
  std::vector<std::string> missing;
  if (c.mass_mg && e.sample_diameter_mm == 0.0)
    missing.push_back("sample_diameter_mm");
  if ((on_thickness || on_mass) && e.foil_thickness_um == 0.0)
    missing.push_back("foil_thickness_um");
  if (on_mass && e.foil_density_g_cm3 == 0.0)
    missing.push_back("foil_density_g_cm3");
  if (!missing.empty()) {
    mistakes.add(line, fmt::format("{} gives a mass, or a thickness with foil: [experiment] must "
                                   "have {}.",
                                   who, fmt::join(missing, ", ")));
    return;
  }
  if (on_thickness && coating_thickness_um(e, *c.thickness_after_um) <= 0.0)
    mistakes.add(line, fmt::format("{}: thickness_after_um = {} includes a foil of {} um: nothing "
                                   "is left for the coating.",
                                   who, c.thickness_after_um->value, e.foil_thickness_um));
  if (on_mass && coating_loading_mg_cm2(e, *c.mass_mg) <= 0.0)
    mistakes.add(line, fmt::format("{}: mass_mg = {} is less than that of the foil ({:.2f} mg).",
                                   who, c.mass_mg->value, foil_mg_cm2(e) * sample_area_cm2(e)));
}

namespace {

/// Columns and numbers; false if the rest cannot be checked.
bool check_columns(const std::string &path, const CsvTable &table, int line, Mistakes &mistakes) {
  const int before = mistakes.count();
  const std::string first = fmt::format("{}", fmt::join(table.header(), ","));
  if (!table.has("displacement_um") && first.find_first_of(";\t") != std::string::npos) {
    mistakes.add(line, fmt::format("'{}': its first line is '{}'. Columns are separated by commas, "
                                   "decimals by points: save it as CSV with these.",
                                   path, first));
    return false;
  }
  for (const char *column : {"displacement_um", "pressure_MPa"}) {
    if (!table.has(column)) {
      mistakes.add(
          line, fmt::format("'{}' has no column '{}' in its first line: {}", path, column, first));
      continue;
    }
    const std::vector<double> values = table.numbers(column);
    const auto wrong =
        std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (wrong != values.end())
      mistakes.add(line, fmt::format("'{}': {} of row {} is no finite number. Correct the row or "
                                     "take it out.",
                                     path, column, wrong - values.begin() + 1));
  }
  if (!table.bad_lines().empty())
    mistakes.add(line, fmt::format("'{}': line {} has another number of columns than the first "
                                   "line. Correct the line, or copy the file again if it is cut.",
                                   path, table.bad_lines().front()));
  if (table.rows() < 2)
    mistakes.add(line, fmt::format("'{}' has {} rows below its first line; a curve has at least 2.",
                                   path, table.rows()));
  return mistakes.count() == before;
}

void check_stages(const std::string &path, const CsvTable &table, int line, Mistakes &mistakes) {
  const std::vector<std::string> known = {"loading",   "compression", "dwell",
                                          "unloading", "relaxation",  "hold"};
  const std::vector<std::string> stages = table.texts("stage");
  const auto wrong = std::find_if(stages.begin(), stages.end(), [&](const std::string &s) {
    return std::find(known.begin(), known.end(), s) == known.end();
  });
  const bool loads = std::any_of(stages.begin(), stages.end(), [](const std::string &s) {
    return s == "loading" || s == "compression";
  });
  if (wrong != stages.end())
    mistakes.add(line, fmt::format("'{}': stage of row {} is '{}'; allowed are {}.", path,
                                   wrong - stages.begin() + 1, *wrong, fmt::join(known, ", ")));
  else if (!stages.empty() && !loads)
    mistakes.add(
        line, fmt::format("'{}': no row has the stage loading: only loading is compared.", path));
}

/// A curve in another unit is off by a power of ten: far beyond what the rest of the file allows.
void check_units(const std::string &path, const CsvTable &table, const Experiment &e,
                 const Condition &c, int line, Mistakes &mistakes) {
  constexpr double kOff = 3.0;        // factor between the curve's largest pressure and the stated
  constexpr double kLeastWay = 0.005; // of the film's thickness
  const auto largest = [&](const char *column) {
    const std::vector<double> v = table.numbers(column);
    return *std::max_element(v.begin(), v.end());
  };
  const double p = largest("pressure_MPa"), d = largest("displacement_um");
  if (c.max_pressure_MPa &&
      (p > kOff * c.max_pressure_MPa->value || p * kOff < c.max_pressure_MPa->value))
    mistakes.add(line, fmt::format("'{}': pressure_MPa goes to {:g}, max_pressure_MPa is {:g}. Is "
                                   "the column in MPa, and the curve this condition's?",
                                   path, p, c.max_pressure_MPa->value));
  if (e.recipe.file.empty()) // it has mistakes of its own
    return;
  const double film = e.recipe.thickness();
  if (d >= film || d < kLeastWay * film)
    mistakes.add(line,
                 fmt::format("'{}': displacement_um goes to {:g}; the film of the recipe is "
                             "{:.1f} um thick. Is the column in um, counted from first touch?",
                             path, d, film));
}

} // namespace

void check_curve(const Experiment &e, const Condition &c, int line, Mistakes &mistakes) {
  std::ifstream in(c.curve, std::ios::binary);
  const auto table =
      CsvTable::parse({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
  if (!check_columns(c.curve, table, line, mistakes))
    return;
  check_stages(c.curve, table, line, mistakes);
  check_units(c.curve, table, e, c, line, mistakes);
}

} // namespace calendem
