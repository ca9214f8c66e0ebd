// The moving picture.
import {
  AmbientLight, AxesHelper, CircleGeometry, Color, DirectionalLight, Group, HemisphereLight, LineBasicMaterial, LineSegments,
  BufferGeometry, Float32BufferAttribute, Mesh, MeshLambertMaterial, PCFShadowMap, PerspectiveCamera, Quaternion, Raycaster,
  Scene, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { element } from '../layout.js';
import { Actors } from './actors.js';
import { Arrows } from './arrows.js';
import { Names } from './names.js';
import { Trails } from './trails.js';
import { degrees } from '../units.js';
import { recorder } from './record.js';
import { triad } from './triad.js';
import { corners, direction, fit, middle, standard, upOf } from './view.js';

function renderer(canvas) {
  const context = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
  if (!context) return null;
  try {
    return new WebGLRenderer({ canvas, context, antialias: true, preserveDrawingBuffer: true });
  } catch { return null; }
}

export function picture(place, scenes, clock, theme, numbers) {
  const canvas = element('canvas', { tabindex: 0, 'aria-label': 'moving picture of the mechanism' });
  const gl = renderer(canvas);
  if (!gl) {
    place.word.hidden = false;
    place.word.textContent = 'No picture: this browser has no WebGL, or it is switched off. Plots and times work without.';
    return null;
  }
  place.picture.append(canvas);
  gl.shadowMap.enabled = true;
  gl.shadowMap.type = PCFShadowMap;
  gl.setPixelRatio(Math.min(devicePixelRatio, 2));

  const world = new Scene();
  world.background = new Color();
  const stage = new Group();
  world.add(stage);
  const all = scenes.map((scene, run) => new Actors(scene, run, theme.colours));
  const { size } = all[0].form;
  // One unit is the mechanism's size, whatever its metres are.
  stage.scale.setScalar(1 / size);
  for (const actors of all) stage.add(actors.root);
  const up = upOf(scenes[0].mechanism);
  const points = all.flatMap(corners).map((p) => p.divideScalar(size));
  const from = direction(scenes[0], up, all[0].form);
  const near = all[0].scene.bodies.some(({ moves }) => moves) ? corners(all[0], true).map((p) => p.divideScalar(size)) : points;
  const overlay = element('canvas', { class: 'triad', width: 144, height: 144 });
  place.picture.append(overlay);

  const camera = new PerspectiveCamera(28, 1, 0.01, 100);
  const controls = new OrbitControls(camera, canvas);
  controls.enableDamping = false;
  const ground = groundBelow(points, up, all[0].form.thick / size);
  world.add(ground.group);
  const sun = lights(world, points, up, from);

  let names = new Names(place.picture, scenes[0].mechanism, all[0]);
  const trails = new Trails(all, stage);
  const arrows = new Arrows(all, world, size);
  const frames = new Group();
  const axesOf = ({ bodies }) => bodies.map(({ group }) => {
    const axes = new AxesHelper(0.16 * size);
    axes.visible = false;
    axes.raycast = () => {};
    group.add(axes);
    return axes;
  });
  let ownAxes = axesOf(all[0]);
  world.add(frames);

  let waiting = false;
  // Where the camera looks at while it follows.
  let followed = null;
  const follow = () => {
    if (!followed) return;
    const now = middle(all[0]).divideScalar(size);
    const by = now.clone().sub(followed);
    followed = now;
    camera.position.add(by);
    controls.target.add(by);
  };
  const draw = () => {
    waiting = false;
    all.forEach((actors) => actors.show(clock.t));
    follow();
    trails.show(clock.t);
    arrows.show(clock.t);
    world.updateMatrixWorld();
    names.show(camera, canvas);
    gl.render(world, camera);
    const context = overlay.getContext('2d');
    context.clearRect(0, 0, 144, 144);
    triad(context, camera, [72, 72], 64);
  };
  const compose = (onto) => {
    draw();
    [onto.width, onto.height] = [canvas.width & ~1, canvas.height & ~1];
    const context = onto.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const radius = 32 * gl.getPixelRatio();
    triad(context, camera, [onto.width - 1.2 * radius, onto.height - 1.2 * radius], radius);
    context.fillStyle = theme.colours.ink;
    context.textAlign = 'left';
    context.font = `${radius / 2.2}px system-ui, sans-serif`;
    context.fillText(`t = ${place.time.textContent}`, radius / 2, onto.height - radius / 2);
  };
  const ask = () => { if (!waiting) { waiting = true; requestAnimationFrame(draw); } };
  // Another run of the same bodies.
  const renew = () => { trails.renew(); arrows.renew(); ask(); };
  // Other bodies: the first run's mechanism has other measures.
  const remake = () => {
    stage.remove(all[0].root);
    all[0] = new Actors(scenes[0], 0, theme.colours);
    stage.add(all[0].root);
    ownAxes = axesOf(all[0]);
    names.remove();
    names = new Names(place.picture, scenes[0].mechanism, all[0]);
    for (const box of Object.values(boxes)) box.onchange();
    all[0].select(numbers.selected());
    renew();
  };
  const look = (way) => {
    all.forEach((actors) => actors.show(clock.t));
    followed &&= middle(all[0]).divideScalar(size);
    const at = followed;
    fit(camera, controls.target, at ? near.map((p) => p.clone().add(at)) : points, way, up);
    controls.update();
    ask();
  };
  const home = () => look(from);
  const views = standard(up);
  const { png, video } = recorder(scenes[0].mechanism.name, clock, compose);

  const toggles = {
    f: ['frames', false, (on) => ownAxes.forEach((axes) => { axes.visible = on; })],
    t: ['trails', false, (on) => trails.turn(on)],
    i: ['inertia', false, (on) => all.forEach((actors) => actors.showEllipsoids(on))],
    l: ['names', false, (on) => names.turn(on)],
    a: ['forces', false, (on) => arrows.turn(on)],
    g: ['ground', true, (on) => { ground.group.visible = on; }],
    c: ['follow', isLong(points, near), (on) => { if (on !== Boolean(followed)) { followed = on ? new Vector3() : null; home(); } }],
    d: ['degrees', false, degrees],
  };
  const boxes = {};
  for (const [key, [words, on, apply]] of Object.entries(toggles)) {
    const box = element('input', { type: 'checkbox' });
    box.checked = on;
    box.onchange = () => { apply(box.checked); ask(); };
    boxes[key] = box;
    place.options.append(element('label', { title: `${words} (${key.toUpperCase()})` }, box, words));
    apply(on);
  }
  const press = (words, key, action) => place.options.append(element('button', { type: 'button', title: `${words} (${key.toUpperCase()})`, onclick: action }, words));
  for (const [key, [words, way]] of Object.entries(views)) press(words, key, () => look(way));
  press('PNG', 'p', png);
  press('video', 'v', video);
  addEventListener('picture-key', ({ detail: key }) => {
    if (key === 'r') home();
    if (views[key]) look(views[key][1]);
    if (key === 'p') png();
    if (key === 'v') video();
    if (key === 'escape') numbers.select(null);
    if (boxes[key]) { boxes[key].checked = !boxes[key].checked; boxes[key].onchange(); }
  });

  const ray = new Raycaster();
  const under = ({ offsetX, offsetY }) => {
    ray.setFromCamera(new Vector2((2 * offsetX) / canvas.clientWidth - 1, 1 - (2 * offsetY) / canvas.clientHeight), camera);
    for (const { object } of ray.intersectObjects(all.map(({ root }) => root), true)) {
      for (let up1 = object; up1; up1 = up1.parent) if (up1.userData.body !== undefined) return up1.userData;
    }
    return null;
  };
  let pressed = null;
  canvas.addEventListener('pointerdown', (event) => { pressed = [event.clientX, event.clientY]; });
  canvas.addEventListener('click', (event) => {
    if (pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 5) return;
    const found = under(event);
    numbers.select(found ? found.body : null);
  });
  canvas.addEventListener('pointermove', (event) => {
    const found = event.buttons ? null : under(event);
    place.label.hidden = !found;
    if (!found) return;
    place.label.textContent = scenes[found.run].mechanism.bodies[found.body].name + (scenes.length > 1 ? ` · ${scenes[found.run].name}` : '');
    place.label.style.transform = `translate(${event.offsetX + 14}px, ${event.offsetY + 10}px)`;
  });
  canvas.addEventListener('pointerleave', () => { place.label.hidden = true; });
  numbers.onSelect((b) => { all.forEach((actors) => actors.select(b)); ask(); });

  const paint = () => {
    world.background.set(theme.colours.sky);
    ground.paint(theme.colours);
    for (const actors of all) {
      actors.materials.made.get('fixed')?.color.set(theme.colours.fixed);
      actors.materials.made.get('metal')?.color.set(theme.colours.joint);
    }
    sun.intensity = theme.name === 'dark' ? 2.2 : 2.6;
    ask();
  };
  theme.listen(paint);
  let first = true;
  const resize = () => {
    const { clientWidth: wide, clientHeight: high } = place.picture;
    if (!wide || !high) return;
    gl.setSize(wide, high, false);
    canvas.style.width = `${wide}px`;
    canvas.style.height = `${high}px`;
    camera.aspect = wide / high;
    camera.updateProjectionMatrix();
    if (first) home();
    first = false;
    draw();
  };
  new ResizeObserver(resize).observe(place.picture);
  paint();
  resize();
  controls.addEventListener('change', ask);
  clock.listen(ask);
  return { canvas, camera, controls, home, draw, renew, remake, boxes, all, arrows, trails, gl, points, under, png, video, views, look };
}

const most = (points, value) => points.reduce((best, p) => Math.max(best, value(p)), -Infinity);

// Whether a motion is much longer than the mechanism, which would be a dot in a picture of the whole.
function isLong(points, near) {
  const longest = (all) => Math.max(...[0, 1, 2].map((k) => most(all, (p) => p.getComponent(k)) + most(all, (p) => -p.getComponent(k))));
  return longest(points) > 6 * longest(near);
}

// A round of ground below all that moves, with its shadow.
function groundBelow(points, up, thick) {
  const low = -most(points, (p) => -p.dot(up)) - 0.3 * thick;
  const centre = points.reduce((sum, p) => sum.add(p), new Vector3()).divideScalar(points.length || 1);
  centre.addScaledVector(up, low - centre.dot(up));
  const wide = 1.25 * Math.max(0.6, most(points, (p) => p.clone().addScaledVector(up, low - p.dot(up)).distanceTo(centre)));
  const group = new Group();
  group.position.copy(centre);
  group.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), up));
  const floor = new Mesh(new CircleGeometry(wide, 72), new MeshLambertMaterial());
  floor.receiveShadow = true;
  floor.raycast = () => {};
  const lines = [];
  const step = 10 ** Math.floor(Math.log10(wide)) / 2;
  for (let s = -Math.floor(wide / step) * step; s <= wide; s += step) {
    const half = Math.sqrt(Math.max(0, wide * wide - s * s));
    lines.push(s, -half, 0, s, half, 0, -half, s, 0, half, s, 0);
  }
  const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(lines, 3));
  const grid = new LineSegments(geometry, new LineBasicMaterial({ transparent: true, opacity: 0.6 }));
  grid.position.z = 0.002;
  group.add(floor, grid);
  const paint = (colours) => { floor.material.color.set(colours.ground); grid.material.color.set(colours.grid); };
  return { group, paint };
}

function lights(world, points, up, from) {
  world.add(new AmbientLight('#ffffff', 0.55));
  const sky = new HemisphereLight('#ffffff', '#8a8f98', 1.0);
  sky.position.copy(up);
  world.add(sky);
  const far = Math.max(1, most(points, (p) => p.length()));
  const sun = new DirectionalLight('#ffffff', 2.4);
  const side = up.clone().cross(from).normalize();
  const middle = points.reduce((sum, p) => sum.add(p), new Vector3()).divideScalar(points.length || 1);
  sun.position.copy(middle).addScaledVector(up, 2.2 * far).addScaledVector(from, 0.8 * far).addScaledVector(side, -1.1 * far);
  sun.target.position.copy(middle);
  sun.castShadow = true;
  sun.shadow.mapSize.set(1024, 1024);
  const reach = 1.2 * Math.max(most(points, (p) => p.distanceTo(middle)), 0.5);
  Object.assign(sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.01, far: 8 * far });
  sun.shadow.bias = -0.0005;
  sun.shadow.normalBias = 0.01;
  sun.shadow.radius = 4;
  world.add(sun, sun.target);
  return sun;
}
