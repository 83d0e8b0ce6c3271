// page.js — the report: a gallery of meshes, and for each its 3D view, figures, histograms, worst elements, origin.
'use strict';

const REPORT = JSON.parse(document.getElementById('report').textContent);
const MEASURES = {smallest: 'smallest dihedral angle', largest: 'largest dihedral angle', q: 'Joe–Liu Q'};

function make(tag, attributes, ...children) {
  const e = document.createElement(tag);
  for (const [k, v] of Object.entries(attributes || {})) {
    if (k === 'class') e.className = v;
    else if (k.startsWith('on')) e.addEventListener(k.slice(2), v);
    else if (k in e && k !== 'list') e[k] = v;
    else e.setAttribute(k, v);
  }
  for (const c of children.flat()) if (c !== null && c !== undefined) e.append(c);
  return e;
}
function drawing(tag, attributes, ...children) {
  const e = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [k, v] of Object.entries(attributes || {})) e.setAttribute(k, v);
  e.append(...children);
  return e;
}
const count = n => n.toLocaleString('en-US');
function size(v) { // four digits are enough to read
  if (v === null || v === undefined) return '–';
  const a = Math.abs(v);
  return a >= 1000 ? Math.round(v).toLocaleString('en-US') : String(Number(v.toPrecision(4)));
}
const angle = v => v === null ? '–' : v.toFixed(1) + '°';
const plural = (n, one, many) => count(n) + ' ' + (n === 1 ? one : many);
const css = c => `rgb(${c[0]},${c[1]},${c[2]})`;
const regionName = (m, r) => m.regions.find(k => k.region === r).name;
const bodiesOf = (m, r) => m.bodies.filter(b => b.region === r);
const molecular = m => m.bodies.filter(b => b.molecular); // domains of it, too
const insideAlone = m => m.bodies.every(b => b.molecular); // closed cavities are holes then, and not listed
const pictureOf = m => 'data:image/png;base64,' + document.getElementById('picture-' + m.index).textContent.trim();

function table(columns, rows, onRow) { // columns: [title, class, text of row]
  const body = make('tbody');
  for (const row of rows) {
    const tr = make('tr', onRow ? {class: 'go', onclick: () => { for (const o of body.children) o.classList.remove('on'); tr.classList.add('on'); onRow(row); }} : {},
      columns.map(([, kind, text]) => make('td', {class: kind}, text(row))));
    body.append(tr);
  }
  return make('div', {class: 'scroll'}, make('table', {},
    make('thead', {}, make('tr', {}, columns.map(([title, kind]) => make('th', {class: kind}, title)))), body));
}

// --- histograms ------------------------------------------------------------------------------------------------------

function histogram(d, unit, colour) {
  const width = 420, height = 150, left = 8, bottom = 22, top = 8, bins = d.bins;
  let first = bins.findIndex(n => n > 0), last = bins.length - 1;
  if (first < 0) return make('p', {class: 'note'}, 'no values');
  while (last > first && bins[last] === 0) last--;
  first = Math.max(0, first - 1);
  last = Math.min(bins.length - 1, last + 1);
  const n = last - first + 1, most = Math.max(...bins), w = (width - 2 * left) / n;
  const total = bins.reduce((a, b) => a + b, 0);
  const svg = drawing('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img'});
  const digits = d.width < 1 ? 2 : 0;
  for (let i = first; i <= last; i++) {
    const h = bins[i] > 0 ? Math.max(1, (height - top - bottom) * bins[i] / most) : 0, x = left + (i - first) * w;
    const from = d.low + i * d.width, middle = from + d.width / 2;
    const bar = drawing('rect', {x: x + 0.5, y: height - bottom - h, width: Math.max(0.5, w - 1), height: h, fill: colour(middle)});
    bar.append(drawing('title', {}, `${from.toFixed(digits)}${unit} to ${(from + d.width).toFixed(digits)}${unit}: ${count(bins[i])} (${(100 * bins[i] / total).toPrecision(3)} %)`));
    svg.append(bar);
  }
  svg.append(drawing('line', {x1: left, x2: width - left, y1: height - bottom + 0.5, y2: height - bottom + 0.5, stroke: '#9aa3af'}));
  const every = Math.max(1, Math.ceil(n / 9));
  for (let i = first; i <= last + 1; i += every) {
    const x = left + (i - first) * w;
    svg.append(drawing('line', {x1: x, x2: x, y1: height - bottom, y2: height - bottom + 4, stroke: '#9aa3af'}));
    svg.append(drawing('text', {x, y: height - 6, 'text-anchor': i === first ? 'start' : 'middle'}, (d.low + i * d.width).toFixed(digits) + unit));
  }
  return svg;
}
function histogramCard(title, d, unit, colour, format) {
  return make('div', {class: 'card'}, make('h2', {}, title, make('small', {}, `${format(d.min)} to ${format(d.max)}, mean ${format(d.mean)}`)), histogram(d, unit, colour));
}

// --- one mesh --------------------------------------------------------------------------------------------------------

let view = null; // the one WebGL context of the page, moved from mesh to mesh
const unpacked = new Map();

async function loadLibraries() {
  if (window.THREE) return true;
  const packed = document.getElementById('three');
  if (!packed) return false;
  const text = new TextDecoder().decode(await Unpack.inflate(Unpack.bytesOfBase64(packed.textContent.trim())));
  const script = document.createElement('script');
  script.textContent = text;
  document.head.append(script);
  return true;
}

function figures(m) {
  const bodies = molecular(m), cavities = bodiesOf(m, 3), sum = (list, key) => list.reduce((a, b) => a + b[key], 0);
  const figure = (value, name, kind) => make('div', {class: 'card'}, make('b', {class: kind || ''}, value), make('span', {}, name));
  const q = m.quality, all = [
    figure(count(m.tets), 'tetrahedra'), figure(count(m.points), 'points'), figure(count(m.triangles), 'boundary triangles')];
  if (bodies.length) all.push(figure(size(sum(bodies, 'volume')) + ' Å³', 'molecule, ' + plural(bodies.length, 'body', 'bodies')));
  else all.push(figure(size(sum(m.bodies, 'volume')) + ' Å³', 'volume'));
  all.push(figure(size(m.surface) + ' Å²', 'molecular surface'));
  if (cavities.length) all.push(figure(size(sum(cavities, 'volume')) + ' Å³', plural(cavities.length, 'closed cavity', 'closed cavities')));
  all.push(figure(angle(q.dihedral.min) + ' – ' + angle(q.dihedral.max), 'dihedral angles'), figure(q.joe_liu_q.min.toFixed(3), 'smallest Joe–Liu Q'));
  if (m.valid !== null) all.push(figure(m.valid ? 'valid' : 'not valid', m.valid ? 'conforming, closed boundaries' : m.faults.map(f => f.rule).join(', '), m.valid ? 'good' : 'bad'));
  return make('div', {class: 'figures'}, all);
}

const minus = (a, b) => a.map((x, k) => x - b[k]);
const place = p => p.map(x => x.toFixed(1)).join(', ');

class Detail {
  constructor(m) {
    this.m = m;
    this.centre = m.low.map((l, k) => (l + m.high[k]) / 2);
    this.axis = 'none';
    this.stage = make('div', {class: 'stage', id: 'stage'});
    this.panel = make('div', {class: 'panel'});
    this.element = make('div', {}, figures(m), m.left_out ? make('p', {class: 'note left'}, m.left_out) : null,
      make('div', {class: 'scene'}, this.stage, this.panel), this.tables());
    this.ready = this.start();
  }

  still(text) {
    this.stage.replaceChildren(make('img', {src: pictureOf(this.m), alt: this.m.name}), make('div', {class: 'overlay', style: 'left:12px;top:12px'}, text));
    this.panel.remove();
    this.stage.parentNode.style.gridTemplateColumns = '1fr';
  }

  async start() {
    const m = this.m;
    if (!m.code) return this.still('A still: ' + (m.no_code || 'this page holds no 3D data of this mesh') + '.');
    this.stage.append(make('div', {class: 'wait'}, 'unpacking ' + count(m.code.tets) + ' tetrahedra …'));
    await new Promise(done => setTimeout(done, 20));
    if (!await loadLibraries()) return this.still('A still: this page was made by a tetreport that was built without three.js.');
    if (!unpacked.has(m.index)) {
      unpacked.clear(); // one at a time: they are large
      unpacked.set(m.index, await Unpack.load(document.getElementById('mesh-' + m.index).textContent.trim(), m.code, this.centre));
    }
    this.mesh = unpacked.get(m.index);
    try {
      if (!view) view = new View(this.stage, REPORT.palette);
    } catch (e) {
      return this.still('A still: this browser has no WebGL.');
    }
    view.host = this.stage;
    this.bar = make('div', {class: 'overlay bar'});
    this.legend = make('div', {class: 'overlay legend'});
    this.length = make('div', {class: 'overlay length'});
    this.picked = make('div', {class: 'overlay picked', hidden: true});
    this.stage.replaceChildren(view.renderer.domElement, this.legend, this.bar, this.length, this.picked);
    if (this.observer) this.observer.disconnect();
    this.observer = new ResizeObserver(() => view.host === this.stage && view.resize());
    this.observer.observe(this.stage);
    view.onDraw = () => this.showLength();
    view.onPick = hit => this.showPicked(hit);
    view.show(this.mesh, m);
    this.controls();
    this.setColour(m.colour);
  }

  colourChoices(triangles) {
    const own = Object.keys(this.mesh.labels).filter(n => triangles || this.mesh.labels[n].tet);
    const names = [...(triangles ? ['plain'] : []), 'region', 'body', ...own];
    return names.map(n => [n, n]).concat(Object.entries(MEASURES));
  }
  select(choices, value, onchange, id) {
    return make('select', {id, onchange: e => onchange(e.target.value)}, choices.map(([v, text]) => make('option', {value: v, selected: v === value}, text)));
  }

  controls() {
    const m = this.m;
    const axes = make('div', {class: 'row'}, [['none', 'off'], ['x', 'x'], ['y', 'y'], ['z', 'z'], ...(m.cuts ? [] : [['view', 'facing me']])].map(([a, text]) =>
      make('button', {id: 'cut-' + a, class: a === 'none' ? 'on' : '', onclick: () => this.cutAlong(a)}, text)));
    this.axes = axes;
    this.slider = make('input', {type: 'range', id: 'cut-at', min: 0, max: 1, step: 0.002, value: 0.5, disabled: true, oninput: () => this.moveCut()});
    this.flip = make('input', {type: 'checkbox', id: 'cut-flip', disabled: true, onchange: () => { this.normal = this.normal.map(x => -x); this.slider.value = 1 - this.slider.value; this.moveCut(); }});
    const home = ['x', 'y', 'z'].map((a, k) => make('button', {onclick: () => view.lookFrom([0, 0, 0].map((_, i) => i === k ? 1 : 0)), title: 'look along ' + a}, a));
    this.panel.replaceChildren(
      make('div', {class: 'card'}, make('h2', {}, 'Colours'),
        make('label', {}, 'surface'), this.select(this.colourChoices(true), m.colour, v => this.setColour(v), 'colour'),
        make('label', {}, 'tetrahedra at the cut'), this.select(this.colourChoices(false), 'smallest', v => { view.colourCutBy(v); this.showLegends(); }, 'cut-colour'),
        make('label', {class: 'check'}, make('input', {type: 'checkbox', checked: true, onchange: e => view.setEdges(e.target.checked)}), 'edges')),
      make('div', {class: 'card'}, make('h2', {}, 'Cut'), axes, make('label', {}, 'place', this.cutText = make('span', {})), this.slider,
        make('label', {class: 'check'}, this.flip, 'the other side'),
        m.cut_note ? make('p', {class: 'note'}, m.cut_note) : null),
      make('div', {class: 'card'}, make('h2', {}, 'View'),
        make('div', {class: 'row'}, make('button', {id: 'home', onclick: () => view.home()}, 'whole'), home),
        make('div', {class: 'row', style: 'margin-top:6px'}, make('button', {onclick: () => this.save()}, 'save a picture')),
        make('p', {class: 'note'}, 'Drag to turn, right button to move, wheel to zoom, click to ask what is there.')),
      this.bodyList());
  }

  bodyList() {
    const m = this.m, card = make('div', {class: 'card'}, make('h2', {}, 'Shown'));
    this.boxes = [];
    for (const region of [...new Set(m.bodies.map(b => b.region))]) {
      const own = m.bodies.map((b, i) => [b, i]).filter(([b]) => b.region === region);
      const inputs = own.slice(0, 400).map(([b, i]) => {
        const input = make('input', {type: 'checkbox', checked: view.shown[i], onchange: e => { view.setShown(i, e.target.checked); settle(); this.rangeChanged(); }});
        this.boxes[i] = input;
        return [b, i, input];
      });
      const whole = make('input', {type: 'checkbox', id: 'show-region-' + region, onchange: e => {
        for (const [, i] of own) view.setShown(i, e.target.checked);
        settle();
        this.rangeChanged();
      }});
      const settle = () => {
        const on = own.filter(([, i]) => view.shown[i]).length;
        whole.checked = on === own.length;
        whole.indeterminate = on > 0 && on < own.length;
        for (const [, i, input] of inputs) input.checked = view.shown[i];
      };
      const what = region === 1 ? plural(own.length, 'body', 'bodies') : region === 3 ? plural(own.length, 'closed cavity', 'closed cavities') : regionName(m, region);
      card.append(make('label', {class: 'check'}, whole, make('span', {}, what), make('small', {}, size(own.reduce((s, [b]) => s + b.volume, 0)) + ' Å³')));
      if (own.length > 1)
        card.append(make('div', {class: 'list'}, inputs.map(([b, i, input], k) => make('label', {class: 'check'}, input, make('span', {}, `${region === 1 ? 'body' : region === 3 ? 'cavity' : 'part'} ${k + 1}`), make('small', {}, size(b.volume) + ' Å³'))),
          own.length > inputs.length ? make('p', {class: 'note'}, `and ${own.length - inputs.length} smaller ones, switched together above`) : null));
      settle();
      (this.settle = this.settle || []).push(settle);
    }
    return card;
  }

  // --- the cut

  cutAlong(axis) {
    this.axis = axis;
    for (const b of this.axes.children) b.classList.toggle('on', b.id === 'cut-' + axis);
    const on = axis !== 'none';
    this.slider.disabled = this.flip.disabled = !on;
    view.setMark(null);
    if (!on) {
      this.cutText.textContent = '';
      view.setPlane(null);
      this.showLegends();
      return;
    }
    this.normal = axis === 'view' ? view.towards() : [0, 1, 2].map(k => 'xyz'[k] === axis ? Math.sign(view.towards()[k]) || 1 : 0);
    this.flip.checked = false;
    this.slider.value = 0.5;
    this.rangeChanged();
    this.showLegends();
  }
  rangeChanged() {
    if (this.axis !== 'none') this.moveCut();
    this.showLegends();
  }
  moveCut() {
    const [low, high] = view.span(this.normal), t = Number(this.slider.value);
    this.setPlane({normal: this.normal, offset: low + t * (high - low)});
  }
  setPlane(plane) {
    const c = this.centre, n = plane.normal, snapped = this.snap(plane);
    this.cutText.textContent = this.axis === 'view' ? '' : ` ${this.axis} = ${(snapped.offset * (n[0] + n[1] + n[2]) + c[['x', 'y', 'z'].indexOf(this.axis)]).toFixed(1)} Å`;
    view.setPlane(snapped);
  }
  snap(plane) { // where the page holds tetrahedra at some places only
    const at = this.m.cuts, k = ['x', 'y', 'z'].indexOf(this.axis);
    if (!at || k < 0) return plane;
    const sign = plane.normal[k], value = plane.offset * sign + this.centre[k];
    const nearest = at[k].reduce((a, b) => Math.abs(b - value) < Math.abs(a - value) ? b : a);
    return {normal: plane.normal, offset: (nearest - this.centre[k]) * sign};
  }

  // --- colours and what they mean

  setColour(name) {
    view.colourBy(name);
    this.showLegends();
  }
  namesOf(name) {
    const m = this.m;
    if (name === 'region') return [...new Set(m.bodies.map(b => b.region))].map(r => [regionName(m, r), r - 1]);
    if (name === 'body') {
      let n = {};
      return m.bodies.map((b, i) => { n[b.region] = (n[b.region] || 0) + 1; return [`${b.region === 1 ? 'body' : regionName(m, b.region)} ${n[b.region]}`, i]; });
    }
    return this.mesh.labels[name].names.map((t, i) => [t, i]);
  }
  showLegends() {
    const cut = view.plane && view.cutBy in MEASURES ? view.cutBy : null, surface = view.surfaceBy;
    const measure = cut || (surface in MEASURES ? surface : null);
    this.bar.hidden = !measure;
    if (measure) {
      const [low, high] = view.measureRange(measure), unit = measure === 'q' ? '' : '°', digits = measure === 'q' ? 2 : 1;
      const reverse = measure === 'largest', stops = [];
      for (let i = 0; i <= 16; i++) stops.push(css(view.rampColour(reverse ? 1 - i / 16 : i / 16)));
      const span = high - low, step = [0.05, 0.1, 0.2, 1, 2, 5, 10, 20, 30].find(s => span / s <= 6) || 30;
      const ticks = [low];
      for (let v = Math.ceil(low / step) * step; v < high; v += step) if (v - low > 0.16 * span && high - v > 0.16 * span) ticks.push(v);
      ticks.push(high);
      this.bar.replaceChildren(make('b', {}, MEASURES[measure]), ' of a tetrahedron',
        make('div', {class: 'ramp', style: `background:linear-gradient(to right,${stops.join(',')})`}),
        make('div', {class: 'ticks'},
          ticks.map((v, i) => make('span', {style: `left:${span > 0 ? 100 * (v - low) / span : 0}%`}, (i === 0 || i === ticks.length - 1 ? v.toFixed(digits) : String(Number(v.toFixed(2)))) + unit))));
    }
    const groups = [];
    const list = (title, name) => {
      const all = this.namesOf(name), most = 16, rows = all.slice(0, all.length > most ? most - 1 : most);
      groups.push(make('div', {}, make('b', {}, title)), ...rows.map(([text, i]) => make('div', {}, make('i', {style: 'background:' + css(view.labelColour(i))}), text)));
      if (rows.length < all.length) groups.push(make('div', {}, `and ${count(all.length - rows.length)} more`));
    };
    if (surface !== 'plain' && !(surface in MEASURES)) list(surface, surface);
    if (view.plane && !(view.cutBy in MEASURES) && view.cutBy !== surface) list(view.cutBy + ', at the cut', view.cutBy);
    this.legend.hidden = groups.length === 0;
    this.legend.replaceChildren(...groups);
  }
  showLength() {
    if (!this.length) return;
    const scale = view.pixelsPerAngstrom(), most = 150 / scale;
    let step = Math.pow(10, Math.floor(Math.log10(most)));
    step *= most >= 5 * step ? 5 : most >= 2 * step ? 2 : 1;
    this.length.replaceChildren(`${size(step)} Å`, make('i', {style: `width:${step * scale}px`}));
  }

  showPicked(hit) {
    if (!hit) { this.picked.hidden = true; return; }
    const m = this.mesh, t = hit.tet !== undefined ? hit.tet : m.face[hit.triangle] >> 2, c = [0, 1, 2, 3].map(i => m.corner[4 * t + i]);
    const shape = shapeOf(m.position, ...c), facts = [];
    for (const [name, label] of Object.entries(m.labels)) {
      const i = hit.triangle !== undefined ? view.triangleLabel(name, hit.triangle) : view.tetLabel(name, t);
      if (i >= 0 && label.names[i] !== undefined) facts.push(`${name} ${label.names[i]}`);
    }
    const at = [0, 1, 2].map(k => c.reduce((s, v) => s + m.position[3 * v + k] / 4, 0) + this.centre[k]);
    this.picked.hidden = false;
    this.picked.replaceChildren(make('b', {}, hit.tet !== undefined ? 'tetrahedron at the cut' : 'surface'), make('br'), facts.join(', '), facts.length ? make('br') : '',
      `angles ${angle(shape[0])} to ${angle(shape[1])}, Q ${shape[2].toFixed(3)}, at ${place(at)} Å`);
  }

  save() {
    view.draw();
    make('a', {href: view.renderer.domElement.toDataURL('image/png'), download: this.m.name.replace(/\.vtu$/, '') + '.png'}).click();
  }

  goToWorst(w) {
    if (!this.mesh || w.place < 0) return;
    this.axis = 'view';
    for (const b of this.axes.children) b.classList.toggle('on', b.id === 'cut-view');
    const plane = view.goToTet(w.place);
    this.normal = plane.normal;
    this.slider.disabled = this.flip.disabled = false;
    const [low, high] = view.span(plane.normal);
    this.slider.value = high > low ? (plane.offset - low) / (high - low) : 0.5;
    this.cutText.textContent = '';
    for (const s of this.settle) s();
    this.showLegends();
    this.picked.hidden = false;
    this.picked.replaceChildren(make('b', {}, `element ${w.tet}`), make('br'), `angles ${angle(w.min)} to ${angle(w.max)}, Q ${w.q.toFixed(3)}, at ${place(w.centre)} Å`, w.residue ? make('br') : '', w.residue);
    this.stage.scrollIntoView({block: 'nearest'});
  }
  goToBody(b) {
    if (!this.mesh) return;
    const i = this.m.bodies.indexOf(b), reach = Math.max(...b.high.map((h, k) => h - b.low[k]));
    if (!view.shown[i]) view.setShown(i, true);
    for (const s of this.settle) s();
    if (b.region === 3) { // it lies inside: cut through it
      this.cutAlong('view');
      const offset = minus(b.centre, this.centre).reduce((s, x, k) => s + x * this.normal[k], 0), [low, high] = view.span(this.normal);
      this.slider.value = high > low ? (offset - low) / (high - low) : 0.5;
      this.moveCut();
    }
    view.goTo(minus(b.centre, this.centre), 2.5 * reach);
    this.stage.scrollIntoView({block: 'nearest'});
  }

  // --- below the scene

  tables() {
    const m = this.m, q = m.quality;
    const shade = (d, worse) => v => { // as at the cut where it is the same measure
      const x = Math.max(0, Math.min(1, worse(v)));
      return css(ramp(x));
    };
    const dihedral = v => v < 70.5 ? (v - q.smallest[0]) / (Math.max(q.smallest[1], q.smallest[0] + 1) - q.smallest[0]) : 1 - (v - 70.5) / (Math.max(q.largest[1], 71) - 70.5);
    const columns = make('div', {class: 'columns'},
      histogramCard('Dihedral angles', q.dihedral, '°', shade(q.dihedral, dihedral), angle),
      histogramCard('Joe–Liu Q', q.joe_liu_q, '', shade(q.joe_liu_q, v => v), v => v.toFixed(3)),
      histogramCard('Longest edge over shortest', q.edge_ratio, '', shade(q.edge_ratio, v => 1.3 - v / 4), v => v === null ? '–' : v.toFixed(2)));
    const worst = make('div', {class: 'card half'}, make('h2', {}, 'Worst elements', make('small', {}, 'a click goes there')),
      table([['element', 'n', w => count(w.tet)], ['angles', 'n', w => angle(w.min) + ' – ' + angle(w.max)], ['Q', 'n', w => w.q.toFixed(3)],
        ['region', 'w', w => regionName(m, w.region)], ['residue there', 'w', w => w.residue || '–'], ['centre, Å', 'n', w => place(w.centre)]], m.worst, w => this.goToWorst(w)));
    const names = {};
    const bodies = m.bodies.map(b => { names[b.region] = (names[b.region] || 0) + 1; return [b, `${b.region === 1 ? 'body' : regionName(m, b.region)} ${names[b.region]}`]; });
    columns.append(worst,
      make('div', {class: 'card half'}, make('h2', {}, 'Bodies and cavities', make('small', {}, insideAlone(m) ? 'cavities are holes in a mesh of the inside alone' : 'a click goes there')),
        table([['', 'w', ([, n]) => n], ['volume, Å³', 'n', ([b]) => size(b.volume)], ['area, Å²', 'n', ([b]) => size(b.area)], ['tetrahedra', 'n', ([b]) => count(b.tets)],
          ['centre, Å', 'n', ([b]) => place(b.centre)], ['residues at its surface', 'l', ([b]) => b.residues ? b.residues + (b.residue_count > b.residues_named ? ` and ${b.residue_count - b.residues_named} more` : '') : '–']], bodies, ([b]) => this.goToBody(b))),
      make('div', {class: 'card'}, make('h2', {}, 'Boundaries'),
        table([['', '', b => b.name], ['triangles', 'n', b => count(b.triangles)], ['area, Å²', 'n', b => size(b.area)]], m.boundaries)),
      this.origin());
    return columns;
  }
  origin() {
    const m = this.m, rows = [['file', m.file], ['atoms from', m.source], ['made by', m.creator], ['isovalue', m.isovalue], ['decay rate, Å⁻²', m.decay || null],
      ['box, Å', place(m.low) + '  to  ' + place(m.high)], ['notes', m.notes.join('; ')]].filter(([, v]) => v !== '' && v !== null && v !== undefined);
    const card = make('div', {class: 'card most'}, make('h2', {}, 'Origin'), make('table', {}, rows.map(([k, v]) => make('tr', {}, make('td', {style: 'color:var(--soft);white-space:nowrap'}, k), make('td', {style: 'overflow-wrap:anywhere'}, String(v))))));
    for (const r of m.runs) {
      const seconds = (r.phases || []).reduce((s, p) => s + p.seconds, 0);
      card.append(make('details', {}, make('summary', {}, `${r.tool} ${r.version}: ${size(seconds)} s, ${r.threads} threads, ${size((r.peak_rss_bytes || 0) / 1e6)} MB`),
        make('pre', {}, JSON.stringify({options: r.options, counts: r.counts}, null, 1).replace(/"/g, ''))));
    }
    return card;
  }
}
function ramp(x) { return View.prototype.rampColour.call({palette: REPORT.palette}, x); }

// --- all meshes ------------------------------------------------------------------------------------------------------

class Gallery {
  constructor() {
    this.rows = REPORT.meshes.map(m => ({m, bodies: molecular(m).length, cavities: insideAlone(m) ? null : bodiesOf(m, 3).length,
      volume: (molecular(m).length ? molecular(m) : m.bodies).reduce((s, b) => s + b.volume, 0), area: m.surface}));
    this.kind = this.rows.length > 60 ? 'table' : 'pictures';
    this.key = null;
    this.body = make('div');
    this.columns = [['mesh', '', r => r.m.name, r => r.m.name], ['tetrahedra', 'n', r => r.m.tets, r => count(r.m.tets)], ['points', 'n', r => r.m.points, r => count(r.m.points)],
      ['bodies', 'n', r => r.bodies, r => count(r.bodies)], ['cavities', 'n', r => r.cavities, r => r.cavities === null ? '–' : count(r.cavities)], ['volume, Å³', 'n', r => r.volume, r => size(r.volume)],
      ['surface, Å²', 'n', r => r.area, r => size(r.area)], ['smallest angle', 'n', r => r.m.quality.dihedral.min, r => angle(r.m.quality.dihedral.min)],
      ['largest angle', 'n', r => r.m.quality.dihedral.max, r => angle(r.m.quality.dihedral.max)], ['smallest Q', 'n', r => r.m.quality.joe_liu_q.min, r => r.m.quality.joe_liu_q.min.toFixed(3)],
      ['check', '', r => String(r.m.valid), r => r.m.valid === null ? 'not asked' : make('span', {class: r.m.valid ? 'good' : 'bad'}, r.m.valid ? 'valid' : 'not valid')],
      ['3D', '', r => String(!!r.m.code), r => r.m.code ? 'yes' : 'still']];
    const kinds = make('div', {class: 'row'}, ['pictures', 'table'].map(k => make('button', {class: k === this.kind ? 'on' : '', id: 'as-' + k, onclick: e => {
      this.kind = k;
      for (const b of kinds.children) b.classList.toggle('on', b === e.target);
      this.show();
    }}, k)));
    this.search = make('input', {type: 'search', placeholder: 'find by name', oninput: () => this.show()});
    this.sorting = make('select', {style: 'width:auto', onchange: e => { this.key = e.target.value === '' ? null : Number(e.target.value); this.down = this.key > 0; this.show(); }},
      make('option', {value: ''}, 'in the order given'), this.columns.map(([t], i) => make('option', {value: i}, 'by ' + t)));
    this.element = make('div', {}, make('div', {class: 'tools'}, kinds, this.search, this.sorting), this.body);
    this.show();
  }
  show() {
    const text = this.search.value.toLowerCase();
    let rows = this.rows.filter(r => r.m.name.toLowerCase().includes(text));
    if (this.key !== null) {
      const get = this.columns[this.key][2];
      rows = rows.slice().sort((a, b) => (get(a) < get(b) ? -1 : get(a) > get(b) ? 1 : a.m.index - b.m.index) * (this.down ? -1 : 1));
    }
    if (this.kind === 'pictures') {
      this.body.replaceChildren(make('div', {class: 'gallery'}, rows.map(r => make('figure', {class: 'card', onclick: () => { location.hash = r.m.index; }},
        make('img', {src: pictureOf(r.m), alt: r.m.name, loading: 'lazy'}),
        make('figcaption', {}, make('b', {title: r.m.name}, r.m.name), make('span', {}, `${count(r.m.tets)} tetrahedra, ${size(r.volume)} Å³`),
          make('span', {}, `angles ${angle(r.m.quality.dihedral.min)} – ${angle(r.m.quality.dihedral.max)}` + (r.cavities ? `, ${plural(r.cavities, 'cavity', 'cavities')}` : '')))))));
      return;
    }
    const head = this.columns.map(([t, kind], i) => make('th', {class: kind + ' sort', onclick: () => { this.down = this.key === i ? !this.down : i > 0; this.key = i; this.sorting.value = i; this.show(); }},
      t + (this.key === i ? (this.down ? ' ↓' : ' ↑') : '')));
    this.body.replaceChildren(make('div', {class: 'card'}, make('table', {}, make('thead', {}, make('tr', {}, head)),
      make('tbody', {}, rows.map(r => make('tr', {class: 'go', onclick: () => { location.hash = r.m.index; }}, this.columns.map(([, kind,, text]) => make('td', {class: kind}, text(r)))))))));
  }
}

const PAGE = {report: REPORT, detail: null, gallery: null, get view() { return view; }};
window.molmesh = PAGE;

function route() {
  const several = REPORT.meshes.length > 1, i = several ? parseInt(location.hash.slice(1), 10) : 0;
  const m = REPORT.meshes[i], main = document.querySelector('main'), title = document.querySelector('h1'), about = document.querySelector('header .about');
  document.getElementById('back').hidden = !several || !m;
  if (m) {
    title.textContent = m.name;
    about.textContent = m.source ? 'atoms from ' + m.source.split(' ')[0] : '';
    PAGE.detail = new Detail(m);
    main.replaceChildren(PAGE.detail.element);
    PAGE.ready = PAGE.detail.ready;
  } else {
    title.textContent = REPORT.title;
    about.textContent = plural(REPORT.meshes.length, 'mesh', 'meshes') + ', ' + count(REPORT.meshes.reduce((s, x) => s + x.tets, 0)) + ' tetrahedra';
    PAGE.detail = null;
    if (view) view.mesh = null;
    PAGE.gallery = PAGE.gallery || new Gallery();
    main.replaceChildren(PAGE.gallery.element);
    PAGE.ready = Promise.resolve();
  }
  window.scrollTo(0, 0);
}
window.addEventListener('hashchange', route);
route();
