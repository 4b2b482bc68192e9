// SPDX-License-Identifier: GPL-2.0-or-later
// bodies.csv, cracks.csv, thresholds.csv: what became of every secondary particle.
#include "base/provenance.h"
#include "electrode/pack/electrode_files.h"
#include "simulate/collect.h"
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace calendem {
namespace {

constexpr double kEndOfRun = std::numeric_limits<double>::max();

using Breaks = std::map<std::pair<int, int>, double>; // tags -> time [us]

Breaks read_breaks(const std::string &file) {
  Breaks broken;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    double time = 0.0;
    int i = 0, j = 0;
    char c = 0;
    if (std::istringstream(line) >> time >> c >> i >> c >> j)
      broken.emplace(std::minmax(i, j), time);
  }
  return broken;
}

struct Member {
  std::vector<int> tags;
  BodyBonds bonds;
  double height = 0.0; // sum over the primaries
};

// By number of the body.
std::map<int, Member> members_of(const std::vector<Particle> &particles, const Breaks &breaks,
                                 double lx, double ly) {
  std::map<int, Member> out;
  std::vector<int> place(particles.size());
  for (size_t i = 0; i < particles.size(); ++i) {
    if (particles[i].body == 0)
      continue;
    Member &m = out[particles[i].body];
    place[i] = m.bonds.primaries++;
    m.bonds.body = particles[i].body;
    m.tags.push_back(particles[i].tag);
    m.height += particles[i].x.z();
  }
  for (const auto &[i, j] : bonds_by_distance(particles, lx, ly)) {
    const auto broken = breaks.find(std::minmax(particles[i].tag, particles[j].tag));
    out[particles[i].body].bonds.bonds.push_back(
        {place[i], place[j], broken == breaks.end() ? HUGE_VAL : broken->second});
  }
  return out;
}

std::map<int, Eigen::Vector3d> positions(const std::string &folder, long step) {
  std::map<int, Eigen::Vector3d> out;
  const vtkSmartPointer<vtkPolyData> frame = particles_of(folder, step);
  vtkDataArray *id = frame->GetPointData()->GetArray("id");
  for (vtkIdType i = 0; id && i < frame->GetNumberOfPoints(); ++i)
    out[static_cast<int>(id->GetTuple1(i))] = Eigen::Vector3d(frame->GetPoint(i));
  return out;
}

// Places [um] of a body's members, which may lie on both sides of a periodic face; empty if any is
// missing.
std::vector<Eigen::Vector3d> together(const std::vector<int> &tags,
                                      const std::map<int, Eigen::Vector3d> &x, double lx,
                                      double ly) {
  std::vector<Eigen::Vector3d> at;
  for (int tag : tags) {
    const auto found = x.find(tag);
    if (found == x.end())
      return {};
    Eigen::Vector3d p = found->second;
    if (!at.empty()) {
      p.x() -= lx * std::round((p.x() - at[0].x()) / lx);
      p.y() -= ly * std::round((p.y() - at[0].y()) / ly);
    }
    at.push_back(p);
  }
  return at;
}

using Points = Eigen::Matrix3Xd;

Points centred(const std::vector<Eigen::Vector3d> &at) {
  Points p(3, at.size());
  for (size_t i = 0; i < at.size(); ++i)
    p.col(i) = at[i];
  return p.colwise() - p.rowwise().mean();
}

struct ShapeChange {
  double change = 0.0; // of the radius of gyration, relative
  double deformation_um =
      0.0; // rms distance of the primaries from the body as it was, moved rigidly
};

ShapeChange shape_of(const std::vector<Eigen::Vector3d> &before,
                     const std::vector<Eigen::Vector3d> &after) {
  if (before.size() < 2 || after.size() != before.size())
    return {};
  const Points a = centred(before), b = centred(after);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(b * a.transpose(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Points moved = svd.matrixU() * turn * svd.matrixV().transpose() * a;
  return {b.norm() / a.norm() - 1.0, (b - moved).norm() / std::sqrt(double(before.size()))};
}

// Pressure [MPa] of the run at a time; empty text if it never comes.
std::string pressure_at(const std::vector<MomentOfRun> &moments, double time) {
  const auto at = std::find_if(moments.begin(), moments.end(),
                               [&](const MomentOfRun &m) { return m.time_us >= time; });
  return at == moments.end() ? "" : fmt::format("{:.6g}", at->pressure_MPa);
}

} // namespace

std::pair<int, int> write_bodies(const std::string &folder, const ElectrodeFacts &e,
                                 const std::string &electrode_folder,
                                 const std::vector<std::pair<long, double>> &frames,
                                 const std::vector<MomentOfRun> &moments, double elongation) {
  const double face = e.facet;
  std::map<int, Eigen::Vector3d> first, last;
  if (!frames.empty()) {
    first = positions(folder, frames.front().first);
    last = positions(folder, frames.back().first);
  }
  std::string out = "body,primaries,bonds,broken,broken_fraction,fragments,largest_fragment,"
                    "shape_change,depth_um,cracked,crack_surface_um2,parted_surface_um2,"
                    "deformation_um,apart_at_MPa,cracked_at_MPa\n";
  int cracked = 0;
  std::vector<BodyBonds> bodies;
  Mistakes none; // the electrode was read before
  for (const auto &[body, m] : members_of(electrode_particles(electrode_folder, none, none),
                                          read_breaks(folder + "/breaks.csv"), e.lx, e.ly)) {
    const FractureState s = state_at(m.bonds, kEndOfRun);
    const ShapeChange shape = shape_of(together(m.tags, first, e.lx, e.ly),
                                       together(m.tags, last, e.elongated(elongation).lx, e.ly));
    cracked += is_cracked(s);
    out += fmt::format("{},{},{},{},{:.5f},{},{:.4f},{:.5f},{:.3f},{},{:.5g},{:.5g},{:.5f},{},{}\n",
                       body, m.tags.size(), s.bonds, s.broken, s.broken_fraction(), s.fragments,
                       s.largest, shape.change, e.thickness - m.height / m.tags.size(),
                       is_cracked(s) ? 1 : 0, s.broken * face, s.parting * face,
                       shape.deformation_um, pressure_at(moments, apart_since(m.bonds)),
                       pressure_at(moments, cracked_since(m.bonds)));
    bodies.push_back(m.bonds);
  }
  write_file(folder + "/bodies.csv", out);
  write_file(folder + "/cracks.csv", cracks_table(bodies, moments, face));
  write_file(folder + "/thresholds.csv", thresholds_table(test_thresholds(bodies, kEndOfRun)));
  return {static_cast<int>(bodies.size()), cracked};
}

} // namespace calendem
