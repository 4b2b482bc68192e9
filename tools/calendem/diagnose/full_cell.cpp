// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/full_cell.h"
#include <fmt/format.h>
#include <map>

namespace calendem {
using inference::Matrix;
using inference::Vector;

Transfer transfer_of(const Experiment &e, const BankTable &bank, const std::vector<Covered> &all,
                     std::vector<std::string> &not_said) {
  std::map<int, std::map<std::string, PointRuns>> runs;
  for (const BankRow &row : bank.rows)
    if (row.point.effect.empty() || row.point.effect == kFullCell)
      runs[row.point.base_point][row.point.effect].push_back(&row);
  const auto as_it_is = [](const SimulatedRun &r) { return r; };
  std::vector<Vector> changes;
  for (auto &[point, of] : runs)
    if (of[kFullCell].size() == bank.spec.pressures.size() && of[kFullCell].size() == of[""].size())
      changes.push_back(values_of(all, of[kFullCell], as_it_is) - values_of(all, of[""], as_it_is));
  if (changes.size() < 2)
    return {};
  const double small = read_recipe(bank.spec.recipe_file).loading,
               full = read_recipe(bank.spec.full_cell.recipe_file).loading;
  const double share = (1.0 / small - 1.0 / e.recipe.loading) / (1.0 / small - 1.0 / full);
  const double n = double(changes.size());
  Matrix d(changes[0].size(), Eigen::Index(changes.size()));
  for (std::size_t k = 0; k < changes.size(); ++k)
    d.col(Eigen::Index(k)) = changes[k];
  const Vector mean = d.rowwise().mean();
  d.colwise() -= mean;
  not_said.push_back(fmt::format(
      "The bank's cell carries {:g} mg/cm2, the sample {:g}: its runs are shifted by {:.0f} % of "
      "what {} runs of {:g} mg/cm2 differ by; how well that is known counts as uncertainty.",
      small, e.recipe.loading, 100.0 * share, changes.size(), full));
  return {share * mean, share * share * (1.0 + 1.0 / n) / (n - 1.0) * d * d.transpose()};
}

} // namespace calendem
