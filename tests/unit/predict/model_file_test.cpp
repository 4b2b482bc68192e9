// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "base/provenance.h"
#include "predict/files.h"
#include "support/made_coatings.h"
#include "support/page.h"
#include "support/test_folder.h"
#include <filesystem>
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;

/// The made bank on disk.
std::string bank_on_disk(const std::filesystem::path &folder) {
  namespace fs = std::filesystem;
  const fs::path source = CALENDEM_SOURCE_DIR, films = source / "input_scripts/cases/films",
                 support = source / "tests/support";
  fs::create_directories(folder / "films");
  for (const fs::path &file :
       {films / "electrode.toml", films / "crushing.csv", support / "made_case.toml"})
    fs::copy(file, folder / "films" / file.filename());
  std::string text = text_of_file((support / "made_coatings.toml").string());
  const std::string there = "../../input_scripts/cases/films/";
  for (auto at = text.find(there); at != std::string::npos; at = text.find(there))
    text.erase(at, there.size());
  const std::string file = (folder / "films/bank.toml").string(),
                    table = (folder / "films/bank.csv").string();
  write_file(file, text);
  write_file(table, bank::write_runs(made_coatings()));
  write_file((folder / "films/bank.fit.json").string(),
             "{\"table\": \"" + hash_of_file(table) + "\", \"groups\": " +
                 text_of_file((support / "made_coatings.fit.json").string()) + "}");
  return file;
}

struct OnDisk {
  std::filesystem::path folder = test_folder();
  std::string bank_file = bank_on_disk(folder);
  FilmBank bank{bank_file};
  Calibration calibration;
  std::string file = (folder / "model.json").string();

  OnDisk() {
    Random random(1, 2);
    calibration.error = {0.01, 0.001, 0.02};
    measure({}, made_film("a", 48.0, 2.0), {80.0, 150.0}, 0.002, random, calibration);
    measure({}, made_film("b", 43.0, 2.5), {50.0}, 0.002, random, calibration);
    CalibrationSettings settings;
    settings.samples = 256;
    settings.draws = 50;
    calibrate(bank, settings, calibration);
    write_file(
        file,
        to_json(bank, calibration, left_out(bank, calibration, settings), folder.string()).dump(1));
  }
};

std::string refusal(const std::string &file) {
  try {
    read_model(file);
  } catch (const Failure &f) {
    return f.exit_status() == kBadInput ? f.what() : "another exit status";
  }
  return "";
}

TEST(ModelFile, ReadsBackWhatWasWritten) {
  const OnDisk d;
  const Model m = read_model(d.file);
  const Film film = made_film("new", 45.0, 2.2);
  const Band before = predicted(d.bank, d.calibration, film, {100.0}, 0.0).after[0],
             after = predicted(m.bank, m.calibration, film, {100.0}, 0.0).after[0];
  EXPECT_NEAR(before.median, after.median, 1e-9);
  EXPECT_NEAR(before.low90, after.low90, 1e-9);
  EXPECT_EQ(m.json["left_out"].size(), 3u);
}

TEST(ModelFile, MovesWithItsBank) {
  namespace fs = std::filesystem;
  const OnDisk d;
  const fs::path moved = d.folder / "moved";
  fs::create_directory(moved);
  fs::rename(d.folder / "films", moved / "films");
  EXPECT_NE(refusal(d.file).find("films/bank.toml is not there"), std::string::npos);
  fs::rename(d.file, moved / "model.json");
  EXPECT_EQ(refusal((moved / "model.json").string()), "");
}

TEST(ModelFile, EveryMaterialIsReadBackAndHasItsCase) {
  OnDisk d;
  d.calibration.materials = {"first", "second"};
  d.calibration.films[1].material = 1;
  CalibrationSettings settings;
  settings.samples = 256;
  settings.draws = 50;
  calibrate(d.bank, settings, d.calibration);
  write_file(d.file, to_json(d.bank, d.calibration, {}, d.folder.string()).dump(1));
  const Model m = read_model(d.file);
  EXPECT_EQ(m.calibration.materials, d.calibration.materials);
  EXPECT_EQ(m.calibration.films[1].material, 1);
  ASSERT_EQ(m.calibration.draws[7].materials.size(), 3u);
  EXPECT_EQ(m.calibration.draws[7].alike, d.calibration.draws[7].alike);
  EXPECT_EQ(m.calibration.draws[7].materials[2].parameters,
            d.calibration.draws[7].materials[2].parameters);
  EXPECT_NE(case_of(m.bank, m.calibration, 0), case_of(m.bank, m.calibration, 1));
  EXPECT_NE(case_of(m.bank, m.calibration, 1).find("calibration, second"), std::string::npos);
  nlohmann::ordered_json lacks = m.json;
  lacks["draws"][7]["materials"].erase(1);
  write_file(d.file, lacks.dump(1));
  EXPECT_NE(refusal(d.file).find("2 materials; it must have 3"), std::string::npos);
}

TEST(ModelFile, WhatIsNoModelOrHasAnotherBankIsRefused) {
  const OnDisk d;
  const std::string whole = text_of_file(d.file);
  EXPECT_NE(refusal((d.folder / "none.json").string()).find("not there"), std::string::npos);
  write_file(d.file, whole.substr(0, whole.size() / 2));
  EXPECT_NE(refusal(d.file).find("cut or damaged"), std::string::npos);
  write_file(d.file, "{}");
  EXPECT_NE(refusal(d.file).find("no model of calendem calibrate"), std::string::npos);
  write_file(d.file, whole);
  EXPECT_EQ(refusal(d.file), "");
  std::string other = whole; // a film of a material that is not there
  other.replace(other.find("\"material\": 0"), 13, "\"material\": 7");
  write_file(d.file, other);
  EXPECT_NE(refusal(d.file).find(d.file + ": a film's material is 7"), std::string::npos);
  other = whole;
  other.replace(other.find("\"sd\": "), 6, "\"sd\": -");
  write_file(d.file, other);
  EXPECT_NE(refusal(d.file).find("Was it edited?"), std::string::npos) << refusal(d.file);
  write_file(d.file, whole);
  for (const char *file :
       {"electrode.toml", "made_case.toml", "crushing.csv"}) { // that the bank reads
    const std::string name = (d.folder / "films" / file).string(), text = text_of_file(name);
    write_file(name, text + "\n");
    EXPECT_NE(refusal(d.file).find(std::string(file) + " is not there or has changed"),
              std::string::npos)
        << refusal(d.file);
    write_file(name, text);
  }
  const std::string table = bank::table_of(d.bank.spec());
  write_file(table, text_of_file(table) + "\n");
  EXPECT_NE(refusal(d.file).find("has changed since"), std::string::npos);
}

TEST(ModelFile, TheCaseIsOneThatRunTakes) {
  const OnDisk d;
  const std::string text = case_of(d.bank, d.calibration, 0);
  for (const char *part : {"[material.am]", "youngs_modulus_GPa = ", "[bond]",
                           "tensile_strength_MPa = ", "shear_strength_MPa = "})
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

// A bank's collapse, bonds and materials need not be those of the defaults: whoever runs the case
// gets the bank's, but for what the calibration moves and what belongs to its runs alone.
TEST(ModelFile, TheCaseHasTheBanksSettingsOfItsEffect) {
  bank::Runs runs = made_coatings();
  runs.bank.case_file = (test_folder() / "case.toml").string();
  write_file(runs.bank.case_file,
             text_of_file(CALENDEM_SOURCE_DIR "/tests/support/made_case.toml") +
                 "\n[effects.cbd_collapse]\nfloor_nanoporosity = 0\nhardening_MPa = "
                 "10\n[bond]\nsurface_inset_um = 0.1\ntensile_strength_MPa = 600\n"
                 "contact_diameter = \"lattice\"\n"
                 "[material.cbd]\nfriction = 0.2\n");
  const FilmBank bank = film_bank_of(runs);
  Calibration c;
  c.draws = {{{{{190.0, 2.4, 480.0}, {{kCollapses, 0.5}}}}, {0.001, 0.5}}};
  const std::string text = case_of(bank, c, 0);
  for (const char *part :
       {"[effects.cbd_collapse]", "floor_nanoporosity = 0\n", "hardening_MPa = 10\n",
        "yield_pressure_MPa = ", "surface_inset_um = 0.1\n", "\nfriction = 0.2\n",
        "\ntensile_strength_MPa = 480\n", "contact_diameter = \"lattice\"\n",
        // what an electrode's own material would say otherwise
        "ced_J_m3 = 600000000\n", "[effects.nmc_plasticity]\nyield_pressure_GPa = 0\n"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  for (const char *part : {"tensile_strength_MPa = 600", "[platen]", "[output]"})
    EXPECT_EQ(text.find(part), std::string::npos) << text;
}

TEST(Pages, AreWholeAndHoldTheirNumbers) {
  const OnDisk d;
  const Model m = read_model(d.file);
  const std::string model = model_page(m.bank, m.calibration, m.json);
  const Film film = made_film("new", 45.0, 2.2);
  std::vector<PredictedFilm> films = {predicted(m.bank, m.calibration, film, {50.0, 100.0}, 0.0)};
  nlohmann::ordered_json json = to_json(m.bank, films), designs;
  json["provenance"] = {{"model", "my/model.json"}};
  const std::string page = prediction_page(m.calibration, films, json);
  const Target target = {0.3, 0.01, 0.2};
  Design design;
  design.film = film;
  design.chances = chances(m.bank, m.calibration, film, {50.0, 100.0}, 0.0, target);
  design.predicted = films[0];
  designs = to_json(m.bank, target, SetBy::Pressure, {design});
  designs["provenance"] = json["provenance"];
  const std::string designed = design_page(target, SetBy::Pressure, {design}, designs);
  for (const std::string *text : {&model, &page, &designed}) {
    const std::string bare = without_scripts(*text);
    EXPECT_EQ(bare.find("{{"), std::string::npos);
    EXPECT_EQ(bare.find("http"), std::string::npos);
  }
  EXPECT_NE(model.find("<td>bank: table hash</td>"), std::string::npos);
  for (const std::string *text : {&page, &designed})
    EXPECT_NE(text->find("<td>model</td><td class=\"file\">my/model.json</td>"), std::string::npos);
  EXPECT_NE(model.find("Every film left out in turn"), std::string::npos);
  EXPECT_NE(designed.find("30 ± 1 % porosity with fewer than 20 % cracked"), std::string::npos);
  const std::string table = prediction_table(m.bank, films);
  EXPECT_EQ(table.substr(0, 60).find("film,porosity_before_percent,"), 0u);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
}

// The ends of an interval are as exact as its middle.
TEST(Pages, IntervalsHaveTheSameDecimals) {
  const OnDisk d;
  PredictedFilm film = predicted(d.bank, d.calibration, made_film("new", 45.0, 2.2), {50.0}, 0.0);
  film.after[0] = {0.3004, 0.29, 0.31, 0.28, 0.322};
  film.cracked[0] = {0.381, 0.2, 0.5, 0.09, 1.0};
  const auto json = to_json(d.bank, {film});
  const std::string page = prediction_page(d.calibration, {film}, json);
  EXPECT_NE(page.find(">30.0 (28.0 to 32.2)<"), std::string::npos);
  EXPECT_NE(page.find(">38 (9 to 100)<"), std::string::npos);
}

} // namespace
