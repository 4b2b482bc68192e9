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

json to_json(const std::vector<Picture> &list) {
  json pictures = json::array();
  for (const Picture &p : list)
    pictures.push_back({{"moment", p.moment},
                        {"subject", p.subject},
                        {"time_us", p.time_us},
                        {"pressure_MPa", p.pressure_MPa},
                        {"broken_fraction", p.broken_fraction},
                        {"file", p.file},
                        {"pixels_per_um", p.pixels_per_um},
                        {"bonds_across_faces", p.across_faces}});
  return pictures;
}

/// The recipe's name, where the electrode has one.
std::string title_of(const Run &run) {
  return run.electrode.is_object() ? run.electrode.value("name", run.name) : run.name;
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

json files_of(const Run &run) {
  json files = json::array();
  for (const auto &file : run.files_read)
    files.push_back({{"file", file}, {"sha256", sha256_of_file(file)}});
  return files;
}

/// Notes of the run, those of its electrode first.
json notes_of(Run &run) {
  Mistakes all;
  for (const std::string &warning : warnings_of_electrode(run.electrode))
    all.add("electrode.json", warning, "");
  all.add(run.notes);
  run.notes = all;
  json notes = json::array();
  for (const Mistake &note : all.list())
    notes.push_back({{"file", note.file}, {"what", note.what}, {"remedy", note.remedy}});
  return notes;
}

struct Drawings {
  std::vector<Picture> pictures, stages, one_body; ///< the latter the paper's Figures 3 and 5
  json view;                                       ///< for the 3-D view; null: no frames
};

json twin_of(Run &run, const json &comparison, const Drawings &drawings) {
  const json headline = headline_of(run);
  return {{"name", run.name},
          {"status", run.unfinished.empty() ? "finished" : "unfinished"},
          {"unfinished", run.unfinished},
          {"headline", headline},
          {"verdict", verdict_of(run, headline, comparison)},
          {"facts", facts_of(run.summary, {"provenance", "contact_range", "presses"})},
          {"electrode",
           facts_of(run.electrode, {"provenance", "recipe", kRecipeGiven, "sphericity_histogram",
                                    "identity", "sources", "material", kMaterialNotes})},
          {"material", material_table(run)},
          {"structure", structure_table(run)},
          {"validity", validity_table(run)},
          {"provenance", facts_of(run.summary.value("provenance", json::object()), {})},
          {"files", files_of(run)},
          {"notes", notes_of(run)},
          {"pictures", to_json(drawings.pictures)},
          {"stages", to_json(drawings.stages)},
          {"studied_body", studied_body(run)},
          {"one_body", to_json(drawings.one_body)}};
}

/// What the page draws of a run, but the JSON twin leaves out.
void add_drawings(const Drawings &d, json &run) {
  run.update({{"facts_table", !run["facts"].empty()},
              {"electrode_table", !run["electrode"].empty()},
              {"has_pictures", !d.pictures.empty()},
              {"electrode_pictures", row_of(d.pictures, "electrode", "Electrode", false)},
              {"bond_pictures", row_of(d.pictures, "bonds", "Bonds", false)},
              {"has_stages", !d.stages.empty()},
              {"stage_rows", rows_of(d.stages, {{"electrode", "Electrode"}, {"bonds", "Bonds"}})},
              {"has_one_body", !d.one_body.empty()},
              {"body_rows", rows_of(d.one_body, {{"place", "Place of the particle"},
                                                 {"shape", "Shape of the particle"},
                                                 {"bonds", "Bonds of the particle"}})},
              {"has_view", !d.view.is_null()},
              {"view", in_script(d.view.dump())}});
}

} // namespace

Page page_of(std::vector<Run> &runs, const std::string &command) {
  const json comparison = comparison_of(runs), provenance = {{"program", "calendem report"},
                                                             {"version", version()},
                                                             {"command", command},
                                                             {"format", 1}};
  std::string title;
  json parts = json::array(), drawn = json::array();
  bool unfinished = false, view = false;
  std::vector<Chart> charts = plots_of(runs);
  for (Run &run : runs) {
    title += (title.empty() ? "" : ", ") + (runs.size() == 1 ? title_of(run) : run.name);
    const Drawings drawings = {draw_pictures(run), draw_stages(run), draw_one_body(run),
                               explorer_of(run)}; // they may add notes
    parts.push_back(twin_of(run, comparison, drawings));
    drawn.push_back(parts.back());
    add_drawings(drawings, drawn.back());
    unfinished = unfinished || !run.unfinished.empty();
    view = view || !drawings.view.is_null();
  }
  const json twin = {{"title", title},
                     {"status", unfinished ? "unfinished" : "finished"},
                     {"provenance", provenance},
                     {"comparison", comparison},
                     {"runs", parts}};
  Page page{kPageHtml, twin, {}, std::move(charts)};
  page.values = {{"is_unfinished", unfinished},
                 {"several", runs.size() > 1},
                 {"provenance_rows", facts_of(provenance, {})},
                 {"runs", drawn}};
  if (view)
    page.values["scripts"] = {{"three", embedded::kThree},
                              {"orbit", embedded::kOrbitControls},
                              {"explorer", embedded::kExplorer}};
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
    throw Failure(kBadInput,
                  "-o is '{}'. Give a name that ends in .html and is none of {}: the page's data "
                  "go to the same name with .json.",
                  page, fmt::join(of_others, ", "));
  const Page contents = page_of(runs, command_line(directories, page));
  for (const Run &run : runs) {
    for (const Mistake &note : run.notes.list())
      std::cerr << "note: " << text_of(note) << '\n';
    if (!run.unfinished.empty())
      std::cerr << "note: " << run.name << " is unfinished (" << run.unfinished
                << "); the report says so\n";
  }
  const fs::path twin = fs::path(page).replace_extension(".json");
  write_file(twin.string(), data_of(contents).dump(1) + "\n");
  write_file(page, to_html(contents));
  std::cout << comparison_text(json(contents.json["comparison"])) << "report: " << page
            << "\ndata:   " << twin.string() << '\n';
}

} // namespace calendem::report
