// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/run.h"
#include "base/case.h"
#include "base/liggghts_job.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/recipe.h"
#include "base/run_folder.h"
#include "simulate/collect.h"
#include "simulate/rolling.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <unistd.h>

namespace calendem {
namespace fs = std::filesystem;
namespace {

/// From this share of the target on the pressure grows steadily enough to say when it is reached.
constexpr double kFirmShare = 0.05;

void check_cell(const ElectrodeFacts &e, int ranks, Mistakes &mistakes) {
  const double cut_off = neighbour_cut_off(e.widest);
  if (std::min(e.lx, e.ly) < 2.0 * cut_off)
    mistakes.add(0,
                 "the cell is {} x {} um; a periodic side must be at least two cut-offs, {:.2f} "
                 "um, or a particle touches two images of another. Pack a larger cell.",
                 e.lx, e.ly, 2.0 * cut_off);
  const int most = most_ranks(e.lx, e.ly, e.widest);
  if (ranks > most)
    mistakes.add(0,
                 "--ranks {}: a cell of {} x {} um can be shared by at most {} ranks whose parts "
                 "are wider than a cut-off ({:.2f} um).",
                 ranks, e.lx, e.ly, most, cut_off);
}

double lowest_gap(const ElectrodeFacts &e) { return 1.02 * e.solid / e.area; }

void check_target(const Settings &s, const ElectrodeFacts &e, Mistakes &mistakes) {
  const double lowest = lowest_gap(e);
  const std::string &control = s.text("platen.control");
  if (control == "pressure")
    return;
  const std::string key = "platen." + control + "_um";
  const double target = control == "displacement" ? e.thickness - s.number(key) : s.number(key);
  if (target < lowest)
    mistakes.add(0,
                 "{} = {} sends the platen to {:.2f} um, but the solid alone fills {:.2f} um: no "
                 "film can be thinner. Ask for a thickness above that.",
                 key, s.text(key), target, lowest);
  if (target >= e.thickness)
    mistakes.add(0,
                 "{} = {} sends the platen to {:.2f} um and it starts at {:.2f} um: nothing would "
                 "be compressed.",
                 key, s.text(key), target, e.thickness);
  const std::string first = "roll.first_gap_um";
  if (control == "roll_gap" && s.number(first) >= e.thickness)
    mistakes.add(0,
                 "{} = {} is not below the electrode's {:.2f} um: the first pass would compress "
                 "nothing. Give a smaller one, or 0.",
                 first, s.text(first), e.thickness);
}

/// Where nanopores may fall, they start from what the electrode was packed with.
void check_nanoporosity(const Settings &s, const ElectrodeFacts &e, Mistakes &mistakes) {
  constexpr double kSame = 0.005;
  const std::string key = "effects.cbd_collapse.initial_nanoporosity";
  const bool falls = s.number("effects.cbd_collapse.yield_pressure_MPa") > 0.0 ||
                     s.number("imposed.cbd_nanoporosity_until_MPa") > 0.0;
  if (falls && e.nanoporosity > 0.0 && std::fabs(e.nanoporosity - s.number(key)) > kSame)
    mistakes.add(0,
                 "{} is {}, but the electrode was packed with a nanoporosity of {:.3g} "
                 "(cbd.nanoporosity_percent of its recipe). Give that.",
                 key, s.text(key), e.nanoporosity);
}

void check_case(const Settings &s, const ElectrodeFacts &e, const RunOptions &o) {
  Mistakes mistakes("case");
  check_nanoporosity(s, e, mistakes);
  check_cell(e, o.ranks, mistakes);
  check_target(s, e, mistakes);
  if (const std::string wrong = wrong_program(o.liggghts); !wrong.empty())
    mistakes.add(0, wrong);
  for (const std::string &path :
       {fs::absolute(o.folder).string(), s.text("electrode"), input_scripts()})
    if (const std::string wrong = wrong_path(path); !wrong.empty())
      mistakes.add(0, wrong);
  mistakes.stop_if_any();
}

std::vector<std::pair<std::string, std::string>> script_settings(const Settings &s) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Key &key : case_keys())
    if (!key.variable.empty())
      out.emplace_back(key.variable, s.text(key.name));
  return out;
}

/// A restart file and a frame; measured: 1.2 kB and 0.3 kB per atom.
std::uintmax_t room_for_next_files(const ElectrodeFacts &e) { return 1000000 + 4000 * e.atoms; }

LiggghtsJob job_of(const Settings &s, const ElectrodeFacts &e, const RunOptions &o,
                   const std::string &folder, bool resume) {
  LiggghtsJob job;
  job.program = o.liggghts;
  job.ranks = o.ranks;
  job.script = input_scripts() + "/in.calendering";
  job.log = folder + "/log.liggghts";
  job.screen = folder + "/screen.txt";
  job.room = room_for_next_files(e);
  job.variables = script_settings(s);
  job.variables.insert(
      job.variables.end(),
      {{"out", folder}, {"scripts", input_scripts()}, {"resuming", resume ? "1" : "0"}});
  return job;
}

/// LIGGGHTS writes a restart file of its own when it is asked to stop, from which nothing goes on.
void remove_forced_restarts(const std::string &folder) {
  std::error_code none;
  for (const auto &entry : fs::directory_iterator(folder, none))
    if (entry.path().filename().string().rfind("restart_forced_liggghts_", 0) == 0)
      fs::remove(entry.path(), none);
}

/// Collects what a failed run has computed; returns what to report to the user.
std::string keep_what_there_is(const std::string &folder, const Settings &settings,
                               const ElectrodeFacts &electrode, const RunFacts &facts) {
  std::string report;
  try {
    const nlohmann::json s = collect(folder, settings, electrode, facts);
    report =
        fmt::format("What was computed is kept: curve.csv up to {:.1f} MPa, summary.json marked "
                    "as not finished.",
                    s["max_pressure_MPa"].get<double>());
  } catch (const std::exception &e) {
    report =
        fmt::format("What was computed is kept as LIGGGHTS wrote it; it could not be collected: "
                    "{}.",
                    e.what());
  }
  if (std::filesystem::exists(folder + "/running.restart"))
    report += " --resume continues from the newest restart file.";
  else
    report += " No restart file was written yet: --resume begins anew.";
  return report;
}

/// Steps and time that a run which goes on has behind it.
void remember_what_was_done(const std::string &folder, RunFacts &facts) {
  RunFolder before(folder);
  const nlohmann::json &old = before.object("summary.json");
  if (old.contains("wall_clock_s") && old["wall_clock_s"].is_number())
    facts.earlier_s = old["wall_clock_s"];
  const std::vector<RawRow> rows = read_raw(folder + "/curve_raw.csv");
  facts.first_step = rows.empty() ? 0.0 : rows.back().step;
}

const char *const kAsRun = "# as run by"; // collect writes it too

/// Writes what the run needs; true if it goes on from a restart file.
bool prepare(const Settings &settings, const ElectrodeFacts &electrode, const RunOptions &o,
             const std::string &electrode_hash, RunFacts &facts) {
  const std::string &folder = o.folder;
  const bool resume =
      o.resume && fs::exists(folder + "/time_step.in") && find_restart(folder, electrode.atoms);
  if (o.resume && !resume)
    fmt::print("run: no restart file in {}; starting from the electrode\n", o.folder);
  if (resume)
    remember_what_was_done(folder, facts);
  mark_as_running(folder, facts.case_hash, electrode_hash, facts.earlier_s);
  if (!resume)
    clear_old_results(folder);
  write_file(
      folder + "/case.toml",
      write_toml(settings, case_keys(),
                 fmt::format("{} calendem {}; every default filled in\n", kAsRun, version())));
  fs::copy_file(settings.text("electrode") + "/electrode.json", folder + "/electrode.json",
                fs::copy_options::overwrite_existing);
  return resume;
}

/// A run is collected with the electrode that it began with, or not at all.
void stop_if_packed_anew(const Settings &settings, const std::string &then) {
  const std::string file = settings.text("electrode") + "/electrode.data";
  const std::string now = hash_of_file(file);
  if (now != then)
    throw Failure(
        kBadInput,
        "'{}' has changed while the run went on (hash then {}, now {}): the electrode was packed "
        "anew. What was computed is kept as LIGGGHTS wrote it and is of neither. Run again with "
        "--force, and pack into another folder while a run is under way.",
        file, then, now);
}

/// Runs LIGGGHTS to its end; a run that fails is collected as far as it came.
void simulate(const Settings &settings, const ElectrodeFacts &electrode, const RunOptions &o,
              const std::string &electrode_hash, RunFacts &facts) {
  const std::string &folder = o.folder;
  facts.earlier_s += facts.wall_clock_s; // of rehearsals
  facts.first_step = 0.0;
  const bool resume = prepare(settings, electrode, o, electrode_hash, facts);
  std::cout << std::flush;
  const auto begin = std::chrono::steady_clock::now();
  const auto stop_watch = [&] {
    facts.wall_clock_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  Progress progress(folder + "/curve_raw.csv", settings);
  try {
    run_liggghts(job_of(settings, electrode, o, folder, resume), [&] { progress(); });
  } catch (const Failure &f) {
    const StopRequests not_now; // a second Ctrl-C would lose what is being collected
    stop_watch();
    remove_forced_restarts(folder);
    stop_if_packed_anew(settings, electrode_hash);
    facts.stopped_because = f.what();
    throw Failure(f.exit_status(), std::string(f.what()) + "\n" +
                                       keep_what_there_is(folder, settings, electrode, facts));
  }
  stop_watch();
  if (isatty(1))
    std::cout << "\r\033[K";
  stop_if_packed_anew(settings, electrode_hash);
}

} // namespace

std::string run_tools(const std::string &liggghts) {
  return version() + hash_of_file(liggghts) + hash_of_file(input_scripts() + "/in.compression") +
         hash_of_file(input_scripts() + "/in.relaxation") +
         hash_of_folder(input_scripts() + "/common");
}

std::string run_identity(const Settings &settings, const std::string &tools) {
  std::string identity = tools;
  for (const auto &[key, value] : settings.all())
    if (key != "electrode")
      identity.append(key).append("=").append(value).append("\n");
  return identity;
}

void run_case(const Settings &settings, RunOptions o) {
  o.liggghts = fs::absolute(o.liggghts).lexically_normal().string(); // it runs in the run's folder
  const ElectrodeFacts electrode = read_electrode(settings.text("electrode"));
  check_case(settings, electrode, o);
  const std::string electrode_hash = hash_of_file(settings.text("electrode") + "/electrode.data");
  const std::string hash =
      hash_of_text(run_identity(settings, run_tools(o.liggghts)) + electrode_hash);
  const std::string folder = fs::absolute(o.folder).lexically_normal().string();
  o.folder = folder;
  make_output_folder(folder, 2 * room_for_next_files(electrode));
  must_not_be(folder, settings.text("electrode"), "the electrode");
  require_own_file(folder + "/case.toml", kAsRun);
  fs::create_directories(folder + "/vtk");
  const FolderLock lock(folder);
  if (holds_this_run(o, settings, hash, electrode_hash)) {
    fmt::print("run: {} already holds this run\n", folder);
    return;
  }
  RunFacts facts;
  facts.ranks = o.ranks;
  facts.case_hash = hash;
  facts.program = hash_of_file(o.liggghts);
  fmt::print("run: {} spheres, {} bonds, {} rank{} -> {}\n", electrode.atoms, electrode.bonds,
             o.ranks, o.ranks == 1 ? "" : "s", folder);
  LineLoadSearch search(folder, settings, lowest_gap(electrode), o.resume);
  do {
    simulate(search.settings(), electrode, o, electrode_hash, facts);
    o.resume = false;
  } while (search.next_trial_needed());
  const nlohmann::json s = collect(folder, search.settings(), electrode, facts);
  fmt::print("run: maximum {:.1f} MPa, {:.2f} % of bonds broken, total porosity {:.2f} % after "
             "relaxation, {:.0f} s\n",
             s["max_pressure_MPa"].get<double>(), 100 * s["broken_fraction_at_max"].get<double>(),
             100 * s["porosity_after_relaxation"].get<double>(), facts.wall_clock_s);
  stop_if_checks_failed(s, folder);
}

namespace {

const char *const kStages[] = {"hold", "compression", "dwell", "relaxation", "done"};

} // namespace

double target_share(const Settings &s, const RawRow &row) {
  if (row.stage > 2.5)
    return 1.0;
  const std::string &control = s.text("platen.control");
  if (control == "pressure")
    return row.p_top / s.number("platen.max_pressure_MPa");
  if (control == "displacement")
    return row.displacement / s.number("platen.displacement_um");
  const double way = row.gap + row.displacement - s.number("platen." + control + "_um");
  return way > 0.0 ? row.displacement / way : 1.0;
}

double time_to_target(const Settings &s, const std::vector<RawRow> &rows) {
  const RawRow &last = rows.back();
  if (last.stage > 1.5 || last.stage < 0.5)
    return std::nan("");
  const double share = target_share(s, last);
  if (s.text("platen.control") != "pressure")
    return share > 0.0 ? (1.0 - share) / share * last.displacement / s.number("platen.speed_m_s")
                       : std::nan("");
  const RawRow &before = rows[rows.size() * 3 / 4];
  const double growth = std::log(last.p_top / before.p_top) / (last.time - before.time);
  return before.p_top > 0.0 && growth > 0.0 && share > kFirmShare
             ? std::max(0.0, -std::log(share)) / growth
             : std::nan("");
}

Progress::Progress(const std::string &curve, const Settings &s)
    : curve_(curve), settings_(s), begin_(std::chrono::steady_clock::now()), shown_(begin_) {}

void Progress::operator()() {
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
  std::string text =
      fmt::format("{:11} {:3.0f} %  {:7.2f} MPa  gap {:.2f} um  {:.2f} % of bonds broken  {:.0f} s",
                  kStages[static_cast<int>(r.stage)], 100 * share, r.p_top, r.gap,
                  r.made > 0 ? 100 * r.broken / r.made : 0.0,
                  std::chrono::duration<double>(now - begin_).count());
  if (std::isnan(from_)) {
    from_ = r.time;
    looked_ = now;
  }
  const double left = time_to_target(settings_, rows) / (r.time - from_) *
                      std::chrono::duration<double>(now - looked_).count();
  if (std::isfinite(left))
    text += fmt::format(", about {:.0f} s to the target", left);
  if (isatty(1))
    std::cout << "\r\033[K" << text << std::flush;
  else
    std::cout << text << std::endl;
}

} // namespace calendem
