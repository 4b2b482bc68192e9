// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/rolling.h"
#include "base/provenance.h"
#include "simulate/collect.h"
#include "simulate/run.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <utility>

namespace calendem {

namespace {

const std::string kGap = "platen.roll_gap_um", kFile = "/rehearsals.csv";

bool agrees(double line_load, const Settings &s) {
  const double asked = s.number("roll.line_load_N_mm");
  return std::fabs(line_load - asked) <= s.number("roll.line_load_tolerance") * asked;
}

double last_line_load(const nlohmann::json &roll) {
  return roll["passes"].back()["line_load_N_mm"].get<double>();
}

std::vector<TrialPassage> read_trials(const std::string &file) {
  std::vector<TrialPassage> done;
  std::ifstream in(file);
  std::string heading;
  std::getline(in, heading);
  TrialPassage r;
  char comma;
  while (in >> r.gap >> comma >> r.line_load >> comma >> r.touch)
    done.push_back(r);
  return done;
}

/// Mean gap and load (of its logarithm) of runs whose order in load contradicts that in gap.
struct Level {
  double gap = 0.0, log_load = 0.0;
  int runs = 1;
};

/// The runs that carried something, the widest gap first. A film carries more in a narrower gap;
/// where single runs say otherwise, breaks scatter them: they count as their mean, so that loads
/// grow from one level to the next (the pool-adjacent-violators algorithm of isotonic regression).
std::vector<Level> levels_of(std::vector<TrialPassage> done) {
  std::sort(done.begin(), done.end(),
            [](const TrialPassage &a, const TrialPassage &b) { return a.gap > b.gap; });
  std::vector<Level> levels;
  for (const TrialPassage &r : done) {
    if (r.line_load <= 0.0)
      continue;
    levels.push_back({r.gap, std::log(r.line_load)});
    while (levels.size() > 1 && levels[levels.size() - 2].log_load >= levels.back().log_load) {
      const Level narrow = levels.back();
      levels.pop_back();
      Level &pooled = levels.back();
      const int runs = pooled.runs + narrow.runs;
      pooled = {(pooled.runs * pooled.gap + narrow.runs * narrow.gap) / runs,
                (pooled.runs * pooled.log_load + narrow.runs * narrow.log_load) / runs, runs};
    }
  }
  return levels;
}

/// The narrowest gap that carries less than asked, the widest that carries more; null: none.
std::pair<const Level *, const Level *> nearest(const std::vector<Level> &levels, double asked) {
  const auto more = std::find_if(levels.begin(), levels.end(), [&](const Level &level) {
    return level.log_load >= std::log(asked);
  });
  return {more == levels.begin() ? nullptr : &*(more - 1), more == levels.end() ? nullptr : &*more};
}

} // namespace

double next_gap(const std::vector<TrialPassage> &done, double asked, double lowest) {
  const std::vector<Level> levels = levels_of(done);
  const auto [less, more] = nearest(levels, asked);
  if (less && more)
    return less->gap + (more->gap - less->gap) * (std::log(asked) - less->log_load) /
                           (more->log_load - less->log_load);
  const double touch = done.back().touch;
  if (levels.empty())
    return 0.5 * (touch + lowest);
  const Level &known = less ? *less : *more;
  const double depths = std::exp(0.5 * (std::log(asked) - known.log_load)); // load ~ depth^2
  const double gap = touch - (touch - known.gap) * depths;
  return more ? gap : std::fmax(gap, 0.5 * (known.gap + lowest));
}

LineLoadSearch::LineLoadSearch(const std::string &folder, const Settings &asked, double lowest,
                               bool resume)
    : file_(folder + kFile), folder_(folder), now_(asked),
      asked_(asked.number("roll.line_load_N_mm")), lowest_(lowest) {
  if (resume)
    done_ = read_trials(file_);
  else
    std::filesystem::remove(file_);
  set_gap();
}

void LineLoadSearch::set_gap() {
  if (!done_.empty())
    now_.set(kGap, fmt::format("{:.4f}", next_gap(done_, asked_, lowest_)));
}

bool LineLoadSearch::next_trial_needed() {
  if (asked_ <= 0.0)
    return false;
  const nlohmann::json roll = roll_passes(read_raw(folder_ + "/curve_raw.csv"), now_);
  const double line_load = last_line_load(roll);
  fmt::print("run: {:.1f} N/mm at a gap of {} um, {:.1f} asked\n", line_load, now_.text(kGap),
             asked_);
  std::cout << std::flush;
  const RollNip nip = roll_nip(now_);
  const nlohmann::json &pass = roll["passes"].back();
  const double touch = pass["gap_um"].get<double>() +
                       nip.above(pass["contact_length_before_the_nip_um"].get<double>());
  done_.push_back({now_.number(kGap), line_load, touch});
  if (agrees(line_load, now_) || static_cast<int>(done_.size()) >= kMostTrials)
    return false;
  // before the gap changes: what is left of this run would be gone on with at another
  clear_old_results(folder_);
  std::string text = "gap_um,line_load_N_mm,touch_um\n";
  for (const TrialPassage &r : done_)
    text += fmt::format("{},{},{}\n", r.gap, r.line_load, r.touch);
  write_file(file_, text);
  set_gap();
  return true;
}

nlohmann::json rehearsals_in(const std::string &folder) {
  nlohmann::json out = nlohmann::json::array();
  for (const TrialPassage &r : read_trials(folder + kFile))
    out.push_back({{"gap_um", r.gap}, {"line_load_N_mm", r.line_load}});
  return out;
}

std::string line_load_missed(const std::vector<RawRow> &rows, const Settings &s) {
  if (s.number("roll.line_load_N_mm") <= 0.0)
    return "";
  const double reached = last_line_load(roll_passes(rows, s));
  return agrees(reached, s)
             ? ""
             : fmt::format(
                   "the last pass carries {:.4g} N/mm at a gap of {} um; "
                   "roll.line_load_N_mm = {} was not met within a fraction of {}. The loads of "
                   "all runs are \"rehearsals\" in summary.json: where they go up and down with "
                   "the gap, that is the scatter of breaks in this cell: give a larger "
                   "roll.line_load_tolerance, or pack a larger cell. Otherwise begin the search "
                   "with another {}",
                   reached, s.text(kGap), s.text("roll.line_load_N_mm"),
                   s.text("roll.line_load_tolerance"), kGap);
}

namespace {

using Rows = std::vector<RawRow>;

/// Rows of each pass: it begins with a compression and ends with a release.
std::vector<Rows> passes_of(const Rows &rows) {
  std::vector<Rows> passes;
  for (const RawRow &r : rows) {
    if (passes.empty() || (r.stage < 1.5 && passes.back().back().stage > 2.5))
      passes.emplace_back();
    passes.back().push_back(r);
  }
  return passes;
}

/// Along the web [um] with pressure above `least`, and line load [MPa um = N/m], of one side of the
/// nip.
struct Side {
  double length = 0.0, load = 0.0;
};

Side side_of(const Rows &pass, bool way_out, const RollNip &nip, double gap, double least) {
  Side side;
  const RawRow *last = nullptr;
  for (const RawRow &r : pass) {
    if ((r.stage > 2.5) != way_out)
      continue;
    if (last) {
      const double way = std::fabs(nip.distance(r.gap - gap) - nip.distance(last->gap - gap));
      side.load += 0.5 * (r.p_top + last->p_top) * way;
      if (std::max(r.p_top, last->p_top) > least)
        side.length += way;
    }
    last = &r;
  }
  return side;
}

nlohmann::json pass_of(const Rows &pass, const RollNip &nip, double lost) {
  double gap = pass.front().gap, largest = 0.0;
  for (const RawRow &r : pass) {
    gap = std::min(gap, r.gap);
    largest = std::max(largest, r.p_top);
  }
  const Side in = side_of(pass, false, nip, gap, lost * largest),
             out = side_of(pass, true, nip, gap, lost * largest);
  return {{"gap_um", gap},
          {"max_pressure_MPa", largest},
          {"line_load_N_mm", 1e-3 * (in.load + out.load)},
          {"line_load_before_the_nip_N_mm", 1e-3 * in.load},
          {"contact_length_um", in.length + out.length},
          {"contact_length_before_the_nip_um", in.length}};
}

} // namespace

RollNip roll_nip(const Settings &s) {
  return {1e3 * s.number("roll.radius_mm"), 1e3 * s.number("roll.counter_radius_mm"),
          s.number("roll.slip")};
}

nlohmann::json roll_passes(const std::vector<RawRow> &rows, const Settings &s) {
  const RollNip nip = roll_nip(s);
  nlohmann::json passes = nlohmann::json::array();
  for (const Rows &pass : passes_of(rows))
    passes.push_back(pass_of(pass, nip, s.number("platen.contact_lost_fraction")));
  const double way = rows.front().gap + rows.front().displacement - s.number("platen.roll_gap_um");
  const double web_speed = s.number("roll.line_speed_m_min") / 60.0; // m/s
  return {{"passes", passes},
          {"web_speed_of_the_run_m_s", nip.web_speed(s.number("platen.speed_m_s"), way)},
          {"run_faster_by", nip.web_speed(s.number("platen.speed_m_s"), way) / web_speed},
          {"time_in_the_last_nip_ms",
           1e-3 * passes.back()["contact_length_um"].get<double>() / web_speed}};
}

bool add_elongation(const std::string &folder, std::vector<RawRow> &rows) {
  const auto known = rows_by_step(folder + "/elongation_raw.csv", 3);
  for (RawRow &r : rows)
    if (const auto at = known.find(static_cast<long>(r.step)); at != known.end()) {
      r.elongation = at->second[1];
      r.work_elongation = at->second[2];
    }
  return !known.empty();
}

double elongation_at(const std::vector<RawRow> &rows, double time) {
  const auto above = std::lower_bound(rows.begin(), rows.end(), time,
                                      [](const RawRow &r, double t) { return r.time < t; });
  if (above == rows.end())
    return rows.back().elongation;
  if (above == rows.begin())
    return above->elongation;
  const RawRow &a = *(above - 1), &b = *above;
  return a.elongation + (b.elongation - a.elongation) * (time - a.time) / (b.time - a.time);
}

std::string elongation_columns() { return ",elongation_percent,cell_x_um,work_elongation_fJ"; }

std::string elongation_cells(const RawRow &row, const ElectrodeFacts &e) {
  return fmt::format(",{:.6f},{:.9f},{:.6g}", 100.0 * row.elongation,
                     e.elongated(row.elongation).lx, row.work_elongation);
}

nlohmann::json elongation_of(const RawRow &top, const RawRow &last, const ElectrodeFacts &e) {
  return {{"percent_at_max", 100.0 * top.elongation},
          {"percent_after", 100.0 * last.elongation},
          {"cell_x_after_um", e.elongated(last.elongation).lx}};
}

} // namespace calendem
