// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/crushed.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

using inference::Cholesky;
using inference::Matrix;
using inference::Vector;
namespace {

constexpr double kUsualLoadSd = 0.2; // of the load, where an experiment gives none

double strength_of(const FilmBank &bank, const Material &material) {
  return material.parameters[std::size_t(bank.strength())];
}

} // namespace

void add_crushed(const Experiment &e, const FilmBank &bank, int material, Calibration &to,
                 std::vector<std::string> &not_said) {
  for (const CrushedParticles &p : e.crushed)
    if (!bank.crushing() || bank.strength() < 0)
      not_said.push_back(
          fmt::format("{}: the bank has no crushed particles, so the load at {:g} um "
                      "is left out.",
                      e.name, p.diameter_um));
    else if (!bank.crushing()->covers(p.diameter_um))
      not_said.push_back(fmt::format("{}: particles of {:g} um are left out: the bank crushed some "
                                     "of {:g} to {:g} um.",
                                     e.name, p.diameter_um, bank.crushing()->diameters().front(),
                                     bank.crushing()->diameters().back()));
    else
      to.crushed.push_back({material, p.diameter_um, p.load_mN.value,
                            p.load_mN.sd > 0.0 ? p.load_mN.sd : kUsualLoadSd * p.load_mN.value});
}

namespace {

/// Between the true loads at two diameters: what the line and the model are off by.
double covariance_between(const CrushingLoads &loads, const Crushing &a, const Crushed &b) {
  return loads.covariance(a.diameter, b.diameter) +
         (a.material == b.material ? kCrushingModel * kCrushingModel : 0.0);
}

/// Covariance of the logarithms of the loads that were read.
Matrix covariance_of(const CrushingLoads &loads, const std::vector<Crushed> &read) {
  const auto n = Eigen::Index(read.size());
  Matrix out(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const Crushed &a = read[std::size_t(i)];
      out(i, j) = covariance_between(loads, {a.material, a.diameter, {}}, read[std::size_t(j)]) +
                  (i == j ? std::pow(a.sd / a.load, 2) : 0.0);
    }
  return out;
}

/// Logarithms read less those of the line, for the strength of the draw.
Vector off_line(const FilmBank &bank, const std::vector<Crushed> &read, const Draw &draw) {
  Vector out{Eigen::Index(read.size())};
  for (std::size_t k = 0; k < read.size(); ++k)
    out[Eigen::Index(k)] =
        std::log(read[k].load) -
        bank.crushing()->log_load(read[k].diameter,
                                  strength_of(bank, draw.materials[std::size_t(read[k].material)]));
  return out;
}

/// Rows to fill, of each material: the bank's diameters and those that were read.
std::vector<Crushing> rows_of(const FilmBank &bank, const Calibration &c) {
  std::vector<Crushing> out;
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    std::vector<Crushing> rows;
    for (const double d : bank.crushing()->diameters())
      rows.push_back({int(m), d, {}});
    for (const Crushed &k : c.crushed) {
      if (k.material != int(m))
        continue;
      const auto at = std::find_if(rows.begin(), rows.end(), [&](const Crushing &row) {
        return row.diameter == k.diameter && row.measured == 0.0;
      });
      if (at == rows.end())
        rows.push_back({int(m), k.diameter, {}, k.load, k.sd});
      else
        *at = {int(m), k.diameter, {}, k.load, k.sd};
    }
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Crushing &a, const Crushing &b) { return a.diameter < b.diameter; });
    out.insert(out.end(), rows.begin(), rows.end());
  }
  return out;
}

} // namespace

double log_likelihood_of_crushed(const FilmBank &bank, const Calibration &c, int material,
                                 const Material &as) {
  std::vector<Crushed> read;
  for (const Crushed &k : c.crushed)
    if (k.material == material)
      read.push_back(k);
  if (read.empty())
    return 0.0;
  Vector off{Eigen::Index(read.size())};
  for (std::size_t k = 0; k < read.size(); ++k)
    off[Eigen::Index(k)] =
        std::log(read[k].load) - bank.crushing()->log_load(read[k].diameter, strength_of(bank, as));
  return -0.5 * off.dot(Cholesky(covariance_of(*bank.crushing(), read)).solve(off));
}

std::vector<std::string> contradicting_loads(const FilmBank &bank, const Calibration &c) {
  constexpr double kFar = 2.0;
  std::vector<std::string> out;
  if (c.crushed.empty())
    return out;
  Vector off = Vector::Zero(Eigen::Index(c.crushed.size()));
  for (const Draw &d : c.draws)
    off += off_line(bank, c.crushed, d) / double(c.draws.size());
  const Matrix covariance = covariance_of(*bank.crushing(), c.crushed);
  for (std::size_t k = 0; k < c.crushed.size(); ++k) {
    const auto at = Eigen::Index(k);
    if (std::fabs(off[at]) > kFar * std::sqrt(covariance(at, at)))
      out.push_back(
          fmt::format("Particles of {:g} um{} broke at {:g} mN; with the strength that was "
                      "found they break at {:.3g} mN. Check diameter, load and unit.",
                      c.crushed[k].diameter, of_material(c, std::size_t(c.crushed[k].material)),
                      c.crushed[k].load, c.crushed[k].load * std::exp(-off[at])));
  }
  return out;
}

std::vector<Crushing> crushing_of(const FilmBank &bank, const Calibration &c) {
  if (!bank.crushing() || bank.strength() < 0)
    return {};
  const CrushingLoads &loads = *bank.crushing();
  std::vector<Crushing> out = rows_of(bank, c);
  const Cholesky of_read(covariance_of(loads, c.crushed));
  for (Crushing &row : out) {
    Vector with{Eigen::Index(c.crushed.size())};
    for (std::size_t k = 0; k < c.crushed.size(); ++k)
      with[Eigen::Index(k)] = covariance_between(loads, row, c.crushed[k]);
    const Vector weights = of_read.solve(with);
    const double left = loads.covariance(row.diameter, row.diameter) +
                        kCrushingModel * kCrushingModel - with.dot(weights);
    Mixture logs;
    for (const Draw &d : c.draws)
      logs.of.push_back(
          {loads.log_load(row.diameter, strength_of(bank, d.materials[std::size_t(row.material)])) +
               weights.dot(off_line(bank, c.crushed, d)),
           left});
    const Band b = band_of(logs, -INFINITY, INFINITY);
    row.load = {std::exp(b.median), std::exp(b.low50), std::exp(b.high50), std::exp(b.low90),
                std::exp(b.high90)};
  }
  return out;
}

} // namespace calendem
