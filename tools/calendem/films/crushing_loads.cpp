// SPDX-License-Identifier: GPL-2.0-or-later
#include "films/crushing_loads.h"
#include "base/csv_table.h"
#include "base/messages.h"
#include "base/provenance.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/ranges.h>

namespace calendem {
namespace {

constexpr std::size_t kFewestParticles = 4;
constexpr double kOtherStrength = 1.2; // factor between strengths that tell the power
constexpr double kBeside = 0.02;       // beyond the diameters, as a fraction of them

Eigen::Vector2d of(double diameter) { return {1.0, std::log(diameter)}; }

} // namespace

CrushingLoads::CrushingLoads(const std::string &file) {
  if (!std::filesystem::exists(file))
    throw Failure(kBadInput,
                  fmt::format("{}: there is no such file (crushing of the bank).", file));
  const CsvTable table = CsvTable::parse(text_of_file(file));
  for (const char *column : {"diameter_um", "strength_MPa", "load_mN"})
    if (!table.has(column))
      throw Failure(kBadInput, fmt::format("{}: its first line has no column {}: {}. Columns are "
                                           "separated by commas.",
                                           file, column, fmt::join(table.header(), ",")));
  if (const std::string wrong = table.ambiguous(); !wrong.empty())
    throw Failure(kBadInput, fmt::format("{} {}", file, wrong));
  if (!table.bad_lines().empty())
    throw Failure(kBadInput,
                  fmt::format("{}: line {} has another number of columns than the first. "
                              "Correct the line, or copy the file again if it is cut.",
                              file, table.bad_lines().front()));
  const std::vector<double> d = table.numbers("diameter_um"), s = table.numbers("strength_MPa"),
                            load = table.numbers("load_mN");
  for (const auto *column : {&d, &s, &load})
    for (std::size_t k = 0; k < column->size(); ++k)
      if (!((*column)[k] > 0.0))
        throw Failure(kBadInput, fmt::format("{}: row {} has a value that is no positive number. "
                                             "Columns: diameter_um, strength_MPa, load_mN.",
                                             file, k + 1));
  diameters_ = d;
  std::sort(diameters_.begin(), diameters_.end());
  diameters_.erase(std::unique(diameters_.begin(), diameters_.end()), diameters_.end());
  if (d.size() < kFewestParticles || diameters_.size() < 2)
    throw Failure(kBadInput, fmt::format("{}: rows: {}, different diameters: {}; at least {} "
                                         "particles of two diameters are needed.",
                                         file, d.size(), diameters_.size(), kFewestParticles));
  fit(d, s, load);
}

void CrushingLoads::fit(const std::vector<double> &d, const std::vector<double> &s,
                        const std::vector<double> &load) {
  std::vector<double> strengths = s;
  std::sort(strengths.begin(), strengths.end());
  strength_ = strengths[strengths.size() / 2];
  const bool varies = strengths.back() > kOtherStrength * strengths.front();
  const auto n = Eigen::Index(d.size()), columns = Eigen::Index(varies ? 3 : 2);
  Eigen::MatrixXd at(n, columns);
  Eigen::VectorXd y(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double log_strength = std::log(s[std::size_t(k)] / strength_);
    at.row(k).head(2) = of(d[std::size_t(k)]);
    if (varies)
      at(k, 2) = log_strength;
    y[k] = std::log(load[std::size_t(k)]) - (varies ? 0.0 : log_strength);
  }
  const Eigen::MatrixXd inverse = (at.transpose() * at).inverse();
  const Eigen::VectorXd found = inverse * (at.transpose() * y);
  line_ = found.head(2);
  if (varies)
    power_ = found[2];
  line_covariance_ =
      inverse.topLeftCorner(2, 2) * ((y - at * found).squaredNorm() / double(n - columns));
}

bool CrushingLoads::covers(double diameter) const {
  return diameter >= (1.0 - kBeside) * diameters_.front() &&
         diameter <= (1.0 + kBeside) * diameters_.back();
}

double CrushingLoads::log_load(double diameter, double strength) const {
  return power_ * std::log(strength / strength_) + line_.dot(of(diameter));
}

double CrushingLoads::covariance(double diameter, double other) const {
  return of(diameter).dot(line_covariance_ * of(other));
}

} // namespace calendem
