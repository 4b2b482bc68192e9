// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/structure.h"
#include "base/messages.h"
#include "measure/run_directory.h"
#include "simulate/run.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {

StructureMeasures measure_phases(const PhaseImage &image, const Density &density,
                                 const MeasureOptions &options) {
  StructureMeasures m;
  m.thickness_um = image.side(2);
  m.voxels = image.n;
  m.voxel = image.voxel;
  m.fraction = phase_fractions(image);
  m.surface = surface_area(image);
  m.bodies = bodies_on_voxels(image);
  m.slices = profile(image, density, options.slice_um);
  for (int axis = 0; options.tortuosity && axis < 3; ++axis)
    m.tortuosity.push_back(tortuosity(image, axis));
  return m;
}

namespace {

/// With a label that no voxel has all results are those of another image.
void check_labels(const std::string &file, const PhaseImage &image, const MeasureOptions &options) {
  const PhaseFractions fraction = phase_fractions(image);
  const auto refuse = [&](const char *option, std::int32_t label) {
    throw Failure(kBadInput, fmt::format("'{}': no voxel is left for {} = {}. Give the label that "
                                         "the image has for it.",
                                         file, option, label));
  };
  if (fraction.pore == 0.0)
    refuse("--background", options.background);
  if (options.cbd_label && fraction.cbd == 0.0)
    refuse("--cbd-label", *options.cbd_label);
}

} // namespace

StructureMeasures measure_image(const std::string &file, const MeasureOptions &options) {
  const PhaseImage image = phases_of(read_label_image(file, options.voxel_um.value_or(0.0)),
                                     options.background, options.cbd_label);
  check_labels(file, image, options);
  const double solid_in_cbd = 1.0 - options.nanoporosity.value_or(NAN);
  StructureMeasures m = measure_phases(image, {1.0, solid_in_cbd}, options);
  m.moment = "image";
  m.porosity = porosity({1.0, m.fraction.am, solid_in_cbd * m.fraction.cbd, m.fraction.cbd});
  return m;
}

StructureMeasures measure_spheres(const SimulatedStructure &s, const MeasureOptions &options) {
  const PhaseImage image =
      voxelise(s.spheres, s.cell, s.lattice, options.voxel_um.value_or(kSimulatedVoxel));
  const PhaseFractions fraction = phase_fractions(image);
  Volumes v;
  v.cell = s.cell.lx * s.cell.ly * s.cell.height;
  v.am = std::pow(s.lattice, 3) * double(std::count_if(s.spheres.begin(), s.spheres.end(),
                                                       [](const Sphere &p) { return p.body > 0; }));
  v.cbd_solid = s.cbd_solid;
  v.cbd_envelope = fraction.cbd * v.cell;
  const auto over = [](double a, double b) { return b > 0.0 ? a / b : 1.0; };
  StructureMeasures m = measure_phases(
      image, {over(v.am, fraction.am * v.cell), over(v.cbd_solid, v.cbd_envelope)}, options);
  m.porosity = porosity(v);
  m.am_on_voxels = over(fraction.am * v.cell, v.am);
  m.coordination = coordination(s.spheres, s.cell);
  m.has_bonds = !s.bonds.empty();
  count_bonds(s.bonds, m.slices);
  return m;
}

// The moments of a run's directory that are measured.

namespace {

Run read_whole_run(const std::string &folder, ElectrodeFacts &electrode) {
  Mistakes mistakes;
  Run run = read_run(folder, mistakes);
  mistakes.stop_if_any();
  if (run.particles.empty() || run.platen.empty())
    run.notes.stop_if_any();
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

double platen_height(const Run &run, double time, Mistakes &mistakes) {
  double height = 0.0;
  for (const auto &outline : read_platen(closest(run.platen, time).path, mistakes).outlines)
    for (const auto &point : outline)
      height = std::max(height, point[2]);
  return height;
}

/// Gives spheres the insets that the run's case has; a run of the scripts alone has no case.
void lay_surfaces(const Run &run, const ParticleFrame &particles, const BondFrame &bonds,
                  std::vector<Sphere> &spheres) {
  const RunFolder folder(run.directory);
  if (!folder.has("case.toml"))
    return;
  const Settings settings = folder.settings();
  const std::vector<double> insets =
      surface_insets(particles, bonds, settings.number("bond.surface_inset_um"),
                     settings.number("bond.inset_fading"));
  for (std::size_t i = 0; i < spheres.size(); ++i)
    spheres[i].inset = insets[i];
}

// The frame nearest to `time`; `height` 0: the platen's in that frame.
SimulatedStructure read_frame(const Run &run, const ElectrodeFacts &e, double time, double height) {
  Mistakes mistakes;
  SimulatedStructure s;
  s.cell = {e.lx, e.ly, height > 0.0 ? height : platen_height(run, time, mistakes)};
  s.lattice = e.lattice;
  s.cbd_solid = e.solid - e.am;
  const auto particles = read_particles(closest(run.particles, time).path, mistakes);
  for (size_t i = 0; i < particles.centre.size(); ++i)
    s.spheres.push_back(
        {Eigen::Vector3d(particles.centre[i].data()), particles.radius[i], particles.body[i]});
  if (!run.bonds.empty()) {
    const auto bonds = read_bonds(closest(run.bonds, time).path, mistakes);
    lay_surfaces(run, particles, bonds, s.spheres);
    for (size_t i = 0; i < bonds.from.size(); ++i)
      s.bonds.push_back({0.5 * (bonds.from[i][2] + bonds.to[i][2]), !bonds.intact[i]});
  }
  mistakes.stop_if_any();
  return s;
}

/// A frame so close to a release's end shows what it left: the film rests, and the platen has hardly
/// turned.
constexpr double kNearEnough_us = 0.1;

bool is_asked(const std::string &moment, const std::string &asked) {
  return asked.empty() || moment == asked ||
         (asked == kReleases && (moment == "after" || moment.rfind("press_", 0) == 0));
}

} // namespace

std::vector<RunMoment> moments_of_run(const std::string &folder) {
  ElectrodeFacts electrode;
  const Run run = read_whole_run(folder, electrode);
  std::vector<RunMoment> moments;
  const auto add = [&](const std::string &name, double time, double height) {
    const double frame = closest(run.particles, time).time_us;
    size_t row = 0;
    for (size_t i = 0; i < run.curve.rows(); ++i)
      if (std::fabs(run.curve["time_us"][i] - frame) < std::fabs(run.curve["time_us"][row] - frame))
        row = i;
    const std::string longer = "elongation_percent";
    const ElectrodeFacts cell =
        electrode.elongated(run.curve.has(longer) ? 0.01 * run.curve[longer][row] : 0.0);
    moments.push_back(
        {name, frame, run.curve["pressure_MPa"][row], read_frame(run, cell, time, height)});
  };
  add("before", run.particles.front().time_us, 0.0);
  const std::vector<Press> presses = run.curve.presses();
  for (std::size_t k = 0; k + 1 < presses.size(); ++k)
    if (const double end = run.curve["time_us"][presses[k].last];
        std::fabs(closest(run.particles, end).time_us - end) <= kNearEnough_us)
      add(fmt::format("press_{}", k + 1), end, run.curve["thickness_um"][presses[k].last]);
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
    if (!is_asked(moment.name, options.moment))
      continue;
    out.push_back(measure_spheres(moment.structure, options));
    out.back().moment = moment.name;
    out.back().time_us = moment.time_us;
    out.back().pressure_MPa = moment.pressure_MPa;
  }
  return out;
}

// structure.csv and structure.json.

namespace {

using nlohmann::json;

json or_null(double v) { return std::isfinite(v) ? json(v) : json(nullptr); }
json or_null(const std::optional<double> &v) { return v ? or_null(*v) : json(nullptr); }

std::string or_empty(double v) { return std::isfinite(v) ? fmt::format("{:.6f}", v) : ""; }

json to_json(const Tortuosity &t) {
  json j = {{"tau", or_null(t.tau)},
            {"tau_on_voxels", or_null(t.tau_on_voxels())},
            {"every_nth_voxel", t.stride},
            {"effective_diffusivity", t.effective},
            {"effective_diffusivity_on_voxels", t.on_voxels},
            {"effective_diffusivity_on_doubled_voxels", t.on_doubled},
            {"extrapolated", t.extrapolated},
            {"porosity", t.porosity},
            {"percolating_fraction", t.percolating},
            {"voxel_um", {t.voxel[0], t.voxel[1], t.voxel[2]}}};
  if (t.effective <= 0.0)
    j["statement"] = "no path of pore voxels leads through: tau is infinite";
  else if (!t.extrapolated)
    j["statement"] = "no path leads through on voxels of twice the size: tau is not extrapolated "
                     "and an upper bound";
  return j;
}

json to_json(const std::vector<Tortuosity> &t) {
  if (t.empty())
    return nullptr;
  json j = {{"in_plane_x", to_json(t[0])},
            {"in_plane_y", to_json(t[1])},
            {"through_plane", to_json(t[2])}};
  const double mean = 0.5 * (t[0].effective + t[1].effective);
  j["tau_in_plane"] = mean > 0.0 ? json(t[0].porosity / mean) : json(nullptr);
  j["tau_through_plane"] = or_null(t[2].tau);
  return j;
}

json to_json(const Coordination &c) {
  return {{"am_am", c.am_am},
          {"am_cbd", c.am_cbd},
          {"cbd_am", c.cbd_am},
          {"cbd_cbd", c.cbd_cbd},
          {"bodies_without_am_contact", c.am_without_am},
          {"bodies_without_contact", c.am_without_any}};
}

} // namespace

std::string profile_table(const std::vector<StructureMeasures> &moments) {
  std::string out = "moment,z_from_um,z_to_um,z_over_thickness,am_fraction,cbd_fraction,"
                    "porosity_macro,porosity_total,bonds,bonds_broken\n";
  for (const StructureMeasures &m : moments)
    for (const Slice &s : m.slices) {
      out += fmt::format("{},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f},{},", m.moment, s.from, s.to,
                         0.5 * (s.from + s.to) / m.thickness_um, s.fraction.am, s.fraction.cbd,
                         s.fraction.pore, or_empty(s.porosity_total));
      out += m.has_bonds ? fmt::format("{},{}\n", s.bonds, s.broken) : ",\n";
    }
  return out;
}

json to_json(const StructureMeasures &m) {
  json j = {{"moment", m.moment},
            {"time_us", or_null(m.time_us)},
            {"pressure_MPa", or_null(m.pressure_MPa)},
            {"thickness_um", m.thickness_um},
            {"voxel_um", {m.voxel[0], m.voxel[1], m.voxel[2]}},
            {"voxels", m.voxels},
            {"porosity_total", or_null(m.porosity.total)},
            {"porosity_macro", m.porosity.macro},
            {"porosity_nano", or_null(m.porosity.nano)},
            {"pore_voxel_fraction", m.fraction.pore},
            {"am_fraction", m.fraction.am},
            {"cbd_fraction", m.fraction.cbd},
            {"am_on_voxels_over_lattice_volume", or_null(m.am_on_voxels)},
            {"area_per_volume_1_um",
             {{"pore_solid", m.surface.pore_solid()},
              {"pore_am", m.surface.pore_am},
              {"pore_cbd", m.surface.pore_cbd},
              {"am_cbd", m.surface.am_cbd}}},
            {"bodies_on_voxels",
             {{"bodies", m.bodies.bodies},
              {"am_am", m.bodies.am_am},
              {"whole", m.bodies.whole},
              {"in_pieces", m.bodies.in_pieces}}},
            {"tortuosity", to_json(m.tortuosity)}};
  if (m.coordination)
    j["coordination"] = to_json(*m.coordination);
  return j;
}

json structure_definitions() {
  return {{"porosity_total", "1 - (V_AM + V_CBD,solid)/(A h)"},
          {"porosity_macro",
           "1 - (V_AM + V_CBD,envelope)/(A h): what a tomogram resolves; V_CBD,envelope "
           "is the part of the CBD spheres outside the AM envelopes"},
          {"porosity_nano", "total - macro: inside CBD"},
          {"V_AM", "N s^3, N primaries on a lattice of spacing s; of an image: its voxels"},
          {"thickness_um",
           "h: gap between collector and platen, after relaxation that at which the "
           "platen lost contact; of an image: all of its layers"},
          {"area_per_volume_1_um", "Cauchy-Crofton along 13 directions of voxels, per volume A h"},
          {"coordination",
           "am_am: other bodies a body touches; am_cbd: CBD spheres a body touches; cbd_am: "
           "bodies a CBD sphere touches; touching: spheres overlap; means"},
          {"bodies_on_voxels",
           "am_am: other bodies that share a face of a voxel; whole: not cut by the "
           "image's sides, 200 voxels at least; in_pieces: of those, largest "
           "connected part below 95 %"},
          {"tau", "tortuosity factor of the macro pores, eps D/D_eff, eps all pore voxels; D_eff "
                  "extrapolated to voxels of size 0; CBD counts as solid. tau_on_voxels: without "
                  "that step, as "
                  "programs that take the voxels as they are"},
          {"tau_in_plane", "eps over the mean D_eff/D of x and y"}};
}

} // namespace calendem
