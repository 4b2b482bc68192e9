// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank/runs.h"
#include "base/csv_table.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "base/shown.h"
#include <fmt/format.h>

namespace calendem::bank {
namespace {

constexpr double kHighest = 400.0, kRatio = 1.1; // MPa, and between pressures of a curve

struct Number {
  const char *column;
  double PressedFilm::*field;
  const char *in_summary; ///< of "presses"; null: found elsewhere
};
constexpr Number kNumbers[] = {
    {"pressure_MPa", &PressedFilm::pressure, "pressure_MPa"},
    {"thickness_at_max_um", &PressedFilm::thickness_at_max, "thickness_loaded_um"},
    {"thickness_after_um", &PressedFilm::thickness_after, "thickness_released_um"},
    {"porosity_at_max", &PressedFilm::porosity_at_max, "porosity_loaded"},
    {"porosity_after", &PressedFilm::porosity_after, "porosity_released"},
    {"cracked_fraction", &PressedFilm::cracked, "cracked_fraction"},
    {"broken_fraction", &PressedFilm::broken, "broken_fraction"},
    {"cbd_nanoporosity_after", &PressedFilm::cbd_nanoporosity, "cbd_nanoporosity"},
    {"inverse_tortuosity", &PressedFilm::inverse_tortuosity, nullptr}};

std::string cell(double v, const char *form = "{:.6g}") {
  return std::isfinite(v) ? fmt::format(fmt::runtime(form), v) : "";
}

std::string curve_column(double pressure) { return fmt::format("um_at_{:.4g}_MPa", pressure); }
std::string release_column(double share) { return fmt::format("um_released_to_{:g}", share); }

/// Displacement where the pressure falls to `pressure`, linear between rows; NaN: it does not.
double released_to(const Curve &c, const Press &press, double pressure) {
  const Column &p = c["pressure_shown_MPa"], &d = c["displacement_shown_um"];
  for (std::size_t k = press.top + 1; k <= press.last; ++k)
    if (c.stage[k] == "relaxation" && p[k] <= pressure && p[k - 1] > pressure)
      return d[k - 1] + (d[k] - d[k - 1]) * (p[k - 1] - pressure) / (p[k - 1] - p[k]);
  return NAN;
}

/// Displacement where the pressure first rises to each of the curve's.
std::vector<double> loading_of(const Curve &c) {
  std::vector<double> out(curve_pressures().size(), NAN);
  const Column &p = c["pressure_shown_MPa"], &d = c["displacement_shown_um"];
  std::size_t next = 0;
  for (std::size_t k = 1; k < c.rows(); ++k)
    for (; next < out.size() && c.stage[k] == "compression" && p[k] >= curve_pressures()[next];
         ++next)
      out[next] =
          d[k - 1] + (d[k] - d[k - 1]) * (curve_pressures()[next] - p[k - 1]) / (p[k] - p[k - 1]);
  return out;
}

} // namespace

const std::vector<double> &curve_pressures() {
  static const std::vector<double> pressures = [] {
    std::vector<double> out;
    for (double p = 1.0; p < kHighest; p *= kRatio)
      out.push_back(std::stod(fmt::format("{:.4g}", p)));
    return out;
  }();
  return pressures;
}

Run read_run_of(const Point &point, const std::string &path) {
  Mistakes mistakes;
  RunFolder folder(path);
  folder.must_be_finished(mistakes);
  mistakes.stop_if_any();
  const Curve curve = folder.curve({"displacement_shown_um", "pressure_shown_MPa", "pressure_MPa"},
                                   mistakes, mistakes);
  mistakes.stop_if_any();
  const nlohmann::json &summary = folder.object("summary.json");
  const nlohmann::json presses = summary.value("presses", nlohmann::json::array());
  const std::vector<Press> rows = curve.presses();
  Run run;
  run.point = point;
  run.porosity_before = number_in(summary, "porosity_initial_shown");
  run.loading = loading_of(curve);
  for (std::size_t k = 0; k < presses.size(); ++k) {
    PressedFilm film;
    for (const Number &n : kNumbers)
      if (n.in_summary)
        film.*(n.field) = number_in(presses[k], n.in_summary);
    film.inverse_tortuosity = folder.inverse_tortuosity(
        k + 1 == presses.size() ? "after" : fmt::format("press_{}", k + 1));
    for (const double share : kReleasedTo)
      film.release.push_back(released_to(curve, rows.at(k), share * film.pressure));
    run.presses.push_back(film);
  }
  if (!run.presses.empty())
    run.thickness_before = run.presses[0].thickness_after * (1.0 - run.presses[0].porosity_after) /
                           (1.0 - run.porosity_before);
  return run;
}

namespace {

std::string start_of_row(const Run &run) {
  std::string out =
      fmt::format("{},{},{:d}", run.point.number, run.point.packing, run.point.larger);
  for (const double v : run.point.values)
    out += "," + cell(v);
  return out + fmt::format(",{},{},{}", run.failed, cell(run.porosity_before),
                           cell(run.thickness_before));
}

/// Displacements of the k-th press: those that no press before has reached.
std::string curve_cells(const Run &run, std::size_t k) {
  std::string out;
  const double from = k == 0 ? 0.0 : run.presses[k - 1].pressure,
               to = k + 1 == run.presses.size() ? kHighest : run.presses[k].pressure;
  for (std::size_t g = 0; g < curve_pressures().size(); ++g) {
    const double p = curve_pressures()[g];
    out += "," + (p > from && p <= to ? cell(run.loading[g], "{:.3f}") : "");
  }
  return out;
}

std::vector<std::string> header_of(const Bank &bank) {
  std::vector<std::string> out = {"point", "packing", "larger_cell"};
  for (const Input &input : bank.design.inputs)
    out.push_back(input.name);
  out.insert(out.end(), {"failed", "porosity_before", "thickness_before_um"});
  for (const Number &n : kNumbers)
    out.push_back(n.column);
  for (const double p : curve_pressures())
    out.push_back(curve_column(p));
  for (const double share : kReleasedTo)
    out.push_back(release_column(share));
  return out;
}

/// A row of the table goes to its run, which is the last one or a new one.
class RunsReader {
public:
  RunsReader(const Bank &bank, const std::string &file, const CsvTable &table)
      : table_(table), mistakes_(file, 20), points_(points_of(bank.design)) {
    for (const std::string &column : header_of(bank)) {
      if (!table.has(column))
        mistakes_.add(1, "column '{}' is missing. Is this the table of {}?", column, bank.file);
      if (column != "failed")
        columns_[column] = table.numbers(column);
    }
    for (const int line : table.bad_lines())
      mistakes_.add(line, "the line has another number of cells than the header.");
    mistakes_.stop_if_any();
    out_.bank = bank;
    failed_ = table.texts("failed");
  }

  Runs read() {
    for (std::size_t k = 0; k < table_.rows(); ++k)
      add(k);
    mistakes_.stop_if_any();
    return out_;
  }

private:
  const CsvTable &table_;
  Mistakes mistakes_;
  std::vector<Point> points_;
  std::map<std::string, std::vector<double>> columns_;
  std::vector<std::string> failed_;
  Runs out_;

  double at(const std::string &column, std::size_t k) const { return columns_.at(column)[k]; }

  /// The point of row k; null, with a mistake: it is none of the bank's.
  const Point *point_at(std::size_t k) {
    const double number = at("point", k);
    const std::vector<Input> &inputs = out_.bank.design.inputs;
    const Point *point =
        number >= 1.0 && number <= double(points_.size()) && number == std::floor(number)
            ? &points_[std::size_t(number) - 1]
            : nullptr;
    bool same = point && at("packing", k) == point->packing &&
                at("larger_cell", k) == double(point->larger);
    for (std::size_t d = 0; same && d < inputs.size(); ++d) {
      const double v = at(inputs[d].name, k), w = point->values[d];
      same = v == w || (std::isnan(v) && std::isnan(w));
    }
    if (!same)
      mistakes_.add(table_.line_of(k),
                    "point {:g} has other inputs than that of {}: it is the table of another bank.",
                    number, out_.bank.file);
    return same ? point : nullptr;
  }

  void add(std::size_t k) {
    const Point *point = point_at(k);
    if (!point)
      return;
    if (out_.runs.empty() || out_.runs.back().point.number != point->number) {
      out_.runs.emplace_back();
      Run &run = out_.runs.back();
      run.point = *point;
      run.failed = failed_[k];
      run.porosity_before = at("porosity_before", k);
      run.thickness_before = at("thickness_before_um", k);
      run.loading.assign(curve_pressures().size(), NAN);
    }
    if (failed_[k].empty())
      add_press(k, out_.runs.back());
  }

  void add_press(std::size_t k, Run &run) {
    PressedFilm film;
    for (const Number &n : kNumbers)
      film.*(n.field) = at(n.column, k);
    if (!std::isfinite(film.pressure) || !std::isfinite(film.porosity_after))
      mistakes_.add(table_.line_of(k), "'pressure_MPa' or 'porosity_after' is no number.");
    for (std::size_t g = 0; g < curve_pressures().size(); ++g)
      if (const double d = at(curve_column(curve_pressures()[g]), k); std::isfinite(d))
        run.loading[g] = d;
    for (const double share : kReleasedTo)
      film.release.push_back(at(release_column(share), k));
    run.presses.push_back(film);
  }
};

} // namespace

std::string write_runs(const Runs &runs) {
  std::string out = fmt::format("{}\n", fmt::join(header_of(runs.bank), ","));
  const std::size_t rest = std::size(kNumbers) + curve_pressures().size() + kReleasedTo.size();
  for (const Run &run : runs.runs) {
    const std::string start = start_of_row(run);
    if (run.presses.empty())
      out += start + std::string(rest, ',') + "\n";
    for (std::size_t k = 0; k < run.presses.size(); ++k) {
      out += start;
      for (const Number &n : kNumbers)
        out += "," + cell(run.presses[k].*(n.field));
      out += curve_cells(run, k);
      for (const double d : run.presses[k].release)
        out += "," + cell(d, "{:.3f}");
      out += "\n";
    }
  }
  return out;
}

Runs read_runs(const Bank &bank, const std::string &file) {
  return RunsReader(bank, file, CsvTable::parse(text_of_file(file))).read();
}

} // namespace calendem::bank
