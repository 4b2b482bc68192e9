// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/observables.h"
#include "measure/structure.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <memory>

namespace calendem {
namespace {

constexpr double kFinest = 0.1; // um: smaller voxels of an image are thinned out
constexpr int kFewest = 6;      // voxels along each axis

/// What is compared, of an image or of a frame.
struct Seen {
  ImageMeasures of_volume;
  double in_pieces = 0.0; ///< of the whole particles; NaN where there is none
  int whole = 0;
  std::string why_none = {}; ///< why nothing is seen
};

Seen seen_in(const PhaseImage &image) {
  const VoxelBodies bodies = bodies_on_voxels(image);
  return {measures_of(image), bodies.whole > 0 ? double(bodies.in_pieces) / bodies.whole : NAN,
          bodies.whole};
}

/// Frames of runs on voxels of one size, each cut once.
class Frames {
public:
  Frames(std::string moment, double voxel) : moment_(std::move(moment)), voxel_(voxel) {}

  const Seen &of(const SimulatedRun &run) {
    const auto known = seen_.find(run.folder);
    return known != seen_.end() ? known->second : seen_[run.folder] = look(run.folder);
  }

private:
  std::string moment_;
  double voxel_;
  std::map<std::string, Seen> seen_;

  Seen look(const std::string &folder) const {
    constexpr double none = NAN;
    std::string why = fmt::format(
        "{} has no frame of the electrode {} it was pressed; let the run end.", folder, moment_);
    try {
      for (const RunMoment &m : moments_of_run(folder))
        if (m.name == moment_)
          return seen_in(
              voxelise(m.structure.spheres, m.structure.cell, m.structure.lattice, voxel_));
    } catch (const Failure &f) { // does not stop the comparison: find_gap reports it
      why = f.what();
    }
    return {{none, none, none, none}, none, 0, why};
  }
};

/// Standard deviation of the mean of four quarters that are independent of each other.
template <class Value> double sd_by_quarters(const PhaseImage &image, Value value) {
  const int i = image.n[0] / 2, j = image.n[1] / 2;
  const std::array<double, 4> of = {value(measures_of(image, 0, i, 0, j)),
                                    value(measures_of(image, i, image.n[0], 0, j)),
                                    value(measures_of(image, 0, i, j, image.n[1])),
                                    value(measures_of(image, i, image.n[0], j, image.n[1]))};
  const double mean = 0.25 * (of[0] + of[1] + of[2] + of[3]);
  double squares = 0.0;
  for (double v : of)
    squares += (v - mean) * (v - mean);
  return std::sqrt(squares / 3.0 / 4.0);
}

PhaseImage read(const Experiment &e, const std::string &file) {
  const PhaseImage image =
      phases_of(read_label_image(file, e.labels_voxel_um), e.labels_pore, e.labels_cbd);
  if (phase_fractions(image).pore == 0.0)
    throw Failure(kBadInput, "{}: no voxel has the label labels_pore = {}. Correct it.", file,
                  e.labels_pore);
  if (e.labels_cbd && phase_fractions(image).cbd == 0.0)
    throw Failure(kBadInput,
                  "{}: no voxel has the label labels_cbd = {}. Correct it, or leave it out if the "
                  "image shows no CBD.",
                  file, *e.labels_cbd);
  const int stride =
      std::max(1, static_cast<int>(std::ceil(kFinest / image.voxel.maxCoeff() - 1e-9)));
  if (*std::min_element(image.n.begin(), image.n.end()) < kFewest * stride)
    throw Failure(kBadInput,
                  "{}: {} x {} x {} voxels of {:g} um are too few to be compared with a run; {} "
                  "along each axis are wanted{}. Give an image of the whole thickness.",
                  file, image.n[0], image.n[1], image.n[2], image.voxel.maxCoeff(),
                  kFewest * stride, stride > 1 ? " of voxels so small" : "");
  return stride > 1 ? every_nth(image, stride) : image;
}

/// The observables of one image.
void compare_image(const Experiment &e, const std::string &file, bool after,
                   std::vector<Observable> &out) {
  const PhaseImage image = read(e, file);
  const auto frames = std::make_shared<Frames>(after ? "after" : "before", image.voxel.maxCoeff());
  const Seen seen = seen_in(image);
  const std::string where = after ? ", image after" : ", image before";
  using Value = std::function<double(const ImageMeasures &)>;
  const auto why_none = [frames](const SimulatedRun &r) { return frames->of(r).why_none; };
  const auto add = [&](const char *name, const Value &value, const Derivative &slope) {
    const auto simulated = [frames, value](const SimulatedRun &r) {
      return 100.0 * value(frames->of(r).of_volume);
    };
    out.push_back({name + where, after ? "relaxation" : kBefore, "%", 100.0 * value(seen.of_volume),
                   100.0 * sd_by_quarters(image, value), simulated, slope});
    out.back().why_none = why_none;
  };
  const auto none = [](const SimulatedRun &) { return 0.0; };
  const auto pore = [after](const SimulatedRun &r) {
    return after ? 100.0 * r.porosity_slope : 0.0;
  };
  const auto am = [frames, after](const SimulatedRun &r) { // proportional to the solid's share
    return after ? -100.0 * r.porosity_slope * frames->of(r).of_volume.am / (1.0 - r.porosity_after)
                 : 0.0;
  };
  if (e.labels_cbd)
    add("macro porosity", &ImageMeasures::pore, pore);
  else
    add("share of AM", &ImageMeasures::am, am);
  add("AM, upper minus lower third", &ImageMeasures::upper_minus_lower, none);
  add("AM, middle minus other thirds", &ImageMeasures::middle_minus_others, none);
  if (!after || seen.whole == 0)
    return;
  const double p = (seen.in_pieces * seen.whole + 1.0) / (seen.whole + 2.0); // never 0 or 1
  const auto in_pieces = [frames](const SimulatedRun &r) { return frames->of(r).in_pieces; };
  out.push_back({"particles in pieces" + where, "relaxation", "fraction", seen.in_pieces,
                 std::sqrt(p * (1.0 - p) / seen.whole), in_pieces, none});
  out.back().why_none = why_none;
}

} // namespace

ImageMeasures measures_of(const PhaseImage &image, int i0, int i1, int j0, int j1) {
  std::array<double, 3> am{}, pore{}, all{};
  for (int k = 0; k < image.n[2]; ++k) {
    const auto third = static_cast<size_t>(3 * k / image.n[2]);
    for (int j = j0; j < j1; ++j)
      for (int i = i0; i < i1; ++i) {
        const VoxelPhase phase = image.phase(image.index(i, j, k));
        am[third] += phase == VoxelPhase::am;
        pore[third] += phase == VoxelPhase::pore;
        all[third] += 1.0;
      }
  }
  const double volume = all[0] + all[1] + all[2];
  const auto share = [&](size_t third) { return am[third] / all[third]; };
  return {(am[0] + am[1] + am[2]) / volume, (pore[0] + pore[1] + pore[2]) / volume,
          share(2) - share(0), share(1) - 0.5 * (share(0) + share(2))};
}

ImageMeasures measures_of(const PhaseImage &image) {
  return measures_of(image, 0, image.n[0], 0, image.n[1]);
}

std::vector<Observable> image_observables_of(const Experiment &e, const Condition &c,
                                             std::vector<std::string> &not_said) {
  std::vector<Observable> out;
  if (!c.labels_before.empty())
    compare_image(e, c.labels_before, false, out);
  if (!c.labels_after.empty()) {
    compare_image(e, c.labels_after, true, out);
    not_said.push_back(fmt::format(
        "{}: a particle counts as in pieces if less than 95 % of the voxels with its label are "
        "connected; a segmentation that gives each piece its own label shows none.",
        c.id));
  }
  return out;
}

} // namespace calendem
