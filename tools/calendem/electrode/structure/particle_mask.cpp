// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/particle_mask.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <vtkFlyingEdges3D.h>
#include <vtkImageConnectivityFilter.h>
#include <vtkImageData.h>
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
    out.sphericity = std::cbrt(3.14159265358979323846) *
                     std::pow(6.0 * std::fabs(out.volume), 2.0 / 3.0) / out.area;
  return out;
}

} // namespace calendem
