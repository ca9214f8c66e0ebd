// Writes the pages that the tests and the gallery look at, by the project's own command.
import { execFileSync } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { LIVE, MODELS, ROOT, STIFF, nameOf } from './models.mjs';

const OTHERS = [
  ['examples/pendulum.toml', ['--t-end', '1', '--compare', 'length=0.4', '--reactions'], 'compared'],
  ...[...LIVE, STIFF].map(([file, more]) => [file, [...more, '--live'], `live-${nameOf(file)}`]),
  ['show/web/tests/thrown.toml', ['--tolerance', '1e-9', '--live'], 'live-thrown'],
  ['show/web/tests/wedge.toml', [], 'wedge'],
  ['examples/laws/quadrotor.toml', ['--t-end', '1'], 'quadrotor'],
  ['examples/laws/crane.toml', [], 'crane'],
  ['examples/contact/crates.toml', [], 'crates'],
  ['show/web/tests/thrown.toml', ['--tolerance', '1e-9'], 'thrown'],
  ['examples/pendulum.toml', ['--t-end', '100', '--every', '0.001', '--step', '0.001'], 'many'],
];

export function writePages(folder) {
  mkdirSync(folder, { recursive: true });
  for (const [file, options, name] of [...MODELS.map(([file, more]) => [file, more, nameOf(file)]), ...OTHERS]) {
    const args = ['xtask', 'show', file, ...options, '--out', join(folder, `${name}.html`)];
    execFileSync('cargo', args, { cwd: ROOT, stdio: ['ignore', 'inherit', 'ignore'] });
  }
}

if (process.argv[1] === new URL(import.meta.url).pathname) writePages(process.argv[2]);
