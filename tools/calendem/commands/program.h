// SPDX-License-Identifier: GPL-2.0-or-later
// What the two programs of the command line share. `calendem` has the verbs that need no bank of films; it lists the others
// in its help and hands them over to `calendem-films` beside it.
#ifndef CALENDEM_COMMANDS_PROGRAM_H
#define CALENDEM_COMMANDS_PROGRAM_H

#include <functional>

namespace CLI {
class App;
} // namespace CLI

namespace calendem {

inline constexpr const char *kFilmProgram = "calendem-films";

/// A verb of `calendem-films`.
struct FilmVerb {
  const char *name;
  const char *group; ///< heading in the help
  const char *description;
};
inline constexpr FilmVerb kFilmVerbs[] = {
    {"bank", "Many runs", "Make the simulations that diagnose and calibrate learn from"},
    {"diagnose", "Experiments",
     "Find where simulation and experiment disagree, and which effect explains it"},
    {"calibrate", "Predictions",
     "Infer a material's parameters and effects from measured films; predict each film from the "
     "others"},
    {"predict", "Predictions",
     "Predict porosity, springback and cracked particles of a film against pressure, with "
     "intervals"},
    {"design", "Predictions",
     "Choose the pressure or gap that meets a target, with the probability that it does"},
    {"validate", "Help", "Check TOML files of any kind and list all mistakes at once"}};

/// Parses the command line with the verbs that `add_verbs` adds, does the work and returns the exit status: 0 done,
/// 1 usage, 2 bad input, 3 the simulation failed, 4 a check did not hold.
int run_program(int argc, char **argv, const std::function<void(CLI::App &)> &add_verbs);

} // namespace calendem

#endif
