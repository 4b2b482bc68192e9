// SPDX-License-Identifier: GPL-2.0-or-later
// Works on the charts of the page it stands in and writes what is wrong into <pre id="result">.
(function() {
'use strict';
var faults = [], saved = [];
function check(holds, words) {
  if (!holds)
    faults.push(words);
}
// What is saved is caught at once: the browser's own time runs ahead of work that it does beside.
window.Blob = function(parts, options) {
  this.text = parts.map(function(p) { return p.text || p; }).join('');
  this.type = options.type;
};
URL.createObjectURL = function(blob) { return '#' + (saved.push(blob) - 1); };
HTMLAnchorElement.prototype.click =
    function() { saved[saved.length - 1].fileName = this.download; };
HTMLCanvasElement.prototype.toBlob = function(
    then) { then(new Blob([ this.toDataURL('image/png') ], {type : 'image/png'})); };

var text = document.getElementById('data').textContent, charts = JSON.parse(text).charts;
function rootOf(chart) { return document.querySelector('[data-chart="' + chart.id + '"]'); }
function marksOf(chart) { return +rootOf(chart).querySelector('svg').dataset.marks; }
function press(chart, name) {
  var found = [].filter.call(rootOf(chart).querySelectorAll('button'),
                             function(b) { return b.textContent === name; });
  check(found.length === 1, chart.id + ': no button ' + name);
  if (found.length)
    found[0].click();
}
function mouse(target, type, x, y) {
  target.dispatchEvent(new MouseEvent(
      type, {bubbles : true, cancelable : true, view : window, clientX : x, clientY : y}));
}
/// A place in the area of the axes, as fractions from the left and from the top.
function place(chart, x, y) {
  var box = rootOf(chart).querySelector('.pointer .background').getBoundingClientRect();
  return [ box.left + x * box.width, box.top + y * box.height ];
}

function checkDrawing(chart) {
  var svg = rootOf(chart).querySelector('svg'), values = 0;
  check(svg, chart.id + ' is not drawn');
  if (!svg)
    return;
  chart.series.forEach(function(s) {
    values += s.y.filter(function(y, i) { return y !== null && s.x[i] !== null; }).length;
  });
  if (!chart.y_top) // else values may lie above
    check(marksOf(chart) === values, chart.id + ': ' + marksOf(chart) + ' of ' + values);
  check(!/NaN|Infinity|undefined/.test(svg.outerHTML), chart.id + ': a place that is no number');
  check(svg.getBoundingClientRect().right <= window.innerWidth, chart.id + ' is too wide');
}

function checkZoom(chart) {
  var before = marksOf(chart), a = place(chart, 0.5, 0), b = place(chart, 1, 0.98);
  var pane = rootOf(chart).querySelector('.pointer .background');
  mouse(pane, 'mousedown', a[0], a[1]);
  mouse(window, 'mousemove', b[0], b[1]);
  mouse(window, 'mouseup', b[0], b[1]);
  check(marksOf(chart) < before && marksOf(chart) > 0, 'zoom: ' + marksOf(chart) + ' of ' + before);
  press(chart, 'reset zoom');
  check(marksOf(chart) === before, 'whole: ' + marksOf(chart) + ' of ' + before);
}

function checkValue(chart) {
  var pane = rootOf(chart).querySelector('.pointer'), seen = null;
  for (var k = 1; k < 20 && !seen; ++k) {
    var at = place(chart, 0.6, k / 20);
    mouse(pane, 'mousemove', at[0], at[1]);
    seen = pane.querySelector('text');
  }
  check(seen, 'no value beside the pointer');
  var ring = pane.querySelector('circle').getBoundingClientRect();
  check(Math.hypot(ring.left - at[0], ring.top - at[1]) < 50, 'the value is far from the pointer');
  var words = pane.textContent, numbers = words.match(/MPa\)?: (-?[0-9.e+-]+)/);
  check(numbers && chart.series.some(function(s) {
    return s.x.concat(s.y).some(function(
        v) { return String(+(+v).toPrecision(4)) === numbers[1]; });
  }),
        'the value is none of the data: ' + words);
}

function checkLegend(chart) {
  var before = marksOf(chart);
  function entry() { return rootOf(chart).querySelector('[data-series="0"]'); }
  mouse(entry(), 'click', 0, 0);
  check(marksOf(chart) < before, 'a hidden series is drawn');
  mouse(entry(), 'click', 0, 0);
  check(marksOf(chart) === before, 'a shown series is not drawn');
}

function checkFiles(chart) {
  press(chart, 'SVG');
  press(chart, 'CSV');
  document.getElementById('save-data').click();
  var svg = new DOMParser().parseFromString(saved[0].text, 'image/svg+xml'), rows = 1;
  check(!svg.querySelector('parsererror') && svg.documentElement.getAttribute('viewBox'),
        'the SVG file is damaged');
  check(!svg.querySelector('.pointer'), 'the SVG file has what belongs to the pointer');
  check(saved[0].fileName === chart.id + '.svg', 'file name ' + saved[0].fileName);
  chart.series.forEach(function(s) { rows += s.x.length; });
  check(saved[1].text.trim().split('\n').length === rows, 'rows of the CSV file');
  check(saved[1].text.indexOf('series,' + chart.x_label + ',quantity,value,base,error\n') === 0,
        'head of the CSV file: ' + saved[1].text.slice(0, 80));
  check(saved[2].text === text, 'the JSON file is not the data');
}

function checkPicture(chart, then) {
  press(chart, 'PNG');
  (function wait(left) {
    if (saved.length < 4 && left > 0)
      return setTimeout(wait, 100, left - 1);
    check(saved.length === 4 && saved[3].text.indexOf('data:image/png;base64,') === 0 &&
              saved[3].text.length > 20000,
          'the PNG file is missing or too small');
    then();
  })(100);
}

function done() {
  var out = document.createElement('pre');
  out.id = 'result';
  out.textContent =
      '\n' +
      (faults.length ? faults.join('\n') : 'charts: as they should be (' + charts.length + ')') +
      '\n';
  document.body.appendChild(out);
}

try {
  charts.forEach(checkDrawing);
  checkZoom(charts[1]);
  checkValue(charts[1]);
  checkLegend(charts[1]);
  press(charts[1], 'log');
  check(!/NaN|Infinity/.test(rootOf(charts[1]).innerHTML),
        'logarithmic: a place that is no number');
  press(charts[1], 'log');
  checkFiles(charts[1]);
  checkPicture(charts[1], done);
} catch (e) {
  faults.push('stopped: ' + e.stack);
  done();
}
})();
