//! The classical fourth-order Runge–Kutta method (Kutta 1901; Hairer, Nørsett and Wanner, *Solving ODEs I*, table
//! II.1.2).

use crate::contract::Storage;
use crate::{Ode, Scalar, System};

/// Work space of the method for states of type `S`.
#[derive(Clone, Debug)]
pub struct Rk4<S> {
    slope: S,
    stage: S,
    sum: S,
}

impl<S: Clone> Rk4<S> {
    /// Work space for states like this one.
    pub fn new(state: &S) -> Self {
        Self { slope: state.clone(), stage: state.clone(), sum: state.clone() }
    }

    /// Advances `y` from `t` to `t + h`.
    pub fn step<D, M>(&mut self, dynamics: &D, model: &M, t: D::Scalar, h: D::Scalar, y: &mut S)
    where
        D: Ode<M, State = S>,
        S: Storage<D::Scalar>,
    {
        let system = System { dynamics, model };
        let half = h * D::Scalar::constant(0.5);
        let (sixth, third) = (h / D::Scalar::constant(6.0), h / D::Scalar::constant(3.0));
        system.derivative(t, y, &mut self.slope);
        self.begin(y, sixth, half);
        system.derivative(t + half, &self.stage, &mut self.slope);
        self.go_on(y, third, half);
        system.derivative(t + half, &self.stage, &mut self.slope);
        self.go_on(y, third, h);
        system.derivative(t + h, &self.stage, &mut self.slope);
        for ((y, sum), slope) in y.as_mut().iter_mut().zip(self.sum.as_ref()).zip(self.slope.as_ref()) {
            *y = D::Scalar::fused(sixth, *slope, *sum);
        }
        system.normalise(y);
    }

    /// Begins the sum with the slope at `y` and its weight, and goes along it to the first stage.
    #[inline]
    fn begin<T: Scalar>(&mut self, y: &S, weight: T, step: T)
    where
        S: Storage<T>,
    {
        let results = self.sum.as_mut().iter_mut().zip(self.stage.as_mut());
        for (((sum, stage), slope), y) in results.zip(self.slope.as_ref()).zip(y.as_ref()) {
            *sum = T::fused(weight, *slope, *y);
            *stage = T::fused(step, *slope, *y);
        }
    }

    /// Adds the slope to the sum with its weight, and goes on from `y` along it to the next stage, in one pass over
    /// memory.
    #[inline]
    fn go_on<T: Scalar>(&mut self, y: &S, weight: T, step: T)
    where
        S: Storage<T>,
    {
        let results = self.sum.as_mut().iter_mut().zip(self.stage.as_mut());
        for (((sum, stage), slope), y) in results.zip(self.slope.as_ref()).zip(y.as_ref()) {
            *sum = T::fused(weight, *slope, *sum);
            *stage = T::fused(step, *slope, *y);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ẏ = (y₁, −y₀): a circle.
    struct Oscillator;

    impl Ode for Oscillator {
        type Scalar = f64;
        type State = [f64; 2];
        fn derivative(&self, _: &(), _: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
            *dy = [y[1], -y[0]];
        }
    }

    fn error_at_one(steps: u32) -> f64 {
        let mut y = [1.0, 0.0];
        let mut rk4 = Rk4::new(&y);
        let h = 1.0 / f64::from(steps);
        for step in 0..steps {
            rk4.step(&Oscillator, &(), f64::from(step) * h, h, &mut y);
        }
        (y[0] - libm::cos(1.0)).abs().max((y[1] + libm::sin(1.0)).abs())
    }

    #[test]
    fn halving_the_step_divides_the_error_by_sixteen() {
        let ratio = error_at_one(50) / error_at_one(100);
        assert!((ratio - 16.0).abs() < 0.5, "{ratio}");
    }
}
