// SPDX-License-Identifier: GPL-2.0-or-later
#include "pack/pack.h"
#include "pack/electrode_files.h"
#include "physics/hertz_contact.h"
#include "physics/sjkr_cohesion.h"
#include "run/process.h"
#include "spec/provenance.h"
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

namespace calendem {
namespace fs = std::filesystem;
namespace {

// Final stiffness and cohesion of in.pack; 5 % of sigma_c A_b at the default strength of 500 MPa.
constexpr double kEam = 2e8, kNuAm = 0.3, kCedAm = 6e5;
constexpr double kForceLimit = 0.05 * 5e5 * 1.98557;
constexpr double kPressureLimit_MPa = 0.1;

PackingState examine(const std::vector<Particle> &p, const Recipe &r) {
  PackingState s;
  int pairs = 0;
  const double E = effective_modulus(kEam, kNuAm, kEam, kNuAm);
  for (size_t i = 0; i < p.size(); ++i) {
    s.highest_particle_um = std::max(s.highest_particle_um, p[i].x.z() + 0.5 * p[i].diameter);
    for (size_t j = i + 1; j < p.size(); ++j) {
      if (p[i].type != p[j].type)
        continue;
      Eigen::Vector3d d = p[i].x - p[j].x;
      const double sum = 0.5 * (p[i].diameter + p[j].diameter);
      if (std::fabs(d.z()) > sum)
        continue;
      d.x() -= r.cell_x * std::round(d.x() / r.cell_x);
      d.y() -= r.cell_y * std::round(d.y() / r.cell_y);
      const double distance = d.norm();
      if (distance >= sum)
        continue;
      if (p[i].type == 2) {
        const double overlap = (sum - distance) / p[i].diameter;
        s.cbd_overlap_mean += overlap;
        s.cbd_overlap_max = std::max(s.cbd_overlap_max, overlap);
        ++pairs;
      } else if (p[i].body == p[j].body) {
        s.largest_bond_strain =
            std::max(s.largest_bond_strain, std::fabs(distance / r.lattice - 1.0));
      } else {
        const double R = 0.5 * p[i].diameter;
        const double force =
            hertz_force(E, 0.5 * R, sum - distance) - sjkr_force(kCedAm, distance, R, R);
        s.largest_body_force_nN = std::max(s.largest_body_force_nN, std::fabs(force));
      }
    }
  }
  s.cbd_overlap_mean /= std::max(pairs, 1);
  return s;
}

struct LastRow {
  double gap = 0.0, pressure = 0.0, kinetic = 0.0;
};

LastRow last_row(const std::string &file) {
  std::ifstream in(file);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty() && line.find_first_of("0123456789") == 0)
      last = line;
  LastRow row;
  double step = 0;
  char comma = 0;
  std::istringstream(last) >> step >> comma >> row.gap >> comma >> row.pressure >> comma >>
      row.kinetic;
  return row;
}

nlohmann::json describe(const Recipe &r, const std::vector<Body> &bodies, const BodyReport &report,
                        const std::vector<Particle> &particles, const PackingState &s,
                        const LastRow &end) {
  double am_mass = 0.0, cbd_mass = 0.0, sphericity = 0.0;
  for (const Particle &p : particles)
    (p.type == 1 ? am_mass : cbd_mass) +=
        p.density * 3.14159265358979 / 6.0 * std::pow(p.diameter, 3);
  for (const Body &b : bodies)
    sphericity += b.sphericity / bodies.size();
  const double h = r.thickness(), volume = r.area() * h;
  const double am = am_mass / r.am_density, cbd_solid = cbd_mass / r.cbd_solid_density;
  const double cbd_envelope = cbd_solid / (1.0 - r.nanoporosity);
  const double total = 1.0 - (am + cbd_solid) / volume;
  const double macro = 1.0 - (am + cbd_envelope) / volume;
  nlohmann::json j;
  j["name"] = r.settings.text("name");
  j["cell_um"] = {r.cell_x, r.cell_y};
  j["thickness_um"] = h;
  j["loading_mg_cm2"] = (am_mass + cbd_mass) / r.area() / 10.0;
  j["porosity_total"] = total;
  j["porosity_macro"] = macro;
  j["porosity_nano"] = total - macro;
  j["bodies"] = bodies.size();
  j["bodies_below_3_um"] = report.below_3_um;
  j["volume_fraction_cut_off_by_size_limit"] = report.volume_cut_off_fraction;
  j["sphericity_mean"] = sphericity;
  j["primaries"] = std::count_if(particles.begin(), particles.end(),
                                 [](const Particle &p) { return p.type == 1; });
  j["cbd"] = std::count_if(particles.begin(), particles.end(),
                           [](const Particle &p) { return p.type == 2; });
  j["bonds"] = bonds_by_distance(particles, r.cell_x, r.cell_y).size();
  j["largest_body_force_nN"] = s.largest_body_force_nN;
  j["largest_body_force_limit_nN"] = kForceLimit;
  j["largest_bond_strain"] = s.largest_bond_strain;
  j["cbd_overlap_mean"] = s.cbd_overlap_mean;
  j["cbd_overlap_max"] = s.cbd_overlap_max;
  j["highest_particle_um"] = s.highest_particle_um;
  j["platen_pressure_MPa"] = end.pressure;
  j["kinetic_energy_fJ"] = end.kinetic;
  j["recipe"] = r.settings.all();
  j["provenance"] = {{"calendem", version()}, {"seed", r.seed}};
  return j;
}

void check(const nlohmann::json &j, const Recipe &r, const std::string &folder) {
  Mistakes missed(folder);
  const double loading = j["loading_mg_cm2"], porosity = j["porosity_total"];
  if (std::fabs(loading / r.loading - 1.0) > 0.01)
    missed.add(0, fmt::format("loading {:.3f} mg/cm2 is more than 1 % off {}", loading, r.loading));
  if (std::fabs(porosity - r.porosity_total) > 0.005)
    missed.add(0, fmt::format("total porosity {:.4f} is more than half a point off {}", porosity,
                              r.porosity_total));
  const double force = j["largest_body_force_nN"], pressure = j["platen_pressure_MPa"];
  if (force > kForceLimit)
    missed.add(
        0,
        fmt::format("a force of {:.0f} nN between bodies exceeds {:.0f} nN (5 % of a 500 MPa bond)",
                    force, kForceLimit));
  if (pressure > kPressureLimit_MPa)
    missed.add(
        0,
        fmt::format("the platen still carries {:.3f} MPa; the limit is {} MPa. Lower the porosity "
                    "target's demand or take another seed",
                    pressure, kPressureLimit_MPa));
  if (!missed.empty())
    throw Failure(kCheckFailed, "the packing misses its targets; the files are kept for a look\n" +
                                    missed.text());
}

void densify(const PackOptions &o, const Placement &placement, const Recipe &r) {
  LiggghtsJob job;
  job.program = o.liggghts;
  job.ranks = o.ranks;
  job.script = input_scripts() + "/in.pack";
  job.log = o.folder + "/packing.log";
  job.screen = o.folder + "/packing.screen";
  job.variables = {{"out", o.folder}, {"scripts", input_scripts()}};
  const bool terminal = isatty(1);
  std::string shown;
  run_liggghts(job, [&] {
    const LastRow row = last_row(o.folder + "/packing.csv");
    const std::string text =
        fmt::format("packing: gap {:.1f} um of {:.1f}, platen {:.3f} MPa, kinetic {:.3g} fJ",
                    row.gap, r.thickness(), row.pressure, row.kinetic);
    if (row.gap > 0.0 && text != shown && terminal)
      std::cout << "\r\033[K" << text << std::flush;
    shown = text;
  });
  if (terminal)
    std::cout << "\r\033[K";
  (void)placement;
}

} // namespace

void pack_electrode(const Recipe &recipe, PackOptions o) {
  std::error_code error;
  o.folder = fs::absolute(o.folder).lexically_normal().string();
  fs::create_directories(o.folder, error);
  if (error)
    throw Failure(kBadInput,
                  fmt::format("cannot make the folder '{}': {}", o.folder, error.message()));
  std::string identity = version() + hash_of_file(input_scripts() + "/in.pack");
  for (const auto &[key, value] : recipe.settings.all())
    identity += key + "=" + value + "\n";
  identity = hash_of_text(identity);
  const std::string summary = o.folder + "/electrode.json";
  if (std::ifstream in(summary); in) {
    const nlohmann::json old = nlohmann::json::parse(in, nullptr, false);
    if (!old.is_discarded() && old.value("identity", "") == identity) {
      fmt::print("pack: {} already holds this electrode\n", o.folder);
      return;
    }
  }
  fs::remove(summary, error);
  const auto begin = std::chrono::steady_clock::now();
  BodyReport report;
  std::vector<Body> bodies = make_bodies(recipe, report);
  Placement placement = place(recipe, bodies);
  fmt::print("pack: {} bodies, {} particles, densifying from {:.0f} to {:.1f} um\n", bodies.size(),
             placement.particles.size(), placement.height, recipe.thickness());
  std::cout << std::flush;
  write_file(o.folder + "/start.data", data_file(recipe, placement.particles, placement.height));
  write_file(o.folder + "/bodies.map", body_map(placement.particles));
  write_file(o.folder + "/electrode.in", script_variables(recipe, recipe.thickness()));
  densify(o, placement, recipe);
  read_positions(o.folder + "/packed.dump", placement.particles);
  const PackingState state = examine(placement.particles, recipe);
  nlohmann::json j = describe(recipe, bodies, report, placement.particles, state,
                              last_row(o.folder + "/packing.csv"));
  const double height = std::max(recipe.thickness(), state.highest_particle_um) + 1.0;
  write_file(o.folder + "/electrode.data", data_file(recipe, placement.particles, height));
  write_file(o.folder + "/bodies.csv", bodies_table(bodies, placement.particles, recipe));
  j["wall_clock_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  fmt::print("pack: loading {:.2f} mg/cm2, total porosity {:.2f} %, platen {:.3f} MPa, largest "
             "force between "
             "bodies {:.0f} nN, {:.0f} s\n",
             j["loading_mg_cm2"].get<double>(), 100 * j["porosity_total"].get<double>(),
             j["platen_pressure_MPa"].get<double>(), state.largest_body_force_nN,
             j["wall_clock_s"].get<double>());
  try {
    check(j, recipe, o.folder);
  } catch (const Failure &) {
    write_file(o.folder + "/electrode.rejected.json", j.dump(2) + "\n");
    throw;
  }
  j["identity"] = identity;
  write_file(summary, j.dump(2) + "\n");
}

} // namespace calendem
