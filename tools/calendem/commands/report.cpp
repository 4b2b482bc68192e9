// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/report.h"
#include "base/messages.h"
#include "commands/commands.h"
#include <CLI/CLI.hpp>
#include <memory>

namespace calendem {

void add_report_verb(CLI::App &app) {
  struct Options {
    std::vector<std::string> directories;
    std::string page, figures;
  };
  const auto options = std::make_shared<Options>();
  CLI::App *verb = app.add_subcommand(
      "report", "One self-contained page with plots and pictures of one or more runs");
  verb->add_option("DIR", options->directories, "Directories made by calendem run")
      ->required()
      ->type_name("");
  verb->add_option("-o,--output", options->page,
                   "Page to write; its data go to the same name with .json. Default: report.html "
                   "in the run's directory, or here if there are several")
      ->type_name("FILE.html");
  verb->add_option("--figures", options->figures, "Folder for every plot as a file (SVG) too")
      ->type_name("FOLDER");
  verb->callback([options] {
    const int status = report::write_report(options->directories, options->page, options->figures);
    if (status != 0)
      throw Failure(status, "calendem report: nothing was written");
  });
}

} // namespace calendem
