//! Single loops of revolute joints that move although 6 − n of their freedoms should be missing, with random
//! dimensions.
//!
//! A loop is given as Denavit and Hartenberg have it: from joint to joint a length a and a twist α along the common
//! normal, and along each axis an offset R. Conditions on these are J. E. Baker's and those of Y. Chen and Z. You
//! (*Motion structures*, 2012). Poses are found by Newton's iteration on the closure, whole and by least squares,
//! which knows nothing of rows, trees or redundancy.

pub mod whole_numbers;

use chacha20::ChaCha8Rng;
use nalgebra::{DMatrix, DVector, Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use rand::RngExt;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

/// From one joint's axis to the next one's.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// Along the common normal, m.
    pub length: f64,
    /// About the common normal, rad.
    pub twist: f64,
    /// Of the normals along the axis before it, m.
    pub offset: f64,
}

/// A closed loop.
#[derive(Clone, Debug)]
pub struct Loop {
    /// Its kind.
    pub name: &'static str,
    /// Link after link, the first fixed.
    pub links: Vec<Link>,
}

/// An axis in space.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// A point on it.
    pub point: Vector3<f64>,
    /// Of length one.
    pub direction: Vector3<f64>,
}

/// The kinds of loops.
pub const KINDS: [&str; 10] = [
    "bennett",
    "goldberg-5r",
    "myard",
    "line-symmetric",
    "plane-symmetric",
    "trihedral",
    "octahedral-line",
    "sarrus",
    "planar",
    "spherical",
];

fn link(length: f64, twist: f64) -> Link {
    Link { length, twist, offset: 0.0 }
}

impl Loop {
    /// One of a kind.
    pub fn random(name: &'static str, dice: &mut ChaCha8Rng) -> Self {
        let mut between = |low: f64, high: f64| dice.random_range(low..high);
        let links = match name {
            "bennett" | "goldberg-5r" => {
                let (a, alpha) = (between(0.3, 0.6), between(0.4, 0.8));
                let mut other = || {
                    let beta = between(1.0, 1.5);
                    link(a * beta.sin() / alpha.sin(), beta)
                };
                let (first, b, c) = (link(a, alpha), other(), other());
                let sum = |links: &[Link]| {
                    link(links.iter().map(|l| l.length).sum(), links.iter().map(|l| l.twist).sum())
                };
                match name {
                    "bennett" => vec![first, b, first, b],
                    // Two of Bennett's, of which one link is shared and left out.
                    _ => vec![first, sum(&[b, c]), first, c, b],
                }
            }
            "myard" => {
                let (b, alpha) = (between(0.6, 1.2), between(0.4, 1.0));
                let a = b * alpha.sin();
                vec![
                    link(a, alpha),
                    link(b, FRAC_PI_2),
                    link(0.0, PI - 2.0 * alpha),
                    link(b, FRAC_PI_2),
                    link(a, PI - alpha),
                ]
            }
            "line-symmetric" => {
                let half: Vec<_> = (0..3)
                    .map(|_| Link {
                        length: between(0.4, 1.0),
                        twist: between(0.5, 1.5),
                        offset: between(-0.3, 0.3),
                    })
                    .collect();
                [half.clone(), half].concat()
            }
            "plane-symmetric" => {
                let [a, b, c] = [0; 3].map(|_| between(0.4, 1.0));
                let [x, y, z] = [0; 3].map(|_| between(0.5, 1.4));
                vec![link(a, x), link(b, y), link(c, z), link(c, -z), link(b, -y), link(a, -x)]
            }
            "trihedral" => {
                let [a, c, e] = [0; 3].map(|_| between(0.8, 1.0));
                let [b, d] = [0; 2].map(|_| between(0.6, 0.8));
                let f = (a * a + c * c + e * e - b * b - d * d).sqrt();
                let (right, left) = (FRAC_PI_2, -FRAC_PI_2);
                vec![
                    link(a, right),
                    link(b, left),
                    link(c, right),
                    link(d, left),
                    link(e, right),
                    link(f, left),
                ]
            }
            "octahedral-line" => {
                let [r, s, t] = [0; 3].map(|_| between(0.4, 1.0));
                let [x, y, z] = [0; 3].map(|_| between(0.7, 1.4));
                let of = |twist, offset| Link { length: 0.0, twist, offset };
                vec![of(x, r), of(y, s), of(z, t), of(x, -r), of(y, -s), of(z, -t)]
            }
            "planar" => {
                let [a, b, c] = [0.3, between(0.9, 1.2), between(0.8, 1.1)];
                vec![link(1.0, 0.0), link(a, 0.0), link(b, 0.0), link(c, 0.0)]
            }
            "spherical" => {
                let twists = [1.2, between(0.3, 0.5), between(1.1, 1.4), between(1.0, 1.3)];
                twists.map(|twist| link(0.0, twist)).to_vec()
            }
            "sarrus" => Vec::new(),
            other => unreachable!("{other} is no kind"),
        };
        Self { name, links }
    }

    /// The axes where the joints have these angles, and what the way around is off by.
    fn around(&self, angles: &[f64]) -> (Vec<Axis>, Vec<f64>) {
        let (mut at, mut turned) = (Vector3::zeros(), Matrix3::identity());
        let mut axes = Vec::new();
        for (link, &angle) in self.links.iter().zip(angles) {
            let direction = turned.column(2).into_owned();
            axes.push(Axis { point: at, direction });
            at += direction * link.offset;
            turned *= Rotation3::from_axis_angle(&Vector3::z_axis(), angle).into_inner();
            at += turned.column(0) * link.length;
            turned *= Rotation3::from_axis_angle(&Vector3::x_axis(), link.twist).into_inner();
        }
        let off = turned - Matrix3::identity();
        (axes, at.iter().chain(off.iter()).copied().collect())
    }

    /// The screws of the joints, whose dependencies are the motions.
    pub fn screws(axes: &[Axis]) -> DMatrix<f64> {
        let columns: Vec<_> = axes
            .iter()
            .map(|axis| {
                let moment = axis.point.cross(&axis.direction);
                DVector::from_iterator(6, axis.direction.iter().chain(moment.iter()).copied())
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// A pose that is clear of singular ones, if one is found: the axes of the joints.
    pub fn pose(&self, dice: &mut ChaCha8Rng) -> Option<Vec<Axis>> {
        if self.name == "sarrus" {
            return Some(lift(dice));
        }
        (0..60).find_map(|_| {
            let mut angles: Vec<f64> = self.links.iter().map(|_| dice.random_range(-PI..PI)).collect();
            for step in 0..40 {
                if step == 12 && self.around(&angles).1.iter().any(|x| x.abs() > 0.01) {
                    return None;
                }
                let step = self.newton(&angles)?;
                angles.iter_mut().zip(step.iter()).for_each(|(angle, step)| *angle -= step);
            }
            let (axes, off) = self.around(&angles);
            let values = Self::screws(&axes).singular_values();
            let n = values.len();
            let is_closed = off.iter().all(|x| x.abs() < 2e-15);
            (is_closed && values[n - 1] < 1e-8 && values[n - 2] > 0.08).then_some(axes)
        })
    }

    fn newton(&self, angles: &[f64]) -> Option<DVector<f64>> {
        let (_, off) = self.around(angles);
        let columns: Vec<_> = (0..angles.len())
            .map(|k| {
                let mut moved = [angles.to_vec(), angles.to_vec()];
                moved[0][k] += 1e-6;
                moved[1][k] -= 1e-6;
                let [plus, minus] = moved.map(|angles| DVector::from_vec(self.around(&angles).1));
                (plus - minus) / 2e-6
            })
            .collect();
        DMatrix::from_columns(&columns).svd(true, true).solve(&DVector::from_vec(off), 1e-6).ok()
    }
}

/// Sarrus's: a plate on two legs, each of three parallel hinges, moves up and down.
fn lift(dice: &mut ChaCha8Rng) -> Vec<Axis> {
    let mut between = |low: f64, high: f64| dice.random_range(low..high);
    let height = between(0.6, 1.0);
    let mut leg = |heading: f64| {
        let (out, bend, middle) = (between(0.6, 1.0), between(0.2, 0.5), between(0.3, 0.7));
        let direction = Vector3::new(-heading.sin(), heading.cos(), 0.0);
        [(out, 0.0), (out + bend, middle * height), (out, height)].map(|(out, up)| Axis {
            point: Vector3::new(out * heading.cos(), out * heading.sin(), up),
            direction,
        })
    };
    let (up, mut down) = (leg(0.3), leg(1.9));
    down.reverse();
    [up, down].concat()
}

/// A loop where it starts: bodies that are turned as space is, and the joints on them.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The axes, in space.
    axes: Vec<Axis>,
    /// Where the bodies are, the ground first.
    centres: Vec<Vector3<f64>>,
}

/// A body's place and Euler parameters.
pub type Pose = [f64; 7];

impl Placed {
    /// Tilted in space. Body k goes from joint k − 1 to joint k.
    pub fn new(axes: &[Axis]) -> Self {
        let tilt = Rotation3::from_euler_angles(0.4, -0.7, 0.3);
        let tilted = |axis: &Axis| Axis { point: tilt * axis.point, direction: tilt * axis.direction };
        let axes: Vec<Axis> = axes.iter().map(tilted).collect();
        let centres = (0..axes.len()).map(|body| match body {
            0 => Vector3::zeros(),
            _ => (axes[body - 1].point + axes[body].point) / 2.0,
        });
        Self { centres: centres.collect(), axes }
    }

    /// The bodies of a joint.
    fn bodies(&self, joint: usize) -> [usize; 2] {
        [joint, (joint + 1) % self.axes.len()]
    }

    /// The model file, the first joint turning at a rate.
    pub fn page(&self, rate: f64, gravity: f64) -> String {
        let mut page = format!(
            "format = 1\nname = \"linkage\"\ngravity = [0, 0, {gravity:?}]\n[simulation]\nt_end = 1\nstep = 1e-3\n\
             [[body]]\nname = \"b0\"\nfixed = true\n"
        );
        for body in 1..self.axes.len() {
            let mass = 1.0 + 0.3 * body as f64;
            let [x, y, z] = [0.05, 0.06, 0.07].map(|square| square * mass);
            let _ = write!(
                page,
                "[[body]]\nname = \"b{body}\"\nmass = {mass:?}\ninertia = [{x:?}, {y:?}, {z:?}]\n"
            );
        }
        let list = |v: Vector3<f64>| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
        for (joint, axis) in self.axes.iter().enumerate() {
            let _ = write!(page, "[[joint]]\nname = \"j{joint}\"\nkind = \"revolute\"\n");
            let other = if axis.direction.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
            let across = list(axis.direction.cross(&other).normalize());
            for (end, body) in ["first", "second"].into_iter().zip(self.bodies(joint)) {
                let (point, direction) = (list(axis.point - self.centres[body]), list(axis.direction));
                let _ = writeln!(
                    page,
                    "{end} = {{ body = \"b{body}\", point = {point}, axis = {direction}, zero = {across} }}"
                );
            }
            match joint {
                0 => drop(writeln!(page, "angle = 0\nrate = {rate:?}")),
                joint if joint + 1 < self.axes.len() => page.push_str("angle = 0\nrough = true\n"),
                _ => {}
            }
        }
        page
    }

    /// By how much the two sides of each joint are apart, m or rad, at poses of the bodies with coordinates; and
    /// the axes there.
    pub fn apart(&self, poses: &[Pose]) -> (f64, Vec<Axis>) {
        let seen = |joint: usize, body: usize| {
            let (point, direction) =
                (self.axes[joint].point - self.centres[body], self.axes[joint].direction);
            let Some([x, y, z, e0, e1, e2, e3]) = body.checked_sub(1).map(|moving| poses[moving]) else {
                return Axis { point, direction };
            };
            let turn = UnitQuaternion::from_quaternion(Quaternion::new(e0, e1, e2, e3));
            Axis { point: Vector3::new(x, y, z) + turn * point, direction: turn * direction }
        };
        let (mut apart, mut axes) = (0.0_f64, Vec::new());
        for joint in 0..self.axes.len() {
            let [one, other] = self.bodies(joint).map(|body| seen(joint, body));
            let gaps = [one.point - other.point, one.direction - other.direction];
            apart = gaps.iter().fold(apart, |apart, gap| apart.max(gap.norm()));
            axes.push(one);
        }
        (apart, axes)
    }
}
