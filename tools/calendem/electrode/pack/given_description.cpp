// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/given_description.h"
#include "base/pi.h"
#include "base/provenance.h"
#include "electrode/pack/given_recipe.h"
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace calendem {
namespace {

double mass_of(const std::vector<Particle> &particles, int type) {
  double sum = 0.0;
  for (const Particle &p : particles)
    if (p.type == type)
      sum += p.density * kPi / 6.0 * std::pow(p.diameter, 3);
  return sum;
}

// Each id of the structure's active material in one body, once.
bool each_once(const GivenStructure &structure, const GivenBodies &given) {
  std::multiset<long> in, out;
  for (const GivenSphere &p : structure.am)
    in.insert(p.id);
  for (const std::vector<long> &ids : given.ids)
    out.insert(ids.begin(), ids.end());
  return in == out;
}

struct Moves {
  double rms = 0.0, largest = 0.0;
};

// Centres of the bodies against the structure's, its heights scaled to the film's thickness.
Moves moves_of(const Recipe &r, const GivenStructure &structure, const GivenBodies &given,
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

nlohmann::json describe_structure(const Recipe &r, const GivenStructure &structure,
                                  const GivenBodies &given, const GivenPlacement &placed,
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

std::string structure_table(const GivenStructure &structure, const GivenBodies &given) {
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
  const auto row = [&](const GivenSphere &p, const Became &b) {
    out += fmt::format("{},{},{:.6g},{:.6g},{:.6f},{:.6f},{:.6f},{},{},{}\n", p.id, p.type,
                       p.diameter, p.density, p.x.x(), p.x.y(), p.x.z(), b.body, b.first, b.last);
  };
  for (const GivenSphere &p : structure.am)
    row(p, became[p.id]);
  for (const GivenSphere &p : structure.cbd) {
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
