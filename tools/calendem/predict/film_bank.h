// SPDX-License-Identifier: GPL-2.0-or-later
// What a bank's runs say of any film of its material: emulators of what a film is like after it was
// pressed, at each of the bank's pressures and between them.
#ifndef CALENDEM_PREDICT_FILM_BANK_H
#define CALENDEM_PREDICT_FILM_BANK_H

#include "bank/training.h"
#include "diagnose/bank/bank_table.h"
#include "diagnose/inference/gaussian_process.h"
#include "inference/quantities.h"
#include "predict/crushing_loads.h"
#include <array>
#include <optional>

namespace calendem {

/// Numbers that the base model has emulators of; the next one, nanoporosity, only collapse has.
constexpr int kByBase = int(FilmNumber::CbdNanoporosity);
/// Tables of earlier versions lack it.
bool may_be_missing(FilmNumber number);

/// Key of the porosity before calendering, where a bank's films differ in it.
inline constexpr const char *kPorosityKey = "recipe.coating.porosity_total_percent";

/// A parameter of materials: nanoporosity of their CBD less the recipe's [%].
inline constexpr const char *kNanoporosity = "nanoporosity_points";

/// The uncalendered film, as the bank's parameters describe it: by volumes, as if carbon, binder and
/// active material had the bank's densities.
struct Film {
  std::string name;
  std::vector<double> recipe; ///< values of the parameters whose keys are a recipe's
  double loading = 0.0;       ///< [mg/cm2]
  double sizes = 0.0;         ///< ln of its particles' median by volume over the bank's
  int material = 0;           ///< place in Draw::materials
  double nanoporosity = 0.5;  ///< of its recipe's CBD, 0-1
  bool of_bank = true;        ///< of the bank's kind: its parameters say all about it
  std::string remark;         ///< of its recipe's material; empty: none
};

struct Acting {
  int effect = 0; ///< place in FilmBank::effects()
  double amplitude = 0.0;
};

/// Values of FilmBank::material(), and the effects that are on.
struct Material {
  std::vector<double> parameters; ///< in their units
  std::vector<Acting> effects;
};

struct Guess {
  double mean = 0.0, variance = 0.0; ///< variance: of the emulators, not of the sample
};

class FilmBank {
public:
  /// Throws Failure(2) with fewer than four pressures or kFewestRuns points. A point that lacks
  /// a run, but for the one to the highest pressure, is left out.
  explicit FilmBank(const BankTable &table);

  const BankSpec &spec() const { return spec_; }
  /// Parameters of the bank whose keys are a case's, and kNanoporosity where the bank does not take
  /// it for known.
  const std::vector<inference::Parameter> &material() const { return material_; }
  /// Place in it of the strength of the bonds; -1: it is none of them.
  int strength() const { return strength_; }
  /// None: the bank does not say.
  const std::optional<CrushingLoads> &crushing() const { return crushing_; }
  /// Nanoporosity of a film's CBD, if it is made of that material, 0-1.
  double nanoporosity(const Film &film, const Material &material) const;
  const std::vector<BankParameter> &film() const { return film_; }
  /// Simulated ones that the bank has runs of.
  const std::vector<inference::Parameter> &effects() const { return effects_; }

  /// Throws Failure(2) if its recipe is another electrode than the bank's but for the parameters.
  /// Other particles pass where the bank's cell could hardly show the difference: percentiles by
  /// volume within a factor of 1.2 there, of 1.6 in the whole film.
  Film film_of(const Recipe &recipe) const;
  /// Describes any electrode: what the bank's parameters are for it.
  Film described(const Recipe &recipe) const;
  const Recipe &recipe() const { return recipe_; } ///< the bank's
  /// In what a recipe is another electrode than the bank's, in words.
  std::vector<std::string> differences(const Recipe &recipe) const;
  /// Its thickness without pores [um].
  double solid_column(const Film &film) const;
  /// Its table has the number; broken bonds, tortuosity and nanoporosity may be missing.
  bool knows(FilmNumber number) const { return emulators_of(number) != nullptr; }
  /// In what a film lies beyond the bank, in words.
  std::vector<std::string> beyond(const Film &film) const;
  bool covers(double pressure) const;

  /// At each of the bank's pressures.
  std::vector<Guess> at_pressures(FilmNumber number, const Film &film,
                                  const Material &material) const;
  /// Between them by a monotone cubic (Fritsch and Butland 1984) in the pressure's logarithm; beyond
  /// them the last value and a variance that grows.
  Guess at(const std::vector<Guess> &curve, double pressure) const;
  /// Pressures 5 % to either side, within the bank's: for a slope.
  std::pair<double, double> beside(double pressure) const;
  /// Errors of the change from the bank's cell to the full cell, one value for each run of that:
  /// sums of products are covariances, between pressures and films too.
  std::vector<double> full_cell_errors(FilmNumber number, const Film &film, double pressure) const;
  /// How well left-out packings are predicted, of a number at each pressure.
  std::vector<inference::Quality> quality(FilmNumber number) const;

private:
  using Emulators = std::vector<inference::GaussianProcess>; ///< a pressure each
  struct FullCell {
    std::vector<double> change;           ///< at each pressure
    std::vector<std::vector<double>> off; ///< what each run is off by, at each pressure
  };
  BankSpec spec_;
  Recipe recipe_;
  std::vector<inference::Parameter> material_, effects_;
  std::vector<BankParameter> film_;
  std::vector<bool> of_film_; ///< of the bank's parameters
  std::array<Emulators, kFilmNumbers> base_;
  std::vector<std::array<Emulators, kFilmNumbers>> with_; ///< differences, by effect
  std::array<FullCell, kFilmNumbers> full_cell_;
  int strength_ = -1;
  std::optional<CrushingLoads> crushing_;
  double full_loading_ = 0.0;
  double floor_nanoporosity_ = 0.0; ///< that collapse leaves, 0-1

  /// A film whose CBD has the bank's nanoporosity, as thick as another and with as much of CBD, pores
  /// included; and what to multiply with.
  struct Alike {
    Film film;
    double solids = 1.0;   ///< volume of solids, the other's per its own
    double collapse = 1.0; ///< volume that the nanopores can lose, the other's per its own
  };

  inference::Vector input(const Film &film, const Material &material) const;
  double carbon_and_binder(const Film &film) const;
  Alike alike(const Film &film, double nanoporosity) const;
  void check_nanoporosity() const;
  void learn(const BankTable &table);
  void learn_full_cell(const BankTable &table);
  void forget(FilmNumber number);
  /// Emulators of the base model; for the nanoporosity, which only collapse changes, those of
  /// collapse.
  const Emulators *emulators_of(FilmNumber number) const;
  double full_cell_share(const Film &film) const;
  /// What one effect changes at one of the bank's pressures.
  Guess change(FilmNumber number, std::size_t pressure, const inference::Vector &input,
               const Acting &acting, const Alike &as) const;
  /// What several change beyond the sum of these; `alone`: without them, `changed`: by each.
  Guess beyond_sum(FilmNumber number, std::size_t pressure, const inference::Vector &input,
                   const Material &material, const Alike &as, double alone,
                   const std::vector<double> &changed) const;
};

/// How porosity may depend on the particles' median size by volume: standard deviation for a factor
/// of e. Studies of the cell's size (docs/validation/studies.md): from 9 to 21 um, where the median
/// in the cell grows from 3.8 to 7.6 um, the porosity after 150 MPa falls from 35.7 to 31.1 %; all
/// of it is counted as the sizes', which is an upper bound.
constexpr double kPorosityBySize = 0.07;

/// Diameters [um] below which 10, 50 and 90 % of the bodies' volume lie, of bodies up to `largest`:
/// a lognormal by number, cut off at both ends (Hatch and Choate 1929 for its volumes).
std::array<double, 3> sizes_by_volume(const Recipe &recipe, double largest);

/// The amplitude in the unit of its effect's key.
double key_value(const FilmBank &bank, const Acting &acting);

/// Value of a run.
double value_of(FilmNumber number, const SimulatedRun &run);

} // namespace calendem

#endif
