'use strict';

/**
 * Geometry of meshes. A mesh of at most this many triangles gets lines along its creases, and normals that are smooth
 * elsewhere. Larger meshes are drawn with flat triangles, so that they do not delay the first picture.
 */
const kMostCreased = 120000;
const kCrease = Math.cos(32 * Math.PI / 180);

/**
 * Gives each vertex a number. Vertices at equal positions get the same number, so that meshes without shared vertices
 * become smooth, too.
 */
function welded(positions) {
  const count = positions.length / 3, bits = new Int32Array(positions.buffer, positions.byteOffset, positions.length);
  let size = 16;
  while (size < 2 * count) size *= 2;
  const table = new Int32Array(size).fill(-1), number = new Uint32Array(count);
  let distinct = 0;
  for (let v = 0; v < count; ++v) {
    let slot = (Math.imul(bits[3 * v], 73856093) ^ Math.imul(bits[3 * v + 1], 19349663) ^ Math.imul(bits[3 * v + 2], 83492791));
    slot = (slot ^ slot >>> 15) & size - 1;
    for (;; slot = slot + 1 & size - 1) {
      const other = table[slot];
      if (other < 0) { table[slot] = v; number[v] = distinct++; break; }
      if (positions[3 * other] === positions[3 * v] && positions[3 * other + 1] === positions[3 * v + 1] &&
          positions[3 * other + 2] === positions[3 * v + 2]) { number[v] = number[other]; break; }
    }
  }
  return {number, distinct};
}

/** Lists the corners (3·triangle + k) at each vertex: corners[first[v]] to corners[first[v + 1] − 1]. */
function cornersOf(vertices, count) {
  const first = new Uint32Array(count + 1), corners = new Uint32Array(vertices.length);
  for (const v of vertices) ++first[v + 1];
  for (let v = 0; v < count; ++v) first[v + 1] += first[v];
  const next = first.slice();
  vertices.forEach((v, c) => { corners[next[v]++] = c; });
  return {first, corners};
}

function faceNormals(positions, indices) {
  const normals = new Float32Array(indices.length);  // not normalised: their lengths are twice the areas of the triangles
  for (let c = 0; c < indices.length; c += 3) {
    const a = 3 * indices[c], b = 3 * indices[c + 1], d = 3 * indices[c + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[d] - positions[a], vy = positions[d + 1] - positions[a + 1], vz = positions[d + 2] - positions[a + 2];
    normals[c] = uy * vz - uz * vy;
    normals[c + 1] = uz * vx - ux * vz;
    normals[c + 2] = ux * vy - uy * vx;
  }
  return normals;
}

/** Returns a surface with normals. `edges` has the end positions of its creases and borders. */
function creased(positions, indices) {
  const {number, distinct} = welded(positions);
  const vertices = new Uint32Array(indices.length);
  indices.forEach((v, c) => { vertices[c] = number[v]; });
  const {first, corners} = cornersOf(vertices, distinct);
  const normals = faceNormals(positions, indices), lengths = new Float32Array(indices.length / 3);
  for (let f = 0; f < lengths.length; ++f) lengths[f] = Math.hypot(normals[3 * f], normals[3 * f + 1], normals[3 * f + 2]);
  const cosine = (f, g) => (normals[3 * f] * normals[3 * g] + normals[3 * f + 1] * normals[3 * g + 1] +
                            normals[3 * f + 2] * normals[3 * g + 2]) / (lengths[f] * lengths[g]);
  const has = (f, v) => vertices[3 * f] === v || vertices[3 * f + 1] === v || vertices[3 * f + 2] === v;
  const faces = [], edges = [];
  for (let f = 0; f < lengths.length; ++f) {
    const [a, b, c] = [vertices[3 * f], vertices[3 * f + 1], vertices[3 * f + 2]];
    if (!(lengths[f] > 0)) continue;
    let repeated = false;  // many mesh files have both sides of every face
    for (let i = first[a]; i < first[a + 1] && !repeated; ++i) {
      const g = corners[i] / 3 | 0;
      repeated = g < f && has(g, b) && has(g, c) && lengths[g] > 0;
    }
    if (!repeated) faces.push(f);
    else lengths[f] = 0;
  }
  // Corners at one vertex with the same normal share a vertex on the graphics card.
  const out = [], outNormals = [], outIndices = new Uint32Array(3 * faces.length);
  const latest = new Int32Array(distinct).fill(-1), before = [];
  const vertexOf = (v, p, x, y, z) => {
    for (let i = latest[v]; i >= 0; i = before[i]) {
      if (Math.abs(outNormals[3 * i] - x) + Math.abs(outNormals[3 * i + 1] - y) + Math.abs(outNormals[3 * i + 2] - z) < 1e-3) return i;
    }
    before.push(latest[v]);
    latest[v] = before.length - 1;
    out.push(positions[p], positions[p + 1], positions[p + 2]);
    outNormals.push(x, y, z);
    return latest[v];
  };
  faces.forEach((f, at) => {
    for (let k = 0; k < 3; ++k) {
      const v = vertices[3 * f + k], w = vertices[3 * f + (k + 1) % 3], p = 3 * indices[3 * f + k], q = 3 * indices[3 * f + (k + 1) % 3];
      let x = 0, y = 0, z = 0, others = 0, sharp = false, earliest = true;
      for (let i = first[v]; i < first[v + 1]; ++i) {
        const g = corners[i] / 3 | 0;
        if (!(lengths[g] > 0)) continue;
        const cos = g === f ? 1 : cosine(f, g);
        if (cos > kCrease) { x += normals[3 * g]; y += normals[3 * g + 1]; z += normals[3 * g + 2]; }
        if (g !== f && has(g, w)) { ++others; sharp = sharp || cos < kCrease; earliest = earliest && f < g; }
      }
      const length = Math.hypot(x, y, z) || 1;
      outIndices[3 * at + k] = vertexOf(v, p, x / length, y / length, z / length);
      if (earliest && (others === 0 || sharp)) {
        edges.push(positions[p], positions[p + 1], positions[p + 2], positions[q], positions[q + 1], positions[q + 2]);
      }
    }
  });
  return {positions: new Float32Array(out), normals: new Float32Array(outNormals), indices: outIndices, edges: new Float32Array(edges)};
}

/** The geometry of each mesh, shared by all bodies and poses that use it. */
const shapes = data.meshes.map((mesh) => {
  const positions = data.array(mesh.positions), indices = data.array(mesh.indices);
  const geometry = new THREE.BufferGeometry();
  const shape = {geometry, origin: new THREE.Vector3(...mesh.origin), triangles: indices.length / 3, flat: false, edges: null};
  if (shape.triangles > kMostCreased) {
    shape.flat = true;
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  } else {
    const smooth = creased(positions, indices);
    geometry.setAttribute('position', new THREE.BufferAttribute(smooth.positions, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(smooth.normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(smooth.indices, 1));
    shape.edges = new THREE.BufferGeometry();
    shape.edges.setAttribute('position', new THREE.BufferAttribute(smooth.edges, 3));
  }
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return shape;
});
