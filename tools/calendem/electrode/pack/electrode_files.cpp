// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/electrode_files.h"
#include "effects/settings.h"
#include "physics/pi.h"
#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace calendem {
namespace {

// A VTK data array of one value per particle.
template <class Value>
std::string array(const char *attributes, const std::vector<Particle> &particles, Value value) {
  std::string out = fmt::format("<DataArray {} format=\"ascii\">\n", attributes);
  for (const Particle &p : particles)
    out += value(p) + "\n";
  return out + "</DataArray>\n";
}

} // namespace

std::string data_file(const Recipe &recipe, const std::vector<Particle> &particles, double height,
                      const std::string &heading) {
  std::string out =
      fmt::format("{}; micro units: id type diameter density x y z\n\n"
                  "{} atoms\n4 atom types\n\n0 {} xlo xhi\n0 {} ylo yhi\n0 {} zlo zhi\n\n"
                  "Atoms\n\n",
                  heading, particles.size(), recipe.cell_x, recipe.cell_y, height);
  for (const Particle &p : particles)
    out += fmt::format("{} {} {} {:.12g} {:.12g} {:.12g} {:.12g}\n", p.tag, p.type, p.diameter,
                       p.density, p.x.x(), p.x.y(), p.x.z());
  return out;
}

std::string body_map(const std::vector<Particle> &particles) {
  std::string rows;
  size_t n = 0;
  for (const Particle &p : particles)
    if (p.body > 0) {
      rows += fmt::format("{} {}\n", p.tag, p.body);
      ++n;
    }
  return fmt::format("# tag body, {} rows\n", n) + rows;
}

std::string script_variables(const Recipe &r, double thickness) {
  const double solid = r.area() * (r.am_column() + r.cbd_solid_column());
  std::string material = fmt::format("# its material, {}; -var NAME VALUE is stronger\n",
                                     r.material.given() ? r.material.name : "of the defaults");
  for (const Key &key : case_keys())
    if (const auto at = r.material.values.find(key.name);
        at != r.material.values.end() && !key.variable.empty())
      material += fmt::format("variable {} index {}\n", key.variable, at->second.text);
  return fmt::format(
      "# what the input scripts need to know of this electrode\n"
      "variable thickness_um equal {:.10g}\nvariable area_um2 equal {:.10g}\n"
      "variable solid_volume_um3 equal {:.10g}\nvariable primary_diameter_um equal {}\n"
      "variable lattice_um equal {}\nvariable cbd_diameter_um equal {}\n{}",
      thickness, r.area(), solid, r.primary_diameter, r.lattice, r.cbd_diameter, material);
}

std::string bodies_table(const std::vector<Body> &bodies, const std::vector<Pose> &poses,
                         const PackingState &state) {
  std::string out = "body,primaries,bonds,volume_um3,equivalent_diameter_um,width_um,sphericity,"
                    "x_um,y_um,z_um,quat_w,quat_x,quat_y,quat_z\n";
  for (size_t k = 0; k < bodies.size(); ++k) {
    const Body &b = bodies[k];
    const Eigen::Vector3d &c = poses[k].centre;
    const Eigen::Quaterniond &q = poses[k].turn;
    out += fmt::format("{},{},{},{:.6g},{:.6g},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},"
                       "{:.6f},{:.6f}\n",
                       k + 1, b.primaries.size(), state.body_bonds[k], b.volume,
                       std::cbrt(6.0 / kPi * b.volume), b.width, b.sphericity, c.x(), c.y(), c.z(),
                       q.w(), q.x(), q.y(), q.z());
  }
  return out;
}

std::string picture_file(const std::vector<Particle> &particles) {
  std::string out = fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" "
                                "version=\"0.1\">\n<PolyData>\n<Piece NumberOfPoints=\"{0}\" "
                                "NumberOfVerts=\"{0}\">\n<Points>\n",
                                particles.size());
  out += array("type=\"Float64\" NumberOfComponents=\"3\"", particles, [](const Particle &p) {
    return fmt::format("{:.9g} {:.9g} {:.9g}", p.x.x(), p.x.y(), p.x.z());
  });
  out += "</Points>\n<Verts>\n";
  out += array("type=\"Int32\" Name=\"connectivity\"", particles,
               [](const Particle &p) { return fmt::format("{}", p.tag - 1); });
  out += array("type=\"Int32\" Name=\"offsets\"", particles,
               [](const Particle &p) { return fmt::format("{}", p.tag); });
  out += "</Verts>\n<PointData>\n";
  out += array("type=\"Int32\" Name=\"id\"", particles,
               [](const Particle &p) { return fmt::format("{}", p.tag); });
  out += array("type=\"Int32\" Name=\"type\"", particles,
               [](const Particle &p) { return fmt::format("{}", p.type); });
  out += array("type=\"Int32\" Name=\"body\"", particles,
               [](const Particle &p) { return fmt::format("{}", p.body); });
  out += array("type=\"Float64\" Name=\"radius\"", particles,
               [](const Particle &p) { return fmt::format("{:.6g}", 0.5 * p.diameter); });
  return out + "</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

void read_positions(const std::string &dump, std::vector<Particle> &particles) {
  std::ifstream in(dump);
  std::string line;
  while (std::getline(in, line) && line.rfind("ITEM: ATOMS", 0) != 0)
    ;
  std::vector<bool> seen(particles.size(), false);
  while (std::getline(in, line)) {
    std::istringstream row(line);
    int tag = 0;
    Eigen::Vector3d x;
    if (!(row >> tag >> x.x() >> x.y() >> x.z()) || tag < 1 ||
        tag > static_cast<int>(particles.size()))
      continue;
    if (seen[tag - 1])
      throw Failure(kSimulationFailed,
                    fmt::format("'{}' holds particle {} twice: the simulation doubled it, or two "
                                "wrote the file at once",
                                dump, tag));
    particles[tag - 1].x = x;
    seen[tag - 1] = true;
  }
  const size_t found = size_t(std::count(seen.begin(), seen.end(), true));
  if (found != particles.size())
    throw Failure(
        kSimulationFailed,
        fmt::format("'{}' holds {} of {} spheres: the packing lost some, or the file is cut", dump,
                    found, particles.size()));
}

} // namespace calendem
