// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <set>

#include "report/plots.h"
#include "report/tables.h"

namespace calendem::report {
namespace {

constexpr double kAzimuth = 28, kElevation = 14; // degrees
// Xu et al., Figure 3: pressures [MPa] at which electrode and bonds are shown.
constexpr double kPaperPressures[] = {0, 9.2, 20.1, 50.9, 146.8};
constexpr double kReached = 0.97;                             // of a pressure: near enough to show
constexpr double kTallestPicture = 620, kWidestPicture = 420; // pixels, as the next
constexpr double kStageTall = 470, kStageWide = 230, kBodyTall = 230, kBodyWide = 230;
constexpr Colour kCbd{96, 96, 96}, kStudied{230, 120, 20};

/// A bond as it is drawn; without a radius [um] it is not.
struct Rod {
  double radius;
  Colour colour;
};
constexpr Rod kIntact{0.13, {150, 172, 200}}, kBroken{0.24, {205, 25, 35}},
    kWillBreak{0.17, {0, 100, 200}}, kStays{0.17, {150, 80, 160}}, kNotDrawn{0.0, {}};

using Tags = std::set<std::pair<int, int>>;

Colour from_hue(double hue, double saturation, double value) {
  Colour colour{};
  for (int k = 0; k < 3; ++k) {
    const double place = std::fmod(hue * 6 + (k == 0 ? 5 : k == 1 ? 3 : 1), 6.0);
    const double dip = std::max(0.0, std::min({place, 4 - place, 1.0}));
    colour[k] = static_cast<std::uint8_t>(255 * value * (1 - saturation * dip));
  }
  return colour;
}

/// Hues a golden angle apart, with changing brightness: neighbours in number differ most. Body 0 is
/// CBD.
Colour colour_of(int body) {
  if (body <= 0)
    return kCbd;
  return from_hue(std::fmod(body * 0.61803398875, 1.0), body % 2 ? 0.50 : 0.68,
                  body % 3 ? 0.95 : 0.78);
}

/// What the first frame holds, with the platen; empty when it cannot be read.
Box box_of(Run &run) {
  Box box;
  for (const auto &centre : read_particles(run.particles.front().path, run.notes).centre)
    box.include(centre);
  if (!box.empty() && !run.platen.empty())
    for (const auto &outline : read_platen(run.platen.front().path, run.notes).outlines)
      for (const auto &corner : outline)
        box.include(corner);
  return box;
}

/// The camera of all pictures, that shows `box` in at most that many pixels.
Camera camera_for(const Box &box, double tallest, double widest) {
  constexpr double kMargin = 1.2; // um: the spheres' radius and some air
  Camera camera(kAzimuth, kElevation);
  camera.frame(box.low, box.high, kMargin, 100.0);
  const double wide = camera.width() / 100.0, tall = camera.height() / 100.0;
  camera.frame(box.low, box.high, kMargin, std::min(tallest / tall, widest / wide));
  return camera;
}

/// Bonds that are longer lead through a periodic face [um].
double longest_in(const Box &box) {
  return 0.5 * std::min(box.high[0] - box.low[0], box.high[1] - box.low[1]);
}

std::string outline_of(const Camera &camera, const std::vector<Point> &corners) {
  std::string points;
  for (const auto &corner : corners) {
    const Point p = camera.project(corner);
    points += fmt::format("{:.1f},{:.1f} ", p[0], p[1]);
  }
  return points;
}

int scale_bar(double pixels_per_um) {
  for (const int length : {50, 20, 10, 5, 2})
    if (length * pixels_per_um <= 110)
      return length;
  return 1;
}

/// A picture with its state, scale bar and outlines of the walls.
Picture framed(const FramesAt &at, const char *subject, const FrameFile &source,
               const Camera &camera, const Curve &curve) {
  Picture picture;
  picture.moment = at.moment.name;
  picture.subject = subject;
  picture.time_us = source.time_us;
  const std::size_t row = row_near(curve, source.time_us);
  picture.pressure_MPa = curve["pressure_MPa"][row];
  picture.broken_fraction = curve["broken_fraction"][row];
  picture.file = source.path;
  picture.width = camera.width();
  picture.height = camera.height();
  picture.pixels_per_um = camera.scale();
  picture.scale_bar_um = scale_bar(camera.scale());
  for (const auto &outline : at.platen.outlines)
    picture.outlines.push_back(outline_of(camera, outline));
  return picture;
}

/// Draws bonds on a raster, as their number says; counts those through a periodic face.
using DrawBonds = std::function<std::size_t(const BondFrame &, Raster &)>;

std::size_t draw_rods(const BondFrame &frame, double longest, Raster &raster,
                      const std::function<Rod(std::size_t)> &rod_of) {
  std::size_t skipped = 0;
  for (std::size_t i = 0; i < frame.from.size(); ++i) {
    const Point &a = frame.from[i], &b = frame.to[i];
    const Rod rod = rod_of(i);
    if (rod.radius == 0.0)
      continue;
    if (std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) > longest)
      ++skipped;
    else
      raster.rod(a, b, rod.radius, rod.colour);
  }
  return skipped;
}

/// Intact bonds, and over them, wherever they are, the broken ones.
DrawBonds broken_over_intact(double longest) {
  return [longest](const BondFrame &frame, Raster &raster) {
    const std::size_t intact = draw_rods(frame, longest, raster, [&](std::size_t i) {
      return frame.intact[i] ? kIntact : kNotDrawn;
    });
    raster.fade(0.45);
    return intact + draw_rods(frame, longest, raster,
                              [&](std::size_t i) { return frame.intact[i] ? kNotDrawn : kBroken; });
  };
}

/// Intact bonds by what becomes of them: broken in the last frame or not.
DrawBonds by_fate(Run &run, double longest) {
  Tags fated;
  const BondFrame last = read_bonds(run.bonds.back().path, run.notes);
  for (std::size_t i = 0; i < last.tags.size(); ++i)
    if (!last.intact[i])
      fated.insert(last.tags[i]);
  return [fated, longest](const BondFrame &frame, Raster &raster) {
    return draw_rods(frame, longest, raster, [&](std::size_t i) {
      return !frame.intact[i]                                          ? kNotDrawn
             : i < frame.tags.size() && fated.count(frame.tags[i]) > 0 ? kWillBreak
                                                                       : kStays;
    });
  };
}

/// The spheres as the subject `solid`, and the bonds where there are any.
void draw(const FramesAt &at, const char *solid, const Camera &camera, const Curve &curve,
          const DrawBonds &draw_bonds, std::vector<Picture> &out) {
  Raster spheres(camera), bonds(camera);
  for (std::size_t i = 0; i < at.particles.centre.size(); ++i)
    spheres.sphere(at.particles.centre[i], at.particles.radius[i], colour_of(at.particles.body[i]));
  out.push_back(framed(at, solid, *at.particle_file, camera, curve));
  out.back().png = png_of(spheres, camera);
  if (!at.bond_file)
    return;
  out.push_back(framed(at, "bonds", *at.bond_file, camera, curve));
  out.back().across_faces = draw_bonds(at.bonds, bonds);
  out.back().png = png_of(bonds, camera);
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
void keep_body(FramesAt &s, int body, const std::array<double, 2> &period) {
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

/// A moment's pictures for each; none without a box to show.
std::vector<Picture> draw_all(Run &run, const std::vector<Moment> &moments, const Box &box,
                              const Camera &camera, const DrawBonds &draw_bonds) {
  std::vector<Picture> pictures;
  for (const Moment &moment : moments)
    if (!box.empty())
      draw(frames_at(run, moment), "electrode", camera, run.curve, draw_bonds, pictures);
  return pictures;
}

} // namespace

FramesAt frames_at(Run &run, const Moment &moment) {
  FramesAt at{moment, {}, {}, {}, &closest(run.particles, moment.time_us), nullptr};
  at.particles = read_particles(at.particle_file->path, run.notes);
  if (!run.bonds.empty()) {
    at.bond_file = &closest(run.bonds, moment.time_us);
    at.bonds = read_bonds(at.bond_file->path, run.notes);
  }
  if (!run.platen.empty())
    at.platen = read_platen(closest(run.platen, moment.time_us).path, run.notes);
  return at;
}

std::vector<Moment> moments_of(const Run &run) {
  const Column &pressure = run.curve["pressure_MPa"];
  const auto pressure_of = [&](const FrameFile &frame) {
    return pressure[row_near(run.curve, frame.time_us)];
  };
  const FrameFile &highest = *std::max_element(
      run.particles.begin(), run.particles.end(),
      [&](const FrameFile &a, const FrameFile &b) { return pressure_of(a) < pressure_of(b); });
  const bool near = pressure_of(highest) >= kReached * pressure[run.curve.row_of_max_pressure()];
  const double top = highest.time_us;
  std::vector<Moment> list{{"Before", run.particles.front().time_us},
                           {near ? "At maximum pressure" : "Frame of highest pressure", top}};
  if (run.particles.back().time_us > top)
    list.push_back({run.unfinished.empty() ? "After" : "Last frame", run.particles.back().time_us});
  return list;
}

std::vector<Moment> stages_of(const Run &run) {
  const std::size_t top = run.curve.row_of_max_pressure();
  const double end = run.curve["time_us"][top], most = run.curve["pressure_MPa"][top];
  const auto pressure_of = [&](const FrameFile &f) {
    return run.curve["pressure_MPa"][row_near(run.curve, f.time_us)];
  };
  std::vector<const FrameFile *> first; // at their pressures: none of a release or a later press
  for (const FrameFile &f : run.particles)
    if (f.time_us <= end + 1e-9 && (first.empty() || pressure_of(f) > pressure_of(*first.back())))
      first.push_back(&f);
  std::vector<Moment> out;
  std::vector<double> missed;
  for (const double wanted : kPaperPressures) {
    if (most < kReached * wanted)
      continue;
    const FrameFile *nearest = &run.particles.front();
    for (const FrameFile *f : first)
      if (wanted > 0 &&
          std::abs(pressure_of(*f) - wanted) < std::abs(pressure_of(*nearest) - wanted))
        nearest = f;
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

std::vector<Picture> draw_pictures(Run &run) {
  if (run.particles.empty())
    return {};
  const Box box = box_of(run);
  return draw_all(run, moments_of(run), box, camera_for(box, kTallestPicture, kWidestPicture),
                  broken_over_intact(longest_in(box)));
}

std::vector<Picture> draw_stages(Run &run) {
  if (run.particles.empty() || run.bonds.empty())
    return {};
  const Box box = box_of(run);
  return draw_all(run, stages_of(run), box, camera_for(box, kStageTall, kStageWide),
                  by_fate(run, longest_in(box)));
}

std::vector<Picture> draw_one_body(Run &run) {
  const int body = studied_body(run);
  if (body == 0 || run.particles.empty() || run.bonds.empty())
    return {};
  const Box all = box_of(run);
  std::vector<FramesAt> stages;
  for (const Moment &moment : stages_of(run))
    stages.push_back(frames_at(run, moment));
  if (all.empty() || stages.empty())
    return {};
  const Camera wide = camera_for(all, kStageTall, kStageWide);
  std::vector<Picture> pictures = {
      framed(stages[0], "place", *stages[0].particle_file, wide, run.curve)};
  pictures.back().png = draw_place(stages[0].particles, body, wide);
  Box box;
  for (FramesAt &s : stages) {
    keep_body(s, body, period_of(run, s.moment.time_us));
    for (const Point &p : s.particles.centre)
      box.include(p);
  }
  if (box.empty()) // bodies.csv names one that the frames have not
    return {};
  const Camera near = camera_for(box, kBodyTall, kBodyWide);
  const DrawBonds draw_bonds = by_fate(run, HUGE_VAL);
  for (const FramesAt &s : stages) {
    draw(s, "shape", near, run.curve, draw_bonds, pictures);
    for (std::size_t k = pictures.size() - 2; k < pictures.size(); ++k)
      pictures[k].broken_fraction = broken_share(s.bonds);
  }
  return pictures;
}

} // namespace calendem::report
