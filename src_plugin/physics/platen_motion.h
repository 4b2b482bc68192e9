// SPDX-License-Identifier: GPL-2.0-or-later
// Programme of the moving platen: wait; down with a smooth start to a pressure, a thickness or a
// displacement; dwell; up until contact is lost or the start is reached; once or several times. Or
// as a roll passes over the cell.
//
// Speeds. `touch` while the averaged pressure is below `touch_pressure`, `load` above, so that the
// stress wave rho c v stays below the pressure being measured. From one to the other and from rest
// the speed follows a smoothstep over `ramp_time`. Towards a pressure the speed is the lesser of
// that and
//   v = max((P_max - P)/3, 0.002 P_max) / (dP/dz * averaging window),
// a first-order approach over three windows that ends with 0.2 % of the target per window. P is the
// pressure now, ahead of its average. While P has reached it and the average has not, it waits.
// Signs: z is up, closing speed is positive downwards. Source: this project (docs/model/press.md).
// Deviations: none. Verified by tests/unit/physics/platen_motion_test.cpp and
// tests/verification/platen.
#ifndef CALENDEM_PHYSICS_PLATEN_MOTION_H
#define CALENDEM_PHYSICS_PLATEN_MOTION_H

#include "roll_nip.h"
#include <cmath>

namespace calendem {

enum class PlatenStage { Hold = 0, Compression = 1, Dwell = 2, Relaxation = 3, Done = 4 };
enum class PlatenControl { Hold, Pressure, Position, Roll };

/// What the user sets. Lengths um, times us, speeds um/us = m/s, pressures kPa.
struct PlatenProgramme {
  PlatenControl control = PlatenControl::Hold;
  double start = 0.0;          ///< position at the beginning
  double target = 0.0;         ///< kPa, or position: where the platen stops, or the roll's gap
  double load_speed = 0.0;     ///< > 0
  double touch_speed = 0.0;    ///< > 0
  double release_speed = 0.0;  ///< > 0
  double touch_pressure = 0.0; ///< >= 0
  double dwell = 0.0;          ///< >= 0
  double ramp_time = 0.0;      ///< >= 0
  double lost_fraction = 0.01; ///< of the maximum pressure: contact is lost below it
  double lowest = 0.0;         ///< the platen never goes below
  double compliance = 0.0;     ///< of the machine [um/kPa]; a position is what it shows
  RollNip roll;                ///< with control = Roll
  double passes = 1.0;         ///< of compression and release, >= 1
  double first_target = 0.0;   ///< of the first of several passes; 0: the target
  bool by_ratio = false;       ///< targets of passes grow by equal ratios, not by equal steps
  double wait = 0.0;           ///< time until which it rests at its start
};

/// What changes; restarts store it as it is.
struct PlatenState {
  double stage = static_cast<double>(PlatenStage::Hold);
  double position = 0.0;
  double speed = 0.0; ///< closing speed, > 0 downwards
  double stage_start = 0.0;
  double max_pressure = 0.0; ///< largest averaged pressure
  double slope = 0.0;        ///< smoothed dP/d(closing) [kPa/um]
  double rate = 0.0;         ///< smoothed rise of the averaged pressure [kPa/us]
  double last_average = 0.0;
  double reached = 0.0;   ///< 1 if the target was met
  double passed = 0.0;    ///< passes that are over
  double web_speed = 0.0; ///< during a pass
};

inline PlatenStage stage_of(const PlatenState &s) { return static_cast<PlatenStage>(int(s.stage)); }

inline void enter(PlatenState &s, PlatenStage stage, double time) {
  s.stage = static_cast<double>(stage);
  s.stage_start = time;
}

inline bool last_pass(const PlatenProgramme &p, const PlatenState &s) {
  return s.passed + 1.0 >= p.passes;
}

/// The pressure or gap of the pass that is on: from first to last in equal steps or ratios.
inline double target_of_pass(const PlatenProgramme &p, const PlatenState &s) {
  if (p.first_target <= 0.0 || last_pass(p, s))
    return p.target;
  const double share = s.passed / (p.passes - 1.0);
  return p.by_ratio ? p.first_target * std::pow(p.target / p.first_target, share)
                    : p.first_target + (p.target - p.first_target) * share;
}

inline double smoothstep(double t) {
  const double x = t <= 0.0 ? 0.0 : (t >= 1.0 ? 1.0 : t);
  return x * x * (3.0 - 2.0 * x);
}

/// Moves `speed` towards `wanted` no faster than a full ramp of height `scale` in ramp_time.
inline double approach_speed(double speed, double wanted, double scale, double ramp_time,
                             double dt) {
  if (ramp_time <= 0.0)
    return wanted;
  const double most = 1.5 * scale / ramp_time * dt; // the smoothstep's steepest slope
  const double change = wanted - speed;
  return speed + (change > most ? most : (change < -most ? -most : change));
}

/// Pressure now: the average is that of half a window ago, its smoothed rate that of a quarter
/// more.
inline double pressure_now(const PlatenState &s, double average, double window) {
  return average + 0.75 * window * std::fmax(s.rate, 0.0);
}

/// Closing speed wanted during compression towards a pressure or a position. On the second half of
/// the way to a pressure the platen takes three windows for what is left, and waits while the
/// average catches up.
inline double closing_speed(const PlatenProgramme &p, const PlatenState &s, double average,
                            double window) {
  double wanted = average < p.touch_pressure ? p.touch_speed : p.load_speed;
  if (p.control == PlatenControl::Pressure && s.slope > 0.0 && window > 0.0) {
    const double per_window = s.slope * window; // rise of pressure in one window at unit speed
    const double target = target_of_pass(p, s), left = target - pressure_now(s, average, window);
    const double limit = left > 0.0 ? std::fmax(left / 3.0, 0.002 * target) / per_window : 0.0;
    if (average > 0.5 * target && limit < wanted)
      wanted = limit;
  }
  return wanted;
}

inline void compress(const PlatenProgramme &p, PlatenState &s, double average, double window,
                     double time, double dt) {
  const double wanted = closing_speed(p, s, average, window);
  const double scale = std::fmax(p.load_speed, p.touch_speed);
  s.speed = wanted < s.speed ? wanted : approach_speed(s.speed, wanted, scale, p.ramp_time, dt);
  s.position -= s.speed * dt;
  const bool by_pressure = p.control == PlatenControl::Pressure;
  // The machine is that much further than its platen. The average is of half a window ago.
  const double stretch = p.compliance * (average + 0.5 * window * std::fmax(s.rate, 0.0));
  const double target = target_of_pass(p, s);
  const bool there = by_pressure ? average >= target : s.position - stretch <= target;
  if (!by_pressure && there)
    s.position = target + stretch;
  if (!there && s.position > p.lowest)
    return;
  s.reached = there ? 1.0 : 0.0;
  s.speed = 0.0;
  enter(s, PlatenStage::Dwell, time);
}

/// Contact is lost: down again, or the end.
inline void end_pass(const PlatenProgramme &p, PlatenState &s, double time) {
  s.speed = s.web_speed = 0.0;
  enter(s, last_pass(p, s) ? PlatenStage::Done : PlatenStage::Compression, time);
  s.passed += 1.0;
}

inline void relax(const PlatenProgramme &p, PlatenState &s, double average, double time,
                  double dt) {
  s.speed = approach_speed(s.speed, -p.release_speed, p.release_speed, p.ramp_time, dt);
  s.position -= s.speed * dt;
  const bool lost = average < p.lost_fraction * s.max_pressure;
  if (lost || s.position >= p.start)
    end_pass(p, s, time);
}

/// Where the cell is on its way under the roll: s, < 0 before the nip.
inline double along_web(const PlatenProgramme &p, const PlatenState &s) {
  const double way = p.roll.distance(s.position - target_of_pass(p, s));
  return stage_of(s) == PlatenStage::Relaxation ? way : -way;
}

/// The web moves on for one step, at most to the nip; returns where the cell is then.
inline double pass_on(const PlatenProgramme &p, PlatenState &s, double dt) {
  const double gap = target_of_pass(p, s), most = p.roll.web_speed(p.load_speed, p.start - gap);
  s.web_speed = approach_speed(s.web_speed, most, most, p.ramp_time, dt);
  const double on = along_web(p, s) + s.web_speed * dt;
  const double along = stage_of(s) == PlatenStage::Compression ? std::fmin(on, 0.0) : on;
  const double position = gap + p.roll.above(along);
  s.speed = (s.position - position) / dt;
  s.position = position;
  return along;
}

inline void enter_nip(const PlatenProgramme &p, PlatenState &s, double time, double dt) {
  const bool there = pass_on(p, s, dt) >= 0.0;
  if (!there && s.position > p.lowest)
    return;
  s.reached = there ? 1.0 : 0.0;
  s.speed = 0.0;
  enter(s, PlatenStage::Dwell, time);
}

inline void leave_nip(const PlatenProgramme &p, PlatenState &s, double average, double time,
                      double dt) {
  pass_on(p, s, dt);
  const bool lost = average < p.lost_fraction * s.max_pressure;
  if (lost || s.position >= p.start)
    end_pass(p, s, time);
}

/// Speed of the roll's surface along the web; the roll stands while it is held in the nip.
inline double slip_speed(const PlatenProgramme &p, const PlatenState &s) {
  const bool turns =
      stage_of(s) == PlatenStage::Compression || stage_of(s) == PlatenStage::Relaxation;
  return p.control == PlatenControl::Roll && turns ? p.roll.slip_speed(s.web_speed, along_web(p, s))
                                                   : 0.0;
}

/// One step. `average`: pressure [kPa] averaged over `window` [us]; `time` at the step's end.
/// `may_release`: false holds the platen in the dwell of its last pass, a roll in its last nip (a
/// script that ends after compression).
inline void advance(const PlatenProgramme &p, PlatenState &s, double average, double window,
                    double time, double dt, bool may_release) {
  s.max_pressure = std::fmax(s.max_pressure, average);
  if (time < p.wait)
    return;
  const bool roll = p.control == PlatenControl::Roll;
  switch (stage_of(s)) {
  case PlatenStage::Compression:
    roll ? enter_nip(p, s, time, dt) : compress(p, s, average, window, time, dt);
    break;
  case PlatenStage::Dwell:
    if ((may_release || !last_pass(p, s)) && time - s.stage_start >= p.dwell)
      enter(s, PlatenStage::Relaxation, time);
    break;
  case PlatenStage::Relaxation:
    roll ? leave_nip(p, s, average, time, dt) : relax(p, s, average, time, dt);
    break;
  default:
    break;
  }
}

/// Call whenever the average has moved on by `interval` [us]: keeps the stiffness of the film that
/// the approach needs. Measured at a good part of the loading speed only; when the platen creeps,
/// single breaking bonds outweigh its motion.
inline void update_slope(const PlatenProgramme &p, PlatenState &s, double average,
                         double interval) {
  const double rate = (average - s.last_average) / interval;
  s.rate = 0.9 * s.rate + 0.1 * rate;
  if (s.speed > 0.2 * p.load_speed && rate > 0.0)
    s.slope = s.slope > 0.0 ? 0.9 * s.slope + 0.1 * rate / s.speed : rate / s.speed;
  s.last_average = average;
}

} // namespace calendem

#endif
