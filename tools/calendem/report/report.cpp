// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/report.h"
#include "base/provenance.h"

#include "base/file_hash.h"
#include "report/explorer.h"
#include "report/fracture_part.h"
#include "report/fracture_pictures.h"
#include "report/plots.h"
#include "report/structure_part.h"
#include "report/tables.h"
#include "report/validity_part.h"

namespace calendem::report {
namespace {

using nlohmann::json;

RunPart part_of(Run &run) {
  RunPart part;
  part.pictures = draw_pictures(run); // may add notes
  part.stages = draw_stages(run);
  part.one_body = draw_one_body(run);
  part.studied_body = studied_body(run);
  part.explorer = explorer_of(run); // so may this
  part.name = run.name;
  part.unfinished = run.unfinished;
  part.headline = headline_of(run);
  part.facts = facts_of(run.summary, {"provenance", "contact_range"});
  part.electrode =
      facts_of(run.electrode, {"provenance", "recipe", "sphericity_histogram", "identity"});
  part.structure = structure_table(run);
  part.validity = validity_table(run);
  part.provenance = facts_of(run.summary.value("provenance", json::object()), {});
  part.files = json::array();
  for (const auto &file : run.files_read)
    part.files.push_back({{"file", file}, {"sha256", sha256_of_file(file)}});
  part.notes = run.notes;
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
  for (const auto &note : run.notes)
    notes.push_back({{"file", note.file}, {"what", note.what}, {"remedy", note.remedy}});
  return {{"name", run.name},
          {"status", run.unfinished.empty() ? "finished" : "unfinished"},
          {"unfinished", run.unfinished},
          {"headline", run.headline},
          {"facts", run.facts},
          {"electrode", run.electrode},
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

} // namespace

Report make_report(std::vector<Run> runs, const std::string &command) {
  Report report;
  report.comparison = comparison_of(runs);
  report.charts = plots_of(runs);
  for (auto &run : runs) {
    report.runs.push_back(part_of(run));
    report.title += (report.title.empty() ? "" : ", ") + run.name;
  }
  report.provenance = {
      {"program", "calendem report"}, {"version", version()}, {"command", command}, {"format", 1}};
  return report;
}

json to_json(const Report &report) {
  json runs = json::array(), charts = json::array();
  bool unfinished = false;
  for (const auto &run : report.runs) {
    runs.push_back(to_json(run));
    unfinished = unfinished || !run.unfinished.empty();
  }
  for (const auto &chart : report.charts)
    charts.push_back(to_json(chart));
  return {{"title", report.title},
          {"status", unfinished ? "unfinished" : "finished"},
          {"provenance", report.provenance},
          {"comparison", report.comparison},
          {"runs", runs},
          {"charts", charts}};
}

} // namespace calendem::report
