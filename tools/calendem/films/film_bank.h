// SPDX-License-Identifier: GPL-2.0-or-later
// What a bank's runs say of any film of its material: emulators of what a film is like after it was
// pressed, at each of the bank's pressures and between them.
#ifndef CALENDEM_FILMS_FILM_BANK_H
#define CALENDEM_FILMS_FILM_BANK_H

#include "bank/training.h"
#include "films/crushing_loads.h"
#include <array>
#include <optional>

namespace calendem {

/// Key of the porosity before calendering, in which a bank's films differ.
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

struct ActiveEffect {
  int effect = 0; ///< place in FilmBank::effects()
  double amplitude = 0.0;
};

/// Values of FilmBank::material(), and the effects that are on.
struct Material {
  std::vector<double> parameters; ///< in their units
  std::vector<ActiveEffect> effects;
};

struct MeanVariance {
  double mean = 0.0, variance = 0.0; ///< variance: of the emulators, not of the sample
};

class FilmBank {
public:
  /// Throws Failure(2) where the runs' presses are too few to predict between.
  FilmBank(const bank::Runs &runs, inference::Emulator emulator);
  /// The bank of that file and the table beside it.
  explicit FilmBank(const std::string &file);

  const bank::Bank &spec() const { return spec_; }
  const std::vector<double> &pressures() const { return pressures_; } ///< MPa, increasing
  /// Quantities of the bank whose keys are a case's, and kNanoporosity where the bank does not take
  /// it for known.
  const std::vector<inference::Parameter> &material() const { return material_; }
  /// Place in it of the strength of the bonds; -1: it is none of them.
  int strength() const { return strength_; }
  /// None: the bank does not say.
  const std::optional<CrushingLoads> &crushing() const { return crushing_; }
  /// Nanoporosity of a film's CBD, if it is made of that material, 0-1.
  double nanoporosity(const Film &film, const Material &material) const;
  const std::vector<bank::Input> &film() const { return film_; }
  /// Effects that the bank's runs have.
  const std::vector<inference::Parameter> &effects() const { return effects_; }
  /// Places of effects that are off in the bank's runs where the effect of that place acts: a contact
  /// follows one law.
  const std::vector<int> &excluded_by(int effect) const { return excluded_[std::size_t(effect)]; }

  /// Throws Failure(2) if its recipe is another electrode than the bank's but for the parameters.
  /// Other particles pass where the bank's cell could hardly show the difference: percentiles by
  /// volume within a factor of 1.2 there, of 1.6 in the whole film.
  Film film_of(const Recipe &recipe) const;
  /// Describes any electrode: what the bank's parameters are for it.
  Film described(const Recipe &recipe) const;
  const Recipe &recipe() const { return recipe_; } ///< the bank's
  /// Says how much of its powder is too wide for the cells of its runs; empty: hardly any.
  std::string powder_cut_off() const;
  /// In what a recipe is another electrode than the bank's, in words.
  std::vector<std::string> differences(const Recipe &recipe) const;
  /// Its thickness without pores [um].
  double solid_column(const Film &film) const;
  /// Its table has the number at every pressure.
  bool knows(FilmNumber number) const { return known_[std::size_t(number)]; }
  /// In what a film lies beyond the bank, in words.
  std::vector<std::string> beyond(const Film &film) const;
  bool covers(double pressure) const;

  /// Outputs of the emulator (bank/training.h), of one film under several materials: outputs x
  /// materials.
  inference::Expectation emulated(const Film &film, const std::vector<const Material *> &materials,
                                  const std::vector<int> &outputs) const;

  /// Correlation of the emulator's errors between all its outputs, as packings that were left out show it.
  const inference::Matrix &error_correlation() const;
  /// Also between numbers of one film at any two pressures [MPa].
  double error_correlation(FilmNumber a, double at_a, FilmNumber b, double at_b) const;

  /// At each of the bank's pressures, of one material or of several.
  std::vector<MeanVariance> at_pressures(FilmNumber number, const Film &film,
                                         const Material &material) const;
  std::vector<std::vector<MeanVariance>>
  at_pressures(FilmNumber number, const Film &film,
               const std::vector<const Material *> &materials) const;
  /// Correlation of the emulator's errors between films, each of its material: films x films.
  inference::Matrix films_alike(const std::vector<Film> &films,
                                const std::vector<const Material *> &materials) const;
  /// Weights of the values at the bank's pressures that give the one at `pressure` (cubic_weights).
  inference::Vector weights_at(double pressure) const;
  /// Between them by the cubic through the four nearest, in the pressure's logarithm; beyond them
  /// the last value and a variance that grows.
  MeanVariance at(const std::vector<MeanVariance> &curve, double pressure) const;
  /// Pressures 5 % to either side, within the bank's: for a slope.
  std::pair<double, double> beside(double pressure) const;
  /// How well left-out packings are predicted, of a number at each pressure.
  std::vector<inference::Accuracy> accuracy(FilmNumber number) const;

private:
  bank::Bank spec_;
  bank::Space space_;
  Recipe recipe_;
  std::vector<double> pressures_;
  inference::Emulator emulator_;
  std::vector<inference::Parameter> material_, effects_;
  std::vector<std::vector<int>> excluded_; ///< of each effect
  std::vector<bank::Input> film_;
  std::array<bool, kFilmNumbers> known_{};
  int strength_ = -1, collapse_ = -1; ///< places among material_ and effects_; -1: none
  std::optional<CrushingLoads> crushing_;
  double larger_loading_ = 0.0;     ///< of the larger cell; 0: there is none
  double floor_nanoporosity_ = 0.0; ///< that collapse leaves, 0-1

  /// A film whose CBD has the bank's nanoporosity, as thick as another and with as much of CBD, pores
  /// included; and what to multiply with.
  struct Alike {
    Film film;
    double solids = 1.0;   ///< volume of solids, the other's per its own
    double collapse = 1.0; ///< volume that the nanopores can lose, the other's per its own
  };

  mutable std::optional<inference::Matrix> error_correlation_; ///< once it was asked for

  double carbon_and_binder(const Film &film) const;
  Alike alike(const Film &film, double nanoporosity) const;
  void check_nanoporosity() const;
  double larger_share(const Film &film) const;
  void note_effects();
  void scale_collapse(const inference::Points &at, const std::vector<Alike> &as,
                      const std::vector<int> &outputs, inference::Matrix &mean) const;
  inference::Points no_points(Eigen::Index count) const;
  void place(const Material &material, const Alike &as, Eigen::Index column,
             inference::Points &at) const;
};

/// Errors of the model change over a factor e of pressure.
double alike_at(double pressure, double other);

/// How porosity may depend on the particles' median size by volume: standard deviation for a factor
/// of e. Studies of the cell's size (docs/validation/studies.md): from 9 to 21 um, where the median
/// in the cell grows from 3.8 to 7.6 um, the porosity after 150 MPa falls from 35.7 to 31.1 %; all
/// of it is counted as the sizes', which is an upper bound.
constexpr double kPorosityBySize = 0.07;

/// Diameters [um] below which 10, 50 and 90 % of the bodies' volume lie, of bodies up to `largest`:
/// a lognormal by number, cut off at both ends (Hatch and Choate 1929 for its volumes).
std::array<double, 3> sizes_by_volume(const Recipe &recipe, double largest);

/// Porosity of a film, 0-1; the bank's own where it is no parameter.
double porosity_before(const FilmBank &bank, const Film &film);

/// Weights of values at increasing places `x` that give the one at `at`: the cubic through the four
/// nearest, at the ends through three; beyond them the last value.
inference::Vector cubic_weights(const std::vector<double> &x, double at);

/// The amplitude in the unit of its effect's key.
double key_value(const FilmBank &bank, const ActiveEffect &acting);

} // namespace calendem

#endif
