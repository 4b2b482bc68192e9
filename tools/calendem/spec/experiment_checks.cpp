// SPDX-License-Identifier: GPL-2.0-or-later
#include "spec/experiment_checks.h"
#include "spec/csv_table.h"
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

void check_curve(const std::string &path, int line, Mistakes &mistakes) {
  std::ifstream in(path, std::ios::binary);
  const auto table =
      CsvTable::parse({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
  for (const char *column : {"displacement_um", "pressure_MPa"}) {
    if (!table.has(column)) {
      mistakes.add(line, fmt::format("'{}' has no column '{}' in its first line: {}", path, column,
                                     fmt::join(table.header(), ",")));
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
}

} // namespace calendem
