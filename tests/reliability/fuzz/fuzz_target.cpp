// SPDX-License-Identifier: GPL-2.0-or-later
// One reader under libFuzzer: every input either works or throws Failure with exit status 2 and a
// message. Environment, set by fuzz.sh: FUZZ_TARGET, which one; FUZZ_FOLDER, an empty folder.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <string>

#include "bank/runs.h"
#include "base/case.h"
#include "base/csv_table.h"
#include "base/experiment.h"
#include "base/messages.h"
#include "base/plain_text.h"
#include "base/recipe.h"
#include "electrode/pack/from_image.h"
#include "electrode/pack/from_structure.h"
#include "electrode/pack/measured_bodies.h"
#include "electrode/slurry/dry.h"
#include "electrode/structure/existing_structure.h"
#include "electrode/tomogram.h"
#include "press/press_curve.h"
#include "simulate/study_file.h"

namespace {

std::string from_environment(const char *name) {
  const char *value = std::getenv(name);
  return value ? value : "";
}
const std::string &folder() {
  static const std::string name = from_environment("FUZZ_FOLDER");
  return name;
}
const std::string &file() {
  static const std::string name = folder() + "/input";
  return name;
}
void put(const std::string &path, const std::string &text) {
  std::ofstream(path, std::ios::binary) << text;
}
void demand(bool holds) {
  if (!holds)
    std::abort();
}

void recipe(const std::string &) { calendem::read_recipe(file()); }
void case_(const std::string &) { calendem::read_case(file()); }
void experiment(const std::string &) { calendem::read_experiment(file()); }
void csv(const std::string &text) {
  for (const calendem::CsvTable &table :
       {calendem::CsvTable::parse(text), calendem::CsvTable::parse_export(text)})
    for (const std::string &column : table.header())
      if (table.has(column))
        demand(table.numbers(column).size() == table.rows() &&
               (table.ambiguous() + table.guess()).find('\r') == text.npos);
}

// The first byte says whether the disc's size is known; the export follows.
void press(const std::string &text) {
  if (text.empty())
    return;
  put(file(), text.substr(1));
  calendem::PressFormat format;
  format.area_mm2 = text[0] & 1 ? 95.0 : 0.0;
  const calendem::PressExport from = calendem::read_press_export(file(), format);
  calendem::PressCurve curve = calendem::make_press_curve(file(), from, 0.2);
  calendem::subtract_machine(curve, curve);
  demand(curve.contact < from.pressure.size() && curve.pressure.size() == curve.stage.size() &&
         curve.pressure.size() == curve.displacement.size());
  const calendem::CsvTable table =
      calendem::CsvTable::parse(calendem::curve_table(curve, "# [press]\n"));
  demand(table.rows() == curve.pressure.size() && table.bad_lines().empty());
}

// An image of 1 to 16 voxels along each axis (bytes 0 to 2) whose labels -1 to 2 follow, as NumPy has
// it; byte 3: its phases are named, it is the electrode itself, which axis leads up. Particles are
// separated, made shapes and put into the film.
void image_places(const std::string &text) {
  if (text.size() < 4)
    return;
  const auto size = [&](int k) { return (text[k] & 15) + 1; };
  std::string labels = text.substr(4);
  labels.resize(std::size_t(size(0)) * size(1) * size(2));
  for (char &c : labels)
    c = char((c & 3) - 1);
  std::string head = "{'descr': '|i1', 'fortran_order': False, 'shape': (" +
                     std::to_string(size(2)) + ", " + std::to_string(size(1)) + ", " +
                     std::to_string(size(0)) + "), }";
  head.resize(117, ' ');
  put(folder() + "/image.npy", std::string("\x93NUMPY\x01\0v\0", 10) + head + "\n" + labels);
  const bool places = text[3] & 2;
  const char *const upwards[] = {"z", "x", "-y", "-z"};
  put(file(), std::string("[particles]\nlattice_um = 0.8\nprimary_diameter_um = 1\n[shapes]\n"
                          "image = \"image.npy\"\nvoxel_size_um = 1\n") +
                  (text[3] & 1 ? "phases = { pore = 0, am = 1, cbd = 2 }\n" : "background = -1\n") +
                  (places ? std::string("places = \"image\"\nupwards = \"") +
                                upwards[text[3] >> 2 & 3] + "\"\n"
                          : ""));
  const calendem::Recipe recipe = calendem::read_recipe(file());
  if (!places)
    return demand(!calendem::library_of(recipe).shapes.empty());
  const calendem::PackInput in = calendem::read_input(recipe);
  demand(in.image->shapes.size() == in.structure.am.size() && in.recipe.loading > 0.0);
  for (const auto *phase : {&in.structure.am, &in.structure.cbd})
    for (const calendem::ExistingSphere &s : *phase)
      demand(s.x.allFinite() && s.x.z() > 0.0 && s.x.z() < in.structure.thickness);
}

// The first byte says how the data file is to be read; the file follows.
void structure(const std::string &text) {
  if (text.empty())
    return;
  put(file(), text.substr(1));
  const char *const styles[] = {"sphere", "granular", "bpm/sphere", "hybrid"};
  calendem::StructureSource source;
  source.file = file();
  source.atom_style = styles[text[0] & 3];
  source.z_periodic = text[0] & 4;
  source.clusters = text[0] & 8;
  source.body_map = text[0] & 16 ? file() : "";
  source.am_types = {"1", "2"};
  source.cbd_types = {"3"};
  source.densities_of_file = !(text[0] & 32);
  source.side_x = source.side_y = 12.0;
  const calendem::ExistingStructure g = calendem::read_structure(source);
  for (const auto *phase : {&g.am, &g.cbd})
    for (const calendem::ExistingSphere &p : *phase)
      demand(p.diameter > 0.0 && p.density > 0.0 && p.x.allFinite() && p.x.z() > 0.0);
  demand(!g.am.empty() && g.thickness > 0.0 && g.thickness <= g.extent);
}

// The study, and after a form feed the design that it may name; recipe and case are sound.
void study(const std::string &text) {
  const std::size_t cut = text.find('\f');
  put(file(), text.substr(0, cut));
  put(folder() + "/design.csv", cut == std::string::npos ? "" : text.substr(cut + 1));
  put(folder() + "/recipe.toml", "seed = 1\n");
  put(folder() + "/case.toml", "electrode = \"x\"\n");
  const calendem::Study s = calendem::read_study(file());
  demand(!s.runs.empty());
  for (const calendem::StudyRun &r : s.runs)
    demand(r.values.size() == s.columns.size() && r.recipe.cell_x > 0.0);
  for (const double p : s.at_pressure)
    demand(p > 0.0 && std::isfinite(p));
}

void bank(const std::string &) {
  const calendem::bank::Bank b = calendem::bank::read_bank(file());
  demand(!b.design.inputs.empty() && b.design.packings > 1 && b.design.points > 0);
  for (const calendem::bank::Input &i : b.design.inputs)
    demand(i.low < i.high && std::isfinite(i.high - i.low) && !i.keys.empty());
}

// A table of the films' bank.
void bank_table(const std::string &) {
  const calendem::bank::Bank spec = calendem::bank::read_bank(from_environment("FUZZ_BANK"));
  const calendem::bank::Runs runs = calendem::bank::read_runs(spec, file());
  for (const calendem::bank::Run &run : runs.runs)
    demand(run.point.number > 0 && run.point.packing > 0 &&
           run.point.values.size() == spec.design.inputs.size());
  const std::string written = calendem::bank::write_runs(runs);
  put(file(), written);
  demand(calendem::bank::write_runs(calendem::bank::read_runs(spec, file())) == written);
}

void film(const std::string &) {
  const calendem::FilmRecipe f = calendem::read_film_recipe(file());
  for (const double v : {f.slurry_thickness(), f.slurry_density(), f.wet_diameter(),
                         f.wet_density(), f.recipe.thickness(), f.tolerance_points})
    demand(v > 0.0 && std::isfinite(v));
  demand(f.wet_diameter() > f.recipe.cbd_diameter);
}

void tomogram(const std::string &) {
  const calendem::TomogramSpec t = calendem::read_tomogram_spec(file());
  demand(t.voxel > 0.0 && t.size.minCoeff() > 0.0 && t.size.allFinite());
  demand(t.min_diameter < t.max_diameter && t.pores >= 0 && t.solid_fraction > 0.0);
}

using Reader = void (*)(const std::string &);

Reader wanted() {
  static const std::map<std::string, Reader> readers = {{"recipe", recipe},
                                                        {"case_", case_},
                                                        {"experiment", experiment},
                                                        {"csv", csv},
                                                        {"press", press},
                                                        {"image_places", image_places},
                                                        {"structure", structure},
                                                        {"study", study},
                                                        {"bank", bank},
                                                        {"bank_table", bank_table},
                                                        {"film", film},
                                                        {"tomogram", tomogram}};
  return readers.at(from_environment("FUZZ_TARGET"));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char *data, std::size_t size) {
  static const Reader reader = wanted();
  const std::string text(reinterpret_cast<const char *>(data), size);
  put(file(), text);
  try {
    reader(text);
  } catch (const calendem::Failure &f) {
    if (f.exit_status() != calendem::kBadInput || std::strlen(f.what()) < 10)
      std::abort();
  }
  return 0;
}
