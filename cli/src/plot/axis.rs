//! Axes with ticks that read well: round numbers, a unit with a prefix, an offset taken out.

/// How values are laid out along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    Linear,
    Log,
}

/// An axis in its own coordinate: `(value − offset) / factor`, or the decimal logarithm of the value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    pub(crate) scale: Scale,
    pub(crate) offset: f64,
    pub(crate) factor: f64,
    /// Unit with its prefix, and what was taken out: `[mrad/s] − 100 rad/s`.
    pub(crate) unit: String,
    pub(crate) range: (f64, f64),
    pub(crate) ticks: Vec<f64>,
    decimals: usize,
}

/// Prefixes from femto to giga with their powers of ten.
const PREFIXES: [(&str, i32); 9] =
    [("f", -15), ("p", -12), ("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9)];

/// Values that differ by less than this part of themselves are shown as differences from the first.
const FLAT: f64 = 1e-3;

/// On a logarithmic axis nothing is shown below this: a zero residual has no logarithm.
const FLOOR: f64 = 1e-18;

impl Axis {
    /// An axis for all of these values.
    pub(crate) fn of<'a>(scale: Scale, unit: &str, values: impl Iterator<Item = &'a f64> + Clone) -> Self {
        match scale {
            Scale::Linear => Self::linear(unit, values),
            Scale::Log => Self::log(unit, values),
        }
    }

    /// Time from zero to the end.
    pub(crate) fn time(t_end: f64) -> Self {
        let mut axis = Self::linear("s", [0.0, t_end].iter());
        axis.range = (0.0, t_end / axis.factor);
        axis.ticks.retain(|t| (0.0..=axis.range.1 * (1.0 + 1e-9)).contains(t));
        axis
    }

    /// The axis' coordinate of a value.
    pub(crate) fn coordinate(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.offset) / self.factor,
            Scale::Log => value.abs().max(FLOOR).log10(),
        }
    }

    /// The text of a tick.
    pub(crate) fn label(&self, tick: f64) -> String {
        match self.scale {
            Scale::Linear => {
                // No negative zero.
                let text = format!("{:.*}", self.decimals, tick + 0.0);
                if text.trim_start_matches('-').chars().all(|c| "0.".contains(c)) {
                    "0".to_owned()
                } else {
                    text
                }
            }
            Scale::Log => format!("1e{tick:.0}"),
        }
    }

    fn linear<'a>(unit: &str, values: impl Iterator<Item = &'a f64> + Clone) -> Self {
        let (low, high) = extent(values.clone());
        let largest = low.abs().max(high.abs());
        let is_flat = high > low && high - low < FLAT * largest;
        let offset = if is_flat { values.clone().next().copied().unwrap_or(0.0) } else { 0.0 };
        let (low, high) = (low - offset, high - offset);
        let (prefixed, factor) = prefixed(low.abs().max(high.abs()), unit);
        let bracketed = if prefixed.is_empty() { prefixed } else { format!("[{prefixed}]") };
        let unit = match (is_flat, offset < 0.0) {
            (false, _) => bracketed,
            (true, false) => format!("− {} {bracketed}", shortest(offset)),
            (true, true) => format!("+ {} {bracketed}", shortest(-offset)),
        };
        let (range, ticks, decimals) = nice(low / factor, high / factor);
        Self { scale: Scale::Linear, offset, factor, unit, range, ticks, decimals }
    }

    fn log<'a>(unit: &str, values: impl Iterator<Item = &'a f64>) -> Self {
        let (mut low, mut high) = extent(values.filter(|v| **v != 0.0));
        if low <= 0.0 {
            (low, high) = (FLOOR, 10.0 * FLOOR);
        }
        let low = low.max(FLOOR).log10().floor();
        let high = high.max(FLOOR).log10().ceil().max(low + 1.0);
        let stride = ((high - low) / 8.0).ceil().max(1.0);
        let n_ticks = ((high - low) / stride).floor() as usize + 1;
        let ticks = (0..n_ticks).map(|k| low + k as f64 * stride).collect();
        let unit = if unit.is_empty() { String::new() } else { format!("[{unit}]") };
        Self { scale: Scale::Log, offset: 0.0, factor: 1.0, unit, range: (low, high), ticks, decimals: 0 }
    }
}

fn extent<'a>(values: impl Iterator<Item = &'a f64>) -> (f64, f64) {
    let finite = values.filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    if low <= high { (low, high) } else { (0.0, 0.0) }
}

/// The unit with the prefix that leaves one to three digits before the point, and the prefix' power of ten. Where there
/// is no prefix, as for pure numbers, the power itself is written.
fn prefixed(largest: f64, unit: &str) -> (String, f64) {
    if largest == 0.0 {
        return (unit.to_owned(), 1.0);
    }
    let power = (largest * (1.0 + 1e-9)).log10().floor() as i32;
    // Tenths read well without a prefix.
    let third = if power == -1 { 0 } else { power.div_euclid(3) * 3 };
    let prefixed = match PREFIXES.iter().find(|(_, p)| *p == third) {
        _ if third == 0 => unit.to_owned(),
        Some((name, _)) if !unit.is_empty() => format!("{name}{unit}"),
        _ => format!("1e{third} {unit}").trim_end().to_owned(),
    };
    (prefixed, 10f64.powi(third))
}

fn shortest(value: f64) -> String {
    crate::words::number(value, 6)
}

/// A range around the values with round ticks in it, and the ticks' decimals.
fn nice(low: f64, high: f64) -> ((f64, f64), Vec<f64>, usize) {
    let (low, high) = if high > low { (low, high) } else { (low - 1.0, high + 1.0) };
    let margin = 0.05 * (high - low);
    let range = (low - margin, high + margin);
    let rough = (range.1 - range.0) / 6.0;
    let power = rough.log10().floor();
    let unit = 10f64.powf(power);
    let step = [1.0, 2.0, 5.0, 10.0].iter().map(|m| m * unit).find(|s| *s >= rough).unwrap_or(10.0 * unit);
    let decimals = (-(step * (1.0 + 1e-9)).log10().floor()).max(0.0) as usize;
    let first = (range.0 / step).ceil();
    let n_ticks = ((range.1 / step).floor() - first) as usize + 1;
    (range, (0..n_ticks).map(|k| (first + k as f64) * step).collect(), decimals)
}

#[cfg(test)]
mod tests;
