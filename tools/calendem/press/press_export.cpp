// SPDX-License-Identifier: GPL-2.0-or-later
#include "press/press_export.h"
#include "base/csv_table.h"
#include "base/messages.h"
#include "base/provenance.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

namespace calendem {
namespace {

using Names = std::vector<const char *>;

/// Parts of names in small letters, and units in those of the curve.
struct Known {
  const char *quantity;
  Names names;
  std::vector<std::pair<const char *, double>> units;
};
const std::vector<Known> kKnown = {
    {"force",
     {"force", "load", "kraft", "effort", "charge"},
     {{"N", 1.0}, {"kN", 1e3}, {"mN", 1e-3}, {"kgf", 9.80665}}},
    {"displacement",
     {"displacement", "position", "travel", "extension", "stroke", "crosshead", "deformation",
      "weg", "traverse", "stauchung", "verformung", "déplacement", "deplacement", "course"},
     {{"um", 1.0}, {"nm", 1e-3}, {"mm", 1e3}, {"cm", 1e4}, {"m", 1e6}}},
    {"pressure",
     {"pressure", "stress", "druck", "spannung", "pression", "contrainte"},
     {{"MPa", 1.0},
      {"kPa", 1e-3},
      {"Pa", 1e-6},
      {"GPa", 1e3},
      {"bar", 0.1},
      {"N/mm2", 1.0},
      {"N/mm²", 1.0}}},
    {"time", {"time", "zeit", "temps"}, {{"s", 1.0}, {"ms", 1e-3}, {"min", 60.0}, {"h", 3600.0}}},
    {"stage",
     {"stage", "phase", "step", "segment", "stufe", "schritt", "abschnitt", "étape", "etape"},
     {}}};

/// Parts of the names of stages; the first that fits counts.
const std::pair<const char *, Names> kStages[] = {
    {"unloading",
     {"unload", "releas", "relax", "entlast", "décharge", "decharge", "retour", "rück"}},
    {"dwell", {"dwell", "hold", "halt", "maintien", "palier"}},
    {"loading",
     {"load", "compress", "belast", "charge", "press", "approach", "vorlauf", "vorkraft"}}};

const Known &known(const std::string &quantity) {
  return *std::find_if(kKnown.begin(), kKnown.end(),
                       [&](const Known &k) { return quantity == k.quantity; });
}

std::string small(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return c < 128 ? char(std::tolower(c)) : char(c); });
  for (const auto &[capital, letter] : {std::pair("É", "é"), std::pair("Ü", "ü")})
    for (std::size_t at = 0; (at = text.find(capital)) != std::string::npos;)
      text.replace(at, 2, letter);
  return text;
}

bool has_part(const std::string &text, const Names &parts) {
  const std::string in = small(text);
  return std::any_of(parts.begin(), parts.end(),
                     [&](const char *part) { return in.find(part) != std::string::npos; });
}

/// Factor of a unit; 0: it is none of that quantity.
double factor_of(const Known &k, std::string unit) {
  for (const char *micro : {"µ", "μ"})
    if (const std::size_t at = unit.find(micro); at != std::string::npos)
      unit.replace(at, 2, "u");
  for (const bool exact : {true, false})
    for (const auto &[name, factor] : k.units)
      if (unit == name || (!exact && small(unit) == small(name)))
        return factor;
  return 0.0;
}

/// The unit in a name such as "Kraft [N]", "Kraft (N)", "Kraft / N", "Kraft in N" and "force_N".
std::string unit_in(const std::string &name) {
  const std::size_t open = name.find_last_of("[(");
  if (open != std::string::npos)
    return name.substr(open + 1, name.find_first_of("])", open) - open - 1);
  const std::size_t at = name.find_last_of("/_ ");
  return at == std::string::npos ? "" : name.substr(at + 1);
}

struct Column {
  std::string name;
  double factor = 1.0;
};

class Reader {
public:
  Reader(const std::string &file, const PressFormat &format)
      : file_(file), format_(format),
        table_(CsvTable::parse_export(text_of_file(file), format.decimal)) {
    if (const std::string wrong = table_.ambiguous(); !wrong.empty())
      refuse("{}{}", wrong,
             wrong.find("two ways") != std::string::npos ? " Or give --decimal." : "");
    if (!table_.bad_lines().empty())
      refuse("line {} has another number of columns than the others. Correct the line; numbers "
             "with decimal commas need other separators.",
             table_.bad_lines().front());
    if (table_.rows() < 3)
      refuse(
          "it has {} rows below its header; a curve needs three or more. Give the press's export "
          "as text (CSV).",
          table_.rows());
  }

  PressExport read() {
    PressExport out;
    const std::string guess = table_.guess();
    out.said.push_back(guess.empty() ? "commas between columns" : guess);
    const bool direct = !by_force();
    const double area = direct ? 1.0 : format_.area_mm2;
    if (area == 0.0)
      refuse("the force becomes a pressure by the disc's size. Give --diameter-mm or --area-mm2.");
    out.pressure = numbers(direct ? "pressure" : "force", area, out.said);
    out.displacement = numbers("displacement", 1.0, out.said);
    if (!find("time").name.empty())
      out.time = numbers("time", 1.0, out.said);
    read_stages(out);
    const auto [low, high] = std::minmax_element(out.pressure.begin(), out.pressure.end());
    if (-*low > *high) {
      for (double &p : out.pressure)
        p = -p;
      out.said.emplace_back("compression is negative there and turned");
    }
    return out;
  }

private:
  std::string file_;
  const PressFormat &format_;
  CsvTable table_;

  template <class... Values>
  [[noreturn]] void refuse(fmt::format_string<Values...> what, Values &&...values) const {
    throw Failure(kBadInput, "{}: {}", file_, fmt::format(what, std::forward<Values>(values)...));
  }
  /// What is named comes first; with the disc's size a force is preferred to a pressure.
  bool by_force() const {
    if (format_.columns.count("pressure") > 0 || format_.columns.count("force") > 0)
      return format_.columns.count("pressure") == 0;
    if (format_.area_mm2 > 0.0)
      return !find("force").name.empty() || find("pressure").name.empty();
    return find("pressure").name.empty() && !find("force").name.empty();
  }
  std::string columns() const {
    std::string out;
    for (std::size_t k = 0; k < table_.header().size(); ++k)
      out += fmt::format("{}{} '{}'", k > 0 ? ", " : "", k + 1, table_.header()[k]);
    return out;
  }

  /// By its number, its name, or its name without the unit.
  std::string named(const std::string &quantity, const std::string &name) const {
    const std::vector<std::string> &header = table_.header();
    for (std::size_t k = 0; k < header.size(); ++k)
      if (name == header[k] || name == fmt::format("{}", k + 1))
        return header[k];
    const auto at = std::find_if(header.begin(), header.end(), [&](const std::string &h) {
      return small(h).rfind(small(name), 0) == 0;
    });
    if (at == header.end())
      refuse("there is no column '{}' for --{}; there are {}.", name, quantity, columns());
    return *at;
  }

  /// Columns with a part of its name, and one of its units or none that is known.
  std::vector<std::string> candidates(const Known &k, bool with_unit) const {
    std::vector<std::string> out;
    for (const std::string &column : table_.header()) {
      const auto is_unit = [&](const Known &q) { return factor_of(q, unit_in(column)) > 0.0; };
      if (has_part(column, k.names) &&
          (with_unit ? is_unit(k) : std::none_of(kKnown.begin(), kKnown.end(), is_unit)))
        out.push_back(column);
    }
    return out;
  }

  /// Empty if the quantity is not asked for and not found.
  Column find(const std::string &quantity) const {
    const Known &k = known(quantity);
    std::string name, unit;
    if (const auto asked = format_.columns.find(quantity); asked != format_.columns.end()) {
      const std::size_t colon = asked->second.rfind(':');
      name = named(quantity, asked->second.substr(0, colon));
      unit = colon == std::string::npos ? "" : asked->second.substr(colon + 1);
    } else {
      std::vector<std::string> found = candidates(k, true);
      if (found.empty())
        found = candidates(k, false);
      if (found.size() > 1)
        refuse(
            "'{}' may each be the {}. Give --{} with the name or number of one of the columns {}.",
            fmt::join(found, "' and '"), quantity, quantity, columns());
      name = found.empty() ? "" : found.front();
    }
    if (name.empty() || k.units.empty())
      return {name, 1.0};
    const double factor = factor_of(k, unit.empty() ? unit_in(name) : unit);
    if (factor == 0.0)
      refuse("the {}'s column '{}' has no unit that is known. Give --{} \"{}:{}\", or what it is.",
             quantity, name, quantity, name, k.units.front().first);
    return {name, factor};
  }

  std::vector<double> numbers(const std::string &quantity, double area,
                              std::vector<std::string> &said) const {
    const Column column = find(quantity);
    if (column.name.empty())
      refuse("no column looks like the {}. Give --{} with the name or number of one of the columns "
             "{}, and its unit (2:{}).",
             quantity, quantity, columns(), known(quantity).units.front().first);
    std::vector<double> out = table_.numbers(column.name);
    for (std::size_t k = 0; k < out.size(); ++k)
      if (out[k] *= column.factor / area; !std::isfinite(out[k]))
        refuse("line {}: '{}' in column '{}' is not a number. Correct or remove the row.",
               table_.line_of(k), table_.texts(column.name)[k].substr(0, 40), column.name);
    said.push_back(fmt::format("{} from '{}'", quantity, column.name));
    return out;
  }

  void read_stages(PressExport &out) const {
    const std::string column = find("stage").name;
    if (column.empty())
      return;
    for (const std::string &text : table_.texts(column)) {
      const auto *stage = std::find_if(std::begin(kStages), std::end(kStages),
                                       [&](const auto &s) { return has_part(text, s.second); });
      if (stage == std::end(kStages)) {
        if (format_.columns.count("stage") > 0)
          refuse("'{}' in column '{}' is no name of a stage that is known (loading, dwell, "
                 "unloading). Leave --stage out: stages follow from the force.",
                 text.substr(0, 40), column);
        out.stage.clear();
        out.said.push_back(
            fmt::format("stages from the force, as '{}' is no name of one", text.substr(0, 40)));
        return;
      }
      out.stage.emplace_back(stage->first);
    }
    out.said.push_back(fmt::format("stages from '{}'", column));
  }
};

} // namespace

PressExport read_press_export(const std::string &file, const PressFormat &format) {
  if (!std::filesystem::is_regular_file(file))
    throw Failure(kBadInput, "{}: no such file. Give the export of a press.", file);
  return Reader(file, format).read();
}

} // namespace calendem
