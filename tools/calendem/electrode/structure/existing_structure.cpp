// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/existing_structure.h"
#include "base/provenance.h"
#include "electrode/structure/particle_data.h"
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <tuple>

namespace calendem {

namespace {

constexpr int kMostListed = 10; // mistakes in rows

// Numbers of the types in each list of the recipe.
struct Types {
  std::set<int> am, cbd, left_out;
};

// What the recipe names by number or by label.
Types types_in(const StructureSource &s, const ParticleData &data, Mistakes &mistakes) {
  Types out;
  std::set<int> seen;
  std::string labels;
  for (const auto &[label, number] : data.labels)
    labels += (labels.empty() ? "" : ", ") + label;
  for (const auto &[key, names, numbers] :
       {std::tuple("am_types", &s.am_types, &out.am),
        std::tuple("cbd_types", &s.cbd_types, &out.cbd),
        std::tuple("left_out_types", &s.left_out_types, &out.left_out)})
    for (const std::string &name : *names) {
      const auto label = data.labels.find(name);
      const int type =
          int(whole_number_in(label == data.labels.end() ? name : label->second).value_or(0));
      if (type == 0 && !data.particles.empty())
        mistakes.add(0, "structure.{} names '{}'; the file's Atom Type Labels are {}.", key, name,
                     labels.empty() ? "none: give the type's number" : labels);
      else if (!seen.insert(type).second && type > 0)
        mistakes.add(0, "structure.{}: '{}' is type {}, which is named before. Name it once.", key,
                     name, type);
      else
        numbers->insert(type);
    }
  return out;
}

// Particles of each type that is not listed, and listed types without particles.
void check_types(const Types &types, const ParticleData &data, Mistakes &mistakes) {
  std::map<int, std::pair<long, int>> found; // number, first line
  for (const DataParticle &p : data.particles)
    if (found[p.type].first++ == 0)
      found[p.type].second = p.line;
  for (const auto &[type, seen] : found)
    if (!types.am.count(type) && !types.cbd.count(type) && !types.left_out.count(type))
      mistakes.add(0,
                   "type {} (particles: {}, first in line {}) is in none of structure.am_types, "
                   "cbd_types and left_out_types. Name it in one of them.",
                   type, seen.first, seen.second);
  for (const auto &[name, listed] :
       {std::pair("am_types", &types.am), std::pair("cbd_types", &types.cbd),
        std::pair("left_out_types", &types.left_out)})
    for (int type : *listed)
      if (!data.particles.empty() && !found.count(type))
        mistakes.add(0,
                     "structure.{} names type {}, but no particle is of that type. Name the types "
                     "that the file has.",
                     name, type);
}

// id -> body, of rows 'id body'.
std::map<long, long> read_body_map(const std::string &file, Mistakes &mistakes) {
  std::map<long, long> out;
  std::ifstream in(file, std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::vector<std::string> words = words_of(line.substr(0, line.find('#')));
    if (words.empty())
      continue;
    const long id = whole_number_in(words[0]).value_or(0);
    const long body = words.size() == 2 ? whole_number_in(words[1]).value_or(0) : 0;
    if (id < 1 || body < 1)
      mistakes.add(number, "'{}' is not a row 'id body' with whole numbers from 1.",
                   joined(words).substr(0, 60));
    else if (!out.emplace(id, body).second)
      mistakes.add(number, "particle {} occurs twice; every primary belongs to one body.", id);
  }
  return out;
}

void set_clusters(std::map<long, long> body, std::vector<ExistingSphere> &am, Mistakes &mistakes) {
  if (body.empty())
    mistakes.add(0, "it holds no rows 'id body'. Give the map of the data file.");
  int missing = 0;
  for (ExistingSphere &p : am) {
    const auto at = body.find(p.id);
    if (at != body.end()) {
      p.cluster = at->second;
      body.erase(at);
    } else if (missing++ == 0)
      mistakes.add(
          0,
          "particle {} of the active material is not in the map. Give the map of this data file.",
          p.id);
  }
  if (!body.empty())
    mistakes.add(0,
                 "{} rows name particles that are not active material in the data file, first {}. "
                 "Give the map of this data file.",
                 body.size(), body.begin()->first);
}

// z from the lowest point; how high the film is.
void measure_height(double box_z, bool z_periodic, ExistingStructure &g) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const auto *phase : {&g.am, &g.cbd})
    for (const ExistingSphere &p : *phase) {
      low = std::min(low, p.x.z() - 0.5 * p.diameter);
      high = std::max(high, p.x.z() + 0.5 * p.diameter);
    }
  for (auto *phase : {&g.am, &g.cbd})
    for (ExistingSphere &p : *phase)
      p.x.z() -= low;
  g.extent = high - low;
  g.thickness = z_periodic ? std::min(box_z, g.extent) : g.extent;
}

void sort_by_id(std::vector<ExistingSphere> &spheres) {
  std::sort(spheres.begin(), spheres.end(),
            [](const ExistingSphere &a, const ExistingSphere &b) { return a.id < b.id; });
}

} // namespace

ExistingStructure read_structure(const StructureSource &s) {
  Mistakes mistakes(s.file, kMostListed), in_map(s.body_map, kMostListed);
  const ParticleData data =
      read_particle_data(s.file,
                         {s.atom_style, s.length_um, s.density_g_cm3, s.z_periodic,
                          s.densities_of_file, s.frame, s.side_x, s.side_y},
                         mistakes);
  const Types types = types_in(s, data, mistakes);
  check_types(types, data, mistakes);
  ExistingStructure g;
  g.lx = data.box.x();
  g.ly = data.box.y();
  for (const DataParticle &p : data.particles) {
    const ExistingSphere sphere{p.id, p.type, p.molecule, p.diameter, p.density, p.x};
    if (types.am.count(p.type))
      g.am.push_back(sphere);
    else if (types.cbd.count(p.type))
      g.cbd.push_back(sphere);
    else
      ++g.left_out;
  }
  if (g.am.empty() && mistakes.empty())
    mistakes.add(0,
                 "it has no particle of active material. Give the whole file, and the types of its "
                 "active material in structure.am_types.");
  sort_by_id(g.am);
  sort_by_id(g.cbd);
  if (s.clusters && !s.body_map.empty()) {
    const std::map<long, long> bodies = read_body_map(s.body_map, in_map);
    if (mistakes.empty() && in_map.empty())
      set_clusters(bodies, g.am, in_map);
  } else if (s.clusters && !data.molecules)
    mistakes.add(0,
                 "its rows ({}) have no molecule ids that identify the clusters. Give "
                 "structure.body_map, or write it with atom_style hybrid sphere molecular.",
                 columns_of(s.atom_style));
  mistakes.add(in_map);
  mistakes.stop_if_any();
  measure_height(data.box.z(), s.z_periodic, g);
  return g;
}

std::string hash_of_structure(const StructureSource &s) {
  if (s.file.empty())
    return "";
  return hash_of_text(hash_of_file(s.file) + (s.body_map.empty() ? "" : hash_of_file(s.body_map)));
}

} // namespace calendem
