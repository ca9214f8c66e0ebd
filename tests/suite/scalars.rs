//! Kernels take any scalar: packs of lanes and dual numbers run the same generated source.

use gyro_mechanisms::gyroscope_parameters::GyroscopeParameters;
use gyro_sim::{Dynamics, Elementary, Mechanism, Scalar};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Two numbers side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Lanes([f64; 2]);

/// A number with its derivative along one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Dual {
    value: f64,
    slope: f64,
}

impl Lanes {
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self([f(self.0[0], other.0[0]), f(self.0[1], other.0[1])])
    }
}

impl Add for Lanes {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Div for Lanes {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

impl Neg for Lanes {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|a| -a))
    }
}

impl Scalar for Lanes {
    fn constant(value: f64) -> Self {
        Self([value; 2])
    }
    fn call(function: Elementary, operands: [Self; 2]) -> Self {
        Self([0, 1].map(|k| f64::call(function, operands.map(|lanes| lanes.0[k]))))
    }
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        let lanes = self.0.map(|t| t.spline(knots, pieces));
        [0, 1, 2].map(|order| Self(lanes.map(|lane| lane[order])))
    }
    fn spline_third(self, knots: &[f64], pieces: &[[f64; 4]]) -> Self {
        Self(self.0.map(|t| t.spline_third(knots, pieces)))
    }
}

fn dual(value: f64, slope: f64) -> Dual {
    Dual { value, slope }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        dual(self.value + other.value, self.slope + other.slope)
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        dual(self.value - other.value, self.slope - other.slope)
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        dual(self.value * other.value, self.slope * other.value + self.value * other.slope)
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        dual(quotient, (self.slope - quotient * other.slope) / other.value)
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        dual(-self.value, -self.slope)
    }
}

impl Scalar for Dual {
    fn constant(value: f64) -> Self {
        dual(value, 0.0)
    }
    fn call(function: Elementary, [x, y]: [Self; 2]) -> Self {
        let value = f64::call(function, [x.value, y.value]);
        match function {
            Elementary::Sqrt => dual(value, x.slope / (2.0 * value)),
            Elementary::Sin => dual(value, x.slope * x.value.cos()),
            Elementary::Cos => dual(value, -x.slope * x.value.sin()),
            Elementary::Tanh => dual(value, x.slope * (1.0 - value * value)),
            Elementary::Atan2 => {
                let turned = y.value * x.slope - x.value * y.slope;
                dual(value, turned / (x.value * x.value + y.value * y.value))
            }
            Elementary::Exp => dual(value, x.slope * value),
            Elementary::Ln => dual(value, x.slope / x.value),
            Elementary::Abs => dual(value, if x.value < 0.0 { -x.slope } else { x.slope }),
            Elementary::Floor => dual(value, 0.0),
            // What is not taken may change infinitely fast.
            Elementary::When | Elementary::Unless => dual(value, f64::call(function, [x.value, y.slope])),
            other => unreachable!("{other:?} is in no scene"),
        }
    }
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        // The third derivative is constant between knots.
        let [value, first, second] = self.value.spline(knots, pieces);
        let third = (self.value + 1e-6).spline(knots, pieces)[2] - second;
        [
            dual(value, first * self.slope),
            dual(first, second * self.slope),
            dual(second, third * 1e6 * self.slope),
        ]
    }
    fn spline_third(self, knots: &[f64], pieces: &[[f64; 4]]) -> Self {
        dual(self.value.spline_third(knots, pieces), 0.0)
    }
}

type Gimbal<T> = GyroscopeParameters<T>;

fn derivative<T: Scalar>(y: &<Gimbal<T> as Mechanism>::State) -> <Gimbal<T> as Mechanism>::State {
    let (mechanism, mut dy) = (Gimbal::<T>::default(), *y);
    mechanism.derivative(T::constant(0.0), y, &mut dy);
    dy
}

/// The start, with every element moved a little, differently for each `seed`.
fn state(seed: f64) -> <Gimbal<f64> as Mechanism>::State {
    let mut y = Gimbal::<f64>::default().start();
    for (k, y) in (0u8..).zip(&mut y) {
        *y += 1e-3 * (seed + f64::from(k)).sin();
    }
    y
}

#[test]
fn lanes_compute_what_scalars_compute_bit_for_bit() {
    let (first, second) = (state(1.0), state(2.0));
    let packed: [Lanes; 39] = std::array::from_fn(|k| Lanes([first[k], second[k]]));
    let expected: [Lanes; 39] = {
        let (first, second) = (derivative(&first), derivative(&second));
        std::array::from_fn(|k| Lanes([first[k], second[k]]))
    };
    assert_eq!(derivative(&packed), expected);
}

/// Central differences with a step of 1e-6: truncation and rounding both stay near 1e-9 of the largest slope.
const DIFFERENCES: f64 = 1e-7;

#[test]
fn dual_numbers_differentiate_a_kernel() {
    let (y, direction, step) = (state(1.0), state(3.0), 1e-6);
    let moved = |h: f64| -> [f64; 39] { std::array::from_fn(|k| y[k] + h * direction[k]) };
    let (after, before) = (derivative(&moved(step)), derivative(&moved(-step)));
    let seeded: [Dual; 39] = std::array::from_fn(|k| dual(y[k], direction[k]));
    let slopes = derivative(&seeded).map(|dual| dual.slope);
    let size = slopes.iter().fold(0.0, |size: f64, slope| size.max(slope.abs()));
    for (k, slope) in slopes.iter().enumerate() {
        let difference = (after[k] - before[k]) / (2.0 * step);
        assert!(
            (slope - difference).abs() <= DIFFERENCES * size,
            "element {k}: {slope} {difference} of {size}"
        );
    }
}
