//! Frames that are fixed in bodies, and what acts between two of them.

use crate::{Formula, Number, Seen};

/// A frame that is fixed in a body.
#[derive(Clone, Debug)]
pub struct BodyFrame {
    /// Index of the body.
    pub body: usize,
    /// Its origin in the body's frame, m.
    pub point: [Number; 3],
    /// How it is turned in the body's frame: Euler parameters of any length; `None` where it has the body's axes.
    pub orientation: Option<[Number; 4]>,
}

/// How the second of two frames lies and moves, seen from the first, by the axes of the first.
///
/// With `A_1` and `A_2` the rotation matrices of the frames and d from the origin of the first to that of the second:
/// `x = A_1ᵀ d`; `A_1ᵀ A_2`, of which `xy` is the first frame's x axis times the second's y axis; ẋ; and the angular
/// velocity of the second body less that of the first.
#[derive(Clone, Debug)]
pub struct Relative {
    /// The first frame and the second.
    pub frames: [BodyFrame; 2],
}

impl Relative {
    /// How many of its numbers tell where the second frame is; the others tell how it moves.
    pub const N_PLACES: usize = 12;

    /// Its numbers, with their units.
    pub const COLUMNS: [(&'static str, &'static str); 18] = [
        ("x", "m"),
        ("y", "m"),
        ("z", "m"),
        ("xx", ""),
        ("xy", ""),
        ("xz", ""),
        ("yx", ""),
        ("yy", ""),
        ("yz", ""),
        ("zx", ""),
        ("zy", ""),
        ("zz", ""),
        ("vx", "m/s"),
        ("vy", "m/s"),
        ("vz", "m/s"),
        ("wx", "rad/s"),
        ("wy", "rad/s"),
        ("wz", "rad/s"),
    ];
}

/// What acts between two frames by where the second is, seen from the first.
///
/// With `A_1` and `A_2` the rotation matrices of the frames and d from the origin of the first to that of the second,
/// its six *readings* are the components x, y, z of `A_1ᵀ d` and the Cardan angles of `A_1ᵀ A_2 = R_x(angle_x)
/// R_y(angle_y) R_z(angle_z)`: `angle_y` is between −π/2 and π/2, where the others are not defined, and these are
/// between −π and π.
///
/// Each reading u has the force or torque `−stiffness u − damping u̇ + load`, and together they have the power Σ f u̇
/// on the two bodies. So the force acts on the second body at the origin of the second frame, and its opposite on the
/// first *at the same point of space*. The springs are conservative. A `moment` is a torque by the axes of the first
/// frame, which is defined however the frames are turned: what acts by it alone asks for no angles.
#[derive(Clone, Debug)]
pub struct Bushing {
    /// The first frame.
    pub first: BodyFrame,
    /// The second frame.
    pub second: BodyFrame,
    /// Along the axes of the first frame: N/m, N·s/m and N.
    pub along: BushingLaw,
    /// About the axes of the Cardan angles: N·m/rad, N·m·s/rad and N·m.
    pub about: BushingLaw,
    /// Torque on the second body by the axes of the first frame, N·m; formulas as those of a load.
    pub moment: [Number; 3],
}

/// What a bushing does along three of its readings.
#[derive(Clone, Debug)]
pub struct BushingLaw {
    /// Of the springs.
    pub stiffness: [Number; 3],
    /// Of the dampers.
    pub damping: [Number; 3],
    /// What is added; formulas of it and of the damping may name the readings and their rates.
    pub load: [Number; 3],
}

impl Bushing {
    /// The names of its readings.
    pub const READINGS: [&'static str; 6] = ["x", "y", "z", "angle_x", "angle_y", "angle_z"];

    /// Its frames.
    pub fn ends(&self) -> [&BodyFrame; 2] {
        [&self.first, &self.second]
    }

    /// What it does along its readings, in their order: stiffness, damping and load of each.
    pub fn strengths(&self) -> [[&Number; 3]; 6] {
        let one = |k: usize| {
            let law = if k < 3 { &self.along } else { &self.about };
            [&law.stiffness[k % 3], &law.damping[k % 3], &law.load[k % 3]]
        };
        std::array::from_fn(one)
    }

    /// Whether anything of it acts about the Cardan angles, or asks for one.
    pub fn has_angles(&self) -> bool {
        let sees = |number: &Number| {
            let seen = number.formula().into_iter().flat_map(Formula::sees);
            seen.into_iter().any(|seen| matches!(seen, Seen::Between(3..) | Seen::BetweenRate(3..)))
        };
        let BushingLaw { stiffness, damping, load } = &self.about;
        let is_there = |number: &Number| !number.is_zero();
        let numbers = || self.strengths().into_iter().flatten().chain(&self.moment);
        [stiffness, damping, load].into_iter().flatten().any(is_there) || numbers().any(sees)
    }
}
