// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/crushed.h"
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

double log_likelihood_of_crushed(const FilmBank &bank, const Calibration &c, const Draw &draw) {
  if (c.crushed.empty())
    return 0.0;
  const CrushingLoads &loads = *bank.crushing();
  const auto n = Eigen::Index(c.crushed.size());
  Vector off(n);
  Matrix covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Crushed &a = c.crushed[std::size_t(i)];
    off[i] = std::log(a.load) -
             loads.log_load(a.diameter, strength_of(bank, draw.materials[std::size_t(a.material)]));
    for (Eigen::Index j = 0; j < n; ++j) {
      const Crushed &b = c.crushed[std::size_t(j)];
      covariance(i, j) = loads.covariance(a.diameter, b.diameter);
      if (a.material == b.material)
        covariance(i, j) += kCrushingModel * kCrushingModel;
      if (i == j)
        covariance(i, j) += std::pow(a.sd / a.load, 2);
    }
  }
  return -0.5 * off.dot(Cholesky(covariance).solve(off));
}

std::vector<Crushing> crushing_of(const FilmBank &bank, const Calibration &c) {
  std::vector<Crushing> out;
  if (!bank.crushing() || bank.strength() < 0)
    return out;
  const CrushingLoads &loads = *bank.crushing();
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    std::vector<Crushing> rows;
    for (const Crushed &k : c.crushed)
      if (k.material == int(m))
        rows.push_back({int(m), k.diameter, {}, k.load, k.sd});
    if (rows.empty())
      for (const double d : loads.diameters())
        rows.push_back({int(m), d, {}});
    for (Crushing &row : rows) {
      Mixture logs;
      for (const Draw &d : c.draws)
        logs.of.push_back(
            {loads.log_load(row.diameter, strength_of(bank, d.materials[m])),
             loads.covariance(row.diameter, row.diameter) + kCrushingModel * kCrushingModel});
      const Band b = band_of(logs, -INFINITY, INFINITY);
      row.load = {std::exp(b.median), std::exp(b.low50), std::exp(b.high50), std::exp(b.low90),
                  std::exp(b.high90)};
      out.push_back(row);
    }
  }
  return out;
}

} // namespace calendem
