// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/film_bank.h"
#include "base/case.h"
#include "base/messages.h"

#include <math.h> // pchip.hpp of Boost 1.74 needs the global isnan

#include <algorithm>
#include <boost/math/interpolators/pchip.hpp>
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

std::vector<std::vector<MeanVariance>>
FilmBank::at_pressures(FilmNumber number, const Film &film,
                       const std::vector<const Material *> &materials) const {
  const auto n = Eigen::Index(materials.size());
  inference::Points at = {inference::Matrix(Eigen::Index(space_.priors.size()), n),
                          inference::Matrix::Zero(Eigen::Index(space_.amplitudes.size()) + 1, n)};
  std::vector<Alike> as;
  for (Eigen::Index m = 0; m < n; ++m) {
    const Material &material = *materials[std::size_t(m)];
    as.push_back(alike(film, nanoporosity(film, material)));
    place(material, as.back(), m, at);
  }
  std::vector<int> outputs;
  for (std::size_t p = 0; p < pressures_.size(); ++p)
    outputs.push_back(bank::output_of(number, p, pressures_.size()));
  const inference::Expectation of = emulator_.predict(at, outputs);
  inference::Matrix open = of.mean; // where nanopores stay open
  for (std::size_t e = 0; e < effects_.size(); ++e)
    if (effects_[e].name == kCollapse && spec_.nanoporosity_within > 0.0) {
      at.amplitudes.row(Eigen::Index(e)).setZero();
      open = emulator_.predict(at, outputs, false).mean;
    }
  std::vector<std::vector<MeanVariance>> out(materials.size());
  for (Eigen::Index m = 0; m < n; ++m) {
    const Alike &film_as = as[std::size_t(m)];
    for (Eigen::Index p = 0; p < of.mean.rows(); ++p) {
      MeanVariance g = {open(p, m) + film_as.collapse * (of.mean(p, m) - open(p, m)),
                        of.variance(p, m)};
      if (number == FilmNumber::PorosityAfter)
        g = {1.0 - film_as.solids * (1.0 - g.mean), film_as.solids * film_as.solids * g.variance};
      if (number == FilmNumber::CbdNanoporosity)
        g.mean += nanoporosity(film, *materials[std::size_t(m)]) - recipe_.nanoporosity;
      out[std::size_t(m)].push_back(g);
    }
  }
  return out;
}

std::vector<MeanVariance> FilmBank::at_pressures(FilmNumber number, const Film &film,
                                                 const Material &material) const {
  return at_pressures(number, film, std::vector<const Material *>{&material}).front();
}

MeanVariance FilmBank::at(const std::vector<MeanVariance> &curve, double pressure) const {
  std::vector<double> x, mean, variance;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    x.push_back(std::log(pressures_[k]));
    mean.push_back(curve[k].mean);
    variance.push_back(curve[k].variance);
  }
  const double at = std::clamp(std::log(pressure), x.front(), x.back());
  const double beyond = kBeyond * (std::log(pressure) - at);
  std::size_t right = 1;
  while (right + 1 < x.size() && x[right] < at)
    ++right;
  const double share = (at - x[right - 1]) / (x[right] - x[right - 1]);
  const double between = variance[right - 1] + share * (variance[right] - variance[right - 1]);
  using boost::math::interpolators::pchip;
  return {pchip<std::vector<double>>(std::move(x), std::move(mean))(at), between + beyond * beyond};
}

std::vector<inference::Accuracy> FilmBank::accuracy(FilmNumber number) const {
  const std::vector<inference::Accuracy> all =
      inference::accuracy_of(emulator_.left_out(), emulator_.runs().values);
  const auto first = all.begin() + bank::output_of(number, 0, pressures_.size());
  return {first, first + long(pressures_.size())};
}

} // namespace calendem
