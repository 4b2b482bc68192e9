// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/smooth_surface.h"
#include <algorithm>
#include <cmath>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSignedCharArray.h>
#include <vtkWindowedSincPolyDataFilter.h>

namespace calendem {

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
