// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/collect.h"
#include "base/case.h"
#include "base/material_notes.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "physics/nanopore_collapse.h"
#include "simulate/rolling.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

namespace calendem {
namespace {

const char *const kStageNames[] = {"hold", "compression", "dwell", "relaxation", "relaxation"};

// Waves after a burst of breaks swing for some tenths of a microsecond.
constexpr double kImbalanceWindow = 0.5; // us
// Rows are up to 0.1 um apart: the highest of them lies a little below the pressure that was met.
// Gaps are averages: where the platen turns at once, a quarter of the window's travel is cut off.
constexpr double kTargetTolerance = 0.02, kLastTravel = 0.25 * kAverageTravel; // um

// |P_top - P_bottom| / P_top with both averaged over kImbalanceWindow: rows are averages over
// `average` already, so those of the time before the rest of the window count.
std::vector<double> imbalance(const std::vector<RawRow> &rows, double average) {
  std::vector<double> out;
  for (size_t i = 0; i < rows.size(); ++i) {
    double top = 0.0, bottom = 0.0;
    for (size_t k = i + 1; k-- > 0 && rows[k].time >= rows[i].time + average - kImbalanceWindow &&
                           (rows[k].stage > 2.5) == (rows[i].stage > 2.5);) {
      top += rows[k].p_top;
      bottom += rows[k].p_bottom;
    }
    out.push_back(top > 0.0 ? std::fabs(top - bottom) / top : 0.0);
  }
  return out;
}

std::string curve(const std::vector<RawRow> &rows, const ElectrodeFacts &e,
                  const UnionVolume &filled, const Settings &settings, bool elongates) {
  const double average = averaging_window(settings);
  const PressInstruments press = instruments_of(settings);
  const std::vector<double> difference = imbalance(rows, average);
  std::string out =
      "time_us,stage,displacement_um,thickness_um,pressure_MPa,pressure_bottom_MPa,bonds_broken,"
      "broken_fraction,broken_tension,broken_bending,broken_shear,broken_torsion,porosity_total,"
      "porosity_macro,kinetic_to_strain,kinetic_fJ,strain_fJ,work_platen_fJ,work_bonds_lost_fJ,"
      "work_collector_fJ,pressure_difference,contact_elastic_fJ,cohesion_fJ,damped_fJ,"
      "friction_fJ,displacement_shown_um,thickness_shown_um,pressure_shown_MPa" +
      validity_columns() + (elongates ? elongation_columns() : "") + "\n";
  for (size_t i = 0; i < rows.size(); ++i) {
    const RawRow &r = rows[i];
    out += fmt::format(
        "{:.6f},{},{:.6f},{:.6f},{:.6g},{:.6g},{:.0f},{:.6f},{:.0f},{:.0f},{:.0f},{:.0f},{:.6f},"
        "{:.6f},{:.4g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6f}"
        ","
        "{:.6f},{:.6g}",
        r.time, kStageNames[static_cast<int>(r.stage)], r.displacement, r.gap, r.p_top, r.p_bottom,
        r.broken, r.made > 0 ? r.broken / r.made : 0.0, r.tension, r.bending, r.shear, r.torsion,
        total_porosity(e, r.gap, r.elongation),
        1.0 - filled.at(r.time) / (e.elongated(r.elongation).area * r.gap),
        r.strain > 0 ? r.kinetic / r.strain : 0.0, r.kinetic, r.strain, r.work_platen, r.work_lost,
        r.work_collector, difference[i], r.contact_elastic, r.cohesion, r.damped, r.friction,
        press.displacement_shown(r.displacement, r.p_top), press.thickness_shown(r.gap),
        press.pressure_shown(r.p_top));
    out += validity_cells(r, e.primary) + (elongates ? elongation_cells(r, e) : "") + "\n";
  }
  return out;
}

nlohmann::json quasi_static(const std::vector<RawRow> &rows, double average) {
  const std::vector<double> averaged = imbalance(rows, average);
  Column pressure;
  std::vector<bool> released;
  for (const RawRow &r : rows) {
    pressure.push_back(r.p_top);
    released.push_back(r.stage > 2.5);
  }
  double worst = 0.0, worst_row = 0.0, sum = 0.0;
  int n = 0, over = 0;
  for (const size_t i : first_loading(pressure, released))
    if (pressure[i] > 5.0) {
      worst = std::max(worst, averaged[i]);
      worst_row = std::max(worst_row, std::fabs(1.0 - rows[i].p_bottom / rows[i].p_top));
      sum += averaged[i];
      over += averaged[i] > kQuasiStatic;
      ++n;
    }
  return {{"window_us", std::max(average, kImbalanceWindow)},
          {"pressure_difference_max_above_5_MPa", worst},
          {"pressure_difference_mean_above_5_MPa", n > 0 ? sum / n : 0.0},
          {"pressure_difference_max_of_a_row", worst_row},
          {"rows_above_5_MPa", n},
          {"rows_with_difference_above_5_percent", over}};
}

std::string speed_warning(const nlohmann::json &check) {
  const int over = check["rows_with_difference_above_5_percent"];
  return over == 0
             ? ""
             : fmt::format("the pressures on platen and collector differ by more than 5 % in {} of "
                           "{} rows above 5 MPa (by {:.1f} % at most): the run is not quasi-static "
                           "there. Lower platen.speed_m_s",
                           over, check["rows_above_5_MPa"].get<int>(),
                           100.0 * check["pressure_difference_max_above_5_MPa"].get<double>());
}

/// What was put in by hand where a model would need a law; null: nothing.
nlohmann::json imposed(const Settings &s, double max_pressure) {
  const double until = s.number("imposed.cbd_nanoporosity_until_MPa"),
               initial = s.number("effects.cbd_collapse.initial_nanoporosity"),
               floor = s.number("effects.cbd_collapse.floor_nanoporosity");
  if (until <= 0.0)
    return nullptr;
  const NanoporeCollapse law = {initial, floor, 0.0, 1.0, 1.0};
  return {{"what", fmt::format("imposed, not predicted: from {:g} to {:g} % at {:g} MPa",
                               100.0 * initial, 100.0 * floor, until)},
          {"final", law.imposed(max_pressure, until)}};
}

std::string platen_stopped(const std::vector<RawRow> &rows, const Settings &s) {
  double pressure = 0.0, gap = rows.front().gap, moved = 0.0; // as the press shows them
  const PressInstruments press = instruments_of(s);
  for (const RawRow &r : rows) {
    pressure = std::max(pressure, press.pressure_shown(r.p_top));
    gap = std::min(gap, r.gap - press.compliance * r.p_top);
    moved = std::max(moved, press.displacement_shown(r.displacement, r.p_top));
  }
  const std::string &control = s.text("platen.control");
  const std::string key =
      control == "pressure" ? "platen.max_pressure_MPa" : "platen." + control + "_um";
  const double target = s.number(key);
  const bool reached = control == "pressure" ? pressure >= (1.0 - kTargetTolerance) * target
                       : control == "thickness" || control == "roll_gap"
                           ? gap <= (1.0 + kTargetTolerance) * target + kLastTravel
                           : moved >= (1.0 - kTargetTolerance) * target - kLastTravel;
  return reached
             ? ""
             : fmt::format("the platen stopped at its lowest position, {:.2f} um, at {:.1f} MPa "
                           "and did not reach {} = {}. Ask for less, or check the units of the "
                           "moduli",
                           gap, pressure, key, target);
}

std::vector<std::string> failed_checks(const std::vector<RawRow> &rows, const Settings &settings,
                                       const ElectrodeFacts &e, long logged) {
  std::vector<std::string> failed;
  const RawRow &last = rows.back();
  if (const std::string missed = line_load_missed(rows, settings); !missed.empty())
    failed.push_back(missed);
  if (const std::string short_of = platen_stopped(rows, settings); !short_of.empty())
    failed.push_back(short_of);
  if (last.made != e.bonds)
    failed.push_back(
        fmt::format("{} bonds were made, but the electrode has {} pairs of one body that touch",
                    last.made, e.bonds));
  if (last.broken != logged)
    failed.push_back(fmt::format("the curve ends with {} broken bonds, breaks.csv holds {}",
                                 last.broken, logged));
  if (last.tension + last.bending + last.shear + last.torsion != last.broken)
    failed.push_back("the four modes do not add up to the broken bonds");
  return failed;
}

long count_rows(const std::string &file) {
  std::ifstream in(file);
  std::string line;
  long n = -1;
  while (std::getline(in, line))
    ++n;
  return std::max(n, 0L);
}

} // namespace

double total_porosity(const ElectrodeFacts &e, double gap, double elongation) {
  return 1.0 - e.solid / (e.elongated(elongation).area * gap);
}

std::map<long, std::vector<double>> rows_by_step(const std::string &file, std::size_t columns) {
  std::map<long, std::vector<double>> rows;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line) && !in.eof()) { // a line without its end is being written
    std::vector<double> row;
    const char *at = line.c_str();
    for (char *end = nullptr; row.size() < columns; at = end + (*end == ',')) {
      const double value = std::strtod(at, &end);
      if (end == at)
        break;
      row.push_back(value);
    }
    if (row.size() == columns)
      rows[static_cast<long>(row[0])] = row;
  }
  return rows;
}

std::vector<RawRow> read_raw(const std::string &file) {
  std::vector<RawRow> out;
  for (const auto &[step, row] : rows_by_step(file, kRawColumns))
    std::memcpy(static_cast<void *>(&out.emplace_back()), row.data(), kRawColumns * sizeof(double));
  return out;
}

RawRow top_of(const std::vector<RawRow> &rows) {
  double largest = 0.0;
  for (const RawRow &r : rows)
    largest = std::max(largest, r.p_top);
  std::size_t top = rows.size() - 1;
  for (std::size_t k = top; k-- > 0;) {
    const bool of_the_time_before = rows[k].stage > 2.5 && rows[k + 1].stage < 1.5;
    if (of_the_time_before && rows[top].p_top >= (1.0 - kTargetTolerance) * largest)
      break;
    if (rows[k].p_top >= rows[top].p_top)
      top = k;
  }
  return rows[top];
}

std::optional<double> gap_at_loss(const std::vector<RawRow> &rows, double fraction,
                                  double max_pressure) {
  const double lost = fraction * max_pressure;
  size_t released = rows.size(); // a roll may have let go before
  while (released > 1 && rows[released - 1].stage > 2.5)
    --released;
  for (size_t k = released; k < rows.size(); ++k) {
    const RawRow &above = rows[k - 1], &below = rows[k];
    if (below.stage > 2.5 && below.p_top < lost)
      return above.p_top <= lost ? above.gap
                                 : above.gap + (below.gap - above.gap) * (above.p_top - lost) /
                                                   (above.p_top - below.p_top);
  }
  return std::nullopt;
}

nlohmann::json gaps_and_porosities(const std::vector<RawRow> &rows, const RawRow &top,
                                   const Settings &settings, const ElectrodeFacts &e) {
  const double lost = settings.number("platen.contact_lost_fraction");
  // a run that was stopped has no gap after relaxation: the last one stands for it
  const double gap = gap_at_loss(rows, lost, top.p_top).value_or(rows.back().gap);
  const PressInstruments press = instruments_of(settings);
  const double last = rows.back().elongation;
  nlohmann::json by_threshold = nlohmann::json::object();
  for (double f : {0.005, 0.01, 0.02, 0.05})
    if (const auto at = gap_at_loss(rows, f, top.p_top))
      by_threshold[fmt::format("{}", f)] = total_porosity(e, *at, last);
  if (rows.back().stage > 3.5) // the pressure of every row may lie above what stopped the platen
    by_threshold[fmt::format("{}", lost)] = total_porosity(e, gap, last);
  nlohmann::json s = {
      {"max_pressure_MPa", top.p_top},
      {"thickness_at_max_um", top.gap},
      {"porosity_at_max", total_porosity(e, top.gap, top.elongation)},
      {"thickness_after_relaxation_um", gap},
      {"porosity_after_relaxation", total_porosity(e, gap, last)},
      {"porosity_initial", total_porosity(e, e.thickness)},
      {"contact_lost_fraction", lost},
      {"springback", (gap - top.gap) / top.gap},
      {"porosity_initial_shown", total_porosity(e, press.thickness_shown(e.thickness))},
      {"max_pressure_shown_MPa", press.pressure_shown(top.p_top)},
      {"thickness_at_max_shown_um", press.thickness_shown(top.gap)},
      {"thickness_after_relaxation_shown_um", press.thickness_shown(gap)},
      {"porosity_after_relaxation_shown", total_porosity(e, press.thickness_shown(gap), last)}};
  if (!by_threshold.empty())
    s["porosity_after_relaxation_by_threshold"] = by_threshold;
  return s;
}

namespace {

using Rows = std::vector<RawRow>;

/// How the run went, and of what.
nlohmann::json provenance(const std::string &folder, const Rows &rows, const Settings &settings,
                          const ElectrodeFacts &e, const RunFacts &facts) {
  nlohmann::json s = {{"timestep_us", rows.back().time / rows.back().step},
                      {"steps", static_cast<long>(rows.back().step)},
                      {"case_hash", facts.case_hash},
                      {"finished", rows.back().stage > 3.5 && facts.stopped_because.empty()}};
  if (facts.ranks > 0) {
    s["wall_clock_s"] = facts.earlier_s + facts.wall_clock_s;
    s["ranks"] = facts.ranks;
    s["atom_steps_per_second"] =
        std::max(0.0, rows.back().step - facts.first_step) * e.atoms / facts.wall_clock_s;
  }
  s["provenance"] = {
      {"calendem", version()},
      {"case_toml", hash_of_file(folder + "/case.toml")},
      {"electrode_data", hash_of_file(settings.text("electrode") + "/electrode.data")},
      {"liggghts", facts.program.empty() ? "not known" : facts.program},
      {"input_scripts", hash_of_folder(input_scripts() + "/common")},
      {"hashes", "64-bit FNV-1a"}};
  if (facts.stopped_because.empty() && !s["finished"].get<bool>())
    s["stopped_because"] = "the scripts did not reach their end";
  else if (facts.stopped_because.empty())
    s["failed_checks"] = failed_checks(rows, settings, e, count_rows(folder + "/breaks.csv"));
  else
    s["stopped_because"] = facts.stopped_because;
  return s;
}

/// What happened to carbon and binder and to the bonds.
nlohmann::json what_changed(const Rows &rows, const RawRow &top, const UnionVolume &filled,
                            const ElectrodeFacts &e) {
  nlohmann::json s = {{"broken_fraction_at_max", top.made > 0 ? top.broken / top.made : 0.0},
                      {"broken_fraction_after", top.made > 0 ? rows.back().broken / top.made : 0.0},
                      {"bonds_initial", static_cast<long>(rows.back().made)}};
  if (const auto &cbd = filled.cbd_spheres;
      e.nanoporosity > 0.0 && !cbd.empty() && cbd.back() > 0.0)
    s["cbd_nanoporosity_after"] = // its spheres keep their solid
        1.0 - (1.0 - e.nanoporosity) * cbd.front() / cbd.back();
  return s;
}

void warn(const nlohmann::json &s, const std::string &folder) {
  for (const std::string &warning :
       warnings_of_electrode(RunFolder(folder).object("electrode.json")))
    fmt::print(stderr, "warning: {}\n", warning);
  for (const std::string &warning :
       {ledger_warning(s["energy_fJ"]), speed_warning(s["quasi_static"]),
        range_warning(s["contact_range"])})
    if (!warning.empty())
      fmt::print(stderr, "warning: {}\n", warning);
}

} // namespace

nlohmann::json collect(const std::string &folder, const Settings &settings, const ElectrodeFacts &e,
                       const RunFacts &facts) {
  Rows rows = read_raw(folder + "/curve_raw.csv");
  if (rows.size() < 2)
    throw Failure(kSimulationFailed, "'{}/curve_raw.csv' holds no curve", folder);
  const bool elongates = add_elongation(folder, rows);
  const auto frames = write_series(folder, rows.back().time / rows.back().step);
  const UnionVolume filled = union_volumes(folder, e, frames, rows);
  write_file(folder + "/curve.csv", curve(rows, e, filled, settings, elongates));
  std::vector<MomentOfRun> moments;
  for (const RawRow &r : rows)
    moments.push_back({r.time, r.p_top, kStageNames[static_cast<int>(r.stage)]});
  const double last = rows.back().elongation;
  const auto [bodies, cracked] =
      write_bodies(folder, e, settings.text("electrode"), frames, moments, last);

  const RawRow top = top_of(rows);
  nlohmann::json s = gaps_and_porosities(rows, top, settings, e);
  s.update(provenance(folder, rows, settings, e, facts));
  if (!frames.empty())
    s["height_of_tops_after_um"] = height_of_tops(folder, frames.back().first);
  s.update(what_changed(rows, top, filled, e));
  s["bodies"] = bodies;
  s["cracked_bodies"] = cracked;
  s["cracked_criterion"] = "at least 8 % of its bonds broken and more than one fragment";
  if (const nlohmann::json by_hand = imposed(settings, top.p_top); !by_hand.is_null())
    s["imposed"] = by_hand;
  s["quasi_static"] = quasi_static(rows, averaging_window(settings));
  s["quasi_static"].update(inertia(rows, top, e.primary));
  s["contact_range"] = contact_range(rows, top);
  s["presses"] = presses_of(folder, rows, filled, e, settings);
  if (settings.text("platen.control") == "roll_gap")
    s["roll"] = roll_passes(rows, settings);
  if (elongates)
    s["elongation"] = elongation_of(top, rows.back(), e);
  if (const nlohmann::json dried = dried_film(folder); !dried.is_null())
    s["drying"] = dried;
  if (const nlohmann::json held = write_bridges(folder, rows, top); !held.is_null())
    s["bridges"] = held;
  if (settings.number("roll.line_load_N_mm") > 0.0)
    s["roll"]["rehearsals"] = rehearsals_in(folder);
  s["energy_fJ"] = energy_ledger(rows, top);
  write_summary(folder, s);
  warn(s, folder);
  return s;
}

void write_summary(const std::string &folder, const nlohmann::json &summary) {
  nlohmann::ordered_json out;
  for (const char *key :
       {"max_pressure_MPa", "porosity_initial", "porosity_at_max", "porosity_after_relaxation",
        "thickness_at_max_um", "thickness_after_relaxation_um", "springback",
        "broken_fraction_at_max", "cracked_bodies", "bodies"})
    if (summary.contains(key))
      out[key] = summary[key];
  out.update(nlohmann::ordered_json(summary)); // the others follow in the order of their names
  write_file(folder + "/summary.json", out.dump(2) + "\n");
}

void stop_if_checks_failed(const nlohmann::json &summary, const std::string &folder) {
  Mistakes failed(folder);
  for (const auto &text : summary.value("failed_checks", nlohmann::json::array()))
    failed.add(0, text.get<std::string>() + ". What was computed is kept.");
  failed.stop_if_any(kCheckFailed);
}

} // namespace calendem
