'use strict';

/** A chart of the closest pair's distance over the path, with a cursor at the place that is shown. A click shows another place. */
class Chart {
  constructor(parent, closest, margin, seek) {
    Object.assign(this, {parent, closest, margin, seek, width: 284, height: 132, left: 52, top: 10, at: 0});
    this.right = this.width - 8;
    this.bottom = this.height - 20;
    this.x = (at) => this.left + at * (this.right - this.left);
    this.draw(false);
  }

  /** @param decades true: a logarithmic scale, on which micrometres and metres are visible; contact is at its lower end. */
  draw(decades) {
    const {closest, margin, left, right, top, bottom} = this;
    const most = closest.metres.reduce((a, b) => Math.max(a, b), 2 * margin) || 1;
    const least = closest.metres.reduce((a, b) => b > 0 ? Math.min(a, b) : a, most);
    const lowest = 10 ** Math.floor(Math.log10(least) - 1e-9), highest = 10 ** Math.ceil(Math.log10(most) + 1e-9);
    const share = (d) => decades ? Math.max(0, Math.log10(d / lowest) / Math.log10(highest / lowest)) : d / most;
    this.y = (d) => bottom - (d > 0 ? share(d) : 0) * (bottom - top);
    this.svg = this.element('svg', {viewBox: `0 0 ${this.width} ${this.height}`, role: 'img', 'aria-label': 'Distance of the closest pair along the path'});
    const points = Array.from(closest.metres, (d, i) => `${this.x(closest.at[i]).toFixed(2)},${this.y(d).toFixed(2)}`);
    const line = (x1, y1, x2, y2, more) => this.add('line', {x1, y1, x2, y2, ...more});
    for (const d of decades ? powers(lowest, highest) : niceTicks(most)) {
      line(left, this.y(d), right, this.y(d), {stroke: '#eceae5'});
      this.add('text', {x: left - 6, y: this.y(d) + 3.5, 'text-anchor': 'end'}, metres(d));
    }
    this.add('polygon', {points: `${this.x(closest.at[0])},${bottom} ${points.join(' ')} ${right},${bottom}`, fill: palette.robots[0], opacity: 0.1});
    this.add('polyline', {points: points.join(' '), fill: 'none', stroke: palette.robots[0], 'stroke-width': 1.5, 'stroke-linejoin': 'round'});
    if (margin > 0) line(left, this.y(margin), right, this.y(margin), {stroke: palette.goal, 'stroke-dasharray': '4 3'});
    if (margin > 0) this.add('text', {x: right, y: this.y(margin) - 3, 'text-anchor': 'end'}, 'margin');
    for (const i of path.states) line(this.x(path.at[i]), bottom, this.x(path.at[i]), bottom + 4, {stroke: '#b5b8bc'});
    for (const i of path.findings) line(this.x(path.at[i]), top, this.x(path.at[i]), bottom, {stroke: palette.alarm, opacity: 0.6});
    this.add('text', {x: left, y: bottom + 15}, 'start');
    this.add('text', {x: right, y: bottom + 15, 'text-anchor': 'end'}, data.verdict.reaches_goal ? 'goal' : 'end');
    this.cursor = line(0, top, 0, bottom, {stroke: palette.ink, 'stroke-width': 1});
    this.dot = this.add('circle', {r: 3.5, fill: palette.witness, stroke: '#fff', 'stroke-width': 1.5});
    this.parent.replaceChildren(this.svg);
    const pick = (event) => {
      const box = this.svg.getBoundingClientRect(), x = (event.clientX - box.left) / box.width * this.width;
      this.seek(Math.min(1, Math.max(0, (x - left) / (right - left))));
    };
    this.svg.addEventListener('pointerdown', (event) => { this.svg.setPointerCapture(event.pointerId); pick(event); });
    this.svg.addEventListener('pointermove', (event) => { if (event.buttons & 1) pick(event); });
    this.goTo(this.at);
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

  goTo(at) {
    this.at = at;
    const d = this.closest.metres[this.closest.indexAt(at)];
    this.cursor.setAttribute('x1', this.x(at));
    this.cursor.setAttribute('x2', this.x(at));
    this.dot.setAttribute('cx', this.x(at));
    this.dot.setAttribute('cy', this.y(d));
  }
}

/** Returns powers of ten in a range, about five at most. */
function powers(lowest, highest) {
  const count = Math.round(Math.log10(highest / lowest)), step = Math.ceil(count / 5);
  return Array.from({length: Math.floor(count / step) + 1}, (_, i) => lowest * 10 ** (i * step));
}

/** Returns about three round values from 0 to `most`. */
function niceTicks(most) {
  const step = roundDown(most / 2);
  return Array.from({length: Math.floor(most / step * (1 + 1e-9)) + 1}, (_, i) => i * step);
}
