// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/model.h"
#include "diagnose/inference/emulators.h"
#include <algorithm>
#include <cmath>

namespace calendem::inference {
namespace {

constexpr double kLength = 0.3, kCommon = 0.5, kRough = 0.1; // of the unknown

/// Observables of the bank that the experiment does not have.
std::vector<int> others_of(const Bank &bank, const std::vector<ObservableId> &experiment) {
  const std::vector<int> own = places_in(bank.observables, experiment);
  std::vector<int> out;
  for (int k = 0; k < int(bank.observables.size()); ++k)
    if (std::find(own.begin(), own.end(), k) == own.end())
      out.push_back(k);
  return out;
}

Matrix values_of(const Bank &bank, const std::vector<int> &places) {
  Matrix values(Eigen::Index(places.size()), Eigen::Index(bank.runs.size()));
  for (std::size_t i = 0; i < bank.runs.size(); ++i)
    values.col(Eigen::Index(i)) = bank.runs[i].values(places);
  return values;
}

/// Variance that a linear fit in the base parameters leaves of the base runs: scatter, roughly.
Vector left_by_line(const Bank &bank, const Matrix &values) {
  const auto base = base_runs(bank);
  Matrix design(Eigen::Index(base.size()), 1 + Eigen::Index(bank.base.size()));
  for (std::size_t i = 0; i < base.size(); ++i) {
    design(Eigen::Index(i), 0) = 1.0;
    design.row(Eigen::Index(i)).tail(design.cols() - 1) =
        scaled_base(bank, bank.runs[base[i]]).transpose();
  }
  const Matrix response = values(Eigen::all, base).transpose();
  const Matrix left = response - design * design.colPivHouseholderQr().solve(response);
  const double degrees = std::max<double>(1.0, double(design.rows() - design.cols()));
  return left.colwise().squaredNorm() / degrees;
}

/// Packings' scatter between features of different specimens is none, of a mean less. The rows are
/// the emulated features of these maps, one after the other.
Matrix of_specimens(Matrix scatter, const std::vector<const FeatureMap *> &maps,
                    const Specimens &specimens) {
  std::vector<Specimen> of;
  for (const FeatureMap *map : maps)
    for (int f = 0; f < map->emulated(); ++f) {
      const int block = map->features()[std::size_t(f)].block;
      const auto at = specimens.find(map->blocks()[std::size_t(block)].condition);
      of.push_back(at == specimens.end() ? Specimen{} : at->second);
    }
  for (std::size_t i = 0; i < of.size(); ++i)
    for (std::size_t j = 0; j < of.size(); ++j)
      scatter(Eigen::Index(i), Eigen::Index(j)) *=
          of[i].name == of[j].name ? 1.0 / std::sqrt(double(of[i].count) * of[j].count) : 0.0;
  return scatter;
}

Matrix side_by_side(const Matrix &left, const Matrix &right) {
  Matrix out(left.rows(), left.cols() + right.cols());
  out << left, right;
  return out;
}

/// Emulators err between features as the runs lie off them.
Matrix correlation_of_errors(const Matrix &residuals) {
  double weight = 0.0;
  return shrunk_correlation(residuals, weight);
}

} // namespace

Matrix unknown_covariance(const std::vector<ObservableId> &observables, const Vector &sd) {
  const int n = int(observables.size());
  Matrix k = Matrix::Zero(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const ObservableId &a = observables[i], &b = observables[j];
      if (a.name != b.name || a.stage != b.stage)
        continue;
      const double apart = (a.coordinate - b.coordinate) / kLength;
      const double common = a.condition == b.condition ? 1.0 : kCommon;
      k(i, j) =
          sd[i] * sd[j] *
          ((1.0 - kRough) * common * std::exp(-0.5 * apart * apart) + (i == j ? kRough : 0.0));
    }
  return k;
}

Model::Model(const Bank &bank, const ObservableVector &experiment, const ModelSettings &settings,
             const std::vector<Candidate> &candidates)
    : observables_(experiment.of), effects_(bank.effects), settings_(settings),
      measurement_(experiment.covariance), base_parameters_(int(bank.base.size())) {
  check(experiment);
  check(bank, others_of(bank, observables_));
  const Matrix values = values_of(bank, places_in(bank.observables, observables_));
  sd_ = (measurement_.diagonal() + left_by_line(bank, values) / settings.packings_in_sample)
            .cwiseSqrt();
  map_ = std::make_shared<FeatureMap>(observables_, values, sd_, measurement_);
  const auto learnt = std::make_shared<Emulators>(bank, map_->emulated_of(values));
  emulators_ = learnt;
  scatter_ = pooled_scatter(learnt->base(), residuals_of(learnt->base()), learnt->packing());
  correlation_ = correlation_of_errors(learnt->residuals());
  judge_emulators();
  for (const Candidate &c : candidates)
    extra_.push_back(learn_extra(bank, c));
}

Model::Extra Model::learn_extra(const Bank &bank, const Candidate &candidate) const {
  check(ObservableVector{candidate.of, Vector::Zero(Eigen::Index(candidate.of.size())),
                         candidate.covariance});
  const std::vector<int> places = places_in(bank.observables, candidate.of),
                         having = runs_that_have(bank, places);
  Bank part = bank;
  part.runs.clear();
  for (const int k : having)
    part.runs.push_back(bank.runs[std::size_t(k)]);
  const Matrix values = values_of(part, places);
  const Vector sd =
      (candidate.covariance.diagonal() + left_by_line(part, values) / settings_.packings_in_sample)
          .cwiseSqrt();
  Extra extra{candidate, nullptr, nullptr, {}, {}};
  extra.map = std::make_shared<FeatureMap>(candidate.of, values, sd, candidate.covariance);
  const auto learnt = std::make_shared<Emulators>(part, extra.map->emulated_of(values));
  extra.emulators = learnt;
  std::vector<int> rows; // of the old emulators' residuals
  for (const int k : learnt->runs())
    rows.push_back(int(
        std::find(emulators_->runs().begin(), emulators_->runs().end(), having[std::size_t(k)]) -
        emulators_->runs().begin()));
  std::vector<GaussianProcess> all = emulators_->base();
  all.insert(all.end(), learnt->base().begin(), learnt->base().end());
  const Eigen::Index runs = Eigen::Index(learnt->packing().size());
  const std::vector<int> of_base(rows.begin(), rows.begin() + runs);
  extra.scatter = of_specimens(
      pooled_scatter(all,
                     side_by_side(residuals_of(emulators_->base())(of_base, Eigen::all),
                                  residuals_of(learnt->base())),
                     learnt->packing())
          .covariance,
      {map_.get(), extra.map.get()}, settings_.specimens);
  extra.correlation = correlation_of_errors(
      side_by_side(emulators_->residuals()(rows, Eigen::all), learnt->residuals()));
  return extra;
}

Vector Model::data_variance() const {
  const Matrix scatter = of_specimens(scatter_.covariance, {map_.get()}, settings_.specimens);
  return map_->covariance(measurement_).diagonal().head(map_->emulated()) +
         scatter.diagonal() / settings_.packings_in_sample;
}

void Model::judge_emulators() {
  const int n = map_->emulated();
  const Vector variance = data_variance();
  for (int which = -1; which < int(effects_.size()); ++which) {
    const auto &learnt = which < 0 ? emulators_->base() : emulators_->effect(which);
    EmulatorQuality q;
    q.effect = which < 0 ? "" : effects_[which].name;
    double missed = 0.0, all = 0.0;
    for (int f = 0; f < n; ++f) {
      const Quality one = learnt[f].left_out();
      const double scatter = one.scatter * one.scatter;
      q.runs = int(learnt[f].residuals().size());
      q.feature.push_back(one);
      missed += (one.error * one.error - scatter) / variance[f];
      all += (one.spread * one.spread - scatter) / variance[f];
      q.error += one.own * one.own / variance[f] / n;
    }
    q.q2 = learnt_share(missed, all);
    q.error = std::sqrt(q.error);
    q.poor = q.q2 < settings_.least_q2 && q.error > settings_.largest_error;
    quality_.push_back(q);
  }
}

std::vector<std::string> Model::poor_effects() const {
  std::vector<std::string> names;
  for (const EmulatorQuality &q : quality_)
    if (q.poor)
      names.push_back(q.effect.empty() ? "none" : q.effect);
  return names;
}

Problem Model::problem(const Vector &values, Part of) const {
  Problem p;
  const int n = map_->emulated(), all = map_->size();
  const double share = 1.0 / settings_.packings_in_sample;
  p.observed = map_->features_of(values);
  p.features = map_->features();
  p.blocks = map_->blocks();
  p.roughness = map_->roughness();
  p.measurement = map_->covariance(measurement_);
  p.scatter = Matrix::Zero(all, all);
  p.scatter.topLeftCorner(n, n) =
      share * of_specimens(scatter_.covariance, {map_.get()}, settings_.specimens);
  p.correlation = Matrix::Identity(all, all);
  p.correlation.topLeftCorner(n, n) = correlation_;
  p.added_scatter = Matrix::Zero(all, all);
  p.added_scatter.topLeftCorner(n, n) =
      share * of_specimens(correlation_, {map_.get()}, settings_.specimens);
  p.degrees_of_freedom = mixed_degrees(p.measurement, p.scatter, scatter_.degrees_of_freedom);
  p.base_parameters = base_parameters_;
  p.effects = effects_;
  p.discrepancy = map_->discrepancy(unknown_covariance(observables_, sd_));
  p.predict = [learnt = emulators_, all, of](const Vector &base, const std::vector<Applied> &on) {
    Prediction out{Vector::Zero(all), Vector::Zero(all), Vector::Zero(all)};
    learnt->predict(base, on, 0, out, of);
    return out;
  };
  p.slopes = [learnt = emulators_, all, of](const Vector &base, const std::vector<Applied> &on) {
    Eigen::Index scores = base.size();
    for (const Applied &a : on)
      scores += a.scores.size();
    const Matrix none = Matrix::Zero(all, scores);
    Slopes out{none, none, none, {Vector::Zero(all), Vector::Zero(all), Vector::Zero(all)}};
    learnt->slopes(base, on, 0, out, of);
    return out;
  };
  return p;
}

std::vector<Extension> Model::extensions(const Vector &values) const {
  std::vector<Extension> list;
  const int n = map_->emulated(), old = map_->size();
  const double share = 1.0 / settings_.packings_in_sample;
  for (const Extra &extra : extra_) {
    const int added = extra.map->emulated(), all = old + added;
    Problem p = problem(values);
    const auto grown = [&](const Matrix &first, const Matrix &second) {
      Matrix both = Matrix::Zero(all, all);
      both.topLeftCorner(old, old) = first;
      both.bottomRightCorner(added, added) = second.topLeftCorner(added, added);
      return both;
    };
    p.measurement = grown(p.measurement, extra.map->covariance(extra.candidate.covariance));
    const Vector sd = extra.candidate.covariance.diagonal().cwiseSqrt();
    p.discrepancy =
        grown(p.discrepancy, extra.map->covariance(unknown_covariance(extra.candidate.of, sd)));
    const auto joined = [&](const Matrix &first, const Matrix &of_both) {
      Matrix both = grown(first, of_both.bottomRightCorner(added, added));
      both.topLeftCorner(n, n) = of_both.topLeftCorner(n, n);
      both.block(0, old, n, added) = of_both.topRightCorner(n, added);
      both.block(old, 0, added, n) = of_both.bottomLeftCorner(added, n);
      return both;
    };
    p.scatter = joined(p.scatter, share * extra.scatter);
    p.correlation = joined(p.correlation, extra.correlation);
    p.added_scatter = joined(p.added_scatter,
                             share * of_specimens(extra.correlation, {map_.get(), extra.map.get()},
                                                  settings_.specimens));
    const int first = int(p.blocks.size());
    for (int f = 0; f < added; ++f)
      p.features.push_back({first + extra.map->features()[std::size_t(f)].block, true});
    p.blocks.insert(p.blocks.end(), extra.map->blocks().begin(), extra.map->blocks().end());
    p.slopes = nullptr; // those are of the old features only
    p.predict = [first = emulators_, second = extra.emulators, old,
                 all](const Vector &base, const std::vector<Applied> &on) {
      Prediction out{Vector::Zero(all), Vector::Zero(all), Vector::Zero(all)};
      first->predict(base, on, 0, out);
      second->predict(base, on, old, out);
      return out;
    };
    list.push_back({extra.candidate.what, extra.candidate.cost, std::move(p)});
  }
  return list;
}

} // namespace calendem::inference
