// unpack.js — reads the code of a mesh (HTML.md) back into arrays.
'use strict';

const Unpack = (() => {
  const RECENT = 16;

  function bytesOfBase64(text) {
    const binary = atob(text);
    const bytes = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
    return bytes;
  }

  async function inflate(bytes) {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  class Varints {
    constructor(bytes) { this.bytes = bytes; this.at = 0; }
    next() {
      const b = this.bytes;
      let v = b[this.at++];
      if (v < 128) return v;
      v &= 127;
      for (let scale = 128; ; scale *= 128) {
        const c = b[this.at++];
        v += (c & 127) * scale;
        if (c < 128) return v;
      }
    }
    signed() { const v = this.next(); return v % 2 ? -(v + 1) / 2 : v / 2; }
  }

  const FACE = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]; // outwards, opposite to each corner
  const EDGE = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

  // streams: by name. Positions come in Å from `centre`.
  function mesh(code, streams, centre) {
    const tets = code.tets, points = code.points;
    const corner = new Int32Array(4 * tets), parent = new Int32Array(tets).fill(-1);
    const position = new Float32Array(3 * points), grid = new Int32Array(3 * points);
    const recent = new Int32Array(RECENT * points).fill(-1), recents = new Uint8Array(points);
    const faces = streams['faces'], corners = streams['corners'], far = new Varints(streams['far']);
    const low = ['x', 'y', 'z'].map(a => streams['low_' + a]);
    const high = ['x', 'y', 'z'].map(a => new Varints(streams['high_' + a]));
    let at = 0, found = 0;
    const last = [0, 0, 0];

    function put(p, other) {
      const row = RECENT * p;
      for (let i = row; i < row + RECENT; i++) if (recent[i] === other) return;
      recent[row + (recents[p]++ & RECENT - 1)] = other;
    }
    function join(a, b) { put(a, b); put(b, a); }

    // near: a, b, c of the face and d behind it; a < 0: none.
    function add(a, b, c, d) {
      const sign = corners[at++];
      if (sign > 0) {
        if (sign > 3 * RECENT) return found - far.next();
        const age = (sign - 1) / 3 | 0, k = (sign - 1) % 3, p = k === 0 ? a : k === 1 ? b : c;
        return recent[RECENT * p + (recents[p] - 1 - age & RECENT - 1)];
      }
      const v = found++;
      for (let k = 0; k < 3; k++) {
        const predicted = a < 0 ? last[k]
          : Math.floor(2 * (grid[3 * a + k] + grid[3 * b + k] + grid[3 * c + k]) / 3) - grid[3 * d + k];
        const z = high[k].next() * 256 + low[k][v];
        const g = predicted + (z % 2 ? -(z + 1) / 2 : z / 2);
        last[k] = grid[3 * v + k] = g;
        position[3 * v + k] = code.origin[k] + g * code.quantum - centre[k];
      }
      return v;
    }

    const seeds = [];
    let made = 0;
    for (let next = 0; next < tets; next++) {
      if (next === made) { // all that was reached is done: another seed
        seeds.push(next);
        for (let i = 0; i < 4; i++) corner[4 * next + i] = add(-1);
        for (const [i, j] of EDGE) join(corner[4 * next + i], corner[4 * next + j]);
        made++;
      }
      const mask = faces[next];
      for (let f = 0; mask >> f; f++) {
        if (!(mask >> f & 1)) continue;
        const o = 4 * next, n = 4 * made, g = FACE[f];
        const a = corner[o + g[0]], b = corner[o + g[1]], c = corner[o + g[2]];
        const v = add(a, b, c, corner[o + f]);
        corner[n] = a; corner[n + 1] = b; corner[n + 2] = c; corner[n + 3] = v;
        join(v, a); join(v, b); join(v, c);
        parent[made++] = next;
      }
    }

    // Bodies follow each other.
    const body = new Int32Array(tets);
    let from = 0;
    code.body_tets.forEach((n, b) => { body.fill(b, from, from + n); from += n; });

    const triangles = code.triangles, face = new Int32Array(triangles), other = new Int32Array(triangles);
    const faceDelta = new Varints(streams['triangles']), others = new Varints(streams['others']);
    for (let i = 0, f = 0; i < triangles; i++) {
      f += faceDelta.next();
      face[i] = f;
      other[i] = others.next() - 1;
    }

    const labels = {};
    for (const name of code.labels) {
      const text = new TextDecoder().decode(streams['names ' + name]);
      const label = {names: text === '' ? [] : text.slice(0, -1).split('\n')};
      if (streams['tets ' + name]) {
        const v = new Varints(streams['tets ' + name]);
        label.tet = new Int32Array(tets);
        for (let k = 0; k < tets; k++) label.tet[k] = v.signed() + (parent[k] >= 0 ? label.tet[parent[k]] : 0);
      }
      if (streams['triangles ' + name]) {
        const v = new Varints(streams['triangles ' + name]);
        label.tri = new Int32Array(triangles);
        for (let i = 0; i < triangles; i++) label.tri[i] = v.signed() + (label.tet ? label.tet[face[i] >> 2] : 0);
      }
      labels[name] = label;
    }
    return {tets, points, triangles, corner, position, body, face, other, labels};
  }

  async function load(base64, code, centre) {
    const bytes = bytesOfBase64(base64);
    const streams = {};
    let from = 0;
    const parts = code.streams.map(([name, size]) => {
      const part = bytes.subarray(from, from + size);
      from += size;
      return [name, part];
    });
    for (const [name, part] of parts) streams[name] = await inflate(part);
    return mesh(code, streams, centre);
  }

  return {load, inflate, bytesOfBase64, FACE, EDGE};
})();
