// view.js — a mesh in 3D: surface by labels, whole tetrahedra at a cut, an element to look at. Needs three.js.
'use strict';

const VERTEX = `
attribute vec3 colour;
attribute vec3 corner;
varying vec3 vColour, vNormal, vView, vCorner;
void main() {
  vColour = colour;
  vCorner = corner;
  vNormal = normalMatrix * normal;
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  vView = view.xyz;
  gl_Position = projectionMatrix * view;
}`;
const FRAGMENT = `
uniform float edges;
varying vec3 vColour, vNormal, vView, vCorner;
void main() {
  vec3 own = cross(dFdx(vView), dFdy(vView));
  vec3 n = normalize(dot(vNormal, vNormal) > 0.25 ? vNormal : own);
  if (n.z < 0.0) n = -n;
  float key = max(0.0, dot(n, vec3(-0.45, 0.55, 0.70)));
  float shine = pow(max(0.0, dot(n, vec3(-0.24, 0.30, 0.92))), 40.0);
  vec3 c = vColour * (0.46 + 0.44 * key + 0.22 * n.z + 0.10 * shine);
  vec3 width = fwidth(vCorner);
  vec3 near = smoothstep(width * 0.35, width * 1.25, vCorner);
  float line = 1.0 - min(min(near.x, near.y), near.z);
  // Where elements are a few pixels wide, lines would hide their colours.
  float fade = clamp(1.1 - 2.6 * max(max(width.x, width.y), width.z), 0.0, 1.0);
  gl_FragColor = vec4(mix(c, vec3(0.08, 0.10, 0.13), line * edges * fade), 1.0);
}`;

// Dihedral angles in degrees: [smallest, largest], and Joe and Liu's Q, of the tetrahedron at these four points.
function shapeOf(p, a, b, c, d) {
  const v = i => [p[3 * i], p[3 * i + 1], p[3 * i + 2]];
  const sub = (x, y) => [x[0] - y[0], x[1] - y[1], x[2] - y[2]];
  const cross = (x, y) => [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
  const dot = (x, y) => x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  const A = v(a), B = v(b), C = v(c), D = v(d);
  const ab = sub(B, A), ac = sub(C, A), ad = sub(D, A), bc = sub(C, B), bd = sub(D, B), cd = sub(D, C);
  const n = [cross(bc, bd), cross(ad, ac), cross(ab, ad), cross(ac, ab)];
  const size = n.map(x => Math.sqrt(dot(x, x)));
  let least = -1, most = 1;
  for (let i = 0; i < 4; i++)
    for (let j = 0; j < i; j++) {
      const cosine = -dot(n[i], n[j]) / (size[i] * size[j]);
      least = Math.max(least, cosine);
      most = Math.min(most, cosine);
    }
  const sum = [ab, ac, ad, bc, bd, cd].reduce((s, e) => s + dot(e, e), 0);
  const degrees = x => Math.acos(Math.max(-1, Math.min(1, x))) * 180 / Math.PI;
  return [degrees(least), degrees(most), 20.784609690826528 * -dot(n[3], ad) / Math.pow(sum, 1.5)];
}

class View {
  // palette: {ramp: [[at, r, g, b]], labels: [[r, g, b]], none, plain} of bytes.
  constructor(host, palette) {
    this.host = host;
    this.palette = palette;
    this.renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    this.renderer.setClearColor(0xffffff);
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    host.appendChild(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.screenSpacePanning = true;
    this.controls.rotateSpeed = 0.8;
    this.controls.addEventListener('change', () => this.draw());
    const material = offset => new THREE.ShaderMaterial({
      vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide, extensions: {derivatives: true},
      uniforms: {edges: {value: 0.5}}, polygonOffset: offset > 0, polygonOffsetFactor: offset, polygonOffsetUnits: offset});
    this.materials = [material(0), material(1)]; // what is cut lies behind the surface on the same points
    this.listeners = [];
    this.onDraw = () => {};
    this.onPick = () => {};
    this.plane = null;
    this.pending = false;
    const canvas = this.renderer.domElement;
    let pressed = null;
    canvas.addEventListener('pointerdown', e => { pressed = [e.clientX, e.clientY]; });
    canvas.addEventListener('pointerup', e => {
      if (pressed && Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) < 4) this.pick(e);
      pressed = null;
    });
    new ResizeObserver(() => this.resize()).observe(host);
  }

  show(mesh, facts) {
    this.setMark(null);
    for (const m of [this.surface, this.cap]) if (m) { this.scene.remove(m); m.geometry.dispose(); }
    this.mesh = mesh;
    this.facts = facts;
    this.order = facts.bodies.map(b => facts.regions.findIndex(r => r.region === b.region));
    this.shown = facts.bodies.map(b => b.region !== 2);
    if (!this.shown.some(s => s)) this.shown.fill(true);
    this.makeSurface();
    const cap = new THREE.BufferGeometry();
    this.cap = new THREE.Mesh(cap, this.materials[1]);
    this.cap.frustumCulled = this.surface.frustumCulled = false;
    this.scene.add(this.surface);
    this.scene.add(this.cap);
    this.colourBy('plain');
    this.cutBy = 'smallest';
    this.setPlane(null);
    this.home();
  }

  makeSurface() {
    const m = this.mesh, n = m.triangles;
    const corners = this.triangle = new Int32Array(3 * n);
    const flat = new Uint8Array(n), boundary = m.labels.boundary;
    for (let i = 0; i < n; i++) {
      const t = m.face[i] >> 2, f = Unpack.FACE[m.face[i] & 3];
      for (let k = 0; k < 3; k++) corners[3 * i + k] = m.corner[4 * t + f[k]];
      if (boundary && /^box_/.test(boundary.names[boundary.tri[i]] || '')) flat[i] = 1;
    }
    // Corners of the curved surface share a normal; which of its senses faces the viewer, the shader decides.
    const sum = new Float32Array(3 * m.points), p = m.position;
    for (let i = 0; i < n; i++) {
      if (flat[i]) continue;
      const [a, b, c] = [corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]];
      const ux = p[3 * b] - p[3 * a], uy = p[3 * b + 1] - p[3 * a + 1], uz = p[3 * b + 2] - p[3 * a + 2];
      const vx = p[3 * c] - p[3 * a], vy = p[3 * c + 1] - p[3 * a + 1], vz = p[3 * c + 2] - p[3 * a + 2];
      const s = m.other[i] >= 0 && this.isFirst(m.other[i], m.body[m.face[i] >> 2]) ? -1 : 1;
      const nx = s * (uy * vz - uz * vy), ny = s * (uz * vx - ux * vz), nz = s * (ux * vy - uy * vx);
      for (const v of [a, b, c]) { sum[3 * v] += nx; sum[3 * v + 1] += ny; sum[3 * v + 2] += nz; }
    }
    const position = new Float32Array(9 * n), normal = new Int8Array(9 * n), corner = new Uint8Array(9 * n);
    for (let i = 0; i < 3 * n; i++) {
      const v = corners[i];
      for (let k = 0; k < 3; k++) position[3 * i + k] = p[3 * v + k];
      corner[3 * i + i % 3] = 255;
      const length = Math.hypot(sum[3 * v], sum[3 * v + 1], sum[3 * v + 2]);
      if (!flat[i / 3 | 0] && length > 0)
        for (let k = 0; k < 3; k++) normal[3 * i + k] = Math.round(127 * sum[3 * v + k] / length);
    }
    const g = new THREE.BufferGeometry();
    const add = (name, array, normalized) => g.setAttribute(name, new THREE.BufferAttribute(array, 3, normalized));
    add('position', position, false);
    add('normal', normal, true);
    add('corner', corner, true);
    add('colour', new Uint8Array(9 * n), true);
    g.setIndex(new THREE.BufferAttribute(new Uint32Array(3 * n), 1));
    this.surface = new THREE.Mesh(g, this.materials[0]);
  }

  // --- colours -------------------------------------------------------------------------------------------------------

  labelColour(i) {
    if (i < 0) return this.palette.none;
    const list = this.palette.labels, c = list[i % list.length], turn = Math.floor(i / list.length) % 3;
    if (turn === 0) return c;
    const [to, share] = turn === 1 ? [[255, 255, 255], 0.4] : [[34, 38, 45], 0.35];
    return c.map((v, k) => Math.round(v + (to[k] - v) * share));
  }
  rampColour(x) {
    const r = this.palette.ramp;
    let i = 1;
    while (i + 1 < r.length && r[i][0] < x) i++;
    const s = Math.max(0, Math.min(1, (x - r[i - 1][0]) / (r[i][0] - r[i - 1][0])));
    return [1, 2, 3].map(k => Math.round(r[i - 1][k] + (r[i][k] - r[i - 1][k]) * s));
  }
  measureRange(measure) {
    const q = this.facts.quality;
    return measure === 'smallest' ? q.smallest : measure === 'largest' ? q.largest : [q.joe_liu_q.min, q.joe_liu_q.max];
  }
  measureColour(measure, tet) {
    if (!this.measured || this.measured.of !== this.mesh || this.measured.measure !== measure)
      this.measured = {of: this.mesh, measure, value: new Float32Array(this.mesh.tets).fill(NaN)};
    const known = this.measured.value, c = this.mesh.corner, i = 4 * tet;
    if (Number.isNaN(known[tet]))
      known[tet] = shapeOf(this.mesh.position, c[i], c[i + 1], c[i + 2], c[i + 3])[measure === 'smallest' ? 0 : measure === 'largest' ? 1 : 2];
    const [low, high] = this.measureRange(measure), x = known[tet];
    const share = high > low ? (x - low) / (high - low) : 1;
    return this.rampColour(measure === 'largest' ? 1 - share : share);
  }
  // Is a surface between two bodies that of the first?
  isFirst(a, b) { return this.order[a] < this.order[b]; }
  // What labels a tetrahedron or a triangle has: 'region', 'body', or one of the mesh's own.
  tetLabel(name, t) {
    const m = this.mesh, body = m.body[t];
    if (name === 'body') return body;
    if (name === 'region') return this.facts.bodies[body].region - 1;
    const label = m.labels[name];
    return label && label.tet ? label.tet[t] : -1;
  }
  triangleLabel(name, i) {
    const m = this.mesh, label = m.labels[name];
    if (label && label.tri) return label.tri[i];
    let t = m.body[m.face[i] >> 2];
    if (name === 'body' || name === 'region') { // of two sides the one that is shown, of both that which the surface is that of
      const o = m.other[i];
      if (o >= 0 && this.shown[o] && (!this.shown[t] || this.isFirst(o, t))) t = o;
      return name === 'body' ? t : this.facts.bodies[t].region - 1;
    }
    return this.tetLabel(name, m.face[i] >> 2);
  }

  colourBy(name) {
    this.surfaceBy = name;
    const m = this.mesh, array = this.surface.geometry.attributes.colour.array;
    const measure = ['smallest', 'largest', 'q'].includes(name);
    for (let i = 0; i < m.triangles; i++) {
      const c = name === 'plain' ? this.palette.plain
        : measure ? this.measureColour(name, m.face[i] >> 2) : this.labelColour(this.triangleLabel(name, i));
      for (let k = 0; k < 9; k++) array[9 * i + k] = c[k % 3];
    }
    this.surface.geometry.attributes.colour.needsUpdate = true;
    this.draw();
  }
  colourCutBy(name) {
    this.cutBy = name;
    this.update();
  }

  // --- the cut -------------------------------------------------------------------------------------------------------

  // plane: {normal, offset} in Å from the centre; what lies beyond is taken away.
  setPlane(plane) {
    this.plane = plane;
    this.update();
  }
  span(normal) { // of the shown bodies along a direction
    const m = this.mesh, p = m.position;
    let low = Infinity, high = -Infinity;
    for (let i = 0; i < m.triangles; i++) {
      const t = m.body[m.face[i] >> 2], o = m.other[i];
      if (!this.shown[t] && !(o >= 0 && this.shown[o])) continue;
      for (let k = 0; k < 3; k++) {
        const v = 3 * this.triangle[3 * i + k], d = normal[0] * p[v] + normal[1] * p[v + 1] + normal[2] * p[v + 2];
        if (d < low) low = d;
        if (d > high) high = d;
      }
    }
    return low <= high ? [low, high] : [0, 0];
  }
  setShown(body, on) {
    this.shown[body] = on;
    if (this.surfaceBy === 'body' || this.surfaceBy === 'region') this.colourBy(this.surfaceBy);
    this.update();
  }

  update() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.updateNow(); });
  }
  updateNow() {
    if (!this.mesh) return;
    const m = this.mesh, p = m.position, shown = this.shown;
    let beyond = null;
    if (this.plane) {
      const {normal: [x, y, z], offset} = this.plane;
      beyond = new Uint8Array(m.points);
      for (let v = 0; v < m.points; v++) if (x * p[3 * v] + y * p[3 * v + 1] + z * p[3 * v + 2] > offset) beyond[v] = 1;
    }
    const index = this.surface.geometry.index, to = index.array, tri = this.triangle;
    let n = 0;
    for (let i = 0; i < m.triangles; i++) {
      const o = m.other[i];
      if (!shown[m.body[m.face[i] >> 2]] && !(o >= 0 && shown[o])) continue;
      if (beyond && beyond[tri[3 * i]] && beyond[tri[3 * i + 1]] && beyond[tri[3 * i + 2]]) continue;
      to[n] = 3 * i; to[n + 1] = 3 * i + 1; to[n + 2] = 3 * i + 2;
      n += 3;
    }
    index.needsUpdate = true;
    this.surface.geometry.setDrawRange(0, n);

    const at = [];
    if (beyond)
      for (let t = 0; t < m.tets; t++) {
        const c = 4 * t, count = beyond[m.corner[c]] + beyond[m.corner[c + 1]] + beyond[m.corner[c + 2]] + beyond[m.corner[c + 3]];
        if (count > 0 && count < 4 && shown[m.body[t]]) at.push(t);
      }
    this.atCut = at;
    const position = new Float32Array(36 * at.length), colour = new Uint8Array(36 * at.length);
    const measure = ['smallest', 'largest', 'q'].includes(this.cutBy);
    at.forEach((t, j) => {
      const c = measure ? this.measureColour(this.cutBy, t) : this.labelColour(this.tetLabel(this.cutBy, t));
      for (let f = 0; f < 4; f++)
        for (let k = 0; k < 3; k++) {
          const v = m.corner[4 * t + Unpack.FACE[f][k]], out = 36 * j + 9 * f + 3 * k;
          for (let a = 0; a < 3; a++) { position[out + a] = p[3 * v + a]; colour[out + a] = c[a]; }
        }
    });
    const corner = new Uint8Array(36 * at.length);
    for (let i = 0; i < 12 * at.length; i++) corner[3 * i + i % 3] = 255;
    this.cap.geometry.dispose();
    const g = this.cap.geometry = new THREE.BufferGeometry();
    g.setAttribute('position', new THREE.BufferAttribute(position, 3));
    g.setAttribute('normal', new THREE.BufferAttribute(new Int8Array(36 * at.length), 3, true));
    g.setAttribute('corner', new THREE.BufferAttribute(corner, 3, true));
    g.setAttribute('colour', new THREE.BufferAttribute(colour, 3, true));
    this.cap.visible = at.length > 0;
    this.draw();
  }

  setEdges(on) {
    for (const m of this.materials) m.uniforms.edges.value = on ? 0.5 : 0;
    this.draw();
  }

  // --- where one looks from ------------------------------------------------------------------------------------------

  home() {
    const a = -60 * Math.PI / 180, e = 25 * Math.PI / 180;
    this.lookFrom([Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)]);
  }
  lookFrom(direction) {
    this.resize();
    const [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(n => this.span(n));
    const target = new THREE.Vector3((x[0] + x[1]) / 2, (y[0] + y[1]) / 2, (z[0] + z[1]) / 2);
    const all = Math.hypot(...this.facts.high.map((h, k) => h - this.facts.low[k])) + 1;
    this.far = 2 * all;
    this.camera.near = -all;
    this.camera.far = 3 * all;
    this.controls.target.copy(target);
    this.camera.position.copy(target).add(new THREE.Vector3(...direction).multiplyScalar(all));
    this.camera.up.set(0, Math.abs(direction[2]) > 0.99 ? 1 : 0, Math.abs(direction[2]) > 0.99 ? 0 : 1);
    this.camera.zoom = 1;
    this.camera.lookAt(target);
    this.camera.updateMatrixWorld();
    const axis = k => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, k).toArray();
    const w = this.span(axis(0)), h = this.span(axis(1));
    this.height = Math.max(h[1] - h[0], (w[1] - w[0]) / this.aspect, 1e-3) * 1.16;
    this.frame();
    this.controls.update();
    this.draw();
  }
  frame() {
    const h = this.height || 1, w = h * this.aspect;
    Object.assign(this.camera, {left: -w / 2, right: w / 2, top: h / 2, bottom: -h / 2});
    this.camera.updateProjectionMatrix();
  }
  towards() { return this.camera.position.clone().sub(this.controls.target).normalize().toArray(); }
  pixelsPerAngstrom() { return this.host.clientHeight * this.camera.zoom / (this.height || 1); }

  goTo(place, size) { // Å from the centre
    const target = new THREE.Vector3(...place), step = target.clone().sub(this.controls.target);
    this.controls.target.copy(target);
    this.camera.position.add(step);
    this.camera.zoom = Math.max(1, this.height / size);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }
  // Cuts just through the element, so that it and those around it are seen whole.
  goToTet(t) {
    const m = this.mesh, p = m.position, corner = [0, 1, 2, 3].map(i => m.corner[4 * t + i]);
    const centre = [0, 1, 2].map(k => corner.reduce((s, v) => s + p[3 * v + k] / 4, 0));
    let size = 0;
    for (const v of corner) size = Math.max(size, Math.hypot(...[0, 1, 2].map(k => p[3 * v + k] - centre[k])));
    if (!this.shown[m.body[t]]) this.shown[m.body[t]] = true;
    const normal = this.towards();
    this.plane = {normal, offset: centre.reduce((s, x, k) => s + x * normal[k], 0)};
    this.updateNow();
    this.setMark(corner);
    this.goTo(centre, 14 * size);
    return {normal, offset: this.plane.offset};
  }
  setMark(corner) {
    for (const m of this.mark || []) { this.scene.remove(m); m.geometry.dispose(); }
    this.mark = null;
    if (!corner) return this.draw();
    const geometry = lists => {
      const g = new THREE.BufferGeometry(), array = [];
      for (const list of lists)
        for (const i of list) array.push(...[0, 1, 2].map(k => this.mesh.position[3 * corner[i] + k]));
      return g.setAttribute('position', new THREE.BufferAttribute(new Float32Array(array), 3));
    };
    const look = {color: 0xd0006f, depthTest: false}; // seen through what is in front of it
    this.mark = [
      new THREE.Mesh(geometry(Unpack.FACE), new THREE.MeshBasicMaterial({...look, side: THREE.DoubleSide, transparent: true, opacity: 0.45})),
      new THREE.LineSegments(geometry(Unpack.EDGE), new THREE.LineBasicMaterial({...look, transparent: true}))];
    for (const m of this.mark) { m.renderOrder = 1; m.frustumCulled = false; this.scene.add(m); }
    this.draw();
  }

  // --- a click -------------------------------------------------------------------------------------------------------

  pick(e) {
    const box = this.renderer.domElement.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera({x: 2 * (e.clientX - box.left) / box.width - 1, y: 1 - 2 * (e.clientY - box.top) / box.height}, this.camera);
    const o = ray.ray.origin, d = ray.ray.direction, p = this.mesh.position;
    let nearest = Infinity, hit = null;
    const v = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()], at = new THREE.Vector3();
    const test = (a, b, c, found) => {
      [a, b, c].forEach((i, k) => v[k].set(p[3 * i], p[3 * i + 1], p[3 * i + 2]));
      if (!ray.ray.intersectTriangle(v[0], v[1], v[2], false, at)) return;
      const depth = (at.x - o.x) * d.x + (at.y - o.y) * d.y + (at.z - o.z) * d.z;
      if (depth < nearest) { nearest = depth; hit = found; }
    };
    const range = this.surface.geometry.drawRange.count, index = this.surface.geometry.index.array;
    for (let k = 0; k < range; k += 3) {
      const i = index[k] / 3;
      test(this.triangle[3 * i], this.triangle[3 * i + 1], this.triangle[3 * i + 2], {triangle: i});
    }
    for (const t of this.atCut)
      for (const f of Unpack.FACE) test(this.mesh.corner[4 * t + f[0]], this.mesh.corner[4 * t + f[1]], this.mesh.corner[4 * t + f[2]], {tet: t});
    this.onPick(hit);
  }

  resize() {
    const w = Math.max(1, this.host.clientWidth), h = Math.max(1, this.host.clientHeight);
    this.aspect = w / h;
    this.renderer.setSize(w, h);
    this.frame();
    this.draw();
  }
  draw() {
    if (!this.mesh) return;
    this.renderer.render(this.scene, this.camera);
    this.onDraw();
  }
}
