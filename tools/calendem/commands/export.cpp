// SPDX-License-Identifier: GPL-2.0-or-later
// export: a moment of a run for other programs.
#include "base/material_notes.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "commands/commands.h"
#include "measure/exports.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace calendem {
namespace {

struct ExportArguments {
  std::string run, moment = "after", electrode, bpx, lammps, phases, labels;
  double voxel_um = kSimulatedVoxel;
};

void write_voxels(const ExportArguments &a, const SimulatedStructure &s) {
  if (a.phases.empty() && a.labels.empty())
    return;
  const PhaseImage image = voxelise(s.spheres, s.cell, s.lattice, a.voxel_um);
  if (!a.phases.empty()) {
    write_label_image(with_phases(image), a.phases);
    fmt::print("export: {}: pores 0, active material 1, CBD 2\n", a.phases);
  }
  if (!a.labels.empty()) {
    const LabelImage labels = with_labels(image);
    write_label_image(labels, a.labels);
    fmt::print("export: {}: pores 0, bodies from 1, CBD {}\n", a.labels,
               *std::max_element(labels.label.begin(), labels.label.end()));
  }
}

void export_run(const ExportArguments &a) {
  if (a.bpx.empty() && a.lammps.empty() && a.phases.empty() && a.labels.empty())
    throw CLI::RequiredError("--bpx, --lammps, --phases or --labels");
  const RunMoment moment = moment_of_run(a.run, a.moment);
  write_voxels(a, moment.structure);
  if (!a.lammps.empty()) {
    write_file(a.lammps, lammps_data_of_run(a.run, moment, a.electrode));
    fmt::print("export: {}: atom_style bpm/sphere, units micro\n", a.lammps);
  }
  if (!a.bpx.empty()) {
    const ElectrodeOfBpx e = electrode_of_bpx(moment.structure, a.voxel_um);
    const std::string title = fmt::format(
        "Positive electrode of {}, {} pressing, calendem {}",
        std::filesystem::path(a.run).lexically_normal().filename().string(), a.moment, version());
    write_file(a.bpx, bpx_fragment(e, title).dump(2) + "\n");
    fmt::print("export: {}: thickness {:.2f} um, porosity {:.2f} %, transport efficiency {:.4f}, "
               "particle radius {:.3f} um, active fraction {:.4f}\n",
               a.bpx, e.thickness, 100.0 * e.porosity, e.transport_efficiency, e.particle_radius,
               e.active_fraction);
  }
  for (const std::string &warning :
       warnings_of_electrode(RunFolder(a.run).object("electrode.json")))
    fmt::print(stderr, "warning: {}\n", warning);
}

} // namespace

void add_export_verb(CLI::App &app) {
  const auto a = std::make_shared<ExportArguments>();
  CLI::App *verb = app.add_subcommand(
      "export", "Write a moment of a run for PyBaMM, LAMMPS or programs that read images");
  verb->add_option("RUN", a->run, "folder made by calendem run")->required();
  verb->add_option("--moment", a->moment, "before, press_1 ..., max or after")
      ->capture_default_str();
  verb->add_option("--bpx", a->bpx, "fragment of a BPX file (JSON): the electrode's structure");
  verb->add_option("--lammps", a->lammps, "data file with bodies as molecules, and bonds");
  verb->add_option("--electrode", a->electrode,
                   "folder of the electrode, for the masses of --lammps, if it has moved");
  verb->add_option("--phases", a->phases,
                   "image of pores, active material and CBD (.tif, .mha ...)");
  verb->add_option("--labels", a->labels, "image with a number for each body");
  verb->add_option("--voxel-um", a->voxel_um, "voxel of images and of the transport efficiency")
      ->capture_default_str()
      ->check(finite_range(0.01, 2.0));
  verb->callback([a] { export_run(*a); });
}

} // namespace calendem
