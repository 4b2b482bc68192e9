// SPDX-License-Identifier: GPL-2.0-or-later
#include "commands/program.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "base/registry.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fmt/core.h>
#include <string>
#include <vector>

namespace calendem {
namespace {

/// What is wrong where the first word is no verb and no option; empty: nothing.
std::string wrong_verb(const CLI::App &app, int argc, char **argv) {
  if (argc < 2)
    return app.help();
  const std::string word = argv[1];
  std::vector<std::string> names;
  for (const CLI::App *verb : app.get_subcommands([](const CLI::App *) { return true; }))
    names.push_back(verb->get_name());
  if (word.empty() || word[0] == '-' || std::find(names.begin(), names.end(), word) != names.end())
    return "";
  return fmt::format("there is no verb '{}'. Did you mean '{}'? calendem --help lists the verbs.\n",
                     word, closest(word, names));
}

/// The work of a verb, and the exit status. What goes wrong in it is thrown.
int run(int argc, char **argv, const std::function<void(CLI::App &)> &add_verbs) {
  CLI::App app{"Calendering of battery electrodes: make an electrode, press it, compare it with "
               "measurements, predict others.",
               "calendem"};
  app.require_subcommand(1);
  app.set_version_flag("--version", version());
  app.footer(
      fmt::format("calendem VERB --help lists the options of a verb, and the keys of its file.\n"
                  "Examples to copy: {}/cases\n"
                  "Exit status: 0 done, 1 usage, 2 bad input, 3 the simulation failed, 4 a "
                  "check failed.",
                  input_scripts()));
  add_verbs(app);
  if (const std::string wrong = wrong_verb(app, argc, argv); !wrong.empty()) {
    fmt::print(stderr, "{}", wrong);
    return kUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError &e) { // or what --help asks for
    return app.exit(e) == 0 ? kDone : kUsage;
  }
  return kDone;
}

} // namespace

int run_program(int argc, char **argv, const std::function<void(CLI::App &)> &add_verbs) {
  return exit_status_of([&] { return run(argc, argv, add_verbs); });
}

} // namespace calendem
