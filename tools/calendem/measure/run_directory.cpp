// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/run_directory.h"
#include "base/provenance.h"
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
  const bool is_cut = text_of_file(file).find("</VTKFile>") == std::string::npos;
  if (data == nullptr || reader->GetErrorCode() != 0 || is_cut) {
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
    mistakes.add(pvd, "no frame is listed: truncated, or not a ParaView collection", kRunAgain);
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
  for (const auto &[name, to] : {std::pair("id", &frame.tag), std::pair("type", &frame.type)})
    if (vtkDataArray *values = data->GetPointData()->GetArray(name))
      for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
        to->push_back(static_cast<int>(std::lround(values->GetTuple1(i))));
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

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::vector<std::string> kRequired = {
    "time_us",      "displacement_um", "pressure_MPa",   "pressure_bottom_MPa",
    "bonds_broken", "broken_fraction", "broken_tension", "broken_bending",
    "broken_shear", "broken_torsion",  "porosity_total", "porosity_macro"};
const std::vector<std::string> kProfileColumns = {"moment", "z_over_thickness", "porosity_macro",
                                                  "bonds", "bonds_broken"};

void read_summary(RunFolder &folder, Run &run, Mistakes &mistakes) {
  if (folder.has("summary.json"))
    if (const json &summary = folder.object("summary.json", mistakes); !summary.is_null())
      run.summary = summary;
  run.unfinished = folder.unfinished();
}

/// structure.json and structure.csv. A file that is cut or was measured of another curve is a note,
/// not a mistake.
void read_structure(RunFolder &folder, Run &run) {
  const std::string file = folder.path_of("structure.json"),
                    again = "measure it again: calendem measure " + folder.folder();
  if (!folder.has("structure.json") || !folder.has("structure.csv"))
    return;
  const json &structure = folder.object("structure.json");
  Mistakes mistakes;
  auto profile = folder.columns("structure.csv", kProfileColumns, mistakes);
  if (!structure.contains("moments") || !mistakes.empty())
    return run.notes.add(file, "it or structure.csv is cut or damaged", again);
  if (structure.value("/provenance/curve"_json_pointer, "") !=
      hash_of_file(folder.path_of("curve.csv")))
    return run.notes.add(file, "measured of another curve.csv, left out", again);
  const auto moment = folder.table("structure.csv").texts("moment");
  for (std::size_t i = 0; i < moment.size(); ++i)
    run.profile.push_back({moment[i], profile["z_over_thickness"][i], profile["porosity_macro"][i],
                           profile["bonds"][i], profile["bonds_broken"][i]});
  run.structure = structure;
}

/// The table's numbers, if it has all `columns`; else a note.
std::map<std::string, Column> columns_or_note(RunFolder &folder, const char *name,
                                              const std::vector<std::string> &columns,
                                              Mistakes &notes) {
  Mistakes mistakes;
  auto out = folder.columns(name, columns, mistakes);
  if (folder.has(name) && !mistakes.empty())
    notes.add(folder.path_of(name), "it lacks columns or is cut: no charts of it",
              "collect the run again: calendem collect " + folder.folder());
  return out;
}

void read_fracture(RunFolder &folder, Run &run) {
  FractureTables &f = run.fracture;
  const auto read = [&](const char *name, const std::vector<std::string> &columns) {
    return columns_or_note(folder, name, columns, run.notes);
  };
  f.cracks = read("cracks.csv",
                  {"time_us", "pressure_MPa", "bodies_with_bonds", "bodies_apart", "bodies_cracked",
                   "bodies_split", "crack_surface_um2", "parted_surface_um2"});
  if (f.cracks.empty()) // a run of an earlier version
    return;
  f.bodies = read("bodies.csv", {"body", "bonds", "broken", "broken_fraction", "fragments",
                                 "largest_fragment", "depth_um"});
  f.thresholds =
      read("thresholds.csv", {"threshold_percent", "above_apart", "above_whole", "below_apart",
                              "below_whole", "above_split", "below_split"});
  f.breaks = read("breaks.csv", {"time_us", "body"});
}

void read_optional(RunFolder &folder, Run &run) {
  const auto series = [&](const char *name) {
    return read_series(folder.path_of(std::string("vtk/") + name), run.notes);
  };
  run.particles = series("particles.pvd");
  run.bonds = series("bonds.pvd");
  run.platen = series("platen.pvd");
  read_structure(folder, run);
  read_fracture(folder, run);
}

std::vector<std::string> files_read(const RunFolder &folder, const Run &run) {
  std::vector<std::string> out;
  const bool measured = !run.structure.is_null();
  for (const char *name :
       {"summary.json", "curve.csv", "electrode.json", "structure.json", "structure.csv",
        "breaks.csv", "bodies.csv", "cracks.csv", "thresholds.csv", "case.toml"})
    if (folder.has(name) && (measured || std::string(name).rfind("structure", 0) != 0))
      out.push_back(folder.path_of(name));
  return out;
}

} // namespace

Run read_run(const std::string &directory, Mistakes &mistakes) {
  Run run;
  fs::path path = fs::path(directory).lexically_normal();
  if (!path.has_filename())
    path = path.parent_path();
  run.directory = path.string();
  run.name = (path == "." ? fs::absolute(path).parent_path() : path).filename().string();
  if (!fs::is_directory(path)) {
    mistakes.add(run.directory, "no such directory", "give a folder made by calendem run");
    return run;
  }
  RunFolder folder(run.directory);
  read_summary(folder, run, mistakes);
  if (folder.has("electrode.json"))
    run.electrode = folder.object("electrode.json", mistakes);
  run.curve = folder.curve(kRequired, mistakes, run.notes);
  if (run.unfinished.empty() && run.curve.rows() > 0 && run.curve.relaxation().empty())
    run.unfinished = "curve.csv has no relaxation";
  read_optional(folder, run);
  run.files_read = files_read(folder, run);
  return run;
}

void make_names_unique(std::vector<Run> &runs) {
  std::vector<std::string> names;
  for (auto &run : runs) {
    const auto same = std::count_if(runs.begin(), runs.end(),
                                    [&](const Run &other) { return other.name == run.name; });
    names.push_back(same > 1 ? run.directory : run.name);
  }
  for (std::size_t i = 0; i < runs.size(); ++i)
    runs[i].name = names[i];
}

} // namespace calendem
