// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the folder that `calendem pack` made and finds out whether it is whole.
#include "electrode/pack/packing_state.h"
#include "simulate/run.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

namespace calendem {
namespace fs = std::filesystem;
namespace {

const char *const kAgain = "Make the electrode again with calendem pack.";

/// A text file cut in the middle of a row ends without a newline.
bool ends_with_newline(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(-1, std::ios::end);
  return in.get() == '\n';
}

bool numbers(const std::string &line, std::vector<double> &out) {
  out.clear();
  std::istringstream row(line);
  std::string word;
  while (row >> word) {
    char *end = nullptr;
    out.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0' || !std::isfinite(out.back()))
      return false;
  }
  return true;
}

/// Mean of the spheres of active material.
MeanSphere primary_of(const std::vector<Particle> &particles) {
  constexpr int kActiveMaterial = 1; // atom type
  double n = 0.0, diameters = 0.0, volumes = 0.0, masses = 0.0;
  for (const Particle &p : particles)
    if (p.type == kActiveMaterial) {
      const double volume = std::pow(p.diameter, 3);
      n += 1.0;
      diameters += p.diameter;
      volumes += volume;
      masses += p.density * volume;
    }
  return n > 0.0 ? MeanSphere{diameters / n, masses / volumes} : MeanSphere();
}

/// Particles by tag; mistakes of electrode.data.
std::vector<Particle> read_atoms(const std::string &file, Mistakes &mistakes) {
  std::ifstream in(file);
  std::map<int, Particle> found;
  std::vector<double> row;
  std::string line;
  long announced = 0;
  int number = 1;
  for (; std::getline(in, line) && line != "Atoms"; ++number)
    if (line.find(" atoms") != std::string::npos && announced == 0)
      announced = std::atol(line.c_str());
  bool whole = true;
  for (++number; whole && std::getline(in, line); ++number) {
    if (line.empty())
      continue;
    whole = numbers(line, row) && row.size() == 7 && row[2] > 0.0 && row[3] > 0.0;
    if (!whole)
      mistakes.add(number, "'{}' is not a row 'id type diameter density x y z'. {}",
                   line.substr(0, 80), kAgain);
    else if (const int tag = int(row[0]);
             !found
                  .emplace(tag,
                           Particle{tag, int(row[1]), row[2], row[3], {row[4], row[5], row[6]}, 0})
                  .second)
      mistakes.add(number, "particle {} occurs twice. {}", tag, kAgain);
  }
  const long rows = long(found.size()), cut = !ends_with_newline(file);
  if (whole && announced <= 0)
    mistakes.add(0, "has no line 'N atoms' with N > 0. {}", kAgain);
  else if (whole && (rows != announced || cut))
    mistakes.add(0, "announces {} atoms and holds {} complete rows: it is cut. {}", announced,
                 rows - cut, kAgain);
  std::vector<Particle> out;
  for (const auto &[tag, particle] : found)
    out.push_back(particle);
  return out;
}

/// Gives the particles their bodies; mistakes of bodies.map.
void read_body_map(const std::string &file, std::vector<Particle> &particles, Mistakes &mistakes) {
  std::ifstream in(file);
  std::vector<double> row;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line[0] == '#')
      continue;
    const bool good = numbers(line, row) && row.size() == 2 && row[1] >= 1;
    const auto at = std::lower_bound(particles.begin(), particles.end(), good ? row[0] : HUGE_VAL,
                                     [](const Particle &p, double tag) { return p.tag < tag; });
    if (at == particles.end() || at->tag != row[0] || at->body > 0)
      return mistakes.add(number,
                          "'{}' is not a row 'tag body' with a tag of electrode.data (each once) "
                          "and a body >= 1. {}",
                          line.substr(0, 80), kAgain);
    at->body = int(row[1]);
  }
}

void stop_if_files_are_missing(const std::string &folder) {
  Mistakes mistakes(folder);
  std::error_code none;
  if (!fs::is_directory(folder, none)) {
    mistakes.add(0, "there is no such folder. Make the electrode with calendem pack, or correct "
                    "'electrode' in the case.");
    mistakes.stop_if_any();
  }
  const bool rejected = fs::exists(fs::path(folder) / "electrode.rejected.json", none);
  for (const char *name :
       {"electrode.data", "bodies.map", "electrode.in", "electrode.json", "bodies.csv"})
    if (!fs::is_regular_file(fs::path(folder) / name, none))
      mistakes.add(0, "'{}' is missing. {}", name,
                   rejected ? "The packing missed its targets, see "
                              "electrode.rejected.json; pack with other settings."
                            : "Make the electrode with calendem pack.");
  mistakes.stop_if_any();
}

} // namespace

ElectrodeFacts describe_electrode(const nlohmann::json &j) {
  ElectrodeFacts e;
  e.lx = j.at("cell_um").at(0);
  e.ly = j.at("cell_um").at(1);
  e.area = e.lx * e.ly;
  e.thickness = j.at("thickness_um");
  const double volume = e.area * e.thickness;
  e.solid = volume * (1.0 - j.at("porosity_total").get<double>());
  e.bonds = j.at("bonds");
  e.bodies = j.at("bodies");
  const nlohmann::json &recipe = j.at("recipe");
  e.lattice = std::stod(recipe.at("particles.lattice_um").get<std::string>());
  e.facet = j.value("facet_um2", e.lattice * e.lattice);
  for (const char *key : {"particles.primary_diameter_um", "cbd.diameter_um"})
    e.widest = std::max(e.widest, std::stod(recipe.at(key).get<std::string>()));
  if (recipe.contains("cbd.nanoporosity_percent"))
    e.nanoporosity = 0.01 * std::stod(recipe["cbd.nanoporosity_percent"].get<std::string>());
  e.primaries = j.at("primaries");
  e.am = e.primaries * std::pow(e.lattice, 3);
  e.cbd_envelope = volume * (1.0 - j.at("porosity_macro").get<double>()) - e.am;
  return e;
}

std::vector<Particle> electrode_particles(const std::string &folder, Mistakes &data,
                                          Mistakes &map) {
  std::vector<Particle> particles = read_atoms(folder + "/electrode.data", data);
  if (data.empty())
    read_body_map(folder + "/bodies.map", particles, map);
  return particles;
}

ElectrodeFacts read_electrode(const std::string &folder) {
  stop_if_files_are_missing(folder);
  ElectrodeFacts e;
  Mistakes description(folder + "/electrode.json"), data(folder + "/electrode.data"),
      map(folder + "/bodies.map"), script(folder + "/electrode.in");
  try {
    std::ifstream in(folder + "/electrode.json");
    e = describe_electrode(nlohmann::json::parse(in));
  } catch (const std::exception &x) { // cut, edited, or of another program
    description.add(0, "cannot be used: {}. {}", x.what(), kAgain);
  }
  const std::vector<Particle> particles = electrode_particles(folder, data, map);
  e.atoms = long(particles.size());
  e.primary = primary_of(particles);
  const auto rows = std::count_if(particles.begin(), particles.end(),
                                  [](const Particle &p) { return p.body > 0; });
  if (data.empty() && map.empty() && description.empty() && rows != e.primaries)
    map.add(0, "holds {} primaries, electrode.json says {}: it is cut or of another electrode. {}",
            rows, e.primaries, kAgain);
  if (!ends_with_newline(folder + "/electrode.in"))
    script.add(0, "is cut. {}", kAgain);
  Mistakes all;
  for (const Mistakes *of_file : {&description, &data, &map, &script})
    all.add(*of_file);
  all.stop_if_any();
  return e;
}

} // namespace calendem
