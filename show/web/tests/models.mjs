// The models of the gallery: file, options of `show`, and the part of the run after which the picture is taken.
export const MODELS = [
  ['models/gyroscope.toml', ['--t-end', '10'], 0.22],
  ['models/gyroscope-four-bar.toml', ['--t-end', '0.2', '--every', '0.002'], 0.02],
  ['models/driven-gyroscope.toml', ['--t-end', '0.5'], 0.25],
  ['models/pitching-gyroscope.toml', ['--t-end', '0.5'], 0.2],
  ['models/gyroscope-rolling-base.toml', ['--t-end', '0.2'], 0.8],
  ['models/gyroscope-gimbal-lock.toml', ['--t-end', '0.2'], 0.22],
  ['models/heavy-top.toml', ['--t-end', '1'], 0.3],
  ['models/spinning-top.toml', ['--t-end', '1'], 0.1],
  ['models/free-body.toml', ['--t-end', '1'], 0.3],
  ['models/compound-pendulum.toml', ['--t-end', '2'], 0.37],
  ['models/torsion.toml', ['--t-end', '4'], 0.37],
  ['models/four-bar-revolute.toml', ['--t-end', '2'], 0.2],
  ['models/four-bar.toml', ['--t-end', '1', '--every', '0.01'], 0.1],
  ['models/four-bar-in-line.toml', ['--t-end', '0.5', '--every', '0.01'], 0.1],
  ['models/slider-crank.toml', ['--t-end', '1'], 0.05],
  ['models/stewart-platform.toml', ['--t-end', '0.5', '--every', '0.01'], 0],
  ['models/double-wishbone.toml', ['--t-end', '1', '--every', '0.01'], 0.5],
  ['models/four-bar-bushing.toml', ['--t-end', '1', '--every', '0.01'], 0.3],
  ['examples/cart-pendulum/cart-pendulum.toml', ['--t-end', '2', '--every', '0.01'], 0.15],
  ['examples/arm/arm.toml', ['--t-end', '0.4', '--every', '0.01', '--input', 'motor=-60'], 0.65],
  ['models/stabilised-gimbal.toml', ['--coordinates', 'joint'], 0.12],
];

// Those that are computed in the page, too.
export const LIVE = [
  ['models/gyroscope.toml', ['--t-end', '1']],
  ['models/driven-gyroscope.toml', ['--t-end', '1']],
  ['models/four-bar.toml', ['--t-end', '2']],
  ['examples/cart-pendulum/cart-pendulum.toml', ['--t-end', '2']],
  ['examples/arm/arm.toml', ['--t-end', '2']],
  ['examples/pendulum.toml', ['--t-end', '2']],
];
// Too stiff for the method that such a page begins with.
export const STIFF = ['models/gyroscope-stiff.toml', ['--t-end', '1', '--every', '0.01', '--integrator', 'tsit5', '--tolerance', '1e-4']];

export const ROOT = new URL('../../..', import.meta.url).pathname;
export const nameOf = (file) => file.replace(/^.*\//, '').replace(/\.toml$/, '');
