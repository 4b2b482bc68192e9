// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank/design.h"
#include "inference/numerics.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem::bank {
namespace {

/// `share` (0-1) of the way from low to high; four digits, so that tables and files agree.
double value_at(const Input &input, double share) {
  const double v = input.spread == Spread::LogUniform
                       ? input.low * std::pow(input.high / input.low, share)
                       : input.low + share * (input.high - input.low);
  return std::stod(fmt::format("{:.4g}", v));
}

/// Switches off what an effect that acts excludes.
void exclude(const std::vector<Input> &inputs, std::vector<double> &values) {
  for (std::size_t d = inputs.size(); d-- > 0;)
    if (!std::isnan(values[d]))
      for (std::size_t other = 0; other < d; ++other)
        if (const auto &names = inputs[d].excludes;
            std::find(names.begin(), names.end(), inputs[other].name) != names.end())
          values[other] = NAN;
}

} // namespace

std::vector<Point> points_of(const Design &design) {
  const std::size_t inputs = design.inputs.size();
  std::size_t effects = 0;
  for (const Input &input : design.inputs)
    effects += input.is_effect();
  const inference::Matrix shares =
      inference::sobol_points(int(inputs + effects + 1), design.points, design.seed);
  std::vector<Point> out;
  for (int k = 0; k < design.points; ++k) {
    Point point;
    point.number = k + 1;
    point.packing = 1 + k % design.packings;
    Eigen::Index acts = Eigen::Index(inputs);
    for (std::size_t d = 0; d < inputs; ++d) {
      const Input &input = design.inputs[d];
      const bool off = input.is_effect() && shares(acts++, k) >= input.share;
      point.values.push_back(off ? NAN : value_at(input, shares(Eigen::Index(d), k)));
    }
    exclude(design.inputs, point.values);
    point.larger = shares(acts, k) < design.larger.share;
    out.push_back(point);
  }
  return out;
}

Columns columns_of(const Design &design, const std::vector<Point> &points,
                   const std::map<std::string, std::string> &recipe) {
  Columns out;
  out.names.push_back("recipe.seed");
  for (const Input &input : design.inputs)
    out.names.insert(out.names.end(), input.keys.begin(), input.keys.end());
  for (const auto &[key, value] : design.larger.recipe)
    out.names.push_back("recipe." + key);
  for (const Point &point : points) {
    std::vector<std::string> row = {fmt::format("{}", point.packing)};
    for (std::size_t d = 0; d < design.inputs.size(); ++d) {
      const Input &input = design.inputs[d];
      row.insert(row.end(), input.keys.size(),
                 std::isnan(point.values[d]) ? input.off : fmt::format("{}", point.values[d]));
    }
    for (const auto &[key, value] : design.larger.recipe)
      row.push_back(point.larger ? value : recipe.at(key));
    out.rows.push_back(row);
  }
  return out;
}

} // namespace calendem::bank
