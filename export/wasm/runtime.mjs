// A mechanism in WebAssembly, as JavaScript calls it. The module has a memory of its own and imports nothing; a call
// copies its arrays in and out, so that what it returns is the caller's. What a call is given is checked before anything
// of the module is touched: a wrong type is a TypeError, a wrong length or number a RangeError.

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
const OPTIONS = ['method', 't', 'state', 'tolerance', 'relative', 'absolute', 'firstStep', 'smallestStep', 'largestStep',
  'budget', 'correctEvery'];
const PAGE = 65536;

/** `joint_accelerations` is `jointAccelerations`. */
const camel = (name) => name.replace(/_+([a-z0-9])/g, (_, letter) => letter.toUpperCase());

/** A value in words. */
function shown(value) {
  if (typeof value === 'string') return JSON.stringify(value);
  if (typeof value === 'object' && value !== null) return Array.isArray(value) ? 'an array' : 'an object';
  return typeof value === 'bigint' ? `${value}n, a BigInt` : String(value);
}

function number(value, what) {
  if (typeof value !== 'number') throw new TypeError(`${what}: a number, not ${shown(value)}`);
  return value;
}

/** An object with all that it holds, which nobody changes any more: other sizes would lead out of the arrays. */
function frozen(object) {
  for (const part of Object.values(object)) if (typeof part === 'object' && part !== null) frozen(part);
  return Object.freeze(object);
}

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
  const isAddress = source instanceof URL || typeof source === 'string';
  if (!isAddress && !(source instanceof ArrayBuffer) && !ArrayBuffer.isView(source)) {
    throw new TypeError(`a module comes from its address, its bytes or a WebAssembly.Module, not from ${shown(source)}`);
  }
  return WebAssembly.compile(isAddress ? await bytesAt(address(source)) : source);
}

function address(source) {
  try {
    return new URL(source, globalThis.location?.href);
  } catch {
    throw new TypeError(`${shown(source)} is no address: write new URL(${shown(source)}, import.meta.url)`);
  }
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
    const absent = ['init', ...about.functions.map(({ name }) => name)].find((name) => !exports[`${about.name}_${name}`]);
    if (absent) throw new TypeError(`this is not the module of ${about.name}: it has no function ${about.name}_${absent}`);
    this.about = frozen(about);
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
    Object.freeze(this);
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
    const at = 16 * Math.ceil(this.#top / 16);
    const missing = at + bytes - this.#wasm.memory.buffer.byteLength;
    try {
      if (missing > 0) this.#wasm.memory.grow(Math.ceil(missing / PAGE));
    } catch {
      throw new RangeError(`${this.about.name} has no memory for another solver: restart one that is done`);
    }
    this.#top = at + bytes;
    return at;
  }

  #numbers(at, size) {
    return new this.Real(this.#wasm.memory.buffer, at >>> 0, size);
  }

  /** A copy of numbers that can be computed with. */
  #copied(numbers, size, what) {
    if (typeof numbers?.length !== 'number' || typeof numbers !== 'object') {
      throw new TypeError(`${what}: an array of ${size} numbers, not ${shown(numbers)}`);
    }
    if (numbers.length !== size) {
      const why = numbers.buffer?.byteLength === 0 ? ' (its buffer is empty, or has been transferred)' : '';
      throw new RangeError(`${what}: ${size} numbers, not ${numbers.length}${why}`);
    }
    const copy = new this.Real(size);
    for (let n = 0; n < size; n++) {
      const given = numbers[n];
      if (typeof given !== 'number') number(given, `${what}[${n}]`);
      copy[n] = given;
      if (!Number.isFinite(copy[n])) throw new RangeError(`${what}[${n}]: ${given} is no finite ${this.about.real}`);
    }
    return copy;
  }

  /** What a function is passed of an argument: arrays that it writes are zero where nothing is given. */
  #argument(value, { name, size, out }, of) {
    const what = `${camel(of)}, ${name}`;
    if (size !== undefined) return out && value === undefined ? new this.Real(size) : this.#copied(value, size, what);
    if (!Number.isFinite(number(value, what))) throw new RangeError(`${what}: ${value} is not finite`);
    return value;
  }

  #call({ name, arguments: wanted }, given) {
    const order = [...wanted.filter(({ out }) => !out), ...wanted.filter(({ out }) => out)];
    if (given.length > order.length) {
      throw new TypeError(`${camel(name)}: ${order.map((of) => of.name).join(', ')}, not ${given.length} arguments`);
    }
    const values = new Map(order.map((argument, n) => [argument, this.#argument(given[n], argument, name)]));
    const passed = [this.#own];
    const written = [];
    let at = this.#scratch;
    for (const argument of wanted) {
      const { size, out } = argument;
      if (size === undefined) {
        passed.push(values.get(argument));
        continue;
      }
      passed.push(at);
      this.#numbers(at, size).set(values.get(argument));
      if (out) written.push({ argument: argument.name, at, size });
      at = (at + size * this.Real.BYTES_PER_ELEMENT + 7) & ~7;
    }
    this.#function(name)(...passed);
    const results = written.map(({ argument, at: place, size }) => [argument, this.#numbers(place, size).slice()]);
    return results.length === 1 ? results[0][1] : Object.fromEntries(results);
  }

  #set(kind, name, value) {
    const all = this.about[`${kind}s`];
    const index = typeof name === 'number' ? name : all.findIndex((of) => of.name === name);
    const known = all[index]?.name;
    if (known === undefined) {
      const names = all.map((of) => of.name).join(', ') || 'there are none';
      throw new RangeError(`no ${kind} is called ${shown(name)}: ${names}`);
    }
    number(value, known);
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
    const at = this.#take(this.#function('solver_bytes')());
    return new Solver({
      mechanism: this,
      wasm: this.#wasm,
      at,
      call: (name, ...given) => this.#function(`solver_${name}`)(at, ...given),
      own: this.#own,
      scratch: this.#scratch,
      copied: (numbers, what) => this.#copied(numbers, this.about.sizes.n_joints, what),
      copyIn: (numbers) => this.#numbers(this.#scratch, numbers.length).set(numbers),
      copyOut: (place) => this.#numbers(place, this.about.sizes.n_joints).slice(),
      words: (status) => this.#text(this.#function('status_text')(status)),
      text: (place) => this.#text(place),
    }, options);
  }

  #text(at) {
    if (!at) return null;
    const bytes = new Uint8Array(this.#wasm.memory.buffer);
    return new TextDecoder().decode(bytes.slice(at >>> 0, bytes.indexOf(0, at >>> 0)));
  }
}

/** Integrates joint coordinates, closes loops after each step, controls the error. */
export class Solver {
  #to;

  constructor(to, options) {
    this.#to = to;
    this.mechanism = to.mechanism;
    this.restart(options);
    Object.freeze(this);
  }

  /** Begins anew, at a time and in a state; what is not given is as it is by default. */
  restart(options = {}) {
    if (typeof options !== 'object' || options === null) throw new TypeError(`options: an object, not ${shown(options)}`);
    const unknown = Object.keys(options).find((name) => !OPTIONS.includes(name));
    if (unknown !== undefined) throw new RangeError(`no option is called ${unknown}: ${OPTIONS.join(', ')}`);
    const { method = 'dop853', t = 0, state = this.mechanism.jointStart(), tolerance = 1e-8, relative = tolerance,
      absolute = tolerance, firstStep = 0, smallestStep = 0, largestStep = Infinity, budget = 1e7, correctEvery = 1 } = options;
    const index = METHODS.indexOf(method);
    if (index < 0) throw new RangeError(`no method is called ${shown(method)}: ${METHODS.join(', ')}`);
    const numbers = { t, tolerance, relative, absolute, firstStep, smallestStep, largestStep, budget, correctEvery };
    for (const [name, value] of Object.entries(numbers)) number(value, name);
    for (const [name, least, most] of [['budget', 0, Number.MAX_SAFE_INTEGER], ['correctEvery', 1, 0xffffffff]]) {
      const value = numbers[name];
      if (!Number.isInteger(value) || value < least || value > most) {
        throw new RangeError(`${name}: a whole number from ${least} to ${most}, not ${value}`);
      }
    }
    const x = this.#to.copied(state, 'state');
    this.#to.copyIn(x);
    this.#to.call('init', index, t, this.#to.scratch);
    this.#to.wasm.solver_control(this.#to.at, relative, absolute, firstStep, smallestStep, largestStep, budget, correctEvery);
  }

  /** The time, s. */
  get t() { return this.#to.call('time'); }

  /** The joint state: coordinates, then rates, then work. */
  get state() { return this.#to.copyOut(this.#to.call('state')); }

  set state(numbers) {
    this.#to.copyIn(this.#to.copied(numbers, 'state'));
    this.#to.call('set_state', this.#to.scratch);
  }

  /** What steps have cost, and what they have met. */
  get statistics() {
    const value = (_, n) => this.#to.wasm.solver_statistic(this.#to.at, n);
    return Object.fromEntries(STATISTICS.map((name, n) => [name, value(name, n)]));
  }

  /** One step of fixed length h, s. */
  step(h) { this.#checked(this.#to.call('step', this.#to.own, number(h, 'h'))); }

  /** One step under error control, at most to `tEnd`. */
  stepTowards(tEnd) { this.#checked(this.#to.call('step_towards', this.#to.own, number(tEnd, 'tEnd'))); }

  /** Steps under error control to `tEnd`. */
  advanceTo(tEnd) { this.#checked(this.#to.call('advance_to', this.#to.own, number(tEnd, 'tEnd'))); }

  /** Closes the loops of the state now. */
  correct() { this.#checked(this.#to.call('correct', this.#to.own)); }

  /** The state at a time within the last step. */
  interpolate(t) {
    this.#checked(this.#to.call('interpolate', this.#to.own, number(t, 't'), this.#to.scratch));
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
