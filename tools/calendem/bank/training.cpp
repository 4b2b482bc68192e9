// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank/training.h"
#include "base/case.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "base/registry.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

namespace calendem::bank {
namespace {

constexpr double kSamePressure = 0.05; // of a press that met its target
constexpr std::size_t kEvery = 4;      // of curve_pressures()
constexpr int kSharing = 4;            // readings of the loading curve
constexpr std::size_t kFewestPresses = 3, kFewestRuns = 8;

inference::Prior prior_of(Spread spread, double low, double high) {
  return {spread == Spread::LogUniform ? inference::Prior::log_uniform : inference::Prior::uniform,
          low, high};
}

/// Places of release in kReleasedTo.
constexpr std::size_t kHalf = 5, kNinety = 9;

double log_modulus(const PressedFilm &film) {
  const double strain = (film.release[kNinety] - film.release[kHalf]) / film.thickness_at_max;
  const double share = kReleasedTo[kNinety] - kReleasedTo[kHalf];
  return strain > 0.0 ? std::log(1e-3 * share * film.pressure / strain) : NAN;
}

} // namespace

const std::vector<double> &loading_pressures() {
  static const std::vector<double> pressures = [] {
    std::vector<double> out;
    for (std::size_t k = 0; k < curve_pressures().size(); k += kEvery)
      out.push_back(curve_pressures()[k]);
    return out;
  }();
  return pressures;
}

double value_of(FilmNumber number, const PressedFilm &film) {
  switch (number) {
  case FilmNumber::PorosityAfter:
    return film.porosity_after;
  case FilmNumber::Springback:
    return (1.0 - film.porosity_at_max) / (1.0 - film.porosity_after) - 1.0;
  case FilmNumber::Cracked:
    return film.cracked;
  case FilmNumber::LogModulus:
    return log_modulus(film);
  case FilmNumber::Broken:
    return film.broken;
  case FilmNumber::InverseTortuosity:
    return film.inverse_tortuosity;
  case FilmNumber::CbdNanoporosity:
    return film.cbd_nanoporosity;
  }
  return NAN;
}

inference::Parameter parameter_of(const Input &input) {
  if (!input.is_effect())
    return {input.name, prior_of(input.spread, input.low, input.high)};
  const EffectParameter &p = find_effect(input.name).parameter;
  double low = p.amplitude(input.low), high = p.amplitude(input.high);
  if (low > high)
    std::swap(low, high);
  const Spread spread = p.scale == AmplitudeScale::Logarithm ? Spread::Uniform : input.spread;
  const double weakest = std::min(p.amplitude(p.low), p.amplitude(p.high));
  return {input.name, prior_of(spread, low, high), true, p.power, std::min(weakest, low)};
}

Space::Space(const Bank &bank) {
  for (std::size_t d = 0; d < bank.design.inputs.size(); ++d) {
    const Input &input = bank.design.inputs[d];
    (input.is_effect() ? effects : quantities).push_back(int(d));
    (input.is_effect() ? amplitudes : priors).push_back(parameter_of(input));
  }
}

std::vector<double> pressures_of(const Bank &bank) {
  const Settings s = read_case(bank.case_file, read_recipe(bank.recipe_file));
  const double first = s.number("platen.first_pressure_MPa"),
               last = s.number("platen.max_pressure_MPa"), presses = s.number("platen.presses");
  if (presses < double(kFewestPresses) || first <= 0.0)
    throw Failure(kBadInput,
                  "{}: the platen goes to {:g} pressures; a bank's runs stop at {} or more. Set "
                  "platen.presses and platen.first_pressure_MPa.",
                  bank.case_file, first > 0.0 ? presses : 1.0, kFewestPresses);
  const bool by_ratio = s.text("platen.spacing") == "ratio";
  std::vector<double> out;
  for (double k = 0.0; k < presses; ++k) {
    const double share = k / (presses - 1.0);
    out.push_back(by_ratio ? first * std::pow(last / first, share)
                           : first + share * (last - first));
  }
  return out;
}

namespace {

/// Each number has its own hyperparameters at each pressure, and so have the readings of a release; four
/// neighbours of the loading curve share theirs.
int group_of(int output, std::size_t presses) {
  const int loading = loading_output(0, presses), release = release_output(0, 0, presses);
  if (output < loading)
    return output;
  return output < release ? loading + (output - loading) / kSharing
                          : loading + (release - loading) / kSharing +
                                (output - release) / int(kReleases.size());
}

/// Loading and releases of a run, as outputs of column r.
void add_curves(const Run &run, const std::vector<double> &pressures, Eigen::Index r,
                inference::Matrix &values) {
  for (std::size_t k = 0; k < loading_pressures().size(); ++k)
    values(loading_output(k, pressures.size()), r) = run.loading[kEvery * k] / run.thickness_before;
  for (std::size_t p = 0; p < run.presses.size() && p < pressures.size(); ++p) {
    const PressedFilm &film = run.presses[p];
    if (std::fabs(film.pressure / pressures[p] - 1.0) > kSamePressure)
      continue;
    const double largest = run.thickness_before - film.thickness_at_max;
    for (std::size_t j = 0; j < kReleases.size(); ++j)
      values(release_output(p, j, pressures.size()), r) =
          (largest - film.release[kReleases[j]]) / film.thickness_at_max;
  }
}

} // namespace

inference::TrainingRuns training_of(const Runs &runs) {
  const Space space(runs.bank);
  const std::vector<double> pressures = pressures_of(runs.bank);
  std::vector<const Run *> used;
  for (const Run &run : runs.runs)
    if (!run.presses.empty())
      used.push_back(&run);
  if (used.size() < kFewestRuns)
    throw Failure(kBadInput, "{}: the table has {} runs; at least {} are needed.", runs.bank.file,
                  used.size(), kFewestRuns);
  const auto n = Eigen::Index(used.size()),
             outputs = Eigen::Index(count_of_outputs(pressures.size()));
  inference::TrainingRuns out;
  out.at.inputs.resize(Eigen::Index(space.priors.size()), n);
  out.at.amplitudes = inference::Matrix::Zero(Eigen::Index(space.amplitudes.size()) + 1, n);
  out.values = inference::Matrix::Constant(outputs, n, NAN);
  for (int o = 0; o < int(outputs); ++o)
    out.group.push_back(group_of(o, pressures.size()));
  for (Eigen::Index r = 0; r < n; ++r) {
    const Run &run = *used[std::size_t(r)];
    const Point &point = run.point;
    for (std::size_t k = 0; k < space.priors.size(); ++k)
      out.at.inputs(Eigen::Index(k), r) =
          space.priors[k].prior.scaled(point.values[std::size_t(space.quantities[k])]);
    for (std::size_t k = 0; k < space.amplitudes.size(); ++k)
      if (const double v = point.values[std::size_t(space.effects[k])]; !std::isnan(v))
        out.at.amplitudes(Eigen::Index(k), r) = space.amplitudes[k].strength(
            find_effect(space.amplitudes[k].name).parameter.amplitude(v));
    out.at.amplitudes(out.at.amplitudes.rows() - 1, r) = point.larger ? 1.0 : 0.0;
    out.packing.push_back(2 * point.packing + point.larger);
    for (std::size_t p = 0; p < run.presses.size() && p < pressures.size(); ++p)
      if (std::fabs(run.presses[p].pressure / pressures[p] - 1.0) <= kSamePressure)
        for (int number = 0; number < kFilmNumbers; ++number)
          out.values(output_of(FilmNumber(number), p, pressures.size()), r) =
              value_of(FilmNumber(number), run.presses[p]);
    add_curves(run, pressures, r, out.values);
  }
  return out;
}

namespace {

/// Hyperparameters of these runs, if `file` has them for this table and this version's covariance.
std::optional<inference::Hyperparameters>
stored_fit(const std::string &file, const std::string &hash, const inference::TrainingRuns &runs) {
  if (!std::filesystem::exists(file))
    return {};
  const auto json = nlohmann::json::parse(text_of_file(file), nullptr, false);
  if (!json.is_object() || json.value("table", "") != hash)
    return {};
  const auto fit = json.at("groups").get<inference::Hyperparameters>();
  const auto length = std::size_t(
      inference::Kernel::prior_means(int(runs.at.inputs.rows()), int(runs.at.amplitudes.rows()))
          .size());
  const bool whole =
      int(fit.size()) == 1 + runs.group.back() &&
      std::all_of(fit.begin(), fit.end(), [&](const auto &of) { return of.size() == length; });
  return whole ? std::optional(fit) : std::nullopt;
}

} // namespace

inference::Emulator emulator_of(const Runs &runs, const std::string &table) {
  const std::string file = std::filesystem::path(table).replace_extension("fit.json").string(),
                    hash = hash_of_file(table);
  inference::TrainingRuns training = training_of(runs);
  if (const auto fit = stored_fit(file, hash, training))
    return inference::Emulator(std::move(training), fit);
  fmt::print("{}: the emulator is fitted once; the fit is kept beside the table\n", table);
  const inference::Emulator emulator(std::move(training));
  try {
    write_file(file,
               nlohmann::json({{"table", hash}, {"groups", emulator.hyperparameters()}}).dump() +
                   "\n");
  } catch (const Failure &) { // of a folder that may not be written: it is fitted again
  }
  return emulator;
}

} // namespace calendem::bank
