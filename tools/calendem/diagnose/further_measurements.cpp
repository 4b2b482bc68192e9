// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/diagnosis.h"
#include <algorithm>
#include <cmath>

namespace calendem {
namespace {

// Errors of what a laboratory would read; estimates.
constexpr double kPorosityPoints = 0.5, kCrackedShare = 0.05, kNanoporosityPoints = 3.0;
constexpr double kPressureError = 0.03, kCurveUm = 0.2, kTouchUm = 1.0;
constexpr double kWithin = 0.02;

Condition read_at(double pressure) {
  Condition c;
  c.id = "further";
  c.control = "pressure";
  c.max_pressure_MPa = Measured{pressure, kPressureError * pressure};
  c.porosity_after_percent = Measured{30.0, kPorosityPoints};
  c.cracked_bodies_fraction = Measured{0.1, kCrackedShare};
  c.cbd_nanoporosity_after_percent = Measured{40.0, kNanoporosityPoints};
  return c;
}

bool has(const MeasuredFilms &measured, int film, const std::string &name, double pressure) {
  return std::any_of(measured.readings.begin(), measured.readings.end(), [&](const Reading &r) {
    return r.film == film && (r.observable.name == name || r.observable.curve == name) &&
           std::fabs(std::log(r.pressure / pressure)) < kWithin;
  });
}

/// Readings of one pressing, and which of them are made together.
class OnePressing {
public:
  OnePressing(const Experiment &e, const FilmBank &bank, int film, double pressure)
      : e_(e), film_(film), condition_(read_at(pressure)) {
    std::vector<std::string> unused;
    Experiment alone = e;
    alone.conditions = {condition_};
    MeasuredFilms single;
    add_readings(alone, bank, single, unused);
    for (const Reading &r : single.readings)
      scalars_.push_back(of_film(r));
    const double solid = bank.solid_column(single.films[0]);
    condition_.loading_mg_cm2 = Measured{e.recipe.loading};
    for (const Branch branch : {Branch::Loading, Branch::Release})
      for (Observable &o : points_of_curve(e_, condition_, pressure, branch))
        if (o.pressure >= bank::loading_pressures().front()) {
          o.sd = kCurveUm / solid;
          o.by_zero = kTouchUm / solid;
          Reading r = scalars_.front();
          r.observable = o;
          curve_.push_back(r);
        }
  }

  const std::vector<Reading> &scalars() const { return scalars_; }
  const std::vector<Reading> &curve() const { return curve_; }

private:
  const Experiment &e_;
  int film_;
  Condition condition_;
  std::vector<Reading> scalars_, curve_;

  Reading of_film(Reading r) const {
    r.film = film_;
    r.condition = r.specimen = "further at " + std::to_string(r.pressure);
    return r;
  }
};

} // namespace

std::vector<FurtherMeasurement> further_measurements(const Experiment &e, const FilmBank &bank,
                                                     const MeasuredFilms &measured, int film,
                                                     MeasuredFilms &with,
                                                     std::vector<std::vector<int>> &places) {
  std::vector<FurtherMeasurement> out;
  int next = 0;
  const auto add = [&](const std::string &name, const std::vector<Reading> &together) {
    const Reading &first = together.front();
    out.push_back({name, first.observable.unit, first.pressure, first.observable.sd, {}});
    places.emplace_back();
    for (const Reading &r : together) {
      with.readings.push_back(r);
      places.back().push_back(next++);
    }
  };
  for (const double pressure : bank.pressures()) {
    const OnePressing pressed(e, bank, film, pressure);
    for (const Reading &r : pressed.scalars())
      if (!has(measured, film, r.observable.name, pressure))
        add(r.observable.name, {r});
    const std::vector<Reading> &curve = pressed.curve();
    if (!curve.empty() && !has(measured, film, curve.front().observable.curve, pressure))
      add("curve", curve);
  }
  return out;
}

} // namespace calendem
