'use strict';

/** The distance of the closest pair over the path, with the place that is shown: an SVG that can be clicked. */
class Chart {
  constructor(parent, closest, margin, seek) {
    this.closest = closest;
    const width = 284, height = 132;
    Object.assign(this, {left: 52, right: width - 8, top: 10, bottom: height - 20});
    const most = Math.max(...closest.metres, 2 * margin) || 1;
    this.x = (at) => this.left + at * (this.right - this.left);
    this.y = (d) => this.bottom - d / most * (this.bottom - this.top);
    this.svg = this.element('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': 'Distance of the closest pair along the path'});
    const points = Array.from(closest.metres, (d, i) => `${this.x(closest.at[i]).toFixed(2)},${this.y(d).toFixed(2)}`);
    const line = (x1, y1, x2, y2, more) => this.add('line', {x1, y1, x2, y2, ...more});
    for (const d of niceTicks(most)) {
      line(this.left, this.y(d), this.right, this.y(d), {stroke: '#eceae5'});
      this.add('text', {x: this.left - 6, y: this.y(d) + 3.5, 'text-anchor': 'end'}, metres(d));
    }
    this.add('polygon', {points: `${this.x(closest.at[0])},${this.bottom} ${points.join(' ')} ${this.right},${this.bottom}`, fill: palette.robots[0], opacity: 0.1});
    this.add('polyline', {points: points.join(' '), fill: 'none', stroke: palette.robots[0], 'stroke-width': 1.5, 'stroke-linejoin': 'round'});
    if (margin > 0) line(this.left, this.y(margin), this.right, this.y(margin), {stroke: palette.goal, 'stroke-dasharray': '4 3'});
    if (margin > 0) this.add('text', {x: this.right, y: this.y(margin) - 3, 'text-anchor': 'end'}, 'margin');
    for (const i of path.states) line(this.x(path.at[i]), this.bottom, this.x(path.at[i]), this.bottom + 4, {stroke: '#b5b8bc'});
    for (const i of path.findings) line(this.x(path.at[i]), this.top, this.x(path.at[i]), this.bottom, {stroke: palette.alarm, opacity: 0.6});
    this.add('text', {x: this.left, y: this.bottom + 15}, 'start');
    this.add('text', {x: this.right, y: this.bottom + 15, 'text-anchor': 'end'}, 'goal');
    this.cursor = line(0, this.top, 0, this.bottom, {stroke: palette.ink, 'stroke-width': 1});
    this.dot = this.add('circle', {r: 3.5, fill: palette.witness, stroke: '#fff', 'stroke-width': 1.5});
    parent.append(this.svg);
    const pick = (event) => {
      const box = this.svg.getBoundingClientRect(), x = (event.clientX - box.left) / box.width * width;
      seek(Math.min(1, Math.max(0, (x - this.left) / (this.right - this.left))));
    };
    this.svg.addEventListener('pointerdown', (event) => { this.svg.setPointerCapture(event.pointerId); pick(event); });
    this.svg.addEventListener('pointermove', (event) => { if (event.buttons & 1) pick(event); });
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
    const d = this.closest.metres[this.closest.indexAt(at)];
    this.cursor.setAttribute('x1', this.x(at));
    this.cursor.setAttribute('x2', this.x(at));
    this.dot.setAttribute('cx', this.x(at));
    this.dot.setAttribute('cy', this.y(d));
  }
}

/** Three or so round values from 0 to `most`. */
function niceTicks(most) {
  const step = roundDown(most / 2);
  return Array.from({length: Math.floor(most / step * (1 + 1e-9)) + 1}, (_, i) => i * step);
}
