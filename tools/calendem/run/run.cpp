// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/run.h"
#include "physics/hertz_contact.h"
#include "run/collect.h"
#include "run/process.h"
#include "spec/case.h"
#include "spec/provenance.h"
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <sstream>
#include <unistd.h>

namespace calendem {
namespace fs = std::filesystem;
namespace {

const char *const kStages[] = {"hold", "compression", "dwell", "relaxation", "done"};

void check_collapse(const Settings &s, const char *phase, double radius, Mistakes &mistakes) {
  const std::string at = fmt::format("material.{}.", phase);
  const double E = 1e6 * s.number(at + "youngs_modulus_GPa"), nu = s.number(at + "poisson");
  const double ced = 1e-3 * s.number(at + "ced_J_m3");
  const double overlap =
      sjkr_equilibrium_overlap(ced, effective_modulus(E, nu, E, nu), 0.5 * radius);
  if (overlap > 0.1 * radius)
    mistakes.add(
        0, fmt::format("{}ced_J_m3 = {} against {}youngs_modulus_GPa = {} pulls two spheres {:.3g} "
                       "um into each other, more than a tenth of their radius ({} um): the packing "
                       "would collapse. The overlap scales as (CED/E)^2; lower the CED or raise E.",
                       at, s.text(at + "ced_J_m3"), at, s.text(at + "youngs_modulus_GPa"), overlap,
                       radius));
}

void check_case(const Settings &s, const ElectrodeFacts &e, const RunOptions &o) {
  Mistakes mistakes("case");
  check_collapse(s, "am", 0.5 * e.primary_diameter, mistakes);
  check_collapse(s, "cbd", 0.658, mistakes);
  const double cut_off = 1.1 * e.primary_diameter + 0.25;
  if (std::min(e.lx, e.ly) < 2.0 * cut_off)
    mistakes.add(
        0,
        fmt::format("the cell is {} x {} um; a periodic side must be at least two cut-offs, {:.2f} "
                    "um, or a particle touches two images of another. Pack a larger cell.",
                    e.lx, e.ly, 2.0 * cut_off));
  const double lowest = 1.02 * e.solid / e.area;
  const std::string &control = s.text("platen.control");
  const double target = control == "thickness" ? s.number("platen.thickness_um")
                        : control == "displacement"
                            ? e.thickness - s.number("platen.displacement_um")
                            : e.thickness;
  if (target < lowest)
    mistakes.add(
        0, fmt::format(
               "the platen is sent to {:.2f} um, but the solid alone fills {:.2f} um. Ask for a "
               "thickness above that.",
               target, lowest));
  if (control != "pressure" && target >= e.thickness)
    mistakes.add(
        0, fmt::format("the platen is sent to {:.2f} um and starts at {:.2f} um: nothing would be "
                       "compressed.",
                       target, e.thickness));
  if (!fs::exists(o.liggghts))
    mistakes.add(0, fmt::format("no program '{}'. Build it with tools/build.", o.liggghts));
  mistakes.stop_if_any();
}

double target_share(const Settings &s, const RawRow &row) {
  if (row.stage > 2.5)
    return 1.0;
  const std::string &control = s.text("platen.control");
  if (control == "pressure")
    return row.p_top / s.number("platen.max_pressure_MPa");
  return control == "displacement" ? row.displacement / s.number("platen.displacement_um")
                                   : row.stage > 1.5;
}

/// Shows the progress line; on a terminal in place, else a line every half minute.
class Progress {
public:
  Progress(const std::string &curve, const Settings &s) : curve_(curve), settings_(s) {}
  void operator()() {
    const auto now = std::chrono::steady_clock::now();
    const double since = std::chrono::duration<double>(now - shown_).count();
    if (since < (isatty(1) ? 1.0 : 30.0))
      return;
    shown_ = now;
    const std::vector<RawRow> rows = read_raw(curve_);
    if (rows.empty())
      return;
    const RawRow &r = rows.back();
    const double share = std::min(1.0, target_share(settings_, r));
    const std::string text = fmt::format(
        "{:11} {:3.0f} %  {:7.2f} MPa  gap {:.2f} um  {:.2f} % of bonds broken  {:.0f} s",
        kStages[static_cast<int>(r.stage)], 100 * share, r.p_top, r.gap,
        r.made > 0 ? 100 * r.broken / r.made : 0.0,
        std::chrono::duration<double>(now - begin_).count());
    if (isatty(1))
      std::cout << "\r\033[K" << text << std::flush;
    else
      std::cout << text << std::endl;
  }

private:
  std::string curve_;
  const Settings &settings_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now(), shown_ = begin_;
};

std::vector<std::pair<std::string, std::string>> script_settings(const Settings &s) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Key &key : case_keys())
    if (!key.variable.empty())
      out.emplace_back(key.variable, s.text(key.name));
  return out;
}

void prepare_folder(const RunOptions &o, const std::string &hash) {
  std::error_code error;
  fs::create_directories(fs::path(o.folder) / "vtk", error);
  if (error || access(o.folder.c_str(), W_OK) != 0)
    throw Failure(
        kBadInput,
        fmt::format("cannot write into '{}'. Give a folder that you may write to", o.folder));
  std::ifstream in(o.folder + "/summary.json");
  if (!in || o.force)
    return;
  const nlohmann::json old = nlohmann::json::parse(in, nullptr, false);
  if (!old.is_discarded() && old.value("case_hash", "") != hash && !o.resume)
    throw Failure(
        kBadInput,
        fmt::format(
            "'{}' holds a finished run of another case, electrode, program or scripts. Give "
            "another -o, or --force to overwrite it",
            o.folder));
}

bool already_done(const RunOptions &o, const std::string &hash) {
  std::ifstream in(o.folder + "/summary.json");
  if (!in)
    return false;
  const nlohmann::json old = nlohmann::json::parse(in, nullptr, false);
  return !old.is_discarded() && old.value("case_hash", "") == hash && old.value("finished", false);
}

void clear_old_results(const std::string &folder) {
  for (const char *name :
       {"curve_raw.csv", "breaks.csv", "curve.csv", "summary.json", "bodies.csv", "running.restart",
        "compressed.restart", "final.restart", "time_step.in"})
    fs::remove(fs::path(folder) / name);
  for (const auto &entry : fs::directory_iterator(fs::path(folder) / "vtk"))
    fs::remove(entry.path());
}

} // namespace

ElectrodeFacts read_electrode(const std::string &folder) {
  Mistakes mistakes(folder);
  for (const char *name :
       {"electrode.data", "bodies.map", "electrode.in", "electrode.json", "bodies.csv"})
    if (!fs::exists(fs::path(folder) / name))
      mistakes.add(0, fmt::format("'{}' is missing. Make the electrode with calendem pack.", name));
  mistakes.stop_if_any();
  std::ifstream json(folder + "/electrode.json"), data(folder + "/electrode.data");
  const nlohmann::json j = nlohmann::json::parse(json, nullptr, false);
  ElectrodeFacts e;
  long rows = 0;
  std::string line;
  bool in_atoms = false;
  while (std::getline(data, line)) {
    if (!in_atoms && line.find("atoms") != std::string::npos)
      e.atoms = std::atol(line.c_str());
    if (in_atoms && !line.empty()) {
      std::istringstream row(line);
      double v = 0.0;
      int columns = 0;
      while (row >> v)
        ++columns;
      rows += columns == 7;
    }
    in_atoms = in_atoms || line == "Atoms";
  }
  if (rows != e.atoms || e.atoms == 0)
    mistakes.add(
        0,
        fmt::format("electrode.data announces {} atoms and holds {} complete rows: it is cut. Make "
                    "the electrode again.",
                    e.atoms, rows));
  if (j.is_discarded() || !j.contains("thickness_um"))
    mistakes.add(0, "electrode.json cannot be read. Make the electrode again.");
  mistakes.stop_if_any();
  e.lx = j["cell_um"][0];
  e.ly = j["cell_um"][1];
  e.area = e.lx * e.ly;
  e.thickness = j["thickness_um"];
  const double volume = e.area * e.thickness;
  e.solid = volume * (1.0 - j["porosity_total"].get<double>());
  e.bonds = j["bonds"];
  e.bodies = j["bodies"];
  e.lattice = std::stod(j["recipe"]["particles.lattice_um"].get<std::string>());
  e.primary_diameter = std::stod(j["recipe"]["particles.primary_diameter_um"].get<std::string>());
  e.am = j["primaries"].get<double>() * std::pow(e.lattice, 3);
  e.cbd_envelope = volume * (1.0 - j["porosity_macro"].get<double>()) - e.am;
  return e;
}

void run_case(Settings settings, const RunOptions &o) {
  const ElectrodeFacts electrode = read_electrode(settings.text("electrode"));
  check_case(settings, electrode, o);
  std::string identity = version() + hash_of_file(o.liggghts) +
                         hash_of_file(input_scripts() + "/in.compression") +
                         hash_of_file(input_scripts() + "/in.relaxation") +
                         hash_of_folder(input_scripts() + "/common") +
                         hash_of_file(settings.text("electrode") + "/electrode.data");
  for (const auto &[key, value] : settings.all())
    if (key != "electrode")
      identity += key + "=" + value + "\n";
  const std::string hash = hash_of_text(identity);
  prepare_folder(o, hash);
  if (already_done(o, hash)) {
    fmt::print("run: {} already holds this run\n", o.folder);
    return;
  }
  const std::string folder = fs::absolute(o.folder).string();
  const bool resume =
      o.resume && fs::exists(folder + "/running.restart") && fs::exists(folder + "/time_step.in");
  if (o.resume && !resume)
    fmt::print("run: no restart file in {}; starting from the electrode\n", o.folder);
  if (!resume)
    clear_old_results(folder);
  write_file(
      folder + "/case.toml",
      write_toml(settings, case_keys(),
                 fmt::format("# as run by calendem {}; every default filled in\n", version())));
  fs::copy_file(settings.text("electrode") + "/electrode.json", folder + "/electrode.json",
                fs::copy_options::overwrite_existing);
  LiggghtsJob job;
  job.program = o.liggghts;
  job.ranks = o.ranks;
  job.script = input_scripts() + "/in.calendering";
  job.log = folder + "/log.liggghts";
  job.screen = folder + "/screen.txt";
  job.variables = script_settings(settings);
  job.variables.insert(
      job.variables.end(),
      {{"out", folder}, {"scripts", input_scripts()}, {"resuming", resume ? "1" : "0"}});
  fmt::print("run: {} atoms, {} bonds, {} ranks -> {}\n", electrode.atoms, electrode.bonds, o.ranks,
             folder);
  std::cout << std::flush;
  const auto begin = std::chrono::steady_clock::now();
  Progress progress(folder + "/curve_raw.csv", settings);
  run_liggghts(job, [&] { progress(); });
  if (isatty(1))
    std::cout << "\r\033[K";
  RunFacts facts;
  facts.wall_clock_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  facts.ranks = o.ranks;
  facts.case_hash = hash;
  facts.program = hash_of_file(o.liggghts);
  const nlohmann::json s = collect(folder, settings, electrode, facts);
  fmt::print("run: maximum {:.1f} MPa, {:.2f} % of bonds broken, total porosity {:.2f} % after "
             "relaxation, {:.0f} s\n",
             s["max_pressure_MPa"].get<double>(), 100 * s["broken_fraction_at_max"].get<double>(),
             100 * s["porosity_after_relaxation"].get<double>(), facts.wall_clock_s);
}

} // namespace calendem
