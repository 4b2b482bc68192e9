// SPDX-License-Identifier: GPL-2.0-or-later
#include "films/film_bank.h"
#include "base/case.h"
#include "base/messages.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr std::size_t kFewestPressures = 4; // of the monotone cubic
// The effect that closes nanopores, and how many it leaves.
constexpr const char *kCollapse = "cbd_collapse",
                     *kFloor = "effects.cbd_collapse.floor_nanoporosity";
constexpr const char *kStrengthKey = "case.bond.tensile_strength_MPa",
                     *kLoading = "coating.loading_mg_cm2";
constexpr double kBeyond = 0.05; // standard deviation per unit of ln p beyond the bank's pressures

bank::Runs runs_of(const std::string &file) {
  const bank::Bank spec = bank::read_bank(file);
  return bank::read_runs(spec, bank::table_of(spec));
}

FilmBank with_emulator(const bank::Runs &runs) {
  return FilmBank(runs, bank::emulator_of(runs, bank::table_of(runs.bank)));
}

} // namespace

FilmBank::FilmBank(const std::string &file) : FilmBank(with_emulator(runs_of(file))) {}

FilmBank::FilmBank(const bank::Runs &runs, inference::Emulator emulator)
    : spec_(runs.bank), space_(runs.bank), recipe_(read_recipe(spec_.recipe_file)),
      pressures_(bank::pressures_of(spec_)), emulator_(std::move(emulator)),
      effects_(space_.amplitudes) {
  if (pressures_.size() < kFewestPressures)
    throw Failure(kBadInput,
                  fmt::format("{}: the runs stop at {} pressures; to predict between them "
                              "{} are needed (platen.presses).",
                              spec_.case_file, pressures_.size(), kFewestPressures));
  for (const int place : space_.quantities) {
    const bank::Input &input = spec_.design.inputs[std::size_t(place)];
    if (input.keys.front() == kStrengthKey)
      strength_ = int(material_.size());
    if (input.is_film())
      film_.push_back(input);
    else
      material_.push_back(bank::parameter_of(input));
  }
  if (!spec_.crushing_file.empty())
    crushing_.emplace(spec_.crushing_file);
  if (const double within = spec_.nanoporosity_within; within > 0.0) {
    check_nanoporosity();
    floor_nanoporosity_ = read_case(spec_.case_file, recipe_).number(kFloor);
    material_.push_back({kNanoporosity, {inference::Prior::uniform, -within, within}});
  }
  note_effects();
  const auto larger = spec_.design.larger.recipe.find(kLoading);
  if (larger != spec_.design.larger.recipe.end())
    larger_loading_ = std::stod(larger->second);
  const inference::Matrix &values = emulator_.runs().values;
  for (int number = 0; number < kFilmNumbers; ++number) {
    known_[std::size_t(number)] = true;
    for (std::size_t p = 0; p < pressures_.size(); ++p)
      known_[std::size_t(number)] =
          known_[std::size_t(number)] &&
          values.row(bank::output_of(FilmNumber(number), p, pressures_.size()))
              .array()
              .isFinite()
              .any();
  }
}

void FilmBank::note_effects() {
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    if (effects_[e].name == kCollapse)
      collapse_ = int(e);
    excluded_.emplace_back();
    for (const std::string &name : spec_.design.inputs[std::size_t(space_.effects[e])].excludes)
      for (std::size_t other = 0; other < effects_.size(); ++other)
        if (effects_[other].name == name)
          excluded_.back().push_back(int(other));
  }
}

double porosity_before(const FilmBank &bank, const Film &film) {
  for (std::size_t k = 0; k < bank.film().size(); ++k)
    if (bank.film()[k].keys.front() == kPorosityKey)
      return 0.01 * film.recipe[k];
  return bank.recipe().porosity_total;
}

double key_value(const FilmBank &bank, const ActiveEffect &acting) {
  const std::string &name = bank.effects()[std::size_t(acting.effect)].name;
  return find_effect(name).parameter.value(acting.amplitude);
}

bool FilmBank::covers(double pressure) const {
  return pressure >= 0.98 * pressures_.front() && pressure <= 1.02 * pressures_.back();
}

std::pair<double, double> FilmBank::beside(double pressure) const {
  constexpr double kStep = 0.05; // of ln p
  const double low = pressures_.front(), high = pressures_.back();
  return {std::min(std::max(pressure * std::exp(-kStep), low), high * std::exp(-kStep)),
          std::max(std::min(pressure * std::exp(kStep), high), low * std::exp(kStep))};
}

/// A film's faces weigh by 1 / loading: no change on the bank's film, all of it on the larger cell's.
double FilmBank::larger_share(const Film &film) const {
  return larger_loading_ > 0.0
             ? (1.0 - recipe_.loading / film.loading) / (1.0 - recipe_.loading / larger_loading_)
             : 0.0;
}

inference::Points FilmBank::no_points(Eigen::Index count) const {
  return {inference::Matrix(Eigen::Index(space_.priors.size()), count),
          inference::Matrix::Zero(Eigen::Index(space_.amplitudes.size()) + 1, count)};
}

void FilmBank::place(const Material &material, const Alike &as, Eigen::Index column,
                     inference::Points &at) const {
  std::size_t of_recipe = 0, of_case = 0;
  for (std::size_t k = 0; k < space_.quantities.size(); ++k) {
    const bool of_film = spec_.design.inputs[std::size_t(space_.quantities[k])].is_film();
    at.inputs(Eigen::Index(k), column) = space_.priors[k].prior.scaled(
        of_film ? as.film.recipe[of_recipe++] : material.parameters[of_case++]);
  }
  for (const ActiveEffect &a : material.effects) {
    const inference::Parameter &effect = effects_[std::size_t(a.effect)];
    at.amplitudes(a.effect, column) = effect.strength(a.amplitude);
  }
  at.amplitudes(at.amplitudes.rows() - 1, column) = larger_share(as.film);
}

/// Collapse takes as much as there are nanopores for.
void FilmBank::scale_collapse(const inference::Points &at, const std::vector<Alike> &as,
                              const std::vector<int> &outputs, inference::Matrix &mean) const {
  std::vector<Eigen::Index> collapsing;
  for (Eigen::Index m = 0; m < mean.cols() && collapse_ >= 0; ++m)
    if (as[std::size_t(m)].collapse != 1.0 && at.amplitudes(collapse_, m) != 0.0)
      collapsing.push_back(m);
  if (collapsing.empty())
    return;
  inference::Points open = {at.inputs(Eigen::all, collapsing),
                            at.amplitudes(Eigen::all, collapsing)};
  open.amplitudes.row(collapse_).setZero();
  const inference::Matrix without = emulator_.predict(open, outputs, false).mean;
  for (std::size_t k = 0; k < collapsing.size(); ++k) {
    const Eigen::Index m = collapsing[k], from = Eigen::Index(k);
    mean.col(m) =
        without.col(from) + as[std::size_t(m)].collapse * (mean.col(m) - without.col(from));
  }
}

inference::Expectation FilmBank::emulated(const Film &film,
                                          const std::vector<const Material *> &materials,
                                          const std::vector<int> &outputs) const {
  const auto n = Eigen::Index(materials.size());
  inference::Points at = no_points(n);
  std::vector<Alike> as;
  for (Eigen::Index m = 0; m < n; ++m) {
    const Material &material = *materials[std::size_t(m)];
    as.push_back(alike(film, nanoporosity(film, material)));
    place(material, as.back(), m, at);
  }
  inference::Expectation of = emulator_.predict(at, outputs);
  scale_collapse(at, as, outputs, of.mean);
  const auto first = [&](FilmNumber number) {
    return bank::output_of(number, 0, pressures_.size());
  };
  const int after = first(FilmNumber::PorosityAfter), pores = first(FilmNumber::CbdNanoporosity),
            count = int(pressures_.size());
  for (Eigen::Index m = 0; m < n; ++m)
    for (Eigen::Index k = 0; k < of.mean.rows(); ++k) {
      const int output = outputs[std::size_t(k)];
      const double solids = as[std::size_t(m)].solids;
      if (output >= after && output < after + count) {
        of.mean(k, m) = 1.0 - solids * (1.0 - of.mean(k, m));
        of.variance(k, m) *= solids * solids;
      } else if (output >= pores && output < pores + count) {
        of.mean(k, m) += nanoporosity(film, *materials[std::size_t(m)]) - recipe_.nanoporosity;
      }
    }
  return of;
}

std::vector<std::vector<MeanVariance>>
FilmBank::at_pressures(FilmNumber number, const Film &film,
                       const std::vector<const Material *> &materials) const {
  std::vector<int> outputs;
  for (std::size_t p = 0; p < pressures_.size(); ++p)
    outputs.push_back(bank::output_of(number, p, pressures_.size()));
  const inference::Expectation of = emulated(film, materials, outputs);
  std::vector<std::vector<MeanVariance>> out(materials.size());
  for (std::size_t m = 0; m < out.size(); ++m)
    for (Eigen::Index p = 0; p < of.mean.rows(); ++p)
      out[m].push_back({of.mean(p, Eigen::Index(m)), of.variance(p, Eigen::Index(m))});
  return out;
}

std::vector<MeanVariance> FilmBank::at_pressures(FilmNumber number, const Film &film,
                                                 const Material &material) const {
  return at_pressures(number, film, std::vector<const Material *>{&material}).front();
}

inference::Vector cubic_weights(const std::vector<double> &x, double at) {
  inference::Vector out = inference::Vector::Zero(Eigen::Index(x.size()));
  const double place = std::clamp(at, x.front(), x.back());
  std::size_t right = 1;
  while (right + 1 < x.size() && x[right] < place)
    ++right;
  const std::size_t first = right < 2 ? 0 : right - 2, last = std::min(right + 1, x.size() - 1);
  for (std::size_t k = first; k <= last; ++k) { // Lagrange's polynomials
    double weight = 1.0;
    for (std::size_t j = first; j <= last; ++j)
      if (j != k)
        weight *= (place - x[j]) / (x[k] - x[j]);
    out[Eigen::Index(k)] = weight;
  }
  return out;
}

inference::Vector FilmBank::weights_at(double pressure) const {
  std::vector<double> x;
  for (const double p : pressures_)
    x.push_back(std::log(p));
  return cubic_weights(x, std::log(pressure));
}

MeanVariance FilmBank::at(const std::vector<MeanVariance> &curve, double pressure) const {
  const double at = std::clamp(pressure, pressures_.front(), pressures_.back());
  const double beyond = kBeyond * std::log(pressure / at);
  const inference::Vector weights = weights_at(at);
  MeanVariance out{0.0, beyond * beyond};
  std::size_t right = 1;
  while (right + 1 < pressures_.size() && pressures_[right] < at)
    ++right;
  const double share =
      std::log(at / pressures_[right - 1]) / std::log(pressures_[right] / pressures_[right - 1]);
  out.variance +=
      curve[right - 1].variance + share * (curve[right].variance - curve[right - 1].variance);
  for (std::size_t k = 0; k < curve.size(); ++k)
    out.mean += weights[Eigen::Index(k)] * curve[k].mean;
  return out;
}

double alike_at(double pressure, double other) {
  return std::exp(-0.5 * std::pow(std::log(pressure / other), 2));
}

namespace {

/// Correlation before any run was left out: outputs of one kind are alike at like pressures.
inference::Matrix expected_correlation(const std::vector<double> &pressures) {
  const std::size_t presses = pressures.size();
  const int n = bank::count_of_outputs(presses);
  std::vector<int> kind;
  std::vector<double> pressure;
  for (int o = 0; o < n; ++o) {
    if (o < bank::loading_output(0, presses)) {
      kind.push_back(o / int(presses));
      pressure.push_back(pressures[std::size_t(o) % presses]);
    } else if (o < bank::release_output(0, 0, presses)) {
      kind.push_back(kFilmNumbers);
      pressure.push_back(
          bank::loading_pressures()[std::size_t(o - bank::loading_output(0, presses))]);
    } else {
      const auto of_release = std::size_t(o - bank::release_output(0, 0, presses));
      kind.push_back(kFilmNumbers + 1);
      pressure.push_back(pressures[of_release / bank::kReleases.size()]);
    }
  }
  inference::Matrix out = inference::Matrix::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      if (i != j && kind[std::size_t(i)] == kind[std::size_t(j)])
        out(i, j) = alike_at(pressure[std::size_t(i)], pressure[std::size_t(j)]);
  return out;
}

} // namespace

const inference::Matrix &FilmBank::error_correlation() const {
  if (!error_correlation_)
    error_correlation_ = inference::error_correlation(emulator_.left_out(), emulator_.runs().values,
                                                      expected_correlation(pressures_));
  return *error_correlation_;
}

inference::Matrix FilmBank::films_alike(const std::vector<Film> &films,
                                        const std::vector<const Material *> &materials) const {
  inference::Points at = no_points(Eigen::Index(films.size()));
  for (std::size_t f = 0; f < films.size(); ++f)
    place(*materials[f], alike(films[f], nanoporosity(films[f], *materials[f])), Eigen::Index(f),
          at);
  return emulator_.correlation(
      at, bank::output_of(FilmNumber::PorosityAfter, pressures_.size() / 2, pressures_.size()));
}

double FilmBank::error_correlation(FilmNumber a, double at_a, FilmNumber b, double at_b) const {
  const auto size = Eigen::Index(pressures_.size());
  const auto between = [&](FilmNumber i, double at_i, FilmNumber j, double at_j) {
    const inference::Matrix of =
        error_correlation().block(bank::output_of(i, 0, pressures_.size()),
                                  bank::output_of(j, 0, pressures_.size()), size, size);
    return weights_at(at_i).dot(inference::Vector(of * weights_at(at_j)));
  };
  return between(a, at_a, b, at_b) /
         std::sqrt(between(a, at_a, a, at_a) * between(b, at_b, b, at_b));
}

std::vector<inference::Accuracy> FilmBank::accuracy(FilmNumber number) const {
  const std::vector<inference::Accuracy> all =
      inference::accuracy_of(emulator_.left_out(), emulator_.runs().values);
  const auto first = all.begin() + bank::output_of(number, 0, pressures_.size());
  return {first, first + long(pressures_.size())};
}

} // namespace calendem
