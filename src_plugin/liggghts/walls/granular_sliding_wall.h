// SPDX-License-Identifier: GPL-2.0-or-later
// A granular wall whose surface also moves along x. The host's flat wall moves along one axis, and
// the platen's is z; this stands before the wall's contact model and adds the second component to
// the velocity that the model is given.
#ifndef LMP_GRANULAR_SLIDING_WALL_H
#define LMP_GRANULAR_SLIDING_WALL_H

#include "granular_wall.h"
#include <memory>

namespace LAMMPS_NS {

class SlidingWall : public LIGGGHTS::Walls::IGranularWall {
public:
  /// `speed` along x [um/us] is read at every contact; `wall` is owned from now on.
  SlidingWall(LIGGGHTS::Walls::IGranularWall *wall, const double &speed)
      : wall_(wall), speed_(speed) {}

  void settings(int narg, char **arg, LIGGGHTS::IContactHistorySetup *setup) {
    wall_->settings(narg, arg, setup);
  }
  void init_granular() { wall_->init_granular(); }
  bool checkSurfaceIntersect(LIGGGHTS::ContactModels::SurfacesIntersectData &contact) {
    return wall_->checkSurfaceIntersect(contact);
  }
  void compute_force(FixWallGran *fix, LIGGGHTS::ContactModels::SurfacesIntersectData &contact,
                     bool intersect, double *velocity, FixMeshSurface *fix_mesh = 0,
                     int mesh_number = 0, TriMesh *mesh = 0, int triangle = 0) {
    double with_slip[] = {velocity[0] + speed_, velocity[1], velocity[2]};
    wall_->compute_force(fix, contact, intersect, with_slip, fix_mesh, mesh_number, mesh, triangle);
  }
  int get_history_offset(std::string name) { return wall_->get_history_offset(name); }
  bool contact_match(const std::string type, const std::string model) {
    return wall_->contact_match(type, model);
  }

private:
  std::unique_ptr<LIGGGHTS::Walls::IGranularWall> wall_;
  const double &speed_;
};

} // namespace LAMMPS_NS

#endif
