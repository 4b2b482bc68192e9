// SPDX-License-Identifier: GPL-2.0-or-later
// What a reader does with a page: zoom and values of the charts, and the buttons that take numbers and
// drawings out of it. The charts' object is in #data; a chart stands in <div data-chart="ID">.
(function() {
'use strict';
var kNear = 40; // px around the pointer

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

/// The chart as it is seen now, as a file.
function drawing(plot) {
  var copy = plot.svg.node().cloneNode(true), box = plot.svg.attr('viewBox').split(' ');
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  copy.setAttribute('width', box[2]);
  copy.setAttribute('height', box[3]);
  d3.select(copy).select('.pointer').remove();
  d3.select(copy)
      .insert('rect', ':first-child')
      .attr({width : '100%', height : '100%', fill : '#fff'});
  return new XMLSerializer().serializeToString(copy) + '\n';
}

function savePicture(plot, name) {
  var image = new Image(), box = plot.svg.attr('viewBox').split(' '), kFiner = 3;
  image.onload = function() {
    var canvas = document.createElement('canvas');
    canvas.width = kFiner * box[2];
    canvas.height = kFiner * box[3];
    canvas.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
    canvas.toBlob(function(blob) { save(blob, 'image/png', name); });
  };
  image.src = 'data:image/svg+xml;charset=utf-8,' + encodeURIComponent(drawing(plot));
}

function addButtons(plot) {
  var id = plot.chart.id, bar = document.createElement('div');
  bar.className = 'chart-buttons';
  plot.root.appendChild(bar);
  function button(text, title, action) {
    var b = document.createElement('button');
    b.textContent = text;
    b.title = title;
    b.onclick = action;
    return bar.appendChild(b);
  }
  plot.whole = button('reset zoom', 'Show the whole chart again (or double-click)', function() {
    plot.zoom = null;
    plot.draw();
  });
  if (plot.canBeLogarithmic())
    plot.logarithmic = button('log', 'Switch the left axis between linear and logarithmic', function() {
      plot.log = !plot.log;
      plot.zoom = null;
      plot.draw();
    });
  button('SVG', 'Save as a vector drawing',
         function() { save(drawing(plot), 'image/svg+xml', id + '.svg'); });
  button('PNG', 'Save as an image', function() { savePicture(plot, id + '.png'); });
  button('CSV', 'Save the numbers',
         function() { save(csvOf(plot.chart), 'text/csv', id + '.csv'); });
  bar.appendChild(document.createElement('span')).textContent =
      'drag to zoom, hover for values';
}

function nearest(plot, at) {
  var best = null;
  plot.chart.series.forEach(function(s, k) {
    for (var i = 0; i < s.x.length && !plot.hidden[k]; ++i) {
      var p = plot.placed(s, i);
      if (!plot.inView(p))
        continue;
      var far = Math.abs(p[0] - at[0]) + Math.abs(p[1] - at[1]);
      if (far < (best ? best.far : kNear))
        best = {far : far, at : p, series : s, i : i};
    }
  });
  return best;
}

function showValue(plot, at) {
  plot.value.selectAll('*').remove();
  var hit = nearest(plot, at);
  if (!hit)
    return;
  var s = hit.series, i = hit.i, error = s.y_error && s.y_error[i];
  function shown(v) { return String(+v.toPrecision(4)); }
  var base = s.base ? s.base[i] : 0; // of a stack the height of its own share
  var lines = [
    s.name, plot.chart.x_label + ': ' + shown(s.x[i]),
    s.axis + ': ' + shown(s.y[i] - base) + (error > 0 ? ' ± ' + shown(error) : '')
  ];
  plot.value.append('circle').attr(
      {cx : hit.at[0], cy : hit.at[1], r : 5, fill : 'none', stroke : Plot.ink, 'stroke-width' : 2});
  var toLeft = hit.at[0] > 0.5 * plot.width, below = hit.at[1] < plot.at.top + 60;
  lines.filter(Boolean).forEach(function(line, k, all) {
    plot.value.append('text')
        .attr({x : hit.at[0] + (toLeft ? -10 : 10), 'text-anchor' : toLeft ? 'end' : 'start'})
        .attr('y', hit.at[1] + (below ? 20 + 16 * k : -12 - 16 * (all.length - 1 - k)))
        .attr({fill : Plot.ink, stroke : '#fff', 'stroke-width' : 4, 'paint-order' : 'stroke'})
        .text(line);
  });
}

/// A drawn box zooms, the value next to the pointer is written beside it.
function listen(plot) {
  var box = d3.svg.brush().x(plot.x).y(plot.left).on('brushend', function() {
    var e = box.extent();
    if (box.empty() || e[0][0] === e[1][0] || e[0][1] === e[1][1])
      return;
    plot.zoom = {
      x : [ e[0][0], e[1][0] ],
      left : [ e[0][1], e[1][1] ],
      right : [ e[0][1], e[1][1] ].map(function(y) { return plot.right.invert(plot.left(y)); })
    };
    plot.draw();
  });
  var g = plot.svg.append('g').attr('class', 'pointer').call(box);
  g.on('touchstart.brush', null); // fingers scroll the page
  g.selectAll('.extent').attr({fill : '#0064b0', 'fill-opacity' : 0.12, stroke : '#0064b0'});
  plot.value = g.append('g').attr('pointer-events', 'none');
  g.on('mousemove.value', function() { showValue(plot, d3.mouse(this)); })
      .on('mouseleave.value', function() { plot.value.selectAll('*').remove(); })
      .on('dblclick.value', function() { plot.whole.onclick(); });
  plot.whole.disabled = !plot.zoom;
  if (plot.logarithmic)
    plot.logarithmic.setAttribute('aria-pressed', plot.log);
}

function start() {
  var text = document.getElementById('data').textContent, data = JSON.parse(text), plots = [];
  document.getElementById('save-data').onclick =
      function() { save(text, 'application/json', document.title + '.json'); };
  (data.charts || []).forEach(function(chart) {
    var plot = new Plot(document.querySelector('[data-chart="' + chart.id + '"]'), chart);
    addButtons(plot);
    plot.drawn = function() { listen(plot); };
    plot.draw();
    plots.push(plot);
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
