// SPDX-License-Identifier: GPL-2.0-or-later
// The verbs of the second program, calendem-films: those that learn from a bank of films, and validate, which also reads
// the file of a bank. The demo builds it after its report. Each function adds the options of its verb, and its work.
#ifndef CALENDEM_FILM_COMMANDS_FILM_COMMANDS_H
#define CALENDEM_FILM_COMMANDS_FILM_COMMANDS_H

namespace CLI {
class App;
} // namespace CLI

namespace calendem {

void set_up_bank(CLI::App &verb); ///< bank BANK.toml -o DIR [--check], with the options of study
void set_up_diagnose(CLI::App &verb);  ///< diagnose EXPERIMENT.toml -o DIR [--bank BANK.toml]
void set_up_calibrate(CLI::App &verb); ///< calibrate EXPERIMENT.toml... -o DIR [--bank BANK.toml]
void set_up_predict(CLI::App &verb); ///< predict MODEL.json RECIPE.toml... --pressure 20:300 -o DIR
void set_up_design(CLI::App &verb);  ///< design MODEL.json RECIPE.toml --porosity 30 -o DIR
void set_up_validate(CLI::App &verb); ///< validate FILE...

} // namespace calendem

#endif
