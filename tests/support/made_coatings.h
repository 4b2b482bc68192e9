// SPDX-License-Identifier: GPL-2.0-or-later
// The bank of coatings with runs from formulas. Nothing in it is physics: porosity falls as a power of
// pressure, the slower the stiffer the binder, and yielding particles let it fall further.
#ifndef CALENDEM_TESTS_MADE_COATINGS_H
#define CALENDEM_TESTS_MADE_COATINGS_H

#include "base/provenance.h"
#include "base/random.h"
#include "predict/calibration.h"
#include <cmath>
#include <nlohmann/json.hpp>

namespace calendem_test {

using namespace calendem;

/// Parameters in the bank's order: E_am, E_cbd, strength, porosity before, carbon and binder each.
/// `yield`: yield pressure [GPa], 0: off.
inline double made_porosity(const std::vector<double> &p, double yield, double pressure) {
  const double soft = yield > 0.0 ? 0.4 / yield : 0.0;
  const double scale = 4000.0 * (p[1] / 2.5) * std::sqrt(p[2] / 500.0) * (2.0 / p[4]);
  return 0.01 * p[3] * std::exp(-std::pow(pressure / scale, 0.4) * (1.0 + soft));
}
inline double made_springback(const std::vector<double> &p, double pressure) {
  return 0.04 * std::sqrt(pressure / 150.0) * 200.0 / p[0];
}
inline double made_cracked(const std::vector<double> &p, double pressure) {
  return 1.0 - std::exp(-pressure / p[2]);
}

/// 1 / tortuosity factor.
inline double made_inverse(double porosity) { return 1.2 * porosity; }

/// What collapse from `yield` [MPa] on takes from the porosity at first.
inline double made_collapse(double yield, double pressure) {
  return 0.03 * std::log(300.0 / yield) * std::exp(-pressure / 60.0);
}

/// What collapse from `yield` [MPa] on leaves of a nanoporosity of one half.
inline double made_nanoporosity(double yield, double pressure) {
  return pressure > yield ? 0.27 + 0.23 * std::exp(-(pressure - yield) / 100.0) : 0.5;
}

/// GPa.
inline double made_modulus(const std::vector<double> &p) { return 0.01 * p[0]; }

/// Places of the effects among the bank's.
constexpr int kYields = 0, kCollapses = 1;
constexpr double kMadeSolid = 12.0; ///< thickness without pores [um]
/// What a film of the larger cell's loading is denser by.
constexpr double kLargerIsDenser = 0.03;

inline bank::PressedFilm made_press(const bank::Point &point, double pressure) {
  Random packing(std::uint64_t(point.packing), 11);
  const std::vector<double> p(point.values.begin(), point.values.begin() + 5);
  const double yield = point.values[5], collapse = point.values[6];
  bank::PressedFilm r;
  r.pressure = pressure;
  r.porosity_after = made_porosity(p, std::isnan(yield) ? 0.0 : yield, pressure) -
                     (std::isnan(collapse) ? 0.0 : made_collapse(collapse, pressure)) -
                     (point.larger ? kLargerIsDenser : 0.0) + 0.002 * packing.normal();
  r.porosity_at_max = 1.0 - (1.0 - r.porosity_after) * (1.0 + made_springback(p, pressure));
  r.cracked = made_cracked(p, pressure);
  r.broken = 0.3 * r.cracked;
  r.inverse_tortuosity = made_inverse(r.porosity_after);
  r.cbd_nanoporosity = std::isnan(collapse) ? 0.5 : made_nanoporosity(collapse, pressure);
  r.thickness_at_max = kMadeSolid / (1.0 - r.porosity_at_max);
  for (const double share : bank::kReleasedTo) // linear: a modulus of made_modulus
    r.release.push_back(kMadeSolid / (1.0 - 0.01 * p[3]) - r.thickness_at_max -
                        (1.0 - share) * pressure * 1e-3 / made_modulus(p) * r.thickness_at_max);
  return r;
}

inline bank::Runs made_coatings() {
  bank::Runs runs;
  runs.bank = bank::read_bank(CALENDEM_SOURCE_DIR "/tests/support/made_coatings.toml");
  runs.bank.nanoporosity_within = 0.0;
  for (const bank::Point &point : bank::points_of(runs.bank.design)) {
    bank::Run run;
    run.point = point;
    run.porosity_before = 0.01 * point.values[3];
    for (const double pressure : bank::pressures_of(runs.bank))
      run.presses.push_back(made_press(point, pressure));
    run.thickness_before = kMadeSolid / (1.0 - run.porosity_before);
    for (const double pressure : bank::curve_pressures())
      run.loading.push_back(run.thickness_before - made_press(point, pressure).thickness_at_max);
    runs.runs.push_back(run);
  }
  return runs;
}

/// An emulator with the hyperparameters that made_coatings.fit.json keeps, so that no test fits them.
inline FilmBank film_bank_of(const bank::Runs &runs) {
  static const auto kept = nlohmann::json::parse(
      text_of_file(CALENDEM_SOURCE_DIR "/tests/support/made_coatings.fit.json"));
  return FilmBank(
      runs, inference::Emulator(bank::training_of(runs), kept.get<inference::Hyperparameters>()));
}

inline const FilmBank &made_film_bank() {
  static const FilmBank bank(film_bank_of(made_coatings()));
  return bank;
}

/// A film of the bank's loading.
inline Film made_film(const std::string &name, double porosity, double carbon) {
  return {name, {porosity, carbon}, 6.0, 0.0};
}

struct Truth {
  std::vector<double> material = {190.0, 2.4, 480.0};
  double yield = 0.0;
};

inline std::vector<double> all_parameters(const Truth &t, const Film &f) {
  return {t.material[0], t.material[1], t.material[2], f.recipe[0], f.recipe[1]};
}

/// Adds a film pressed to these pressures, measured within `sd`.
inline void measure(const Truth &truth, const Film &film, const std::vector<double> &pressures,
                    double sd, Random &random, Calibration &to) {
  to.films.push_back(film);
  for (const double p : pressures)
    to.data.push_back(
        {int(to.films.size()) - 1, "p", FilmNumber::PorosityAfter, p, 0.01,
         made_porosity(all_parameters(truth, film), truth.yield, p) + sd * random.normal(), sd});
}

} // namespace calendem_test

#endif
