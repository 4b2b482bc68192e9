// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/line_load.h"
#include "base/provenance.h"
#include "simulate/collect.h"
#include "simulate/resume.h"
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

std::vector<Rehearsal> read_rehearsals(const std::string &file) {
  std::vector<Rehearsal> done;
  std::ifstream in(file);
  std::string heading;
  std::getline(in, heading);
  Rehearsal r;
  char comma;
  while (in >> r.gap >> comma >> r.line_load >> comma >> r.touch)
    done.push_back(r);
  return done;
}

/// The narrowest gap that carried less than asked, the widest that carried more; null: none.
std::pair<const Rehearsal *, const Rehearsal *> nearest(const std::vector<Rehearsal> &done,
                                                        double asked) {
  const Rehearsal *less = nullptr, *more = nullptr;
  for (const Rehearsal &r : done)
    if (r.line_load > 0.0 && r.line_load < asked)
      less = !less || r.gap < less->gap ? &r : less;
    else if (r.line_load >= asked)
      more = !more || r.gap > more->gap ? &r : more;
  return {less, more};
}

} // namespace

bool is_scatter(const std::vector<Rehearsal> &done, double asked) {
  const auto [less, more] = nearest(done, asked);
  return less && more && less->gap - more->gap < kSameGap;
}

double next_gap(const std::vector<Rehearsal> &done, double asked, double lowest) {
  const auto [less, more] = nearest(done, asked);
  const Rehearsal touch = {done.back().touch, 0.0, 0.0};
  const Rehearsal &a = less ? *less : touch, &b = more ? *more : touch;
  const bool exponential = less && more;
  const auto scale = [&](double load) { return exponential ? std::log(load) : std::sqrt(load); };
  const double from = scale(a.line_load), to = scale(b.line_load);
  const double gap = a.gap + (b.gap - a.gap) * (scale(asked) - from) / (to - from);
  return more ? gap : std::fmax(gap, 0.5 * (a.gap + lowest));
}

Rehearsals::Rehearsals(const std::string &folder, const Settings &asked, double lowest, bool resume)
    : file_(folder + kFile), folder_(folder), now_(asked),
      asked_(asked.number("roll.line_load_N_mm")), lowest_(lowest) {
  if (resume)
    done_ = read_rehearsals(file_);
  else
    std::filesystem::remove(file_);
  set_gap();
}

void Rehearsals::set_gap() {
  if (!done_.empty())
    now_.set(kGap, fmt::format("{:.4f}", next_gap(done_, asked_, lowest_)));
}

bool Rehearsals::again() {
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
  if (agrees(line_load, now_) || static_cast<int>(done_.size()) >= kMostRehearsals ||
      is_scatter(done_, asked_))
    return false;
  // before the gap changes: what is left of this run would be gone on with at another
  clear_old_results(folder_);
  std::string text = "gap_um,line_load_N_mm,touch_um\n";
  for (const Rehearsal &r : done_)
    text += fmt::format("{},{},{}\n", r.gap, r.line_load, r.touch);
  write_file(file_, text);
  set_gap();
  return true;
}

nlohmann::json rehearsals_in(const std::string &folder) {
  nlohmann::json out = nlohmann::json::array();
  for (const Rehearsal &r : read_rehearsals(folder + kFile))
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
                   "roll.line_load_N_mm = {} was not met within a fraction of {}. If runs "
                   "at gaps less than {} um apart carry more and less (\"rehearsals\" in "
                   "summary.json), that is the scatter of breaks in this cell: give a "
                   "larger roll.line_load_tolerance, or pack a larger cell. Otherwise begin "
                   "the search with another {}",
                   reached, s.text(kGap), s.text("roll.line_load_N_mm"),
                   s.text("roll.line_load_tolerance"), kSameGap, kGap);
}

} // namespace calendem
