// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/recipe.h"
#include <cctype>
#include <filesystem>
#include <sstream>

namespace calendem {
namespace fs = std::filesystem;
namespace {

// "1 2, 3" or "AM" as names, each once.
std::set<std::string> types_of(const Settings &s, const std::string &key, Mistakes &mistakes) {
  std::string text = s.text(key);
  std::set<std::string> types;
  if (text == "none" || !s.sound({key}))
    return types;
  for (char &c : text)
    c = c == ',' ? ' ' : c;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    const bool number =
                   word.size() < 8 && word.find_first_not_of("0123456789") == std::string::npos,
               label = std::isalpha(static_cast<unsigned char>(word[0]));
    if (number)
      word = std::to_string(std::stoi(word));
    if (!(number || label) || word == "0" || !types.insert(word).second) {
      mistakes.add(s.line(key),
                   "{} is \"{}\"; it must name whole numbers from 1 or labels of the file, each "
                   "once, such as \"1 2 3\" or \"AM\".",
                   key, s.text(key));
      break;
    }
  }
  return types;
}

void check_types(const Settings &s, const StructureSource &source, Mistakes &mistakes) {
  if (s.line("structure.am_types") == 0)
    mistakes.add(0, "structure.am_types is missing: say which atom types are active material, such "
                    "as \"1 2 3\".");
  if (s.line("structure.cbd_types") == 0)
    mistakes.add(0,
                 "structure.cbd_types is missing: say which atom types are carbon and binder, or "
                 "\"none\".");
  std::set<std::string> seen = source.am_types;
  for (const auto &[key, types] : {std::pair("structure.cbd_types", &source.cbd_types),
                                   std::pair("structure.left_out_types", &source.left_out_types)})
    for (const std::string &type : *types)
      if (!seen.insert(type).second)
        mistakes.add(
            s.line(key),
            "{}: type {} is in another list too; a type is active material, CBD or left out.", key,
            type);
}

void check_files(const Settings &s, const StructureSource &source, Mistakes &mistakes) {
  for (const auto &[key, path] : {std::pair("structure.file", &source.file),
                                  std::pair("structure.body_map", &source.body_map)})
    if (!path->empty() && !fs::is_regular_file(*path))
      mistakes.add(s.line(key), "{} '{}' is not there. Give its path, relative to this file.", key,
                   *path);
  if (!source.body_map.empty() && !source.clusters)
    mistakes.add(s.line("structure.body_map"),
                 "structure.body_map names given bodies, but structure.bodies is \"shapes\". Give "
                 "structure.bodies = \"clusters\" or remove the map.");
}

// Keys that a structure makes idle: whoever gives them expects something else.
void check_idle(const Settings &s, bool clusters, const std::string &source, Mistakes &mistakes) {
  std::vector<std::string> idle = {"particles.median_um", "particles.sigma_ln", "particles.min_um",
                                   "particles.max_um", "shapes.sizes"};
  if (clusters)
    idle.insert(idle.end(), {"particles.irregularity", "shapes.image", "shapes.library"});
  for (const std::string &key : idle)
    if (s.line(key) > 0)
      mistakes.add(s.line(key),
                   "{} has no effect beside {}, which gives the {}. Remove one of them.", key,
                   source, clusters ? "bodies" : "sizes");
}

void read_units(const Settings &s, StructureSource &out, Mistakes &mistakes) {
  const std::string &units = s.text("structure.units");
  out.length_um = s.number("structure.lj_length_um");
  out.density_g_cm3 = s.number("structure.lj_density_g_cm3");
  const bool scaled = out.length_um > 0.0 || out.density_g_cm3 > 0.0;
  if (units != "lj" && scaled)
    mistakes.add(s.line("structure.units"),
                 "structure.lj_length_um and lj_density_g_cm3 are for units \"lj\"; "
                 "structure.units is \"{}\".",
                 units);
  if (units == "lj" && !(out.length_um > 0.0 && out.density_g_cm3 > 0.0))
    mistakes.add(s.line("structure.units"),
                 "structure.units \"lj\" has no scale: give structure.lj_length_um, the length of "
                 "one unit, and structure.lj_density_g_cm3, that of one unit of density.");
  if (units == "none" && s.sound({"structure.units"}))
    mistakes.add(0, "structure.units is missing: a data file does not say its units. Give those of "
                    "the script that wrote it: micro, si, cgs or lj.");
  if (units != "lj") {
    out.length_um = units_named(units).length_um;
    out.density_g_cm3 = units_named(units).density_g_cm3;
  }
}

} // namespace

const std::vector<Key> &structure_keys() {
  static const std::vector<Key> keys = {
      {"structure.file", "", "none", 0, 0, "",
       "data file or dump of LAMMPS or LIGGGHTS, or table x y z r, with the particles", "", true},
      {"structure.atom_style", "", "sphere", 0, 0, "",
       "atom_style of the script that wrote the file; hybrid: sphere or granular first",
       "sphere|granular|bpm/sphere|hybrid"},
      {"structure.units", "", "none", 0, 0, "", "units of the script that wrote the file; required",
       "micro|si|cgs|lj"},
      {"structure.lj_length_um", "", "0", 0, 1e6, "um", "length of one unit, with units lj"},
      {"structure.lj_density_g_cm3", "", "0", 0, 1e6, "g/cm3",
       "density of one unit, with units lj"},
      {"structure.boundary", "", "p p f", 0, 0, "",
       "boundary of the script that wrote the file; z points up from the collector",
       "p p f|p p s|p p m|p p p"},
      {"structure.am_types", "", "none", 0, 0, "",
       "atom types of active material, by number or label: \"1 2 3\"", "", true},
      {"structure.cbd_types", "", "none", 0, 0, "", "atom types of carbon and binder", "", true},
      {"structure.left_out_types", "", "none", 0, 0, "", "atom types to leave out (solvent, walls)",
       "", true},
      {"structure.bodies", "", "shapes", 0, 0, "",
       "shapes: each AM sphere becomes a body of its volume; clusters: given clusters are kept",
       "shapes|clusters"},
      {"structure.body_map", "", "none", 0, 0, "",
       "file with rows 'id body' for clusters; none: molecule ids are used", "", true},
      {"structure.frame", "", "last", 0, 0, "", "time step of a dump's frame, such as \"65000\"",
       "", true},
      {"structure.densities", "", "file", 0, 0, "",
       "densities of the particles: those of the file or those of the recipe", "file|recipe"},
  };
  return keys;
}

DataUnits units_named(const std::string &units) {
  return units == "si"    ? DataUnits{1e6, 1e-3}
         : units == "cgs" ? DataUnits{1e4, 1.0}
                          : DataUnits{1.0, 1.0};
}

StructureSource read_structure_source(const Settings &s, const std::string &file,
                                      Mistakes &mistakes) {
  StructureSource out;
  out.file = path_of(s, "structure.file", file);
  for (const Key &key : structure_keys())
    if (!out.given() && s.sound({"structure.file"}) && s.line(key.name) > 0 &&
        key.name != "structure.file") {
      mistakes.add(s.line(key.name), "[structure] needs structure.file, a data file of LAMMPS or "
                                     "LIGGGHTS.");
      break;
    }
  if (!out.given())
    return out;
  out.body_map = path_of(s, "structure.body_map", file);
  out.atom_style = s.text("structure.atom_style");
  out.z_periodic = s.text("structure.boundary") == "p p p";
  out.clusters = s.text("structure.bodies") == "clusters";
  out.densities_of_file = s.text("structure.densities") == "file";
  out.am_types = types_of(s, "structure.am_types", mistakes);
  out.cbd_types = types_of(s, "structure.cbd_types", mistakes);
  out.left_out_types = types_of(s, "structure.left_out_types", mistakes);
  out.frame = s.text("structure.frame");
  out.side_x = s.line("cell.x_um") > 0 ? s.number("cell.x_um") : 0.0;
  out.side_y = s.line("cell.y_um") > 0 ? s.number("cell.y_um") : 0.0;
  read_units(s, out, mistakes);
  check_types(s, out, mistakes);
  check_files(s, out, mistakes);
  check_idle(s, out.clusters, "[structure]", mistakes);
  return out;
}

void take_places_of_image(const Settings &s, Recipe &recipe, Mistakes &mistakes) {
  if (!recipe.shapes.in_place)
    return;
  if (recipe.structure.given())
    mistakes.add(s.line("shapes.places"), "shapes.places is \"image\", and [structure] has places "
                                          "too. Give one of them.");
  recipe.structure = {};
  recipe.structure.of_image = true;
  recipe.structure.densities_of_file = false;
  recipe.structure.side_x = s.line("cell.x_um") > 0 ? s.number("cell.x_um") : 0.0;
  recipe.structure.side_y = s.line("cell.y_um") > 0 ? s.number("cell.y_um") : 0.0;
  check_idle(s, false, "shapes.places", mistakes);
  if (s.line("particles.irregularity") > 0)
    mistakes.add(s.line("particles.irregularity"),
                 "particles.irregularity has no effect beside shapes.places, which gives the "
                 "shapes. Remove one of them.");
}

} // namespace calendem
