// SPDX-License-Identifier: GPL-2.0-or-later
// Which films a bank has, and what its parameters are for them.
#include "base/material_notes.h"
#include "base/messages.h"
#include "base/particle_sizes.h"
#include "base/shown.h"
#include "films/film_bank.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {

std::array<double, 3> sizes_by_volume(const Recipe &r, double largest) {
  const SizeLaw law{r.median, r.sigma_ln, r.min_diameter, largest};
  return {law.volume_quantile(0.1), law.volume_quantile(0.5), law.volume_quantile(0.9)};
}

namespace {

constexpr double kSameInCell = 1.2, kSameInFilm = 1.6; // factors, of the percentiles
constexpr double kSameLoading = 0.02, kThinnest = 0.5; // of the bank's loading
constexpr double kSizesSaid = 0.0005;                  // error of porosity 0-1

bool are_alike(const std::array<double, 3> &a, const std::array<double, 3> &b, double factor) {
  for (std::size_t k = 0; k < a.size(); ++k)
    if (std::max(a[k] / b[k], b[k] / a[k]) > factor)
      return false;
  return true;
}

/// As far as the bank's cell shows it, and roughly in the whole film.
bool has_particles_of(Recipe film, const Recipe &bank) {
  if (!are_alike(sizes_by_volume(film, film.max_diameter), sizes_by_volume(bank, bank.max_diameter),
                 kSameInFilm))
    return false;
  film.cell_x = bank.cell_x;
  film.cell_y = bank.cell_y;
  return are_alike(sizes_by_volume(film, film.largest_body()),
                   sizes_by_volume(bank, bank.largest_body()), kSameInCell);
}

/// Weight of carbon and binder (0-1) and loading with which the bank's densities give the film's
/// volumes.
struct ByVolume {
  double weight = 0.0, loading = 0.0;
};

ByVolume by_volume(const Recipe &film, const Recipe &bank) {
  const double am = bank.am_density * film.am_column(),
               cbd = bank.cbd_solid_density * film.cbd_solid_column();
  return {cbd / (am + cbd), 0.1 * (am + cbd)};
}

/// A bank's key without "recipe.".
std::string bare_of(const std::string &key) { return key.substr(key.find('.') + 1); }
bool is_composition(const std::string &bare) { return bare.rfind("composition.", 0) == 0; }

void add_differences_of_packings(std::vector<std::string> &to, const Recipe &recipe,
                                 const Recipe &bank, bool alike) {
  if (recipe.structure.given() || bank.structure.given())
    return;
  const auto differs = [&](const char *key) {
    if (recipe.settings.number(key) != bank.settings.number(key))
      to.push_back(fmt::format("{}: {:g} instead of {:g}", key, recipe.settings.number(key),
                               bank.settings.number(key)));
  };
  if (!alike) {
    for (const char *key : {"particles.min_um", "particles.max_um"})
      differs(key);
    to.push_back(fmt::format("half of the particles' volume lies below {:.3g} instead of {:.3g} um",
                             sizes_by_volume(recipe, recipe.max_diameter)[1],
                             sizes_by_volume(bank, bank.max_diameter)[1]));
  }
  for (const char *key :
       {"particles.primary_diameter_um", "particles.lattice_um", "effects.cbd_gradient.slope"})
    differs(key);
  if (recipe.settings.line("particles.irregularity") > 0) // of a material it is the model's
    differs("particles.irregularity");
}

/// What is said of a film's material, which the bank does not vary.
std::string remark_on(const ReferenceMaterial &film, const ReferenceMaterial &bank) {
  std::string out = not_calibrated(film);
  if (!share_a_name(film, bank))
    out =
        fmt::format("the material is '{}', and the bank's runs are of '{}': the numbers are those "
                    "of the bank's material{}",
                    film.name, bank.name, out.empty() ? "" : "; " + out);
  return out;
}

} // namespace

Film FilmBank::described(const Recipe &recipe) const {
  const Recipe &bank = recipe_;
  const bool same_solids =
      recipe.am_density == bank.am_density && recipe.cbd_solid_density == bank.cbd_solid_density;
  const ByVolume volumes = same_solids || recipe.am_weight >= 1.0
                               ? ByVolume{1.0 - recipe.am_weight, recipe.loading}
                               : by_volume(recipe, bank);
  const double of_weight = recipe.am_weight < 1.0 ? volumes.weight / (1.0 - recipe.am_weight) : 1.0;
  Film out;
  out.name = recipe.settings.text("name");
  out.loading = volumes.loading;
  out.nanoporosity = recipe.nanoporosity;
  out.of_bank = differences(recipe).empty();
  out.remark = remark_on(recipe.material, bank.material);
  for (const bank::Input &p : film_) {
    double sum = 0.0;
    for (const std::string &key : p.keys) {
      const std::string bare = bare_of(key);
      sum += recipe.settings.number(bare) * (is_composition(bare) ? of_weight : 1.0);
    }
    out.recipe.push_back(sum / double(p.keys.size()));
  }
  if (!recipe.structure.given() && !bank.structure.given())
    out.sizes = std::log(sizes_by_volume(recipe, recipe.max_diameter)[1] /
                         sizes_by_volume(bank, bank.max_diameter)[1]);
  return out;
}

Film FilmBank::film_of(const Recipe &recipe) const {
  if (const auto differs = differences(recipe); !differs.empty())
    throw Failure(kBadInput, fmt::format("{}: the film is not of the bank's kind; {}. Make a bank "
                                         "of it (calendem bank; copy {} and change its recipe), "
                                         "or predict it by runs of its own (--runs).",
                                         recipe.file, fmt::join(differs, "; "), spec_.file));
  return described(recipe);
}

std::string FilmBank::powder_cut_off() const {
  const double largest = recipe_.largest_body();
  const double cut = measured_law(recipe_).volume_above(largest);
  return cut > kCutOffWarned
             ? fmt::format("{:.0f} % of the volume of the bank's powder is in particles wider than "
                           "its cells can hold ({:.1f} um); smaller ones take its place.",
                           100.0 * cut, largest)
             : "";
}

std::vector<std::string> FilmBank::differences(const Recipe &recipe) const {
  const Recipe &bank = recipe_;
  std::map<std::string, std::string> wanted = bank.settings.all();
  const auto any = [&](const char *key) { wanted[key] = recipe.settings.text(key); };
  for (const bank::Input &p : film_)
    for (const std::string &key : p.keys) {
      const std::string bare = bare_of(key);
      any(bare.c_str());
      if (is_composition(bare))
        for (const char *other :
             {"composition.am_weight_percent", "density.am_g_cm3", "density.cbd_solid_g_cm3"})
          any(other);
    }
  if (spec_.nanoporosity_within > 0.0)
    any("cbd.nanoporosity_percent");
  const bool alike = has_particles_of(recipe, bank);
  if (alike)
    for (const char *key : {"particles.median_um", "particles.sigma_ln"})
      any(key);
  std::vector<std::string> out = other_electrode(wanted, recipe.settings.all());
  add_differences_of_packings(out, recipe, bank, alike);
  if (!are_of_one_density(recipe.am_density, bank.am_density))
    out.push_back(fmt::format("density.am_g_cm3: {:g} instead of {:g}, that of another material",
                              recipe.am_density, bank.am_density));
  if (const double least = kThinnest * recipe_.loading; recipe.loading < least)
    out.push_back(
        fmt::format("coating.loading_mg_cm2: {:g}; its faces count more than the bank can "
                    "tell below {:g}",
                    recipe.loading, least));
  return out;
}

double FilmBank::carbon_and_binder(const Film &film) const {
  double percent = 0.0;
  for (const char *key :
       {"composition.carbon_weight_percent", "composition.binder_weight_percent"}) {
    double value = recipe_.settings.number(key);
    for (std::size_t k = 0; k < film_.size(); ++k)
      for (const std::string &name : film_[k].keys)
        if (name == std::string("recipe.") + key)
          value = film.recipe[k];
    percent += value;
  }
  return 0.01 * percent;
}

double FilmBank::solid_column(const Film &film) const {
  Recipe as = recipe_;
  as.loading = film.loading;
  as.am_weight = 1.0 - carbon_and_binder(film);
  return as.am_column() + as.cbd_solid_column();
}

void FilmBank::check_nanoporosity() const {
  const auto has = [&](const auto &wanted) {
    return std::any_of(film_.begin(), film_.end(), [&](const bank::Input &p) {
      return std::any_of(p.keys.begin(), p.keys.end(), wanted);
    });
  };
  if (!has([](const std::string &key) { return key == kPorosityKey; }) ||
      !has([](const std::string &key) { return is_composition(bare_of(key)); }))
    throw Failure(kBadInput,
                  fmt::format("{}: nanoporosity_within_points is {:g}; for that the bank's films "
                              "must differ in porosity ({}) and in carbon and binder "
                              "(recipe.composition.*). Add such [[input]]s, or leave it out.",
                              spec_.file, spec_.nanoporosity_within, kPorosityKey));
}

double FilmBank::nanoporosity(const Film &film, const Material &material) const {
  constexpr double kMost = 0.9; // 0-1
  return spec_.nanoporosity_within > 0.0
             ? std::clamp(film.nanoporosity + 0.01 * material.parameters.back(), 0.0, kMost)
             : recipe_.nanoporosity;
}

FilmBank::Alike FilmBank::alike(const Film &film, double nanoporosity) const {
  Alike out = {film};
  const double of_bank = recipe_.nanoporosity, weight = carbon_and_binder(film);
  if (nanoporosity == of_bank || weight <= 0.0)
    return out;
  const double more = (1.0 - of_bank) / (1.0 - nanoporosity), // solid CBD, the bank's per film's
      am = (1.0 - weight) / recipe_.am_density, cbd = weight / recipe_.cbd_solid_density;
  out.solids = (am + cbd) / (am + more * cbd);
  for (std::size_t k = 0; k < film_.size(); ++k)
    if (const std::string &key = film_[k].keys.front(); key == kPorosityKey)
      out.film.recipe[k] = 100.0 - (100.0 - film.recipe[k]) / out.solids;
    else if (is_composition(bare_of(key)))
      out.film.recipe[k] *= more / (1.0 - weight + more * weight);
  if (of_bank > floor_nanoporosity_)
    out.collapse =
        std::max(0.0, nanoporosity - floor_nanoporosity_) / (of_bank - floor_nanoporosity_);
  return out;
}

std::vector<std::string> FilmBank::beyond(const Film &film) const {
  std::vector<std::string> out;
  if (!film.remark.empty())
    out.push_back(film.remark);
  const std::vector<double> recipe =
      spec_.nanoporosity_within > 0.0 ? alike(film, film.nanoporosity).film.recipe : film.recipe;
  for (std::size_t k = 0; k < film_.size(); ++k)
    if (recipe[k] < film_[k].low || recipe[k] > film_[k].high)
      out.push_back(fmt::format("{0} {2:.4g}{1}; the bank has {3:g} to {4:g}{1}: extrapolated",
                                in_words(film_[k].name).name, in_words(film_[k].name).unit,
                                recipe[k], film_[k].low, film_[k].high));
  if (larger_loading_ > 0.0 && film.loading < (1.0 - kSameLoading) * recipe_.loading)
    out.push_back(fmt::format("loading {:.3g} mg/cm2; the bank has {:g} and more: extrapolated",
                              film.loading, recipe_.loading));
  if (const double error = kPorosityBySize * std::fabs(film.sizes); error > kSizesSaid)
    out.push_back(fmt::format("half of the particles' volume lies below a diameter that is {:.2f} "
                              "times the bank's: counted as an error of {:.1f} points of porosity",
                              std::exp(film.sizes), 100.0 * error));
  return out;
}

} // namespace calendem
