'use strict';

/**
 * Draws the witness points of the closest pair. They are those of the sample (of `data.distances`) nearest to the
 * current position on the path.
 */
class ClosestPair {
  constructor(scene) {
    this.sample = data.array(data.distances.sample);
    this.metres = data.array(data.distances.metres);
    this.bodies = data.array(data.distances.bodies);
    this.points = data.array(data.distances.points);
    this.at = Float32Array.from(this.sample, (i) => path.at[i]);
    this.root = new THREE.Group();
    const material = new THREE.MeshBasicMaterial({color: light(palette.witness), depthTest: false, transparent: true});
    const ball = new THREE.SphereBufferGeometry(1, 16, 12), rod = new THREE.CylinderBufferGeometry(1, 1, 1, 8);
    this.balls = [new THREE.Mesh(ball, material), new THREE.Mesh(ball, material)];
    this.rod = new THREE.Mesh(rod, material);
    for (const mesh of [...this.balls, this.rod]) { mesh.renderOrder = 20; this.root.add(mesh); }
    this.root.visible = false;
    scene.add(this.root);
  }

  indexAt(at) {
    const i = lastNotAbove(this.at, at), k = Math.min(i + 1, this.at.length - 1);
    return at - this.at[i] <= this.at[k] - at ? i : k;
  }

  place(at, stage) {
    const i = this.indexAt(at);
    const [a, b] = [0, 3].map((k) => new THREE.Vector3().fromArray(this.points, 6 * i + k));
    const between = b.clone().sub(a), length = between.length(), pixel = stage.pixelAt(a);
    this.balls[0].position.copy(a);
    this.balls[1].position.copy(b);
    for (const mesh of this.balls) mesh.scale.setScalar(4.5 * pixel);
    this.rod.visible = length > 0;
    this.rod.position.copy(a).addScaledVector(between, 0.5);
    this.rod.scale.set(1.4 * pixel, length || 1, 1.4 * pixel);
    if (length > 0) this.rod.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), between.divideScalar(length));
  }
}

/**
 * Draws the boxes of the OBB trees as lines, one level at a time. The lines of a level are made when the level is first
 * shown.
 */
class Trees {
  constructor() {
    this.byMesh = new Map(data.trees.map((tree) => [tree.mesh, tree.shapes.map((shape) => (
      {counts: shape.counts, boxes: data.array(shape.boxes), leaves: data.array(shape.leaves), whole: shape.whole}))]));
    this.levels = Math.max(1, ...data.trees.map((tree) => Math.max(...tree.shapes.map((shape) => shape.counts.length))));
    this.made = new Map();
    this.shown = [];
  }

  /** Returns the lines of a mesh's boxes: of those on a level, and of the leaves above this level. */
  geometry(mesh, level) {
    const key = `${mesh}/${level}`;
    if (this.made.has(key)) return this.made.get(key);
    const positions = [];
    let count = 0;
    for (const {counts, boxes, leaves} of this.byMesh.get(mesh) || []) {
      let box = 0;
      counts.forEach((boxCount, at) => {
        for (let i = 0; i < boxCount; ++i, ++box) {
          if (at > level || at < level && !leaves[box]) continue;
          addBox(boxes, 10 * box, positions);
          ++count;
        }
      });
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    const made = {geometry, count};
    this.made.set(key, made);
    return made;
  }

  /**
   * Shows a level of the trees. @param level -1: no level. @param parentOf(body) returns the object that moves the
   * body's boxes. @returns the number of boxes.
   */
  show(level, parentOf) {
    for (const object of this.shown) object.parent.remove(object);
    this.shown = [];
    if (level < 0) return 0;
    const material = new THREE.LineBasicMaterial({color: light(palette.levels[level % palette.levels.length]), transparent: true, opacity: 0.75});
    let sum = 0;
    data.bodies.forEach((body) => {
      const {geometry, count} = this.geometry(body.mesh, level);
      const object = new THREE.LineSegments(geometry, material);
      if (body.frame < 0) placeObstacle(object, body);
      else object.position.copy(shapes[body.mesh].origin);
      object.renderOrder = 6;
      parentOf(body).add(object);
      this.shown.push(object);
      sum += count;
    });
    return sum;
  }

  /** Returns whether the page lacks boxes on `level` of some tree. */
  cut(level) {
    return [...this.byMesh.values()].some((trees) => trees.some((tree) => tree.counts.length - 1 < level && !finished(tree)));
  }
}

/** Returns whether every box on the lowest level that the page contains is a leaf. */
function finished({counts, leaves}) {
  const last = counts[counts.length - 1];
  return leaves.subarray(leaves.length - last).every((leaf) => leaf);
}

/**
 * Appends the twelve edges of a box. The box is ten numbers from `first` on: its centre, quaternion and half extents.
 */
function addBox(boxes, first, positions) {
  const centre = new THREE.Vector3().fromArray(boxes, first), q = new THREE.Quaternion().fromArray(boxes, first + 3);
  const axes = [0, 1, 2].map((k) => new THREE.Vector3().setComponent(k, boxes[first + 7 + k]).applyQuaternion(q));
  const corners = Array.from({length: 8}, (_, i) => axes.reduce((p, axis, k) => p.addScaledVector(axis, i >> k & 1 ? 1 : -1), centre.clone()));
  for (let i = 0; i < 8; ++i) {
    for (let k = 0; k < 3; ++k) if (!(i >> k & 1)) positions.push(...corners[i].toArray(), ...corners[i | 1 << k].toArray());
  }
}

/** Shows a finding in the scene: highlights its two bodies, and draws a ring around the place where they meet. */
class Contact {
  constructor(scene) {
    this.ring = new THREE.Mesh(new THREE.RingBufferGeometry(11, 14, 40), new THREE.MeshBasicMaterial(
      {color: light(palette.alarm), depthTest: false, transparent: true, side: THREE.DoubleSide}));
    this.dot = new THREE.Mesh(new THREE.CircleBufferGeometry(3.5, 20), this.ring.material);
    for (const mesh of [this.ring, this.dot]) { mesh.renderOrder = 21; mesh.visible = false; scene.add(mesh); }
    this.lit = [];
  }

  /** @param finding null: no finding is shown. @param materialsOf(index) returns the materials of a body. */
  show(finding, materialsOf) {
    this.finding = finding;
    for (const material of this.lit) material.emissive.setHex(0);
    this.lit = [];
    this.ring.visible = this.dot.visible = Boolean(finding) && finding.a !== null;
    if (!finding) return;
    for (const body of [finding.a, finding.b]) {
      if (body === null) continue;
      for (const material of materialsOf(body)) {
        material.emissive.copy(light(palette.alarm)).multiplyScalar(0.55);
        this.lit.push(material);
      }
    }
    for (const mesh of [this.ring, this.dot]) mesh.position.fromArray(finding.point);
  }

  place(stage) {
    if (!this.ring.visible) return;
    for (const mesh of [this.ring, this.dot]) {
      mesh.quaternion.copy(stage.camera.quaternion);
      mesh.scale.setScalar(stage.pixelAt(mesh.position));
    }
  }
}
