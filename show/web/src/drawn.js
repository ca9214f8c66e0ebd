// What parameters do to the drawing: lengths, points and inertias change with them, to first order.

// A number of the mechanism, by its path, and what holds it.
function place(mechanism, path) {
  const keys = path.split('/').slice(1);
  const last = keys.pop();
  return [keys.reduce((at, key) => at[key], mechanism), last];
}

/** Sets the mechanism's numbers to those of the parameters; whether any has changed. */
export function drawnWith(mechanism, { parameters, slopes }, values) {
  let hasChanged = false;
  const sums = new Map();
  for (const { path, base, parameter, slope } of slopes) {
    const { name, value } = parameters[parameter];
    sums.set(path, (sums.get(path) ?? base) + slope * (values[name] - value));
  }
  for (const [path, value] of sums) {
    const [at, key] = place(mechanism, path);
    hasChanged ||= at[key] !== value;
    at[key] = value;
  }
  return hasChanged;
}
