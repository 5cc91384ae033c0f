'use strict';

/** The page's data as the program wrote it. `data.array` returns the typed array that an entry refers to. */
const data = (() => {
  const json = JSON.parse(document.getElementById('data').textContent);
  const element = document.getElementById('buffers');
  const binary = atob(element.textContent);
  element.remove();
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  const types = {f4: Float32Array, u4: Uint32Array, u2: Uint16Array, u1: Uint8Array};
  json.array = ([type, offset, count]) => new types[type](bytes.buffer, offset, count);
  return json;
})();

/** Colours in sRGB; three.js computes in linear light. */
const palette = {
  paper: '#f8f7f4', grid: '#dcd9d1', ink: '#1f2730', floor: '#eceae4', edge: '#6f6c66',
  obstacles: ['#d3cfc6', '#c5cad0', '#d6ccba', '#c3cdc7'], wall: '#9a9892',
  robots: ['#2f6db5', '#7a5bb0', '#2a8a8c', '#9a6a2f', '#5a6b7c'],
  start: '#2e9e5b', way: '#d9a441', goal: '#d04a3f', alarm: '#b0127e', witness: '#b0127e',
  levels: ['#1f2730', '#5b2a86', '#a0307a', '#c8414f', '#dd6b2f', '#c9951a', '#8a8f1c', '#3f8f4f'],
};
const light = (hex) => new THREE.Color(hex).convertSRGBToLinear();
/**
 * Returns the colour at the position `at` on the path, in [0, 1]: from the start's colour, through `palette.way` at
 * 0.5, to the goal's colour.
 */
const wayColour = (at) => at < 0.5 ? new THREE.Color(palette.start).lerp(new THREE.Color(palette.way), 2 * at)
  : new THREE.Color(palette.way).lerp(new THREE.Color(palette.goal), 2 * at - 1);

const byId = (id) => document.getElementById(id);
/** Creates an element with text (never HTML) and children. */
function make(tag, text = '', ...children) {
  const element = document.createElement(tag);
  element.textContent = text;
  element.append(...children);
  return element;
}

/** Formats a length with four significant digits, in a unit that keeps it short. */
function metres(x) {
  const size = Math.abs(x);
  const [factor, unit] = size === 0 || size >= 1 ? [1, 'm'] : size >= 1e-3 ? [1e3, 'mm'] : size >= 1e-6 ? [1e6, 'µm'] : [1e9, 'nm'];
  return `${digits(x * factor)} ${unit}`;
}
const digits = (x) => String(Number(x.toPrecision(4)));
const seconds = (x) => `${x.toFixed(3)} s`;
const counted = (n, noun) => `${n.toLocaleString('en')} ${noun}${n === 1 ? '' : 's'}`;

/** Returns the index of the last value that is at most `x`, or 0 if there is none. `values` ascends. */
function lastNotAbove(values, x) {
  let low = 0;
  for (let high = values.length; high - low > 1;) {
    const middle = (low + high) >> 1;
    if (values[middle] <= x) low = middle; else high = middle;
  }
  return low;
}
