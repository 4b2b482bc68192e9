// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/learnt.h"
#include "inference/ensemble.h"
#include <algorithm>
#include <cmath>

namespace calendem {
namespace {

/// A parameter and its normal score in each draw.
struct Scores {
  std::string name;
  std::vector<double> of;
};

std::vector<Scores> scores_of(const FilmBank &bank, const Calibration &c) {
  std::vector<Scores> out;
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    for (std::size_t k = 0; k < bank.material().size(); ++k) {
      Scores s;
      s.name = bank.material()[k].name + of_material(c, m);
      for (const Draw &d : c.draws)
        s.of.push_back(bank.material()[k].prior.score(d.materials[m].parameters[k]));
      out.push_back(s);
    }
  return out;
}

/// Moments of values by weights that sum to 1.
struct Moments {
  double mean = 0.0, sd = 0.0;
};

Moments moments_of(const std::vector<double> &values, const std::vector<double> &weights) {
  Moments out;
  double squares = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    out.mean += weights[k] * values[k];
    squares += weights[k] * values[k] * values[k];
  }
  out.sd = std::sqrt(std::max(0.0, squares - out.mean * out.mean));
  return out;
}

/// Shares of the draws without a datum.
std::vector<double> weights_without(const std::vector<std::vector<MeanVariance>> &predicted,
                                    std::size_t datum, double measured) {
  std::vector<double> logs;
  for (const std::vector<MeanVariance> &of : predicted) {
    const MeanVariance &g = of[datum];
    logs.push_back(0.5 * std::pow(measured - g.mean, 2) / g.variance + 0.5 * std::log(g.variance));
  }
  const double largest = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (double &l : logs)
    sum += l = std::exp(l - largest);
  for (double &l : logs)
    l /= sum;
  return logs;
}

LeftOutDatum lesson_of(const std::vector<std::vector<MeanVariance>> &predicted, std::size_t datum,
                       double measured, const std::vector<Scores> &scores) {
  const std::vector<double> without = weights_without(predicted, datum, measured),
                            with(without.size(), 1.0 / double(without.size()));
  LeftOutDatum out;
  Mixture mixture;
  for (const std::size_t k :
       inference::resampled(inference::Vector::Map(without.data(), Eigen::Index(without.size())),
                            int(without.size())))
    mixture.of.push_back(predicted[k][datum]);
  out.without = band_of(mixture, 0.0, 1.0);
  double squares = 0.0;
  for (const double w : without) {
    squares += w * w;
    out.gain -= std::log(std::max(w * double(without.size()), 1e-300)) / double(without.size());
  }
  out.effective = 1.0 / squares;
  for (const Scores &s : scores) {
    const Moments before = moments_of(s.of, without), after = moments_of(s.of, with);
    const double shift = before.sd > 0.0 ? (after.mean - before.mean) / before.sd : 0.0;
    if (out.parameter.empty() || std::fabs(shift) > std::fabs(out.shift)) {
      out.parameter = s.name;
      out.shift = shift;
    }
  }
  return out;
}

} // namespace

std::vector<LeftOutDatum> left_out_data_of(const FilmBank &bank, const Calibration &c) {
  std::vector<LeftOutDatum> out;
  if (c.data.size() < 2)
    return out;
  const Predictions predicted = each_from_the_others(bank, c);
  const std::vector<Scores> scores = scores_of(bank, c);
  for (std::size_t k = 0; k < c.data.size(); ++k)
    out.push_back(lesson_of(predicted, k, c.data[k].measured, scores));
  return out;
}

std::vector<TradeOff> trade_offs_of(const FilmBank &bank, const Calibration &c, double least) {
  const std::vector<Scores> scores = scores_of(bank, c);
  const std::vector<double> equal(c.draws.size(), 1.0 / double(c.draws.size()));
  std::vector<TradeOff> out;
  for (std::size_t a = 0; a < scores.size(); ++a)
    for (std::size_t b = a + 1; b < scores.size(); ++b) {
      std::vector<double> product;
      for (std::size_t k = 0; k < equal.size(); ++k)
        product.push_back(scores[a].of[k] * scores[b].of[k]);
      const Moments x = moments_of(scores[a].of, equal), y = moments_of(scores[b].of, equal);
      const double r = (moments_of(product, equal).mean - x.mean * y.mean) / (x.sd * y.sd);
      if (std::fabs(r) > least)
        out.push_back({scores[a].name, scores[b].name, r});
    }
  std::sort(out.begin(), out.end(), [](const TradeOff &a, const TradeOff &b) {
    return std::fabs(a.correlation) > std::fabs(b.correlation);
  });
  return out;
}

} // namespace calendem
