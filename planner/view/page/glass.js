'use strict';

/**
 * Fractions of the robots' pixels. A body that hides more than kHides is drawn like glass; when it hides less than
 * kNoLonger, solid again.
 */
const kHides = 0.08, kNoLonger = 0.03;

/** Makes glass more opaque at its rims, where the surface is seen at a grazing angle. */
function thickenedRims(shader) {
  shader.fragmentShader = shader.fragmentShader.replace('#include <tonemapping_fragment>',
    'gl_FragColor.a *= mix(0.6, 4.0, pow(1.0 - abs(dot(normal, normalize(vViewPosition))), 3.0));\n#include <tonemapping_fragment>');
}

/** The bodies that do not move, each drawn solid or like glass. */
class Obstacles {
  constructor(scene, lowest) {
    this.bodies = [];
    this.mode = 'auto';
    let number = 0;
    data.bodies.forEach((body, index) => {
      if (body.frame >= 0) return;
      const shape = shapes[body.mesh];
      const place = new THREE.Object3D();
      placeObstacle(place, body);
      place.updateMatrix();
      const bounds = shape.geometry.boundingBox.clone().applyMatrix4(place.matrix), size = bounds.getSize(new THREE.Vector3());
      const floor = bounds.max.z < lowest + 0.02 * Math.max(size.x, size.y) && size.z < 0.12 * Math.max(size.x, size.y);
      const colour = floor ? palette.floor : data.planar ? palette.wall : palette.obstacles[number++ % palette.obstacles.length];
      const solid = surface(colour, shape);
      const glass = surface(colour, shape, {transparent: true, opacity: 0.13, depthWrite: false});
      glass.onBeforeCompile = thickenedRims;
      const mesh = new THREE.Mesh(shape.geometry, solid);
      const edges = shape.edges && lines(shape, palette.edge, 0.55);
      mesh.receiveShadow = true;
      for (const object of edges ? [mesh, edges] : [mesh]) {
        placeObstacle(object, body);
        scene.add(object);
      }
      this.bodies.push({index, mesh, solid, glass, edges, bounds, floor, hides: 0, isGlass: false});
    });
  }

  setGlass(body, glass) {
    body.isGlass = glass;
    body.mesh.material = glass ? body.glass : body.solid;
    body.mesh.castShadow = !glass && !body.floor;
    body.mesh.renderOrder = glass ? 5 : 0;
    if (body.edges) body.edges.material.opacity = glass ? 0.42 : 0.55;
  }

  /**
   * Sets each body to solid or glass. A floor stays solid in the mode 'glass'. @param mode 'auto', 'solid' or 'glass'.
   * @returns whether anything changed.
   */
  apply(mode, motion, stage) {
    this.mode = mode;
    if (mode === 'auto') this.look(motion, stage);
    let changed = false;
    for (const body of this.bodies) {
      const glass = mode === 'glass' ? !body.floor : mode === 'auto' && body.hides > (body.isGlass ? kNoLonger : kHides);
      changed = changed || glass !== body.isGlass;
      this.setGlass(body, glass);
    }
    return changed;
  }

  /**
   * Measures the fraction of the robots' pixels that each body hides. Renders a small picture of the robots alone, then
   * a picture with the obstacles. The obstacles that hide robots are then removed, and a picture of the others is
   * rendered, to find the obstacles behind. At most four pictures with obstacles are rendered.
   */
  look(motion, stage) {
    const width = 256, height = Math.max(16, Math.round(width / stage.aspect)), pixels = new Uint8Array(4 * width * height);
    const target = new THREE.WebGLRenderTarget(width, height), scene = new THREE.Scene(), {renderer} = stage;
    const flat = (number) => new THREE.MeshBasicMaterial({color: number, side: THREE.DoubleSide});
    const white = flat(0xffffff);
    const copies = [motion.start, ...motion.goals, ...motion.ghosts].map((shown) => {
      const copy = new RobotCopy((body, shape) => [new THREE.Mesh(shape.geometry, white)]);
      shown.frames.forEach((frame, i) => copy.frames[i].matrix.copy(frame.matrix));
      copy.frames.forEach((frame) => { frame.matrixWorldNeedsUpdate = true; });
      return copy.root;
    });
    const walls = this.bodies.map((body, i) => {
      const mesh = new THREE.Mesh(body.mesh.geometry, flat(i + 1));
      mesh.position.copy(body.mesh.position);
      return mesh;
    });
    const picture = () => {
      renderer.render(scene, stage.camera);
      renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
    };
    const numberAt = (i) => pixels[4 * i] << 16 | pixels[4 * i + 1] << 8 | pixels[4 * i + 2];
    stage.setClippingPlanes();
    renderer.gammaOutput = false;
    renderer.setRenderTarget(target);
    renderer.setClearColor(0);
    scene.add(...copies);
    picture();
    const mask = Array.from({length: width * height}, (_, i) => numberAt(i) !== 0);
    const all = mask.reduce((sum, seen) => sum + seen, 0) || 1;
    for (const body of this.bodies) body.hides = 0;
    if (walls.length) scene.add(...walls);
    for (let pass = 0; pass < 4 && walls.length; ++pass) {
      picture();
      const counts = new Array(walls.length).fill(0);
      mask.forEach((seen, i) => { if (seen && numberAt(i) !== 0xffffff && numberAt(i) > 0) ++counts[numberAt(i) - 1]; });
      let found = false;
      counts.forEach((count, i) => {
        this.bodies[i].hides = Math.max(this.bodies[i].hides, count / all);
        if (count / all > kHides) { found = true; scene.remove(walls[i]); }
      });
      if (!found) break;
    }
    renderer.setRenderTarget(null);
    renderer.setClearColor(palette.paper);
    renderer.gammaOutput = true;
    target.dispose();
  }
}
