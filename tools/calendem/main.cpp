// SPDX-License-Identifier: GPL-2.0-or-later
// The command line. Exit status: 0 done, 1 usage, 2 bad input, 3 the simulation failed, 4 a check
// did not hold.
#include "base/messages.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/core.h>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>

int main(int argc, char **argv) {
  CLI::App app{"Calendering of battery electrodes: pack an electrode, press it, report."};
  app.require_subcommand(1);
  app.set_version_flag("--version", calendem::version());
  calendem::add_dry_verb(app);
  calendem::add_pack_verb(app);
  calendem::add_run_verb(app);
  calendem::add_collect_verb(app);
  calendem::add_measure_verb(app);
  calendem::add_report_verb(app);
  calendem::add_compare_verb(app);
  calendem::add_sample_verb(app);
  calendem::add_study_verb(app);
  calendem::add_bank_verb(app);
  calendem::add_diagnose_verb(app);
  calendem::add_calibrate_verb(app);
  calendem::add_predict_verb(app);
  calendem::add_design_verb(app);
  calendem::add_withheld_verb(app);
  calendem::add_effects_verb(app);
  calendem::add_registry_verb(app);
  calendem::add_tomogram_verb(app);
  calendem::add_validate_verb(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success &e) {
    return app.exit(e);
  } catch (const CLI::ParseError &e) {
    app.exit(e);
    return calendem::kUsage;
  } catch (const calendem::Failure &e) {
    fmt::print(stderr, "{}\n", e.what());
    return e.exit_status();
  } catch (const std::bad_alloc &) {
    fmt::print(stderr,
               "not enough memory. Take a smaller cell or image, or a machine with more.\n");
    return calendem::kBadInput;
  } catch (const nlohmann::json::exception &e) {
    fmt::print(stderr,
               "a JSON file is not as calendem writes it ({}). Was it edited, or made by "
               "another version? Make it again.\n",
               e.what());
    return calendem::kBadInput;
  } catch (const std::exception &e) {
    fmt::print(stderr, "calendem: {}\n", e.what());
    return calendem::kBadInput;
  }
  if (std::fflush(stdout) != 0 || !std::cout.flush()) {
    fmt::print(stderr, "the output could not be written. Is the disk full?\n");
    return calendem::kBadInput;
  }
  return calendem::kDone;
}
