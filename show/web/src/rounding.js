// Which columns are nothing but what rounding leaves of a zero.

// A number this much smaller than the largest of its kind is not known: a rounding of 1.1e-16, some thousand times.
const NOTHING = 1e-12;
const KINDS = { 'N*m': 'N', 'N.m': 'N' };

const largest = (values) => values.reduce((most, v) => (Number.isFinite(v) ? Math.max(most, Math.abs(v)) : most), 0);

/** Sets `nothing` of each line to its largest size where it is rounding alone beside others of its kind, or else to 0. */
export function measure(charts) {
  const sizes = new Map();
  const kind = ({ group, unit }) => `${group === 'Energy' ? group : ''}${KINDS[unit] ?? unit}`;
  for (const chart of charts) {
    for (const line of chart.lines) {
      line.size = largest(line.column.values);
      sizes.set(kind(chart), Math.max(sizes.get(kind(chart)) ?? 0, line.size));
    }
  }
  for (const chart of charts) {
    // These tell how large rounding is.
    const isTold = chart.log || chart.title.startsWith('error');
    for (const line of chart.lines) line.nothing = !isTold && line.size < NOTHING * sizes.get(kind(chart)) ? line.size : 0;
  }
}
