// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/film_bank.h"
#include "base/case.h"
#include "base/messages.h"
#include "diagnose/bank_points.h"
#include "diagnose/experiment_data.h"
#include "diagnose/inference/emulators.h"
#include "predict/together.h"

#include <math.h> // pchip.hpp of Boost 1.74 needs the global isnan

#include <algorithm>
#include <boost/math/interpolators/pchip.hpp>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {

using inference::Training;
using inference::Vector;
namespace {

constexpr std::size_t kFewestPressures = 4; // of the monotone cubic
// The effect that closes nanopores, and how many it leaves.
constexpr const char *kCollapse = "cbd_collapse",
                     *kFloor = "effects.cbd_collapse.floor_nanoporosity";
constexpr const char *kStrengthKey = "case.bond.tensile_strength_MPa";
constexpr std::size_t kMostEffects = 6; // 64 sets
constexpr double kBeyond = 0.05; // standard deviation per unit of ln p beyond the bank's pressures

bool is_recipe(const BankParameter &p) { return p.keys.front().rfind("recipe.", 0) == 0; }

inference::Parameter parameter_of(const BankParameter &p) {
  const auto kind =
      p.spread == Spread::LogUniform ? inference::Prior::log_uniform : inference::Prior::uniform;
  return {p.name, {kind, p.low, p.high}};
}

/// -1 to 1 over the prior's range, and beyond.
double scaled(const BankParameter &p, double value) { return parameter_of(p).prior.scaled(value); }

} // namespace

bool may_be_missing(FilmNumber number) {
  return number == FilmNumber::Broken || number == FilmNumber::InverseTortuosity ||
         number == FilmNumber::CbdNanoporosity;
}

double value_of(FilmNumber number, const SimulatedRun &run) {
  switch (number) {
  case FilmNumber::PorosityAfter:
    return run.porosity_after;
  case FilmNumber::Springback:
    return (1.0 - run.porosity_at_max) / (1.0 - run.porosity_after) - 1.0;
  case FilmNumber::Cracked:
    return run.cracked_fraction;
  case FilmNumber::LogModulus: {
    const auto released_to = [&](double share) {
      return displacement_at(run.release_pressure, run.release_displacement, share * run.target);
    };
    const double strain = (released_to(0.95) - released_to(0.5)) / run.thickness_at_max;
    return std::log(1e-3 * 0.45 * run.target / strain);
  }
  case FilmNumber::Broken:
    return run.broken_fraction;
  case FilmNumber::InverseTortuosity:
    return run.inverse_tortuosity;
  case FilmNumber::CbdNanoporosity:
    return run.cbd_nanoporosity;
  }
  return NAN;
}

FilmBank::FilmBank(const BankTable &table)
    : spec_(table.spec), recipe_(read_recipe(spec_.recipe_file)) {
  if (spec_.pressures.size() < kFewestPressures)
    throw Failure(kBadInput, fmt::format("{}: the bank has {} pressures; to predict between them "
                                         "{} are needed (pressures_MPa).",
                                         spec_.file, spec_.pressures.size(), kFewestPressures));
  for (const BankParameter &p : spec_.parameters) {
    of_film_.push_back(is_recipe(p));
    if (p.keys.front() == kStrengthKey)
      strength_ = int(material_.size());
    if (is_recipe(p))
      film_.push_back(p);
    else
      material_.push_back(parameter_of(p));
  }
  if (!spec_.crushing_file.empty())
    crushing_.emplace(spec_.crushing_file);
  if (const double within = spec_.nanoporosity_within; within > 0.0) {
    check_nanoporosity();
    floor_nanoporosity_ = read_case(spec_.case_file, recipe_).number(kFloor);
    material_.push_back({kNanoporosity, {inference::Prior::uniform, -within, within}});
  }
  learn(table);
  learn_full_cell(table);
}

namespace {

/// A point's input, and its values at the bank's pressures; NaN: it has no such run.
Vector input_of(const BankSpec &spec, const BankPoint &point) {
  Vector out(Eigen::Index(spec.parameters.size()));
  for (std::size_t k = 0; k < spec.parameters.size(); ++k)
    out[Eigen::Index(k)] = scaled(spec.parameters[k], point.base[k]);
  return out;
}

Vector values_of(FilmNumber number, const BankSpec &spec, const PointRuns &runs) {
  Vector out{Eigen::Index(spec.pressures.size())};
  for (std::size_t k = 0; k < spec.pressures.size(); ++k) {
    const BankRow *row = run_to({spec.pressures[k]}, runs);
    out[Eigen::Index(k)] = row ? value_of(number, row->run) : NAN;
  }
  return out;
}

/// Points of one effect, their inputs and their differences from the base points; in nanoporosity,
/// which stays what it is without an effect, from `nanoporosity`.
struct Learnt {
  Training training;
  std::array<inference::Matrix, kFilmNumbers> values; ///< pressures x points
};

Learnt learnt_of(const BankSpec &spec, const std::vector<PointRuns> &points,
                 const std::string &effect, double nanoporosity) {
  std::map<int, const PointRuns *> base;
  std::vector<const PointRuns *> of;
  for (const PointRuns &p : points) {
    if (p.front()->point.effect.empty())
      base[p.front()->point.base_point] = &p;
    if (p.front()->point.effect == effect)
      of.push_back(&p);
  }
  const auto n = Eigen::Index(of.size()), d = Eigen::Index(spec.parameters.size());
  const Eigen::Index extra = effect.empty() ? 0 : 1;
  Learnt out;
  out.training.inputs.resize(d + extra, n);
  out.training.amplitudes.resize(extra, n);
  for (auto &v : out.values)
    v.resize(Eigen::Index(spec.pressures.size()), n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const BankPoint &point = of[std::size_t(k)]->front()->point;
    out.training.inputs.col(k).head(d) = input_of(spec, point);
    out.training.packing.push_back(point.packing);
    if (extra > 0) {
      const Effect e = effect_of(spec, effect);
      const inference::Parameter q = inference_effect(e).parameters.front();
      const double amplitude = e.parameter.amplitude(point.value);
      out.training.inputs(d, k) = q.input(amplitude);
      out.training.amplitudes(0, k) = q.strength(amplitude);
    }
    for (int number = 0; number < kFilmNumbers; ++number) {
      auto column = out.values[std::size_t(number)].col(k);
      column = values_of(FilmNumber(number), spec, *of[std::size_t(k)]);
      if (extra > 0 && FilmNumber(number) == FilmNumber::CbdNanoporosity)
        column.array() -= nanoporosity;
      else if (extra > 0)
        column -= values_of(FilmNumber(number), spec, *base.at(point.base_point));
    }
  }
  return out;
}

/// Empty for a number that may be missing and is.
std::vector<inference::GaussianProcess>
emulators_of(const Learnt &learnt, int number, const std::vector<inference::GaussianProcess> *of) {
  std::vector<inference::GaussianProcess> out;
  const inference::Matrix &values = learnt.values[std::size_t(number)];
  for (Eigen::Index p = 0; p < values.rows(); ++p) {
    std::vector<Eigen::Index> known; // a point may lack a run, a run a number
    for (Eigen::Index k = 0; k < values.cols(); ++k)
      if (std::isfinite(values(p, k)))
        known.push_back(k);
    if (known.size() < std::size_t(inference::kFewestRuns) && may_be_missing(FilmNumber(number)))
      return {};
    if (known.size() < std::size_t(inference::kFewestRuns))
      throw Failure(kBadInput, fmt::format("the bank has {} usable points at its pressure number "
                                           "{}; at least {} are needed.",
                                           known.size(), p + 1, inference::kFewestRuns));
    Training t;
    t.inputs = learnt.training.inputs(Eigen::all, known);
    t.amplitudes = learnt.training.amplitudes(Eigen::all, known);
    t.values = Vector(values.row(p))(known);
    for (const Eigen::Index k : known)
      t.packing.push_back(learnt.training.packing[std::size_t(k)]);
    if (of)
      t.usual_noise = inference::kOfDifference * (*of)[std::size_t(p)].run_variance();
    out.emplace_back(t);
  }
  return out;
}

} // namespace

void FilmBank::learn(const BankTable &table) {
  std::vector<std::string> ignored;
  std::vector<PressedTo> wanted; // a soft film may have no pores left before the highest
  for (const double pressure : spec_.pressures)
    if (pressure < spec_.pressures.back())
      wanted.push_back({pressure});
  const std::vector<PointRuns> points = points_of(table, wanted, ignored);
  const Learnt base = learnt_of(spec_, points, "", recipe_.nanoporosity);
  if (base.training.packing.size() < std::size_t(inference::kFewestRuns))
    throw Failure(kBadInput,
                  fmt::format("{}: the table has {} whole points of the base model; at "
                              "least {} are needed.",
                              spec_.file, base.training.packing.size(), inference::kFewestRuns));
  for (int number = 0; number < kByBase; ++number)
    base_[std::size_t(number)] = calendem::emulators_of(base, number, nullptr);
  for (const std::string &name : spec_.effects) {
    const Learnt with = learnt_of(spec_, points, name, recipe_.nanoporosity);
    if (find_effect(name).instrument ||
        with.training.packing.size() < std::size_t(inference::kFewestRuns))
      continue;
    effects_.push_back(inference_effect(effect_of(spec_, name)).parameters.front());
    effects_.back().name = name;
    if (effects_.size() > kMostEffects)
      throw Failure(kBadInput,
                    fmt::format("{}: the table has runs of more than {} effects; calibrate "
                                "compares every set of them. List the most important in effects.",
                                spec_.file, kMostEffects));
    with_.emplace_back();
    for (int number = 0; number < kByBase; ++number)
      if (knows(FilmNumber(number)))
        with_.back()[std::size_t(number)] =
            calendem::emulators_of(with, number, &base_[std::size_t(number)]);
    if (name == kCollapse)
      with_.back()[kByBase] = calendem::emulators_of(with, kByBase, nullptr);
  }
  for (int number = 0; number < kByBase; ++number)
    for (const auto &of_effect : with_)
      if (of_effect[std::size_t(number)].empty())
        forget(FilmNumber(number));
}

const FilmBank::Emulators *FilmBank::emulators_of(FilmNumber number) const {
  const Emulators *of = &base_[std::size_t(number)];
  if (number == FilmNumber::CbdNanoporosity)
    for (const auto &effect : with_)
      if (!effect[kByBase].empty())
        of = &effect[kByBase];
  return of->empty() ? nullptr : of;
}

/// A number that the base model's runs have and an effect's, or the full cell's, lack.
void FilmBank::forget(FilmNumber number) {
  base_[std::size_t(number)].clear();
  full_cell_[std::size_t(number)] = {};
}

double key_value(const FilmBank &bank, const Acting &acting) {
  const std::string &name = bank.effects()[std::size_t(acting.effect)].name;
  return find_effect(name).parameter.value(acting.amplitude);
}

bool FilmBank::covers(double pressure) const {
  return pressure >= 0.98 * spec_.pressures.front() && pressure <= 1.02 * spec_.pressures.back();
}

Vector FilmBank::input(const Film &film, const Material &material) const {
  Vector out{Eigen::Index(of_film_.size())};
  std::size_t of_recipe = 0, of_case = 0;
  for (std::size_t k = 0; k < of_film_.size(); ++k)
    out[Eigen::Index(k)] =
        scaled(spec_.parameters[k],
               of_film_[k] ? film.recipe[of_recipe++] : material.parameters[of_case++]);
  return out;
}

std::pair<double, double> FilmBank::beside(double pressure) const {
  constexpr double kStep = 0.05; // of ln p
  const double low = spec_.pressures.front(), high = spec_.pressures.back();
  return {std::min(std::max(pressure * std::exp(-kStep), low), high * std::exp(-kStep)),
          std::max(std::min(pressure * std::exp(kStep), high), low * std::exp(kStep))};
}

Guess FilmBank::change(FilmNumber number, std::size_t pressure, const Vector &input,
                       const Acting &acting, const Alike &as) const {
  const Emulators &of = with_[std::size_t(acting.effect)][std::size_t(number)];
  if (of.empty())
    return {};
  const inference::Parameter &q = effects_[std::size_t(acting.effect)];
  Vector with(input.size() + 1), strength(1);
  with << input, q.input(acting.amplitude);
  strength << q.strength(acting.amplitude);
  const inference::Mean more = of[pressure].at(with, strength);
  const double share = q.name == kCollapse ? as.collapse : 1.0;
  return {share * more.mean, share * share * more.variance};
}

Guess FilmBank::beyond_sum(FilmNumber number, std::size_t pressure, const Vector &input,
                           const Material &material, const Alike &as, double alone,
                           const std::vector<double> &changed) const {
  if (material.effects.size() < 2 ||
      (number != FilmNumber::PorosityAfter && number != FilmNumber::Springback))
    return {};
  const bool springs = number == FilmNumber::Springback;
  const FilmNumber other = springs ? FilmNumber::PorosityAfter : FilmNumber::Springback;
  const auto response = [&](double of_number, double of_other) {
    return springs ? Response{of_other, of_number} : Response{of_number, of_other};
  };
  const Response base =
      response(alone, base_[std::size_t(other)][pressure].at(input, Vector()).mean);
  std::vector<Response> changes;
  for (std::size_t k = 0; k < changed.size(); ++k)
    changes.push_back(
        response(changed[k], change(other, pressure, input, material.effects[k], as).mean));
  const Response of = calendem::beyond_sum(base, changes);
  const double more = springs ? of.springback : of.porosity;
  return {more, kBeyondSumError * kBeyondSumError * more * more};
}

std::vector<Guess> FilmBank::at_pressures(FilmNumber number, const Film &film,
                                          const Material &material) const {
  const auto n = std::size_t(number);
  const Alike as = alike(film, nanoporosity(film, material));
  const Vector x = input(as.film, material);
  const double share = full_cell_share(film);
  std::vector<Guess> out;
  for (std::size_t p = 0; p < spec_.pressures.size(); ++p) {
    Guess g = {nanoporosity(film, material), 0.0}; // where nothing changes it
    if (number != FilmNumber::CbdNanoporosity) {
      const inference::Mean base = base_[n][p].at(x, Vector());
      g = {base.mean, base.variance};
    }
    const double alone = g.mean;
    std::vector<double> changed;
    const auto add = [&](const Guess &more) {
      g.mean += more.mean;
      g.variance += more.variance;
      return more.mean;
    };
    for (const Acting &a : material.effects)
      changed.push_back(add(change(number, p, x, a, as)));
    add(beyond_sum(number, p, x, material, as, alone, changed));
    if (share != 0.0 && !full_cell_[n].change.empty())
      g.mean += share * full_cell_[n].change[p];
    if (number == FilmNumber::PorosityAfter)
      g = {1.0 - as.solids * (1.0 - g.mean), as.solids * as.solids * g.variance};
    out.push_back(g);
  }
  return out;
}

Guess FilmBank::at(const std::vector<Guess> &curve, double pressure) const {
  std::vector<double> x, mean, variance;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    x.push_back(std::log(spec_.pressures[k]));
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

std::vector<inference::Quality> FilmBank::quality(FilmNumber number) const {
  std::vector<inference::Quality> out;
  if (const Emulators *of = emulators_of(number))
    for (const inference::GaussianProcess &g : *of)
      out.push_back(g.left_out());
  return out;
}

} // namespace calendem
