//! Decisions and numbers.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// Seeded decisions.
#[derive(Clone, Debug)]
pub struct Dice(ChaCha8Rng);

impl Dice {
    /// The decisions of a seed.
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        self.0.random_range(0..n)
    }

    /// Dice of their own for what a third of the model files have, and how many of it: one or two.
    pub fn of_a_third(seed: u64, turn: u32) -> Option<(Self, usize)> {
        let mut dice = Self::new(seed.rotate_left(turn));
        let is_there = dice.once_in(3);
        is_there.then(|| {
            let count = 1 + dice.below(2);
            (dice, count)
        })
    }

    /// Once in so many times.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// One of some.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0.random_range(low..high)
    }

    /// A number about as large as one, positive, as people and programs write such numbers.
    pub fn number(&mut self) -> String {
        match self.below(12) {
            0 | 1 => self.pick(&["0.1", "0.2", "0.3", "0.25", "0.5", "1.5", "0.75", "0.05"]).to_owned(),
            2 => self.pick(&["1", "2", "3", "1.0", "2.50"]).to_owned(),
            3 => self.pick(&["1e0", "5e-1", "2.5E-1", "12e-1", "1_000e-3"]).to_owned(),
            // What a program prints of a quotient, in all its digits or in a few.
            4 | 5 => self.quotient(),
            6 => self.rounded(),
            // Numbers that differ by less than a float can tell.
            7 => self.pick(NEIGHBOURS).to_owned(),
            8 => format!("{:?}", self.between(0.05, 2.0)),
            9 => format!("{:.3}", self.between(0.05, 2.0)),
            10 => format!("{:.7}", self.between(0.05, 2.0)),
            _ => format!("{:.9e}", self.between(0.05, 2.0)),
        }
    }

    fn quotient(&mut self) -> String {
        let (numerator, denominator) = (1 + self.below(12), self.pick(&[3.0, 6.0, 7.0, 9.0, 12.0, 11.0]));
        format!("{:?}", numerator as f64 / denominator)
    }

    /// The same with fewer digits.
    fn rounded(&mut self) -> String {
        let (numerator, denominator) = (1 + self.below(12), self.pick(&[3.0, 6.0, 7.0, 9.0, 12.0]));
        let digits = self.pick(&[3, 5, 8, 15, 16, 18]);
        format!("{:.digits$}", numerator as f64 / denominator)
    }

    /// With either sign, or zero.
    pub fn signed(&mut self) -> String {
        match self.below(8) {
            0 => self.pick(&["0", "0.0", "-0.0", "0e0"]).to_owned(),
            1 => self.pick(&["1e-9", "-1e-9", "1e-6", "-2.5e-4", "6.123233995736766e-17"]).to_owned(),
            2..5 => format!("-{}", self.number()),
            _ => self.number(),
        }
    }

    /// An angle in rad, none of them large.
    pub fn angle(&mut self) -> String {
        let parts = self.pick(&[2.0, 3.0, 4.0, 6.0, 12.0, -2.0, -4.0]);
        match self.below(6) {
            0 => format!("{:?}", PI / parts),
            1 => format!("{:.4}", PI / parts),
            2 => format!("{:.2}", PI / parts),
            3 => format!("{:?}", self.between(-3.0, 3.0)),
            4 => format!("{:.3}", self.between(-6.5, 6.5)),
            _ => self.signed(),
        }
    }

    /// An angle in degrees.
    pub fn degrees(&mut self) -> String {
        match self.below(3) {
            0 => self.pick(&["0", "30", "45", "90", "-90", "180", "-120", "60"]).to_owned(),
            1 => format!("{:.1}", self.between(-200.0, 200.0)),
            _ => format!("{:?}", self.between(-200.0, 200.0)),
        }
    }

    /// Three numbers for a point, mostly with zeros.
    pub fn point(&mut self) -> [String; 3] {
        [(); 3].map(|()| if self.once_in(2) { "0".to_owned() } else { self.signed() })
    }

    /// A direction whose length is a short number, or the root of one.
    pub fn direction(&mut self) -> [String; 3] {
        if self.once_in(12) {
            [(); 3].map(|()| format!("{}", 1 + self.below(5)))
        } else {
            self.pick(AXES).map(str::to_owned)
        }
    }

    /// A direction as programs print them and people measure them.
    pub fn rough_direction(&mut self) -> [String; 3] {
        if self.once_in(2) {
            self.pick(PRINTED).map(str::to_owned)
        } else {
            [(); 3].map(|()| format!("{:.2}", self.between(-1.0, 1.0) + 1.5))
        }
    }
}

const NEIGHBOURS: &[&str] = &[
    "1.00000000000000000001",
    "1",
    "0.99999999999999999999",
    "0.1",
    "0.1000000000000000055511151231257827",
    "0.16666666666666666",
    "0.1666666666666666667",
    "0.08333333333333333",
    "0.083333333333333333333",
];

const AXES: &[[&str; 3]] = &[
    ["1", "0", "0"],
    ["0", "1", "0"],
    ["0", "0", "1"],
    ["0", "0", "-1"],
    ["0", "0", "1"],
    ["1", "0", "0"],
    ["0", "1", "0"],
    ["1", "2", "2"],
    ["0.6", "0", "0.8"],
    ["3", "0", "4"],
    ["1", "1", "0"],
];

/// As programs print them.
const PRINTED: &[[&str; 3]] = &[
    ["6.123233995736766e-17", "0", "1"],
    ["0.7071067811865476", "0.7071067811865475", "0"],
    ["0.8660254037844387", "0", "0.5"],
    ["0.001", "0", "1"],
    ["0.577", "0.577", "0.577"],
    ["0", "1e-9", "-1"],
];

/// The value of a number's text.
pub fn value(text: &str) -> f64 {
    text.replace('_', "").parse().expect("dice write decimals")
}
