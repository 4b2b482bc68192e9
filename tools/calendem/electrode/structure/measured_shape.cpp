// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/measured_shape.h"
#include "base/messages.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <vtkFlyingEdges3D.h>
#include <vtkImageConnectivityFilter.h>
#include <vtkImageData.h>
#include <vtkImageEuclideanDistance.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSignedCharArray.h>
#include <vtkSmartPointer.h>
#include <vtkWindowedSincPolyDataFilter.h>

namespace calendem {

namespace {

vtkSmartPointer<vtkImageData> image_of(const ParticleMask &m) {
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(m.n.data());
  image->SetSpacing(m.voxel.data());
  vtkNew<vtkSignedCharArray> values;
  values->SetNumberOfValues(vtkIdType(m.inside.size()));
  std::copy(m.inside.begin(), m.inside.end(), values->GetPointer(0));
  image->GetPointData()->SetScalars(values);
  return image;
}

// Numbers from 1 of the parts, connected by faces, of the voxels with inside == value; 0 elsewhere.
std::vector<int> parts_of(const ParticleMask &m, int value, bool largest_only) {
  vtkNew<vtkImageConnectivityFilter> filter;
  filter->SetInputData(image_of(m));
  filter->SetScalarRange(value, value);
  filter->SetLabelScalarTypeToInt();
  if (largest_only)
    filter->SetExtractionModeToLargestRegion();
  filter->Update();
  const int *part = static_cast<const int *>(filter->GetOutput()->GetScalarPointer());
  return {part, part + m.inside.size()};
}

void keep_largest_part(ParticleMask &m) {
  const std::vector<int> largest = parts_of(m, 1, true);
  for (size_t v = 0; v < m.inside.size(); ++v) {
    m.solid_voxels += largest[v] > 0;
    m.loose_voxels += m.inside[v] == 1 && largest[v] == 0;
    m.inside[v] = largest[v] > 0;
  }
}

// The corner is outside; what is not connected to it is inside.
void close_pores(ParticleMask &m) {
  const std::vector<int> empty = parts_of(m, 0, false);
  for (size_t v = 0; v < m.inside.size(); ++v) {
    m.pore_voxels += empty[v] > 0 && empty[v] != empty[0];
    m.inside[v] = empty[v] != empty[0];
  }
}

} // namespace

std::vector<Region> find_regions(const LabelImage &image, std::int32_t background) {
  std::unordered_map<std::int32_t, Region> found;
  Region *last = nullptr;
  for (int k = 0; k < image.n[2]; ++k)
    for (int j = 0; j < image.n[1]; ++j)
      for (int i = 0; i < image.n[0]; ++i) {
        const std::int32_t label = image.at(i, j, k);
        if (label == background)
          continue;
        if (!last || last->label != label)
          last = &found.try_emplace(label, Region{label, {i, j, k}, {i, j, k}, 0, false})
                      .first->second;
        const int at[3] = {i, j, k};
        for (int axis = 0; axis < 3; ++axis) {
          last->low[axis] = std::min(last->low[axis], at[axis]);
          last->high[axis] = std::max(last->high[axis], at[axis]);
          last->cut = last->cut || at[axis] == 0 || at[axis] == image.n[axis] - 1;
        }
        ++last->voxels;
      }
  std::map<std::int32_t, Region> sorted(found.begin(), found.end());
  std::vector<Region> out;
  for (const auto &[label, region] : sorted)
    out.push_back(region);
  return out;
}

ParticleMask extract_particle(const LabelImage &image, const Region &r) {
  ParticleMask m;
  for (int axis = 0; axis < 3; ++axis)
    m.n[axis] = r.high[axis] - r.low[axis] + 3;
  m.voxel = image.voxel;
  m.inside.assign(size_t(m.n[0]) * m.n[1] * m.n[2], 0);
  for (int k = r.low[2]; k <= r.high[2]; ++k)
    for (int j = r.low[1]; j <= r.high[1]; ++j)
      for (int i = r.low[0]; i <= r.high[0]; ++i)
        if (image.at(i, j, k) == r.label)
          m.inside[m.index(i - r.low[0] + 1, j - r.low[1] + 1, k - r.low[2] + 1)] = 1;
  keep_largest_part(m);
  close_pores(m);
  return m;
}

SurfaceMeasures measure_surface(const ParticleMask &mask) {
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputData(image_of(mask));
  surface->SetValue(0, 0.5);
  surface->ComputeNormalsOff();
  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->SetInputConnection(surface->GetOutputPort());
  smooth->SetNumberOfIterations(20);
  smooth->SetPassBand(0.05);
  smooth->NonManifoldSmoothingOn();
  smooth->NormalizeCoordinatesOn();
  vtkNew<vtkMassProperties> measure;
  measure->SetInputConnection(smooth->GetOutputPort());
  measure->Update();
  SurfaceMeasures out;
  out.area = measure->GetSurfaceArea();
  out.volume = measure->GetVolume();
  if (out.area > 0.0)
    out.sphericity = std::cbrt(kPi) * std::pow(6.0 * std::fabs(out.volume), 2.0 / 3.0) / out.area;
  return out;
}

namespace {

// Cells whose volume lies to one half or more inside.
void coarsen(const ParticleMask &m, MeasuredShape &s) {
  for (int axis = 0; axis < 3; ++axis)
    s.n[axis] = int(std::ceil(m.n[axis] * m.voxel[axis] / s.cell)) + 2;
  const auto cell_of = [&](int axis, int i) { return 1 + int((i + 0.5) * m.voxel[axis] / s.cell); };
  std::vector<std::array<int, 2>> count(size_t(s.n[0]) * s.n[1] * s.n[2], {0, 0});
  for (int k = 0; k < m.n[2]; ++k)
    for (int j = 0; j < m.n[1]; ++j)
      for (int i = 0; i < m.n[0]; ++i) {
        auto &c = count[(size_t(cell_of(2, k)) * s.n[1] + cell_of(1, j)) * s.n[0] + cell_of(0, i)];
        ++c[0];
        c[1] += m.inside[m.index(i, j, k)];
      }
  for (const auto &c : count)
    s.inside.push_back(c[0] > 0 && 2 * c[1] >= c[0]);
}

// What follows from the cells: depth, centre, reach.
void complete(MeasuredShape &s) {
  s.depth = signed_distance(s.inside, s.n, s.cell);
  std::vector<Eigen::Vector3d> cells;
  for (int k = 0; k < s.n[2]; ++k)
    for (int j = 0; j < s.n[1]; ++j)
      for (int i = 0; i < s.n[0]; ++i)
        if (s.inside[(size_t(k) * s.n[1] + j) * s.n[0] + i])
          cells.emplace_back((i + 0.5) * s.cell, (j + 0.5) * s.cell, (k + 0.5) * s.cell);
  if (cells.empty())
    throw Failure(kBadInput, "no cell is inside");
  s.centre.setZero();
  for (const Eigen::Vector3d &c : cells)
    s.centre += c / double(cells.size());
  for (const Eigen::Vector3d &c : cells)
    s.reach = std::max(s.reach, (c - s.centre).norm() + 0.87 * s.cell);
}

} // namespace

double MeasuredShape::depth_at(const Eigen::Vector3d &x) const {
  const Eigen::Array3d at = ((x + centre) / cell).array() - 0.5;
  const Eigen::Array3d top(n[0] - 1.001, n[1] - 1.001, n[2] - 1.001);
  const Eigen::Array3d in_box = at.max(0.0).min(top);
  const Eigen::Array3i low = in_box.cast<int>();
  const Eigen::Array3d f = in_box - low.cast<double>();
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const double share = (i ? f[0] : 1 - f[0]) * (j ? f[1] : 1 - f[1]) * (k ? f[2] : 1 - f[2]);
    sum += share * depth[(size_t(low[2] + k) * n[1] + low[1] + j) * n[0] + low[0] + i];
  }
  return sum + (at - in_box).matrix().norm() * cell;
}

MeasuredShape make_shape(const ParticleMask &mask, int cells) {
  MeasuredShape s;
  s.volume = mask.volume();
  s.equivalent_diameter = std::cbrt(6.0 / kPi * s.volume);
  s.sphericity = std::min(1.0, measure_surface(mask).sphericity);
  s.closed_pore_fraction = double(mask.pore_voxels) / double(mask.pore_voxels + mask.solid_voxels);
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    longest = std::max(longest, (mask.n[axis] - 2) * mask.voxel[axis]);
  s.cell = std::max(mask.voxel.maxCoeff(), longest / cells);
  coarsen(mask, s);
  complete(s);
  return s;
}

nlohmann::json to_json(const MeasuredShape &s) {
  std::vector<int> runs;
  char value = 0;
  int length = 0;
  for (const char v : s.inside) {
    if (v != value) {
      runs.push_back(length);
      length = 0;
      value = v;
    }
    ++length;
  }
  runs.push_back(length);
  return {{"name", s.name},
          {"label", s.label},
          {"volume_um3", s.volume},
          {"equivalent_diameter_um", s.equivalent_diameter},
          {"sphericity", s.sphericity},
          {"closed_pore_fraction", s.closed_pore_fraction},
          {"number_weight", s.weight},
          {"cells", s.n},
          {"cell_um", s.cell},
          {"runs_outside_inside", runs}};
}

MeasuredShape shape_from_json(const nlohmann::json &j) {
  MeasuredShape s;
  s.name = j.at("name");
  s.label = j.at("label");
  s.volume = j.at("volume_um3");
  s.equivalent_diameter = j.at("equivalent_diameter_um");
  s.sphericity = j.at("sphericity");
  s.closed_pore_fraction = j.at("closed_pore_fraction");
  s.weight = j.at("number_weight");
  s.n = j.at("cells");
  s.cell = j.at("cell_um");
  const size_t size = size_t(std::max(0, s.n[0])) * std::max(0, s.n[1]) * std::max(0, s.n[2]);
  if (size < 27 || size > 1000000 || !(s.cell > 0.0) || !(s.volume > 0.0) || !(s.weight > 0.0))
    throw Failure(kBadInput,
                  "cells {} x {} x {} of {} um, volume {} um3, weight {}: all must be positive",
                  s.n[0], s.n[1], s.n[2], s.cell, s.volume, s.weight);
  char value = 0;
  for (const int length : j.at("runs_outside_inside")) {
    if (length < 0 || s.inside.size() + length > size)
      break;
    s.inside.insert(s.inside.end(), length, value);
    value = value ? 0 : 1;
  }
  if (s.inside.size() != size)
    throw Failure(kBadInput, "runs_outside_inside fill {} of {} cells", s.inside.size(), size);
  complete(s);
  return s;
}

namespace {

// Squared distance in cells to the nearest cell with inside == value.
std::vector<double> squared_distance(const std::vector<char> &inside, const std::array<int, 3> &n,
                                     char value) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(n.data());
  image->AllocateScalars(VTK_SIGNED_CHAR, 1);
  std::transform(inside.begin(), inside.end(),
                 static_cast<signed char *>(image->GetScalarPointer()),
                 [&](char v) { return static_cast<signed char>(v != value); });
  vtkNew<vtkImageEuclideanDistance> distance; // to the nearest 0
  distance->SetInputData(image);
  distance->Update();
  const auto *d = static_cast<const double *>(distance->GetOutput()->GetScalarPointer());
  return {d, d + inside.size()};
}

} // namespace

std::vector<float> signed_distance(const std::vector<char> &inside, const std::array<int, 3> &n,
                                   double cell) {
  const std::vector<double> to_inside = squared_distance(inside, n, 1);
  const std::vector<double> to_outside = squared_distance(inside, n, 0);
  std::vector<float> out(inside.size());
  for (size_t v = 0; v < out.size(); ++v)
    out[v] = static_cast<float>(
        cell * (inside[v] ? 0.5 - std::sqrt(to_outside[v]) : std::sqrt(to_inside[v]) - 0.5));
  return out;
}

} // namespace calendem
