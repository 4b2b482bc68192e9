// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/electrode_picture.h"

#include <algorithm>
#include <cmath>

#include "report/scene.h"

namespace calendem::report {
namespace {

constexpr double kTallestPicture = 620; // pixels
constexpr double kWidestPicture = 420;
constexpr double kIntactRadius = 0.13, kBrokenRadius = 0.24; // um, as drawn
constexpr Colour kIntact{150, 172, 200}, kBroken{205, 25, 35};

std::string draw_electrode(const ParticleFrame &frame, const Camera &camera) {
  Raster raster(camera);
  for (std::size_t i = 0; i < frame.centre.size(); ++i)
    raster.sphere(frame.centre[i], frame.radius[i], colour_of(frame.body[i]));
  return png_of(raster, camera);
}

std::string draw_bonds(const BondFrame &frame, const Camera &camera, double longest,
                       std::size_t &skipped) {
  Raster raster(camera);
  for (const bool intact : {true, false}) {
    for (std::size_t i = 0; i < frame.from.size(); ++i) {
      if (frame.intact[i] != intact)
        continue;
      const Point &a = frame.from[i], &b = frame.to[i];
      if (std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) > longest)
        ++skipped;
      else
        raster.rod(a, b, intact ? kIntactRadius : kBrokenRadius, intact ? kIntact : kBroken);
    }
    if (intact)
      raster.fade(0.45); // the broken ones lie on top, wherever they are
  }
  return png_of(raster, camera);
}

} // namespace

std::vector<Moment> moments_of(const Run &run) {
  const Column &pressure = run.curve["pressure_MPa"];
  const auto pressure_of = [&](const FrameFile &frame) {
    return pressure[row_near(run.curve, frame.time_us)];
  };
  const FrameFile &highest = *std::max_element(
      run.particles.begin(), run.particles.end(),
      [&](const FrameFile &a, const FrameFile &b) { return pressure_of(a) < pressure_of(b); });
  constexpr double kNear = 0.97;
  const bool near = pressure_of(highest) >= kNear * pressure[run.curve.row_of_max_pressure()];
  const double top = highest.time_us;
  std::vector<Moment> list{{"Before", run.particles.front().time_us},
                           {near ? "At maximum pressure" : "Frame of highest pressure", top}};
  if (run.particles.back().time_us > top)
    list.push_back({run.unfinished.empty() ? "After" : "Last frame", run.particles.back().time_us});
  return list;
}

std::vector<Picture> draw_pictures(Run &run) {
  std::vector<Picture> pictures;
  if (run.particles.empty())
    return pictures;
  const Box box = box_of(run);
  if (box.low[0] > box.high[0])
    return pictures;
  const Camera camera = camera_for(box, kTallestPicture, kWidestPicture);
  const double longest = 0.5 * std::min(box.high[0] - box.low[0], box.high[1] - box.low[1]);
  for (const auto &moment : moments_of(run)) {
    PlatenFrame platen;
    if (!run.platen.empty())
      platen = read_platen(closest(run.platen, moment.time_us).path, run.notes);
    const FrameFile &particles = closest(run.particles, moment.time_us);
    pictures.push_back(framed(moment, "electrode", particles, camera, platen));
    pictures.back().png = draw_electrode(read_particles(particles.path, run.notes), camera);
    add_state(run.curve, pictures.back());
    if (run.bonds.empty())
      continue;
    const FrameFile &bonds = closest(run.bonds, moment.time_us);
    pictures.push_back(framed(moment, "bonds", bonds, camera, platen));
    pictures.back().png = draw_bonds(read_bonds(bonds.path, run.notes), camera, longest,
                                     pictures.back().across_faces);
    add_state(run.curve, pictures.back());
  }
  return pictures;
}

} // namespace calendem::report
