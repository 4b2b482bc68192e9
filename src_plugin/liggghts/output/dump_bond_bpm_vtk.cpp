// SPDX-License-Identifier: GPL-2.0-or-later
#ifdef LAMMPS_VTK
#include "dump_bond_bpm_vtk.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_wall_gran_platen.h"
#include "modify.h"
#include "update.h"
#include <algorithm>
#include <cstring>
#include <unordered_map>
#include <vector>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

using namespace LAMMPS_NS;

namespace {

// One line of the picture; doubles only, so that it travels through MPI as it is.
struct BondLine {
  double tag_i, tag_j, body, state, mode, sigma, tau, broken_us;
};
struct Centre {
  double tag, x, y, z;
};
const int kLineSize = sizeof(BondLine) / sizeof(double);
const int kCentreSize = sizeof(Centre) / sizeof(double);
const char *const kLineArrays[kLineSize] = {"tag_i", "tag_j",     "body",    "state",
                                            "mode",  "sigma_MPa", "tau_MPa", "broken_us"};

template <class T> std::vector<T> gather(const std::vector<T> &mine, int size, MPI_Comm world) {
  int me, nprocs;
  MPI_Comm_rank(world, &me);
  MPI_Comm_size(world, &nprocs);
  std::vector<int> counts(nprocs), starts(nprocs, 0);
  const int n = size * static_cast<int>(mine.size());
  MPI_Gather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, world);
  for (int p = 1; p < nprocs; ++p)
    starts[p] = starts[p - 1] + counts[p - 1];
  std::vector<T> all(me == 0 ? (starts[nprocs - 1] + counts[nprocs - 1]) / size : 0);
  MPI_Gatherv(mine.data(), n, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, 0,
              world);
  return all;
}

std::vector<BondLine> lines_of_intact(FixBondBpm &bonds, const Atom &atom) {
  std::vector<BondLine> lines;
  bonds.pairs().for_each_intact([&](int i, int j, const BondHistory &bond) {
    const calendem::BondStress stress =
        bonds.pair_of(i, j, bond).stress(bond.loads(), bonds.settings().criterion);
    lines.push_back({double(atom.tag[i]), double(atom.tag[j]),
                     double(bonds.body(i < atom.nlocal ? i : j)), 1.0, 0.0, 1e-3 * stress.sigma(),
                     1e-3 * stress.tau(), -1.0});
  });
  return lines;
}

std::vector<Centre> centres_of_bodies(const FixBondBpm &bonds, const Atom &atom) {
  std::vector<Centre> centres;
  for (int i = 0; i < atom.nlocal; ++i)
    if (bonds.body(i) > 0)
      centres.push_back({double(atom.tag[i]), atom.x[i][0], atom.x[i][1], atom.x[i][2]});
  return centres;
}

} // namespace

DumpPolyData::DumpPolyData(LAMMPS *lmp, int narg, char **arg, int narg_expected)
    : Dump(lmp, narg, arg) {
  if (narg != narg_expected || !multifile) {
    const std::string message =
        std::string("dump style ") + style +
        ": wrong number of arguments, or a file name without '*' (one file per output)";
    error->all(FLERR, message.c_str());
  }
  size_one = 1;
}

void DumpPolyData::write_file(vtkPolyData *data) {
  std::string name = filename;
  const size_t star = name.find('*');
  char step[32];
  snprintf(step, sizeof step, BIGINT_FORMAT, update->ntimestep);
  name.replace(star, 1, step);
  const std::string partial = name + ".part";
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(partial.c_str());
  writer->SetInputData(data);
  if (!writer->Write() || rename(partial.c_str(), name.c_str()) != 0) {
    const std::string message = "cannot write '" + name + "'; the run goes on without this picture";
    error->warning(FLERR, message.c_str());
  }
}

DumpBondBpmVtk::DumpBondBpmVtk(LAMMPS *lmp, int narg, char **arg)
    : DumpPolyData(lmp, narg, arg, 5), fix_(NULL) {}

void DumpBondBpmVtk::init_style() { fix_ = FixBondBpm::find(lmp, "dump bond/bpm/vtk"); }

void DumpBondBpmVtk::write() {
  std::vector<BondLine> lines = gather(lines_of_intact(*fix_, *atom), kLineSize, world);
  const std::vector<Centre> centres = gather(centres_of_bodies(*fix_, *atom), kCentreSize, world);
  const std::vector<BreakEvent> &breaks = fix_->breaks();
  if (comm->me != 0)
    return;
  for (const BreakEvent &e : breaks)
    lines.push_back(
        {e.tag_low, e.tag_high, e.body, 0.0, e.mode, 1e-3 * e.sigma, 1e-3 * e.tau, e.time});
  std::unordered_map<int, const Centre *> by_tag;
  for (const Centre &c : centres)
    by_tag[static_cast<int>(c.tag)] = &c;

  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkDoubleArray> arrays[kLineSize];
  for (int a = 0; a < kLineSize; ++a)
    arrays[a]->SetName(kLineArrays[a]);
  for (const BondLine &line : lines) {
    const auto i = by_tag.find(static_cast<int>(line.tag_i));
    const auto j = by_tag.find(static_cast<int>(line.tag_j));
    if (i == by_tag.end() || j == by_tag.end())
      continue;
    const Centre &a = *i->second, &b = *j->second;
    double d[3] = {b.x - a.x, b.y - a.y, b.z - a.z};
    domain->minimum_image(d[0], d[1], d[2]);
    const vtkIdType ends[2] = {points->InsertNextPoint(a.x, a.y, a.z),
                               points->InsertNextPoint(a.x + d[0], a.y + d[1], a.z + d[2])};
    cells->InsertNextCell(2, ends);
    const double *values = reinterpret_cast<const double *>(&line);
    for (int n = 0; n < kLineSize; ++n)
      arrays[n]->InsertNextValue(values[n]);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  for (vtkNew<vtkDoubleArray> &array : arrays)
    data->GetCellData()->AddArray(array);
  write_file(data);
}

DumpPlatenVtk::DumpPlatenVtk(LAMMPS *lmp, int narg, char **arg) : DumpPolyData(lmp, narg, arg, 7) {
  ids_[0] = arg[6];
  ids_[1] = arg[5];
}

FixWallGranPlaten *DumpPlatenVtk::wall(int which) {
  const int n = modify->find_fix(ids_[which].c_str());
  FixWallGranPlaten *found = n < 0 ? NULL : dynamic_cast<FixWallGranPlaten *>(modify->fix[n]);
  if (!found) {
    const std::string message = "dump platen/vtk: '" + ids_[which] + "' is no fix wall/gran/platen";
    error->all(FLERR, message.c_str());
  }
  return found;
}

void DumpPlatenVtk::init_style() {
  wall(0);
  wall(1);
}

void DumpPlatenVtk::write() {
  if (comm->me != 0)
    return;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkDoubleArray> which, pressure;
  which->SetName("wall");
  pressure->SetName("pressure_MPa");
  const double *lo = domain->boxlo, *hi = domain->boxhi;
  for (int w = 0; w < 2; ++w) {
    const double z = wall(w)->position();
    const vtkIdType corners[4] = {
        points->InsertNextPoint(lo[0], lo[1], z), points->InsertNextPoint(hi[0], lo[1], z),
        points->InsertNextPoint(hi[0], hi[1], z), points->InsertNextPoint(lo[0], hi[1], z)};
    cells->InsertNextCell(4, corners);
    which->InsertNextValue(w);
    pressure->InsertNextValue(1e-3 * wall(w)->pressure());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetCellData()->AddArray(which);
  data->GetCellData()->AddArray(pressure);
  write_file(data);
}
#endif
