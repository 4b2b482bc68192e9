// SPDX-License-Identifier: GPL-2.0-or-later
// Time that has passed, from the number of a step: steps may get another length or other numbers
// on the way, and what has passed stays.
//   t(n) = t_0 + (n - n_0) dt
// with n_0 the step from which on dt holds. As long as neither changes t_0 and n_0 stay 0, and time
// is the number of the step times its length to the last bit. Source: none, a definition.
// Verified by tests/unit/physics/time_count_test.cpp, tests/reliability/between_runs.
#ifndef CALENDEM_PHYSICS_TIME_COUNT_H
#define CALENDEM_PHYSICS_TIME_COUNT_H

namespace calendem {

struct TimeCount {
  double before = 0.0; ///< t_0 [us]
  double first = 0.0;  ///< n_0
  double length = 0.0; ///< dt [us]

  double at(double step) const { return before + (step - first) * length; }
  /// Steps after this one have that length.
  void set_length(double step, double new_length) {
    if (new_length == length)
      return;
    before = at(step);
    first = step;
    length = new_length;
  }
  /// The step has another number from now on.
  void renumber(double step, double number) {
    before = at(step);
    first = number;
  }
};

} // namespace calendem

#endif
