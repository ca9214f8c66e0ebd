// Calls that nobody should make of an exported ES module: each is refused in words, and changes nothing.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const [path] = process.argv.slice(2);
const { about, load, Failure } = await import(pathToFileURL(path));
const m = await load();
const { n_joints: n, n_state: nState } = about.sizes;
const start = m.jointStart();
const kept = m.solver({ tolerance: 1e-6 });
const undisturbed = (await m.another()).solver({ tolerance: 1e-6 });
for (const solver of [kept, undisturbed]) for (let k = 0; k < 3; k++) solver.stepTowards(1);
const bits = (numbers) => [...new Uint8Array(Float64Array.from(numbers).buffer)].join();

// What a caller can see of a mechanism and of a solver in mid-run.
const seen = () => JSON.stringify([m.parameters, m.inputs, kept.t, kept.statistics, about]) + bits(kept.state)
  + bits(m.jointStart()) + bits(m.jointAccelerations(0.1, start)) + bits(m.energy(0, m.toMaximal(0, start)));
const before = seen();
let count = 0;

function holds(error, kind, words) {
  assert.ok(error instanceof kind, `${error.name}, not ${kind.name}: ${error.message}`);
  assert.match(error.message, words);
  assert.equal(seen(), before, `after: ${error.message}`);
  count += 1;
}

function refused(call, kind, words) {
  assert.throws(call, (error) => { holds(error, kind, words); return true; }, `nothing refused: ${call}`);
}

const numbers = (length, value = 0.1) => new Array(length).fill(value);
const detached = new Float64Array(start);
structuredClone(detached.buffer, { transfer: [detached.buffer] });
const outgrown = new WebAssembly.Memory({ initial: 1 });
const grown = new Float64Array(outgrown.buffer, 0, n);
outgrown.grow(1);

// What is no array of so many finite numbers, for each place where one is taken.
const places = [
  ['jointAccelerations, x', n, (x) => m.jointAccelerations(0, x)],
  ['jointDerivative, x', n, (x) => m.jointDerivative(0, x)],
  ['toMaximal, x', n, (x) => m.toMaximal(0, x)],
  ['energy, y', nState, (y) => m.energy(0, y)],
  ['toJoints, x', n, (x) => m.toJoints(0, m.toMaximal(0, start), x)],
  ['state', n, (state) => m.solver({ state })],
  ['state', n, (state) => kept.restart({ state })],
  ['state', n, (state) => { kept.state = state; }],
];
for (const [what, size, call] of places) {
  const with_ = (value) => [...numbers(size - 1), value];
  const begin = new RegExp(`^${what}`);
  for (const wrong of [numbers(size + 1), numbers(size - 1), [], new Float32Array(size + 1), { length: 1e9 }, { length: -1 }]) {
    refused(() => call(wrong), RangeError, new RegExp(`^${what}: ${size} numbers, not ${wrong.length}`));
  }
  if (size === n) {
    refused(() => call(detached), RangeError, /transferred/);
    refused(() => call(grown), RangeError, /transferred/);
  }
  for (const wrong of [null, 0, 'x'.repeat(size), '1'.repeat(size), true, {}, Symbol('x'), () => 0, 3n, new Map(), new ArrayBuffer(8 * size)]) {
    refused(() => call(wrong), TypeError, new RegExp(`^${what}: an array of ${size} numbers`));
  }
  for (const wrong of [NaN, Infinity, -Infinity]) refused(() => call(with_(wrong)), RangeError, /\]: -?\w+ is no finite f\d/);
  for (const wrong of ['1', null, undefined, 1n, [1], { valueOf: () => 1 }, true, Symbol('x')]) {
    refused(() => call(with_(wrong)), TypeError, begin);
  }
  refused(() => call(new BigInt64Array(size)), TypeError, begin);
  refused(() => call(new Array(size)), TypeError, begin);
  // One that calls back, needs more memory and then turns out to be none.
  const trap = { length: size, get 0() { m.jointAccelerations(0, start); m.solver(); return 0.1; } };
  refused(() => call(trap), TypeError, begin);
}

for (const wrong of ['0', null, undefined, 1n, [], {}, true, Symbol('t')]) {
  refused(() => m.jointAccelerations(wrong, start), TypeError, /^jointAccelerations, t: a number, not /);
  refused(() => kept.step(wrong), TypeError, /^h: a number, not /);
  refused(() => kept.advanceTo(wrong), TypeError, /^tEnd: a number, not /);
  refused(() => kept.stepTowards(wrong), TypeError, /^tEnd: a number, not /);
  refused(() => kept.interpolate(wrong), TypeError, /^t: a number, not /);
  if (wrong === undefined) continue;
  for (const name of ['t', 'tolerance', 'relative', 'absolute', 'firstStep', 'smallestStep', 'largestStep', 'budget', 'correctEvery']) {
    refused(() => kept.restart({ [name]: wrong }), TypeError, new RegExp(`: a number, not `));
  }
  refused(() => kept.restart({ method: wrong }), RangeError, /no method is called .*: rk4, tsit5/);
}
refused(() => m.jointAccelerations(NaN, start), RangeError, /^jointAccelerations, t: NaN is not finite/);
refused(() => m.jointAccelerations(0, start, start, start), TypeError, /not 4 arguments/);
refused(() => m.jointAccelerations(), TypeError, /a number, not undefined/);
for (const wrong of [null, 'tsit5', 1]) refused(() => kept.restart(wrong), TypeError, /^options: an object, not /);
refused(() => kept.restart({ tolerence: 1e-6 }), RangeError, /no option is called tolerence: method/);
refused(() => kept.restart({ method: 'toString' }), RangeError, /no method is called "toString"/);
for (const wrong of [NaN, -1, 0.5, Infinity, 1e300]) {
  refused(() => kept.restart({ budget: wrong }), RangeError, /^budget: a whole number/);
  refused(() => kept.restart({ correctEvery: wrong }), RangeError, /^correctEvery: a whole number/);
}

for (const [kind, set, known] of [['parameter', 'setParameter', about.parameters], ['input', 'setInput', about.inputs]]) {
  for (const wrong of ['no such', -1, 0.5, NaN, known.length, undefined, null, Symbol('x'), '__proto__', {}]) {
    refused(() => m[set](wrong, 1), RangeError, new RegExp(`^no ${kind} is called `));
  }
  for (const { name } of known) {
    for (const wrong of ['1', null, undefined, 1n, [1], {}, true]) refused(() => m[set](name, wrong), TypeError, new RegExp(`^${name}: a number`));
    for (const wrong of [NaN, Infinity, -Infinity]) refused(() => m[set](name, wrong), RangeError, new RegExp(`^${name} cannot be `));
  }
}

// What is known of a mechanism is not to be changed: other sizes would lead out of its arrays.
for (const change of [
  () => { about.sizes.n_joints = 1e6; }, () => { about.functions[0].arguments[0].size = 1e6; }, () => { m.about = {}; },
  () => { m.Real = Int8Array; }, () => { kept.mechanism = null; }, () => { m.energy = null; }, () => about.parameters.push({}),
]) refused(change, TypeError, /read only|not extensible|read-only/);

// Times and lengths that cannot be are failures, as in C, and the state is as it was.
for (const [call, status] of [
  [() => kept.step(NaN), 'invalid_step'], [() => kept.step(Infinity), 'invalid_step'],
  [() => kept.advanceTo(NaN), 'invalid_time'], [() => kept.interpolate(NaN), 'invalid_time'], [() => kept.interpolate(-1), 'invalid_time'],
]) refused(call, Failure, status === 'invalid_step' ? /step of this length/ : /time is not finite/);
const spoiled = m.solver();
for (const tolerance of [NaN, 0, -1, 1e-300, Infinity]) {
  spoiled.restart({ tolerance });
  refused(() => spoiled.advanceTo(1), Failure, /tolerances must be positive/);
}

async function refusedModule(source, kind, words) {
  await assert.rejects(load(source), (error) => { holds(error, kind, words); return true; });
}
for (const wrong of [null, 42, {}, () => 0]) await refusedModule(wrong, TypeError, /its address, its bytes or a WebAssembly.Module/);
await refusedModule('beside.wasm', TypeError, /is no address: write new URL/);
await refusedModule(new URL('no-such.wasm', import.meta.url), Error, /no-such.wasm/);
await refusedModule(new Uint8Array(8), WebAssembly.CompileError, /magic/);
await refusedModule(Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0), TypeError, /not the module of/);
await refusedModule(new WebAssembly.Module(Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0)), TypeError, /not the module of/);
assert.ok(readFileSync(path.replace(/mjs$/, 'wasm')).length > 0);

// After all of it, the solver goes on with the bits of one that nobody has disturbed.
for (const solver of [kept, undisturbed]) for (let k = 0; k < 3; k++) solver.stepTowards(2);
assert.equal(bits(kept.state), bits(undisturbed.state));
assert.equal(kept.t, undisturbed.t);
console.log(`${count} calls refused`);
