// The mechanism as WebAssembly: what its run is from the time that is shown on, with parameters and inputs as they are
// set there. The samples of the page's first run are replaced in place, a few in each frame.
import { Failure, Mechanism } from '../../../export/wasm/runtime.mjs';
import { indexAt } from './data.js';

// Of a frame, ms: the rest is for drawing.
const SLICE = 8;
// Steps that stability alone keeps short, before a run is taken for stiff.
const MANY = 500;

export class Live {
  static async of(given, bytes, scene) {
    return new Live(await Mechanism.of(given.about, bytes), given, scene);
  }

  constructor(mechanism, given, scene) {
    const { about } = mechanism;
    Object.assign(this, { mechanism, given, scene, listeners: [], failure: null, waiting: false });
    this.states = new Float64Array(scene.n * about.sizes.n_joints);
    this.bodies = about.bodies.map((name) => scene.mechanism.bodies.findIndex((body) => body.name === name));
    // Those of free bodies are the numbers of the picture.
    this.columns = scene.columns.filter(({ group }) => group !== 'Free bodies');
    this.sources = sources(this.columns, about.states.map(({ name }) => name));
    this.work = about.states.findIndex(({ name }) => name === 'work');
    this.reset();
    this.solver = mechanism.solver();
    this.begin(0);
  }

  listen(listener) { this.listeners.push(listener); }

  /** Whether all samples are those of the present values. */
  get isReady() { return this.next >= this.scene.n; }

  /** Parameters and inputs of the run that the page came with. */
  reset() {
    this.method = this.given.method;
    for (const { name, value } of this.given.parameters) this.mechanism.setParameter(name, value);
    for (const { name, value } of this.given.inputs) this.mechanism.setInput(name, value);
  }

  set(kind, name, value) {
    if (kind === 'parameter') this.mechanism.setParameter(name, value);
    else this.mechanism.setInput(name, value);
  }

  state(k) {
    const size = this.mechanism.about.sizes.n_joints;
    return this.states.subarray(k * size, (k + 1) * size);
  }

  /** Computes anew what follows a time, or as much of it as is not known yet. */
  from(t) {
    this.begin(Math.min(indexAt(this.scene.time, t), Math.max(0, this.next - 1)));
  }

  begin(k) {
    const state = k > 0 ? this.state(k) : this.mechanism.jointStart();
    this.failure = null;
    this.solver.restart({ method: this.method, tolerance: this.given.tolerance, t: this.scene.time[k], state });
    this.next = k;
    this.balance = null;
    this.tried(() => {
      // Another length may have opened a loop.
      this.solver.correct();
      this.keep(k, this.solver.state);
    });
    this.schedule();
  }

  schedule() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      const end = performance.now() + SLICE;
      while (!this.isReady && performance.now() < end) this.tried(() => this.advance());
      if (!this.isReady) this.schedule();
      for (const listener of this.listeners) listener(this);
    });
  }

  /** On to the next sample. */
  advance() {
    const { time } = this.scene;
    const at = time[this.next];
    while (this.solver.t < at) this.solver.stepTowards(time[time.length - 1]);
    this.keep(this.next, this.solver.t > at ? this.solver.interpolate(at) : this.solver.state);
    const { accepted, limitedByStability } = this.solver.statistics;
    if (limitedByStability > Math.max(MANY, accepted / 4) && this.hasImplicit) this.goOnImplicitly();
  }

  get hasImplicit() { return this.method !== 'rodas4' && Boolean(this.mechanism.jointJacobian); }

  goOnImplicitly() {
    this.method = 'rodas4';
    this.begin(Math.max(0, this.next - 1));
  }

  tried(work) {
    try {
      work();
    } catch (failure) {
      // Of numbers that are too large to go on with, the mechanism says so by a RangeError.
      if (!(failure instanceof Failure || failure instanceof RangeError)) throw failure;
      if (failure.status === 'stiff' && this.hasImplicit) {
        this.goOnImplicitly();
        return;
      }
      this.failure = failure;
      this.stop();
    }
  }

  /** From here on nothing is known: bodies stay where they are, curves end. */
  stop() {
    const { bodies, n } = this.scene;
    const last = Math.max(0, this.next - 1);
    for (const { pose, velocity, moves } of bodies) {
      if (moves) for (const values of [...pose, ...velocity]) values.fill(values[last], this.next);
    }
    for (const { values } of this.columns) values.fill(NaN, this.next);
    this.next = n;
  }

  /** A sample. */
  keep(k, x) {
    const { mechanism: m, scene } = this;
    const t = scene.time[k];
    const y = m.toMaximal(t, x);
    this.state(k).set(x);
    const n = this.bodies.length;
    this.bodies.forEach((b, slot) => {
      const { pose, velocity } = scene.bodies[b];
      pose.forEach((values, c) => { values[k] = y[7 * slot + c]; });
      velocity.forEach((values, c) => { values[k] = y[7 * n + 6 * slot + c]; });
    });
    const [kinetic, potential] = m.energy(t, y);
    const work = this.work < 0 ? 0 : x[this.work];
    this.balance ??= kinetic + potential - work;
    const facts = {
      k,
      dt: k > 0 ? t - scene.time[k - 1] : 0,
      state: x,
      readings: m.readJoints(t, y),
      outputs: m.about.sizes.n_outputs > 0 ? m.outputs(t, y) : [],
      inputs: Object.values(m.inputs),
      energy: { kinetic, potential, work, '': kinetic + potential - work - this.balance },
      violation: [largest(m.phi(t, y)), largest(m.velocityResidual(t, y))],
    };
    this.columns.forEach(({ values }, c) => { values[k] = this.sources[c](facts); });
    this.next = k + 1;
  }
}

const largest = (numbers) => numbers.reduce((most, x) => Math.max(most, Math.abs(x)), 0);

// What fills each column: of a joint in the joint state its place there, of one at which a loop is cut its readings.
function sources(columns, states) {
  const [next, place] = [{ Outputs: 0, Inputs: 0 }, new Map()];
  let end = 0;
  for (const { group, title, unit } of columns) {
    if (group !== 'Joints' || place.has(title)) continue;
    place.set(title, end);
    end += { 1: 7, rad: 3, m: 2 }[unit];
  }
  return columns.map(({ group, title, name, unit, values }) => {
    if (group === 'Energy') return ({ energy }) => energy[name];
    if (group === 'Violations') return ({ violation }) => violation[title === 'constraints' ? 0 : 1];
    if (group === 'Outputs' || group === 'Inputs') {
      const n = next[group]++;
      return group === 'Inputs' ? ({ inputs }) => inputs[n] : ({ outputs }) => outputs[n];
    }
    const n = states.indexOf([title, group === 'Rates' && 'rate', name].filter(Boolean).join(' '));
    if (n >= 0) return ({ state }) => state[n];
    const at = place.get(title);
    if (name) return ({ readings }) => readings[at + ['e0', 'e1', 'e2', 'e3', 'x', 'y', 'z'].indexOf(name)];
    if (unit === 'rad') return ({ readings, k, dt }) => angle(readings.subarray(at), values[Math.max(0, k - 1)], dt);
    const rate = { 'rad/s': 2, 'm/s': 1, m: 0 }[unit];
    return ({ readings }) => readings[at + rate];
  });
}

// Sine and cosine, by the same factor, and the rate: the angle nearest to where the one before has gone.
function angle([sine, cosine, rate], before, dt) {
  const turn = 2 * Math.PI;
  const own = Math.atan2(sine, cosine);
  return own + turn * Math.round((before + rate * dt - own) / turn);
}
