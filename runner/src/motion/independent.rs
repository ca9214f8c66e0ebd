//! Linearisation of loops in independent coordinates.

use super::contract::{COLUMNS, Element, Linear, rows};
use gyro_sim::{Coordinate, Description, Dual, JointPlace, JointSpace, Mechanism, Real, Scalar};

/// What is asked of a mechanism in dual numbers beside its Jacobian.
pub trait Closing: Mechanism {
    /// Closes positions and velocities of a joint state, by one step each.
    fn close(&self, t: Self::Scalar, x: &mut [Self::Scalar]);
    /// The outputs at a joint state.
    fn outputs_of(&self, t: Self::Scalar, x: &[Self::Scalar]) -> Vec<Self::Scalar>;
}

impl<D: JointSpace> Closing for D {
    fn outputs_of(&self, t: D::Scalar, x: &[D::Scalar]) -> Vec<D::Scalar> {
        let (mut joints, mut y, mut outputs) = (self.joint_start(), self.start(), self.buffers().outputs);
        joints.as_mut().copy_from_slice(x);
        self.to_maximal(t, &joints, &mut y);
        self.outputs(t, &y, &mut outputs);
        outputs.as_ref().to_vec()
    }

    fn close(&self, t: D::Scalar, x: &mut [D::Scalar]) {
        let mut joints = self.joint_start();
        joints.as_mut().copy_from_slice(x);
        self.close_positions(t, &mut joints);
        self.close_velocities(t, &mut joints);
        x.copy_from_slice(joints.as_ref());
    }
}

/// The linearisation about a closed state in as many coordinates as there are degrees of freedom; `linear` is that in
/// all coordinates, without the work.
pub(super) fn reduced<M, D>(mechanism: &M, duals: &D, x: &[M::Scalar], linear: &Linear) -> Linear
where
    M: JointSpace<Scalar: Real>,
    D: Closing<Scalar = Dual<M::Scalar, COLUMNS>>,
{
    let tangent = Tangent::of(mechanism, duals, x, linear);
    let n = linear.state.len();
    let n_inputs = linear.by_inputs.len() / n;
    let by_state = tangent.directions().into_iter().map(|direction| {
        let change: Vec<_> = linear.by_state.chunks(n).map(|row| dot(row, &direction)).collect();
        tangent.kept(&change)
    });
    let by_inputs = (0..n_inputs).map(|input| {
        let change: Vec<_> = linear.by_inputs.iter().skip(input).step_by(n_inputs).copied().collect();
        tangent.kept(&change)
    });
    let outputs_by_state = tangent.directions().into_iter().map(|direction| {
        linear.outputs_by_state.chunks(n).map(|row| dot(row, &direction)).collect::<Vec<_>>()
    });
    let places = || tangent.independent.iter().map(|&k| &tangent.rates[k]);
    let positions = places().map(|rate| rate.position_at.map_or(0.0, |at| linear.state[at]));
    let moving = || tangent.independent_rates.iter().map(|&k| &tangent.rates[k]);
    let rates = tangent.independent_rates.iter().map(|&k| linear.state[tangent.n_coordinates + k]);
    let states = tangent.states.iter().map(|&at| linear.state[at]);
    let own = tangent.states.iter().map(|&at| linear.elements[at]);
    Linear {
        t: linear.t,
        elements: places().map(Rate::element).chain(moving().map(Rate::element_of_rate)).chain(own).collect(),
        state: positions.chain(rates).chain(states).collect(),
        slope: tangent.kept(&linear.slope),
        by_state: rows(&by_state.collect::<Vec<_>>()),
        by_inputs: rows(&by_inputs.collect::<Vec<_>>()),
        outputs: linear.outputs.clone(),
        outputs_by_state: rows(&outputs_by_state.collect::<Vec<_>>()),
        outputs_by_inputs: linear.outputs_by_inputs.clone(),
    }
}

/// One number of u.
struct Rate {
    place: JointPlace,
    /// Which of the place's it is.
    component: usize,
    /// Where the number of which it is the derivative stands in x; none for rates of turning.
    position_at: Option<usize>,
    /// The derivative of x where this rate is one and the others are zero.
    derivative: Vec<f64>,
    /// Its unit: the mechanism's size for lengths.
    unit: f64,
}

impl Rate {
    /// All of u.
    fn all<M: JointSpace>(mechanism: &M, x: &[f64]) -> Vec<Self> {
        let (layout, mut rates, mut from) = (mechanism.joint_layout(), Vec::new(), 0);
        for &place in layout.places {
            let n_lengths = match place {
                JointPlace::Scalar { .. } => 1,
                JointPlace::Orientation { .. } | JointPlace::Turn { .. } | JointPlace::State { .. } => 0,
                JointPlace::Body { .. } => 3,
            };
            for component in 0..place.n_rates() {
                let mut derivative = vec![0.0; layout.n_coordinates()];
                let position_at = (component < n_lengths).then_some(from + component);
                match position_at {
                    Some(at) => derivative[at] = 1.0,
                    None => {
                        let [e0, e1, e2, e3] = core::array::from_fn(|k| x[from + n_lengths + k] / 2.0);
                        // ½ G(p)ᵀ
                        let turning = [[-e1, e0, e3, -e2], [-e2, -e3, e0, e1], [-e3, e2, -e1, e0]];
                        derivative[from + n_lengths..][..4].copy_from_slice(&turning[component - n_lengths]);
                    }
                }
                let is_length = position_at.is_some() && !is_angle(mechanism.description(), place);
                let unit = if is_length { mechanism.description().size } else { 1.0 };
                rates.push(Self { place, component, position_at, derivative, unit });
            }
            from += place.n_coordinates();
        }
        rates
    }

    fn element(&self) -> Element {
        let (place, component) = (self.place, self.component);
        match (self.position_at, place) {
            (Some(_), _) => Element::Position { place, component },
            (None, JointPlace::Body { .. }) => Element::Turn { place, component: component - 3 },
            (None, _) => Element::Turn { place, component },
        }
    }

    fn element_of_rate(&self) -> Element {
        Element::Rate { place: self.place, component: self.component }
    }
}

fn is_angle(description: &Description<'_>, place: JointPlace) -> bool {
    let JointPlace::Scalar { joint, coordinate } = place else { return false };
    description.joints[usize::from(joint)].coordinates.get(usize::from(coordinate))
        == Some(&Coordinate::Angle)
}

/// How a state can change on the closure: x by `T N δq`, u by `W δq + R δq̇`, with q the independent coordinates and q̇
/// the independent rates, which are fewer where rows of velocities hold. T has the derivatives of x by each rate, the
/// columns of N span what closed positions leave free, those of R the null space of the closure's Jacobian, and W is
/// how rates follow positions.
struct Tangent {
    n_coordinates: usize,
    /// Where the model file's own states stand in x: they are independent of all that is closed.
    states: Vec<usize>,
    rates: Vec<Rate>,
    /// Indices of the rates whose coordinates are independent: N is one there.
    independent: Vec<usize>,
    /// N above W, column by column.
    columns: Vec<Vec<f64>>,
    /// Indices of the independent rates: R is one there and W zero.
    independent_rates: Vec<usize>,
    /// R, column by column.
    columns_of_rates: Vec<Vec<f64>>,
}

/// What is changed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Changed {
    Coordinates,
    Rates,
}

impl Tangent {
    /// The columns are what closing leaves of a change along each rate, as far as they are independent.
    fn of<M, D>(mechanism: &M, duals: &D, x: &[M::Scalar], linear: &Linear) -> Self
    where
        M: JointSpace<Scalar: Real>,
        D: Closing<Scalar = Dual<M::Scalar, COLUMNS>>,
    {
        let layout = mechanism.joint_layout();
        let rates = Rate::all(mechanism, &linear.state);
        let n_coordinates = layout.n_coordinates();
        let is_state = |&at: &usize| {
            let element = linear.elements.get(at);
            matches!(element, Some(Element::Position { place: JointPlace::State { .. }, .. }))
        };
        let states = (0..n_coordinates).filter(is_state).collect();
        let (independent, columns, independent_rates, columns_of_rates) = Default::default();
        let mut tangent =
            Self { n_coordinates, states, rates, independent, columns, independent_rates, columns_of_rates };
        let [columns, of_rates] = [Changed::Coordinates, Changed::Rates].map(|changed| {
            let changes = tangent.closed(duals, linear.t, x, changed).into_iter().zip(&tangent.rates);
            let columns = changes.map(|(change, rate)| {
                let rates = change[n_coordinates..].iter().take(tangent.rates.len()).copied();
                let positions =
                    if changed == Changed::Coordinates { tangent.along_rates(&change) } else { Vec::new() };
                positions.into_iter().chain(rates).map(|part| part * rate.unit).collect::<Vec<_>>()
            });
            eliminate(columns.collect(), &tangent.rates)
        });
        (tangent.independent, tangent.columns) = columns;
        (tangent.independent_rates, tangent.columns_of_rates) = of_rates;
        for column in &mut tangent.columns {
            let following = &mut column[tangent.rates.len()..];
            for (&row, motion) in tangent.independent_rates.iter().zip(&tangent.columns_of_rates) {
                let share = following[row];
                subtract(following, share, motion);
            }
        }
        tangent
    }

    /// The change of the closed state as each coordinate, or each rate, changes.
    fn closed<T: Real, D>(&self, duals: &D, t: f64, x: &[T], changed: Changed) -> Vec<Vec<f64>>
    where
        D: Closing<Scalar = Dual<T, COLUMNS>>,
    {
        let mut changes = Vec::new();
        let places: Vec<usize> = (0..self.rates.len()).collect();
        for rates in places.chunks(COLUMNS) {
            let slopes = |k: usize| {
                let of = |&rate: &usize| {
                    T::constant(match changed {
                        Changed::Coordinates => self.rates[rate].derivative.get(k).copied().unwrap_or(0.0),
                        Changed::Rates => f64::from(u8::from(k == self.n_coordinates + rate)),
                    })
                };
                core::array::from_fn(|column| rates.get(column).map_or(T::constant(0.0), of))
            };
            let mut state: Vec<_> =
                x.iter().enumerate().map(|(k, &value)| Dual { value, slopes: slopes(k) }).collect();
            duals.close(Dual::constant(t), &mut state);
            let column =
                |column: usize| state.iter().map(|number| number.slopes[column].to_f64()).collect::<Vec<_>>();
            changes.extend((0..rates.len()).map(column));
        }
        changes
    }

    /// A change of x in terms of rates.
    fn along_rates(&self, change: &[f64]) -> Vec<f64> {
        let along = |rate: &Rate| dot(&rate.derivative, change) / dot(&rate.derivative, &rate.derivative);
        self.rates.iter().map(along).collect()
    }

    /// The changes of (x, u) as each independent coordinate, each independent rate and each state changes.
    fn directions(&self) -> Vec<Vec<f64>> {
        let n_rates = self.rates.len();
        let mut directions = Vec::new();
        for column in &self.columns {
            let (free, following) = column.split_at(n_rates);
            let mut direction = vec![0.0; self.n_coordinates];
            for (rate, part) in self.rates.iter().zip(free) {
                direction
                    .iter_mut()
                    .zip(&rate.derivative)
                    .for_each(|(sum, derivative)| *sum += derivative * part);
            }
            directions.push([&direction, following].concat());
        }
        let at_rest = vec![0.0; self.n_coordinates];
        directions.extend(self.columns_of_rates.iter().map(|column| [&at_rest, &column[..]].concat()));
        directions.extend(self.states.iter().map(|&at| {
            let mut direction = vec![0.0; self.n_coordinates + n_rates];
            direction[at] = 1.0;
            direction
        }));
        directions
    }

    /// What a change of (x, u) is in independent coordinates, rates and states.
    fn kept(&self, change: &[f64]) -> Vec<f64> {
        let (positions, rates) = (self.along_rates(change), &change[self.n_coordinates..]);
        let positions: Vec<_> = self.independent.iter().map(|&k| positions[k]).collect();
        let rates: Vec<_> = self.independent_rates.iter().map(|&k| rates[k]).collect();
        let states = self.states.iter().map(|&at| change[at]).collect();
        [positions, rates, states].concat()
    }
}

/// The columns are those of a projector. What is left of them once they are combined is below this; of a pivot it is
/// of the order of one by the number of rates.
const NOTHING: f64 = 1e-4;

/// Chooses as many of the upper rows as are independent and combines the columns until they are one there: Gauss and
/// Jordan with the largest pivot of all (Golub and Van Loan, *Matrix Computations*, section 3.4.8).
fn eliminate(mut columns: Vec<Vec<f64>>, rates: &[Rate]) -> (Vec<usize>, Vec<Vec<f64>>) {
    let mut chosen: Vec<(usize, Vec<f64>)> = Vec::new();
    loop {
        let free = |row: &usize| chosen.iter().all(|(other, _)| other != row);
        let elements = columns.iter().enumerate().flat_map(|(column, values)| {
            (0..rates.len()).map(move |row| (row, column, (values[row] / rates[row].unit).abs()))
        });
        let elements = elements.filter(|(row, ..)| free(row));
        let largest = elements.max_by(|a, b| a.2.total_cmp(&b.2)).filter(|(.., pivot)| *pivot > NOTHING);
        let Some((row, column, _)) = largest else { break };
        let mut pivot = columns.swap_remove(column);
        let scale = 1.0 / pivot[row];
        pivot.iter_mut().for_each(|value| *value *= scale);
        for other in columns.iter_mut().chain(chosen.iter_mut().map(|(_, column)| column)) {
            let share = other[row];
            subtract(other, share, &pivot);
        }
        chosen.push((row, pivot));
    }
    chosen.sort_by_key(|(row, _)| *row);
    chosen.into_iter().unzip()
}

fn subtract(from: &mut [f64], share: f64, what: &[f64]) {
    from.iter_mut().zip(what).for_each(|(from, what)| *from -= share * what);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests;
