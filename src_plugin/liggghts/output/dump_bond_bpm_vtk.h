// SPDX-License-Identifier: GPL-2.0-or-later
// dump ID all bond/bpm/vtk N FILE-*.vtp
//   Bonds as lines between the centres: cell arrays tag_i, tag_j, body, state (1 intact, 0 broken),
//   mode (0 none, 1 tension, 2 bending, 3 shear, 4 torsion), sigma_MPa, tau_MPa, broken_us (-1
//   intact).
// dump ID all platen/vtk N FILE-*.vtp PLATEN COLLECTOR
//   Both walls as quads over the cell: cell arrays wall (0 collector, 1 platen), pressure_MPa.
// One file per output, written by rank 0.
#ifdef LAMMPS_VTK
#ifdef DUMP_CLASS

DumpStyle(bond/bpm/vtk, DumpBondBpmVtk) DumpStyle(platen/vtk, DumpPlatenVtk)

#else
#ifndef LMP_DUMP_BOND_BPM_VTK_H
#define LMP_DUMP_BOND_BPM_VTK_H

#include "dump.h"
#include <string>

class vtkPolyData;

namespace LAMMPS_NS {

/// A dump that writes one VTK polydata file per output from rank 0.
class DumpPolyData : public Dump {
public:
  DumpPolyData(class LAMMPS *, int, char **, int narg_expected);

protected:
  void write_file(vtkPolyData *data);
  void write_header(bigint) {}
  void pack(int *) {}
  void write_data(int, double *) {}
};

class DumpBondBpmVtk : public DumpPolyData {
public:
  DumpBondBpmVtk(class LAMMPS *, int, char **);
  void write();

private:
  class FixBondBpm *fix_;
  void init_style();
};

class DumpPlatenVtk : public DumpPolyData {
public:
  DumpPlatenVtk(class LAMMPS *, int, char **);
  void write();

private:
  std::string ids_[2]; // collector, platen
  void init_style();
  class FixWallGranPlaten *wall(int which);
};

} // namespace LAMMPS_NS

#endif
#endif
#endif
