// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/material_notes.h"
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr double kSameDensity = 0.03;
const char *const kDensity = "density.am_g_cm3";
const char *const kWhatToDo = "Give the recipe's key 'material' that one, or a file of your own "
                              "(input_scripts/materials has examples), or correct the recipe.";

/// Letters and digits, in lower case: "LiNi1/3..." and "lini13..." are one name.
std::string bare(const std::string &text) {
  std::string out;
  for (const unsigned char c : text)
    if (std::isalnum(c))
      out += static_cast<char>(std::tolower(c));
  return out;
}

std::vector<std::string> names_of(const ReferenceMaterial &m) {
  std::vector<std::string> out = {bare(m.name)};
  for (const std::string &name : m.also_called)
    out.push_back(bare(name));
  return out;
}

/// The name of the material that the text holds; empty: none of them.
std::string named_in(const std::string &text, const ReferenceMaterial &m) {
  for (const std::string &name : names_of(m))
    if (!name.empty() && bare(text).find(name) != std::string::npos)
      return name;
  return "";
}

/// "its name" or "its file" where that holds a name of `other` and none of its own material.
std::string names_other(const Recipe &r, const ReferenceMaterial &other) {
  const std::string name = r.settings.text("name"),
                    file = std::filesystem::path(r.file).stem().string();
  for (const auto &[what, text] : {std::pair("name", name), std::pair("file", file)})
    if (named_in(text, r.material).empty() && !named_in(text, other).empty())
      return fmt::format("its {} '{}' is of the material '{}', and its key 'material' says '{}'",
                         what, text, other.name, r.material.name);
  return "";
}

} // namespace

bool share_a_name(const ReferenceMaterial &a, const ReferenceMaterial &b) {
  const std::vector<std::string> names = names_of(a), others = names_of(b);
  return std::find_first_of(names.begin(), names.end(), others.begin(), others.end()) !=
         names.end();
}

bool are_of_one_density(double a, double b) { return std::fabs(a / b - 1.0) <= kSameDensity; }

std::vector<std::string> other_material(const Recipe &r) {
  std::vector<std::string> out;
  const auto density = r.material.values.find(kDensity);
  if (density != r.material.values.end())
    if (!are_of_one_density(r.am_density, std::stod(density->second.text)))
      out.push_back(fmt::format("{} is {:g}, and {} of its material '{}': more than {:.0f} % apart",
                                kDensity, r.am_density, density->second.text, r.material.name,
                                100.0 * kSameDensity));
  for (const std::string &known : known_materials())
    if (const std::string text = names_other(r, read_material(material_path(known, "")));
        !text.empty()) {
      out.push_back(text);
      break;
    }
  return out;
}

void stop_if_of_other_material(const Recipe &r) {
  if (const auto differs = other_material(r); !differs.empty())
    throw Failure(kBadInput, "{}: the answer would be that of another material: {}. {}", r.file,
                  fmt::join(differs, "; "), kWhatToDo);
}

std::string not_calibrated(const ReferenceMaterial &m) {
  return !m.given() || m.calibrated()
             ? ""
             : fmt::format("the material '{}' is not calibrated: none of its values was fitted to "
                           "measured films",
                           m.name);
}

std::vector<std::string> notes_of(const Recipe &recipe) {
  std::vector<std::string> out;
  for (const std::string &text : other_material(recipe))
    out.push_back(fmt::format("the recipe is not of its material: {}. {}", text, kWhatToDo));
  if (const std::string text = not_calibrated(recipe.material); !text.empty())
    out.push_back(text + ".");
  return out;
}

std::vector<std::string> warnings_of_electrode(const nlohmann::json &electrode) {
  if (!electrode.is_object()) // cut or missing: who reads it says so
    return {};
  auto out = electrode.value(kMaterialNotes, std::vector<std::string>());
  if (const double cut = electrode.value(kCutOff, 0.0); cut > kCutOffWarned)
    out.push_back(fmt::format("{:.0f} % of the volume of the recipe's particles is in particles "
                              "wider than this cell can hold ({:.1f} um); smaller ones take its "
                              "place. A larger cell holds more.",
                              100.0 * cut, electrode.value(kLargestAllowed, 0.0)));
  return out;
}

} // namespace calendem
