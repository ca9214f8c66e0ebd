// As driver.c: reads numbers and writes numbers, as their bytes; what an exported ES module makes of them.
import { readFileSync, writeSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const [path, what] = process.argv.slice(2);
const { about, load } = await import(pathToFileURL(path));
const m = await load();
const Real = about.real === 'f32' ? Float32Array : Float64Array;
const bytes = readFileSync(0);
const given = new Real(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
let next = 0;
const number = () => given[next++];
const numbers = (n) => given.slice(next, next += n);
const told = [];
const tell = (values) => told.push(...values);
const { n_state: nState, n_joints: nJoints } = about.sizes;

function kernels() {
  for (let n = number(); n > 0; n--) {
    const [t, y, x] = [number(), numbers(nState), numbers(nJoints)];
    tell(m.jointAccelerations(t, x));
    tell(m.jointDerivative(t, x));
    tell(m.toMaximal(t, x));
    for (const name of ['toJoints', 'energy', 'outputs', 'phi', 'velocityResidual', 'readJoints', 'derivative',
      'correctedDerivative']) tell(m[name](t, y));
  }
}

// As C divides numbers of this type.
const real = (x) => new Real([x])[0];

function run(method) {
  const [tolerance, end, nSteps, nSamples] = numbers(4);
  const solver = m.solver({ method: ['rk4', 'tsit5', 'dop853', 'rodas4'][method], tolerance });
  let status = 0;
  try {
    for (let sample = 0; sample < nSamples;) {
      const at = real(real(end * (sample + 1)) / nSamples);
      if (solver.t >= at) {
        tell(solver.interpolate(at));
        sample += 1;
      } else if (nSteps > 0) solver.step(real(end / nSteps));
      else solver.stepTowards(end);
    }
  } catch (failure) {
    status = ['ok', 'not_finite', 'no_convergence', 'singular', 'jump', 'step_too_short', 'too_many_steps', 'stiff',
      'invalid_step', 'invalid_time', 'invalid_tolerance', 'invalid_method'].indexOf(failure.status);
    if (status < 0) throw failure;
  }
  const { accepted, rejected, evaluations, leaps } = solver.statistics;
  tell([status, ...solver.state, accepted, rejected, evaluations, leaps]);
}

about.parameters.forEach(({ name }) => m.setParameter(name, number()));
about.inputs.forEach(({ name }) => m.setInput(name, number()));
if (what === 'kernels') kernels(); else run(Number(what));
const out = new Uint8Array(new Real(told).buffer);
for (let at = 0; at < out.length;) at += writeSync(1, out, at);
