// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/study_page.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "report/page.h"
#include "report/tables.h"
#include "simulate/collect.h"
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
extern const char *const kStudyHtml;
namespace {

std::string shown(const MeanAndSd &s, double factor, const char *format) {
  if (s.n == 0)
    return "–";
  const std::string mean = fmt::format(fmt::runtime(format), factor * s.mean);
  return s.n < 2 ? mean
                 : fmt::format("{} ± {}", mean, fmt::format(fmt::runtime(format), factor * s.sd));
}

/// Measured porosity less simulated, where the run's maximum is one of Table 1's.
std::string porosity_distance(const StudyTable &table, const StudyGroup &group) {
  const MeanAndSd top = table.mean_and_sd(group, "max_pressure_MPa"),
                  after = table.mean_and_sd(group, "porosity_after_relaxation");
  for (const report::MeasuredPorosity &p : report::paper_porosity())
    if (p.pressure_MPa > 0.0 && std::fabs(top.mean - p.pressure_MPa) < 0.02 * p.pressure_MPa)
      return fmt::format("{:+.1f}", 100.0 * after.mean - p.porosity_percent);
  return "–";
}

nlohmann::json row_of(const StudyTable &table, const StudyGroup &group) {
  nlohmann::json cells = nlohmann::json::array();
  for (const std::string &column : table.settings())
    cells.push_back(group.settings.at(column));
  cells.push_back(fmt::format("{}", group.rows.size()));
  cells.push_back(shown(table.mean_and_sd(group, "max_pressure_MPa"), 1.0, "{:.1f}"));
  for (const double p : table.pressures("broken_fraction"))
    cells.push_back(shown(table.mean_and_sd(group, fmt::format("broken_fraction_at_{:g}_MPa", p)),
                          100.0, "{:.1f}"));
  const double far = distance_to_paper(table, group);
  cells.push_back(std::isfinite(far) ? fmt::format("{:.1f}", far) : "–");
  cells.push_back(shown(table.mean_and_sd(group, "porosity_at_max"), 100.0, "{:.1f}"));
  cells.push_back(shown(table.mean_and_sd(group, "porosity_after_relaxation"), 100.0, "{:.1f}"));
  cells.push_back(porosity_distance(table, group));
  cells.push_back(shown(table.mean_and_sd(group, "springback"), 100.0, "{:.1f}"));
  const MeanAndSd difference = table.mean_and_sd(group, "pressure_difference_max_above_5_MPa");
  cells.push_back(shown(difference, 100.0, "{:.1f}") +
                  (difference.mean > kQuasiStatic ? " !" : ""));
  return {{"cells", cells}};
}

nlohmann::json head(const StudyTable &table) {
  nlohmann::json out = nlohmann::json::array();
  for (const std::string &column : table.settings())
    out.push_back(setting_in_words(column));
  out.push_back("packings");
  out.push_back("maximum pressure (MPa)");
  for (const double p : table.pressures("broken_fraction"))
    out.push_back(fmt::format("broken at {:g} MPa (%)", p));
  for (const char *name : {"broken: distance to paper (points)", "porosity at maximum (%)",
                           "porosity after relaxation (%)", "minus Table 1 (points)",
                           "springback (%)", "pressures differ by (%)"})
    out.push_back(name);
  return out;
}

} // namespace

double distance_to_paper(const StudyTable &table, const StudyGroup &group) {
  double sum = 0.0;
  int n = 0;
  for (const double p : table.pressures("broken_fraction"))
    for (const report::PublishedBreaks &b : report::paper_breaks())
      if (std::fabs(b.pressure_MPa - p) < 0.5) {
        const MeanAndSd s = table.mean_and_sd(group, fmt::format("broken_fraction_at_{:g}_MPa", p));
        sum += std::pow(100.0 * s.mean - b.broken_percent, 2);
        ++n;
      }
  return n > 0 ? std::sqrt(sum / n) : std::nan("");
}

std::string study_page(const StudyTable &table, const std::vector<report::Chart> &charts,
                       const nlohmann::json &description) {
  report::Page page{kStudyHtml, description, {}, charts};
  nlohmann::json rows = nlohmann::json::array();
  for (const StudyGroup &group : table.groups())
    rows.push_back(row_of(table, group));
  page.json["finished"] = table.finished();
  page.json["table"] = {{"head", head(table)}, {"rows", rows}};
  page.values = {{"provenance_rows", report::facts_of(description["provenance"], {})}};
  return report::to_html(page);
}

void draw_study(const std::vector<std::string> &columns, const std::string &folder) {
  if (!std::filesystem::exists(folder + "/study.csv"))
    throw Failure(kBadInput,
                  fmt::format("{} holds no study.csv. Make it with calendem study.", folder));
  const nlohmann::json description =
      nlohmann::json::parse(text_of_file(folder + "/study.json"), nullptr, false);
  if (!description.is_object() || !description.contains("provenance"))
    throw Failure(kBadInput, fmt::format("{}/study.json is missing or damaged. Make it again with "
                                         "calendem study ... --table.",
                                         folder));
  const StudyTable table(CsvTable::parse(text_of_file(folder + "/study.csv")), columns);
  const auto curve = [&](const std::string &run) {
    return RunFolder(folder + "/runs/" + run).table("curve.csv");
  };
  write_file(folder + "/study.html", study_page(table, study_charts(table, curve), description));
  fmt::print("page: {}/study.html\n", folder);
}

} // namespace calendem
