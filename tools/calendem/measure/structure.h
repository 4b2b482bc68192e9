// SPDX-License-Identifier: GPL-2.0-or-later
// Everything that is measured of a structure, simulated or imaged.
#ifndef CALENDEM_MEASURE_STRUCTURE_H
#define CALENDEM_MEASURE_STRUCTURE_H

#include "measure/diffusion.h"
#include "measure/phases.h"
#include "measure/run_directory.h"
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace calendem {

// Coordination numbers from overlaps of spheres; the same and broken bodies as voxels show them.

/// Two bodies touch if a primary of one overlaps a primary of the other by more than the insets of
/// both, as in the simulation; fragments of a body count as that body. Each partner counts once,
/// however many primaries touch. Means; 0 where there is nothing to count.
struct Coordination {
  int bodies = 0, cbd = 0;
  double am_am = 0.0;          ///< other bodies that a body touches
  double am_cbd = 0.0;         ///< CBD spheres that a body touches
  double cbd_am = 0.0;         ///< bodies that a CBD sphere touches
  double cbd_cbd = 0.0;        ///< other CBD spheres that a CBD sphere touches
  double am_without_am = 0.0;  ///< share of the bodies that touch no other body
  double am_without_any = 0.0; ///< share of the bodies that touch nothing
};

/// Inset of each particle [um] for its intact bonds, as `fix bond/bpm` has it; 0 of CBD and where a frame
/// has no tags. `whole` [um], `fading` 0-1: keys of the case.
std::vector<double> surface_insets(const ParticleFrame &particles, const BondFrame &bonds,
                                   double whole, double fading);

Coordination coordination(const std::vector<Sphere> &spheres, const Cell &cell);

/// What voxels show of the bodies, in a simulated structure as in a tomogram. It depends on the
/// size of the voxels: narrower gaps and cracks are not seen.
struct VoxelBodies {
  int bodies = 0;
  double am_am = 0.0; ///< mean number of other bodies that share a face of a voxel with a body
  int whole = 0;      ///< bodies that no side of the image cuts and of at least 200 voxels
  int in_pieces = 0;  ///< of those: the largest part connected by faces has less than 95 %
};

VoxelBodies bodies_on_voxels(const PhaseImage &image);

constexpr double kSimulatedVoxel = 0.15; ///< [um]

struct MeasureOptions {
  /// Voxel of a simulated structure (kSimulatedVoxel), or in place of an image's own.
  std::optional<double> voxel_um;
  double slice_um = 1.0;                 ///< of the profiles
  bool tortuosity = true;                ///< takes most of the time
  std::int32_t background = 0;           ///< label of an image's pores
  std::optional<std::int32_t> cbd_label; ///< none: an image shows no CBD
  std::optional<double> nanoporosity;    ///< of an image's CBD, 0-1; none: no total porosity
  std::string moment; ///< of a run, the only one to measure, or kReleases; empty: all
};

/// One structure at one moment.
struct StructureMeasures {
  std::string moment; ///< before, press_1, ..., max, after; image
  std::optional<double> time_us, pressure_MPa;
  double thickness_um = 0.0; ///< h of the porosities
  std::array<int, 3> voxels = {0, 0, 0};
  Eigen::Vector3d voxel;   ///< [um]
  PhaseFractions fraction; ///< of the voxels
  Porosity porosity;       ///< total and nano are NaN for an image whose nanoporosity is not known
  std::optional<double> am_on_voxels; ///< volume of AM on voxels over N s^3
  SurfaceArea surface;
  std::optional<Coordination> coordination; ///< only where spheres are known
  VoxelBodies bodies;
  std::vector<Tortuosity> tortuosity; ///< along x, y, z; empty if not asked for
  std::vector<Slice> slices;
  bool has_bonds = false;
};

/// What the voxels show; what only a simulation knows is left empty.
StructureMeasures measure_phases(const PhaseImage &image, const Density &density,
                                 const MeasureOptions &options);

/// A label image. Throws Failure(2) as read_label_image does.
StructureMeasures measure_image(const std::string &file, const MeasureOptions &options);

/// Spheres between collector and platen, with the volumes of their solids.
struct SimulatedStructure {
  std::vector<Sphere> spheres;
  Cell cell{};
  double lattice = 0.0;   ///< [um]
  double cbd_solid = 0.0; ///< carbon and binder [um3]
  std::vector<BondAt> bonds;
};
StructureMeasures measure_spheres(const SimulatedStructure &structure,
                                  const MeasureOptions &options);

/// What asks for the ends of all releases: press_1, ..., after.
inline constexpr const char *kReleases = "releases";

/// A frame of a run: before, press_1 and so on (the end of a release that is not the last, if a frame
/// is near), max (the frame nearest the maximum pressure), after.
struct RunMoment {
  std::string name;
  double time_us = 0.0, pressure_MPa = 0.0;
  SimulatedStructure structure;
};

/// Moments that an unfinished run has not reached are left out. Throws Failure(2) with every file
/// that is missing or damaged.
std::vector<RunMoment> moments_of_run(const std::string &folder);

/// The moments of a run's directory, measured. Throws as moments_of_run does.
std::vector<StructureMeasures> measure_run(const std::string &folder,
                                           const MeasureOptions &options);

/// structure.csv and structure.json.
std::string profile_table(const std::vector<StructureMeasures> &moments);
nlohmann::json to_json(const StructureMeasures &measures);
/// What every number in structure.json means.
nlohmann::json structure_definitions();

} // namespace calendem

#endif
