// SPDX-License-Identifier: GPL-2.0-or-later
// The verb on whole (made-up) run directories.
#include "commands/commands.h"
#include "report/report.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/messages.h"
#include "support/make_run.h"
#include "support/page.h"
#include "support/test_folder.h"

namespace fs = std::filesystem;
using calendem::report::write_report;
using calendem::tests::MadeRun;
using calendem::tests::make_run;

namespace {

std::string contents(const fs::path &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

class WriteReport : public ::testing::Test {
protected:
  void SetUp() override {
    small_.bodies = 4;
    small_.rows = 60;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const char *name) const { return (folder_ / name).string(); }
  nlohmann::json twin(const char *name) const {
    return nlohmann::json::parse(contents(folder_ / name));
  }
  /// The message with which the directories are refused; nothing may be written.
  std::string refusal(const std::vector<std::string> &directories) const {
    try {
      write_report(directories, path("r.html"));
      ADD_FAILURE() << "accepted";
    } catch (const calendem::Failure &failure) {
      EXPECT_EQ(failure.exit_status(), calendem::kBadInput);
      EXPECT_FALSE(fs::exists(path("r.html")));
      return failure.what();
    }
    return "";
  }

  const fs::path folder_ = calendem_test::test_folder();
  MadeRun small_;
};

} // namespace

// Requirement: the page needs no other file and no network; the twin carries the same figures.
TEST_F(WriteReport, PageIsSelfContained) {
  make_run(path("run"), small_);
  write_report({path("run")}, "");
  const std::string page = contents(folder_ / "run" / "report.html");
  const std::string plain = calendem_test::without_scripts(page);
  for (const char *outside : {"http://", "https://", "src=", "@import", "url(h", "{{"})
    EXPECT_EQ(plain.find(outside), std::string::npos) << outside;
  const auto json = twin("run/report.json");
  EXPECT_EQ(calendem_test::data_in(page), json);
  for (const auto &chart : json["charts"])
    EXPECT_NE(plain.find("data-chart=\"" + chart["id"].get<std::string>() + "\""),
              std::string::npos);
  std::size_t pictures = 0;
  for (auto at = page.find("data:image/png"); at != std::string::npos;
       at = page.find("data:image/png", at + 1))
    ++pictures;
  const std::size_t stages = 5; // the paper's pressures, all below 150 MPa
  EXPECT_EQ(pictures, 6u + 2 * stages + 1 + 2 * stages);
  EXPECT_EQ(json["status"], "finished");
  EXPECT_EQ(json["charts"].size(), 15u);
  EXPECT_EQ(json["runs"][0]["pictures"].size(), 6u);
  EXPECT_EQ(json["runs"][0]["stages"].size(), 2 * stages);
  EXPECT_NEAR(json["runs"][0]["headline"][0]["value"].get<double>(), 150, 1);
  EXPECT_EQ(json["runs"][0]["files"][0]["sha256"].get<std::string>().size(), 64u);
}

// Requirement: same inputs, same bytes.
TEST_F(WriteReport, IsReproducible) {
  make_run(path("run"), small_);
  write_report({path("run")}, path("r.html"));
  const std::string first = contents(path("r.html"));
  write_report({path("run")}, path("r.html"));
  EXPECT_EQ(first, contents(path("r.html")));
}

// Requirement: the comparison stands beside the paper's numbers, for every run.
TEST_F(WriteReport, ComparesWithThePaper) {
  make_run(path("a"), small_);
  small_.max_pressure_MPa = 80;
  make_run(path("b"), small_);
  write_report({path("a"), path("b") + "/"}, path("r.html"));
  const auto json = twin("r.json");
  EXPECT_EQ(json["runs"][1]["name"], "b");
  const auto &rows = json["comparison"]["rows"];
  ASSERT_EQ(rows.size(), 10u);
  EXPECT_DOUBLE_EQ(rows[1]["paper"], 27.75);
  EXPECT_TRUE(rows[1]["cells"][0]["value"].is_null()); // a went to 150 MPa
  EXPECT_FALSE(rows[1]["cells"][1]["value"].is_null());
  EXPECT_NEAR(rows[2]["cells"][0]["difference"], rows[2]["cells"][0]["value"].get<double>() - 25.17,
              1e-9);
  EXPECT_TRUE(rows[9]["cells"][1]["value"].is_null()); // b never sees 146 MPa
}

// Requirement: the first screen says how the run stands beside the measurement, and which limits of
// the model's validity it exceeds; what a label stands for is told where one points at it.
TEST_F(WriteReport, BeginsWithAVerdict) {
  make_run(path("run"), small_);
  write_report({path("run")}, path("r.html"));
  const auto json = twin("r.json"), run = json["runs"][0];
  const double z = json["comparison"]["rows"][2]["cells"][0]["z"];
  EXPECT_EQ(run["verdict"][0]["kind"], std::fabs(z) <= 2 ? "good" : "bad");
  const std::string verdict = run["verdict"][0]["text"], expected = std::fabs(z) <= 2 ? "agrees"
                                                                    : z > 0           ? "too porous"
                                                                                      : "too dense";
  EXPECT_EQ(verdict.rfind("Table 1 of the paper, 150 MPa: " + expected, 0), 0u) << verdict;
  std::size_t exceeded = 0;
  for (const auto &figure : run["headline"]) {
    EXPECT_NE(figure["means"], "") << figure["label"];
    exceeded += figure["exceeded"].get<bool>() ? 1 : 0;
    if (figure["remark"] == "above 5 MPa; limit 5 %")
      EXPECT_EQ(figure["exceeded"], figure["value"].get<double>() > 5);
  }
  EXPECT_EQ(run["verdict"].size(), 1 + exceeded);
  EXPECT_GT(exceeded, 0u); // 15 % of the force is beyond the range of its law
  const std::string page = contents(path("r.html"));
  EXPECT_LT(page.find("class=\"verdict\""), page.find("<table"));
  EXPECT_NE(page.find("<div class=\"exceeded\">"), std::string::npos);
}

// Requirement: the page reports how far contacts are beyond the range of their law; twin and page
// agree, and what a run does not know is a dash.
TEST_F(WriteReport, ShowsTheRangeOfTheContactLaw) {
  make_run(path("run"), small_);
  write_report({path("run")}, path("r.html"));
  const auto json = twin("r.json"), rows = json["runs"][0]["validity"]["rows"];
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0]["cells"][1]["text"], "44.00");
  EXPECT_EQ(rows[0]["cells"][8]["text"], "42.9");
  EXPECT_DOUBLE_EQ(rows[0]["cells"][8]["value"], 0.429);
  EXPECT_EQ(rows[1]["cells"][0]["text"], "–"); // no contacts between active material
  const std::string page = contents(path("r.html"));
  for (const char *text :
       {"Validity of the contact law", "42.9", "beyond 0.2 R", "Inertial number × 1000"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
}

// Requirement: an unfinished run gets a report that says so.
TEST_F(WriteReport, UnfinishedIsMarked) {
  small_.finished = false;
  make_run(path("run"), small_);
  std::ofstream(path("run/curve.csv"), std::ios::app) << "20.1,compre"; // being written
  write_report({path("run")}, path("r.html"));
  EXPECT_EQ(twin("r.json")["status"], "unfinished");
  EXPECT_NE(contents(path("r.html")).find(">unfinished<"), std::string::npos);
}

// Requirement: without frames there is a report without pictures, and a note.
TEST_F(WriteReport, WithoutFrames) {
  small_.frames = false;
  make_run(path("run"), small_);
  write_report({path("run")}, path("r.html"));
  EXPECT_EQ(twin("r.json")["runs"][0]["notes"].size(), 3u);
}

// Requirement: a truncated frame is a note that names the file, not a crash.
TEST_F(WriteReport, TruncatedFrame) {
  make_run(path("run"), small_);
  fs::resize_file(folder_ / "run/vtk/bonds_0.vtp", 700);
  write_report({path("run")}, path("r.html"));
  EXPECT_NE(twin("r.json")["runs"][0]["notes"].dump().find("bonds_0.vtp"), std::string::npos);
}

// Requirement: bad input names the file, what is wrong and what to do; nothing is written; exit 2.
TEST_F(WriteReport, NoDirectory) {
  EXPECT_NE(refusal({path("nowhere")}).find("no such directory"), std::string::npos);
}

TEST_F(WriteReport, MissingCurve) {
  fs::create_directories(path("run"));
  std::ofstream(path("run/curve_raw.csv")) << "step\n";
  const std::string message = refusal({path("run")});
  EXPECT_NE(message.find("curve.csv"), std::string::npos);
  EXPECT_NE(message.find("--resume"), std::string::npos);
}

TEST_F(WriteReport, MissingColumns) {
  make_run(path("run"), small_);
  std::ofstream(path("run/curve.csv")) << "time_us,stage\n0,compression\n1,relaxation\n";
  EXPECT_NE(refusal({path("run")}).find("broken_torsion"), std::string::npos);
}

TEST_F(WriteReport, TruncatedCurveOfAFinishedRun) {
  make_run(path("run"), small_);
  fs::resize_file(folder_ / "run/curve.csv", fs::file_size(path("run/curve.csv")) - 60);
  EXPECT_NE(refusal({path("run")}).find("line 61 is cut short"), std::string::npos);
}

TEST_F(WriteReport, TruncatedSummary) {
  make_run(path("run"), small_);
  fs::resize_file(folder_ / "run/summary.json", 100);
  EXPECT_NE(refusal({path("run")}).find("summary.json"), std::string::npos);
}

TEST_F(WriteReport, TruncatedElectrode) {
  make_run(path("run"), small_);
  fs::resize_file(folder_ / "run/electrode.json", 40);
  EXPECT_NE(refusal({path("run")}).find("electrode.json: cut or damaged"), std::string::npos);
}

TEST_F(WriteReport, NotANumber) {
  make_run(path("run"), small_);
  std::string curve = contents(path("run/curve.csv"));
  curve.replace(curve.find("compression,0,"), 14, "compression,nan,");
  std::ofstream(path("run/curve.csv")) << curve;
  EXPECT_NE(refusal({path("run")}).find("displacement_um, row 1: not a number"), std::string::npos);
}

// Requirement: through the command line the exit status is 2 too.
TEST_F(WriteReport, VerbFailsWithStatus) {
  CLI::App app;
  calendem::add_report_verb(app);
  try {
    app.parse("report " + path("nowhere"));
    ADD_FAILURE() << "accepted";
  } catch (const calendem::Failure &failure) {
    EXPECT_EQ(failure.exit_status(), calendem::kBadInput);
  }
}

// Requirement: all mistakes of all runs at once.
TEST_F(WriteReport, AllMistakesAtOnce) {
  const std::string message = refusal({path("x"), path("y")});
  EXPECT_NE(message.find(path("x")), std::string::npos);
  EXPECT_NE(message.find(path("y")), std::string::npos);
}
