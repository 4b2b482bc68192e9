// SPDX-License-Identifier: GPL-2.0-or-later
// The 3-D view of a run: click a body to see its bonds. Data: explorer.cpp. Address ending in
// #body=12&moment=1 opens the first view there. What is shown is in data-body, data-moment,
// data-bonds and data-broken of the view's element.
(function() {
'use strict';

function numbers(text) {
  var bytes = atob(text), out = new Uint16Array(bytes.length / 2);
  for (var i = 0; i < out.length; ++i)
    out[i] = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
  return out;
}

function unpack(data) {
  var side = [ 0, 1, 2 ].map(function(k) { return data.high[k] - data.low[k]; });
  function positions(text) { // centred on the box
    var n = numbers(text), out = new Float32Array(n.length);
    for (var i = 0; i < n.length; ++i)
      out[i] = (n[i] / 65535 - 0.5) * side[i % 3];
    return out;
  }
  return data.moments.map(function(m) {
    return {
      name : m.name,
      time : m.time_us,
      xyz : positions(m.xyz),
      radius : numbers(m.radius_nm),
      body : numbers(m.body),
      ends : positions(m.ends),
      owner : numbers(m.owner),
      intact : numbers(m.intact)
    };
  });
}

function colourOf(body) { // as in the pictures
  if (!body)
    return new THREE.Color(0x606060);
  return new THREE.Color().setHSL((body * 0.61803398875) % 1, body % 2 ? 0.55 : 0.7,
                                  body % 3 ? 0.62 : 0.5);
}

function Explorer(root, data) {
  this.root = root;
  this.moments = unpack(data);
  this.bodies = data.bodies;
  this.height = data.high[2] - data.low[2];
  this.moment = Math.min(1, this.moments.length - 1);
  this.body = 0;
  this.showCbd = true;
  this.makeScene();
  this.makeControls();
  this.show();
}

Explorer.prototype.makeScene = function() {
  var canvas = this.root.querySelector('canvas'), self = this;
  this.renderer =
      new THREE.WebGLRenderer({canvas : canvas, antialias : true, preserveDrawingBuffer : true});
  this.renderer.setClearColor(0xffffff);
  this.scene = new THREE.Scene();
  this.camera = new THREE.PerspectiveCamera(30, 1, 0.1, 2000);
  this.camera.up.set(0, 0, 1);
  this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8890a0, 0.85));
  var sun = new THREE.DirectionalLight(0xffffff, 0.45);
  sun.position.set(1, -2, 3);
  this.scene.add(sun);
  this.orbit = new THREE.OrbitControls(this.camera, canvas);
  this.orbit.addEventListener('change', function() { self.render(); });
  this.ball = new THREE.SphereBufferGeometry(1, 14, 10);
  this.rod = new THREE.CylinderBufferGeometry(1, 1, 1, 6);
  this.lookAtAll();
  var pressed = null;
  canvas.addEventListener('pointerdown', function(e) { pressed = [ e.clientX, e.clientY ]; });
  canvas.addEventListener('pointerup', function(e) {
    if (pressed && Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) < 4)
      self.select(self.pick(e));
  });
  window.addEventListener('resize', function() { self.resize(); });
};

Explorer.prototype.look = function(target, distance) {
  this.orbit.target.copy(target);
  this.camera.position.set(0.62, -0.72, 0.32).multiplyScalar(distance).add(target);
  this.orbit.update();
};

Explorer.prototype.lookAtAll =
    function() { this.look(new THREE.Vector3(0, 0, 0), 2 * this.height); };

Explorer.prototype.makeControls = function() {
  var self = this, bar = this.root.querySelector('.view-controls');
  this.buttons = this.moments.map(function(m, i) {
    var b = document.createElement('button');
    b.textContent = m.name;
    b.onclick = function() {
      self.moment = i;
      self.show();
    };
    bar.appendChild(b);
    return b;
  });
  var cbd = document.createElement('button');
  cbd.textContent = 'carbon-binder spheres on/off';
  cbd.onclick = function() {
    self.showCbd = !self.showCbd;
    self.show();
  };
  bar.appendChild(cbd);
  var list = this.list = document.createElement('select');
  list.setAttribute('aria-label', 'Secondary particle');
  list.add(new Option('whole electrode', 0));
  this.bodies.slice()
      .sort(function(a, b) { return b.broken_fraction - a.broken_fraction; })
      .forEach(function(b) {
        list.add(new Option('particle ' + b.body + ': ' + (100 * b.broken_fraction).toFixed(0) +
                                ' % of ' + b.bonds + ' bonds broken',
                            b.body));
      });
  list.onchange = function() { self.select(+list.value); };
  bar.appendChild(list);
};

Explorer.prototype.select = function(body) {
  var whole = !body;
  this.body = body || 0;
  this.list.value = this.body;
  this.show();
  if (whole)
    return this.lookAtAll();
  var m = this.moments[this.moment], centre = new THREE.Vector3(), n = 0;
  for (var i = 0; i < m.body.length; ++i)
    if (m.body[i] === this.body) {
      centre.add(new THREE.Vector3().fromArray(m.xyz, 3 * i));
      ++n;
    }
  this.look(centre.multiplyScalar(1 / Math.max(1, n)), 8 + 4 * Math.cbrt(n));
};

// The body whose sphere the ray meets first; 0 if it meets none.
Explorer.prototype.pick = function(event) {
  var box = this.renderer.domElement.getBoundingClientRect(), m = this.moments[this.moment];
  var ray = new THREE.Raycaster();
  ray.setFromCamera({
    x : 2 * (event.clientX - box.left) / box.width - 1,
    y : 1 - 2 * (event.clientY - box.top) / box.height
  },
                    this.camera);
  var nearest = Infinity, body = 0, hit = new THREE.Vector3(), sphere = new THREE.Sphere();
  for (var i = 0; i < m.body.length; ++i) {
    if (!m.body[i] && !this.showCbd)
      continue;
    sphere.center.fromArray(m.xyz, 3 * i);
    sphere.radius = m.radius[i] / 1000;
    if (!ray.ray.intersectSphere(sphere, hit))
      continue;
    var d = hit.distanceTo(ray.ray.origin);
    if (d < nearest) {
      nearest = d;
      body = m.body[i];
    }
  }
  return body;
};

Explorer.prototype.instances = function(geometry, material, matrices) {
  if (!matrices.length)
    return;
  // A geometry of its own: three.js r111 would draw all meshes of one geometry at the first one's
  // places.
  var mesh = new THREE.InstancedMesh(geometry.clone(), material, matrices.length);
  matrices.forEach(function(matrix, i) { mesh.setMatrixAt(i, matrix); });
  mesh.frustumCulled = false;
  this.shown.add(mesh);
};

Explorer.prototype.addSpheres = function(m) {
  var of = {}, self = this;
  for (var i = 0; i < m.body.length; ++i) {
    var b = m.body[i], r = m.radius[i] / 1000;
    if (this.body ? b !== this.body : !b && !this.showCbd)
      continue;
    (of[b] = of[b] || [])
        .push(new THREE.Matrix4().makeScale(r, r, r).setPosition(m.xyz[3 * i], m.xyz[3 * i + 1],
                                                                 m.xyz[3 * i + 2]));
  }
  Object.keys(of).forEach(function(b) {
    self.instances(self.ball, new THREE.MeshLambertMaterial({
      color : colourOf(+b),
      transparent : !!self.body,
      opacity : self.body ? 0.16 : 1,
      depthWrite : !self.body
    }),
                   of[b]);
  });
};

Explorer.prototype.addBonds = function(m) {
  var rods = [ [], [] ], up = new THREE.Vector3(0, 1, 0), a = new THREE.Vector3(),
      b = new THREE.Vector3();
  for (var i = 0; i < m.owner.length; ++i) {
    if (m.owner[i] !== this.body)
      continue;
    a.fromArray(m.ends, 6 * i);
    b.fromArray(m.ends, 6 * i + 3);
    var along = b.clone().sub(a), length = along.length(), thick = m.intact[i] ? 0.12 : 0.2;
    rods[m.intact[i] ? 1 : 0].push(new THREE.Matrix4().compose(
        a.clone().add(b).multiplyScalar(0.5),
        new THREE.Quaternion().setFromUnitVectors(up, along.normalize()),
        new THREE.Vector3(thick, length, thick)));
  }
  this.instances(this.rod, new THREE.MeshLambertMaterial({color : 0xcd1923}), rods[0]);
  this.instances(this.rod, new THREE.MeshLambertMaterial({color : 0x5b7aa3}), rods[1]);
  return [ rods[0].length, rods[1].length ];
};

Explorer.prototype.show = function() {
  if (this.shown)
    this.scene.remove(this.shown);
  this.shown = new THREE.Group();
  this.scene.add(this.shown);
  var m = this.moments[this.moment], self = this;
  this.addSpheres(m);
  var counts = this.body ? this.addBonds(m) : [ 0, 0 ];
  this.buttons.forEach(function(b, i) { b.setAttribute('aria-pressed', i === self.moment); });
  this.root.dataset.body = this.body;
  this.root.dataset.moment = this.moment;
  this.root.dataset.broken = counts[0];
  this.root.dataset.bonds = counts[0] + counts[1];
  this.report(m, counts);
  this.resize();
};

Explorer.prototype.report = function(m, counts) {
  var text =
      'Click a particle to see its bonds. Drag to rotate, wheel to zoom, right button to move.';
  var row = this.bodies.filter(function(b) { return b.body === this.body; }, this)[0];
  if (this.body)
    text =
        'Particle ' + this.body + ', ' + m.name.toLowerCase() + ': ' + (counts[0] + counts[1]) +
        ' bonds, ' + counts[0] + ' broken (red).' +
        (row ? ' At the end: ' + row.fragments + ' fragments, the largest ' +
                   (100 * row.largest_fragment).toFixed(0) + ' % of it; depth ' +
                   row.depth_um.toFixed(1) + ' µm; ' + (row.cracked ? 'cracked.' : 'not cracked.')
             : '') +
        ' Click the background for the whole electrode.';
  this.root.querySelector('.view-text').textContent = text;
};

Explorer.prototype.resize = function() {
  var canvas = this.renderer.domElement, width = canvas.parentNode.clientWidth,
      height = Math.min(620, 1.3 * width);
  this.renderer.setPixelRatio(window.devicePixelRatio || 1);
  this.renderer.setSize(width, height);
  this.camera.aspect = width / height;
  this.camera.updateProjectionMatrix();
  this.render();
};

Explorer.prototype.render = function() { this.renderer.render(this.scene, this.camera); };

function start() {
  var roots = document.querySelectorAll('.view');
  for (var i = 0; i < roots.length; ++i)
    try {
      var view = new Explorer(roots[i], JSON.parse(roots[i].querySelector('script').textContent));
      var asked = i ? [] : location.hash.slice(1).split('&');
      asked.forEach(function(word) {
        var pair = word.split('=');
        if (pair[0] === 'moment' && view.moments[+pair[1]]) {
          view.moment = +pair[1];
          view.show();
        }
        if (pair[0] === 'body')
          view.select(+pair[1]);
      });
    } catch (e) {
      roots[i].dataset.error = e.message;
      roots[i].querySelector('canvas').style.display = 'none';
      roots[i].querySelector('.view-text').textContent =
          'This browser does not show 3-D graphics (WebGL): ' + e.message;
    }
}
start();
})();
