// SPDX-License-Identifier: GPL-2.0-or-later
// A number in a range. CLI11's own check of a range lets NaN through.
#ifndef CALENDEM_COMMANDS_FINITE_RANGE_H
#define CALENDEM_COMMANDS_FINITE_RANGE_H

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <string>

namespace calendem {

inline CLI::Validator finite_range(double low, double high) {
  const std::string range = fmt::format("in [{:g} - {:g}]", low, high);
  return {[=](std::string &text) {
            double value = 0.0;
            const bool good =
                CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
            return good ? std::string() : fmt::format("{} is no number {}", text, range);
          },
          "FLOAT " + range};
}

} // namespace calendem

#endif
