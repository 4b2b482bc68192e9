// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "report/plots.h"
#include "report/tables.h"

namespace calendem::report {
namespace {

// Xu et al., Figure 3: pressures [MPa] at which electrode and bonds are shown.
constexpr double kPaperPressures[] = {0, 9.2, 20.1, 50.9, 146.8};
constexpr double kReached = 0.97; // of a pressure: near enough to show
constexpr double kStageTall = 470, kStageWide = 230, kBodyTall = 230, kBodyWide = 230; // pixels
constexpr double kRodRadius = 0.17;                                                    // um
constexpr Colour kWillBreak{0, 100, 200}, kStays{150, 80, 160}, kStudied{230, 120, 20};

using Tags = std::set<std::pair<int, int>>;

struct Stage {
  Moment moment;
  ParticleFrame particles;
  BondFrame bonds;
  PlatenFrame platen;
  const FrameFile *file;
};

/// How bonds are seen. Those longer than `longest` [um] lead through a periodic face.
struct View {
  Camera camera;
  Tags fated; ///< bonds that are broken in the last frame
  double longest;
};

std::vector<Stage> read_stages(Run &run) {
  std::vector<Stage> out;
  for (const Moment &moment : stages_of(run)) {
    Stage s;
    s.moment = moment;
    s.file = &closest(run.particles, moment.time_us);
    s.particles = read_particles(s.file->path, run.notes);
    s.bonds = read_bonds(closest(run.bonds, moment.time_us).path, run.notes);
    if (!run.platen.empty())
      s.platen = read_platen(closest(run.platen, moment.time_us).path, run.notes);
    out.push_back(std::move(s));
  }
  return out;
}

/// Bonds that are broken in the last frame.
Tags broken_at_end(Run &run) {
  Tags out;
  const BondFrame last = read_bonds(run.bonds.back().path, run.notes);
  for (std::size_t i = 0; i < last.tags.size(); ++i)
    if (!last.intact[i])
      out.insert(last.tags[i]);
  return out;
}

/// Intact bonds; those through a periodic face are counted, not drawn.
std::string draw_fate(const BondFrame &frame, const View &view, std::size_t &skipped) {
  Raster raster(view.camera);
  for (std::size_t i = 0; i < frame.from.size(); ++i) {
    const Point &a = frame.from[i], &b = frame.to[i];
    if (!frame.intact[i])
      continue;
    if (std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) > view.longest)
      ++skipped;
    else
      raster.rod(a, b, kRodRadius,
                 i < frame.tags.size() && view.fated.count(frame.tags[i]) ? kWillBreak : kStays);
  }
  return png_of(raster, view.camera);
}

std::string draw_spheres(const ParticleFrame &frame, const Camera &camera) {
  Raster raster(camera);
  for (std::size_t i = 0; i < frame.centre.size(); ++i)
    raster.sphere(frame.centre[i], frame.radius[i], colour_of(frame.body[i]));
  return png_of(raster, camera);
}

/// A stage's spheres, as the subject `solid`, and its bonds.
std::array<Picture, 2> draw_stage(const Stage &s, const char *solid, const View &view,
                                  const Curve &curve) {
  std::array<Picture, 2> out = {framed(s.moment, solid, *s.file, view.camera, s.platen),
                                framed(s.moment, "bonds", *s.file, view.camera, s.platen)};
  out[0].png = draw_spheres(s.particles, view.camera);
  out[1].png = draw_fate(s.bonds, view, out[1].across_faces);
  for (Picture &p : out)
    add_state(curve, p);
  return out;
}

std::string draw_place(const ParticleFrame &frame, int body, const Camera &camera) {
  Raster raster(camera);
  for (const bool studied : {false, true}) {
    for (std::size_t i = 0; i < frame.centre.size(); ++i)
      if ((frame.body[i] == body) == studied)
        raster.sphere(frame.centre[i], frame.radius[i],
                      studied ? kStudied : colour_of(frame.body[i]));
    if (!studied)
      raster.fade(0.7);
  }
  return png_of(raster, camera);
}

/// One body by itself, whole, its centre at the origin.
void keep_body(Stage &s, int body, const std::array<double, 2> &period) {
  const PeriodicUnwrapper unwrapper(s.particles, period);
  Point centre{0, 0, 0};
  ParticleFrame particles;
  for (std::size_t i = 0; i < s.particles.centre.size(); ++i)
    if (s.particles.body[i] == body) {
      particles.centre.push_back(unwrapper.place(s.particles.centre[i], body));
      particles.radius.push_back(s.particles.radius[i]);
      particles.body.push_back(body);
    }
  for (const Point &p : particles.centre)
    for (int k = 0; k < 3; ++k)
      centre[k] += p[k] / double(particles.centre.size());
  const auto moved = [&](Point p) {
    for (int k = 0; k < 3; ++k)
      p[k] -= centre[k];
    return p;
  };
  for (Point &p : particles.centre)
    p = moved(p);
  BondFrame bonds;
  for (std::size_t i = 0; i < s.bonds.from.size(); ++i)
    if (s.bonds.body[i] == body) {
      bonds.from.push_back(moved(unwrapper.place(s.bonds.from[i], body)));
      bonds.to.push_back(moved(unwrapper.place(s.bonds.to[i], body)));
      bonds.intact.push_back(s.bonds.intact[i]);
      if (i < s.bonds.tags.size())
        bonds.tags.push_back(s.bonds.tags[i]);
    }
  s.particles = std::move(particles);
  s.bonds = std::move(bonds);
  s.platen = {};
}

double broken_share(const BondFrame &frame) {
  const double n = double(frame.intact.size());
  return n > 0 ? std::count(frame.intact.begin(), frame.intact.end(), false) / n : 0.0;
}

bool has_frames(const Run &run) { return !run.particles.empty() && !run.bonds.empty(); }

} // namespace

std::vector<Moment> stages_of(const Run &run) {
  const std::size_t top = run.curve.row_of_max_pressure();
  const double end = run.curve["time_us"][top], most = run.curve["pressure_MPa"][top];
  const auto pressure_of = [&](const FrameFile &f) {
    return run.curve["pressure_MPa"][row_near(run.curve, f.time_us)];
  };
  std::vector<Moment> out;
  std::vector<double> missed;
  for (const double wanted : kPaperPressures) {
    if (most < kReached * wanted)
      continue;
    const FrameFile *nearest = &run.particles.front();
    for (const FrameFile &f : run.particles)
      if (wanted > 0 && f.time_us <= end + 1e-9 &&
          std::abs(pressure_of(f) - wanted) < std::abs(pressure_of(*nearest) - wanted))
        nearest = &f;
    const double miss = std::abs(pressure_of(*nearest) - wanted);
    const std::string name = "Paper: " + shown(wanted, wanted > 0 ? 1 : 0) + " MPa";
    if (!out.empty() && out.back().time_us == nearest->time_us) {
      if (miss < missed.back())
        out.back().name = name;
      continue;
    }
    out.push_back({name, nearest->time_us});
    missed.push_back(miss);
  }
  return out;
}

std::vector<Picture> draw_stages(Run &run) {
  std::vector<Picture> pictures;
  if (!has_frames(run))
    return pictures;
  const Box box = box_of(run);
  if (box.low[0] > box.high[0])
    return pictures;
  const View view = {camera_for(box, kStageTall, kStageWide), broken_at_end(run),
                     0.5 * std::min(box.high[0] - box.low[0], box.high[1] - box.low[1])};
  for (const Stage &s : read_stages(run))
    for (Picture &p : draw_stage(s, "electrode", view, run.curve))
      pictures.push_back(std::move(p));
  return pictures;
}

std::vector<Picture> draw_one_body(Run &run) {
  std::vector<Picture> pictures;
  const int body = studied_body(run);
  if (body == 0 || !has_frames(run))
    return pictures;
  const Box all = box_of(run);
  std::vector<Stage> stages = read_stages(run);
  if (all.low[0] > all.high[0] || stages.empty())
    return pictures;
  const Camera wide = camera_for(all, kStageTall, kStageWide);
  pictures.push_back(framed(stages[0].moment, "place", *stages[0].file, wide, stages[0].platen));
  pictures.back().png = draw_place(stages[0].particles, body, wide);
  add_state(run.curve, pictures.back());
  Box box;
  for (Stage &s : stages) {
    keep_body(s, body, period_of(run, s.moment.time_us));
    for (const Point &p : s.particles.centre)
      box.include(p);
  }
  if (box.low[0] > box.high[0]) // bodies.csv names one that the frames have not
    return {};
  const View view = {camera_for(box, kBodyTall, kBodyWide), broken_at_end(run), HUGE_VAL};
  for (const Stage &s : stages)
    for (Picture &p : draw_stage(s, "shape", view, run.curve)) {
      p.broken_fraction = broken_share(s.bonds);
      pictures.push_back(std::move(p));
    }
  return pictures;
}

} // namespace calendem::report
