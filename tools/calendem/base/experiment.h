// SPDX-License-Identifier: GPL-2.0-or-later
// What was measured on a calendered electrode, with its uncertainty, and how it was calendered. A
// new measured value is a row of quantities() and a field of Condition; experiment_reader.cpp reads
// the file.
#ifndef CALENDEM_BASE_EXPERIMENT_H
#define CALENDEM_BASE_EXPERIMENT_H

#include "base/messages.h"
#include "base/recipe.h"
#include "base/registry.h"
#include <optional>
#include <string>
#include <vector>

namespace calendem {

/// A measured value. In the file a number, or { value, sd } or { value, sd_relative }.
struct Measured {
  double value = 0.0;
  double sd = 0.0; ///< standard deviation in the unit of the value; 0: not given
  bool includes_foil =
      false; ///< mass and thickness only; default: a mass does, a thickness does not
};

/// One pressed sample. Units are in the names; fractions 0-1.
struct Condition {
  std::string id;
  std::string specimen; ///< the piece that was pressed; conditions may share one
  std::string control;  ///< pressure, displacement, thickness or roll_gap
  std::string pressing; ///< name of a bank's way of pressing; empty: the usual one
  std::optional<Measured> roll_gap_um, displacement_um, thickness_at_max_um, max_pressure_MPa,
      loading_mg_cm2, porosity_before_percent, porosity_after_percent, thickness_after_um, mass_mg,
      cracked_bodies_fraction, cbd_nanoporosity_after_percent, pressure_left_percent;
  std::string curve;                       ///< absolute path of a CSV file, empty if none
  double curve_sd_um = 0.0;                ///< of each displacement of the curve; 0: not given
  double curve_drift_um = 0.0;             ///< sd at the curve's end, from 0 at its beginning
  double curve_zero_um = 0.0;              ///< sd of where the platen first touches
  std::string labels_before, labels_after; ///< absolute paths of label images, or empty
  double dwell_s = 0.0;
};

/// Single particles of the powder, crushed one by one between two plates.
struct CrushedParticles {
  double diameter_um = 0.0;
  Measured load_mN; ///< at which those of this diameter break, in the middle
};

struct Experiment {
  std::string name;
  std::string electrode; ///< absolute path of the recipe
  std::string material;  ///< of the coating; empty: not named
  Recipe recipe;
  double sample_diameter_mm = 0.0; ///< 0: not given; so are the foil's
  double foil_thickness_um = 0.0;
  double foil_density_g_cm3 = 0.0;
  int labels_pore = 0;           ///< label of the pores in the label images
  std::optional<int> labels_cbd; ///< none: the images show no CBD
  double labels_voxel_um = 0.0;  ///< 0: as the images state
  bool on_press = false;         ///< not by a simulation like the bank's
  /// By what specimens of one coating differ (standard deviations).
  double specimen_porosity_points = 0.0, specimen_thickness_percent = 0.0;
  std::vector<Condition> conditions;
  std::vector<std::string> train, test; ///< ids
  std::vector<CrushedParticles> crushed;
};

/// Throws Failure(2) with every mistake of the file and of the recipe that it names.
Experiment read_experiment(const std::string &file);

/// Thickness of the coating alone, from a thickness or a mass that may include the foil.
double coating_thickness_um(const Experiment &e, const Measured &thickness);
double coating_loading_mg_cm2(const Experiment &e, const Measured &mass);
/// Thickness of the coating without pores, with the recipe's composition and densities.
double solid_thickness_um(const Experiment &e, double loading_mg_cm2);

double sample_area_cm2(const Experiment &e);
double foil_mg_cm2(const Experiment &e);

/// Every key with unit, range and meaning, for --help.
std::string list_of_experiment_keys();

/// A number, or { value, sd }, of a condition.
struct Quantity {
  Key key;
  std::optional<Measured> Condition::*field;
};

const std::vector<Key> &head_keys();      ///< of [experiment]
const std::vector<Key> &condition_keys(); ///< of [[condition]], without the measured values
const std::vector<Quantity> &quantities();
const std::vector<Key> &crushed_keys(); ///< of [[crushed_particle]]

/// Foil and sample are known where masses and thicknesses hold them, and leave a coating.
void check_foil(const Experiment &experiment, const Condition &condition, const std::string &who,
                int line, Mistakes &mistakes);

/// Loading of the condition's specimen: from its mass, or as stated. [mg/cm2]
std::optional<Measured> loading_of(const Experiment &experiment, const Condition &condition);

/// A coating is as thick as its solid at least, and has not only pores; far beyond the errors one of
/// the values is wrong.
void check_thickness(const Experiment &experiment, const Condition &condition,
                     const std::string &who, int line, Mistakes &mistakes);

/// A CSV file whose displacements, pressures and stages can be those of the condition; `line` is
/// that of its key.
void check_curve(const Experiment &experiment, const Condition &condition, int line,
                 Mistakes &mistakes);

} // namespace calendem

#endif
