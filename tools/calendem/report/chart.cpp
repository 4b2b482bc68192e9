// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/chart.h"
#include "report/page_template.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace calendem::report {

namespace {

constexpr double kWidth = 640, kPlotHeight = 300;
constexpr double kLeft = 68, kBottom = 52, kTop = 10, kLegendRow = 20;
constexpr double kCharacter = 6.9; // mean advance of the page's 13 px font

std::string px(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

/// Draws one chart: fixes the axes, then appends each part to `svg_`.
class Drawing {
public:
  explicit Drawing(const Chart &chart) : chart_(chart) {
    fix_axes();
    place_legend();
    right_ = kWidth - (has_right_ ? kLeft : 18);
    top_ = kTop + legend_rows_ * kLegendRow + 6;
    bottom_ = top_ + kPlotHeight;
  }

  std::string svg() {
    open();
    draw_axes();
    svg_ << "<g clip-path=\"url(#" << chart_.id << "-clip)\">";
    for (const auto &series : chart_.series)
      draw(series);
    svg_ << "</g>";
    draw_limits();
    draw_legend();
    svg_ << "</svg>";
    return svg_.str();
  }

private:
  struct Entry {
    const Series *series;
    double x, y;
  };

  void fix_axes() {
    Range x, left, right;
    if (chart_.from_zero)
      left.include(0);
    right.include(0);
    for (const auto &s : chart_.series) {
      for (const double v : s.x)
        x.include(v);
      for (std::size_t i = 0; i < s.y.size(); ++i) {
        const double error = i < s.y_error.size() && std::isfinite(s.y_error[i]) ? s.y_error[i] : 0;
        (s.right_axis ? right : left).include(s.y[i] + error);
        (s.right_axis ? right : left).include(s.y[i] - error);
      }
      has_right_ = has_right_ || s.right_axis;
    }
    for (const auto &limit : chart_.limits)
      left.include(limit.y);
    if (chart_.y_top > 0)
      left = {true, 0, chart_.y_top};
    x_ = axis_for(x.low, x.high, 7);
    left_ = axis_for(left.low, left.high, 6);
    right_axis_ = axis_for(right.low, right.high, 6);
  }

  void place_legend() {
    double x = kLeft, y = kTop + 8;
    for (const auto &s : chart_.series) {
      if (s.name.empty())
        continue;
      const double width = 42 + kCharacter * static_cast<double>(s.name.size()) + 14;
      if (x > kLeft && x + width > kWidth) {
        x = kLeft;
        y += kLegendRow;
        ++legend_rows_;
      }
      legend_.push_back({&s, x, y});
      x += width;
    }
    legend_rows_ += legend_.empty() ? 0 : 1;
  }

  double at_x(double v) const { return x_.place(v, kLeft, right_); }
  double at_y(double v, bool right) const {
    return (right ? right_axis_ : left_).place(v, bottom_, top_);
  }

  void open() {
    svg_ << "<svg class=\"chart\" viewBox=\"0 0 " << kWidth << ' ' << px(bottom_ + kBottom)
         << "\" role=\"img\" aria-label=\"" << escaped(chart_.title) << "\"><defs><clipPath id=\""
         << chart_.id << "-clip\"><rect x=\"" << px(kLeft - 6) << "\" y=\"" << px(top_ - 6)
         << "\" width=\"" << px(right_ - kLeft + 12) << "\" height=\"" << px(kPlotHeight + 12)
         << "\"/></clipPath>";
    for (std::size_t i = 0; i < chart_.series.size(); ++i)
      if (chart_.series[i].mark == Mark::area)
        define_hatch(chart_.series[i]);
    svg_ << "</defs>";
  }

  std::string fill_id(const Series &s) const {
    return chart_.id + "-fill" + std::to_string(&s - chart_.series.data());
  }

  void define_hatch(const Series &s) {
    static const char *const kStrokes[] = {"", "<path d=\"M0 8L8 0\" class=\"hatch\"/>",
                                           "<path d=\"M0 0L8 8\" class=\"hatch\"/>",
                                           "<circle cx=\"4\" cy=\"4\" r=\"1.4\"/>"};
    svg_ << "<pattern id=\"" << fill_id(s)
         << "\" width=\"8\" height=\"8\" patternUnits=\"userSpaceOnUse\"><rect width=\"8\" "
            "height=\"8\" fill=\""
         << s.colour << "\"/>" << kStrokes[static_cast<int>(s.hatch)] << "</pattern>";
  }

  void text(double x, double y, const char *kind, const std::string &words) {
    svg_ << "<text x=\"" << px(x) << "\" y=\"" << px(y) << "\" class=\"" << kind << "\">"
         << escaped(words) << "</text>";
  }

  void line(double x1, double y1, double x2, double y2, const char *kind) {
    svg_ << "<line x1=\"" << px(x1) << "\" y1=\"" << px(y1) << "\" x2=\"" << px(x2) << "\" y2=\""
         << px(y2) << "\" class=\"" << kind << "\"/>";
  }

  void upright(double x, const std::string &words) {
    const double y = 0.5 * (top_ + bottom_);
    svg_ << "<text class=\"axis-label\" transform=\"translate(" << px(x) << ' ' << px(y)
         << ") rotate(-90)\">" << escaped(words) << "</text>";
  }

  void draw_axes() {
    for (const double tick : x_.ticks()) {
      line(at_x(tick), top_, at_x(tick), bottom_ + 4, "grid");
      text(at_x(tick), bottom_ + 19, "tick-x", x_.label(tick));
    }
    for (const double tick : left_.ticks()) {
      line(kLeft - 4, at_y(tick, false), right_, at_y(tick, false), "grid");
      text(kLeft - 8, at_y(tick, false) + 4, "tick-left", left_.label(tick));
    }
    if (has_right_)
      for (const double tick : right_axis_.ticks()) {
        line(right_, at_y(tick, true), right_ + 4, at_y(tick, true), "axis");
        text(right_ + 8, at_y(tick, true) + 4, "tick-right", right_axis_.label(tick));
      }
    svg_ << "<path class=\"axis\" d=\"M" << px(kLeft) << ' ' << px(top_) << 'V' << px(bottom_)
         << 'H' << px(right_);
    if (has_right_)
      svg_ << 'V' << px(top_);
    svg_ << "\"/>";
    text(0.5 * (kLeft + right_), bottom_ + 42, "axis-label", chart_.x_label);
    upright(16, chart_.y_label);
    if (has_right_)
      upright(kWidth - 8, chart_.right_label);
  }

  void draw(const Series &s) {
    if (s.mark == Mark::area)
      return draw_area(s);
    if (s.mark == Mark::line)
      draw_line(s);
    const std::size_t stride =
        s.mark == Mark::points ? 1 : std::max<std::size_t>(1, s.x.size() / 9);
    if (s.symbol == Symbol::none)
      return;
    for (std::size_t i = s.mark == Mark::points ? 0 : stride / 2; i < s.x.size(); i += stride) {
      if (i < s.y_error.size() && s.y_error[i] > 0)
        draw_error(s, i);
      if (std::isfinite(s.x[i]) && std::isfinite(s.y[i]))
        draw_symbol(s, at_x(s.x[i]), at_y(s.y[i], s.right_axis));
    }
  }

  void draw_line(const Series &s) {
    svg_ << "<path class=\"line\" stroke=\"" << s.colour << '"';
    if (!s.dash.empty())
      svg_ << " stroke-dasharray=\"" << s.dash << '"';
    svg_ << " d=\"";
    bool pen_down = false;
    double last_x = 0, last_y = 0;
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) {
        pen_down = false;
        continue;
      }
      const double x = at_x(s.x[i]), y = at_y(s.y[i], s.right_axis);
      const bool last = i + 1 == s.x.size();
      if (pen_down && !last && std::hypot(x - last_x, y - last_y) < 0.4)
        continue; // below what the eye or a printer resolves
      svg_ << (pen_down ? 'L' : 'M') << px(x) << ' ' << px(y);
      pen_down = true;
      last_x = x;
      last_y = y;
    }
    svg_ << "\"/>";
  }

  void draw_area(const Series &s) {
    svg_ << "<path class=\"area\" fill=\"url(#" << fill_id(s) << ")\" d=\"";
    for (std::size_t i = 0; i < s.x.size(); ++i)
      svg_ << (i == 0 ? 'M' : 'L') << px(at_x(s.x[i])) << ' ' << px(at_y(s.y[i], false));
    for (std::size_t i = s.x.size(); i-- > 0;)
      svg_ << 'L' << px(at_x(s.x[i])) << ' ' << px(at_y(i < s.base.size() ? s.base[i] : 0, false));
    svg_ << "Z\"/>";
  }

  void draw_error(const Series &s, std::size_t i) {
    const double x = at_x(s.x[i]);
    const double high = at_y(s.y[i] + s.y_error[i], s.right_axis);
    const double low = at_y(s.y[i] - s.y_error[i], s.right_axis);
    svg_ << "<path class=\"error\" stroke=\"" << s.colour << "\" d=\"M" << px(x - 4) << ' '
         << px(high) << "h8m-4 0V" << px(low) << "m-4 0h8\"/>";
  }

  void draw_symbol(const Series &s, double x, double y) {
    const bool solid = s.mark == Mark::line;
    svg_ << "<path class=\"symbol\" stroke=\"" << s.colour << "\" fill=\""
         << (solid ? s.colour : std::string("#fff")) << "\" d=\"M" << px(x) << ' ' << px(y);
    switch (s.symbol) {
    case Symbol::circle:
      svg_ << "m-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z";
      break;
    case Symbol::square:
      svg_ << "m-3.6 -3.6h7.2v7.2h-7.2z";
      break;
    case Symbol::triangle:
      svg_ << "m0 -4.6l4.4 7.8h-8.8z";
      break;
    case Symbol::diamond:
      svg_ << "m0 -5l5 5l-5 5l-5 -5z";
      break;
    case Symbol::none:
      break;
    }
    svg_ << "\"/>";
  }

  void draw_limits() {
    for (const auto &limit : chart_.limits) {
      const double y = at_y(limit.y, false);
      line(kLeft, y, right_, y, "limit");
      text(right_ - 6, y - 5, "limit-label", limit.label);
    }
  }

  void draw_legend() {
    for (const auto &entry : legend_) {
      const Series &s = *entry.series;
      const double x = entry.x, y = entry.y;
      if (s.mark == Mark::area)
        svg_ << "<rect class=\"area\" x=\"" << px(x) << "\" y=\"" << px(y - 7)
             << "\" width=\"32\" height=\"14\" fill=\"url(#" << fill_id(s) << ")\"/>";
      if (s.mark == Mark::line)
        svg_ << "<path class=\"line\" stroke=\"" << s.colour << "\" stroke-dasharray=\""
             << (s.dash.empty() ? "none" : s.dash) << "\" d=\"M" << px(x) << ' ' << px(y)
             << "h32\"/>";
      if (s.symbol != Symbol::none)
        draw_symbol(s, x + 16, y);
      text(x + 38, y + 4, "legend", s.name);
    }
  }

  const Chart &chart_;
  Axis x_, left_, right_axis_;
  bool has_right_ = false;
  int legend_rows_ = 0;
  double right_ = 0, top_ = 0, bottom_ = 0;
  std::vector<Entry> legend_;
  std::ostringstream svg_;
};

} // namespace

std::string to_svg(const Chart &chart) { return Drawing(chart).svg(); }

std::string to_svg_file(const Chart &chart) {
  const std::string svg = to_svg(chart);
  const std::size_t end = svg.find('>');
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"640\" " + svg.substr(5, end - 5) +
         "><style><![CDATA[" + embedded::kPageCss +
         "]]></style><rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>" +
         svg.substr(end + 1) + "\n";
}

nlohmann::json to_json(const Chart &chart) {
  nlohmann::json series = nlohmann::json::array();
  for (const auto &s : chart.series) {
    nlohmann::json entry = {{"name", s.name},
                            {"axis", s.right_axis ? chart.right_label : chart.y_label},
                            {"x", s.x},
                            {"y", s.y}};
    if (!s.base.empty())
      entry["base"] = s.base;
    if (!s.y_error.empty())
      entry["y_error"] = s.y_error;
    series.push_back(std::move(entry));
  }
  return {{"id", chart.id},           {"title", chart.title}, {"x_label", chart.x_label},
          {"y_label", chart.y_label}, {"note", chart.note},   {"series", series}};
}

void Range::include(double value) {
  if (!std::isfinite(value))
    return;
  low = any ? std::min(low, value) : value;
  high = any ? std::max(high, value) : value;
  any = true;
}

Axis axis_for(double low, double high, int count) {
  if (!(high > low))
    high = low + std::max(std::abs(low) * 0.1, 1.0);
  const double raw = (high - low) / std::max(count, 1);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  constexpr double kSlack = 1e-6; // a value on a tick does not open the next interval
  return {std::floor(low / step + kSlack) * step, std::ceil(high / step - kSlack) * step, step};
}

std::vector<double> Axis::ticks() const {
  std::vector<double> values;
  const int count = static_cast<int>(std::lround((high - low) / step));
  for (int i = 0; i <= count; ++i)
    values.push_back(low + i * step);
  return values;
}

std::string Axis::label(double tick) const {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  if (std::abs(tick) < step * 1e-6)
    tick = 0; // no "-0"
  char text[48];
  if (step >= 1e6)
    std::snprintf(text, sizeof text, "%.3g", tick);
  else
    std::snprintf(text, sizeof text, "%.*f", decimals, tick);
  return text;
}

double Axis::place(double value, double begin, double end) const {
  return begin + (value - low) / (high - low) * (end - begin);
}

} // namespace calendem::report
