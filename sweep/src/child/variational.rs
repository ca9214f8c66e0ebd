//! The variational equations: the joint form `ẋ = f(t, x, p)` and, with it, `Ṡ = ∂f/∂x S + ∂f/∂p` of the derivatives
//! `S = ∂x/∂p`. Their state is x and then the columns of S; a solver controls the error of all of it.

use gyro_runner::motion::COLUMNS;
use gyro_sim::{Clearance, CloseLoops, Correction, Dual, Error, Joint, JointSpace, Ode};
use std::rc::Rc;

/// A number with its derivatives in some directions.
pub(super) type Number = Dual<f64, COLUMNS>;

/// The mechanism in dual numbers for some directions, with a joint state for its length.
#[derive(Clone, Debug)]
pub(super) struct Part<D: JointSpace> {
    pub(super) mechanism: D,
    joints: D::Joints,
}

impl<D: JointSpace<Scalar = Number>> Part<D> {
    pub(super) fn new(mechanism: D) -> Self {
        Self { joints: mechanism.joint_start(), mechanism }
    }

    /// How many numbers x has.
    fn n(&self) -> usize {
        self.joints.as_ref().len()
    }

    /// x with the columns of S from the k-th group of directions.
    pub(super) fn joints(&self, k: usize, state: &[f64]) -> D::Joints {
        let (n, mut x) = (self.n(), self.joints.clone());
        for (i, number) in x.as_mut().iter_mut().enumerate() {
            let slope = |column| state.get((1 + k * COLUMNS + column) * n + i).copied().unwrap_or(0.0);
            *number = Dual { value: state[i], slopes: core::array::from_fn(slope) };
        }
        x
    }

    /// Writes these columns.
    pub(super) fn write_slopes(&self, k: usize, x: &D::Joints, state: &mut [f64]) {
        let n = self.n();
        for (i, number) in x.as_ref().iter().enumerate() {
            for (column, slope) in number.slopes.iter().enumerate() {
                if let Some(element) = state.get_mut((1 + k * COLUMNS + column) * n + i) {
                    *element = *slope;
                }
            }
        }
    }
}

/// A part for each group of directions.
pub(super) type Parts<D> = Rc<Vec<Part<D>>>;

/// The equations.
#[derive(Clone, Debug)]
pub(super) struct Variational<D: JointSpace>(pub(super) Parts<D>);

impl<M: JointSpace<Scalar = f64>, D: JointSpace<Scalar = Number>> Ode<M> for Variational<D> {
    type Scalar = f64;
    type State = Vec<f64>;

    fn derivative(&self, _: &M, t: f64, y: &Vec<f64>, dy: &mut Vec<f64>) {
        for (k, part) in self.0.iter().enumerate() {
            let mut slope = part.joints.clone();
            part.mechanism.joint_derivative(Dual::new(t), &part.joints(k, y), &mut slope);
            if k == 0 {
                dy.iter_mut().zip(slope.as_ref()).for_each(|(to, from)| *to = from.value);
            }
            part.write_slopes(k, &slope, dy);
        }
    }

    fn normalise(&self, mechanism: &M, y: &mut Vec<f64>) {
        for (k, part) in self.0.iter().enumerate() {
            let mut x = part.joints(k, y);
            part.mechanism.joint_layout().normalise(x.as_mut());
            part.write_slopes(k, &x, y);
        }
        let layout = mechanism.joint_layout();
        layout.normalise(&mut y[..layout.n_coordinates()]);
    }
}

/// Closes loops: x as in runs without derivatives, and S by the derivative of a step of Newton's method there, which is
/// what keeps the rows closed as p changes.
#[derive(Clone, Debug)]
pub(super) struct Closing<M: JointSpace, D: JointSpace> {
    loops: CloseLoops<M>,
    parts: Parts<D>,
    x: M::Joints,
}

impl<M: JointSpace<Scalar = f64>, D: JointSpace<Scalar = Number>> Closing<M, D> {
    pub(super) fn new(mechanism: &M, parts: Parts<D>) -> Self {
        Self { loops: CloseLoops::new(mechanism), parts, x: mechanism.joint_start() }
    }

    fn x(&self, y: &[f64]) -> M::Joints {
        let mut x = self.x.clone();
        x.as_mut().iter_mut().zip(y).for_each(|(to, from)| *to = *from);
        x
    }
}

impl<M, D> Correction<Variational<D>, M> for Closing<M, D>
where
    M: JointSpace<Scalar = f64>,
    D: JointSpace<Scalar = Number>,
{
    fn correct(&mut self, mechanism: &M, t: f64, y: &mut Vec<f64>) -> Result<(), Error> {
        if mechanism.joint_layout().closure_rows.is_empty() {
            return Ok(());
        }
        let mut x = self.x(y);
        self.loops.correct(mechanism, t, &mut x)?;
        y[..x.as_ref().len()].copy_from_slice(x.as_ref());
        for (k, part) in self.parts.iter().enumerate() {
            let mut x = part.joints(k, y);
            part.mechanism.close_positions(Dual::new(t), &mut x);
            part.mechanism.close_velocities(Dual::new(t), &mut x);
            part.write_slopes(k, &x, y);
        }
        Ok(())
    }

    fn violation(&mut self, mechanism: &M, t: f64, y: &Vec<f64>) -> f64 {
        let x = self.x(y);
        Correction::<Joint, M>::violation(&mut self.loops, mechanism, t, &x)
    }

    fn clearance(&self, mechanism: &M, t: f64, y: &Vec<f64>) -> Option<Clearance<f64>> {
        self.loops.clearance(mechanism, t, &self.x(y))
    }
}
