'use strict';

const kDuration = 9;  // seconds to play a path that has no times
const kShadowTriangles = 150000;

function webglWorks() {
  try {
    const canvas = document.createElement('canvas');
    return Boolean(canvas.getContext('webgl') || canvas.getContext('experimental-webgl'));
  } catch (error) {
    return false;
  }
}

/** Sets up the panel, which works without a scene. */
function openPanel() {
  const toggle = byId('toggle'), narrow = window.matchMedia('(max-width: 760px)').matches;
  const set = (closed) => {
    document.body.classList.toggle('closed', closed);
    toggle.setAttribute('aria-expanded', String(!closed));
  };
  toggle.addEventListener('click', () => set(!document.body.classList.contains('closed')));
  set(narrow);
  Panel.fill();
}

function start() {
  const image = location.hash === '#image';
  document.body.classList.toggle('image', image);
  openPanel();
  if (!webglWorks()) {
    byId('trouble').textContent = 'The scene can’t be drawn: it needs WebGL, which this browser lacks or has switched off.';
    byId('trouble').hidden = false;
    byId('views').hidden = true;
    console.warn('corridor: no picture: there is no WebGL');
    return;
  }
  const stage = new Stage(byId('canvas'), {top: kTopFirst}), {scene} = stage;
  const motion = new Motion(scene, image);
  const robotPoints = motion.points();
  const robotBox = new THREE.Box3().setFromPoints(robotPoints);
  const obstacles = new Obstacles(scene, robotBox.min.z);
  const [points, bounds] = interest(robotPoints, robotBox, obstacles);
  const ringed = image && path ? data.verdict.findings[Panel.mainFinding()] : null;
  if (ringed && ringed.a !== null) points.push(new THREE.Vector3(...ringed.point));
  stage.show(points, bounds);
  const triangles = data.bodies.reduce((sum, body) => sum + shapes[body.mesh].triangles, 0);
  if (!kTopFirst && triangles <= kShadowTriangles) stage.castShadows();

  // Buttons that draw obstacles solid or like glass, and that choose the view.
  const glass = (mode) => {
    if (obstacles.apply(mode, motion, stage)) stage.renderer.shadowMap.needsUpdate = true;
    byId('glass').querySelectorAll('button').forEach((button) => button.setAttribute('aria-pressed', String(button.dataset.glass === mode)));
    stage.draw();
  };
  byId('glass').addEventListener('click', (event) => { if (event.target.dataset.glass) glass(event.target.dataset.glass); });
  const view = (top) => {
    stage.setTop(top);
    byId('view-3d').setAttribute('aria-pressed', String(!top));
    byId('view-top').setAttribute('aria-pressed', String(top));
  };
  byId('view-3d').addEventListener('click', () => view(false));
  byId('view-top').addEventListener('click', () => view(true));

  const closest = path && data.distances ? new ClosestPair(scene) : null;
  const contact = new Contact(scene), trees = new Trees();
  let chart = null, plots = null, treeLevel = -1;
  stage.beforeDraw.push(() => contact.place(stage));
  if (closest) stage.beforeDraw.push(() => closest.root.visible && closest.place(motion.at, stage));
  stage.beforeDraw.push(() => motion.placeTrace(stage));

  // The function that goes to a position on the path.
  const seek = (at, keepFinding = false) => {
    motion.goTo(at);
    byId('slider').value = at;
    Panel.place(at, closest);
    if (chart) chart.goTo(at);
    if (plots) plots.goTo(at);
    if (!keepFinding && contact.finding) showFinding(-1, false);
    stage.renderer.shadowMap.needsUpdate = true;
    stage.draw();
  };
  const materialsOf = (index) => data.bodies[index].frame < 0
    ? obstacles.bodies.filter((body) => body.index === index).flatMap((body) => [body.solid, body.glass]) : [motion.now.materials.get(index)];
  const showFinding = (index, move = true) => {
    Panel.pressFinding(index);
    const finding = index < 0 ? null : data.verdict.findings[index];
    contact.show(finding, materialsOf);
    motion.showPoses(!finding);
    if (finding && move) {
      player.pause();
      seek(path.at[path.findings[index]], true);
      if (finding.a !== null) stage.approach(new THREE.Vector3(...finding.point), 2 * motion.reach(finding));
    }
    stage.draw();
  };
  const player = path ? new Player(seek, () => motion.at) : null;
  if (player) {
    byId('bar').hidden = image;
    player.ticks();
    Panel.findings(showFinding);
    byId('speed').hidden = byId('plots-toggle').hidden = !path.times;
    if (path.times) plots = new Plots(closest, seek);
  } else {
    byId('ghosts-row').hidden = byId('trace-row').hidden = true;
  }

  // Controls of what is shown only on request.
  const ghosts = byId('ghosts');
  ghosts.max = motion.mostGhosts;
  ghosts.value = motion.ghosts.length;
  ghosts.addEventListener('input', () => { motion.setGhosts(Number(ghosts.value)); stage.draw(); });
  byId('trace-of').textContent = data.robots.some((robot, i) => data.bodies.filter((body) => body.robot === i).length > 1) ? 'last link' : 'reference point';
  byId('trace').addEventListener('change', (event) => { motion.trace.visible = event.target.checked; stage.draw(); });
  byId('closest-section').hidden = !closest;
  byId('closest').addEventListener('change', (event) => {
    byId('closest-body').hidden = !event.target.checked;
    closest.root.visible = event.target.checked;
    chart = chart || new DistanceChart(byId('chart'), closest, seek);
    chart.goTo(motion.at);
    stage.draw();
  });
  byId('decades').addEventListener('change', (event) => chart.draw(event.target.checked));
  const showTrees = () => {
    treeLevel = byId('trees').checked ? Number(byId('level').value) : -1;
    byId('trees-body').hidden = treeLevel < 0;
    const mover = motion.now || motion.start;
    const count = trees.show(treeLevel, (body) => body.frame < 0 ? scene : mover.frames[body.frame]);
    byId('trees-text').textContent = `Level ${treeLevel} of ${trees.levels - 1}: ${counted(count, 'box').replace('boxs', 'boxes')}, including the leaves of the levels above.` +
      (trees.cut(treeLevel) ? ' The lower levels of larger trees are not in this page.' : '');
    stage.draw();
  };
  byId('level').max = trees.levels - 1;
  byId('level').value = Math.min(2, trees.levels - 1);
  byId('level').addEventListener('input', showTrees);
  byId('trees').addEventListener('change', showTrees);
  byId('pairs').addEventListener('change', (event) => { byId('pairs-body').hidden = !event.target.checked; });

  Panel.legend(stage);
  if (image) stage.below = byId('stage').clientHeight - byId('legend').offsetTop + 6;
  view(kTopFirst);
  glass('auto');
  if (path) seek(0);
  if (image && path) motion.hideNow();
  if (ringed) contact.show(ringed, () => []);  // draws only the ring; the robots keep their colours
  stage.drawNow();
  let looking = 0;
  stage.onView = () => {
    clearTimeout(looking);
    if (obstacles.mode === 'auto' && triangles <= 1e5 && !image) looking = setTimeout(() => glass('auto'), 250);
  };
  window.corridorView = {stage, motion, obstacles, closest, trees, contact, player, plots, seek, showFinding};
  if (image) console.info('corridor: the picture is drawn');
}

/**
 * Returns the points that the first view must show (points that the robots reach, and obstacles near these points), and
 * the bounds of everything.
 */
function interest(robotPoints, robotBox, obstacles) {
  const bounds = robotBox.clone(), near = robotBox.clone();
  for (const body of obstacles.bodies) bounds.union(body.bounds);
  if (near.isEmpty()) near.copy(bounds);
  near.expandByScalar((data.planar ? 0.6 : 0.3) * near.getSize(new THREE.Vector3()).length());
  const points = [...robotPoints];
  for (const body of obstacles.bodies) {
    const box = body.bounds.clone().intersect(near);
    if (box.isEmpty()) continue;
    for (let corner = 0; corner < 8; ++corner) {
      points.push(new THREE.Vector3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z));
    }
  }
  if (!points.length) points.push(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1));
  if (bounds.isEmpty()) bounds.setFromPoints(points);
  return [points, bounds];
}

/**
 * Plays the path, and handles slider, button and keys. A path with times is played at its true speed, or at a multiple
 * of it.
 */
class Player {
  constructor(seek, now) {
    Object.assign(this, {seek, now, playing: 0});
    byId('slider').addEventListener('input', (event) => { this.pause(); seek(Number(event.target.value)); });
    byId('play').addEventListener('click', () => this.toggle());
    this.icon();
    document.addEventListener('keydown', (event) => this.key(event));
  }

  key(event) {
    const typed = event.target.tagName === 'BUTTON' || event.target.tagName === 'SUMMARY' || event.target.tagName === 'A';
    const other = event.target.tagName === 'SELECT' || event.target.tagName === 'INPUT' && event.target.id !== 'slider';
    if (event.ctrlKey || event.altKey || event.metaKey || other) return;
    const states = path.states.map((i) => path.at[i]), at = this.now(), tiny = 1e-6;
    const to = {
      ' ': () => { if (!typed) this.toggle(); else return false; },
      ArrowRight: () => this.step(event.shiftKey ? states.find((s) => s > at + tiny) ?? 1 : at + 0.01),
      ArrowLeft: () => this.step(event.shiftKey ? [...states].reverse().find((s) => s < at - tiny) ?? 0 : at - 0.01),
      Home: () => this.step(0),
      End: () => this.step(1),
    }[event.key];
    if (to && to() !== false) event.preventDefault();
  }

  step(at) {
    this.pause();
    this.seek(Math.min(1, Math.max(0, at)));
  }
  toggle() { if (this.playing) this.pause(); else this.play(); }
  play() {
    if (this.now() >= 1) this.seek(0);
    const duration = path.times ? path.times[1] - path.times[0] : kDuration;
    let last = null;
    const frame = (time) => {
      if (!this.playing) return;
      const at = this.now() + (time - (last ?? time)) / 1000 * Number(byId('speed').value) / duration;
      last = time;
      this.seek(Math.min(1, at));
      if (at >= 1) this.pause(); else if (this.playing) this.playing = requestAnimationFrame(frame);
    };
    this.playing = requestAnimationFrame(frame);
    this.icon();
  }
  pause() {
    cancelAnimationFrame(this.playing);
    this.playing = 0;
    this.icon();
  }

  icon() {
    const button = byId('play'), svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    const shape = document.createElementNS('http://www.w3.org/2000/svg', 'path');
    svg.setAttribute('viewBox', '0 0 14 14');
    shape.setAttribute('d', this.playing ? 'M2 1h3.6v12H2zM8.4 1H12v12H8.4z' : 'M3 1l10 6-10 6z');
    svg.append(shape);
    button.replaceChildren(svg);
    button.setAttribute('aria-label', this.playing ? 'Pause' : 'Play');
  }

  /** Draws ticks on the slider, for the states and the findings. */
  ticks() {
    const add = (i, className) => {
      const tick = make('i');
      tick.className = className;
      tick.style.left = `${100 * path.at[i]}%`;
      byId('ticks').append(tick);
    };
    if (path.states.length <= 400) path.states.forEach((i) => add(i, ''));
    path.findings.forEach((i) => add(i, 'finding'));
  }
}

start();
