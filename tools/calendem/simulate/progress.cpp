// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/progress.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iostream>
#include <unistd.h>

namespace calendem {
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
  return before.p_top > 0.0 && growth > 0.0 && share > 0.0
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
