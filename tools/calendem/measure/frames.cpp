// SPDX-License-Identifier: GPL-2.0-or-later

#include "measure/frames.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLGenericDataObjectReader.h>
#include <vtkXMLUtilities.h>

namespace calendem {
namespace {

namespace fs = std::filesystem;

const char *const kRunAgain =
    "run the case again (calendem run), or let a run that was interrupted end (--resume)";

/// VTK writes its own complaints to the terminal; ours name the file and the remedy.
class WithoutVtkWarnings {
public:
  WithoutVtkWarnings() : before_(vtkObject::GetGlobalWarningDisplay()) {
    vtkObject::SetGlobalWarningDisplay(0);
  }
  ~WithoutVtkWarnings() { vtkObject::SetGlobalWarningDisplay(before_); }
  WithoutVtkWarnings(const WithoutVtkWarnings &) = delete;
  WithoutVtkWarnings &operator=(const WithoutVtkWarnings &) = delete;

private:
  int before_;
};

vtkSmartPointer<vtkDataSet> read_data(const std::string &file, Mistakes &mistakes) {
  if (!fs::exists(file)) {
    mistakes.add(file, "the frame is listed in the .pvd file but missing", kRunAgain);
    return nullptr;
  }
  const WithoutVtkWarnings guard;
  vtkNew<vtkXMLGenericDataObjectReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkSmartPointer<vtkDataSet> data = vtkDataSet::SafeDownCast(reader->GetOutput());
  if (data == nullptr || reader->GetErrorCode() != 0 || data->GetNumberOfPoints() == 0) {
    mistakes.add(file, "the frame cannot be read: truncated, or not VTK XML", kRunAgain);
    return nullptr;
  }
  return data;
}

vtkDataArray *array_of(vtkDataSetAttributes *arrays, const char *name, const std::string &file,
                       Mistakes &mistakes) {
  vtkDataArray *array = arrays->GetArray(name);
  if (array == nullptr)
    mistakes.add(file, std::string("the array '") + name + "' is missing",
                 "write the frames with input_scripts/in.calendering of this version");
  return array;
}

Point point_of(vtkDataSet *data, vtkIdType i) {
  Point p{};
  data->GetPoint(i, p.data());
  return p;
}

} // namespace

std::vector<FrameFile> read_series(const std::string &pvd, Mistakes &mistakes) {
  std::vector<FrameFile> frames;
  if (!fs::exists(pvd)) {
    mistakes.add(pvd, "the list of frames is missing", kRunAgain);
    return frames;
  }
  const WithoutVtkWarnings guard;
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(pvd.c_str()));
  vtkXMLDataElement *list =
      root == nullptr ? nullptr : root->FindNestedElementWithName("Collection");
  for (int i = 0; list != nullptr && i < list->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement *entry = list->GetNestedElement(i);
    double time = 0;
    const char *file = entry->GetAttribute("file");
    if (file != nullptr && entry->GetScalarAttribute("timestep", time))
      frames.push_back({time, (fs::path(pvd).parent_path() / file).string()});
  }
  if (frames.empty())
    mistakes.add(pvd, "no frame is listed: truncated, or no ParaView collection", kRunAgain);
  std::stable_sort(frames.begin(), frames.end(),
                   [](const FrameFile &a, const FrameFile &b) { return a.time_us < b.time_us; });
  return frames;
}

ParticleFrame read_particles(const std::string &file, Mistakes &mistakes) {
  ParticleFrame frame;
  const auto data = read_data(file, mistakes);
  if (data == nullptr)
    return frame;
  vtkDataArray *radius = array_of(data->GetPointData(), "radius", file, mistakes);
  vtkDataArray *body = array_of(data->GetPointData(), "body", file, mistakes);
  if (radius == nullptr || body == nullptr)
    return frame;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    frame.centre.push_back(point_of(data, i));
    frame.radius.push_back(radius->GetTuple1(i));
    frame.body.push_back(static_cast<int>(std::lround(body->GetTuple1(i))));
  }
  return frame;
}

BondFrame read_bonds(const std::string &file, Mistakes &mistakes) {
  BondFrame frame;
  const auto data = read_data(file, mistakes);
  if (data == nullptr)
    return frame;
  vtkDataArray *state = array_of(data->GetCellData(), "state", file, mistakes);
  vtkDataArray *body = array_of(data->GetCellData(), "body", file, mistakes);
  if (state == nullptr || body == nullptr)
    return frame;
  vtkDataArray *tag_i = data->GetCellData()->GetArray("tag_i");
  vtkDataArray *tag_j = data->GetCellData()->GetArray("tag_j");
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i) {
    vtkCell *cell = data->GetCell(i);
    if (cell->GetNumberOfPoints() != 2)
      continue;
    frame.from.push_back(point_of(data, cell->GetPointId(0)));
    frame.to.push_back(point_of(data, cell->GetPointId(1)));
    frame.intact.push_back(state->GetTuple1(i) > 0.5);
    frame.body.push_back(static_cast<int>(std::lround(body->GetTuple1(i))));
    if (tag_i != nullptr && tag_j != nullptr)
      frame.tags.push_back(std::minmax({static_cast<int>(std::lround(tag_i->GetTuple1(i))),
                                        static_cast<int>(std::lround(tag_j->GetTuple1(i)))}));
  }
  return frame;
}

PlatenFrame read_platen(const std::string &file, Mistakes &mistakes) {
  PlatenFrame frame;
  const auto data = read_data(file, mistakes);
  if (data == nullptr)
    return frame;
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i) {
    vtkCell *cell = data->GetCell(i);
    std::vector<Point> outline;
    for (vtkIdType k = 0; k < cell->GetNumberOfPoints(); ++k)
      outline.push_back(point_of(data, cell->GetPointId(static_cast<int>(k))));
    frame.outlines.push_back(std::move(outline));
  }
  return frame;
}

const FrameFile &closest(const std::vector<FrameFile> &frames, double time_us) {
  return *std::min_element(frames.begin(), frames.end(),
                           [time_us](const FrameFile &a, const FrameFile &b) {
                             return std::abs(a.time_us - time_us) < std::abs(b.time_us - time_us);
                           });
}

} // namespace calendem
