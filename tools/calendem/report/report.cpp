// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/report.h"
#include "base/material_notes.h"
#include "base/provenance.h"
#include "measure/run_directory.h"
#include "report/page.h"
#include "report/pictures.h"
#include "report/plots.h"
#include "report/tables.h"
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <set>

namespace calendem {
extern const char *const kPageHtml;
}

namespace calendem::report {

namespace {

using nlohmann::json;

RunPart part_of(Run &run, const json &comparison) {
  RunPart part;
  part.pictures = draw_pictures(run); // may add notes
  part.stages = draw_stages(run);
  part.one_body = draw_one_body(run);
  part.studied_body = studied_body(run);
  part.explorer = explorer_of(run); // so may this
  part.name = run.name;
  part.unfinished = run.unfinished;
  part.headline = headline_of(run);
  part.verdict = verdict_of(run, part.headline, comparison);
  part.facts = facts_of(run.summary, {"provenance", "contact_range"});
  part.electrode =
      facts_of(run.electrode, {"provenance", "recipe", kRecipeGiven, "sphericity_histogram",
                               "identity", "sources", "material", kMaterialNotes});
  part.material = material_table(run);
  part.structure = structure_table(run);
  part.validity = validity_table(run);
  part.provenance = facts_of(run.summary.value("provenance", json::object()), {});
  part.files = json::array();
  for (const auto &file : run.files_read)
    part.files.push_back({{"file", file}, {"sha256", sha256_of_file(file)}});
  for (const std::string &warning : warnings_of_electrode(run.electrode))
    part.notes.add("electrode.json", warning, "");
  part.notes.add(run.notes);
  return part;
}

json to_json(const Picture &picture) {
  return {{"moment", picture.moment},
          {"subject", picture.subject},
          {"time_us", picture.time_us},
          {"pressure_MPa", picture.pressure_MPa},
          {"broken_fraction", picture.broken_fraction},
          {"file", picture.file},
          {"pixels_per_um", picture.pixels_per_um},
          {"bonds_across_faces", picture.across_faces}};
}

json to_json(const std::vector<Picture> &list) {
  json pictures = json::array();
  for (const auto &picture : list)
    pictures.push_back(to_json(picture));
  return pictures;
}

json to_json(const RunPart &run) {
  json notes = json::array();
  for (const Mistake &note : run.notes.list())
    notes.push_back({{"file", note.file}, {"what", note.what}, {"remedy", note.remedy}});
  return {{"name", run.name},
          {"status", run.unfinished.empty() ? "finished" : "unfinished"},
          {"unfinished", run.unfinished},
          {"headline", run.headline},
          {"verdict", run.verdict},
          {"facts", run.facts},
          {"electrode", run.electrode},
          {"material", run.material},
          {"structure", run.structure},
          {"validity", run.validity},
          {"provenance", run.provenance},
          {"files", run.files},
          {"notes", notes},
          {"pictures", to_json(run.pictures)},
          {"stages", to_json(run.stages)},
          {"studied_body", run.studied_body},
          {"one_body", to_json(run.one_body)}};
}

/// The recipe's name, where the electrode has one.
std::string title_of(const Run &run) {
  return run.electrode.is_object() ? run.electrode.value("name", run.name) : run.name;
}

} // namespace

Report make_report(std::vector<Run> runs, const std::string &command) {
  Report report;
  report.comparison = comparison_of(runs);
  report.charts = plots_of(runs);
  for (auto &run : runs) {
    report.title +=
        (report.title.empty() ? "" : ", ") + (runs.size() == 1 ? title_of(run) : run.name);
    report.runs.push_back(part_of(run, report.comparison));
  }
  report.provenance = {
      {"program", "calendem report"}, {"version", version()}, {"command", command}, {"format", 1}};
  return report;
}

namespace {

json json_of(const Report &report) {
  json runs = json::array();
  bool unfinished = false;
  for (const auto &run : report.runs) {
    runs.push_back(to_json(run));
    unfinished = unfinished || !run.unfinished.empty();
  }
  return {{"title", report.title},
          {"status", unfinished ? "unfinished" : "finished"},
          {"provenance", report.provenance},
          {"comparison", report.comparison},
          {"runs", runs}};
}

json drawn(const Picture &picture, const std::string &label) {
  constexpr double kEdge = 12; // px between scale bar and the picture's edge
  const double length = picture.scale_bar_um * picture.pixels_per_um;
  return {{"label", label},
          {"moment", picture.moment},
          {"time", shown(picture.time_us, 2)},
          {"pressure", shown(picture.pressure_MPa, 1)},
          {"broken", shown(100 * picture.broken_fraction, 1)},
          {"width", picture.width},
          {"height", picture.height},
          {"total_height", picture.height + 34},
          {"png", picture.png},
          {"outlines", picture.outlines},
          {"bar_um", picture.scale_bar_um},
          {"bar_start", kEdge},
          {"bar_end", kEdge + length},
          {"bar_middle", kEdge + length / 2},
          {"bar_y", picture.height + 10},
          {"bar_text_y", picture.height + 28},
          {"across_faces", picture.across_faces > 0 ? json(picture.across_faces) : json(nullptr)}};
}

/// The pictures of one subject, as the template wants them; null: none.
json row_of(const std::vector<Picture> &pictures, const char *subject, const std::string &name,
            bool by_pressure) {
  json list = json::array();
  for (const auto &p : pictures)
    if (p.subject == subject)
      list.push_back(
          drawn(p, name + ": " + (by_pressure ? shown(p.pressure_MPa, 1) + " MPa" : p.moment)));
  return list.empty() ? json(nullptr) : json{{"list", list}};
}

/// A row of pictures for every subject that has some.
json rows_of(const std::vector<Picture> &pictures,
             std::initializer_list<std::pair<const char *, const char *>> subjects) {
  json rows = json::array();
  for (const auto &[subject, name] : subjects)
    if (json row = row_of(pictures, subject, name, true); !row.is_null())
      rows.push_back(std::move(row));
  return rows;
}

/// What the page draws of a run, but the JSON twin leaves out.
void add_pictures(const RunPart &part, json &run) {
  run["facts_table"] = !part.facts.empty();
  run["electrode_table"] = !part.electrode.empty();
  run["has_pictures"] = !part.pictures.empty();
  run["electrode_pictures"] = row_of(part.pictures, "electrode", "Electrode", false);
  run["bond_pictures"] = row_of(part.pictures, "bonds", "Bonds", false);
  run["has_stages"] = !part.stages.empty();
  run["stage_rows"] = rows_of(part.stages, {{"electrode", "Electrode"}, {"bonds", "Bonds"}});
  run["has_one_body"] = !part.one_body.empty();
  run["body_rows"] = rows_of(part.one_body, {{"place", "Place of the particle"},
                                             {"shape", "Shape of the particle"},
                                             {"bonds", "Bonds of the particle"}});
  run["has_view"] = !part.explorer.is_null();
  run["view"] = in_script(part.explorer.dump());
}

} // namespace

Page page_of(const Report &report) {
  Page page{kPageHtml, json_of(report), {}, report.charts};
  page.values = {{"is_unfinished", page.json["status"] == "unfinished"},
                 {"several", report.runs.size() > 1},
                 {"provenance_rows", facts_of(report.provenance, {})},
                 {"runs", page.json["runs"]}};
  for (std::size_t i = 0; i < report.runs.size(); ++i) {
    add_pictures(report.runs[i], page.values["runs"][i]);
    if (!report.runs[i].explorer.is_null())
      page.values["scripts"] = {{"three", embedded::kThree},
                                {"orbit", embedded::kOrbitControls},
                                {"explorer", embedded::kExplorer}};
  }
  return page;
}

namespace {

namespace fs = std::filesystem;

std::string command_line(const std::vector<std::string> &directories, const std::string &page) {
  std::string command = "calendem report";
  for (const auto &directory : directories)
    command += " " + directory;
  return command + " -o " + page;
}

} // namespace

void write_report(const std::vector<std::string> &directories, std::string page) {
  Mistakes mistakes;
  std::vector<Run> runs;
  for (const auto &directory : directories)
    runs.push_back(read_run(directory, mistakes));
  mistakes.stop_if_any();
  make_names_unique(runs);
  if (page.empty())
    page = directories.size() == 1 ? (fs::path(directories[0]) / "report.html").string()
                                   : "report.html";
  const fs::path ending = fs::path(page).extension(), stem = fs::path(page).stem();
  const std::set<std::string> of_others = {"summary", "electrode", "structure",  "gap",
                                           "model",   "design",    "prediction", "shrink"};
  if (ending != ".html" || of_others.count(stem.string()))
    throw Failure(kBadInput, fmt::format("-o is '{}'. Give a name that ends in .html and is none "
                                         "of {}: the page's data go to the same name with .json.",
                                         page, fmt::join(of_others, ", ")));
  const Report report = make_report(std::move(runs), command_line(directories, page));
  for (const auto &run : report.runs) {
    for (const Mistake &note : run.notes.list())
      std::cerr << "note: " << text_of(note) << '\n';
    if (!run.unfinished.empty())
      std::cerr << "note: " << run.name << " is unfinished (" << run.unfinished
                << "); the report says so\n";
  }
  const fs::path twin = fs::path(page).replace_extension(".json");
  const Page contents = page_of(report);
  write_file(twin.string(), data_of(contents).dump(1) + "\n");
  write_file(page, to_html(contents));
  std::cout << comparison_text(report.comparison) << "report: " << page
            << "\ndata:   " << twin.string() << '\n';
}

} // namespace calendem::report
