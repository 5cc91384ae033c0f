'use strict';

/**
 * A chart over the path, with a cursor at the position that the scene shows. A click goes to another position.
 * Subclasses draw with: `begin`, their own shapes, `finish`.
 */
class Chart {
  /**
   * @param seek called with the position that is clicked, in [0, 1]. @param hover called with the position under the
   * mouse, or null.
   */
  constructor(parent, label, seek, hover = () => {}) {
    Object.assign(this, {parent, label, seek, hover, width: 284, height: 132, left: 52, top: 10, at: 0});
    this.right = this.width - 8;
    this.bottom = this.height - 20;
    this.x = (at) => this.left + at * (this.right - this.left);
  }

  /**
   * Begins a new drawing. @param y the function from values to pixels. @param ticks the values with grid lines. @param
   * text the label of a tick.
   */
  begin(y, ticks, text) {
    this.y = y;
    this.svg = this.element('svg', {viewBox: `0 0 ${this.width} ${this.height}`, role: 'img', 'aria-label': this.label});
    for (const value of ticks) {
      this.line(this.left, y(value), this.right, y(value), {stroke: '#eceae5'});
      this.add('text', {x: this.left - 6, y: y(value) + 3.5, 'text-anchor': 'end'}, text(value));
    }
  }

  /** Draws a curve through points, given as strings "x,y". */
  curve(points, stroke) {
    this.add('polyline', {points: points.join(' '), fill: 'none', stroke, 'stroke-width': 1.5, 'stroke-linejoin': 'round'});
  }
  /**
   * Draws a dashed line at a value. A label, `word`, stands above the end of the line, left of the labels `words` that
   * stand there already.
   */
  level(value, stroke, word = '', words = '') {
    this.line(this.left, this.y(value), this.right, this.y(value), {stroke, 'stroke-dasharray': '4 3'});
    if (word) this.add('text', {x: this.right - 7 * words.length, y: this.y(value) - 3, 'text-anchor': 'end'}, word);
  }

  finish() {
    const {left, right, top, bottom} = this;
    if (path.states.length <= 400) for (const i of path.states) this.line(this.x(path.at[i]), bottom, this.x(path.at[i]), bottom + 4, {stroke: '#b5b8bc'});
    for (const i of path.findings) this.line(this.x(path.at[i]), top, this.x(path.at[i]), bottom, {stroke: palette.alarm, opacity: 0.6});
    const [first, last] = path.times ? path.times.map((time) => `${digits(time)} s`) : ['start', data.verdict.reaches_goal ? 'goal' : 'end'];
    this.add('text', {x: left, y: bottom + 15}, first);
    this.add('text', {x: right, y: bottom + 15, 'text-anchor': 'end'}, last);
    this.cursor = this.line(0, top, 0, bottom, {stroke: palette.ink, 'stroke-width': 1});
    this.parent.replaceChildren(this.svg);
    const place = (event) => {
      const box = this.svg.getBoundingClientRect(), x = (event.clientX - box.left) / box.width * this.width;
      return Math.min(1, Math.max(0, (x - left) / (right - left)));
    };
    this.svg.addEventListener('pointerdown', (event) => { this.svg.setPointerCapture(event.pointerId); this.seek(place(event)); });
    this.svg.addEventListener('pointermove', (event) => {
      if (event.buttons & 1) this.seek(place(event));
      if (event.pointerType === 'mouse') this.hover(place(event));
    });
    this.svg.addEventListener('pointerleave', () => this.hover(null));
  }

  element(tag, attributes) {
    const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    return element;
  }
  add(tag, attributes, text = '') {
    const element = this.element(tag, attributes);
    element.textContent = text;
    this.svg.append(element);
    return element;
  }
  line(x1, y1, x2, y2, more) { return this.add('line', {x1, y1, x2, y2, ...more}); }

  goTo(at) {
    this.at = at;
    this.cursor.setAttribute('x1', this.x(at));
    this.cursor.setAttribute('x2', this.x(at));
  }
}

/**
 * The closest pair's distance over the path, with the margin, the proved clearance, and the edges that are not proved.
 */
class DistanceChart extends Chart {
  constructor(parent, closest, seek, hover) {
    super(parent, 'Distance of the closest pair along the path', seek, hover);
    this.closest = closest;
    this.draw(false);
  }

  /**
   * @param decades true: a logarithmic scale, which shows micrometres as well as metres; contact is at the lower end of
   * the scale.
   */
  draw(decades) {
    const {closest, right, top, bottom} = this, margin = data.solution.margin_m, proved = data.verdict.proved_clearance_m;
    const most = closest.metres.reduce((a, b) => Math.max(a, b), 2 * margin) || 1;
    const least = closest.metres.reduce((a, b) => b > 0 ? Math.min(a, b) : a, most);
    const lowest = 10 ** Math.floor(Math.log10(least) - 1e-9), highest = 10 ** Math.ceil(Math.log10(most) + 1e-9);
    const share = (d) => decades ? Math.max(0, Math.log10(d / lowest) / Math.log10(highest / lowest)) : d / most;
    this.begin((d) => bottom - (d > 0 ? share(d) : 0) * (bottom - top), decades ? powers(lowest, highest) : niceTicks(0, most), metres);
    for (const {edge} of data.verdict.findings) {
      const [from, to] = [edge, edge + 1].map((state) => this.x(path.at[path.states[Math.min(state, path.states.length - 1)]]));
      this.add('rect', {x: from, y: top, width: to - from, height: bottom - top, fill: palette.alarm, opacity: 0.08});
    }
    const points = Array.from(closest.metres, (d, i) => `${this.x(closest.at[i]).toFixed(2)},${this.y(d).toFixed(2)}`);
    this.add('polygon', {points: `${this.x(closest.at[0])},${bottom} ${points.join(' ')} ${right},${bottom}`, fill: palette.robots[0], opacity: 0.1});
    this.curve(points, palette.robots[0]);
    if (margin > 0) this.level(margin, palette.goal, 'margin');
    const isNear = margin > 0 && Math.abs(this.y(proved) - this.y(margin)) < 12;
    if (proved > 0) this.level(proved, palette.start, 'proved', isNear ? 'margin' : '');
    this.finish();
    this.dot = this.add('circle', {r: 3.5, fill: palette.witness, stroke: '#fff', 'stroke-width': 1.5});
    this.goTo(this.at);
  }

  goTo(at) {
    super.goTo(at);
    this.dot.setAttribute('cx', this.x(at));
    this.dot.setAttribute('cy', this.y(this.closest.metres[this.closest.indexAt(at)]));
  }
}

/** Returns powers of ten in a range: about five at most. */
function powers(lowest, highest) {
  const count = Math.round(Math.log10(highest / lowest)), step = Math.ceil(count / 5);
  return Array.from({length: Math.floor(count / step) + 1}, (_, i) => lowest * 10 ** (i * step));
}

/** Returns about three values in a range that have few digits. */
function niceTicks(least, most) {
  const step = roundDown((most - least) / 2), first = Math.ceil(least / step - 1e-9);
  return Array.from({length: Math.floor(most / step + 1e-9) - first + 1}, (_, i) => (first + i) * step);
}
