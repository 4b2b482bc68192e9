// SPDX-License-Identifier: GPL-2.0-or-later
#include "films/film_problem.h"
#include "base/case.h"
#include "films/film_model.h"
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
    const Film &film = measured.films[std::size_t(f)];
    shared->films.emplace_back(bank, film, readings, cells, middle);
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
