// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/sample.h"
#include "base/case.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "simulate/collect.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

std::vector<double> turned(std::vector<double> v) {
  std::reverse(v.begin(), v.end());
  return v;
}

/// A path as gaps against rising pressure: where each is met for the first time.
struct GapOfPressure {
  std::vector<double> pressure, gap;

  GapOfPressure(const std::vector<double> &p, const std::vector<double> &h) {
    for (std::size_t k = 0; k < p.size(); ++k)
      if (pressure.empty() || p[k] > pressure.back()) {
        pressure.push_back(p[k]);
        gap.push_back(h[k]);
      }
  }
  double at(double p) const { return along_points(pressure, gap, p, gap.front()); }
};

/// Down, a cell bears nothing before its first point; up, nothing after its last.
double pressure_down(const PressedCell &c, double gap) {
  return gap > c.down.gap.front() ? 0.0
                                  : along_points(turned(c.down.gap), turned(c.down.pressure), gap,
                                                 c.down.pressure.back());
}
double pressure_up(const PressedCell &c, double gap) {
  return gap > c.up.gap.back() ? 0.0
                               : along_points(c.up.gap, c.up.pressure, gap, c.up.pressure.front());
}

template <class Cells, class Value> double mean(const Cells &cells, Value value) {
  double sum = 0.0;
  for (const auto &c : cells)
    sum += value(c);
  return sum / double(cells.size());
}

template <class Value> double largest(const std::vector<PressedCell> &cells, Value value) {
  double out = -kEndless;
  for (const PressedCell &c : cells)
    out = std::max(out, value(c));
  return out;
}

/// The different ones from `low` to `high`, rising.
std::vector<double> between(std::vector<double> v, double low, double high) {
  v.erase(std::remove_if(v.begin(), v.end(), [&](double x) { return x < low || x > high; }),
          v.end());
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
  return v;
}

} // namespace

double along_points(const std::vector<double> &x, const std::vector<double> &y, double at,
                    double below) {
  const auto next = std::lower_bound(x.begin(), x.end(), at);
  if (next == x.end())
    return y.back();
  const std::size_t k = std::size_t(next - x.begin());
  if (x[k] == at)
    return y[k];
  return k == 0 ? below : y[k - 1] + (y[k] - y[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]);
}

PressPath monotone(const PressPath &path, bool rises) {
  PressPath out;
  for (std::size_t k = 0; k < path.gap.size(); ++k)
    if (out.gap.empty() || (rises ? path.gap[k] > out.gap.back() : path.gap[k] < out.gap.back())) {
      out.gap.push_back(path.gap[k]);
      out.pressure.push_back(path.pressure[k]);
    }
  return out;
}

std::vector<SampleRow> under_one_gap(const std::vector<PressedCell> &cells) {
  const double turn = largest(cells, [](const PressedCell &c) { return c.down.gap.back(); });
  std::vector<double> down, up;
  for (const PressedCell &c : cells) {
    down.push_back(c.thickness);
    down.insert(down.end(), c.down.gap.begin(), c.down.gap.end());
    up.insert(up.end(), c.up.gap.begin(), c.up.gap.end());
  }
  std::vector<SampleRow> out;
  for (const double gap : turned(between(down, turn, kEndless)))
    out.push_back(
        {false, gap, mean(cells, [&](const PressedCell &c) { return pressure_down(c, gap); })});
  for (const double gap : between(up, turn, kEndless))
    out.push_back(
        {true, gap, mean(cells, [&](const PressedCell &c) { return pressure_up(c, gap); })});
  return out;
}

std::vector<SampleRow> under_one_pressure(const std::vector<PressedCell> &cells) {
  std::vector<GapOfPressure> down, up;
  std::vector<double> down_to, up_from;
  double turn = kEndless, end = -kEndless;
  for (const PressedCell &c : cells) {
    down.push_back({c.down.pressure, c.down.gap});
    up.push_back({turned(c.up.pressure), turned(c.up.gap)});
    down_to.insert(down_to.end(), down.back().pressure.begin(), down.back().pressure.end());
    up_from.insert(up_from.end(), up.back().pressure.begin(), up.back().pressure.end());
    turn = std::min(turn, down.back().pressure.back());
    end = std::max(end, up.back().pressure.front());
  }
  std::vector<SampleRow> out;
  for (const double p : between(down_to, -kEndless, turn))
    out.push_back({false, mean(down, [&](const GapOfPressure &g) { return g.at(p); }), p});
  for (const double p : turned(between(up_from, end, turn)))
    out.push_back({true, mean(up, [&](const GapOfPressure &g) { return g.at(p); }), p});
  return out;
}

namespace {

constexpr double kSameTurn = 0.02; // of the pressure

struct Cell {
  PressedCell pressed;
  double solid = 0.0, loading = 0.0; ///< [um], [mg/cm2]
  Settings settings;
  nlohmann::json summary, electrode;
};

/// A curve's last row comes before the platen turns, by up to a row; the summary has the moment itself.
void add_turn(const nlohmann::json &summary, PressPath &down) {
  const double gap = summary.value("thickness_at_max_um", kEndless);
  if (gap < down.gap.back()) {
    down.gap.push_back(gap);
    down.pressure.push_back(summary.value("max_pressure_MPa", std::nan("")));
  }
}

/// Gap and pressure down and up.
void read_paths(RunFolder &folder, Cell &cell, Mistakes &mistakes) {
  const Curve curve =
      folder.curve({"thickness_um", "pressure_MPa", "porosity_total"}, mistakes, mistakes);
  PressPath down, up;
  for (std::size_t k = 0; k < curve.rows(); ++k) {
    const bool released = curve.stage[k] == "relaxation";
    if (!released && !up.gap.empty())
      return mistakes.add(folder.path_of("curve.csv"),
                          "of a run that was pressed again after a release",
                          "make a sample of single passes");
    PressPath &path = released ? up : down;
    path.gap.push_back(curve["thickness_um"][k]);
    path.pressure.push_back(curve["pressure_MPa"][k]);
  }
  if (curve.rows() == 0)
    return;
  if (down.gap.empty() || up.gap.empty())
    return mistakes.add(folder.path_of("curve.csv"),
                        fmt::format("it has no {}", up.gap.empty() ? "relaxation" : "compression"),
                        "run the case again");
  cell.solid = curve["thickness_um"][0] * (1.0 - curve["porosity_total"][0]);
  cell.pressed.down = monotone(down, false);
  add_turn(cell.summary, cell.pressed.down);
  cell.pressed.up = monotone(up, true);
}

Cell read_cell(const std::string &path, Mistakes &mistakes) {
  Cell cell;
  RunFolder folder(path);
  folder.must_be_finished(mistakes);
  cell.summary = folder.object("summary.json");
  cell.electrode = folder.object("electrode.json", mistakes);
  if (cell.summary.is_null() || cell.electrode.is_null())
    return cell;
  cell.settings = folder.settings();
  cell.loading = cell.electrode.value("loading_mg_cm2", std::nan(""));
  read_paths(folder, cell, mistakes);
  cell.pressed.thickness =
      cell.solid / (1.0 - cell.summary.value("porosity_initial", std::nan("")));
  return cell;
}

double turning_point(const Cell &c, OneFor shared) {
  const PressPath &path = c.pressed.down;
  return shared == OneFor::Gap ? path.gap.back()
                               : *std::max_element(path.pressure.begin(), path.pressure.end());
}

/// All cells turn together: a window's travel apart at most, or the press's tolerance.
void check_turns(const std::vector<std::string> &folders, const std::vector<Cell> &cells,
                 OneFor shared, Mistakes &mistakes) {
  const double first = turning_point(cells[0], shared),
               apart = shared == OneFor::Gap ? kAverageTravel : kSameTurn * first;
  const char *unit = shared == OneFor::Gap ? "um" : "MPa";
  for (std::size_t k = 1; k < cells.size(); ++k)
    if (const double turn = turning_point(cells[k], shared); !(std::fabs(turn - first) <= apart))
      mistakes.add(0,
                   "{} was pressed to {:.3f} {}, {} to {:.3f} {}; cells of one {} turn within "
                   "{:.2g} {} of each other. Press them all with the same {}.",
                   folders[0], first, unit, folders[k], turn, unit,
                   shared == OneFor::Gap ? "gap" : "pressure", apart, unit,
                   shared == OneFor::Gap ? "platen.thickness_um, control = \"thickness\""
                                         : "platen.max_pressure_MPa");
}

/// The sample as a run: its rows, and its means as an electrode of 1 um2.
struct Pressed {
  std::vector<RawRow> rows;
  ElectrodeFacts means;

  RawRow top() const { return top_of(rows); }
};

Pressed pressed_sample(const std::vector<Cell> &cells, OneFor shared) {
  std::vector<PressedCell> pressed;
  for (const Cell &c : cells)
    pressed.push_back(c.pressed);
  Pressed out;
  out.means.area = 1.0;
  out.means.thickness = mean(cells, [](const Cell &c) { return c.pressed.thickness; });
  out.means.solid = mean(cells, [](const Cell &c) { return c.solid; });
  for (const SampleRow &r :
       shared == OneFor::Gap ? under_one_gap(pressed) : under_one_pressure(pressed)) {
    RawRow &row = out.rows.emplace_back();
    row.stage = r.released ? 3.0 : 1.0;
    row.displacement = out.means.thickness - r.gap;
    row.gap = r.gap;
    row.p_top = r.pressure;
  }
  return out;
}

/// The sample's own numbers, and what a press with these instruments shows of them.
std::string curve_of(const Pressed &sample, const PressInstruments &press) {
  std::string out = "stage,displacement_um,thickness_um,pressure_MPa,porosity_total,"
                    "displacement_shown_um,thickness_shown_um,pressure_shown_MPa\n";
  for (const RawRow &r : sample.rows)
    out += fmt::format("{},{:.6f},{:.6f},{:.6g},{:.6f},{:.6f},{:.6f},{:.6g}\n",
                       r.stage > 2.5 ? "relaxation" : "compression", r.displacement, r.gap, r.p_top,
                       total_porosity(sample.means, r.gap),
                       press.displacement_shown(r.displacement, r.p_top),
                       press.thickness_shown(r.gap), press.pressure_shown(r.p_top));
  return out;
}

nlohmann::json description(const std::vector<std::string> &folders, const std::vector<Cell> &cells,
                           OneFor shared) {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t k = 0; k < cells.size(); ++k)
    list.push_back({{"run", folders[k]},
                    {"summary", hash_of_file(folders[k] + "/summary.json")},
                    {"loading_mg_cm2", cells[k].loading},
                    {"thickness_um", cells[k].pressed.thickness},
                    {"turned_at", turning_point(cells[k], shared)}});
  return {{"one", shared == OneFor::Gap ? "gap" : "pressure"}, {"cells", list}};
}

/// The recipe is the first cell's with the mean loading.
nlohmann::json electrode_of(const std::vector<Cell> &cells, const nlohmann::json &sample) {
  nlohmann::json j = {{"sample", sample},
                      {"recipe", cells[0].electrode.value("recipe", nlohmann::json::object())}};
  if (cells[0].electrode.contains("material"))
    j["material"] = cells[0].electrode["material"];
  j["loading_mg_cm2"] = mean(cells, [](const Cell &c) { return c.loading; });
  j["recipe"]["coating.loading_mg_cm2"] = fmt::format("{:.6g}", j["loading_mg_cm2"].get<double>());
  return j;
}

/// The bodies are those of all cells.
nlohmann::json summary_of(const std::vector<Cell> &cells, const Pressed &sample,
                          const nlohmann::json &what) {
  nlohmann::json j =
      gaps_and_porosities(sample.rows, sample.top(), cells[0].settings, sample.means);
  j["finished"] = true;
  for (const char *key : {"bodies", "cracked_bodies"}) {
    double sum = 0.0;
    for (const Cell &c : cells)
      sum += c.summary.value(key, 0.0);
    j[key] = sum;
  }
  j["sample"] = what;
  j["provenance"] = {{"calendem", version()}};
  return j;
}

/// The first cell's; who presses a sample knows its pressure.
std::string case_of(const std::vector<Cell> &cells, const Pressed &sample) {
  Settings settings = cells[0].settings;
  for (const char *other : {"platen.thickness_um", "platen.displacement_um", "platen.roll_gap_um"})
    settings.set(other, "0");
  settings.set("platen.control", "pressure");
  settings.set("platen.max_pressure_MPa", fmt::format("{:.6g}", sample.top().p_top));
  return write_toml(settings, case_keys(), fmt::format("# a sample of {} cells\n", cells.size()));
}

/// Recipe and material, but for seeds, loading and files: cells of one sample have it in common.
std::map<std::string, std::string> common_to_cells(const Cell &c) {
  using Texts = std::map<std::string, std::string>;
  Texts out = c.electrode.value(kRecipeGiven, c.electrode.value("recipe", Texts()));
  for (const auto &[key, value] : c.settings.all())
    if (key.rfind("material.", 0) == 0 || key.rfind("bond.", 0) == 0 ||
        key.rfind("effects.", 0) == 0)
      out[key] = value;
  for (const char *own : {"name", "seed", "coating.loading_mg_cm2", "bond.seed", "structure.file",
                          "structure.body_map", "shapes.image", "shapes.library"})
    out.erase(own);
  return out;
}

void check_alike(const std::vector<std::string> &runs, const std::vector<Cell> &cells,
                 Mistakes &mistakes) {
  for (std::size_t k = 1; k < cells.size(); ++k) {
    const auto all = common_to_cells(cells[k]);
    for (const auto &[key, value] : common_to_cells(cells[0]))
      if (const auto other = all.find(key); other != all.end() && other->second != value)
        mistakes.add(0,
                     "'{}' has {} = {}, '{}' has {}: cells of one sample are of one recipe and "
                     "material, whatever their loading.",
                     runs[0], key, value, runs[k], other->second);
  }
}

std::vector<Cell> read_cells(const std::vector<std::string> &runs, OneFor shared) {
  Mistakes mistakes("sample");
  std::vector<Cell> cells;
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (std::size_t m = 0; m < k; ++m)
      if (std::error_code none; std::filesystem::equivalent(runs[k], runs[m], none))
        fmt::print("note: '{}' is given twice and counts twice\n", runs[k]);
  for (const std::string &run : runs)
    cells.push_back(read_cell(run, mistakes));
  mistakes.stop_if_any();
  check_alike(runs, cells, mistakes);
  check_turns(runs, cells, shared, mistakes);
  mistakes.stop_if_any();
  return cells;
}

/// What has another meaning or more files than a sample is not written over.
void must_not_hold_another(const std::string &folder) {
  namespace fs = std::filesystem;
  const bool run = fs::exists(folder + "/curve_raw.csv"),
             electrode = fs::exists(folder + "/electrode.data");
  if (run || electrode)
    throw Failure(kBadInput,
                  "'{}' holds {}, which a sample would overwrite. Give another folder with -o.",
                  folder, run ? "a run" : "an electrode");
}

} // namespace

void make_sample(const std::vector<std::string> &runs, OneFor shared, const std::string &folder) {
  const std::vector<Cell> cells = read_cells(runs, shared);
  const Pressed sample = pressed_sample(cells, shared);
  const nlohmann::json what = description(runs, cells, shared),
                       electrode = electrode_of(cells, what),
                       summary = summary_of(cells, sample, what);
  make_output_folder(folder);
  for (const std::string &run : runs)
    must_not_be(folder, run, "a run of the sample");
  must_not_hold_another(folder);
  write_file(folder + "/curve.csv", curve_of(sample, instruments_of(cells[0].settings)));
  write_file(folder + "/electrode.json", electrode.dump(2) + "\n");
  write_file(folder + "/case.toml", case_of(cells, sample));
  write_summary(folder, summary);
  fmt::print("sample: {} cells under one {}, {:.2f} mg/cm2, {:.1f} MPa at {:.2f} um, {:.2f} um and "
             "{:.2f} % porosity after release -> {}\n",
             cells.size(), what["one"].get<std::string>(),
             electrode["loading_mg_cm2"].get<double>(), sample.top().p_top, sample.top().gap,
             summary["thickness_after_relaxation_um"].get<double>(),
             100.0 * summary["porosity_after_relaxation"].get<double>(), folder);
}

} // namespace calendem
