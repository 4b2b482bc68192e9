// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "base/liggghts_job.h"
#include "base/provenance.h"
#include "base/run_folder.h"
#include "simulate/collect.h"
#include "simulate/run.h"
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {

namespace fs = std::filesystem;
namespace {

/// The settings in which two cases differ: "key: then X, now Y".
std::string differences(const std::string &old_case, const Settings &now) {
  Mistakes ignored(old_case);
  const Settings then = read_toml(old_case, FileKind::Case, case_keys(), ignored);
  const bool gap_was_found = then.number("roll.line_load_N_mm") > 0.0;
  std::string text;
  for (const Key &key : case_keys())
    if (key.name != "electrode" && !(gap_was_found && key.name == "platen.roll_gap_um") &&
        then.text(key.name) != now.text(key.name))
      text +=
          fmt::format("\n  {}: then {}, now {}", key.name, then.text(key.name), now.text(key.name));
  return text;
}

const char *const kResults[] = {
    "curve_raw.csv",   "bridges_raw.csv",      "elongation_raw.csv", "bridges.csv",
    "drying.csv",      "breaks.csv",           "curve.csv",          "bodies.csv",
    "cracks.csv",      "thresholds.csv",       "running.restart",    "running.previous",
    "running.damaged", "running.restart.part", "compressed.restart", "final.restart",
    "time_step.in",    "structure.csv",        "structure.json"};

/// A frame or a series of frames of a run.
bool is_picture(const fs::path &file) {
  const std::string ending = file.extension().string();
  return ending == ".vtp" || ending == ".pvd" || ending == ".part";
}

/// A file of the folder that a run would replace or remove; empty: there is none.
std::string result_in(const std::string &folder) {
  for (const char *name : kResults)
    if (fs::exists(fs::path(folder) / name))
      return name;
  for (const auto &entry : fs::directory_iterator(fs::path(folder) / "vtk"))
    if (is_picture(entry.path()))
      return "vtk/" + entry.path().filename().string();
  return "";
}

/// A folder without a summary.json that can be read is no run of this command that was killed:
/// those have one from their first moment on.
void stop_if_of_others(const RunOptions &o) {
  const std::string found = result_in(o.folder);
  if (found.empty() || o.force || (o.resume && fs::exists(o.folder + "/time_step.in")))
    return;
  throw Failure(kBadInput,
                "'{}' holds '{}' but no summary.json that can be read: the run of a script that "
                "was not collected, or files of your own. They would be lost. Give another -o, "
                "calendem collect, or --force to overwrite them.",
                o.folder, found);
}

} // namespace

bool holds_this_run(const RunOptions &o, const Settings &settings, const std::string &hash,
                    const std::string &electrode) {
  RunFolder before(o.folder);
  const nlohmann::json &old = before.object("summary.json");
  if (old.is_null()) { // none, or cut
    stop_if_of_others(o);
    return false;
  }
  const std::string why = before.unfinished();
  const bool finished = why.empty(), same = old.value("case_hash", "") == hash;
  if (finished && same) {
    stop_if_checks_failed(old, o.folder);
    return true;
  }
  if (o.force)
    return false;
  const std::string differs = differences(o.folder + "/case.toml", settings);
  if (!same && (finished || (o.resume && !differs.empty())))
    throw Failure(kBadInput,
                  "'{}' holds a run of another case. Give another -o, or --force to overwrite it. "
                  "What differs:{}",
                  o.folder,
                  differs.empty() ? "\n  the electrode, the program or the input scripts"
                                  : differs);
  const std::string then =
      old.value("provenance", nlohmann::json::object()).value("electrode_data", electrode);
  if (!finished && o.resume && then != electrode)
    throw Failure(kBadInput,
                  "'{}' holds a run of another electrode (electrode.data then {}, now {}): its "
                  "restart files do not belong to '{}'. Give the electrode that it began with, "
                  "another -o, or --force to overwrite it.",
                  o.folder, then, electrode, settings.text("electrode"));
  if (!finished && !o.resume && fs::exists(o.folder + "/running.restart"))
    throw Failure(
        kBadInput,
        "'{}' holds an unfinished run: {}. Go on with --resume, or start again with --force.",
        o.folder, why);
  return false;
}

bool find_restart(const std::string &folder, long atoms) {
  const std::string newest = folder + "/running.restart", before = folder + "/running.previous";
  if (!fs::exists(newest) && !fs::exists(before))
    return false;
  if (restart_is_whole(newest, atoms))
    return true;
  if (!restart_is_whole(before, atoms))
    throw Failure(
        kBadInput,
        "'{}' is cut or damaged ({} bytes) and there is no older one: the run cannot be continued. "
        "What was computed is kept; start again with --force, or in another folder with -o.",
        newest, fs::exists(newest) ? fs::file_size(newest) : 0);
  fmt::print("run: {} is cut; going on from the one before it\n", newest);
  std::error_code none;
  fs::rename(newest, folder + "/running.damaged", none);
  fs::copy_file(before, newest, fs::copy_options::overwrite_existing);
  return true;
}

void clear_old_results(const std::string &folder) {
  for (const char *name : kResults)
    fs::remove(fs::path(folder) / name);
  for (const auto &entry : fs::directory_iterator(fs::path(folder) / "vtk"))
    if (is_picture(entry.path()))
      fs::remove(entry.path());
}

void mark_as_running(const std::string &folder, const std::string &hash,
                     const std::string &electrode, double wall_clock_s) {
  const nlohmann::json s = {{"case_hash", hash},
                            {"finished", false},
                            {"wall_clock_s", wall_clock_s},
                            {"provenance", {{"electrode_data", electrode}}},
                            {"stopped_because", "still running, or killed without a message"}};
  write_file(folder + "/summary.json", s.dump(2) + "\n");
}

namespace {

constexpr double kShortestRecord = 5.0; // length, x, y, z and something
constexpr size_t kCount = sizeof(std::int32_t);
constexpr int kMostEmptyRanks = 64;

template <class T> T value_at(const std::string &bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Atoms whose records fill exactly `n` values from `at` on; -1 if they do not.
long atoms_in_chunk(const std::string &bytes, size_t at, size_t n) {
  long atoms = 0;
  for (size_t k = 0; k < n; ++atoms) {
    const double length = value_at<double>(bytes, at + sizeof(double) * k);
    if (!(length >= kShortestRecord) || length > double(n - k) || length != std::floor(length))
      return -1;
    k += static_cast<size_t>(length);
  }
  return atoms;
}

/// Where the chunk of at least one atom begins that reaches to `end`; `end` if there is none.
size_t last_chunk(const std::string &bytes, size_t end) {
  const size_t shortest = kCount + sizeof(double) * static_cast<size_t>(kShortestRecord);
  for (size_t length = shortest; length <= end; length += sizeof(double)) {
    const size_t begin = end - length, n = (length - kCount) / sizeof(double);
    if (value_at<std::int32_t>(bytes, begin) == static_cast<std::int64_t>(n) &&
        atoms_in_chunk(bytes, begin + kCount, n) > 0)
      return begin;
  }
  return end;
}

} // namespace

// From the end: where a count reaches exactly to the end, a chunk of atoms begins; then the one
// before it. Ranks without atoms leave counts of 0, which the last value of an atom may look like
// too: they are taken for such only where no chunk fits.
bool restart_is_whole(const std::string &file, long atoms) {
  const std::string bytes = text_of_file(file);
  int empty_ranks = 0;
  size_t end = bytes.size();
  while (atoms > 0) {
    const size_t begin = last_chunk(bytes, end);
    if (begin < end) {
      atoms -= atoms_in_chunk(bytes, begin + kCount, (end - begin - kCount) / sizeof(double));
      end = begin;
    } else if (end >= kCount && value_at<std::int32_t>(bytes, end - kCount) == 0 &&
               empty_ranks++ < kMostEmptyRanks) {
      end -= kCount;
    } else {
      return false;
    }
  }
  return atoms == 0;
}

} // namespace calendem
