// SPDX-License-Identifier: GPL-2.0-or-later
// What an experiment says of a film, as readings.
#include "base/messages.h"
#include "films/film_problem.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr double kUsualPressureSd = 0.1; // where an experiment gives none
constexpr double kUsualPorosityPoints = 1.0, kUsualShareSd = 0.1;

std::string named(const Experiment &e, const Condition &c) { return e.name + ", " + c.id; }

/// Why nothing is read of a condition; empty: it is.
std::string left_out(const Condition &c, const FilmBank &bank) {
  if (!c.pressing.empty())
    return fmt::format("pressed in a way of its own (\"{}\"): left out.", c.pressing);
  if (!c.max_pressure_MPa || !bank.covers(c.max_pressure_MPa->value))
    return fmt::format(
        "its pressure is not known, or outside the bank's {:g} to {:g} MPa: left out.",
        bank.pressures().front(), bank.pressures().back());
  return "";
}

/// An emulator knows it.
bool is_emulated(const Observable &o) {
  if (o.stage == kBefore || o.stage == kDwell)
    return false;
  return o.curve.empty() || o.pressure >= bank::loading_pressures().front();
}

std::vector<Observable> observables_for(const Experiment &e, const Condition &given,
                                        const FilmBank &bank, std::vector<std::string> &warnings) {
  const bool by_thickness =
      given.thickness_after_um || given.thickness_at_max_um || !given.curve.empty();
  Condition c =
      by_thickness && !loading_of(e, given) ? with_loading_of_recipe(e, given, warnings) : given;
  c.control = "pressure"; // to which it went, however it was set
  std::vector<Observable> out;
  for (Observable &o : observables_of(e, c, warnings)) {
    if (!is_emulated(o))
      continue;
    if (o.sd == 0.0 && o.unit == "%")
      o.sd = kUsualPorosityPoints;
    if (o.sd == 0.0 && o.unit == "fraction")
      o.sd = kUsualShareSd;
    out.push_back(o);
  }
  if (const auto &pores = c.cbd_nanoporosity_after_percent;
      pores && bank.knows(FilmNumber::CbdNanoporosity))
    out.push_back(observable_of(FilmNumber::CbdNanoporosity, 0.01 * pores->value,
                                pores->sd > 0.0 ? 0.01 * pores->sd : kUsualShareSd));
  return out;
}

} // namespace

int place_of_material(const Experiment &e, std::vector<std::string> &names) {
  const std::string material = e.material.empty() ? kUnnamed : e.material;
  if (material == kOther)
    throw Failure(kBadInput,
                  fmt::format("{}: material is '{}', which stands for one that was not measured. "
                              "Give it another name.",
                              e.name, kOther));
  const auto known = std::find(names.begin(), names.end(), material);
  const int place = int(known - names.begin());
  if (known == names.end())
    names.push_back(material);
  return place;
}

void add_readings(const Experiment &e, const FilmBank &bank, MeasuredFilms &to,
                  std::vector<std::string> &warnings) {
  Film film = bank.film_of(e.recipe);
  film.name = e.name;
  film.material = place_of_material(e, to.materials);
  for (const std::string &why : bank.beyond(film))
    warnings.push_back(fmt::format("{}: {}.", e.name, why));
  to.films.push_back(film);
  to.cells.push_back(e.sample_diameter_mm > 0.0 ? 1e8 * sample_area_cm2(e) / bank.recipe().area()
                                                : 0.0);
  const std::size_t before = to.readings.size();
  for (const Condition &c : e.conditions) {
    if (const std::string why = left_out(c, bank); !why.empty()) {
      warnings.push_back(fmt::format("{}: {}", named(e, c), why));
      continue;
    }
    if (!c.labels_before.empty() || !c.labels_after.empty())
      warnings.push_back(named(e, c) + ": its images are not compared; `calendem compare "
                                       "EXPERIMENT RUN` compares a run with them.");
    Reading r;
    r.film = int(to.films.size()) - 1;
    r.condition = c.id;
    r.specimen = c.specimen.empty() ? c.id : c.specimen;
    r.pressure = c.max_pressure_MPa->value;
    r.pressure_sd =
        c.max_pressure_MPa->sd > 0.0 ? c.max_pressure_MPa->sd / r.pressure : kUsualPressureSd;
    r.specimen_porosity = 0.01 * e.specimen_porosity_points;
    r.specimen_porosity_before =
        c.porosity_before_percent ? 0.01 * c.porosity_before_percent->sd : r.specimen_porosity;
    for (const Observable &o : observables_for(e, c, bank, warnings)) {
      r.observable = o;
      to.readings.push_back(r);
    }
  }
  if (to.readings.size() == before)
    throw Failure(kBadInput,
                  fmt::format("{}: no condition has a pressure within the bank's {:g} to "
                              "{:g} MPa and a value that the bank predicts.",
                              e.name, bank.pressures().front(), bank.pressures().back()));
}

Observable observable_of(FilmNumber number, double measured, double sd) {
  Observable o;
  o.measured = measured;
  o.sd = sd;
  o.stage = "relaxation";
  switch (number) {
  case FilmNumber::PorosityAfter:
    o.name = "total porosity";
    o.simulated = [](const SimulatedRun &r) { return r.porosity_after; };
    o.per_porosity = [](const SimulatedRun &) { return 1.0; };
    return o;
  case FilmNumber::Cracked:
    o.name = "cracked bodies";
    o.simulated = [](const SimulatedRun &r) { return r.cracked_fraction; };
    return o;
  case FilmNumber::CbdNanoporosity:
    o.name = "nanoporosity";
    o.simulated = [](const SimulatedRun &r) { return r.cbd_nanoporosity; };
    o.per_porosity = [](const SimulatedRun &) { return 1.0; };
    return o;
  default:
    throw Failure(kBadInput, "no reading of a film is this number");
  }
}

} // namespace calendem
