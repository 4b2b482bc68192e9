// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/particle_mask.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSignedCharArray.h>
#include <vtkWindowedSincPolyDataFilter.h>

namespace calendem {

namespace {

// Marks in `mark` all voxels of value `from` connected by faces to `start` with `to`; their number.
long flood(ParticleMask &m, size_t start, char from, char to) {
  std::vector<size_t> front = {start};
  m.inside[start] = to;
  const long step[3] = {1, m.n[0], long(m.n[0]) * m.n[1]};
  long count = 0;
  while (!front.empty()) {
    const size_t at = front.back();
    front.pop_back();
    ++count;
    const int place[3] = {int(at % m.n[0]), int(at / step[1] % m.n[1]), int(at / step[2])};
    for (int axis = 0; axis < 3; ++axis)
      for (int side : {-1, 1}) {
        if (place[axis] + side < 0 || place[axis] + side >= m.n[axis])
          continue;
        const size_t next = at + side * step[axis];
        if (m.inside[next] == from) {
          m.inside[next] = to;
          front.push_back(next);
        }
      }
  }
  return count;
}

// Leaves the largest part as 1, drops the others to 0.
void keep_largest_part(ParticleMask &m) {
  std::vector<std::pair<long, size_t>> parts; // size, first voxel
  for (size_t v = 0; v < m.inside.size(); ++v)
    if (m.inside[v] == 1)
      parts.emplace_back(flood(m, v, 1, 2), v);
  const auto largest = std::max_element(parts.begin(), parts.end());
  for (auto part = parts.begin(); part != parts.end(); ++part)
    if (part != largest) {
      flood(m, part->second, 2, 0);
      m.loose_voxels += part->first;
    }
  m.solid_voxels = flood(m, largest->second, 2, 1);
}

// The corner is outside; what outside does not reach is inside.
void close_pores(ParticleMask &m) {
  flood(m, 0, 0, 2);
  for (char &v : m.inside) {
    m.pore_voxels += v == 0;
    v = v == 2 ? 0 : 1;
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
  vtkNew<vtkImageData> image;
  image->SetDimensions(mask.n.data());
  image->SetSpacing(mask.voxel.data());
  vtkNew<vtkSignedCharArray> values;
  values->SetNumberOfValues(vtkIdType(mask.inside.size()));
  std::copy(mask.inside.begin(), mask.inside.end(), values->GetPointer(0));
  image->GetPointData()->SetScalars(values);
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputData(image);
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
    out.sphericity = std::cbrt(3.14159265358979323846) *
                     std::pow(6.0 * std::fabs(out.volume), 2.0 / 3.0) / out.area;
  return out;
}

} // namespace calendem
