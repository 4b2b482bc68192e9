// SPDX-License-Identifier: GPL-2.0-or-later
// report, compare, measure: what is read off runs.
#include "report/report.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "compare/gap.h"
#include "measure/structure.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

struct CompareOptions {
  std::string experiment, folder = "gap";
  std::vector<std::string> runs;
};

void print_rows(const std::vector<Residual> &rows) {
  const auto name = [](const Residual &r) {
    return r.observable + (r.unit.empty() ? "" : ", " + r.unit);
  };
  std::size_t width = 0;
  for (const Residual &r : rows)
    width = std::max(width, name(r).size());
  fmt::print("{:<6} {:<{}} {:>9} {:>9} {:>9} {:>7} {:>6}\n", "", "", width, "measured", "simulated",
             "differ by", "z", "share");
  for (const Residual &r : rows)
    fmt::print("{:<6} {:<{}} {:>9.4g} {:>9.4g} {:>+9.3g} {:>+7.1f} {:>5.0f}%\n", r.condition,
               name(r), width, r.measured, r.simulated, r.residual, r.z, 100.0 * r.share);
}

void compare(const CompareOptions &o) {
  const Experiment experiment = read_experiment(o.experiment);
  std::vector<SimulatedRun> runs;
  Mistakes mistakes;
  for (const std::string &folder : o.runs)
    try {
      runs.push_back(read_simulated_run(folder));
    } catch (const Failure &f) {
      mistakes.add(f);
    }
  mistakes.stop_if_any();
  const Gap gap = find_gap(experiment, runs);
  nlohmann::ordered_json j = to_json(gap);
  j["provenance"]["experiment_file"] = hash_of_file(o.experiment);
  for (const std::string &folder : o.runs)
    j["provenance"]["runs"][folder] = hash_of_file(folder + "/summary.json");
  make_output_folder(o.folder);
  write_gap(j, gap_page(j), o.folder);
  print_rows(gap.rows);
  for (const std::string &text : gap.said)
    fmt::print("* {}\n", text);
  for (const std::string &text : gap.not_said)
    fmt::print("- {}\n", text);
  fmt::print("page: {0}/gap.html\ndata: {0}/gap.json\n", o.folder);
}

} // namespace

void add_compare_verb(CLI::App &app) {
  auto o = std::make_shared<CompareOptions>();
  CLI::App *verb = app.add_subcommand(
      "compare", "Compare runs with an experiment: every residual with its uncertainty");
  verb->add_option("EXPERIMENT", o->experiment, "experiment file (TOML)")->required();
  verb->add_option("DIR", o->runs,
                   "directories made by calendem run; several packings per "
                   "condition give the scatter")
      ->required();
  verb->add_option("-o,--output", o->folder, "folder for gap.json and gap.html")
      ->capture_default_str();
  verb->callback([o] { compare(*o); });
}

void add_report_verb(CLI::App &app) {
  struct Options {
    std::vector<std::string> directories;
    std::string page;
  };
  const auto options = std::make_shared<Options>();
  CLI::App *verb = app.add_subcommand(
      "report", "Write one self-contained page with charts and pictures of one or more runs");
  verb->add_option("DIR", options->directories, "folders made by calendem run")
      ->required()
      ->type_name("");
  verb->add_option("-o,--output", options->page,
                   "Page to write; its data go to the same name with .json. Default: report.html "
                   "in the run's directory, or here if there are several")
      ->type_name("FILE.html");
  verb->callback([options] { report::write_report(options->directories, options->page); });
}

namespace fs = std::filesystem;
namespace {

constexpr double kLargestForPorosity = 0.2; // um

struct Arguments {
  std::string input, output;
  MeasureOptions options;
  double voxel_um = 0.0, nanoporosity_percent = 50.0;
  std::int32_t cbd_label = 0;
  bool without_tortuosity = false, images = false;
};

void print(const StructureMeasures &m) {
  const auto percent = [](double v) {
    return std::isfinite(v) ? fmt::format("{:.2f} %", 100 * v) : std::string("not known");
  };
  fmt::print(
      "measure: {}: thickness {:.2f} um, porosity total {}, macro {}, pore-solid area {:.3f} "
      "/um\n",
      m.moment, m.thickness_um, percent(m.porosity.total), percent(m.porosity.macro),
      m.surface.pore_solid());
  if (m.coordination)
    fmt::print("measure: {}: a body touches {:.2f} bodies and {:.2f} CBD spheres\n", m.moment,
               m.coordination->am_am, m.coordination->am_cbd);
  for (size_t axis = 0; axis < m.tortuosity.size(); ++axis) {
    const Tortuosity &t = m.tortuosity[axis];
    fmt::print("measure: {}: tau along {} {:.3f}{}\n", m.moment, "xyz"[axis], t.tau,
               t.effective <= 0.0 ? ": no path of pore voxels leads through"
               : t.extrapolated
                   ? fmt::format(" for voxels of size 0, {:.3f} on {}", t.tau_on_voxels(),
                                 t.stride == 1
                                     ? "all voxels"
                                     : fmt::format("voxels of {} times the size", t.stride))
                   : ", an upper bound: no path on voxels of twice the size");
  }
  const double largest = m.voxel.maxCoeff();
  if (largest > kLargestForPorosity * (1.0 + 1e-6)) // images hold single precision
    fmt::print(stderr, "note: voxels of {:.3g} um; porosity is defined on {} um or less\n", largest,
               kLargestForPorosity);
}

nlohmann::json provenance(const Arguments &a, bool is_run) {
  nlohmann::json p = {{"calendem", version()}, {"source", a.input}, {"hashes", "64-bit FNV-1a"}};
  p[is_run ? "curve" : "image"] =
      is_run ? hash_of_file(a.input + "/curve.csv") : hash_of_image(a.input);
  return p;
}

/// Every moment as a label image: pores 0, CBD -1, bodies from 1.
void write_images(const Arguments &a, const std::string &folder) {
  for (const RunMoment &moment : moments_of_run(a.input)) {
    if (!a.options.moment.empty() && moment.name != a.options.moment)
      continue;
    const SimulatedStructure &s = moment.structure;
    const std::string file = folder + "/" + moment.name + ".mha";
    write_label_image(
        voxelise(s.spheres, s.cell, s.lattice, a.options.voxel_um.value_or(kSimulatedVoxel)), file);
    fmt::print("measure: {}: pores 0, CBD -1, particles from 1\n", file);
  }
}

void measure(Arguments a, const CLI::App &verb) {
  const bool is_run = fs::is_directory(a.input);
  if (!fs::exists(a.input) && a.input.find('%') == std::string::npos) // a pattern names a series
    throw Failure(kBadInput,
                  "{}: no such file or folder. Give the folder of a run, or a label image.",
                  a.input);
  if (a.images && !is_run)
    throw Failure(kBadInput, "--images is for a run; '{}' is not a folder.", a.input);
  if (a.output.empty() && !is_run)
    throw CLI::RequiredError("--output");
  const std::string folder = a.output.empty() ? a.input : a.output;
  if (a.voxel_um > 0.0)
    a.options.voxel_um = a.voxel_um;
  if (verb.count("--cbd-label") > 0) {
    a.options.cbd_label = a.cbd_label;
    a.options.nanoporosity = 0.01 * a.nanoporosity_percent;
  }
  a.options.tortuosity = !a.without_tortuosity;
  const bool is_new = !std::filesystem::exists(folder);
  make_output_folder(folder); // it may not be possible, and what follows takes long
  std::vector<StructureMeasures> moments;
  try {
    moments = is_run ? measure_run(a.input, a.options)
                     : std::vector<StructureMeasures>{measure_image(a.input, a.options)};
  } catch (...) {
    if (std::error_code none; is_new)
      std::filesystem::remove(folder, none);
    throw;
  }
  nlohmann::json j = {{"definitions", structure_definitions()},
                      {"moments", nlohmann::json::array()},
                      {"provenance", provenance(a, is_run)}};
  for (const StructureMeasures &m : moments) {
    print(m);
    j["moments"].push_back(to_json(m));
  }
  write_file(folder + "/structure.csv", profile_table(moments));
  write_file(folder + "/structure.json", j.dump(2) + "\n");
  fmt::print("measure: {0}/structure.csv, {0}/structure.json\n", folder);
  if (a.images)
    write_images(a, folder);
}

} // namespace

void add_measure_verb(CLI::App &app) {
  auto a = std::make_shared<Arguments>();
  CLI::App *verb = app.add_subcommand(
      "measure",
      "Measure porosity, profiles, surface, contacts and tortuosity of a run or a label image");
  verb->add_option("DIR|IMAGE", a->input,
                   "folder of a run, or a label image whose z runs from collector to platen")
      ->required();
  verb->add_option("-o,--output", a->output,
                   "folder for structure.csv and structure.json (default: the run's)");
  verb->add_option("--voxel-um", a->voxel_um,
                   "voxel size; of a run 0.15 by default; of an image, if its file states none or "
                   "a wrong one")
      ->check(finite_range(0.01, 2.0));
  verb->add_option("--slice-um", a->options.slice_um, "thickness of a slice of the profiles")
      ->capture_default_str()
      ->check(finite_range(0.01, 100.0));
  verb->add_option("--moment", a->options.moment,
                   "measure only this moment of a run; releases: the end of each release")
      ->check(CLI::IsMember({"before", "max", "after", kReleases}));
  verb->add_flag("--without-tortuosity", a->without_tortuosity,
                 "leave out the tortuosity, which takes most of the time");
  verb->add_flag(
      "--images", a->images,
      "write a run's moments, or that of --moment, as label images too: before.mha, max.mha, "
      "after.mha");
  verb->add_option("--background", a->options.background, "label of an image's pores")
      ->capture_default_str();
  verb->add_option("--cbd-label", a->cbd_label, "label of an image's CBD; without it, all is AM");
  verb->add_option("--cbd-nanoporosity-percent", a->nanoporosity_percent,
                   "nanoporosity of an image's CBD, for the total porosity")
      ->capture_default_str()
      ->check(finite_range(0.0, 99.0));
  verb->callback([a, verb] { measure(*a, *verb); });
}

} // namespace calendem
