// SPDX-License-Identifier: GPL-2.0-or-later
#include "pack/description.h"
#include "pack/envelope.h"
#include "pack/sizes.h"
#include "spec/pi.h"
#include "spec/provenance.h"
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
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
  const Envelope envelope = measure_envelope(r, f.particles, f.poses);
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
  j["largest_equivalent_diameter_allowed_um"] = f.recipe.largest_body();
  j["volume_fraction_cut_off_by_size_limit"] = law.volume_above(f.recipe.largest_body());
  j["largest_width_um"] = widest;
  j["shapes_redrawn_for_width"] = redrawn;
  j["sphericity_mean"] = sphericity;
  j["sphericity_how"] = "surface of the sphere of equal volume over the surface of the smooth "
                        "shape the primaries fill";
  j["sphericity_histogram"] = sphericity_histogram(f.bodies);
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
  j["lattice_pairs"] = s.lattice_pairs;
  j["largest_bond_strain"] = s.bond_strain;
  j["largest_body_force_nN"] = s.body_force_nN;
  j["largest_body_force_limit_nN"] = kForceLimit_nN;
  j["largest_am_cbd_force_nN"] = s.am_cbd_force_nN;
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
  const int bonds = j["bonds"], pairs = j["lattice_pairs"];
  at_most("bonds that are not the lattice's:", std::abs(bonds - pairs), 0, other);
  if (!missed.empty())
    throw Failure(kCheckFailed, "the packing misses its targets; its files are kept for a look, "
                                "but electrode.json is not written\n" +
                                    missed.text());
}

} // namespace calendem
