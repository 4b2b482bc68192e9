// SPDX-License-Identifier: GPL-2.0-or-later
// The moments of a run's directory that are measured.
#include "simulate/run.h"
#include "base/messages.h"
#include "measure/run_directory.h"
#include "measure/structure.h"
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

void stop_if_any(const Problems &problems) {
  std::string text;
  for (const Problem &p : problems)
    text += fmt::format("{}{}: {}. What to do: {}.", text.empty() ? "" : "\n", p.file, p.what,
                        p.remedy);
  if (!text.empty())
    throw Failure(kBadInput, text);
}

Run read_whole_run(const std::string &folder, ElectrodeFacts &electrode) {
  Problems problems;
  Run run = read_run(folder, problems);
  stop_if_any(problems);
  if (run.particles.empty() || run.platen.empty())
    stop_if_any(run.notes);
  try {
    electrode = describe_electrode(run.electrode);
  } catch (const std::exception &x) {
    throw Failure(kBadInput,
                  fmt::format("{}/electrode.json: it is missing or cannot be used ({}). Copy it "
                              "from the folder of the run's electrode.",
                              folder, x.what()));
  }
  return run;
}

double platen_height(const Run &run, double time, Problems &problems) {
  double height = 0.0;
  for (const auto &outline : read_platen(closest(run.platen, time).path, problems).outlines)
    for (const auto &point : outline)
      height = std::max(height, point[2]);
  return height;
}

// The frame nearest to `time`; `height` 0: the platen's in that frame.
SimulatedStructure read_frame(const Run &run, const ElectrodeFacts &e, double time, double height) {
  Problems problems;
  SimulatedStructure s;
  s.cell = {e.lx, e.ly, height > 0.0 ? height : platen_height(run, time, problems)};
  s.lattice = e.lattice;
  s.cbd_solid = e.solid - e.am;
  const auto particles = read_particles(closest(run.particles, time).path, problems);
  for (size_t i = 0; i < particles.centre.size(); ++i)
    s.spheres.push_back(
        {Eigen::Vector3d(particles.centre[i].data()), particles.radius[i], particles.body[i]});
  if (!run.bonds.empty()) {
    const auto bonds = read_bonds(closest(run.bonds, time).path, problems);
    for (size_t i = 0; i < bonds.from.size(); ++i)
      s.bonds.push_back({0.5 * (bonds.from[i][2] + bonds.to[i][2]), !bonds.intact[i]});
  }
  stop_if_any(problems);
  return s;
}

} // namespace

std::vector<RunMoment> moments_of_run(const std::string &folder) {
  ElectrodeFacts electrode;
  const Run run = read_whole_run(folder, electrode);
  std::vector<RunMoment> moments;
  const auto add = [&](const char *name, double time, double height) {
    const double frame = closest(run.particles, time).time_us;
    size_t row = 0;
    for (size_t i = 0; i < run.curve.rows(); ++i)
      if (std::fabs(run.curve["time_us"][i] - frame) < std::fabs(run.curve["time_us"][row] - frame))
        row = i;
    moments.push_back(
        {name, frame, run.curve["pressure_MPa"][row], read_frame(run, electrode, time, height)});
  };
  add("before", run.particles.front().time_us, 0.0);
  if (!run.curve.relaxation().empty())
    add("max", run.curve["time_us"][run.curve.row_of_max_pressure()], 0.0);
  if (run.unfinished.empty())
    add("after", run.particles.back().time_us,
        run.summary.value("thickness_after_relaxation_um", 0.0));
  return moments;
}

std::vector<StructureMeasures> measure_run(const std::string &folder,
                                           const MeasureOptions &options) {
  std::vector<StructureMeasures> out;
  for (const RunMoment &moment : moments_of_run(folder)) {
    out.push_back(measure_spheres(moment.structure, options));
    out.back().moment = moment.name;
    out.back().time_us = moment.time_us;
    out.back().pressure_MPa = moment.pressure_MPa;
  }
  return out;
}

} // namespace calendem
