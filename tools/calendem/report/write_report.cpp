// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/report.h"

#include <filesystem>
#include <fstream>
#include <iostream>

#include "base/messages.h"
#include "measure/run_directory.h"
#include "report/page.h"
#include "report/tables.h"

namespace calendem::report {
namespace {

namespace fs = std::filesystem;

void print(const char *kind, const Problem &problem) {
  std::cerr << "calendem report: " << kind << ": " << problem.file << ": " << problem.what
            << "\n  what to do: " << problem.remedy << '\n';
}

bool write(const fs::path &file, const std::string &text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (out)
    return true;
  print("error", {file.string(), "cannot be written", "check the folder, its rights and the disk"});
  return false;
}

std::string command_line(const std::vector<std::string> &directories, const std::string &page) {
  std::string command = "calendem report";
  for (const auto &directory : directories)
    command += " " + directory;
  return command + " -o " + page;
}

} // namespace

int write_report(const std::vector<std::string> &directories, std::string page,
                 const std::string &figures) {
  Problems problems;
  std::vector<Run> runs;
  for (const auto &directory : directories)
    runs.push_back(read_run(directory, problems));
  for (const auto &problem : problems)
    print("error", problem);
  if (!problems.empty())
    return kBadInput;
  make_names_unique(runs);
  if (page.empty())
    page = directories.size() == 1 ? (fs::path(directories[0]) / "report.html").string()
                                   : "report.html";
  const Report report = make_report(std::move(runs), command_line(directories, page));
  for (const auto &run : report.runs) {
    for (const auto &note : run.notes)
      print("note", note);
    if (!run.unfinished.empty())
      std::cerr << "calendem report: note: " << run.name << " is unfinished (" << run.unfinished
                << "); the report says so\n";
  }
  const fs::path twin = fs::path(page).replace_extension(".json");
  if (!write(twin, to_json(report).dump(1) + "\n") || !write(page, to_html(report)))
    return kBadInput;
  if (!figures.empty())
    fs::create_directories(figures);
  for (const Chart &chart : report.charts)
    if (!figures.empty() && !write(figures + "/" + chart.id + ".svg", to_svg_file(chart)))
      return kBadInput;
  std::cout << comparison_text(report.comparison) << "report: " << page
            << "\ndata:   " << twin.string() << '\n';
  return kDone;
}

} // namespace calendem::report
