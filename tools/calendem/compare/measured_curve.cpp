// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/measured_curve.h"
#include "base/csv_table.h"
#include "base/provenance.h"
#include "compare/gap.h"
#include <algorithm>
#include <cmath>

namespace calendem {
namespace {

constexpr double kJumps = 6.0;      // of the usual distance from neighbours
constexpr double kSmallJump = 0.01; // of the largest value: never less than that

void add(MeasuredBranch &branch, double p, double d) {
  add_if_higher(branch.pressure, branch.displacement, p, d);
}

double upper_median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + long(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// True for values far off the median of themselves and their two neighbours on either side
/// (Hampel): the rows of a press rise and fall, however steeply; single ones do not jump. Where it
/// turns they may.
std::vector<bool> standing_out(const std::vector<double> &v,
                               const std::vector<std::size_t> &turns) {
  std::vector<bool> out(v.size(), false);
  std::vector<double> off(v.size(), 0.0), size;
  double largest = 0.0;
  for (const double x : v)
    largest = std::max(largest, std::fabs(x));
  for (std::size_t k = 2; k + 2 < v.size(); ++k) {
    off[k] = std::fabs(v[k] - upper_median({v[k - 2], v[k - 1], v[k], v[k + 1], v[k + 2]}));
    size.push_back(off[k]);
  }
  if (size.empty())
    return out;
  const double usual = std::max(1.4826 * upper_median(size), kSmallJump * largest);
  const auto turn = std::max_element(v.begin(), v.end()) - v.begin(); // rises and falls steeply
  for (std::size_t k = 0; k < v.size(); ++k)
    out[k] = off[k] > kJumps * usual && std::abs(long(k) - turn) > 2 &&
             std::none_of(turns.begin(), turns.end(),
                          [&](std::size_t at) { return std::abs(long(k) - long(at)) <= 2; });
  return out;
}

} // namespace

MeasuredCurve read_measured_curve(const std::string &file) {
  const CsvTable table = CsvTable::parse(text_of_file(file));
  const auto d = table.numbers("displacement_um"), p = table.numbers("pressure_MPa");
  const auto stage = table.texts("stage");
  std::vector<std::size_t> turns;
  for (std::size_t k = 1; k < stage.size(); ++k)
    if (stage[k] != stage[k - 1])
      turns.push_back(k);
  const std::vector<bool> of_d = standing_out(d, turns), of_p = standing_out(p, turns);
  MeasuredCurve out;
  for (std::size_t k = 0; k < p.size(); ++k)
    out.left_out += of_d[k] || of_p[k];
  const auto released = [&](std::size_t k) {
    return !stage.empty() && (stage[k] == "unloading" || stage[k] == "relaxation");
  };
  for (std::size_t k = 0; k < p.size() && !released(k); ++k)
    if (!of_d[k] && !of_p[k] &&
        (stage.empty() || stage[k] == "loading" || stage[k] == "compression"))
      add(out.loading, p[k], d[k]);
  bool begun = false; // the last release, not those before
  for (std::size_t k = stage.size(); k-- > 0 && (!begun || released(k));)
    if (released(k)) {
      begun = true;
      if (!of_d[k] && !of_p[k])
        add(out.release, p[k], d[k]);
    }
  return out;
}

} // namespace calendem
