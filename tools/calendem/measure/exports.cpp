// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/exports.h"
#include "base/case.h"
#include "electrode/structure/particle_data.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {

RunMoment moment_of_run(const std::string &folder, const std::string &name) {
  std::string there;
  for (RunMoment &moment : moments_of_run(folder)) {
    if (moment.name == name)
      return std::move(moment);
    there += (there.empty() ? "" : ", ") + moment.name;
  }
  throw Failure(kBadInput, fmt::format("'{}' has no moment '{}'; it has {}. Give one of them by "
                                       "--moment, or let the run end (--resume).",
                                       folder, name, there));
}

ElectrodeOfBpx electrode_of_bpx(const SimulatedStructure &s, double voxel) {
  MeasureOptions options;
  options.voxel_um = voxel;
  options.tortuosity = false;
  const StructureMeasures m = measure_spheres(s, options);
  std::map<int, int> primaries;
  for (const Sphere &p : s.spheres)
    if (p.body > 0)
      ++primaries[p.body];
  double cubes = 0.0, squares = 0.0; // of the balls' radii
  for (const auto &[body, count] : primaries) {
    const double r = std::cbrt(0.75 / kPi * count) * s.lattice;
    cubes += r * r * r;
    squares += r * r;
  }
  ElectrodeOfBpx out;
  out.thickness = s.cell.height;
  out.porosity = m.porosity.total;
  out.macro_porosity = m.porosity.macro;
  out.transport_efficiency = tortuosity(voxelise(s.spheres, s.cell, s.lattice, voxel), 2).effective;
  out.particle_radius = squares > 0.0 ? cubes / squares : 0.0;
  out.active_fraction = 4.0 / 3.0 * kPi * cubes / (s.cell.lx * s.cell.ly * s.cell.height);
  return out;
}

nlohmann::ordered_json bpx_fragment(const ElectrodeOfBpx &e, const std::string &title) {
  constexpr double kMetre = 1e-6; // of 1 um
  nlohmann::ordered_json j;
  j["Header"] = {{"BPX", 0.4}, // a number up to version 0.5 of the schema; later ones take it, too
                 {"Title", title},
                 {"Model", "DFN"}};
  nlohmann::ordered_json &all = j["Parameterisation"];
  all["Positive electrode"] = {
      {"Thickness [m]", e.thickness * kMetre},
      {"Porosity", e.porosity},
      {"Transport efficiency", e.transport_efficiency},
      {"Particle radius [m]", e.particle_radius * kMetre},
      {"Surface area per unit volume [m-1]", 3.0 * e.active_fraction / e.particle_radius / kMetre}};
  nlohmann::ordered_json &more = all["User-defined"];
  more = {{"Positive electrode active material volume fraction", e.active_fraction},
          {"Positive electrode macro porosity", e.macro_porosity}};
  if (e.transport_efficiency > 0.0) {
    more["Positive electrode tortuosity factor of the macro pores"] =
        e.macro_porosity / e.transport_efficiency;
    more["Positive electrode Bruggeman exponent"] =
        std::log(e.transport_efficiency) / std::log(e.porosity);
  }
  return j;
}

std::map<long, double> masses_of_electrode(const std::string &folder) {
  Mistakes mistakes(folder + "/electrode.data", 3);
  std::map<long, double> out;
  for (const DataParticle &p : read_particle_data(mistakes.file(), {}, mistakes).particles)
    out[p.id] = p.density * kPi / 6.0 * p.diameter * p.diameter * p.diameter;
  mistakes.stop_if_any();
  return out;
}

namespace {

double in_period(double x, double side) { return x - side * std::floor(x / side); }

std::string atom_rows(const ParticleFrame &p, const Cell &cell,
                      const std::map<long, double> &mass) {
  std::string out;
  for (size_t k = 0; k < p.tag.size(); ++k) {
    const auto m = mass.find(p.tag[k]);
    if (m == mass.end())
      throw Failure(kBadInput, fmt::format("particle {} of the run is not in electrode.data. Give "
                                           "the electrode of this run by --electrode.",
                                           p.tag[k]));
    const double d = 2.0 * p.radius[k];
    out +=
        fmt::format("{} {} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", p.tag[k], p.body[k], p.type[k],
                    d, m->second / (kPi / 6.0 * d * d * d), in_period(p.centre[k][0], cell.lx),
                    in_period(p.centre[k][1], cell.ly), p.centre[k][2]);
  }
  return out;
}

} // namespace

std::string lammps_data(const ParticleFrame &p, const BondFrame &bonds, const Cell &cell,
                        const std::map<long, double> &mass, const std::string &title) {
  if (p.tag.empty() || p.type.size() != p.tag.size() || bonds.tags.size() != bonds.intact.size())
    throw Failure(kBadInput,
                  "the frames have no tags. Write them with input_scripts/in.calendering "
                  "of this version.");
  std::string rows;
  size_t count = 0;
  for (size_t k = 0; k < bonds.tags.size(); ++k)
    if (bonds.intact[k])
      rows += fmt::format("{} 1 {} {}\n", ++count, bonds.tags[k].first, bonds.tags[k].second);
  double low = 0.0, high = cell.height;
  for (const Point &x : p.centre) {
    low = std::min(low, x[2]);
    high = std::max(high, x[2]);
  }
  std::string out = fmt::format(
      "{}; units micro, atom_style bpm/sphere, boundary p p f\n\n{} atoms\n{} atom types\n{} "
      "bonds\n1 bond types\n\n0 {:.9g} xlo xhi\n0 {:.9g} ylo yhi\n{:.9g} {:.9g} zlo zhi\n\n"
      "Atoms # bpm/sphere\n\n",
      title, p.tag.size(), *std::max_element(p.type.begin(), p.type.end()), count, cell.lx, cell.ly,
      low, high);
  out += atom_rows(p, cell, mass);
  return count > 0 ? out + "\nBonds\n\n" + rows : out;
}

std::string lammps_data_of_run(const std::string &folder, const RunMoment &moment,
                               const std::string &electrode) {
  Mistakes mistakes;
  const Run run = read_run(folder, mistakes);
  const ParticleFrame particles =
      read_particles(closest(run.particles, moment.time_us).path, mistakes);
  const BondFrame bonds = run.bonds.empty()
                              ? BondFrame{}
                              : read_bonds(closest(run.bonds, moment.time_us).path, mistakes);
  mistakes.stop_if_any();
  const std::string from =
      electrode.empty() ? read_case(folder + "/case.toml").text("electrode") : electrode;
  return lammps_data(particles, bonds, moment.structure.cell, masses_of_electrode(from),
                     fmt::format("{} of {} by calendem export", moment.name, run.name));
}

namespace {

LabelImage relabelled(const PhaseImage &image, std::int32_t am, std::int32_t cbd) {
  LabelImage out = image;
  for (std::int32_t &label : out.label)
    label = label == kCbdLabel ? cbd : label > 0 && am > 0 ? am : label;
  return out;
}

} // namespace

LabelImage with_phases(const PhaseImage &image) { return relabelled(image, 1, 2); }

LabelImage with_labels(const PhaseImage &image) {
  return relabelled(image, 0, *std::max_element(image.label.begin(), image.label.end()) + 1);
}

} // namespace calendem
