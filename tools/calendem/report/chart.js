// SPDX-License-Identifier: GPL-2.0-or-later
// Draws a chart (page.h) with d3. The drawing's data-marks is the number of values in view. All looks
// are attributes of the drawing, so that it stands alone as SVG.
var Plot = (function() {
'use strict';
var kFont = '"DejaVu Sans", Verdana, Helvetica, Arial, sans-serif';
var kInk = '#1d232a', kGrid = '#e3e7eb';

function isNumber(value) { return typeof value === 'number' && isFinite(value); }

function Plot(root, chart) {
  this.root = root;
  this.chart = chart;
  this.hidden = {};
  this.zoom = null; // domains of the three axes
  this.log = false;
  this.drawn = function() {}; // called after every drawing
}

Plot.ink = kInk;

/// Lines and points over more than a decade; a filled area has no bottom there.
Plot.prototype.canBeLogarithmic = function() {
  var values = [], filled = false;
  this.chart.series.forEach(function(s) {
    filled = filled || s.mark === 'area';
    if (!s.right)
      values = values.concat(s.y.filter(function(y) { return y > 0; }));
  });
  return !filled && values.length > 0 && d3.max(values) > 10 * d3.min(values);
};

Plot.prototype.values = function(of) {
  var out = [];
  this.chart.series.forEach(function(s) {
    for (var i = 0; i < s.x.length; ++i)
      of(s, i, out);
  });
  return d3.extent(out.filter(isNumber));
};

/// An error bar that reaches from a positive value below zero counts with its positive part only.
Plot.prototype.domains = function() {
  var chart = this.chart;
  function y(right) {
    return function(s, i, out) {
      var error = s.y_error && s.y_error[i] || 0;
      if (!!s.right === right && isNumber(s.y[i]))
        out.push(Math.max(s.y[i] - error, Math.min(s.y[i], 0)), s.y[i] + error);
    };
  }
  function widened(range) {
    var low = isNumber(range[0]) ? range[0] : 0, high = isNumber(range[1]) ? range[1] : low;
    return high > low ? [ low, high ] : [ low, low + Math.max(Math.abs(low) * 0.1, 1) ];
  }
  /// A point at the end of the axis would be cut in half; no axis begins below 0 for it.
  function withRoom(range) {
    var room = 0.03 * (range[1] - range[0]);
    function hasPointAt(x) {
      return chart.series.some(function(s) { return s.mark === 'points' && s.x.indexOf(x) >= 0; });
    }
    return [
      hasPointAt(range[0]) && range[0] > 0 ? Math.max(range[0] - room, 0) : range[0],
      hasPointAt(range[1]) ? range[1] + room : range[1]
    ];
  }
  var left = this.values(y(false)), right = this.values(y(true));
  left = d3.extent(
      left.concat(chart.limits.map(function(l) { return l.y; }), chart.from_zero ? [ 0 ] : []));
  if (chart.y_top)
    left = [ 0, chart.y_top ];
  if (this.log)
    left = this.values(function(s, i, out) {
      if (!s.right && s.y[i] > 0)
        out.push(s.y[i]);
    });
  return {
    x : withRoom(widened(this.values(function(s, i, out) { out.push(s.x[i]); }))),
    left : widened(left),
    right : widened(d3.extent(right.concat([ 0 ])))
  };
};

Plot.prototype.fixAxes = function() {
  this.width = Math.max(260, this.root.clientWidth);
  var narrow = this.width < 480, domains = this.zoom || this.domains(), self = this;
  this.hasRight = this.chart.series.some(function(s) { return s.right; });
  this.at = {left : narrow ? 54 : 64, top : 10, height : narrow ? 230 : 300};
  this.at.right = this.width - (this.hasRight ? this.at.left : 16);
  this.ticks = {x : narrow ? 5 : 8, y : 6};
  this.x = d3.scale.linear().domain(domains.x).range([ this.at.left, this.at.right ]);
  this.left = (this.log ? d3.scale.log() : d3.scale.linear()).domain(domains.left);
  this.right = d3.scale.linear().domain(domains.right);
  if (!this.zoom)
    [[ this.x, this.ticks.x ], [ this.left, this.ticks.y ], [ this.right, this.ticks.y ]].forEach(
        function(axis) {
          var low = axis[0].domain()[0], high = axis[0].nice(axis[1]).domain()[1];
          if (low < 0 && low > -0.02 * high) // a hair below 0 is no reason for a step below it
            axis[0].domain([ low, high ]);
        });
  this.placed = function(s, i) {
    var y = s.y[i];
    return isNumber(s.x[i]) && isNumber(y) && (s.right || !self.log || y > 0)
               ? [ self.x(s.x[i]), (s.right ? self.right : self.left)(y) ]
               : null;
  };
};

Plot.prototype.inView = function(p) {
  var a = this.at;
  return p && p[0] > a.left - 1 && p[0] < a.right + 1 && p[1] > a.top - 1 && p[1] < a.bottom + 1;
};

Plot.prototype.draw = function() {
  this.fixAxes();
  d3.select(this.root).select('svg').remove();
  this.svg = d3.select(this.root)
                 .append('svg')
                 .attr({role : 'img', 'aria-label' : this.chart.title, 'font-family' : kFont})
                 .attr('font-size', this.width < 480 ? 11 : 13);
  this.fill = this.chart.series.map(this.fillOf, this);
  this.drawLegend();
  this.at.bottom = this.at.top + this.at.height;
  this.left.range([ this.at.bottom, this.at.top ]);
  this.right.range([ this.at.bottom, this.at.top ]);
  this.svg.attr('viewBox', '0 0 ' + this.width + ' ' + (this.at.bottom + 50));
  this.drawAxes();
  this.drawSeries();
  this.drawLimits();
  this.drawn();
};

Plot.prototype.fillOf = function(s, k) {
  if (s.mark !== 'area' || s.hatch === 'solid')
    return s.colour;
  var id = this.chart.id + '-fill' + k;
  var pattern = this.svg.append('pattern').attr(
      {id : id, width : 8, height : 8, patternUnits : 'userSpaceOnUse'});
  pattern.append('rect').attr({width : 8, height : 8, fill : s.colour});
  if (s.hatch === 'dots')
    pattern.append('circle').attr({cx : 4, cy : 4, r : 1.4});
  else
    pattern.append('path').attr(
        {d : s.hatch === 'rising' ? 'M0 8L8 0' : 'M0 0L8 8', stroke : '#444'});
  return 'url(#' + id + ')';
};

function symbolOf(s) {
  return d3.svg.symbol().size(52).type(s.symbol === 'triangle' ? 'triangle-up' : s.symbol)();
}

function drawSymbol(g, s, x, y) {
  g.append('path').attr({
    d : symbolOf(s),
    transform : 'translate(' + x.toFixed(1) + ' ' + y.toFixed(1) + ')',
    stroke : s.colour,
    'stroke-width' : 1.6,
    fill : s.mark === 'points' ? '#fff' : s.colour
  });
}

/// Words in lines that are at most so wide, 14 below each other; how many lines.
function writeLines(text, words, room) {
  var span = text.append('tspan'), line = '', lines = 1;
  words.split(' ').forEach(function(word) {
    span.text(line + word);
    if (line && span.node().getComputedTextLength() > room) {
      span.text(line);
      span = text.append('tspan').attr({x : text.attr('x'), dy : 14}).text(word);
      line = '';
      ++lines;
    }
    line += word + ' ';
  });
  return lines;
}

/// Rows of entries above the axes; a click hides and shows a series.
Plot.prototype.drawLegend = function() {
  var self = this, x = this.at.left, y = 12, rows = 0, room = this.width - this.at.left - 36;
  this.chart.series.forEach(function(s, k) {
    if (!s.name)
      return;
    var g = self.svg.append('g').style('cursor', 'pointer').attr('data-series', k);
    g.attr('opacity', self.hidden[k] ? 0.35 : 1);
    g.append('title').text('Click to hide or show');
    if (s.mark === 'area')
      g.append('rect').attr(
          {y : -7, width : 30, height : 14, fill : self.fill[k], stroke : '#444'});
    if (s.mark === 'line')
      g.append('path')
          .attr({d : 'M0 0h30', stroke : s.colour, 'stroke-width' : 2})
          .attr('stroke-dasharray', s.dash || null);
    if (s.symbol !== 'none')
      drawSymbol(g, s, 15, 0);
    var text = g.append('text').attr({x : 36, y : 4, fill : kInk});
    var lines = writeLines(text, s.name, room);
    var long = 36 + (lines > 1 ? room : text.node().getComputedTextLength()) + 16;
    if (x > self.at.left && x + long > self.width) {
      x = self.at.left;
      y += 20;
    }
    g.attr('transform', 'translate(' + x + ' ' + y + ')').on('click', function() {
      self.hidden[k] = !self.hidden[k];
      self.draw();
    });
    rows = y += 14 * (lines - 1);
    x += long;
  });
  this.at.top = rows + (rows ? 18 : 10);
};

Plot.prototype.drawAxis = function(scale, orient, count, at, length) {
  var axis =
      d3.svg.axis().scale(scale).orient(orient).outerTickSize(0).innerTickSize(length).tickPadding(
          7);
  if (scale === this.left && this.log)
    axis.tickFormat(scale.tickFormat(count, function(v) { return String(+v.toPrecision(3)); }));
  else
    axis.ticks(count).tickFormat(scale.tickFormat(count, 'f'));
  var g = this.svg.append('g').attr('transform', 'translate(' + at + ')').call(axis);
  g.selectAll('.tick line').attr('stroke', orient === 'right' ? kInk : kGrid);
  g.selectAll('.tick text').attr('fill', kInk);
  g.select('.domain').attr({fill : 'none', stroke : kInk, 'stroke-width' : 1.2});
};

Plot.prototype.label = function(text, x, y, turned) {
  this.svg.append('text')
      .text(text)
      .attr({'text-anchor' : 'middle', fill : kInk})
      .attr('transform', 'translate(' + x + ' ' + y + ')' + (turned ? ' rotate(-90)' : ''));
};

Plot.prototype.drawAxes = function() {
  var a = this.at, middle = 0.5 * (a.top + a.bottom), chart = this.chart;
  this.drawAxis(this.x, 'bottom', this.ticks.x, [ 0, a.bottom ], -a.height);
  this.drawAxis(this.left, 'left', this.ticks.y, [ a.left, 0 ], a.left - a.right);
  this.label(chart.x_label, 0.5 * (a.left + a.right), a.bottom + 42);
  this.label(chart.y_label, 14, middle, true);
  if (!this.hasRight)
    return;
  this.drawAxis(this.right, 'right', this.ticks.y, [ a.right, 0 ], 5);
  this.label(chart.right_label, this.width - 5, middle, true);
};

/// Points of a line, without those within half a pixel of the one before; null: a gap.
Plot.prototype.path = function(s) {
  var out = [], last = null;
  for (var i = 0; i < s.x.length; ++i) {
    var p = this.placed(s, i);
    if (p && last && i + 1 < s.x.length &&
        Math.abs(p[0] - last[0]) + Math.abs(p[1] - last[1]) < 0.5)
      continue;
    out.push(last = p);
  }
  return out;
};

function rounded(value) { return Math.round(10 * value) / 10; }

Plot.prototype.drawSeries = function() {
  var self = this, a = this.at, marks = 0, id = this.chart.id + '-clip';
  this.svg.append('clipPath')
      .attr('id', id)
      .append('rect')
      .attr({x : a.left - 6, y : a.top - 6, width : a.right - a.left + 12, height : a.height + 12});
  var all = this.svg.append('g').attr('clip-path', 'url(#' + id + ')');
  this.chart.series.forEach(function(s, k) {
    if (self.hidden[k])
      return;
    for (var i = 0; i < s.x.length; ++i)
      marks += self.inView(self.placed(s, i)) ? 1 : 0;
    if (s.mark === 'area')
      return self.drawArea(all, s, self.fill[k]);
    if (s.mark === 'line')
      all.append('path')
          .attr({fill : 'none', stroke : s.colour, 'stroke-width' : 2})
          .attr('stroke-dasharray', s.dash || null)
          .attr('d', d3.svg.line()
                         .defined(function(p) { return p !== null; })
                         .x(function(p) { return rounded(p[0]); })
                         .y(function(p) { return rounded(p[1]); })(self.path(s)));
    self.drawPoints(all, s);
  });
  this.svg.attr('data-marks', marks);
};

Plot.prototype.drawArea = function(g, s, fill) {
  var self = this, rows = d3.range(s.x.length).filter(function(i) { return self.placed(s, i); });
  var area = d3.svg.area()
                 .x(function(i) { return rounded(self.x(s.x[i])); })
                 .y0(function(i) { return rounded(self.left(s.base ? s.base[i] : 0)); })
                 .y1(function(i) { return rounded(self.left(s.y[i])); });
  g.append('path').attr({d : area(rows), fill : fill, stroke : '#444', 'stroke-width' : 0.7});
};

Plot.prototype.drawPoints = function(g, s) {
  if (s.symbol === 'none')
    return;
  var apart = s.mark === 'points' ? 1 : Math.max(1, Math.floor(s.x.length / 9));
  for (var i = s.mark === 'points' ? 0 : apart >> 1; i < s.x.length; i += apart) {
    var p = this.placed(s, i), error = s.y_error && s.y_error[i];
    if (!p)
      continue;
    if (error > 0)
      this.drawError(g, s, i, p[0], error);
    drawSymbol(g, s, p[0], p[1]);
  }
};

Plot.prototype.drawError = function(g, s, i, x, error) {
  var y = s.right ? this.right : this.left;
  var low = this.log && s.y[i] <= error ? this.at.bottom : y(s.y[i] - error);
  g.append('path').attr({
    d : 'M' + rounded(x - 4) + ' ' + rounded(y(s.y[i] + error)) + 'h8m-4 0V' + rounded(low) +
            'm-4 0h8',
    fill : 'none',
    stroke : s.colour,
    'stroke-width' : 1.4
  });
};

/// Steps of at most four pixels along what is drawn of a series.
Plot.prototype.steps = function(s) {
  var points = this.path(s), out = [];
  for (var i = 1; i < points.length; ++i) {
    var p = points[i - 1], q = points[i];
    var n = p && q ? Math.ceil(Math.max(Math.abs(q[0] - p[0]), Math.abs(q[1] - p[1])) / 4) : 0;
    for (var k = 0; k < n; ++k)
      out.push([ p[0] + (q[0] - p[0]) * k / n, p[1] + (q[1] - p[1]) * k / n ]);
  }
  return out.concat(points.filter(function(p) { return p; }));
};

/// Above or below its line, where the fewest curves pass; in white behind itself, for those that do.
Plot.prototype.drawLimitLabel = function(label, y) {
  var self = this, a = this.at, steps = [], best = null;
  this.chart.series.forEach(function(s, k) {
    if (!self.hidden[k])
      steps = steps.concat(self.steps(s));
  });
  var halo = this.svg.append('text').text(label).attr(
      {fill : '#fff', stroke : '#fff', 'stroke-width' : 4, 'stroke-linejoin' : 'round'});
  var long = halo.node().getComputedTextLength(), free = a.right - a.left - long - 12;
  [1, 0.5, 0].forEach(function(share) {
    [y - 5, y + 16].forEach(function(base) {
      var x = a.left + 6 + share * free, top = base - 15, bottom = base + 5;
      if (top < a.top || bottom > a.bottom)
        return;
      var crossed = steps.filter(function(p) {
        return p[0] > x - 4 && p[0] < x + long + 4 && p[1] > top && p[1] < bottom;
      });
      if (!best || crossed.length < best.crossed)
        best = {x : x, y : base, crossed : crossed.length};
    });
  });
  best = best || {x : a.left + 6 + free, y : y - 5};
  halo.attr({x : best.x, y : best.y});
  this.svg.append('text').text(label).attr({x : best.x, y : best.y, fill : kInk});
};

Plot.prototype.drawLimits = function() {
  var self = this, a = this.at;
  this.chart.limits.forEach(function(limit) {
    var y = self.left(limit.y);
    if (!(y >= a.top && y <= a.bottom))
      return;
    self.svg.append('line')
        .attr({x1 : a.left, x2 : a.right, y1 : y, y2 : y, stroke : '#000', 'stroke-width' : 1.4})
        .attr({'stroke-dasharray' : '1 4', 'stroke-linecap' : 'round'});
    self.drawLimitLabel(limit.label, y);
  });
};

return Plot;
})();
