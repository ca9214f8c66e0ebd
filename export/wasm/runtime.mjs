// A mechanism in WebAssembly, as JavaScript calls it. The module has a memory of its own and imports nothing; a call
// copies its arrays in and out, so that what it returns is the caller's.

/** A step or a correction that could not be made. */
export class Failure extends Error {
  /** @param {object} facts what `solver.error` has in C */
  constructor(words, facts) {
    super(`${words} at ${facts.t} s${facts.owner ? ` (${facts.owner})` : ''}`);
    this.name = 'Failure';
    Object.assign(this, facts);
  }
}

const METHODS = ['rk4', 'tsit5', 'dop853', 'rodas4'];
const STATUS = ['ok', 'not_finite', 'no_convergence', 'singular', 'jump', 'step_too_short', 'too_many_steps', 'stiff',
  'invalid_step', 'invalid_time', 'invalid_tolerance', 'invalid_method'];
const STATISTICS = ['accepted', 'rejected', 'corrections', 'evaluations', 'jacobians', 'limitedByStability', 'leaps',
  'fastestRate', 'shortestStep', 'longestStep'];
const PAGE = 65536;

/** `joint_accelerations` is `jointAccelerations`. */
const camel = (name) => name.replace(/_+([a-z0-9])/g, (_, letter) => letter.toUpperCase());

/** The bytes at an address: a file in Node, else what the address answers. */
async function bytesAt(url) {
  if (url.protocol === 'file:' && globalThis.process?.versions?.node) {
    const { readFile } = await import(/* @vite-ignore */ 'node:fs/promises');
    return readFile(url);
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${url}: ${answer.status} ${answer.statusText}`);
  return answer.arrayBuffer();
}

/** The module, compiled, from what names it or is it. */
async function compiled(source) {
  if (source instanceof WebAssembly.Module) return source;
  const bytes = source instanceof URL || typeof source === 'string'
    ? await bytesAt(new URL(source, globalThis.location?.href)) : source;
  return WebAssembly.compile(bytes);
}

/** A mechanism with its parameters and inputs. */
export class Mechanism {
  #wasm;
  #own;
  #top;
  #scratch;
  #values;

  /** From a module, its bytes or its address. */
  static async of(about, source) {
    const module = await compiled(source);
    return new Mechanism(about, module, await WebAssembly.instantiate(module));
  }

  constructor(about, module, { exports }) {
    this.about = about;
    this.module = module;
    this.#wasm = exports;
    this.Real = about.real === 'f32' ? Float32Array : Float64Array;
    this.#own = exports.mechanism();
    this.#top = exports.__heap_base.value;
    const sizes = about.functions.map((of) => of.arguments.reduce((sum, { size }) => sum + (size ?? 0) + 1, 0));
    this.#scratch = this.#take(8 * Math.max(64, 2 * about.sizes.n_joints, ...sizes));
    this.#function('init')(this.#own);
    this.#values = {
      parameter: new Map(about.parameters.map(({ name, value }) => [name, value])),
      input: new Map(about.inputs.map(({ name, value }) => [name, value])),
    };
    for (const of of about.functions) this[camel(of.name)] = (...given) => this.#call(of, given);
  }

  /** Another of the kind, with the model file's parameters, in a memory of its own. */
  async another() {
    return Mechanism.of(this.about, this.module);
  }

  #function(name) {
    return this.#wasm[`${this.about.name}_${name}`];
  }

  // Memory that nobody else uses; what is taken stays taken.
  #take(bytes) {
    const at = (this.#top + 15) & ~15;
    this.#top = at + bytes;
    const missing = this.#top - this.#wasm.memory.buffer.byteLength;
    if (missing > 0) this.#wasm.memory.grow(Math.ceil(missing / PAGE));
    return at;
  }

  #numbers(at, size) {
    return new this.Real(this.#wasm.memory.buffer, at, size);
  }

  #copyIn(at, size, numbers, what) {
    if (numbers?.length !== size) throw new RangeError(`${what}: ${size} numbers, not ${numbers?.length ?? 'none'}`);
    this.#numbers(at, size).set(numbers);
  }

  #call({ name, arguments: wanted }, given) {
    const rest = [...given];
    const passed = [this.#own];
    const written = [];
    let at = this.#scratch;
    for (const { name: argument, size, out } of wanted) {
      if (size === undefined) {
        passed.push(rest.shift());
        continue;
      }
      passed.push(at);
      if (out) written.push({ argument, at, size });
      else this.#copyIn(at, size, rest.shift(), `${camel(name)}, ${argument}`);
      at = (at + size * this.Real.BYTES_PER_ELEMENT + 7) & ~7;
    }
    for (const { argument, at: place, size } of written) {
      if (rest.length > 0) this.#copyIn(place, size, rest.shift(), `${camel(name)}, ${argument}`);
      else this.#numbers(place, size).fill(0);
    }
    this.#function(name)(...passed);
    const results = written.map(({ argument, at: place, size }) => [argument, this.#numbers(place, size).slice()]);
    return results.length === 1 ? results[0][1] : Object.fromEntries(results);
  }

  #set(kind, name, value) {
    const index = typeof name === 'number' ? name : this.about[`${kind}s`].findIndex((known) => known.name === name);
    const known = this.about[`${kind}s`][index]?.name;
    if (known === undefined) throw new RangeError(`no ${kind} is called ${name}`);
    if (!this.#function(`set_${kind}`)(this.#own, index, value)) throw new RangeError(`${known} cannot be ${value}`);
    this.#values[kind].set(known, value);
  }

  setParameter(name, value) { this.#set('parameter', name, value); }

  setInput(name, value) { this.#set('input', name, value); }

  /** The parameters as they are set. */
  get parameters() { return Object.fromEntries(this.#values.parameter); }

  /** The inputs as they are set. */
  get inputs() { return Object.fromEntries(this.#values.input); }

  /** A solver of its own; `mechanism` may be changed between its steps. */
  solver(options = {}) {
    if (!this.about.hasSolver) throw new Error(`${this.about.name} has no joint coordinates, which the solver integrates`);
    const at = this.#take(this.#wasm.solver_size());
    return new Solver({
      mechanism: this,
      wasm: this.#wasm,
      at,
      call: (name, ...given) => this.#function(`solver_${name}`)(at, ...given),
      own: this.#own,
      scratch: this.#scratch,
      copyIn: (numbers, what) => this.#copyIn(this.#scratch, this.about.sizes.n_joints, numbers, what),
      copyOut: (place) => this.#numbers(place, this.about.sizes.n_joints).slice(),
      words: (status) => this.#text(this.#function('status_text')(status)),
      text: (place) => this.#text(place),
    }, options);
  }

  #text(at) {
    if (!at) return null;
    const bytes = new Uint8Array(this.#wasm.memory.buffer);
    return new TextDecoder().decode(bytes.slice(at, bytes.indexOf(0, at)));
  }
}

/** Integrates joint coordinates, closes loops after each step, controls the error. */
export class Solver {
  #to;

  constructor(to, options) {
    this.#to = to;
    this.mechanism = to.mechanism;
    this.restart(options);
  }

  /** Begins anew, at a time and in a state; what is not given is as it is by default. */
  restart({ method = 'dop853', t = 0, state = this.mechanism.jointStart(), tolerance = 1e-8, relative = tolerance,
    absolute = tolerance, firstStep = 0, smallestStep = 0, largestStep = Infinity, budget = 1e7, correctEvery = 1 } = {}) {
    const number = METHODS.indexOf(method);
    if (number < 0) throw new RangeError(`no method is called ${method}: ${METHODS.join(', ')}`);
    this.#to.copyIn(state, 'state');
    this.#to.call('init', number, t, this.#to.scratch);
    this.#to.wasm.solver_control(this.#to.at, relative, absolute, firstStep, smallestStep, largestStep, budget, correctEvery);
  }

  /** The time, s. */
  get t() { return this.#to.wasm.solver_time(this.#to.at); }

  /** The joint state: coordinates, then rates, then work. */
  get state() { return this.#to.copyOut(this.#to.wasm.solver_state(this.#to.at)); }

  set state(numbers) {
    this.#to.copyIn(numbers, 'state');
    this.#to.call('set_state', this.#to.scratch);
  }

  /** What steps have cost, and what they have met. */
  get statistics() {
    const value = (_, n) => this.#to.wasm.solver_statistic(this.#to.at, n);
    return Object.fromEntries(STATISTICS.map((name, n) => [name, value(name, n)]));
  }

  /** One step of fixed length h, s. */
  step(h) { this.#checked(this.#to.call('step', this.#to.own, h)); }

  /** One step under error control, at most to `tEnd`. */
  stepTowards(tEnd) { this.#checked(this.#to.call('step_towards', this.#to.own, tEnd)); }

  /** Steps under error control to `tEnd`. */
  advanceTo(tEnd) { this.#checked(this.#to.call('advance_to', this.#to.own, tEnd)); }

  /** Closes the loops of the state now. */
  correct() { this.#checked(this.#to.call('correct', this.#to.own)); }

  /** The state at a time within the last step. */
  interpolate(t) {
    this.#checked(this.#to.call('interpolate', this.#to.own, t, this.#to.scratch));
    return this.#to.copyOut(this.#to.scratch);
  }

  /** Says that parameters or inputs have changed. */
  changed() { this.#to.call('changed'); }

  #checked(status) {
    if (status === 0) return;
    const { wasm, at, text, words } = this.#to;
    const [t, value, limit] = [0, 1, 2].map((n) => wasm.solver_failure(at, n));
    throw new Failure(words(status), { status: STATUS[status], t, value, limit, index: wasm.solver_index(at), owner: text(wasm.solver_owner(at)) });
  }
}
