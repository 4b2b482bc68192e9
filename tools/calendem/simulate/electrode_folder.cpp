// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the folder that `calendem pack` made and finds out whether it is whole.
#include "simulate/run.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
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

/// Mean of the spheres of active material, one row of electrode.data after the other.
class PrimaryMean {
public:
  void add(const std::vector<double> &row) {
    if (row[1] != kActiveMaterial)
      return;
    const double volume = std::pow(row[2], 3);
    ++n_;
    diameters_ += row[2];
    volumes_ += volume;
    masses_ += row[3] * volume;
  }
  MeanSphere mean() const {
    return n_ > 0 ? MeanSphere{diameters_ / n_, masses_ / volumes_} : MeanSphere();
  }

private:
  static constexpr double kActiveMaterial = 1; // atom type
  long n_ = 0;
  double diameters_ = 0.0, volumes_ = 0.0, masses_ = 0.0;
};

/// Tags of the atoms; number and mean of them in `e`; mistakes of electrode.data.
std::set<long> read_atoms(const std::string &file, ElectrodeFacts &e, Mistakes &mistakes) {
  long &announced = e.atoms;
  PrimaryMean primaries;
  std::ifstream in(file);
  std::set<long> tags;
  std::vector<double> row;
  std::string line;
  announced = 0;
  int number = 1;
  for (; std::getline(in, line) && line != "Atoms"; ++number)
    if (line.find(" atoms") != std::string::npos && announced == 0)
      announced = std::atol(line.c_str());
  for (++number; std::getline(in, line); ++number) {
    if (line.empty())
      continue;
    if (!numbers(line, row) || row.size() != 7 || row[2] <= 0.0 || row[3] <= 0.0) {
      mistakes.add(number, fmt::format("'{}' is not a row 'id type diameter density x y z'. {}",
                                       line.substr(0, 80), kAgain));
      return tags;
    }
    if (!tags.insert(static_cast<long>(row[0])).second)
      mistakes.add(number, fmt::format("particle {} occurs twice. {}", row[0], kAgain));
    primaries.add(row);
  }
  e.primary = primaries.mean();
  if (announced <= 0)
    mistakes.add(0, fmt::format("has no line 'N atoms' with N > 0. {}", kAgain));
  else if (static_cast<long>(tags.size()) != announced || !ends_with_newline(file))
    mistakes.add(0, fmt::format("announces {} atoms and holds {} complete rows: it is cut. {}",
                                announced,
                                static_cast<long>(tags.size()) - !ends_with_newline(file), kAgain));
  return tags;
}

/// Rows of bodies.map; mistakes in it.
long read_body_map(const std::string &file, const std::set<long> &tags, Mistakes &mistakes) {
  std::ifstream in(file);
  std::set<long> seen;
  std::vector<double> row;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line[0] == '#')
      continue;
    if (!numbers(line, row) || row.size() != 2 || row[1] < 1 ||
        !seen.insert(static_cast<long>(row[0])).second || !tags.count(static_cast<long>(row[0]))) {
      mistakes.add(number, fmt::format("'{}' is not a row 'tag body' with a tag of electrode.data "
                                       "(each once) and a body >= 1. {}",
                                       line.substr(0, 80), kAgain));
      break;
    }
  }
  return static_cast<long>(seen.size());
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
      mistakes.add(0, fmt::format("'{}' is missing. {}", name,
                                  rejected ? "The packing missed its targets, see "
                                             "electrode.rejected.json; pack with other settings."
                                           : "Make the electrode with calendem pack."));
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

ElectrodeFacts read_electrode(const std::string &folder) {
  stop_if_files_are_missing(folder);
  ElectrodeFacts e;
  Mistakes description(folder + "/electrode.json"), data(folder + "/electrode.data"),
      map(folder + "/bodies.map"), script(folder + "/electrode.in");
  try {
    std::ifstream in(folder + "/electrode.json");
    e = describe_electrode(nlohmann::json::parse(in));
  } catch (const std::exception &x) { // cut, edited, or of another program
    description.add(0, fmt::format("cannot be used: {}. {}", x.what(), kAgain));
  }
  const std::set<long> tags = read_atoms(folder + "/electrode.data", e, data);
  const long rows = data.empty() ? read_body_map(folder + "/bodies.map", tags, map) : 0;
  if (data.empty() && map.empty() && description.empty() && rows != e.primaries)
    map.add(0, fmt::format("holds {} primaries, electrode.json says {}: it is cut or of another "
                           "electrode. {}",
                           rows, e.primaries, kAgain));
  if (!ends_with_newline(folder + "/electrode.in"))
    script.add(0, fmt::format("is cut. {}", kAgain));
  Mistakes all;
  for (const Mistakes *of_file : {&description, &data, &map, &script})
    all.add(*of_file);
  all.stop_if_any();
  return e;
}

} // namespace calendem
