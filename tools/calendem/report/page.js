// SPDX-License-Identifier: GPL-2.0-or-later
// The page's charts, drawn with d3 from the object in #data, and the buttons that take numbers and
// drawings out of the page. A chart stands in <div data-chart="ID">; the drawing's data-marks is the
// number of values in view. All looks are attributes of the drawing, so that it stands alone as SVG.
(function() {
'use strict';
var kFont = '"DejaVu Sans", Verdana, Helvetica, Arial, sans-serif';
var kInk = '#1d232a', kGrid = '#e3e7eb', kNear = 40; // px around the pointer

function save(content, type, name) {
  var link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([ content ], {type : type}));
  link.download = name;
  link.click();
}

function quoted(value) {
  var text = value === undefined || value === null ? '' : String(value);
  return /[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text;
}

function csvOf(chart) {
  var rows = [ [ 'series', chart.x_label, 'quantity', 'value', 'base', 'error' ] ];
  chart.series.forEach(function(s) {
    s.x.forEach(function(x, i) {
      rows.push([ s.name, x, s.axis, s.y[i], s.base && s.base[i], s.y_error && s.y_error[i] ]);
    });
  });
  return rows.map(function(row) { return row.map(quoted).join(',') + '\n'; }).join('');
}

function isNumber(value) { return typeof value === 'number' && isFinite(value); }

function Plot(root, chart) {
  this.root = root;
  this.chart = chart;
  this.hidden = {};
  this.zoom = null; // domains of the three axes
  this.log = false;
  this.makeButtons();
  this.draw();
}

Plot.prototype.makeButtons = function() {
  var self = this, id = this.chart.id, bar = document.createElement('div');
  bar.className = 'chart-buttons';
  this.root.appendChild(bar);
  function button(text, title, action) {
    var b = document.createElement('button');
    b.textContent = text;
    b.title = title;
    b.onclick = action;
    return bar.appendChild(b);
  }
  this.whole = button('whole', 'All of the chart again (double click does it too)', function() {
    self.zoom = null;
    self.draw();
  });
  if (this.canBeLogarithmic())
    this.logarithmic = button('log', 'Left axis logarithmic or linear', function() {
      self.log = !self.log;
      self.zoom = null;
      self.draw();
    });
  button('SVG', 'Save as a drawing',
         function() { save(self.drawing(), 'image/svg+xml', id + '.svg'); });
  button('PNG', 'Save as a picture', function() { self.savePicture(id + '.png'); });
  button('CSV', 'Save the numbers',
         function() { save(csvOf(self.chart), 'text/csv', id + '.csv'); });
  bar.appendChild(document.createElement('span')).textContent =
      'drag: zoom · point: value · name: hide';
};

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

/// Of an error bar that reaches from a positive value below zero only the positive part counts.
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
    x : widened(this.values(function(s, i, out) { out.push(s.x[i]); })),
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
        function(axis) { axis[0].nice(axis[1]); });
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
  this.listen();
  this.whole.disabled = !this.zoom;
  if (this.logarithmic)
    this.logarithmic.setAttribute('aria-pressed', this.log);
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

/// Rows of entries above the axes; a click hides and shows a series.
Plot.prototype.drawLegend = function() {
  var self = this, x = this.at.left, y = 12, rows = 0;
  this.chart.series.forEach(function(s, k) {
    if (!s.name)
      return;
    var g = self.svg.append('g').style('cursor', 'pointer').attr('data-series', k);
    g.attr('opacity', self.hidden[k] ? 0.35 : 1);
    g.append('title').text('Click: hide or show');
    if (s.mark === 'area')
      g.append('rect').attr(
          {y : -7, width : 30, height : 14, fill : self.fill[k], stroke : '#444'});
    if (s.mark === 'line')
      g.append('path')
          .attr({d : 'M0 0h30', stroke : s.colour, 'stroke-width' : 2})
          .attr('stroke-dasharray', s.dash || null);
    if (s.symbol !== 'none')
      drawSymbol(g, s, 15, 0);
    var text = g.append('text').attr({x : 36, y : 4, fill : kInk}).text(s.name);
    var long = 36 + text.node().getComputedTextLength() + 16;
    if (x > self.at.left && x + long > self.width) {
      x = self.at.left;
      y += 20;
    }
    g.attr('transform', 'translate(' + x + ' ' + y + ')').on('click', function() {
      self.hidden[k] = !self.hidden[k];
      self.draw();
    });
    rows = y;
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

/// Places of a line, those aside that no eye can tell from the one before; null: a gap.
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

Plot.prototype.drawLimits = function() {
  var self = this, a = this.at;
  this.chart.limits.forEach(function(limit) {
    var y = self.left(limit.y);
    if (!(y >= a.top && y <= a.bottom))
      return;
    self.svg.append('line')
        .attr({x1 : a.left, x2 : a.right, y1 : y, y2 : y, stroke : '#000', 'stroke-width' : 1.4})
        .attr({'stroke-dasharray' : '1 4', 'stroke-linecap' : 'round'});
    self.svg.append('text')
        .attr({
          x : a.right - 6,
          y : y + (y < a.top + 20 ? 16 : -5),
          'text-anchor' : 'end',
          fill : kInk
        })
        .text(limit.label);
  });
};

/// A drawn box zooms, the value next to the pointer is written beside it.
Plot.prototype.listen = function() {
  var self = this;
  var box = d3.svg.brush().x(this.x).y(this.left).on('brushend', function() {
    var e = box.extent();
    if (box.empty() || e[0][0] === e[1][0] || e[0][1] === e[1][1])
      return;
    self.zoom = {
      x : [ e[0][0], e[1][0] ],
      left : [ e[0][1], e[1][1] ],
      right : [ e[0][1], e[1][1] ].map(function(y) { return self.right.invert(self.left(y)); })
    };
    self.draw();
  });
  var g = this.svg.append('g').attr('class', 'pointer').call(box);
  g.on('touchstart.brush', null); // fingers scroll the page
  g.selectAll('.extent').attr({fill : '#0064b0', 'fill-opacity' : 0.12, stroke : '#0064b0'});
  this.value = g.append('g').attr('pointer-events', 'none');
  g.on('mousemove.value', function() { self.showValue(d3.mouse(this)); })
      .on('mouseleave.value', function() { self.value.selectAll('*').remove(); })
      .on('dblclick.value', function() { self.whole.onclick(); });
};

Plot.prototype.nearest = function(at) {
  var best = null, self = this;
  this.chart.series.forEach(function(s, k) {
    for (var i = 0; i < s.x.length && !self.hidden[k]; ++i) {
      var p = self.placed(s, i);
      if (!self.inView(p))
        continue;
      var far = Math.abs(p[0] - at[0]) + Math.abs(p[1] - at[1]);
      if (far < (best ? best.far : kNear))
        best = {far : far, at : p, series : s, i : i};
    }
  });
  return best;
};

Plot.prototype.showValue = function(at) {
  this.value.selectAll('*').remove();
  var hit = this.nearest(at);
  if (!hit)
    return;
  var s = hit.series, i = hit.i, error = s.y_error && s.y_error[i];
  function shown(v) { return String(+v.toPrecision(4)); }
  var base = s.base ? s.base[i] : 0; // of a stack the height of its own share
  var lines = [
    s.name, this.chart.x_label + ': ' + shown(s.x[i]),
    s.axis + ': ' + shown(s.y[i] - base) + (error > 0 ? ' ± ' + shown(error) : '')
  ];
  this.value.append('circle').attr(
      {cx : hit.at[0], cy : hit.at[1], r : 5, fill : 'none', stroke : kInk, 'stroke-width' : 2});
  var toLeft = hit.at[0] > 0.5 * this.width, below = hit.at[1] < this.at.top + 60, self = this;
  lines.filter(Boolean).forEach(function(line, k, all) {
    self.value.append('text')
        .attr({x : hit.at[0] + (toLeft ? -10 : 10), 'text-anchor' : toLeft ? 'end' : 'start'})
        .attr('y', hit.at[1] + (below ? 20 + 16 * k : -12 - 16 * (all.length - 1 - k)))
        .attr({fill : kInk, stroke : '#fff', 'stroke-width' : 4, 'paint-order' : 'stroke'})
        .text(line);
  });
};

/// The chart as it is seen now, as a file.
Plot.prototype.drawing = function() {
  var copy = this.svg.node().cloneNode(true), box = this.svg.attr('viewBox').split(' ');
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  copy.setAttribute('width', box[2]);
  copy.setAttribute('height', box[3]);
  d3.select(copy).select('.pointer').remove();
  d3.select(copy)
      .insert('rect', ':first-child')
      .attr({width : '100%', height : '100%', fill : '#fff'});
  return new XMLSerializer().serializeToString(copy) + '\n';
};

Plot.prototype.savePicture = function(name) {
  var image = new Image(), box = this.svg.attr('viewBox').split(' '), kFiner = 3;
  image.onload = function() {
    var canvas = document.createElement('canvas');
    canvas.width = kFiner * box[2];
    canvas.height = kFiner * box[3];
    canvas.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
    canvas.toBlob(function(blob) { save(blob, 'image/png', name); });
  };
  image.src = 'data:image/svg+xml;charset=utf-8,' + encodeURIComponent(this.drawing());
};

function start() {
  var text = document.getElementById('data').textContent, data = JSON.parse(text), plots = [];
  document.getElementById('save-data').onclick =
      function() { save(text, 'application/json', document.title + '.json'); };
  (data.charts || []).forEach(function(chart) {
    plots.push(new Plot(document.querySelector('[data-chart="' + chart.id + '"]'), chart));
  });
  var width = window.innerWidth;
  window.addEventListener('resize', function() {
    if (window.innerWidth === width)
      return; // a telephone's address bar came or went
    width = window.innerWidth;
    plots.forEach(function(plot) { plot.draw(); });
  });
}
start();
})();
