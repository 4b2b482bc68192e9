// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/film_charts.h"
#include <fmt/format.h>

namespace calendem {

using report::kSeriesColours;
using report::kSeriesSymbols;
using report::Mark;
using report::Series;

namespace {

/// The colour, mixed with white: `share` of it is left.
std::string tint(const std::string &colour, double share) {
  std::string out = "#";
  for (std::size_t k = 1; k < 7; k += 2)
    out += fmt::format("{:02x}",
                       int(255.0 - share * (255 - std::stoi(colour.substr(k, 2), nullptr, 16))));
  return out;
}

} // namespace

std::vector<double> part_of(const std::vector<Band> &bands, double Band::*part, double scale) {
  std::vector<double> out;
  for (const Band &b : bands)
    out.push_back(scale * b.*part);
  return out;
}

Series line_of(const std::string &name, const std::vector<double> &x, const std::vector<double> &y,
               const std::string &colour) {
  Series s;
  s.name = name;
  s.x = x;
  s.y = y;
  s.colour = colour;
  return s;
}

void add_bands(const std::vector<double> &x, const std::vector<Band> &bands, double scale,
               const std::string &colour, report::Chart &chart) {
  Series wide = line_of("90 %", x, part_of(bands, &Band::high90, scale), tint(colour, 0.2)),
         half = line_of("50 %", x, part_of(bands, &Band::high50, scale), tint(colour, 0.4));
  wide.mark = half.mark = Mark::area;
  wide.base = part_of(bands, &Band::low90, scale);
  half.base = part_of(bands, &Band::low50, scale);
  chart.series.push_back(wide);
  chart.series.push_back(half);
  chart.series.push_back(line_of("median", x, part_of(bands, &Band::median, scale), colour));
}

void add_edges(const std::string &name, const std::vector<double> &x,
               const std::vector<Band> &bands, double scale, std::size_t number,
               report::Chart &chart) {
  const std::string colour = kSeriesColours[number % kSeriesColours.size()];
  Series middle = line_of(name, x, part_of(bands, &Band::median, scale), colour);
  middle.symbol = kSeriesSymbols[number % kSeriesSymbols.size()];
  chart.series.push_back(middle);
  for (double Band::*edge : {&Band::low90, &Band::high90}) {
    Series s = line_of("", x, part_of(bands, edge, scale), colour);
    s.dash = "4 3";
    chart.series.push_back(s);
  }
}

report::Chart chart_of(const std::string &id, const std::string &title, const std::string &y,
                       const std::string &x) {
  report::Chart c;
  c.id = id;
  c.title = title;
  c.x_label = x;
  c.y_label = y;
  return c;
}

Series points_of(const Calibration &c, int film, const std::string &colour) {
  Series s;
  s.name = "measured";
  s.mark = Mark::points;
  s.symbol = report::Symbol::circle;
  s.colour = colour;
  for (const Datum &d : c.data)
    if (d.film == film && d.number == FilmNumber::PorosityAfter) {
      s.x.push_back(d.pressure);
      s.y.push_back(kPercent * d.measured);
      s.y_error.push_back(kPercent * d.sd);
    }
  return s;
}

} // namespace calendem
