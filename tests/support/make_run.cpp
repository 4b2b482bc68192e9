// SPDX-License-Identifier: GPL-2.0-or-later
#include "support/make_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "simulate/fracture.h"

namespace calendem::tests {
namespace {

namespace fs = std::filesystem;

constexpr double kThickness = 76.5, kSpacing = 1.28, kPrimary = 0.795, kCbd = 0.658; // um
constexpr double kTouch = 9, kTravel = 26, kSpringback = 4;                          // um
constexpr double kSpeed = 1;                                                         // um/us

struct Sphere {
  double x, y, z, radius;
  int type, body;
};
struct Bond {
  int i, j;
  double breaks_at; ///< pressure [MPa]
  int mode;         ///< 1 tension, 2 bending, 3 shear, 4 torsion
};
struct Film {
  std::vector<Sphere> spheres;
  std::vector<Bond> bonds;
};

struct Row {
  double time, displacement, pressure, seen; ///< seen: largest pressure so far
  const char *stage;
};

/// std's distributions differ between libraries; this does not.
double uniform(std::mt19937 &random) { return static_cast<double>(random()) / 4294967296.0; }

void add_body(int body, const Sphere &centre, std::mt19937 &random, const MadeRun &options,
              Film &film) {
  const double reach = centre.radius, broken = options.broken_at_max;
  const std::size_t first = film.spheres.size();
  const int n = static_cast<int>(reach / kSpacing);
  for (int a = -n; a <= n; ++a)
    for (int b = -n; b <= n; ++b)
      for (int c = -n; c <= n; ++c)
        if (std::sqrt(a * a + b * b + c * c) * kSpacing <= reach)
          film.spheres.push_back({centre.x + a * kSpacing, centre.y + b * kSpacing,
                                  centre.z + c * kSpacing, kPrimary, 1, body});
  for (std::size_t i = first; i < film.spheres.size(); ++i)
    for (std::size_t j = i + 1; j < film.spheres.size(); ++j) {
      const Sphere &p = film.spheres[i], &q = film.spheres[j];
      if (std::hypot(p.x - q.x, p.y - q.y, p.z - q.z) > 1.01 * kSpacing)
        continue;
      const double share = uniform(random) / broken; // of max pressure ^ 0.6
      film.bonds.push_back({static_cast<int>(i) + 1, static_cast<int>(j) + 1,
                            options.max_pressure_MPa * std::pow(share, 1 / 0.6),
                            1 + static_cast<int>(4 * std::pow(uniform(random), 1.6))});
    }
}

Film make_film(const MadeRun &options) {
  Film film;
  std::mt19937 random(7);
  for (int body = 1; body <= options.bodies; ++body) {
    const double reach = 1.6 + 2.6 * std::pow(uniform(random), 2);
    const double z = reach + (kThickness - 2 * reach) * (body - 0.5) / options.bodies;
    add_body(body,
             {options.cell_um * uniform(random), options.cell_um * uniform(random), z, reach, 1, 0},
             random, options, film);
  }
  for (int k = 0; k < 12 * options.bodies; ++k)
    film.spheres.push_back({options.cell_um * uniform(random), options.cell_um * uniform(random),
                            kCbd + (kThickness - 2 * kCbd) * uniform(random), kCbd, 2, 0});
  return film;
}

double pressure_at(double displacement, bool loading, double max_pressure) {
  const double start = loading ? kTouch : kTravel - kSpringback;
  const double share = std::max(0.0, (displacement - start) / (kTravel - start));
  return max_pressure * std::pow(share, loading ? 2.4 : 1.7);
}

std::vector<Row> make_rows(const MadeRun &options) {
  std::vector<Row> rows;
  double seen = 0;
  const double way = kTravel + (options.finished ? kSpringback + 1.0 : -8.0);
  for (int i = 0; i < options.rows; ++i) {
    const double step = way / (options.rows - 1);
    const double on_grid = i * step;
    const bool at_turn = std::abs(on_grid - kTravel) < 0.5 * step; // a row at the maximum itself
    const double path = at_turn ? kTravel : on_grid;
    const bool loading = path <= kTravel;
    const double d = loading ? path : 2 * kTravel - path;
    const double p = pressure_at(d, loading, options.max_pressure_MPa);
    seen = std::max(seen, p);
    rows.push_back({path / kSpeed, d, p, seen, loading ? "compression" : "relaxation"});
  }
  return rows;
}

std::array<int, 5> broken(const Film &film, double seen) {
  std::array<int, 5> count{};
  for (const auto &bond : film.bonds)
    if (bond.breaks_at < seen) {
      ++count[0];
      ++count[static_cast<std::size_t>(bond.mode)];
    }
  return count;
}

double porosity(double thickness) { return 1 - 0.5203 * kThickness / thickness; }

void write_curve(const fs::path &file, const Film &film, const std::vector<Row> &rows) {
  std::ofstream out(file);
  out << "time_us,stage,displacement_um,thickness_um,pressure_MPa,pressure_bottom_MPa,"
         "bonds_broken,broken_fraction,broken_tension,broken_bending,broken_shear,broken_torsion,"
         "porosity_total,porosity_macro,kinetic_to_strain,work_platen_fJ,strain_fJ,"
         "work_bonds_lost_fJ,damped_fJ,kinetic_fJ,inertial_number,kinetic_to_elastic,"
         "force_beyond_0.1_R,force_beyond_0.2_R,force_beyond_0.3_R\n";
  double work = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row &r = rows[i];
    if (i > 0)
      work += 0.5 * (r.pressure + rows[i - 1].pressure) * 225e3 *
              (r.displacement - rows[i - 1].displacement);
    const auto count = broken(film, r.seen);
    const double h = kThickness - r.displacement, elastic = 2.2e5 * r.pressure * r.pressure / 60;
    const double lost = 900.0 * count[0];
    out << r.time << ',' << r.stage << ',' << r.displacement << ',' << h << ',' << r.pressure << ','
        << r.pressure * (1 + 0.03 * std::sin(2 * r.time)) << ',' << count[0] << ','
        << static_cast<double>(count[0]) / static_cast<double>(film.bonds.size());
    for (int mode = 1; mode <= 4; ++mode)
      out << ',' << count[static_cast<std::size_t>(mode)];
    out << ',' << porosity(h) << ',' << porosity(h) - 0.04 * kThickness / h << ",0.002," << work
        << ',' << elastic << ',' << lost << ',' << std::max(0.0, work - elastic - lost) << ','
        << 2e-3 * elastic << ',' << 2e-3 / std::sqrt(1 + r.pressure) << ",0.002";
    for (const double at : {60, 200, 600})
      out << ',' << r.pressure / (r.pressure + at);
    out << '\n';
  }
}

nlohmann::json made_contacts() {
  const nlohmann::json all = {{"contacts", 4000},
                              {"force_nN", 4.4e7},
                              {"overlap_mean", 0.12},
                              {"overlap_largest", 0.61},
                              {"contacts_beyond_0.1_R", 0.5},
                              {"contacts_beyond_0.2_R", 0.25},
                              {"contacts_beyond_0.3_R", 0.125},
                              {"force_beyond_0.1_R", 0.714},
                              {"force_beyond_0.2_R", 0.429},
                              {"force_beyond_0.3_R", 0.2},
                              {"force_beyond_law", 0.15}};
  return {{"all", all}, {"am_cbd", all}};
}

void write_summary(const fs::path &file, const Film &film, const MadeRun &options) {
  const double after = kThickness - kTravel + kSpringback;
  const auto count = broken(film, options.max_pressure_MPa);
  const nlohmann::json summary = {
      {"finished", true},
      {"max_pressure_MPa", options.max_pressure_MPa},
      {"porosity_after_relaxation", porosity(after)},
      {"thickness_after_relaxation_um", after},
      {"broken_fraction_at_max",
       static_cast<double>(count[0]) / static_cast<double>(film.bonds.size())},
      {"springback", kSpringback / (kThickness - kTravel)},
      {"bonds_initial", film.bonds.size()},
      {"bodies", options.bodies},
      {"cracked_bodies", options.bodies / 5},
      {"quasi_static", true},
      {"contact_range", {{"at_max_pressure", made_contacts()}}},
      {"energy", {{"work_platen_fJ", 1.1e8}, {"damped_fJ", 4.0e7}}},
      {"wall_clock_s", 512.3},
      {"atom_steps_per_second", 2.1e6},
      {"provenance",
       {{"version", "0.1"}, {"command", "made by tests/support/make_run"}, {"seed", 7}}}};
  std::ofstream(file) << summary.dump(1) << '\n';
}

/// When the bond breaks: at the first row that has seen its pressure.
double break_time(const Bond &bond, const std::vector<Row> &rows) {
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const Row &r) { return bond.breaks_at < r.seen; });
  return row == rows.end() ? HUGE_VAL : row->time;
}

/// bodies.csv, cracks.csv, thresholds.csv as `calendem run` would write them.
void write_fracture(const fs::path &directory, const Film &film, const std::vector<Row> &rows,
                    const MadeRun &options) {
  std::vector<BodyBonds> bodies(options.bodies);
  std::vector<int> place;
  std::vector<double> height(options.bodies, 0.0);
  for (const Sphere &s : film.spheres) {
    place.push_back(s.body > 0 ? bodies[s.body - 1].primaries++ : 0);
    if (s.body > 0)
      height[s.body - 1] += s.z;
  }
  for (const Bond &b : film.bonds)
    bodies[film.spheres[b.i - 1].body - 1].bonds.push_back(
        {place[b.i - 1], place[b.j - 1], break_time(b, rows)});
  std::ofstream out(directory / "bodies.csv");
  out << "body,primaries,bonds,broken,broken_fraction,fragments,largest_fragment,shape_change,"
         "depth_um,cracked\n";
  for (int k = 0; k < options.bodies; ++k) {
    const FractureState s = state_at(bodies[k], rows.back().time);
    out << k + 1 << ',' << bodies[k].primaries << ',' << s.bonds << ',' << s.broken << ','
        << s.broken_fraction() << ',' << s.fragments << ',' << s.largest << ",0,"
        << kThickness - height[k] / bodies[k].primaries << ',' << is_cracked(s) << '\n';
  }
  std::vector<MomentOfRun> moments;
  for (const Row &r : rows)
    moments.push_back({r.time, r.pressure, r.stage});
  std::ofstream(directory / "cracks.csv") << cracks_table(bodies, moments, kSpacing * kSpacing);
  std::ofstream(directory / "thresholds.csv")
      << thresholds_table(test_thresholds(bodies, rows.back().time));
}

void write_side_files(const fs::path &directory, const Film &film, const std::vector<Row> &rows,
                      const MadeRun &options) {
  static const char *const kModes[] = {"", "tension", "bending", "shear", "torsion"};
  std::ofstream breaks(directory / "breaks.csv");
  breaks << "time_us,tag_i,tag_j,body,mode,sigma_MPa,tau_MPa,x_um,y_um,z_um,pressure_MPa\n";
  for (const auto &bond : film.bonds)
    if (const double time = break_time(bond, rows); std::isfinite(time)) {
      const Sphere &s = film.spheres[static_cast<std::size_t>(bond.i) - 1];
      breaks << time << ',' << bond.i << ',' << bond.j << ',' << s.body << ',' << kModes[bond.mode]
             << ",500,100," << s.x << ',' << s.y << ',' << s.z << ',' << bond.breaks_at << '\n';
    }
  write_fracture(directory, film, rows, options);
  std::ofstream(directory / "case.toml") << "electrode = \"made up\"\n";
  std::ofstream(directory / "electrode.json")
      << nlohmann::json({{"thickness_um", kThickness},
                         {"loading_mg_cm2", 17.46},
                         {"porosity_total", porosity(kThickness)},
                         {"bodies", options.bodies},
                         {"primaries", film.spheres.size()},
                         {"seed", 7}})
             .dump(1);
}

void write_series(const fs::path &vtk, const std::string &kind, const std::vector<Row> &frames) {
  std::ofstream out(vtk / (kind + ".pvd"));
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t k = 0; k < frames.size(); ++k)
    out << "<DataSet timestep=\"" << frames[k].time << "\" part=\"0\" file=\"" << kind << '_'
        << k * 1000 << ".vtp\"/>\n";
  out << "</Collection>\n</VTKFile>\n";
}

/// One .vtp file in ASCII: points, lines or polygons, arrays.
class VtpFile {
public:
  VtpFile(const fs::path &file, std::size_t points, std::size_t vertices, std::size_t lines,
          std::size_t polygons)
      : out_(file) {
    out_ << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
            "byte_order=\"LittleEndian\">\n<PolyData>\n<Piece NumberOfPoints=\""
         << points << "\" NumberOfVerts=\"" << vertices << "\" NumberOfLines=\"" << lines
         << "\" NumberOfStrips=\"0\" NumberOfPolys=\"" << polygons << "\">\n";
  }
  ~VtpFile() { out_ << "</Piece>\n</PolyData>\n</VTKFile>\n"; }
  void open(const char *part) { out_ << '<' << part << ">\n"; }
  void close(const char *part) { out_ << "</" << part << ">\n"; }
  template <typename Value>
  void array(const char *name, const char *type, int components, std::size_t count, Value value) {
    out_ << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
         << components << "\" format=\"ascii\">\n";
    for (std::size_t i = 0; i < count; ++i) {
      value(i);
      out_ << '\n';
    }
    out_ << "</DataArray>\n";
  }
  /// Cells of `corners` points each, numbered through.
  void cells(const char *part, std::size_t count, std::size_t corners) {
    open(part);
    array("connectivity", "Int32", 1, count * corners, [&](std::size_t i) { out_ << i; });
    array("offsets", "Int32", 1, count, [&](std::size_t i) { out_ << (i + 1) * corners; });
    close(part);
  }
  std::ofstream &out() { return out_; }

private:
  std::ofstream out_;
};

void write_particles(const fs::path &file, const Film &film, double squeeze, double seen) {
  const std::size_t n = film.spheres.size();
  std::vector<int> gone(n, 0), whole(n, 0);
  for (const auto &bond : film.bonds)
    for (const int tag : {bond.i, bond.j})
      ++(bond.breaks_at < seen ? gone : whole)[static_cast<std::size_t>(tag) - 1];
  VtpFile vtp(file, n, n, 0, 0);
  auto &out = vtp.out();
  const auto &s = film.spheres;
  vtp.open("PointData");
  vtp.array("id", "Int32", 1, n, [&](std::size_t i) { out << i + 1; });
  vtp.array("type", "Int32", 1, n, [&](std::size_t i) { out << s[i].type; });
  vtp.array("body", "Int32", 1, n, [&](std::size_t i) { out << s[i].body; });
  vtp.array("radius", "Float64", 1, n, [&](std::size_t i) { out << s[i].radius; });
  vtp.array("v", "Float64", 3, n, [&](std::size_t) { out << "0 0 0"; });
  vtp.array("f", "Float64", 3, n, [&](std::size_t) { out << "0 0 0"; });
  vtp.array("bonds_intact", "Float64", 1, n, [&](std::size_t i) { out << whole[i]; });
  vtp.array("bonds_broken", "Float64", 1, n, [&](std::size_t i) { out << gone[i]; });
  vtp.close("PointData");
  vtp.open("Points");
  vtp.array("Points", "Float64", 3, n,
            [&](std::size_t i) { out << s[i].x << ' ' << s[i].y << ' ' << s[i].z * squeeze; });
  vtp.close("Points");
  vtp.cells("Verts", n, 1);
}

void write_bonds(const fs::path &file, const Film &film, double squeeze, double seen) {
  const std::size_t n = film.bonds.size();
  VtpFile vtp(file, 2 * n, 0, n, 0);
  auto &out = vtp.out();
  const auto &b = film.bonds;
  vtp.open("CellData");
  vtp.array("tag_i", "Int32", 1, n, [&](std::size_t i) { out << b[i].i; });
  vtp.array("tag_j", "Int32", 1, n, [&](std::size_t i) { out << b[i].j; });
  vtp.array("body", "Int32", 1, n,
            [&](std::size_t i) { out << film.spheres[static_cast<std::size_t>(b[i].i) - 1].body; });
  vtp.array("state", "Int32", 1, n, [&](std::size_t i) { out << (b[i].breaks_at < seen ? 0 : 1); });
  vtp.array("mode", "Int32", 1, n,
            [&](std::size_t i) { out << (b[i].breaks_at < seen ? b[i].mode : 0); });
  vtp.array("sigma_MPa", "Float64", 1, n, [&](std::size_t) { out << 100; });
  vtp.array("tau_MPa", "Float64", 1, n, [&](std::size_t) { out << 20; });
  vtp.close("CellData");
  vtp.open("Points");
  vtp.array("Points", "Float64", 3, 2 * n, [&](std::size_t k) {
    const auto &s = film.spheres[static_cast<std::size_t>(k % 2 ? b[k / 2].j : b[k / 2].i) - 1];
    out << s.x << ' ' << s.y << ' ' << s.z * squeeze;
  });
  vtp.close("Points");
  vtp.cells("Lines", n, 2);
}

void write_platen(const fs::path &file, double cell, double height, double pressure) {
  VtpFile vtp(file, 8, 0, 0, 2);
  auto &out = vtp.out();
  vtp.open("CellData");
  vtp.array("wall", "Int32", 1, 2, [&](std::size_t i) { out << i; });
  vtp.array("pressure_MPa", "Float64", 1, 2, [&](std::size_t) { out << pressure; });
  vtp.close("CellData");
  vtp.open("Points");
  vtp.array("Points", "Float64", 3, 8, [&](std::size_t i) {
    out << (i % 4 == 1 || i % 4 == 2 ? cell : 0) << ' ' << (i % 4 >= 2 ? cell : 0) << ' '
        << (i < 4 ? 0 : height);
  });
  vtp.close("Points");
  vtp.cells("Polys", 2, 4);
}

void write_frames(const fs::path &vtk, const Film &film, const std::vector<Row> &rows,
                  const MadeRun &options) {
  fs::create_directories(vtk);
  std::vector<Row> frames;
  const std::size_t every = std::max<std::size_t>(1, rows.size() / 24);
  for (std::size_t i = 0; i < rows.size(); i += every)
    frames.push_back(rows[i]);
  frames.back() = rows.back();
  for (const char *kind : {"particles", "bonds", "platen"})
    write_series(vtk, kind, frames);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const double height = kThickness - frames[k].displacement;
    const std::string end = "_" + std::to_string(k * 1000) + ".vtp";
    write_particles(vtk / ("particles" + end), film, height / kThickness, frames[k].seen);
    write_bonds(vtk / ("bonds" + end), film, height / kThickness, frames[k].seen);
    write_platen(vtk / ("platen" + end), options.cell_um, height, frames[k].pressure);
  }
}

} // namespace

void make_run(const fs::path &directory, const MadeRun &options) {
  fs::create_directories(directory);
  const Film film = make_film(options);
  const auto rows = make_rows(options);
  write_curve(directory / "curve.csv", film, rows);
  write_side_files(directory, film, rows, options);
  if (options.finished)
    write_summary(directory / "summary.json", film, options);
  if (options.frames)
    write_frames(directory / "vtk", film, rows, options);
}

} // namespace calendem::tests
