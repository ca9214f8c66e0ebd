// From the page's bytes to numbers: undoes what `show/src/channel.rs` does.

const NONE = -2147483648;

function unpack(channel, n, bytes, start) {
  const values = new Float64Array(n);
  const { base, step, order, planes, log } = channel;
  if (!planes) return values.fill(log ? 2 ** (base ?? NaN) : base ?? NaN);
  const numbers = new Int32Array(n);
  for (let k = 0; k < n; k++) {
    let folded = 0;
    for (let plane = 0; plane < planes; plane++) folded |= bytes[start + plane * n + k] << (8 * plane);
    numbers[k] = (folded >>> 1) ^ -(folded & 1);
  }
  for (let pass = 0; pass < order; pass++) {
    for (let k = 1; k < n; k++) numbers[k] = (numbers[k] + numbers[k - 1]) | 0;
  }
  for (let k = 0; k < n; k++) {
    const value = numbers[k] === NONE ? NaN : base + step * numbers[k];
    values[k] = log ? 2 ** value : value;
  }
  return values;
}

// Where bodies are that no joint holds, and how they move: the numbers of the picture itself.
function ofFreeBodies(mechanism, bodies) {
  const parts = [['position', 'pose', 0, 'm', ['x', 'y', 'z']], ['orientation', 'pose', 3, '1', ['e0', 'e1', 'e2', 'e3']],
    ['velocity', 'velocity', 0, 'm/s', ['x', 'y', 'z']], ['angular velocity, body frame', 'velocity', 3, 'rad/s', ['x', 'y', 'z']]];
  return mechanism.bodies.flatMap(({ name, free }, b) => (free && bodies[b].moves ? parts : []).flatMap(([what, of, first, unit, names]) =>
    names.map((own, k) => ({ group: 'Free bodies', title: `${name} ${what}`, name: own, unit, log: false, channel: {}, values: bodies[b][of][first + k] }))));
}

export function readScenes(head, bytes) {
  let start = 0;
  const next = (channel, n) => {
    const values = unpack(channel, n, bytes, start);
    start += channel.planes * n;
    return values;
  };
  const scenes = head.scenes.map((scene) => {
    const time = next(scene.time, scene.n);
    // The start is zero, whatever rounding makes of it.
    if (scene.n && Math.abs(time[0]) < 1e-9 * Math.abs(time[scene.n - 1])) time[0] = 0;
    const bodies = scene.bodies.map(({ pose, velocity }) => {
      const moves = velocity.length > 0;
      return {
        moves,
        pose: pose.map((c) => next(c, moves ? scene.n : 1)),
        velocity: velocity.map((c) => next(c, scene.n)),
      };
    });
    const columns = scene.columns.map((c) => ({ ...c, log: c.channel.log, values: next(c.channel, scene.n) }));
    return { ...scene, time, bodies, columns: [...columns, ...ofFreeBodies(scene.mechanism, bodies)], events: scene.events ?? [] };
  });
  const meshes = (head.meshes ?? []).map(({ n, vertices, triangles }) => ({
    vertices: vertices.map((c) => next(c, n[0])),
    triangles: next(triangles, 3 * n[1]),
  }));
  scenes.forEach((scene) => { scene.meshes = (scene.meshes ?? []).map((place) => meshes[place]); });
  return scenes;
}

// The last sample that is not after t.
export function indexAt(time, t) {
  let low = 0;
  let high = time.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (time[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

// Position and Euler parameters of a body at a time, between samples interpolated: [x, y, z, e0, e1, e2, e3].
export function poseAt(scene, b, t, pose = new Float64Array(7)) {
  const channels = scene.bodies[b].pose;
  const { time } = scene;
  const k = indexAt(time, t);
  const i = scene.bodies[b].moves ? k : 0;
  const j = scene.bodies[b].moves ? Math.min(k + 1, time.length - 1) : 0;
  const part = j > i ? Math.min(1, Math.max(0, (t - time[i]) / (time[j] - time[i]))) : 0;
  let dot = 0;
  for (let c = 3; c < 7; c++) dot += channels[c][i] * channels[c][j];
  let norm = 0;
  for (let c = 0; c < 7; c++) {
    const to = c > 2 && dot < 0 ? -channels[c][j] : channels[c][j];
    pose[c] = channels[c][i] + part * (to - channels[c][i]);
    if (c > 2) norm += pose[c] * pose[c];
  }
  norm = Math.sqrt(norm) || 1;
  for (let c = 3; c < 7; c++) pose[c] /= norm;
  return pose;
}

// A value between samples.
export function valueAt(time, values, t) {
  const i = indexAt(time, t);
  const j = Math.min(i + 1, time.length - 1);
  if (j === i || !(time[j] > time[i])) return values[i];
  const part = Math.min(1, Math.max(0, (t - time[i]) / (time[j] - time[i])));
  return values[i] + part * (values[j] - values[i]);
}

/** A function of time that gives a number of a law: a constant, an input with its sign, or what an output tells. */
export function amountOf({ columns, time }, amount) {
  if (typeof amount === 'number') return () => amount;
  const inputs = columns.filter(({ group }) => group === 'Inputs');
  const told = ({ group, title, name }) => group === 'Outputs' && title === amount.output && name === amount.part;
  const column = 'input' in amount ? inputs[amount.input] : columns.find(told);
  return (t) => (column ? (amount.sign ?? 1) * valueAt(time, column.values, t) : 0);
}
