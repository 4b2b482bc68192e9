// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/emulators.h"
#include <algorithm>
#include <cmath>

namespace calendem::inference {
namespace {

/// Scaled base parameters and effect's parameters; strengths of its amplitudes.
struct Point {
  Vector input, amplitudes;
};

Point point_of(const Vector &scaled_base, const ModelledEffect &effect, const Vector &values) {
  Point p;
  const auto n = scaled_base.size();
  p.input.resize(n + values.size());
  p.input.head(n) = scaled_base;
  Eigen::Index amplitudes = 0;
  for (const Parameter &q : effect.parameters)
    amplitudes += q.amplitude;
  p.amplitudes.resize(amplitudes);
  amplitudes = 0;
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    const Parameter &q = effect.parameters[std::size_t(j)];
    p.input[n + j] = q.input(values[j]);
    if (q.amplitude)
      p.amplitudes[amplitudes++] = q.strength(values[j]);
  }
  return p;
}

Point point_at(const Vector &scaled_base, const ModelledEffect &effect, const Vector &scores) {
  Vector values(scores.size());
  for (Eigen::Index j = 0; j < values.size(); ++j)
    values[j] = effect.parameters[std::size_t(j)].prior.value(scores[j]);
  return point_of(scaled_base, effect, values);
}

Training effect_training(const Bank &bank, const ModelledEffect &effect,
                         const std::vector<std::pair<int, int>> &pairs,
                         const std::vector<int> &packing) {
  Training t;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const BankRun &on = bank.runs[pairs[k].second];
    const Point p = point_of(scaled_base(bank, on), effect, on.amplitudes);
    if (k == 0) {
      t.inputs.resize(p.input.size(), Eigen::Index(pairs.size()));
      t.amplitudes.resize(p.amplitudes.size(), Eigen::Index(pairs.size()));
    }
    t.inputs.col(Eigen::Index(k)) = p.input;
    t.amplitudes.col(Eigen::Index(k)) = p.amplitudes;
    t.packing.push_back(packing[pairs[k].second]);
  }
  return t;
}

} // namespace

std::vector<int> base_runs(const Bank &bank) {
  std::vector<int> places;
  for (int i = 0; i < int(bank.runs.size()); ++i)
    if (bank.runs[i].effect.empty())
      places.push_back(i);
  return places;
}

Vector scaled_base(const Bank &bank, const BankRun &run) {
  Vector scaled(run.base.size());
  for (Eigen::Index j = 0; j < scaled.size(); ++j)
    scaled[j] = bank.base[std::size_t(j)].prior.scaled(run.base[j]);
  return scaled;
}

Emulators::Emulators(const Bank &bank, const Matrix &features)
    : parameters_(bank.base), table_(bank.effects) {
  std::vector<int> packing;
  for (const BankRun &r : bank.runs)
    packing.push_back(number_.emplace(r.packing, int(number_.size())).first->second);
  const auto base = base_runs(bank);
  Training t;
  t.inputs.resize(Eigen::Index(bank.base.size()), Eigen::Index(base.size()));
  t.amplitudes.resize(0, Eigen::Index(base.size()));
  for (std::size_t k = 0; k < base.size(); ++k) {
    t.inputs.col(Eigen::Index(k)) = scaled_base(bank, bank.runs[base[k]]);
    t.packing.push_back(packing[base[k]]);
  }
  packing_ = t.packing;
  runs_ = base;
  for (Eigen::Index f = 0; f < features.rows(); ++f) {
    t.values = features.row(f)(base);
    base_.emplace_back(t);
  }
  for (const ModelledEffect &effect : bank.effects) {
    const auto pairs = pairs_of(bank, effect.name);
    Training difference = effect_training(bank, effect, pairs, packing);
    difference.values.resize(Eigen::Index(pairs.size()));
    for (const auto &[off, on] : pairs)
      if (!effect.computed)
        runs_.push_back(on);
    effects_.emplace_back();
    for (Eigen::Index f = 0; f < features.rows(); ++f) {
      for (std::size_t k = 0; k < pairs.size(); ++k)
        difference.values[Eigen::Index(k)] =
            features(f, pairs[k].second) - features(f, pairs[k].first);
      difference.usual_noise =
          effect.computed ? 0.0 : kOfDifference * base_[std::size_t(f)].run_variance();
      effects_.back().emplace_back(difference);
    }
  }
}

Asked Emulators::asked(int effect, const std::vector<Vector> &base,
                       const std::vector<Vector> &amplitudes,
                       const std::vector<std::string> &packing) const {
  Asked out;
  std::map<std::string, int> number = number_; // and those that the bank has not
  const auto n = Eigen::Index(base.size());
  for (Eigen::Index k = 0; k < n; ++k) {
    Vector scaled(base[std::size_t(k)].size());
    for (Eigen::Index j = 0; j < scaled.size(); ++j)
      scaled[j] = parameters_[std::size_t(j)].prior.scaled(base[std::size_t(k)][j]);
    const Point p = point_of(scaled, table_[std::size_t(effect)], amplitudes[std::size_t(k)]);
    if (k == 0) {
      out.inputs.resize(p.input.size(), n);
      out.amplitudes.resize(p.amplitudes.size(), n);
    }
    out.inputs.col(k) = p.input;
    out.amplitudes.col(k) = p.amplitudes;
    const std::string &id = packing[std::size_t(k)];
    const int next = int(number.size());
    out.packing.push_back(id.empty() ? kExpectation : number.emplace(id, next).first->second);
  }
  return out;
}

Matrix Emulators::residuals() const {
  std::vector<const std::vector<GaussianProcess> *> simulated{&base_};
  for (std::size_t e = 0; e < effects_.size(); ++e)
    if (!table_[e].computed)
      simulated.push_back(&effects_[e]);
  const auto features = Eigen::Index(base_.size());
  Matrix all(0, features);
  for (const auto *group : simulated) {
    const Eigen::Index before = all.rows(),
                       runs = group->empty() ? 0 : group->front().residuals().size();
    all.conservativeResize(before + runs, features);
    for (Eigen::Index f = 0; f < features && runs > 0; ++f) {
      const GaussianProcess &g = (*group)[std::size_t(f)];
      const double sd = std::sqrt(g.run_variance() + g.packing_variance());
      all.col(f).tail(runs) = g.residuals() / std::max(sd, 1e-300);
    }
  }
  return all;
}

Vector Emulators::scaled(const Vector &base_scores) const {
  Vector base(base_scores.size());
  for (Eigen::Index j = 0; j < base.size(); ++j) {
    const Prior &p = parameters_[std::size_t(j)].prior;
    base[j] = p.scaled(p.value(base_scores[j]));
  }
  return base;
}

void Emulators::predict(const Vector &base_scores, const std::vector<Applied> &on, int first,
                        Prediction &out, Part of) const {
  const Vector base = scaled(base_scores);
  for (std::size_t f = 0; f < base_.size() && of == Part::whole; ++f) {
    const Mean m = base_[f].at(base, Vector());
    out.mean[first + Eigen::Index(f)] += m.mean;
    out.variance[first + Eigen::Index(f)] += m.variance;
  }
  for (const Applied &a : on) {
    const Point p = point_at(base, table_[std::size_t(a.effect)], a.scores);
    for (std::size_t f = 0; f < base_.size(); ++f) {
      const GaussianProcess &g = effects_[std::size_t(a.effect)][f];
      const Mean m = g.at(p.input, p.amplitudes);
      const Eigen::Index row = first + Eigen::Index(f);
      out.mean[row] += m.mean;
      out.variance[row] += m.variance;
      out.scatter[row] += g.packing_variance() * p.amplitudes.squaredNorm();
    }
  }
}

void Emulators::slopes(const Vector &base_scores, const std::vector<Applied> &on, int first,
                       Slopes &out, Part of) const {
  const Vector base = scaled(base_scores);
  const auto n = base.size();
  Vector per_score(n);
  for (Eigen::Index j = 0; j < n; ++j)
    per_score[j] = parameters_[std::size_t(j)].prior.scaled_slope(base_scores[j]);
  for (std::size_t f = 0; f < base_.size() && of == Part::whole; ++f) {
    const MeanSlopes s = base_[f].slopes_at(base, Vector());
    const Eigen::Index row = first + Eigen::Index(f);
    out.here.mean[row] += s.here.mean;
    out.here.variance[row] += s.here.variance;
    out.mean.row(row).head(n) += s.mean_inputs.cwiseProduct(per_score).transpose();
    out.variance.row(row).head(n) += s.variance_inputs.cwiseProduct(per_score).transpose();
  }
  Eigen::Index column = n;
  for (const Applied &a : on) {
    const ModelledEffect &effect = table_[std::size_t(a.effect)];
    const Point p = point_at(base, effect, a.scores);
    for (std::size_t f = 0; f < base_.size(); ++f) {
      const GaussianProcess &g = effects_[std::size_t(a.effect)][f];
      const MeanSlopes s = g.slopes_at(p.input, p.amplitudes);
      const Eigen::Index row = first + Eigen::Index(f);
      out.here.mean[row] += s.here.mean;
      out.here.variance[row] += s.here.variance;
      out.here.scatter[row] += g.packing_variance() * p.amplitudes.squaredNorm();
      out.mean.row(row).head(n) += s.mean_inputs.head(n).cwiseProduct(per_score).transpose();
      out.variance.row(row).head(n) +=
          s.variance_inputs.head(n).cwiseProduct(per_score).transpose();
      Eigen::Index amplitude = 0;
      for (Eigen::Index j = 0; j < a.scores.size(); ++j) {
        const Parameter &q = effect.parameters[std::size_t(j)];
        const double input = q.input_slope(a.scores[j]);
        out.mean(row, column + j) += input * s.mean_inputs[n + j];
        out.variance(row, column + j) += input * s.variance_inputs[n + j];
        if (!q.amplitude)
          continue;
        const double strength =
            q.strength_slope(q.prior.value(a.scores[j])) * q.prior.value_slope(a.scores[j]);
        out.mean(row, column + j) += strength * s.mean_amplitudes[amplitude];
        out.variance(row, column + j) += strength * s.variance_amplitudes[amplitude];
        out.scatter(row, column + j) +=
            strength * 2.0 * g.packing_variance() * p.amplitudes[amplitude++];
      }
    }
    column += a.scores.size();
  }
}

} // namespace calendem::inference
