// SPDX-License-Identifier: GPL-2.0-or-later
// The frames of a run: ParaView series and the space that particles fill.
#include "base/provenance.h"
#include "physics/pi.h"
#include "simulate/collect.h"
#include "simulate/sample.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

namespace calendem {
namespace fs = std::filesystem;
namespace {

constexpr double kVoxel = 0.2; // um
constexpr int kAmType = 1, kCbdType = 2;

/// LIGGGHTS was stopped in a frame that lacks its end, or the disk was full.
bool is_whole(const std::string &frame) {
  if (ends_with(frame, "</VTKFile>"))
    return true;
  fmt::print(stderr,
             "warning: '{}' is cut and left out. Go on with calendem run --resume if the run was "
             "stopped in it, or run the case again.\n",
             frame);
  return false;
}

std::vector<long> steps_of(const std::string &folder, const std::string &family) {
  std::vector<long> steps;
  const std::string prefix = family + "_";
  for (const auto &entry : fs::directory_iterator(folder + "/vtk")) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(prefix, 0) == 0 && entry.path().extension() == ".vtp" &&
        std::isdigit(static_cast<unsigned char>(name[prefix.size()])) && is_whole(entry.path()))
      steps.push_back(std::atol(name.c_str() + prefix.size()));
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

/// Cell of voxels, periodic in x and y.
class Voxels {
public:
  Voxels(double lx, double ly, double height)
      : nx_(std::lround(lx / kVoxel)), ny_(std::lround(ly / kVoxel)),
        nz_(std::lround(height / kVoxel) + 1), hx_(lx / nx_), hy_(ly / ny_),
        cells_(size_t(nx_) * ny_ * nz_, 0) {}

  void mark(const double *x, double radius, char phase, bool overwrite) {
    const long k0 = std::max(0L, long(std::floor((x[2] - radius) / kVoxel)));
    const long k1 = std::min(nz_ - 1, long(std::floor((x[2] + radius) / kVoxel)));
    for (long k = k0; k <= k1; ++k)
      for (long i = std::floor((x[0] - radius) / hx_); i <= (x[0] + radius) / hx_; ++i)
        for (long j = std::floor((x[1] - radius) / hy_); j <= (x[1] + radius) / hy_; ++j) {
          const double dx = (i + 0.5) * hx_ - x[0], dy = (j + 0.5) * hy_ - x[1],
                       dz = (k + 0.5) * kVoxel - x[2];
          char &c = cells_[(size_t(k) * ny_ + wrap(j, ny_)) * nx_ + wrap(i, nx_)];
          if (dx * dx + dy * dy + dz * dz < radius * radius && (overwrite || c == 0))
            c = phase;
        }
  }
  double volume(char phase) const {
    return hx_ * hy_ * kVoxel * std::count(cells_.begin(), cells_.end(), phase);
  }

private:
  long nx_, ny_, nz_;
  double hx_, hy_;
  std::vector<char> cells_;
  static long wrap(long i, long n) { return ((i % n) + n) % n; }
};

} // namespace

vtkSmartPointer<vtkPolyData> particles_of(const std::string &folder, long step) {
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(fmt::format("{}/vtk/particles_{}.vtp", folder, step).c_str());
  reader->Update();
  return reader->GetOutput();
}

std::vector<std::pair<long, double>> write_series(const std::string &folder, double dt) {
  std::vector<std::pair<long, double>> frames;
  for (const char *family : {"particles", "bonds", "platen"}) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n <Collection>\n";
    for (long step : steps_of(folder, family)) {
      if (family == std::string("particles"))
        frames.emplace_back(step, step * dt);
      text += fmt::format("  <DataSet timestep=\"{:.9g}\" file=\"{}_{}.vtp\"/>\n", step * dt,
                          family, step);
    }
    write_file(fmt::format("{}/vtk/{}.pvd", folder, family), text + " </Collection>\n</VTKFile>\n");
  }
  std::error_code none; // a convenience, which nothing depends on
  if (!frames.empty())
    fs::copy_file(input_scripts() + "/paraview/open_in_paraview.py",
                  folder + "/open_in_paraview.py", fs::copy_options::overwrite_existing, none);
  return frames;
}

// AM keeps its volume (N s^3); CBD adds what of its spheres lies outside all primaries.
UnionVolume union_volumes(const std::string &folder, const ElectrodeFacts &e,
                          const std::vector<std::pair<long, double>> &frames,
                          const std::vector<RawRow> &rows) {
  UnionVolume out;
  for (const auto &[step, time] : frames) {
    const vtkSmartPointer<vtkPolyData> data = particles_of(folder, step);
    vtkDataArray *type = data->GetPointData()->GetArray("type");
    vtkDataArray *radius = data->GetPointData()->GetArray("radius");
    if (!type || !radius || data->GetNumberOfPoints() == 0)
      continue;
    Voxels voxels(e.elongated(elongation_at(rows, time)).lx, e.ly, e.thickness + 2.0);
    double cubes = 0.0;
    for (int phase : {kAmType, kCbdType})
      for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
        if (type->GetTuple1(i) == phase) {
          voxels.mark(data->GetPoint(i), radius->GetTuple1(i), static_cast<char>(phase), false);
          cubes += phase == kCbdType ? std::pow(radius->GetTuple1(i), 3) : 0.0;
        }
    out.time.push_back(time);
    out.volume.push_back(e.am + voxels.volume(kCbdType));
    out.cbd_spheres.push_back(4.0 / 3.0 * kPi * cubes);
  }
  return out;
}

double height_of_tops(const std::string &folder, long step) {
  const vtkSmartPointer<vtkPolyData> data = particles_of(folder, step);
  vtkDataArray *radius = data->GetPointData()->GetArray("radius");
  std::vector<double> tops;
  for (vtkIdType i = 0; radius && i < data->GetNumberOfPoints(); ++i)
    tops.push_back(data->GetPoint(i)[2] + radius->GetTuple1(i));
  if (tops.empty())
    return NAN;
  const auto at = tops.begin() + std::lround(0.999 * double(tops.size() - 1));
  std::nth_element(tops.begin(), at, tops.end());
  return *at;
}

double UnionVolume::at(double t) const {
  return time.empty() ? NAN : along_points(time, volume, t, volume.front());
}

} // namespace calendem
