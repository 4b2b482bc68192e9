// SPDX-License-Identifier: GPL-2.0-or-later
// bodies.csv: what became of every secondary particle.
#include "pack/electrode_files.h"
#include "run/collect.h"
#include "spec/provenance.h"
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

namespace calendem {
namespace {

// A body counts as cracked at this broken fraction, if it has also come apart. The paper speculates
// 8-12 % (and once 13 %).
constexpr double kCrackedFraction = 0.08;

std::vector<Particle> read_particles(const std::string &folder) {
  std::vector<Particle> particles;
  std::ifstream data(folder + "/electrode.data"), map(folder + "/bodies.map");
  std::string line;
  while (std::getline(data, line) && line != "Atoms")
    ;
  while (std::getline(data, line)) {
    std::istringstream row(line);
    Particle p;
    if (row >> p.tag >> p.type >> p.diameter >> p.density >> p.x.x() >> p.x.y() >> p.x.z())
      particles.push_back(p);
  }
  std::sort(particles.begin(), particles.end(),
            [](const Particle &a, const Particle &b) { return a.tag < b.tag; });
  while (std::getline(map, line)) {
    int tag = 0, body = 0;
    if (std::istringstream(line) >> tag >> body)
      particles.at(tag - 1).body = body;
  }
  return particles;
}

std::set<std::pair<int, int>> read_breaks(const std::string &file) {
  std::set<std::pair<int, int>> broken;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    double time = 0.0;
    int i = 0, j = 0;
    char c = 0;
    if (std::istringstream(line) >> time >> c >> i >> c >> j)
      broken.insert(std::minmax(i, j));
  }
  return broken;
}

int root(std::vector<int> &parent, int i) {
  while (parent[i] != i)
    i = parent[i] = parent[parent[i]];
  return i;
}

std::map<int, Eigen::Vector3d> positions(const std::string &file) {
  std::map<int, Eigen::Vector3d> out;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkDataArray *id = reader->GetOutput()->GetPointData()->GetArray("id");
  for (vtkIdType i = 0; id && i < reader->GetOutput()->GetNumberOfPoints(); ++i)
    out[static_cast<int>(id->GetTuple1(i))] = Eigen::Vector3d(reader->GetOutput()->GetPoint(i));
  return out;
}

// Radius of gyration [um] of a body whose members may lie on both sides of a periodic face.
double gyration(const std::vector<int> &tags, const std::map<int, Eigen::Vector3d> &x, double lx,
                double ly) {
  std::vector<Eigen::Vector3d> at;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int tag : tags) {
    const auto found = x.find(tag);
    if (found == x.end())
      return NAN;
    Eigen::Vector3d p = found->second;
    if (!at.empty()) {
      p.x() -= lx * std::round((p.x() - at[0].x()) / lx);
      p.y() -= ly * std::round((p.y() - at[0].y()) / ly);
    }
    at.push_back(p);
    mean += p / tags.size();
  }
  double sum = 0.0;
  for (const Eigen::Vector3d &p : at)
    sum += (p - mean).squaredNorm();
  return std::sqrt(sum / at.size());
}

} // namespace

std::pair<int, int> write_bodies(const std::string &folder, const ElectrodeFacts &e,
                                 const std::string &electrode_folder,
                                 const std::vector<std::pair<long, double>> &frames) {
  const std::vector<Particle> particles = read_particles(electrode_folder);
  const std::set<std::pair<int, int>> broken = read_breaks(folder + "/breaks.csv");
  std::vector<int> parent(particles.size());
  std::iota(parent.begin(), parent.end(), 0);
  std::map<int, int> bonds, gone;
  for (const auto &[i, j] : bonds_by_distance(particles, e.lx, e.ly)) {
    const int body = particles[i].body;
    ++bonds[body];
    if (broken.count(std::minmax(particles[i].tag, particles[j].tag)))
      ++gone[body];
    else
      parent[root(parent, i)] = root(parent, j);
  }
  std::map<int, std::vector<int>> members;
  std::map<int, std::map<int, int>> fragments;
  std::map<int, double> height;
  for (size_t i = 0; i < particles.size(); ++i) {
    const int body = particles[i].body;
    if (body == 0)
      continue;
    members[body].push_back(particles[i].tag);
    ++fragments[body][root(parent, static_cast<int>(i))];
    height[body] += particles[i].x.z();
  }
  std::map<int, Eigen::Vector3d> first, last;
  if (!frames.empty()) {
    first = positions(fmt::format("{}/vtk/particles_{}.vtp", folder, frames.front().first));
    last = positions(fmt::format("{}/vtk/particles_{}.vtp", folder, frames.back().first));
  }
  std::string out =
      "body,primaries,bonds,broken,broken_fraction,fragments,largest_fragment,shape_change,"
      "depth_um,cracked\n";
  int cracked = 0;
  for (const auto &[body, tags] : members) {
    int largest = 0;
    for (const auto &[r, n] : fragments[body])
      largest = std::max(largest, n);
    const double fraction = bonds[body] > 0 ? double(gone[body]) / bonds[body] : 0.0;
    const bool is_cracked = fraction >= kCrackedFraction && fragments[body].size() > 1;
    cracked += is_cracked;
    const double before = gyration(tags, first, e.lx, e.ly);
    const double change = before > 0.0 ? gyration(tags, last, e.lx, e.ly) / before - 1.0 : 0.0;
    out += fmt::format("{},{},{},{},{:.5f},{},{:.4f},{:.5f},{:.3f},{}\n", body, tags.size(),
                       bonds[body], gone[body], fraction, fragments[body].size(),
                       double(largest) / tags.size(), change,
                       e.thickness - height[body] / tags.size(), is_cracked ? 1 : 0);
  }
  write_file(folder + "/bodies.csv", out);
  return {static_cast<int>(members.size()), cracked};
}

} // namespace calendem
