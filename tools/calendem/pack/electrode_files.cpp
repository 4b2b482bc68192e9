// SPDX-License-Identifier: GPL-2.0-or-later
#include "pack/electrode_files.h"
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <sstream>

namespace calendem {
namespace {

// Length of a periodic side as it comes nearest: -L/2 ... L/2.
double nearest(double d, double side) { return d - side * std::round(d / side); }

} // namespace

std::string data_file(const Recipe &recipe, const std::vector<Particle> &particles, double height) {
  std::string out =
      fmt::format("Electrode made by calendem pack; micro units: id type diameter density x y z\n\n"
                  "{} atoms\n4 atom types\n\n0 {} xlo xhi\n0 {} ylo yhi\n0 {} zlo zhi\n\n"
                  "Atoms\n\n",
                  particles.size(), recipe.cell_x, recipe.cell_y, height);
  for (const Particle &p : particles)
    out += fmt::format("{} {} {} {:.12g} {:.12g} {:.12g} {:.12g}\n", p.tag, p.type, p.diameter,
                       p.density, p.x.x(), p.x.y(), p.x.z());
  return out;
}

std::string body_map(const std::vector<Particle> &particles) {
  std::string out = "# tag body\n";
  for (const Particle &p : particles)
    if (p.body > 0)
      out += fmt::format("{} {}\n", p.tag, p.body);
  return out;
}

std::string script_variables(const Recipe &r, double thickness) {
  const double solid = r.area() * (r.am_column() + r.cbd_solid_column());
  return fmt::format(
      "# what the input scripts need to know of this electrode\n"
      "variable thickness_um equal {:.10g}\nvariable area_um2 equal {:.10g}\n"
      "variable solid_volume_um3 equal {:.10g}\nvariable primary_diameter_um equal {}\n"
      "variable lattice_um equal {}\nvariable cbd_diameter_um equal {}\n",
      thickness, r.area(), solid, r.primary_diameter, r.lattice, r.cbd_diameter);
}

std::string bodies_table(const std::vector<Body> &bodies, const std::vector<Particle> &particles,
                         const Recipe &recipe) {
  std::map<int, int> bonds;
  for (const auto &[i, j] : bonds_by_distance(particles, recipe.cell_x, recipe.cell_y))
    ++bonds[particles[i].body];
  std::map<int, double> depth;
  for (const Particle &p : particles)
    if (p.body > 0)
      depth[p.body] += p.x.z() / bodies[p.body - 1].primaries.size();
  std::string out =
      "body,primaries,bonds,volume_um3,equivalent_diameter_um,sphericity,z_um,quat_w,quat_x,"
      "quat_y,quat_z\n";
  for (size_t k = 0; k < bodies.size(); ++k) {
    const Body &b = bodies[k];
    const int n = static_cast<int>(k) + 1;
    out += fmt::format("{},{},{},{:.6g},{:.6g},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f}\n", n,
                       b.primaries.size(), bonds[n], b.volume,
                       std::cbrt(6.0 / 3.14159265358979 * b.volume), b.sphericity, depth[n],
                       b.lattice.w(), b.lattice.x(), b.lattice.y(), b.lattice.z());
  }
  return out;
}

void read_positions(const std::string &dump, std::vector<Particle> &particles) {
  std::ifstream in(dump);
  std::string line;
  while (std::getline(in, line) && line.rfind("ITEM: ATOMS", 0) != 0)
    ;
  size_t found = 0;
  while (std::getline(in, line)) {
    std::istringstream row(line);
    int tag = 0;
    Eigen::Vector3d x;
    if (!(row >> tag >> x.x() >> x.y() >> x.z()) || tag < 1 ||
        tag > static_cast<int>(particles.size()))
      continue;
    particles[tag - 1].x = x;
    ++found;
  }
  if (found != particles.size())
    throw Failure(
        kSimulationFailed,
        fmt::format("'{}' holds {} of {} particles: the packing lost some, or the file is cut",
                    dump, found, particles.size()));
}

std::vector<std::pair<int, int>> bonds_by_distance(const std::vector<Particle> &particles,
                                                   double lx, double ly) {
  std::map<int, std::vector<int>> members;
  for (size_t i = 0; i < particles.size(); ++i)
    if (particles[i].body > 0)
      members[particles[i].body].push_back(static_cast<int>(i));
  std::vector<std::pair<int, int>> bonds;
  for (const auto &[body, list] : members)
    for (size_t a = 0; a < list.size(); ++a)
      for (size_t b = a + 1; b < list.size(); ++b) {
        const Particle &p = particles[list[a]], &q = particles[list[b]];
        const Eigen::Vector3d d(nearest(p.x.x() - q.x.x(), lx), nearest(p.x.y() - q.x.y(), ly),
                                p.x.z() - q.x.z());
        if (d.norm() < 0.5 * (p.diameter + q.diameter))
          bonds.emplace_back(list[a], list[b]);
      }
  return bonds;
}

} // namespace calendem
