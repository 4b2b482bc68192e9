// SPDX-License-Identifier: GPL-2.0-or-later

#include "report/report.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/provenance.h"
#include "base/run_folder.h"
#include "report/pictures.h"

namespace calendem::report {
namespace {

using nlohmann::json;

constexpr double kSteps = 65535;

class Bytes {
public:
  void add(double whole) {
    const auto n = static_cast<std::uint16_t>(std::lround(std::clamp(whole, 0.0, kSteps)));
    bytes_.push_back(n & 0xff);
    bytes_.push_back(n >> 8);
  }
  void add(const Point &p, const Box &box) {
    for (int k = 0; k < 3; ++k)
      add(kSteps * (p[k] - box.low[k]) / std::max(1e-9, box.high[k] - box.low[k]));
  }
  std::string text() const { return base64(bytes_.data(), bytes_.size()); }

private:
  std::vector<unsigned char> bytes_;
};

void make_whole(FramesAt &f, const std::array<double, 2> &period) {
  const PeriodicUnwrapper unwrapper(f.particles, period);
  for (std::size_t i = 0; i < f.particles.centre.size(); ++i)
    f.particles.centre[i] = unwrapper.place(f.particles.centre[i], f.particles.body[i]);
  for (std::size_t i = 0; i < f.bonds.from.size(); ++i) {
    f.bonds.from[i] = unwrapper.place(f.bonds.from[i], f.bonds.body[i]);
    f.bonds.to[i] = unwrapper.place(f.bonds.to[i], f.bonds.body[i]);
  }
}

json packed(const FramesAt &f, const Box &box) {
  Bytes xyz, radius, body, ends, owner, state;
  for (std::size_t i = 0; i < f.particles.centre.size(); ++i) {
    xyz.add(f.particles.centre[i], box);
    radius.add(1000.0 * f.particles.radius[i]); // nm
    body.add(f.particles.body[i]);
  }
  for (std::size_t i = 0; i < f.bonds.from.size(); ++i) {
    ends.add(f.bonds.from[i], box);
    ends.add(f.bonds.to[i], box);
    owner.add(f.bonds.body[i]);
    state.add(f.bonds.intact[i] ? 1 : 0);
  }
  return {{"name", f.moment.name},      {"time_us", f.moment.time_us}, {"xyz", xyz.text()},
          {"radius_nm", radius.text()}, {"body", body.text()},         {"ends", ends.text()},
          {"owner", owner.text()},      {"intact", state.text()}};
}

/// Rows of bodies.csv as numbers, by their header.
json bodies_of(const std::string &directory) {
  RunFolder folder(directory);
  const CsvTable &table = folder.table("bodies.csv");
  json rows = json::array();
  for (std::size_t i = 0; i < table.rows(); ++i)
    rows.push_back(json::object());
  for (const std::string &column : table.header()) {
    const std::vector<double> values = table.numbers(column);
    for (std::size_t i = 0; i < values.size(); ++i)
      rows[i][column] = std::isfinite(values[i]) ? json(values[i]) : json();
  }
  return rows;
}

} // namespace

json explorer_of(Run &run) {
  if (run.particles.empty() || run.bonds.empty())
    return {};
  std::vector<FramesAt> all;
  Box box;
  for (const Moment &moment : moments_of(run)) {
    all.push_back(frames_at(run, moment));
    const std::array<double, 2> period = period_of(run, moment.time_us);
    if (period[0] > 0.0 && period[1] > 0.0)
      make_whole(all.back(), period);
    for (const Point &centre : all.back().particles.centre)
      box.include(centre);
  }
  if (box.empty())
    return {};
  json out = {{"low", box.low}, {"high", box.high}, {"bodies", bodies_of(run.directory)}};
  for (const FramesAt &f : all)
    out["moments"].push_back(packed(f, box));
  return out;
}

} // namespace calendem::report
