'use strict';

const origin = new THREE.Vector3(...data.origin);
const kGhostTriangles = 1.5e6;  // the largest number of triangles of all copies along the path together
const kPose = 7;                // numbers per pose of a frame

/**
 * Reads the pose (x y z and a quaternion) at index `first` of an array. With u > 0, interpolates to the pose at `next`,
 * by the fraction u.
 */
function poseOf(array, first, next, u, position, quaternion) {
  position.set(array[first], array[first + 1], array[first + 2]);
  quaternion.set(array[first + 3], array[first + 4], array[first + 5], array[first + 6]);
  if (u > 0) {
    const to = new THREE.Vector3(array[next], array[next + 1], array[next + 2]);
    position.lerp(to, u);
    quaternion.slerp(new THREE.Quaternion(array[next + 3], array[next + 4], array[next + 5], array[next + 6]), u);
  }
}

/** Places an object in the scene. The object is given in the coordinates of an obstacle's mesh. */
function placeObstacle(object, body) {
  object.position.copy(shapes[body.mesh].origin);
  if (!body.pose) {
    object.position.sub(origin);
    return;
  }
  const at = new THREE.Vector3();
  poseOf(body.pose, 0, 0, 0, at, object.quaternion);
  object.position.applyQuaternion(object.quaternion.normalize()).add(at);
}

/** The path's samples; undefined without a path. */
const path = data.path && {
  at: data.array(data.path.at), t: data.array(data.path.t), edge: data.array(data.path.edge), poses: data.array(data.path.poses),
  states: data.path.states, findings: data.path.findings, trace: data.path.trace,
  times: data.path.times,  // the times of start and end, seconds; undefined: the path has no times
};
/** Returns the time at the position `at` on the path, seconds. */
const timeAt = (at) => path.times[0] + at * (path.times[1] - path.times[0]);
const frameCount = data.array(data.start).length / kPose;
/** For each frame, whether it never moves on the path (without a path: between start and goals), like an arm's base. */
const isStill = Array.from({length: frameCount}, (_, frame) => {
  const samples = path ? path.poses : Float32Array.from([data.start, ...data.goals].flatMap((end) => [...data.array(end)]));
  for (let i = frame * kPose; i < samples.length; i += frameCount * kPose) {
    for (let k = 0; k < kPose; ++k) if (samples[i + k] !== samples[frame * kPose + k]) return false;
  }
  return true;
});

/** Computes the pose of a frame at the position `at` on the path, in [0, 1]. */
function framePose(at, frame, position, quaternion) {
  const i = lastNotAbove(path.at, at), k = Math.min(i + 1, path.at.length - 1);
  const u = k > i && path.at[k] > path.at[i] ? Math.min(1, (at - path.at[i]) / (path.at[k] - path.at[i])) : 0;
  poseOf(path.poses, (i * frameCount + frame) * kPose, (k * frameCount + frame) * kPose, u, position, quaternion);
}

/**
 * A copy of all robots: a group of three.js for each frame, with the meshes that `meshOf(body, shape, index)` returns
 * for each body.
 */
class RobotCopy {
  constructor(meshOf) {
    this.root = new THREE.Group();
    this.frames = Array.from({length: frameCount}, () => new THREE.Group());
    this.frames.forEach((frame) => { frame.matrixAutoUpdate = false; this.root.add(frame); });
    data.bodies.forEach((body, index) => {
      if (body.frame < 0) return;
      const shape = shapes[body.mesh];
      for (const mesh of meshOf(body, shape, index)) {
        mesh.position.copy(shape.origin);
        this.frames[body.frame].add(mesh);
      }
    });
  }

  /** Places the copy at poses of the start or a goal. */
  stand(poses) { this.set((frame, position, quaternion) => poseOf(poses, frame * kPose, 0, 0, position, quaternion)); }
  goTo(at) { this.set((frame, position, quaternion) => framePose(at, frame, position, quaternion)); }

  set(pose) {
    const position = new THREE.Vector3(), quaternion = new THREE.Quaternion(), one = new THREE.Vector3(1, 1, 1);
    this.frames.forEach((frame, i) => {
      pose(i, position, quaternion);
      frame.matrix.compose(position, quaternion.normalize(), one);
      frame.matrixWorldNeedsUpdate = true;
    });
  }
}

/** Creates the material of a surface; `more` overrides its properties, for example for glass. */
function surface(colour, shape, more = {}) {
  return new THREE.MeshPhongMaterial({color: light(colour), specular: 0x111111, shininess: 24, side: THREE.DoubleSide,
    flatShading: shape.flat, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1, ...more});
}
/**
 * Properties of a transparent material that is drawn together with the opaque materials, in the order of `renderOrder`.
 */
const blended = {blending: THREE.CustomBlending, blendSrc: THREE.SrcAlphaFactor, blendDst: THREE.OneMinusSrcAlphaFactor};

function lines(shape, colour, opacity) {
  return new THREE.LineSegments(shape.edges, new THREE.LineBasicMaterial({color: light(colour), transparent: true, opacity, depthWrite: false}));
}

/**
 * Returns the depth offset of a copy of the robots. Where several copies coincide, the copy with the smallest rank is
 * visible.
 */
const behind = (rank) => ({polygonOffsetFactor: 1 + 0.25 * rank, polygonOffsetUnits: 1 + 300 * rank});

/** A copy of the robots that is drawn solid. Where other bodies hide it, it is dimly visible; large meshes are not. */
class Robots extends RobotCopy {
  /**
   * @param hex the colour; unset: each robot has its own colour. @param rank see `behind`; above 0, frames that never
   * move are left out.
   */
  constructor(hex, rank = 0) {
    const materials = new Map();
    super((body, shape, index) => {
      if (rank > 0 && isStill[body.frame]) return [];
      const colour = '#' + new THREE.Color(hex && !isStill[body.frame] ? hex : palette.robots[body.robot % palette.robots.length])
        .lerp(new THREE.Color('#ffffff'), index % 2 ? 0.14 : 0).lerp(new THREE.Color('#b9bcc0'), isStill[body.frame] ? 0.55 : 0).getHexString();
      const solid = new THREE.Mesh(shape.geometry, surface(colour, shape, behind(rank)));
      solid.castShadow = true;
      solid.receiveShadow = !shape.flat;
      solid.renderOrder = 2;
      materials.set(index, solid.material);
      if (shape.flat) return [solid];  // large meshes are drawn only once
      const hidden = new THREE.Mesh(shape.geometry, surface(colour, shape, {...blended, opacity: 0.22, depthFunc: THREE.GreaterDepth, depthWrite: false}));
      hidden.renderOrder = 1;
      return [solid, hidden, lines(shape, '#10233d', 0.35)];
    });
    this.materials = materials;
  }
}

/**
 * A copy of the robots at another pose, like glass. All ghosts form one layer: their depths are drawn first, behind
 * solid things, and then their colours. So the nearest ghost is visible, in whatever order the ghosts are drawn.
 */
class Ghost extends RobotCopy {
  constructor(colour, opacity, rank) {
    const offset = behind(rank);
    const depth = new THREE.MeshBasicMaterial({colorWrite: false, side: THREE.DoubleSide, polygonOffset: true, ...offset});
    const smooth = surface('#000000', {flat: false}, {...blended, opacity, depthWrite: false, ...offset});
    const flat = surface('#000000', {flat: true}, {...blended, opacity, ...offset});  // for large meshes: in one pass
    for (const material of [smooth, flat]) material.color.copy(colour).convertSRGBToLinear();
    super((body, shape) => {
      if (isStill[body.frame]) return [];
      const first = new THREE.Mesh(shape.geometry, depth), second = new THREE.Mesh(shape.geometry, shape.flat ? flat : smooth);
      first.renderOrder = 3;
      second.renderOrder = 4;
      return shape.flat ? [second] : [first, second];
    });
  }
}

/**
 * All copies of the robots (at the current position, at the start and goals, and at poses along the path), and a trace
 * of each robot.
 */
class Motion {
  /** @param picture true for pictures, which show the poses along the path, but no robots at the current position. */
  constructor(scene, picture) {
    this.scene = scene;
    this.at = 0;
    this.opacity = picture ? {end: 0.75, way: 0.42} : data.planar ? {end: 0.6, way: 0.42} : {end: 0.42, way: 0.22};
    this.triangles = data.bodies.reduce((sum, body) => sum + (body.frame < 0 ? 0 : shapes[body.mesh].triangles), 0);
    this.ends = [data.array(data.start), ...data.goals.map((goal) => data.array(goal))];
    this.now = path ? new Robots() : null;
    const end = (hex, rank) => path ? new Ghost(new THREE.Color(hex), this.opacity.end, rank) : new Robots(hex, rank);
    this.start = end(palette.start, path ? 1 : 0);
    this.start.stand(this.ends[0]);
    this.goals = (path ? [null] : data.goals).map((_, i) => {
      const goal = end(palette.goal, path ? 2 : i + 1);
      if (path) goal.goTo(1); else goal.stand(this.ends[i + 1]);
      return goal;
    });
    for (const copy of [this.now, this.start, ...this.goals]) if (copy) scene.add(copy.root);
    this.ghosts = [];
    this.mostGhosts = path ? Math.min(24, Math.floor(kGhostTriangles / Math.max(1, this.triangles))) : 0;
    this.setGhosts(Math.min(data.planar ? 11 : 7, this.mostGhosts, Math.floor((picture ? 1e6 : 2e5) / Math.max(1, this.triangles))));
    if (path) this.addTrace();
    if (path) this.goTo(0);
  }

  setGhosts(count) {
    for (const ghost of this.ghosts) this.scene.remove(ghost.root);
    this.ghosts = Array.from({length: count}, (_, i) => {
      const at = (i + 1) / (count + 1), ghost = new Ghost(wayColour(at), this.opacity.way, i + 3);
      ghost.root.visible = this.start.root.visible;
      ghost.goTo(at);
      this.scene.add(ghost.root);
      return ghost;
    });
  }

  goTo(at) {
    this.at = at;
    this.now.goTo(at);
  }

  /**
   * Shows or hides the copies at start, goals and poses between. If hidden, only the robots at the current position
   * remain visible.
   */
  showPoses(shown) {
    for (const copy of [this.start, ...this.goals, ...this.ghosts]) copy.root.visible = shown;
  }

  /** For pictures: hides the robots at the current position, except frames that never move. */
  hideNow() {
    this.now.frames.forEach((frame, i) => { frame.visible = isStill[i]; });
  }

  /**
   * Returns points that the robots reach: the corners of their bodies' bounds, at the start and along the path or,
   * without a path, at start and goals.
   */
  points() {
    const points = [], position = new THREE.Vector3(), quaternion = new THREE.Quaternion(), one = new THREE.Vector3(1, 1, 1);
    const matrix = new THREE.Matrix4();
    const add = (pose) => data.bodies.forEach((body) => {
      if (body.frame < 0) return;
      pose(body.frame);
      matrix.compose(position, quaternion, one);
      const {min, max} = shapes[body.mesh].geometry.boundingBox;
      for (let corner = 0; corner < 8; ++corner) {
        const p = new THREE.Vector3(corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y, corner & 4 ? max.z : min.z);
        points.push(p.add(shapes[body.mesh].origin).applyMatrix4(matrix));
      }
    });
    for (const end of path ? this.ends.slice(0, 1) : this.ends) add((frame) => poseOf(end, frame * kPose, 0, 0, position, quaternion));
    if (path) for (let k = 0; k <= 24; ++k) add((frame) => framePose(k / 24, frame, position, quaternion));
    return points;
  }

  /** Returns the size of the larger moving body of a finding. */
  reach(finding) {
    return Math.max(0, ...[finding.a, finding.b].map((index) => data.bodies[index]).filter((body) => body.frame >= 0)
      .map((body) => 2 * shapes[body.mesh].geometry.boundingSphere.radius));
  }

  /**
   * Draws a thin tube along the curve of each robot's tip frame. Dots mark the ends of the tube, since small robots are
   * hard to find.
   */
  addTrace() {
    this.trace = new THREE.Group();
    this.tubes = [];
    this.dots = [];
    const ball = new THREE.SphereBufferGeometry(1, 16, 12);
    for (const frame of path.trace) {
      const points = [];
      for (let i = 0; i < path.at.length; ++i) {
        const p = new THREE.Vector3().fromArray(path.poses, (i * frameCount + frame) * kPose);
        points.push({p, at: path.at[i]});
      }
      this.tubes.push(tube(points));
      for (const [{p}, colour] of [[points[0], palette.start], [points[points.length - 1], palette.goal]]) {
        const dot = new THREE.Mesh(ball, new THREE.MeshBasicMaterial({color: light(colour)}));
        dot.position.copy(p);
        dot.renderOrder = 2;
        this.dots.push(dot);
      }
    }
    this.trace.add(...this.tubes, ...this.dots);
    this.scene.add(this.trace);
  }

  /**
   * Called before each drawing: scales tubes and dots so that their sizes in pixels do not depend on their distance.
   */
  placeTrace(stage) {
    if (!this.trace) return;
    const radius = 1.2 * stage.pixelAt(stage.target);
    if (Math.abs(radius / this.radius - 1) > 0.05 || !this.radius) for (const mesh of this.tubes) scaleTube(mesh, this.radius = radius);
    for (const dot of this.dots) dot.scale.setScalar(4 * stage.pixelAt(dot.position));
  }
}

/**
 * Creates a tube around the curve through points. Its colours go from the start's to the goal's. `scaleTube` sets its
 * radius.
 */
function tube(points) {
  const sides = 6, kept = points.filter((point, i) => i === 0 || point.p.distanceTo(points[i - 1].p) > 0);
  const positions = [], directions = [], colours = [], indices = [];
  const tangent = new THREE.Vector3(), u = new THREE.Vector3(1, 0, 0), v = new THREE.Vector3();
  kept.forEach(({p, at}, i) => {
    tangent.subVectors(kept[Math.min(i + 1, kept.length - 1)].p, kept[Math.max(i - 1, 0)].p).normalize();
    u.addScaledVector(tangent, -u.dot(tangent));
    if (u.lengthSq() < 1e-6) u.set(-tangent.y, tangent.x, 0).lengthSq() > 1e-6 || u.set(0, -tangent.z, tangent.y);
    u.normalize();
    v.crossVectors(tangent, u);
    const colour = wayColour(at).convertSRGBToLinear();
    for (let k = 0; k < sides; ++k) {
      const angle = 2 * Math.PI * k / sides;
      positions.push(p.x, p.y, p.z);
      directions.push(...new THREE.Vector3().addScaledVector(u, Math.cos(angle)).addScaledVector(v, Math.sin(angle)).toArray());
      colours.push(colour.r, colour.g, colour.b);
      if (i === 0) continue;
      const a = i * sides + k, b = i * sides + (k + 1) % sides;
      indices.push(a - sides, a, b, a - sides, b, b - sides);
    }
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3));
  geometry.setIndex(indices);
  const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({vertexColors: THREE.VertexColors, side: THREE.DoubleSide}));
  mesh.renderOrder = 2;
  mesh.frustumCulled = false;
  mesh.userData = {centres: Float32Array.from(positions), directions: Float32Array.from(directions)};
  return mesh;
}

function scaleTube(mesh, radius) {
  const {centres, directions} = mesh.userData, attribute = mesh.geometry.attributes.position;
  for (let i = 0; i < centres.length; ++i) attribute.array[i] = centres[i] + radius * directions[i];
  attribute.needsUpdate = true;
}
