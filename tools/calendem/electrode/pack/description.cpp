// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/material_notes.h"
#include "base/provenance.h"
#include "electrode/pack/body.h"
#include "electrode/pack/electrode_files.h"
#include "electrode/pack/from_structure.h"
#include "electrode/pack/packing_state.h"
#include "physics/pi.h"
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace calendem {

namespace {

// 5 % of sigma_c A_b at the default strength of 500 MPa and lambda 1.
constexpr double kForceLimit_nN = 0.05 * 5e5 * kPi * 0.795 * 0.795;
constexpr double kPressureLimit_MPa = 0.1;
// The stress wave rho c v of this speed in active material is 0.1 MPa: c = sqrt(200 GPa / 4.65).
constexpr double kSpeedLimit_m_s = 0.0033;

double mass(const std::vector<Particle> &particles, int type) {
  double sum = 0.0;
  for (const Particle &p : particles)
    if (p.type == type)
      sum += p.density * kPi / 6.0 * std::pow(p.diameter, 3);
  return sum;
}

void add_composition(nlohmann::json &j, const FinishedPacking &f) {
  const Recipe &r = f.recipe;
  const double am_mass = mass(f.particles, 1), cbd_mass = mass(f.particles, 2);
  const double volume = r.area() * r.thickness();
  const double total = 1.0 - (am_mass / r.am_density + cbd_mass / r.cbd_solid_density) / volume;
  const Envelope envelope = measure_envelope(r, f.particles);
  const double macro = 1.0 - envelope.total / volume;
  j["cell_um"] = {r.cell_x, r.cell_y};
  j["thickness_um"] = r.thickness();
  j["loading_mg_cm2"] = (am_mass + cbd_mass) / r.area() / 10.0;
  j["porosity_total"] = total;
  j["porosity_macro"] = macro;
  j["porosity_nano"] = total - macro;
  j["am_envelope_overlap_fraction"] = 1.0 - envelope.am * r.am_density / am_mass;
}

// Spheres of a type by volume, from the lowest place that they can have to the highest: their slope
// and shares by fifths.
std::pair<double, std::vector<double>> over_height(const FinishedPacking &f, int type) {
  std::vector<double> fifths(5, 0.0);
  double sum = 0.0, moment = 0.0;
  for (const Particle &p : f.particles) {
    if (p.type != type)
      continue;
    const double volume = std::pow(p.diameter, 3);
    const double z = (p.x.z() - 0.5 * p.diameter) / (f.recipe.thickness() - p.diameter);
    fifths[std::clamp(int(5.0 * z), 0, 4)] += volume;
    moment += volume * z;
    sum += volume;
  }
  for (double &share : fifths)
    share /= sum;
  return {CbdGradient::slope_of(moment / sum), fifths};
}

nlohmann::json cbd_profile(const FinishedPacking &f) {
  const auto n = std::count_if(f.particles.begin(), f.particles.end(),
                               [](const Particle &p) { return p.type == 2; });
  if (n == 0)
    return nullptr;
  const auto [slope, fifths] = over_height(f, 2);
  return {{"slope", slope},
          {"slope_asked", f.recipe.cbd_gradient.slope},
          {"slope_scatter", f.recipe.cbd_gradient.scatter(double(n))},
          {"slope_of_am", over_height(f, 1).first},
          {"share_by_fifths_of_height", fifths}};
}

// Counts in classes of 0.02 from 0.7; below goes into the first.
nlohmann::json sphericity_histogram(const std::vector<Body> &bodies) {
  std::vector<int> count(15, 0);
  for (const Body &b : bodies)
    ++count[std::clamp(int(std::floor((b.sphericity - 0.7) / 0.02)), 0, 14)];
  return {{"from", 0.7}, {"step", 0.02}, {"count", count}};
}

// Cosine of the angle between `axis` and the lattice axis nearest to it, averaged over bodies of
// two primaries and more; (3/4) tan... for random orientation it is 0.831 in every direction.
double nearest_axis_cosine(const FinishedPacking &f, const Eigen::Vector3d &axis) {
  double sum = 0.0;
  int bodies = 0;
  for (size_t k = 0; k < f.bodies.size(); ++k)
    if (f.bodies[k].primaries.size() > 1) {
      sum += (f.poses[k].turn.conjugate() * axis).cwiseAbs().maxCoeff();
      ++bodies;
    }
  return bodies ? sum / bodies : 0.0;
}

void add_bodies(nlohmann::json &j, const FinishedPacking &f) {
  int single = 0, small = 0, redrawn = 0;
  double sphericity = 0.0, widest = 0.0, distortion = 0.0;
  for (size_t k = 0; k < f.bodies.size(); ++k) {
    const Body &b = f.bodies[k];
    single += b.primaries.size() == 1;
    small += b.volume < kPi / 6.0 * 27.0;
    redrawn += b.redrawn > 0;
    sphericity += b.sphericity / double(f.bodies.size());
    widest = std::max(widest, b.width);
    distortion = std::max(distortion, f.poses[k].distortion);
  }
  const SizeLaw law = measured_law(f.recipe);
  j["bodies"] = f.bodies.size();
  j["bodies_below_3_um"] = small;
  j["bodies_of_one_primary"] = single;
  j["note_small_bodies"] = "bodies below 3 um are made of 1-7 primaries, those below one lattice "
                           "cell of one; their volume is rounded to whole cells, the total is kept";
  j[kLargestAllowed] = f.recipe.largest_body();
  j[kCutOff] = law.volume_above(f.recipe.largest_body());
  j["largest_width_um"] = widest;
  j["shapes_redrawn_for_width"] = redrawn;
  j["sphericity_mean"] = sphericity;
  j["sphericity_how"] = "surface of the sphere of equal volume over the surface of the smooth "
                        "shape the primaries fill";
  j["sphericity_histogram"] = sphericity_histogram(f.bodies);
  double facets = 0.0;
  int of_grains = 0;
  for (const Body &b : f.bodies) {
    facets += b.facet * int(b.primaries.size());
    of_grains += int(b.primaries.size());
  }
  j["facet_um2"] = facets / of_grains;
  if (f.recipe.grains == GrainShape::Lattice)
    j["lattice_nearest_axis_cosine"] = {{"x", nearest_axis_cosine(f, Eigen::Vector3d::UnitX())},
                                        {"y", nearest_axis_cosine(f, Eigen::Vector3d::UnitY())},
                                        {"z", nearest_axis_cosine(f, Eigen::Vector3d::UnitZ())},
                                        {"random", 0.831}};
  j["largest_distortion_um"] = distortion;
}

void add_state(nlohmann::json &j, const FinishedPacking &f) {
  const auto overlaps = [](const Overlaps &o) {
    return nlohmann::json{{"pairs", o.pairs}, {"mean", o.mean}, {"largest", o.largest}};
  };
  const PackingState &s = f.state;
  const double total_mass = mass(f.particles, 1) + mass(f.particles, 2);
  j["primaries"] = std::count_if(f.particles.begin(), f.particles.end(),
                                 [](const Particle &p) { return p.type == 1; });
  j["cbd"] = std::count_if(f.particles.begin(), f.particles.end(),
                           [](const Particle &p) { return p.type == 2; });
  j["cbd_over_height"] = cbd_profile(f);
  j["bonds"] = s.bonds;
  j["pairs_as_made"] = s.pairs_as_made;
  j["pairs_changed"] = s.pairs_changed;
  j["largest_bond_strain"] = s.bond_strain;
  j["largest_body_force_nN"] = s.body_force_nN;
  j["largest_body_force_limit_nN"] = kForceLimit_nN;
  j["largest_am_cbd_force_nN"] = s.am_cbd_force_nN;
  j["film_stress_MPa"] = s.film_stress_MPa;
  j["cbd_overlap_over_radius"] = {{"cbd_cbd", overlaps(s.cbd_cbd)}, {"cbd_am", overlaps(s.cbd_am)}};
  j["highest_particle_um"] = s.highest_um;
  j["platen_pressure_MPa"] = f.end.pressure_MPa + 0.0;
  j["kinetic_energy_fJ"] = f.end.kinetic_fJ;
  j["rms_speed_m_s"] = std::sqrt(2.0 * f.end.kinetic_fJ / total_mass);
}

} // namespace

LastRow last_row(const std::string &file) {
  std::ifstream in(file);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty() && line.find_first_of("0123456789") == 0)
      last = line;
  LastRow row;
  double step = 0;
  char comma = 0;
  std::istringstream(last) >> step >> comma >> row.gap_um >> comma >> row.pressure_MPa >> comma >>
      row.kinetic_fJ;
  return row;
}

nlohmann::json describe(const FinishedPacking &f) {
  nlohmann::json j;
  j["name"] = f.recipe.settings.text("name");
  add_composition(j, f);
  add_bodies(j, f);
  add_state(j, f);
  j["recipe"] = f.recipe.settings.all();
  j["provenance"] = {{"calendem", version()}, {"seed", f.recipe.seed}};
  return j;
}

void check_targets(const nlohmann::json &j, const Recipe &r, const std::string &folder) {
  Mistakes missed(folder);
  const auto at_most = [&](const char *what, double value, double limit, const char *advice) {
    if (!(value <= limit))
      missed.add(
          0, fmt::format("{} {:.4g}; at most {:.4g} is allowed. {}", what, value, limit, advice));
  };
  const char *size = "Make the cell larger: whole particles cannot come nearer to the target.";
  const char *longer = "Let it relax longer (relax_most in in.pack) or take another seed.";
  const char *other = "Take another seed.";
  at_most("relative error of the loading is",
          std::fabs(j["loading_mg_cm2"].get<double>() / r.loading - 1.0), 0.01, size);
  at_most("error of the total porosity is",
          std::fabs(j["porosity_total"].get<double>() - r.porosity_total), 0.005, size);
  at_most("the largest force between bodies in nN is (limit: 5 % of a 500 MPa bond)",
          j["largest_body_force_nN"], kForceLimit_nN, longer);
  at_most("the pressure on the platen in MPa is", j["platen_pressure_MPa"], kPressureLimit_MPa,
          "The film is jammed at this thickness: raise porosity_total_percent or relax longer.");
  at_most("the rms speed in m/s is", j["rms_speed_m_s"], kSpeedLimit_m_s, longer);
  at_most("bonds that the bodies as made do not have, or lack:", j["pairs_changed"], 0, other);
  if (!missed.empty())
    throw Failure(kCheckFailed, "the packing misses its targets; its files are kept for "
                                "inspection, but electrode.json is not written\n" +
                                    missed.text());
}

namespace {

double mass_of(const std::vector<Particle> &particles, int type) {
  double sum = 0.0;
  for (const Particle &p : particles)
    if (p.type == type)
      sum += p.density * kPi / 6.0 * std::pow(p.diameter, 3);
  return sum;
}

// Each id of the structure's active material in one body, once.
bool each_once(const ExistingStructure &structure, const BodiesOfStructure &given) {
  std::multiset<long> in, out;
  for (const ExistingSphere &p : structure.am)
    in.insert(p.id);
  for (const std::vector<long> &ids : given.ids)
    out.insert(ids.begin(), ids.end());
  return in == out;
}

struct Moves {
  double rms = 0.0, largest = 0.0;
};

// Centres of the bodies against the structure's, its heights scaled to the film's thickness.
Moves moves_of(const Recipe &r, const ExistingStructure &structure, const BodiesOfStructure &given,
               const std::vector<Pose> &poses) {
  Moves m;
  const Eigen::Vector3d scale(1.0, 1.0, r.thickness() / structure.extent);
  for (size_t k = 0; k < poses.size(); ++k) {
    const double d =
        periodic_difference(r, poses[k].centre, given.at[k].cwiseProduct(scale)).norm();
    m.rms += d * d / double(poses.size());
    m.largest = std::max(m.largest, d);
  }
  m.rms = std::sqrt(m.rms);
  return m;
}

} // namespace

nlohmann::json describe_structure(const Recipe &r, const ExistingStructure &structure,
                                  const BodiesOfStructure &given,
                                  const PlacementOfStructure &placed,
                                  const std::vector<Pose> &poses,
                                  const std::vector<Particle> &particles) {
  const Moves moves = moves_of(r, structure, given, poses);
  const auto of_type = [&](int type) {
    return std::count_if(particles.begin(), particles.end(),
                         [&](const Particle &p) { return p.type == type; });
  };
  return {{"source", std::filesystem::path(r.structure.file).filename().string()},
          {"source_hash", hash_of_structure(r.structure)},
          {"bodies", r.structure.clusters ? "clusters" : "shapes"},
          {"am_particles_in", structure.am.size()},
          {"am_particles_out", r.structure.clusters ? of_type(1) : long(given.bodies.size())},
          {"each_am_particle_once", each_once(structure, given)},
          {"cbd_in", structure.cbd.size()},
          {"cbd_out", of_type(2)},
          {"left_out", structure.left_out},
          {"am_mass_in_pg", am_mass(r, structure)},
          {"am_mass_out_pg", mass_of(particles, 1)},
          {"primary_mass_pg", r.am_density * std::pow(r.lattice, 3)},
          {"cbd_mass_in_pg", cbd_mass(r, structure)},
          {"cbd_mass_out_pg", mass_of(particles, 2)},
          {"thickness_um", structure.thickness},
          {"stretch", placed.stretch},
          {"moved_to_be_free", placed.moved},
          {"largest_move_to_be_free_um", placed.largest_move_um},
          {"bodies_moved_rms_um", moves.rms},
          {"bodies_moved_at_most_um", moves.largest},
          {"moved_how", "from the places in the structure, its heights scaled to the thickness"}};
}

std::string structure_table(const ExistingStructure &structure, const BodiesOfStructure &given) {
  struct Became {
    size_t body = 0, first = 0, last = 0; ///< tags
  };
  std::map<long, Became> became;
  size_t tag = 1;
  for (size_t k = 0; k < given.bodies.size(); ++k) {
    const size_t n = given.bodies[k].primaries.size();
    const bool one = given.ids[k].size() == 1;
    for (size_t m = 0; m < given.ids[k].size(); ++m)
      became[given.ids[k][m]] = {k + 1, tag + m, one ? tag + n - 1 : tag + m};
    tag += n;
  }
  std::string out = "id,type,diameter_um,density_g_cm3,x_um,y_um,z_um,body,first_tag,last_tag\n";
  const auto row = [&](const ExistingSphere &p, const Became &b) {
    out += fmt::format("{},{},{:.6g},{:.6g},{:.6f},{:.6f},{:.6f},{},{},{}\n", p.id, p.type,
                       p.diameter, p.density, p.x.x(), p.x.y(), p.x.z(), b.body, b.first, b.last);
  };
  for (const ExistingSphere &p : structure.am)
    row(p, became[p.id]);
  for (const ExistingSphere &p : structure.cbd) {
    row(p, {0, tag, tag});
    ++tag;
  }
  return out;
}

void check_kept(const nlohmann::json &j, const std::string &folder) {
  Mistakes lost(folder);
  for (const char *phase : {"am_particles", "cbd"}) {
    const long in = j[phase + std::string("_in")], out = j[phase + std::string("_out")];
    if (in != out)
      lost.add(0, fmt::format("{}: {} in the structure, {} in the electrode.", phase, in, out));
  }
  if (!j["each_am_particle_once"].get<bool>())
    lost.add(0, "a particle of the active material is in no body or in two.");
  const double am = j["am_mass_out_pg"].get<double>() - j["am_mass_in_pg"].get<double>();
  const double cbd_in = j["cbd_mass_in_pg"], cbd = j["cbd_mass_out_pg"].get<double>() - cbd_in;
  const double primary = j["primary_mass_pg"];
  if (!(std::fabs(am) <= 0.5001 * primary))
    lost.add(0,
             fmt::format("the active material's mass differs by {:.4g} pg; half a primary, {:.4g} "
                         "pg, is allowed.",
                         am, 0.5 * primary));
  if (!(std::fabs(cbd) <= 1e-9 * cbd_in))
    lost.add(0, fmt::format("the mass of CBD differs by {:.4g} of {:.4g} pg.", cbd, cbd_in));
  if (!lost.empty())
    throw Failure(kCheckFailed,
                  "particles of the structure were lost or doubled; this is a fault of "
                  "calendem, please report it with the structure\n" +
                      lost.text());
}

} // namespace calendem
