// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/paper_reference.h"

#include "base/csv_table.h"
#include "report/embedded.h"

namespace calendem::report {

std::vector<MeasuredPorosity> paper_porosity() {
  const CsvTable table = CsvTable::parse(embedded::kTable1);
  const auto pressure = table.numbers("pressure_MPa");
  const auto porosity = table.numbers("porosity_percent");
  const auto sd = table.numbers("porosity_sd_percent");
  std::vector<MeasuredPorosity> points;
  for (std::size_t i = 0; i < pressure.size(); ++i)
    points.push_back({pressure[i], porosity[i], sd[i]});
  return points;
}

std::vector<PublishedBreaks> paper_breaks() {
  const CsvTable table = CsvTable::parse(embedded::kPaperBonds);
  const auto pressure = table.numbers("pressure_MPa");
  const auto broken = table.numbers("broken_percent");
  std::vector<PublishedBreaks> points;
  for (std::size_t i = 0; i < pressure.size(); ++i)
    points.push_back({pressure[i], broken[i]});
  return points;
}

} // namespace calendem::report
