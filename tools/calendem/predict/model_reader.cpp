// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "base/provenance.h"
#include "predict/files.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {

using Json = nlohmann::ordered_json;

const char *name_of(FilmNumber number) {
  constexpr const char *kNames[kFilmNumbers] = {
      "porosity_after", "springback",         "cracked",         "log_modulus",
      "broken",         "inverse_tortuosity", "cbd_nanoporosity"};
  return kNames[int(number)];
}

const char *reading_in_words(const std::string &name) {
  return name == name_of(FilmNumber::PorosityAfter) ? "porosity after release"
         : name == name_of(FilmNumber::Cracked)     ? "cracked particles"
                                                    : "nanoporosity after release";
}

namespace {

FilmNumber number_of(const std::string &name) {
  for (int k = 0; k < kFilmNumbers; ++k)
    if (name == name_of(FilmNumber(k)))
      return FilmNumber(k);
  throw Failure(kBadInput, fmt::format("number '{}' is unknown.", name));
}

Material material_of(const FilmBank &bank, const Json &row) {
  Material out;
  for (const inference::Parameter &p : bank.material()) {
    out.parameters.push_back(row.at(p.name));
    if (const double value = out.parameters.back(); !(value >= p.prior.a && value <= p.prior.b))
      throw Failure(kBadInput, fmt::format("a draw's {} is {:g}; the bank has {:g} to {:g}.",
                                           p.name, value, p.prior.a, p.prior.b));
  }
  for (const auto &[name, amplitude] : row.at("effects").items()) {
    const auto &all = bank.effects();
    const auto of =
        std::find_if(all.begin(), all.end(), [&n = name](const auto &e) { return e.name == n; });
    if (of == all.end())
      throw Failure(kBadInput, fmt::format("effect '{}' is none of the bank's.", name));
    out.effects.push_back({int(of - all.begin()), amplitude});
  }
  return out;
}

Draw draw_of(const FilmBank &bank, const Json &row, std::size_t materials) {
  Draw out;
  out.missed = {row.at("missed_sd"), row.at("missed_shared")};
  out.alike = row.at("alike");
  for (const Json &of : row.at("materials"))
    out.materials.push_back(material_of(bank, of));
  if (out.materials.size() != materials)
    throw Failure(kBadInput, fmt::format("a draw has {} materials; it must have {}.",
                                         out.materials.size(), materials));
  return out;
}

Calibration calibration_of(const FilmBank &bank, const Json &json) {
  Calibration out;
  out.materials = json.at("materials").get<std::vector<std::string>>();
  for (const Json &row : json.at("films")) {
    Film f;
    f.name = row.at("name");
    f.material = row.at("material");
    if (f.material < 0 || f.material >= int(out.materials.size()))
      throw Failure(kBadInput, fmt::format("a film's material is {}; there are {}.", f.material,
                                           out.materials.size()));
    f.loading = row.at("loading_mg_cm2");
    if (!(f.loading > 0.0))
      throw Failure(kBadInput, fmt::format("a film's loading_mg_cm2 is {:g}.", f.loading));
    f.nanoporosity = row.at("nanoporosity");
    f.sizes = row.at("sizes");
    for (const bank::Input &p : bank.film())
      f.recipe.push_back(row.at("recipe").at(p.name));
    out.films.push_back(f);
  }
  for (const Json &row : json.at("data")) {
    Datum d = {row.at("film"),
               row.at("condition"),
               number_of(row.at("number")),
               row.at("pressure_MPa"),
               row.at("pressure_sd_relative"),
               row.at("measured"),
               row.at("sd")};
    if (!(d.sd > 0.0 && d.pressure > 0.0 && d.measured >= 0.0 && d.measured <= 1.0))
      throw Failure(kBadInput, fmt::format("a datum is {:g} ± {:g} (0 to 1) at {:g} MPa.",
                                           d.measured, d.sd, d.pressure));
    if (d.film < 0 || d.film >= int(out.films.size()))
      throw Failure(kBadInput,
                    fmt::format("a datum's film is {}; there are {}.", d.film, out.films.size()));
    out.data.push_back(d);
  }
  const Json &error = json.at("model_error");
  out.error = {error.at("numerics"), error.at("low"), error.at("high")};
  for (const Json &row : json.at("draws"))
    out.draws.push_back(draw_of(bank, row, out.materials.size() + 1));
  if (out.draws.empty() || out.data.empty())
    throw Failure(kBadInput, "it holds no draws or no data.");
  return out;
}

/// With the file's name in what is wrong.
Calibration calibration_of(const FilmBank &bank, const Json &json, const std::string &file) {
  try {
    return calibration_of(bank, json);
  } catch (const Failure &f) {
    throw Failure(f.exit_status(),
                  fmt::format("{}: {} Was it edited? Calibrate again.", file, f.what()));
  }
}

Json parsed(const std::string &file) {
  if (!std::filesystem::is_regular_file(file))
    throw Failure(kBadInput, fmt::format("{}: not there. Make it with calendem calibrate.", file));
  try {
    return Json::parse(text_of_file(file));
  } catch (const Json::exception &) {
    throw Failure(kBadInput, fmt::format("{}: cut or damaged; make it again with calendem "
                                         "calibrate.",
                                         file));
  }
}

/// The bank that the model was made from, there and unchanged.
FilmBank bank_of(const std::string &file, const Json &json) {
  namespace fs = std::filesystem;
  const Json &of = json.at("bank");
  const auto unchanged = [&](const fs::path &there, const Json &hash) {
    if (hash_of_file(there.string()) != hash.get<std::string>())
      throw Failure(kBadInput, fmt::format("{}: {} is not there or has changed since the model was "
                                           "calibrated on it. Calibrate again.",
                                           file, there.string()));
  };
  const std::string name = of.at("file");
  fs::path bank = (fs::path(input_scripts()) / name).lexically_normal();
  if (!fs::exists(bank))
    bank = (fs::absolute(file).parent_path() / name).lexically_normal();
  unchanged(bank, of.at("hash"));
  unchanged(bank::table_of(bank::read_bank(bank.string())), of.at("table_hash"));
  for (const Json &other : of.at("beside"))
    unchanged((bank.parent_path() / other.at("file").get<std::string>()).lexically_normal(),
              other.at("hash"));
  return FilmBank(bank.string());
}

} // namespace

Model read_model(const std::string &file) {
  const Json json = parsed(file);
  try {
    FilmBank bank = bank_of(file, json);
    Calibration calibration = calibration_of(bank, json, file);
    return {std::move(bank), std::move(calibration), json};
  } catch (const Json::exception &e) {
    throw Failure(kBadInput, fmt::format("{}: no model of calendem calibrate, or of another "
                                         "version: {}. Calibrate again.",
                                         file, e.what()));
  }
}

} // namespace calendem
