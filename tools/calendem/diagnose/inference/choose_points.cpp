// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/choose_points.h"
#include "diagnose/inference/emulators.h"
#include <algorithm>
#include <cmath>
#include <set>

namespace calendem::inference {
namespace {

constexpr int kPlaces = 32; // of priors, over which the information is averaged
constexpr std::uint64_t kPlacesSeed = 11;

/// One effect: what its emulators would know after some runs.
class Learning {
public:
  Learning(const Model &model, const Bank &bank, int effect,
           const std::vector<const PossiblePoint *> &possible);

  /// Bits, of running this one too.
  double gain(Eigen::Index run) const { return information(run) - now_; }
  void learn(Eigen::Index run);

private:
  static constexpr Eigen::Index kNone = -1;
  Matrix square_, others_;    ///< features x places: mean^2, variance of data and base emulator
  Matrix at_first_;           ///< that of the effect's emulators before any run
  std::vector<Matrix> known_; ///< by feature: covariance of runs, then places
  double now_ = 0.0;          ///< information

  double information(Eigen::Index run) const;
};

Learning::Learning(const Model &model, const Bank &bank, int effect,
                   const std::vector<const PossiblePoint *> &possible) {
  const ModelledEffect &of = bank.effects[std::size_t(effect)];
  const auto base = Eigen::Index(bank.base.size()), own = Eigen::Index(of.parameters.size());
  const Matrix scores = sobol_normals(int(base + own), kPlaces, kPlacesSeed);
  std::vector<Vector> bases, amplitudes;
  std::vector<std::string> packing;
  for (const PossiblePoint *p : possible) {
    bases.push_back(p->base);
    amplitudes.push_back(p->amplitudes);
    packing.push_back(p->packing);
  }
  const Vector data = model.data_variance();
  const auto features = data.size();
  square_ = others_ = at_first_ = Matrix::Zero(features, kPlaces);
  const Problem problem = model.problem(Vector::Zero(Eigen::Index(model.observables().size())));
  for (Eigen::Index k = 0; k < kPlaces; ++k) {
    const Vector of_base = scores.col(k).head(base), of_effect = scores.col(k).tail(own);
    Vector values(base), strength(own);
    for (Eigen::Index j = 0; j < base; ++j)
      values[j] = bank.base[std::size_t(j)].prior.value(of_base[j]);
    for (Eigen::Index j = 0; j < own; ++j)
      strength[j] = of.parameters[std::size_t(j)].prior.value(of_effect[j]);
    bases.push_back(values);
    amplitudes.push_back(strength);
    packing.emplace_back();
    const Prediction off = problem.predict(of_base, {}),
                     on = problem.predict(of_base, {{effect, of_effect}});
    square_.col(k) = (on.mean - off.mean).head(features).cwiseAbs2();
    others_.col(k) =
        data + off.variance.head(features) + on.scatter.head(features) / model.packings_in_sample();
  }
  const Asked asked = model.emulators().asked(effect, bases, amplitudes, packing);
  for (Eigen::Index f = 0; f < features; ++f) {
    known_.push_back(model.emulators().effect(effect)[std::size_t(f)].covariance(asked));
    at_first_.row(f) = known_.back().diagonal().tail(kPlaces).transpose();
  }
  now_ = information(kNone);
}

double Learning::information(Eigen::Index run) const {
  Vector ratio = Vector::Zero(kPlaces); // S/N^2
  for (Eigen::Index f = 0; f < square_.rows(); ++f) {
    const Matrix &c = known_[std::size_t(f)];
    Vector left = c.diagonal().tail(kPlaces);
    if (run != kNone)
      left -= c.col(run).tail(kPlaces).cwiseAbs2() / c(run, run);
    left = left.cwiseMax(0.0);
    const Vector first = at_first_.row(f).transpose();
    ratio.array() += (square_.row(f).transpose() + first - left).array() /
                     (others_.row(f).transpose() + left).array();
  }
  return 0.5 * (1.0 + ratio.array()).log().mean() / std::log(2.0);
}

void Learning::learn(Eigen::Index run) {
  for (Matrix &c : known_) {
    const Vector with = c.col(run) / std::sqrt(c(run, run));
    c.noalias() -= with * with.transpose();
  }
  now_ = information(kNone);
}

/// Places in the list of the points of one effect.
std::vector<int> of_effect(const std::vector<PossiblePoint> &points, int effect) {
  std::vector<int> out;
  for (int k = 0; k < int(points.size()); ++k)
    if (points[std::size_t(k)].effect == effect)
      out.push_back(k);
  return out;
}

std::vector<const PossiblePoint *> at(const std::vector<PossiblePoint> &points,
                                      const std::vector<int> &places) {
  std::vector<const PossiblePoint *> out;
  for (const int k : places)
    out.push_back(&points[std::size_t(k)]);
  return out;
}

/// The points of one effect in the order in which they gain most, `count` at most.
std::vector<ChosenPoint> in_order(const Model &model, const Bank &bank,
                                  const std::vector<PossiblePoint> &points, int effect, int count) {
  const std::vector<int> places = of_effect(points, effect);
  std::vector<ChosenPoint> out;
  if (places.empty())
    return out;
  Learning learning(model, bank, effect, at(points, places));
  std::set<int> taken; // base runs
  while (int(out.size()) < count) {
    int best = -1;
    double most = 0.0;
    for (int k = 0; k < int(places.size()); ++k) {
      if (taken.count(points[std::size_t(places[std::size_t(k)])].beside) > 0)
        continue;
      const double gain = learning.gain(k);
      if (best < 0 || gain > most) {
        best = k;
        most = gain;
      }
    }
    if (best < 0)
      break;
    const int place = places[std::size_t(best)];
    taken.insert(points[std::size_t(place)].beside);
    learning.learn(best);
    out.push_back({place, most});
  }
  return out;
}

} // namespace

std::vector<ChosenPoint> choose_points(const Model &model, const Bank &bank,
                                       const std::vector<PossiblePoint> &possible, int count) {
  std::vector<std::vector<ChosenPoint>> of; // by effect
  for (int effect = 0; effect < int(bank.effects.size()); ++effect)
    of.push_back(in_order(model, bank, possible, effect, count));
  std::vector<std::size_t> next(of.size(), 0);
  std::vector<ChosenPoint> out;
  while (int(out.size()) < count) { // effects do not teach each other: the best of all first
    int best = -1;
    for (int e = 0; e < int(of.size()); ++e)
      if (next[std::size_t(e)] < of[std::size_t(e)].size() &&
          (best < 0 || of[std::size_t(e)][next[std::size_t(e)]].gain >
                           of[std::size_t(best)][next[std::size_t(best)]].gain))
        best = e;
    if (best < 0)
      break;
    out.push_back(of[std::size_t(best)][next[std::size_t(best)]++]);
  }
  return out;
}

std::vector<double> information_gain(const Model &model, const Bank &bank,
                                     const std::vector<PossiblePoint> &points) {
  std::vector<double> out(bank.effects.size(), 0.0);
  for (int effect = 0; effect < int(bank.effects.size()); ++effect) {
    const std::vector<int> places = of_effect(points, effect);
    if (places.empty())
      continue;
    Learning learning(model, bank, effect, at(points, places));
    for (Eigen::Index k = 0; k < Eigen::Index(places.size()); ++k) {
      out[std::size_t(effect)] += learning.gain(k);
      learning.learn(k);
    }
  }
  return out;
}

} // namespace calendem::inference
