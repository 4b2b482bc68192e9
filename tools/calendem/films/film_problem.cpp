// SPDX-License-Identifier: GPL-2.0-or-later
#include "films/film_problem.h"
#include "base/case.h"
#include "films/film_readings.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace calendem {

using inference::Cholesky;
using inference::Matrix;
using inference::Vector;
namespace {

using Eigen::Index;

// Small cells give way in jumps: squares of the errors of packings that were left out are spread as those of a t
// distribution with 10 to 14 degrees of freedom (docs/validation/films_bank.md).
constexpr double kDegreesOfOneCell = 12.0;
constexpr double kNodesFrom = 1.0, kNodesTo = 6.0; // of ln(p / MPa), one apart

/// Readings whose errors of the model are alike at like pressures.
std::string kind_of(const Observable &o) {
  return o.curve.empty() ? o.name + "|" + o.stage : o.curve + "|" + o.stage;
}

double pressure_of(const Reading &r) {
  return r.observable.pressure > 0.0 ? r.observable.pressure : r.pressure;
}

/// Values of a shared discrepancy at nodes, whose product is about `alike_at`.
Matrix node_factors(const std::vector<double> &pressures) {
  const auto nodes = Index(kNodesTo - kNodesFrom) + 1, n = Index(pressures.size());
  const auto node = [](Index k) { return std::exp(kNodesFrom + double(k)); };
  Matrix between(nodes, nodes), with(nodes, n);
  for (Index i = 0; i < nodes; ++i) {
    for (Index j = 0; j < nodes; ++j)
      between(i, j) = alike_at(node(i), node(j)) + (i == j ? 1e-6 : 0.0);
    for (Index k = 0; k < n; ++k)
      with(i, k) = alike_at(node(i), pressures[std::size_t(k)]);
  }
  return Cholesky(between).matrixL().solve(with).transpose();
}

/// C_ij / sqrt(C_ii C_jj), 1 on the diagonal.
Matrix correlation_of(const Matrix &covariance) {
  const Vector sd = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
  Matrix out = sd.cwiseInverse().asDiagonal() * covariance * sd.cwiseInverse().asDiagonal();
  out.diagonal().setOnes();
  return out;
}

/// Adds `of` of each reading as an error common to readings of one group.
void add_common(const std::vector<Reading> &readings, const Vector &of, std::string Reading::*group,
                Matrix &to) {
  for (Index i = 0; i < of.size(); ++i)
    for (Index j = 0; j < of.size(); ++j)
      if (readings[std::size_t(i)].*group == readings[std::size_t(j)].*group)
        to(i, j) += of[i] * of[j];
}

/// Covariance of a discrepancy of size 1: readings of one kind have it alike at like pressures.
Matrix discrepancy_of_one(const std::vector<Reading> &readings, const Vector &per_porosity) {
  const Index n = per_porosity.size();
  Matrix out = Matrix::Zero(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const Reading &a = readings[std::size_t(i)], &b = readings[std::size_t(j)];
      if (kind_of(a.observable) == kind_of(b.observable))
        out(i, j) = per_porosity[i] * per_porosity[j] * alike_at(pressure_of(a), pressure_of(b));
    }
  return out;
}

/// A film's data and how they are predicted.
class FilmModel {
public:
  FilmModel(const FilmBank &bank, const MeasuredFilms &measured, int film,
            const std::vector<Reading> &readings, double cells, const Material &middle)
      : readings_(bank, measured.films[std::size_t(film)], readings), cells_(cells),
        correlation_(bank.error_correlation()) {
    const inference::Expectation e = readings_.emulated({&middle}, readings_.outputs());
    outputs_ = e.mean.col(0);
    slopes_ = readings_.slopes(outputs_);
    const Vector sd = e.variance.col(0).cwiseMax(0.0).cwiseSqrt(),
                 packings = e.scatter.col(0).cwiseMax(0.0).cwiseSqrt();
    emulator_ = correlation_of(covariance(sd));
    scatter_ = correlation_of(covariance(packings));
    for (Index o = 0; o < slopes_.cols(); ++o)
      if (slopes_.col(o).any())
        used_.push_back(int(o));
    for (Index k = 0; k < slopes_.rows(); ++k) {
      places_.emplace_back();
      for (std::size_t u = 0; u < used_.size(); ++u)
        if (slopes_(k, used_[u]) != 0.0)
          places_.back().push_back(Index(u));
    }
    slopes_ = Matrix(slopes_(Eigen::all, used_));
    correlation_ = Matrix(correlation_(used_, used_));
  }

  inference::FilmData data(const ModelError &error, double sizes) const;
  inference::FilmPredictions predict(const std::vector<Material> &materials,
                                     const std::vector<PressInstruments> &presses) const;
  Vector per_porosity() const { return readings_.per_porosity(outputs_); }

private:
  FilmReadings readings_;
  double cells_;
  Matrix correlation_, slopes_, emulator_, scatter_;
  Vector outputs_;
  std::vector<int> used_;                  ///< outputs on which any reading depends
  std::vector<std::vector<Index>> places_; ///< places in them on which each depends

  Matrix covariance(const Vector &sd) const {
    const Matrix by = slopes_ * finite(sd).asDiagonal();
    return by * correlation_ * by.transpose();
  }
  static Vector finite(const Vector &of) {
    return of.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
  }
  double variance(Index reading, const Vector &sd) const {
    double sum = 0.0;
    for (const Index i : places_[std::size_t(reading)])
      for (const Index j : places_[std::size_t(reading)])
        sum += slopes_(reading, i) * sd[i] * correlation_(i, j) * sd[j] * slopes_(reading, j);
    return sum;
  }
};

inference::FilmData FilmModel::data(const ModelError &error, double sizes) const {
  const std::vector<Reading> &all = readings_.readings();
  const auto n = Index(all.size());
  inference::FilmData out;
  out.observed.resize(n);
  Vector stated(n), loading(n), drift(n), zero(n), before(n), after(n);
  const Vector per_porosity = readings_.per_porosity(outputs_),
               of_pressed = readings_.derivatives(&Observable::per_porosity, outputs_),
               of_initial = readings_.derivatives(&Observable::per_initial_porosity, outputs_);
  for (Index k = 0; k < n; ++k) {
    const Reading &r = all[std::size_t(k)];
    out.observed[k] = r.observable.measured;
    stated[k] = r.observable.sd * r.observable.sd;
    loading[k] = r.observable.by_loading;
    drift[k] = r.observable.by_drift;
    zero[k] = r.observable.by_zero;
    before[k] = r.specimen_porosity_before * of_initial[k];
    after[k] = r.specimen_porosity * of_pressed[k];
  }
  out.measurement = stated.asDiagonal();
  add_common(all, loading, &Reading::specimen, out.measurement);
  add_common(all, drift, &Reading::condition, out.measurement);
  add_common(all, zero, &Reading::condition, out.measurement);
  out.fixed = Matrix::Zero(n, n);
  add_common(all, before, &Reading::specimen, out.fixed);
  add_common(all, after, &Reading::specimen, out.fixed);
  const double tiny = 1e-12 * std::max(1.0, out.measurement.diagonal().maxCoeff());
  out.fixed.diagonal().array() += tiny;
  out.emulator_correlation = emulator_;
  out.scatter_correlation = scatter_;
  out.discrepancy = discrepancy_of_one(all, per_porosity);
  out.shared_errors.resize(n, 2);
  out.shared_errors.col(0) = error.numerics * of_pressed;
  out.shared_errors.col(1) = kPorosityBySize * sizes * of_pressed;
  return out;
}

inference::FilmPredictions FilmModel::predict(const std::vector<Material> &materials,
                                              const std::vector<PressInstruments> &presses) const {
  std::vector<const Material *> of;
  for (const Material &m : materials)
    of.push_back(&m);
  const inference::Expectation e = readings_.emulated(of, used_);
  const auto n = Index(readings_.readings().size()), count = Index(materials.size());
  inference::FilmPredictions out;
  out.mean.resize(n, count);
  out.variance.resize(n, count);
  if (cells_ > 0.0)
    out.scatter.resize(n, count);
  out.errors.assign(1, Matrix(n, count));
  Vector outputs = outputs_;
  for (Index m = 0; m < count; ++m) {
    outputs(used_) = e.mean.col(m);
    const auto values = readings_.values(outputs, presses[std::size_t(m)]);
    out.mean.col(m) = values.at;
    const Vector sd = finite(e.variance.col(m).cwiseMax(0.0).cwiseSqrt()),
                 packings = finite(e.scatter.col(m).cwiseMax(0.0).cwiseSqrt());
    for (Index k = 0; k < n; ++k) {
      out.errors[0](k, m) =
          values.by_log_pressure[k] * readings_.readings()[std::size_t(k)].pressure_sd;
      out.variance(k, m) = variance(k, sd);
      if (cells_ > 0.0)
        out.scatter(k, m) = variance(k, packings) / cells_;
    }
  }
  return out;
}

/// Kinds of readings that several films have: their discrepancies may be common.
std::vector<std::string> common_kinds(const MeasuredFilms &measured) {
  std::map<std::string, int> last; // film that had it last; -1: several
  for (const Reading &r : measured.readings) {
    const auto [at, is_new] = last.emplace(kind_of(r.observable), r.film);
    if (!is_new && at->second != r.film)
      at->second = -1;
  }
  std::vector<std::string> out;
  for (const auto &[kind, film] : last)
    if (film < 0)
      out.push_back(kind);
  return out;
}

Matrix shared_discrepancy(const std::vector<Reading> &readings, const Vector &per_porosity,
                          const std::vector<std::string> &kinds) {
  std::vector<double> pressures;
  for (const Reading &r : readings)
    pressures.push_back(pressure_of(r));
  const Matrix factors = node_factors(pressures);
  Matrix out = Matrix::Zero(factors.rows(), factors.cols() * Index(kinds.size()));
  for (Index k = 0; k < factors.rows(); ++k) {
    const auto at =
        std::find(kinds.begin(), kinds.end(), kind_of(readings[std::size_t(k)].observable));
    if (at != kinds.end())
      out.row(k).segment((at - kinds.begin()) * factors.cols(), factors.cols()) =
          per_porosity[k] * factors.row(k);
  }
  return out;
}

/// The mean of N cells has an Nth of their excess kurtosis, 6 / (degrees - 4).
double degrees_of_freedom(const std::vector<double> &cells) {
  double fewest = inference::kNormal;
  for (const double n : cells)
    if (n > 0.0)
      fewest = std::min(fewest, n);
  return std::min(inference::kNormal, 4.0 + fewest * (kDegreesOfOneCell - 4.0));
}

inference::Parameter fault_parameter(const std::string &name) {
  const EffectParameter &p = find_effect(name).parameter;
  bank::Input input;
  input.name = name;
  input.off = p.off;
  input.low = p.low;
  input.high = p.high;
  input.spread = p.spread;
  return bank::parameter_of(input);
}

/// What all films' predictors share.
struct Shared {
  std::vector<inference::Parameter> parameters, effects;
  std::vector<std::vector<int>> excluded; ///< by each effect of a material
  std::vector<FilmModel> films;

  Material material(const Vector &scores, const Vector &amplitudes) const {
    Material out;
    for (std::size_t k = 0; k < parameters.size(); ++k)
      out.parameters.push_back(parameters[k].prior.value(scores[Index(k)]));
    std::vector<char> acting(excluded.size());
    for (std::size_t e = 0; e < acting.size();
         ++e) { // the later one stays, as in the bank's design
      acting[e] = inference::acts(amplitudes[Index(e)]);
      for (const int other : excluded[e])
        acting[std::size_t(other)] = acting[std::size_t(other)] && !acting[e];
    }
    for (std::size_t e = 0; e < acting.size(); ++e)
      if (acting[e])
        out.effects.push_back({int(e), effects[e].prior.value(amplitudes[Index(e)])});
    return out;
  }
  PressInstruments press(const Vector &amplitudes) const {
    PressInstruments out;
    for (std::size_t e = excluded.size(); e < effects.size(); ++e)
      if (inference::acts(amplitudes[Index(e)])) {
        const Effect &effect = find_effect(effects[e].name);
        out.*effect.shown = effect.parameter.value(effects[e].prior.value(amplitudes[Index(e)]));
      }
    return out;
  }
  inference::FilmPredictions predict(int film, const Matrix &scores,
                                     const Matrix &amplitudes) const {
    std::vector<Material> materials;
    std::vector<PressInstruments> presses;
    for (Index m = 0; m < scores.cols(); ++m) {
      materials.push_back(material(scores.col(m), amplitudes.col(m)));
      presses.push_back(press(amplitudes.col(m)));
    }
    return films[std::size_t(film)].predict(materials, presses);
  }
};

} // namespace

ModelError model_error_of(const FilmBank &bank) {
  ModelError out;
  double squares = 0.0;
  for (const bank::Numerics &n : bank.spec().numerics)
    squares += n.porosity_points * n.porosity_points;
  out.numerics = 0.01 * std::sqrt(squares);
  return out;
}

inference::Prior discrepancy_of(const ModelError &error) {
  return {inference::Prior::log_uniform, error.low, error.high};
}

std::vector<std::string> acting_in(const Settings &settings, const FilmBank &bank) {
  std::vector<std::string> out;
  for (const inference::Parameter &e : bank.effects()) {
    const EffectParameter &p = find_effect(e.name).parameter;
    if (!find_effect(e.name).in_recipe && settings.number(p.keys.front()) != std::stod(p.off))
      out.push_back(e.name);
  }
  return out;
}

namespace {

/// Parameters, effects and their priors; the amplitudes of the model that may be wrong, in the middle
/// of their priors.
Vector add_priors(const FilmBank &bank, const ProblemOptions &options, FilmProblem &to) {
  to.parameters = bank.material();
  to.effects = bank.effects();
  inference::PosteriorProblem &p = to.problem;
  Vector middle(Index(to.effects.size()));
  for (std::size_t e = 0; e < to.effects.size(); ++e) {
    const bool acting = std::find(options.acting.begin(), options.acting.end(),
                                  to.effects[e].name) != options.acting.end();
    p.effects.push_back({acting ? 1.0 - options.wrong : options.wrong, false});
    middle[Index(e)] = acting ? 0.0 : inference::kOff;
    to.excluded.push_back(bank.excluded_by(int(e)));
  }
  if (options.faults)
    for (const std::string &fault : bank.spec().faults) {
      to.effects.push_back(fault_parameter(fault));
      p.effects.push_back({options.wrong, true});
    }
  p.parameters = int(to.parameters.size());
  p.discrepancy = discrepancy_of(options.error);
  p.understated = options.understated;
  return middle;
}

} // namespace

FilmProblem problem_of(const FilmBank &bank, const MeasuredFilms &measured,
                       const ProblemOptions &options) {
  FilmProblem out;
  const Vector amplitudes = add_priors(bank, options, out);
  auto shared = std::make_shared<Shared>();
  shared->parameters = out.parameters;
  shared->effects = out.effects;
  shared->excluded = out.excluded;
  inference::PosteriorProblem &p = out.problem;
  p.materials = int(measured.materials.size());
  p.degrees_of_freedom = degrees_of_freedom(measured.cells);
  const Material middle = shared->material(Vector::Zero(Index(out.parameters.size())), amplitudes);
  const std::vector<std::string> kinds = common_kinds(measured);
  for (int f = 0; f < int(measured.films.size()); ++f) {
    std::vector<Reading> readings;
    out.readings.emplace_back();
    for (int k = 0; k < int(measured.readings.size()); ++k)
      if (measured.readings[std::size_t(k)].film == f) {
        readings.push_back(measured.readings[std::size_t(k)]);
        out.readings.back().push_back(k);
      }
    const double cells =
        std::size_t(f) < measured.cells.size() ? measured.cells[std::size_t(f)] : 0.0;
    shared->films.emplace_back(bank, measured, f, readings, cells, middle);
    const Film &film = measured.films[std::size_t(f)];
    p.films.push_back(shared->films.back().data(options.error, film.sizes));
    p.films.back().material = film.material;
    if (!kinds.empty())
      p.films.back().shared_discrepancy =
          shared_discrepancy(readings, shared->films.back().per_porosity(), kinds);
  }
  p.predict = [shared](int film, const Matrix &scores, const Matrix &amplitudes) {
    return shared->predict(film, scores, amplitudes);
  };
  return out;
}

Material material_of(const FilmProblem &of, const Vector &scores, const Vector &amplitudes) {
  Shared shared;
  shared.parameters = of.parameters;
  shared.effects = of.effects;
  shared.excluded = of.excluded;
  return shared.material(scores, amplitudes);
}

} // namespace calendem
