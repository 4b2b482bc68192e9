// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "base/provenance.h"
#include "electrode/structure/measured_shape.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace calendem {
namespace fs = std::filesystem;
namespace {

// A particle of w voxels lies clear of the border of n with the chance (n - w - 1)/n per axis
// (Miles & Lantuejoul): large ones are cut more often and count for more.
double border_weight(const LabelImage &image, const Region &r) {
  double chance = 1.0;
  for (int axis = 0; axis < 3; ++axis)
    chance *= 1.0 - double(r.high[axis] - r.low[axis] + 2) / image.n[axis];
  return 1.0 / std::max(chance, 0.01);
}

void sort_by_size(ShapeLibrary &l) {
  std::sort(l.shapes.begin(), l.shapes.end(), [](const MeasuredShape &a, const MeasuredShape &b) {
    return std::pair(a.equivalent_diameter, a.name) < std::pair(b.equivalent_diameter, b.name);
  });
}

double weight_of(const ShapeLibrary &l) {
  double sum = 0.0;
  for (const MeasuredShape &s : l.shapes)
    sum += s.weight;
  return sum;
}

std::string table(const ShapeLibrary &l) {
  std::string out = "shape,label,volume_um3,equivalent_diameter_um,sphericity,"
                    "closed_pore_fraction,number_weight\n";
  for (const MeasuredShape &s : l.shapes)
    out += fmt::format("{},{},{:.6g},{:.6g},{:.4f},{:.5f},{:.4f}\n", s.name, s.label, s.volume,
                       s.equivalent_diameter, s.sphericity, s.closed_pore_fraction, s.weight);
  return out;
}

} // namespace

double ShapeLibrary::number_below(double diameter) const {
  const double total = weight_of(*this);
  double before = 0.0, q0 = 0.0, d0 = 0.0;
  for (const MeasuredShape &s : shapes) { // each shape stands at the middle of its step
    const double q = (before + 0.5 * s.weight) / total;
    if (s.equivalent_diameter >= diameter)
      return d0 == 0.0 ? 0.0
                       : q0 + (q - q0) * std::log(diameter / d0) /
                                  std::max(1e-12, std::log(s.equivalent_diameter / d0));
    before += s.weight;
    q0 = q;
    d0 = s.equivalent_diameter;
  }
  return 1.0;
}

double ShapeLibrary::quantile(double q) const {
  const double total = weight_of(*this);
  double before = 0.0, q0 = 0.0, d0 = shapes.front().equivalent_diameter;
  for (const MeasuredShape &s : shapes) {
    const double at = (before + 0.5 * s.weight) / total;
    if (q <= at)
      return d0 * std::pow(s.equivalent_diameter / d0, std::max(0.0, q - q0) / (at - q0));
    before += s.weight;
    q0 = at;
    d0 = s.equivalent_diameter;
  }
  return shapes.back().equivalent_diameter;
}

double ShapeLibrary::volume_above(double diameter) const {
  double all = 0.0, above = 0.0;
  for (const MeasuredShape &s : shapes) {
    all += s.weight * s.volume;
    above += s.equivalent_diameter > diameter ? s.weight * s.volume : 0.0;
  }
  return above / all;
}

double ShapeLibrary::volume_quantile(double q) const {
  for (const MeasuredShape &s : shapes)
    if (1.0 - volume_above(s.equivalent_diameter) >= q - 1e-12)
      return s.equivalent_diameter;
  return shapes.back().equivalent_diameter;
}

ShapeLibrary make_library(const LabelImage &image, std::int32_t background,
                          const std::string &source) {
  ShapeLibrary l;
  l.source = fs::path(source).filename().string();
  refuse_negative_labels(image, {background});
  for (const Region &r : find_regions(image, background)) {
    ++l.labels;
    if (r.cut || r.voxels < kFewestVoxels) {
      (r.cut ? l.cut : l.coarse).push_back(r.label);
      continue;
    }
    const ParticleMask mask = extract_particle(image, r);
    l.loose_voxels += mask.loose_voxels;
    MeasuredShape shape = make_shape(mask);
    shape.label = r.label;
    shape.name = fmt::format("shape_{:05d}", r.label);
    shape.weight = border_weight(image, r);
    l.shapes.push_back(std::move(shape));
  }
  constexpr int kPhases = 3;
  if (l.shapes.empty() && l.labels <= kPhases)
    throw Failure(kBadInput,
                  "{}: {} labels beside the background {}, and no whole particle: these look like "
                  "phases. Name them, and the active material is separated into particles: "
                  "shapes.phases = {{ pore = 0, am = 1, cbd = 2 }} (of a binary image without "
                  "cbd). Else give the right shapes.background.",
                  source, l.labels, background);
  if (l.shapes.empty())
    throw Failure(kBadInput,
                  "{}: of {} labels {} are cut by the border and {} have fewer than {} voxels: no "
                  "particle is left. Give a larger or finer image, or the right shapes.background.",
                  source, l.labels, l.cut.size(), l.coarse.size(), kFewestVoxels);
  sort_by_size(l);
  return l;
}

void write_library(const ShapeLibrary &l, const std::string &folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  for (const auto &entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().rfind("shape_", 0) == 0)
      fs::remove(entry.path(), error);
  for (const MeasuredShape &s : l.shapes)
    write_file(folder + "/" + s.name + ".json", to_json(s).dump() + "\n");
  write_file(folder + "/shapes.csv", table(l));
  const nlohmann::json j = {{"source", l.source},
                            {"source_hash", l.source_hash},
                            {"calendem", version()},
                            {"labels", l.labels},
                            {"shapes", l.shapes.size()},
                            {"cut_by_border", l.cut},
                            {"fewer_than_200_voxels", l.coarse},
                            {"loose_voxels", l.loose_voxels}};
  write_file(folder + "/library.json", j.dump(2) + "\n");
}

ShapeLibrary read_library(const std::string &folder) {
  Mistakes mistakes(folder);
  ShapeLibrary l;
  l.source = folder;
  std::vector<std::string> files;
  if (fs::is_directory(folder))
    for (const auto &entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".json" && entry.path().filename() != "library.json")
        files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  for (const std::string &file : files)
    try {
      std::ifstream in(file);
      l.shapes.push_back(shape_from_json(nlohmann::json::parse(in)));
      l.source_hash = hash_of_text(l.source_hash + hash_of_file(file));
    } catch (const std::exception &e) {
      mistakes.add(0, "'{}' is not a shape: {}. Make the library again, or remove the file.",
                   fs::path(file).filename().string(), e.what());
    }
  if (files.empty())
    mistakes.add(0, "it holds no shapes (shape_*.json). Give a folder 'shapes' that calendem pack "
                    "made from a label image.");
  mistakes.stop_if_any();
  l.labels = int(l.shapes.size());
  sort_by_size(l);
  return l;
}

} // namespace calendem
