'use strict';

const kQuantities = ['position', 'velocity', 'acceleration'];
const kPerSecond = ['', '/s', '/s²'];  // for position, velocity, acceleration: the text after the position's unit
const kDrawnSpans = 600;               // the most spans of a curve; the smallest and largest value of each are drawn

/**
 * The joints of a trajectory. `at` has, for each value, its position on the path. If two values have the same position,
 * they are the values before and after a jump.
 */
const joints = data.plots && data.plots.joints.map((joint, i, all) => ({...joint,
  values: joint.values.map((values) => data.array(values)),
  colour: `hsl(${Math.round(360 * i / all.length + 212) % 360}, 55%, ${i % 2 ? 36 : 48}%)`}));
const plotsAt = data.plots && data.array(data.plots.at);

/** Returns the limits of a joint's position, velocity or acceleration: [lower, upper], or null. */
function limitsOf(joint, quantity) {
  if (quantity === 0) return joint.bounds;
  const limit = quantity === 1 ? joint.velocity : joint.acceleration;
  return limit === null ? null : [-limit, limit];
}
/** Returns "rad/s", or "m/s, rad/s" if the joints have both. */
const unitsOf = (quantity) => [...new Set(joints.map((joint) => joint.unit + kPerSecond[quantity]))].join(', ');

/**
 * A quantity of all joints over time. If all joints have limits, it is drawn in percent of them: 0 and 100 % are the
 * bounds of a position, −100 and 100 % the limits of a velocity or acceleration.
 */
class JointChart extends Chart {
  constructor(parent, quantity, seek, hover) {
    super(parent, `${kQuantities[quantity]} of the joints over the time`, seek, hover);
    const ranges = joints.map((joint) => limitsOf(joint, quantity)), least = quantity === 0 ? 0 : -1;
    this.isShare = ranges.every(Boolean);
    const shown = joints.map((joint, i) => {
      const [lower, upper] = this.isShare ? ranges[i] : [0, 1], from = this.isShare ? least : 0;
      return joint.values[quantity].map((value) => from + (1 - from) * (value - lower) / (upper - lower || 1));
    });
    const all = shown.flatMap((values) => [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))]);
    all.push(...this.isShare ? [least, 1] : quantity > 0 ? [0] : []);
    let low = Math.min(...all), high = Math.max(...all);
    if (!(high > low)) [low, high] = [low - 1, high + 1];
    const {left, right, top, bottom} = this;
    this.begin((value) => bottom - (value - low) / (high - low) * (bottom - top), niceTicks(low, high),
      this.isShare ? (share) => `${digits(100 * share)} %` : (value) => digits(value));
    if (this.isShare) for (const limit of [least, 1]) this.level(limit, palette.goal);
    shown.forEach((values, i) => this.curve(extremes(values).map((k) => `${this.x(plotsAt[k]).toFixed(2)},${this.y(values[k]).toFixed(2)}`), joints[i].colour));
    this.finish();
  }
}

/**
 * Returns the indices of the values to draw: all indices or, if there are many, those of the smallest and largest value
 * of each span.
 */
function extremes(values) {
  if (values.length <= 2 * kDrawnSpans) return [...values.keys()];
  const chosen = [0];
  for (let span = 0; span < kDrawnSpans; ++span) {
    const begin = Math.floor(span * values.length / kDrawnSpans), end = Math.floor((span + 1) * values.length / kDrawnSpans);
    let least = begin, most = begin;
    for (let k = begin; k < end; ++k) {
      if (values[k] < values[least]) least = k;
      if (values[k] > values[most]) most = k;
    }
    chosen.push(Math.min(least, most), Math.max(least, most));
  }
  return [...chosen, values.length - 1];
}

/**
 * The plots of a trajectory below the player, and the table of its joints. All have one cursor: at the position that
 * the scene shows or, while the mouse is over a plot, at the position under the mouse.
 */
class Plots {
  constructor(closest, seek) {
    this.at = 0;
    this.hovered = null;
    const hover = (at) => { this.hovered = at; this.update(); };
    const add = (title, chart) => {
      const box = make('div'), caption = make('figcaption');
      byId('plots').append(make('figure', '', caption, box));
      const made = chart(box);
      caption.textContent = title(made);
      return made;
    };
    this.charts = joints.length ? kQuantities.map((name, quantity) => add(
      (chart) => `${name[0].toUpperCase()}${name.slice(1)}, ${chart.isShare ? quantity === 0 ? '% of the bounds' : '% of the limit' : unitsOf(quantity)}`,
      (box) => new JointChart(box, quantity, seek, hover))) : [];
    if (closest) this.charts.push(add(() => 'Distance of the closest pair', (box) => new DistanceChart(box, closest, seek, hover)));
    byId('joints-section').hidden = joints.length === 0;
    byId('joints').append(make('tr', '', make('th'), ...kQuantities.map((name, quantity) => make('th', unitsOf(quantity)))));
    this.rows = joints.map((joint) => {
      const name = make('th', '', make('i'), document.createTextNode(joint.name)), cells = kQuantities.map(() => make('td'));
      name.firstChild.style.background = joint.colour;
      byId('joints').append(make('tr', '', name, ...cells));
      return cells;
    });
    const button = byId('plots-toggle'), show = (shown) => {
      byId('plots').hidden = !shown;
      button.setAttribute('aria-pressed', String(shown));
    };
    button.addEventListener('click', () => show(byId('plots').hidden));
    show(!window.matchMedia('(max-width: 760px)').matches);
  }

  goTo(at) {
    this.at = at;
    this.update();
  }

  update() {
    const at = this.hovered ?? this.at;
    for (const chart of this.charts) chart.goTo(at);
    const i = lastNotAbove(plotsAt, at), k = Math.min(i + 1, plotsAt.length - 1);
    const u = plotsAt[k] > plotsAt[i] ? (at - plotsAt[i]) / (plotsAt[k] - plotsAt[i]) : 0;
    this.rows.forEach((cells, joint) => cells.forEach((cell, quantity) => {
      const values = joints[joint].values[quantity];
      cell.textContent = (values[i] + u * (values[k] - values[i])).toFixed(3);
    }));
  }
}
