'use strict';

const kDegree = Math.PI / 180;
/** Whether the first view is from above, in parallel projection with y upwards. */
const kTopFirst = data.from ? data.from[1] > 89.9 * kDegree && Math.abs(data.from[0] + 90 * kDegree) < 0.1 * kDegree : data.planar;
/** The first direction of the viewer in 3D: azimuth about z, as in `corridor solve --picture`, and elevation. */
const kAzimuth = data.from && !kTopFirst ? data.from[0] : -60 * kDegree;
/** The first elevation in 3D: never quite vertical, since the camera keeps z upwards. */
const kElevation = data.from && !kTopFirst ? Math.min(Math.max(data.from[1], -89.9 * kDegree), 89.9 * kDegree) : 32 * kDegree;
const kFieldOfView = 30;  // degrees, vertical: a small angle, so that near and far things have nearly the same scale

/** The canvas with cameras, lights and ground; redraws when something has changed. */
class Stage {
  constructor(canvas, options) {
    this.canvas = canvas;
    // With preserveDrawingBuffer, a printed page contains the scene.
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setClearColor(palette.paper);
    this.renderer.gammaOutput = true;
    this.renderer.gammaFactor = 2.2;
    this.scene = new THREE.Scene();
    this.beforeDraw = [];
    this.onView = () => {};
    this.below = 0;  // height of the legend at the bottom, pixels; `fit` leaves it free, but 5 to 40 % of the picture
    this.moved = false;  // whether the camera was moved; `fitToPage` then keeps it where it is
    this.top = options.top;
    this.perspective = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.1, 10);
    this.perspective.up.set(0, 0, 1);
    this.flat = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
    this.scene.add(this.perspective, this.flat);
    this.controls = [this.perspective, this.flat].map((camera) => {
      const controls = new THREE.OrbitControls(camera, canvas);
      controls.enableKeys = false;  // the arrow keys step along the path
      controls.screenSpacePanning = true;
      controls.addEventListener('change', () => this.draw());
      controls.addEventListener('start', () => { this.moved = true; });
      controls.addEventListener('end', () => this.onView());
      return controls;
    });
    this.controls[1].enableRotate = false;
    this.controls[1].mouseButtons.LEFT = THREE.MOUSE.PAN;
    this.controls[1].touches.ONE = THREE.TOUCH.PAN;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  get camera() { return this.top ? this.flat : this.perspective; }
  get target() { return this.controls[this.top ? 1 : 0].target; }

  /** Sets what is shown. @param points points that must be visible. @param bounds the bounds of all bodies. */
  show(points, bounds) {
    this.points = points;
    this.bounds = bounds;
    this.box = new THREE.Box3().setFromPoints(points);
    this.radius = Math.max(bounds.getSize(new THREE.Vector3()).length() / 2, 1e-9);
    this.addLights();
    this.addGround();
    this.setTop(this.top);
  }

  addLights() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xb3aca0, 0.52));
    const centre = this.box.getCenter(new THREE.Vector3()), size = this.box.getSize(new THREE.Vector3()).length() / 2 || 1;
    this.key = new THREE.DirectionalLight(0xfffaf2, 0.47);
    this.key.position.copy(centre).addScaledVector(new THREE.Vector3(-0.25, -0.55, 0.95), 3 * size);
    this.key.target.position.copy(centre);
    this.fill = new THREE.DirectionalLight(0xeaf1ff, 0.16);
    this.fill.position.copy(centre).addScaledVector(new THREE.Vector3(0.9, 0.2, 0.35), 3 * size);
    this.fill.target.position.copy(centre);
    this.scene.add(this.key, this.key.target, this.fill, this.fill.target);
    const shadow = this.key.shadow;
    shadow.mapSize.set(2048, 2048);
    Object.assign(shadow.camera, {left: -size, right: size, top: size, bottom: -size, near: size, far: 5 * size});
    shadow.bias = -0.0015;
    shadow.radius = 2.5;
  }

  /**
   * Switches shadows on. They cost as much as drawing everything again, so large meshes and views from above have none.
   */
  castShadows() {
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    this.renderer.shadowMap.needsUpdate = true;
    this.key.castShadow = true;
  }

  /**
   * Adds a ground below everything, with a grid that fades out. The spacing of its lines is 1, 2 or 5 times a power of
   * ten.
   */
  addGround() {
    const centre = this.box.getCenter(new THREE.Vector3()), size = this.box.getSize(new THREE.Vector3());
    const extent = Math.max(size.x, size.y, 0.4 * size.z) || 1, step = roundDown(extent / 8);
    this.step = step;
    const reach = Math.ceil(1.1 * extent / step) + 1;
    // Grid lines are at multiples of the step in world coordinates.
    const shift = (x, origin) => Math.round((x + origin) / step) * step - origin;
    const x0 = shift(centre.x, data.origin[0]), y0 = shift(centre.y, data.origin[1]), z = this.bounds.min.z - 0.002 * extent;
    const positions = [], colours = [], line = light(palette.grid), paper = light(palette.paper);
    const add = (x, y) => {
      positions.push(x0 + x * step, y0 + y * step, z);
      const fade = Math.min(1, Math.max(0, 1.15 - Math.hypot(x, y) / reach) / 0.6);
      const c = paper.clone().lerp(line, fade);
      colours.push(c.r, c.g, c.b);
    };
    for (let i = -reach; i <= reach; ++i) {
      for (let k = -reach; k < reach; ++k) {
        add(i, k); add(i, k + 1);
        add(k, i); add(k + 1, i);
      }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3));
    this.scene.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({vertexColors: THREE.VertexColors})));
    const ground = new THREE.Mesh(new THREE.PlaneBufferGeometry(20 * extent, 20 * extent), new THREE.ShadowMaterial({opacity: 0.13}));
    ground.position.set(centre.x, centre.y, z - 0.001 * extent);
    ground.receiveShadow = true;
    this.ground = ground;
    this.scene.add(ground);
  }

  setTop(top) {
    this.top = top;
    this.controls[0].enabled = !top;
    this.controls[1].enabled = top;
    this.moved = false;
    this.fitToPage();
    this.onView();
  }

  resize() {
    if (this.fitToPage()) this.drawNow();  // draw at once, because setting the size of a canvas clears it
  }

  /** Fits canvas and cameras to the page. @returns whether the size has changed, and neither width nor height is 0. */
  fitToPage() {
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    if (!width || !height || !this.points) return false;
    const changed = width !== this.width || height !== this.height;
    if (changed) this.renderer.setSize(width, height, false);
    Object.assign(this, {width, height, aspect: width / height});
    if (!this.moved) this.fit();
    this.perspective.aspect = this.aspect;
    this.flat.left = -this.half * this.aspect;
    this.flat.right = this.half * this.aspect;
    this.flat.top = this.half;
    this.flat.bottom = -this.half;
    this.draw();
    return changed;
  }

  /** Moves the camera so that all points are in the picture, within a border and above the legend. */
  fit() {
    const below = Math.max(0.05, Math.min(this.below / this.height, 0.4)), border = 0.98 - below, lift = below - 0.02;
    const toViewer = this.top ? new THREE.Vector3(0, 0, 1)
      : new THREE.Vector3(Math.cos(kElevation) * Math.cos(kAzimuth), Math.cos(kElevation) * Math.sin(kAzimuth), Math.sin(kElevation));
    const up = this.top ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(0, 0, 1);
    const right = up.clone().cross(toViewer).normalize();
    up.copy(toViewer).cross(right);
    const seen = this.points.map((p) => [p.dot(right), p.dot(up), p.dot(toViewer)]);
    const range = (values) => values.reduce(([low, high], x) => [Math.min(low, x), Math.max(high, x)], [Infinity, -Infinity]);
    const largest = (values) => range(values)[1];
    const [zLow, zHigh] = range(seen.map((s) => s[2]));
    const tangent = Math.tan(kFieldOfView * Math.PI / 360) * border;
    let [x, y, distance] = [0, 0, 0];
    const around = (i, scale) => range(seen.map((s) => s[i] * scale(s[2])));
    const middle = ([low, high]) => (low + high) / 2;
    x = middle(around(0, () => 1));
    y = middle(around(1, () => 1));
    for (let pass = 0; pass < 8; ++pass) {
      distance = largest(seen.map((s) => s[2] + Math.max(Math.abs(s[0] - x) / (tangent * this.aspect), Math.abs(s[1] - y) / tangent)));
      if (this.top) break;
      // Move the middle of the points to the middle of the picture.
      const inPicture = (i, o) => middle(range(seen.map((s) => (s[i] - o) / (distance - s[2]))));
      x += inPicture(0, x) * (distance - zHigh);
      y += inPicture(1, y) * (distance - zHigh);
    }
    this.half = largest(seen.map((s) => Math.max(Math.abs(s[0] - x) / this.aspect, Math.abs(s[1] - y)))) / border * 1.04;
    const visible = this.top ? this.half : tangent * (distance - middle([zLow, zHigh]));
    const target = new THREE.Vector3().addScaledVector(right, x).addScaledVector(up, y - lift * visible).addScaledVector(toViewer, middle([zLow, zHigh]));
    this.controls[this.top ? 1 : 0].target.copy(target);
    const camera = this.camera;
    camera.zoom = 1;
    camera.position.copy(target).addScaledVector(toViewer, this.top ? 3 * this.radius : Math.max(distance - middle([zLow, zHigh]), 1e-9));
    camera.lookAt(target);
    this.controls[this.top ? 1 : 0].update();
  }

  /**
   * Moves the camera, without turning it, so that the point is in the middle, and near enough that `size` fills a third
   * of the picture. Never moves the camera farther away.
   */
  approach(point, size) {
    const camera = this.camera, away = camera.position.clone().sub(this.target);
    if (this.top) {
      camera.zoom = Math.max(camera.zoom, this.half / Math.max(1.5 * size, 1e-9));
    } else if (size > 0) {
      away.setLength(Math.min(away.length(), 1.5 * size / Math.tan(kFieldOfView * Math.PI / 360)));
    }
    this.target.copy(point);
    camera.position.copy(point).add(away);
    this.moved = true;
    this.controls[this.top ? 1 : 0].update();
    this.draw();
  }

  /** Returns the length in the world of one pixel at a point. */
  pixelAt(point) {
    const height = this.canvas.clientHeight || 1;
    if (this.top) return 2 * this.half / this.flat.zoom / height;
    return 2 * Math.tan(kFieldOfView * Math.PI / 360) * this.perspective.position.distanceTo(point) / height;
  }

  /** Sets the camera's near and far planes for its place and the scene's size. */
  setClippingPlanes() {
    const {camera} = this, away = camera.position.distanceTo(this.bounds.getCenter(new THREE.Vector3()));
    camera.near = this.top ? 0.01 * this.radius : Math.max(away - 2.5 * this.radius, camera.position.distanceTo(this.target) / 60);
    camera.far = away + 12 * this.radius;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }

  draw() {
    if (this.asked) return;
    this.asked = requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    cancelAnimationFrame(this.asked);
    this.asked = 0;
    const started = performance.now();
    this.setClippingPlanes();
    for (const prepare of this.beforeDraw) prepare();
    this.renderer.render(this.scene, this.camera);
    this.drawMs = performance.now() - started;
  }
}

/** Rounds down to 1, 2 or 5 times a power of ten. */
function roundDown(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * (x / power >= 5 ? 5 : x / power >= 2 ? 2 : 1);
}
