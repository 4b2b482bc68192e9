// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/shown.h"
#include "effects/effects.h"
#include "report/plots.h"
#include "report/study_page.h"
#include "report/tables.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
using report::Chart;
using report::Series;
using report::Symbol;
namespace {

const char *const kMaxPressure = "case.platen.max_pressure_MPa";
constexpr std::array kDashes = {"", "9 4", "3 3", "9 3 2 3"};

/// The look of the k-th series of a chart.
Series styled(std::size_t k, const std::string &name) {
  Series s;
  s.name = name;
  s.colour = report::kSeriesColours[k % report::kSeriesColours.size()];
  s.symbol = report::kSeriesSymbols[k % report::kSeriesSymbols.size()];
  s.dash = kDashes[k % kDashes.size()];
  return s;
}

void add(Series &series, double x, const MeanAndSd &y, double factor) {
  if (!std::isfinite(x) || y.n == 0)
    return;
  series.x.push_back(x);
  series.y.push_back(factor * y.mean);
  series.y_error.push_back(factor * y.sd);
}

/// Like the paper's Figure 4a: a point for every maximum pressure, a line for all other settings.
Chart porosity_chart(const StudyTable &table) {
  Chart chart{"porosity", "Porosity after relaxation against maximum pressure",
              "Maximum pressure (MPa)", "Total porosity after relaxation (%)"};
  std::size_t k = 0;
  for (const StudyGroup &line : table.groups({kMaxPressure})) {
    std::map<double, std::vector<double>> by_pressure;
    const std::vector<double> top = table.numbers(line, "max_pressure_MPa"),
                              after = table.numbers(line, "porosity_after_relaxation");
    for (std::size_t i = 0; i < top.size(); ++i)
      by_pressure[std::round(top[i])].push_back(after[i]);
    const std::string label = StudyTable::label(line);
    Series s = styled(k++, label.empty() ? "simulation" : label);
    for (const auto &[pressure, values] : by_pressure)
      add(s, pressure, mean_and_sd(values), 100.0);
    chart.series.push_back(s);
  }
  chart.note = "Mean and standard deviation over packings.";
  if (table.of_paper()) {
    chart.series.push_back(report::porosity_of_paper("measured (paper, Table 1)"));
    chart.note += " The porosity at 0 MPa is an input from the recipe. The measured pressures are "
                  "uncertain by 10–25 %.";
  }
  return chart;
}

/// Breaks of the paper's Figure 4b, against pressure.
Chart broken_chart(const StudyTable &table) {
  Chart chart{"broken", "Broken bonds against pressure", "Pressure on the platen (MPa)",
              "Broken bonds (% of initial)"};
  const std::vector<double> pressures = table.pressures("broken_fraction");
  if (pressures.empty())
    return chart;
  std::size_t k = 0;
  for (const StudyGroup &group : table.groups()) {
    const std::string label = StudyTable::label(group);
    Series s = styled(k++, label.empty() ? "simulation" : label);
    for (const double p : pressures)
      add(s, p, table.mean_and_sd(group, fmt::format("broken_fraction_at_{:g}_MPa", p)), 100.0);
    chart.series.push_back(s);
  }
  if (table.of_paper())
    chart.series.push_back(report::breaks_of_paper("paper (simulation)"));
  chart.note =
      "Where compression first reaches the pressure; mean and standard deviation over packings.";
  return chart;
}

Series curve_series(Series s, const CsvTable &curve, const char *column, double factor) {
  s.x = curve.numbers("displacement_um");
  s.y = curve.numbers(column);
  for (double &y : s.y)
    y *= factor;
  s.symbol = Symbol::none;
  return s;
}

/// The paper's Figure 4b of the first packing of each setting.
Chart curve_chart(const StudyTable &table, const CurveOfRun &curve_of) {
  Chart chart{"curves", "Pressure and broken bonds against displacement",
              "Displacement of the platen (µm)", "Pressure on the platen (MPa)",
              "Broken bonds (% of initial)"};
  const std::vector<StudyGroup> groups = table.groups();
  for (std::size_t k = 0;
       k < groups.size() && chart.series.size() < 2 * report::kSeriesColours.size(); ++k) {
    const CsvTable curve = curve_of(table.texts(groups[k], "run").front());
    if (curve.rows() == 0)
      continue;
    const std::string label = StudyTable::label(groups[k]);
    Series s = styled(k, (label.empty() ? "" : label + ": ") + "pressure");
    s.dash.clear();
    chart.series.push_back(curve_series(s, curve, "pressure_MPa", 1.0));
    s.name = "broken (right)";
    s.dash = "2 3";
    s.right_axis = true;
    chart.series.push_back(curve_series(s, curve, "broken_fraction", 100.0));
  }
  chart.note = fmt::format("First packing of each setting; {} of {} settings are drawn.",
                           chart.series.size() / 2, groups.size());
  return chart;
}

/// Whether the value switches off an effect that acts the more the smaller its key is: such a value has no
/// place on the key's axis.
bool is_off_the_axis(const std::string &setting, double value) {
  const std::string key = setting.substr(setting.find('.') + 1);
  return std::any_of(effects().begin(), effects().end(), [&](const Effect &e) {
    const EffectParameter &p = e.parameter;
    return p.scale == AmplitudeScale::Reciprocal && value == std::stod(p.off) &&
           std::find(p.keys.begin(), p.keys.end(), key) != p.keys.end();
  });
}

/// One result against one setting; a line for every combination of the others. Where the setting is off
/// a level says what the result is.
Chart against(const StudyTable &table, const std::string &setting, const std::string &result,
              const std::string &title, double factor) {
  const std::string words = setting_in_words(setting);
  Chart chart{setting + "-" + result,
              fmt::format("{} against {}", title.substr(0, title.rfind(" (")),
                          words.substr(0, words.rfind(" ("))),
              words, title};
  std::size_t k = 0;
  for (const StudyGroup &line : table.groups({setting})) {
    std::map<double, std::vector<double>> by_value;
    const std::vector<double> x = table.numbers(line, setting), y = table.numbers(line, result);
    for (std::size_t i = 0; i < x.size(); ++i)
      by_value[x[i]].push_back(y[i]);
    Series s = styled(k++, StudyTable::label(line));
    for (const auto &[value, values] : by_value) {
      const MeanAndSd y = mean_and_sd(values);
      if (!is_off_the_axis(setting, value))
        add(s, value, y, factor);
      else if (y.n > 0)
        chart.limits.push_back({factor * y.mean, s.name.empty() ? "off" : "off, " + s.name});
    }
    chart.series.push_back(s);
  }
  return chart;
}

/// Some value differs from zero.
bool shows_anything(const Chart &chart) {
  return std::any_of(chart.series.begin(), chart.series.end(), [](const Series &s) {
    return std::any_of(s.y.begin(), s.y.end(), [](double y) { return y != 0.0; });
  });
}

std::vector<Chart> charts_of_setting(const StudyTable &table, const std::string &setting) {
  std::vector<Chart> out;
  const auto published =
      table.of_paper() ? report::paper_breaks() : std::vector<report::PublishedBreaks>();
  for (const double p : table.pressures("broken_fraction")) {
    Chart chart = against(table, setting, fmt::format("broken_fraction_at_{:g}_MPa", p),
                          fmt::format("Broken bonds at {:g} MPa (%)", p), 100.0);
    for (const report::PublishedBreaks &b : published)
      if (std::fabs(b.pressure_MPa - p) < 0.5)
        chart.limits.push_back({b.broken_percent, "paper"});
    if (shows_anything(chart))
      out.push_back(chart);
  }
  if (setting != kMaxPressure)
    out.push_back(against(table, setting, "porosity_after_relaxation",
                          "Total porosity after relaxation (%)", 100.0));
  out.push_back(against(table, setting, "springback", "Springback (%)", 100.0));
  return out;
}

} // namespace

std::string setting_in_words(const std::string &key) {
  std::string path = key.substr(key.find('.') + 1);
  if (path.rfind("effects.", 0) == 0)
    path.erase(0, 8);
  auto [name, unit] = in_words(path);
  std::replace(name.begin(), name.end(), '.', ' ');
  return unit.empty() ? name : fmt::format("{} ({})", name, unit.substr(1));
}

std::vector<Chart> study_charts(const StudyTable &table, const CurveOfRun &curve) {
  std::vector<Chart> out = {porosity_chart(table), broken_chart(table), curve_chart(table, curve)};
  for (const std::string &setting : table.numeric_settings())
    for (const Chart &chart : charts_of_setting(table, setting))
      out.push_back(chart);
  out.erase(std::remove_if(out.begin(), out.end(), [](const Chart &c) { return c.series.empty(); }),
            out.end());
  return out;
}

} // namespace calendem
