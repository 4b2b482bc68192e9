// SPDX-License-Identifier: GPL-2.0-or-later
// Where simulation and press disagree: the residual of every observable that both have, beside
// everything that makes it uncertain, and its page. Nothing is fitted here.
#ifndef CALENDEM_COMPARE_GAP_H
#define CALENDEM_COMPARE_GAP_H

#include "base/experiment.h"
#include "base/gap_file.h"
#include "base/shown.h"
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace calendem {

/// What one run gives for an experiment, as its press shows it. Lengths um, pressures MPa,
/// porosities and fractions 0-1.
struct SimulatedRun {
  std::string folder;
  std::string control;
  std::string pressing; ///< of a bank's runs: its name; empty: the usual one
  double target = 0.0;  ///< of the platen: MPa or um
  double max_pressure = 0.0, thickness_at_max = 0.0, thickness_after = 0.0;
  double porosity_initial = 0.0, porosity_at_max = 0.0, porosity_after = 0.0;
  double solid_column = 0.0;     ///< solid volume per area [um]
  double cracked_fraction = 0.0; ///< of the bodies
  double broken_fraction = NAN;  ///< of the bonds, after release
  /// 1 / tortuosity factor of the macro pores through the plane, after release; 0: no path leads
  /// through; NaN: not measured.
  double inverse_tortuosity = NAN;
  double cbd_nanoporosity = NAN; ///< of the carbon-binder domain after release
  /// Pressure at the end of the dwell over that at its beginning; NaN: there is no dwell.
  double pressure_left = NAN;
  std::string way; ///< how often, how fast and how long it was pressed, to tell runs apart
  std::vector<double> pressure, displacement; ///< of the first compression, highest so far
  /// The last release, by rising pressure: the lowest so far.
  std::vector<double> release_pressure, release_displacement;
  double porosity_slope = 0.0; ///< d porosity / d pressure under load near the maximum [1/MPa]
  std::string imposed;         ///< what was imposed on the run, not predicted; empty: nothing
  std::map<std::string, std::string> recipe; ///< of its electrode
  std::string electrode_hash;                ///< two runs of one packing are no two packings
};

/// Reads summary.json, electrode.json, case.toml and curve.csv of a run directory. Throws
/// Failure(2) with what is missing, cut, or not finished.
SimulatedRun read_simulated_run(const std::string &folder);

/// Adds a point to a branch of a curve if its pressure lies above all before; false: it does not.
bool add_if_higher(std::vector<double> &pressures, std::vector<double> &displacements,
                   double pressure, double displacement);

/// Mean pressure of the last quarter of the last dwell, over that of the compression's last row; NaN:
/// there is no dwell.
double pressure_left(const std::vector<std::string> &stage, const std::vector<double> &pressure);

/// Displacement at which `pressure` is first met, linear between points; NaN beyond the last.
double displacement_at(const std::vector<double> &pressures,
                       const std::vector<double> &displacements, double pressure);

/// One observable of one condition; values in `unit`.
struct Residual : Place {
  double measured = 0.0, simulated = 0.0;
  int packings = 0;            ///< that `simulated` is the mean of
  double sd_measurement = 0.0; ///< of the measured value
  double sd_seeds = 0.0;       ///< of the mean over packings; NaN: not known
  double sd_pressure = 0.0;    ///< by the uncertainty of the condition's pressure
};

struct Gap {
  std::string experiment;
  std::vector<Residual> rows;        ///< largest |z| first
  double threshold = 0.0;            ///< of |z|
  double chi2 = 0.0, p_value = 1.0;  ///< of all rows together, as if they were independent
  int degrees_of_freedom = -1;       ///< of the pooled scatter between packings; -1: not known
  std::vector<std::string> said;     ///< what can be said
  std::vector<std::string> not_said; ///< what cannot, and what would help
};

/// Throws Failure(2) if no run belongs to any condition.
Gap find_gap(const Experiment &experiment, const std::vector<SimulatedRun> &runs);

/// gap.json and the page made from it.
nlohmann::ordered_json to_json(const Gap &gap);
std::string gap_page(const nlohmann::ordered_json &gap);

/// For a page: {"conditions": [""], "rows": [{"observable", "cells": [{"text", "colour"}]}]} of
/// rows "where" of gap.json, whose residual is simulation less experiment in "unit" and whose z
/// is beyond `threshold`. Conditions in the order of `conditions`, the others by name.
nlohmann::json heat_map(const nlohmann::json &where, double threshold,
                        const std::vector<std::string> &conditions = {});

/// The condition with the recipe's loading where its own is not known, and a note.
Condition with_loading_of_recipe(const Experiment &experiment, const Condition &condition,
                                 std::vector<std::string> &not_said);

} // namespace calendem

#endif
