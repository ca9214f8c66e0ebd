//! Where bodies are along a path, and how fast they move.

use super::Evaluation;
use super::attitude::Euler;
use super::jet::Jet;
use super::linear::{Matrix, Vector};
use crate::field::Field;
use std::array::from_fn;

/// What changes, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// Nothing.
    Rest,
    /// One of (r, p) of a moving_body, at unit rate.
    Coordinate { moving_body: usize, k: usize },
    /// One of (r, π') of a moving_body, at unit rate: `ṗ = ½ Gᵀ π̇'`, so that `Φ_π' = ½ Φ_p Gᵀ`.
    Virtual { moving_body: usize, k: usize },
    /// Time, while bodies with coordinates rest.
    Time,
    /// Time and all bodies, at constant s and w'.
    Motion,
}

/// Position and orientation.
#[derive(Clone, Debug)]
pub struct Pose<F> {
    pub r: Vector<F>,
    pub p: Euler<F>,
    /// A(p).
    pub a: Matrix<F>,
}

/// A pose with velocities: s in the global frame, w' in the body's own.
#[derive(Clone, Debug)]
pub struct Moving<F> {
    pub pose: Pose<F>,
    pub s: Vector<F>,
    pub w: Vector<F>,
}

/// Accelerations `(s̈, ẇ')` of a body.
#[derive(Clone, Debug)]
pub struct Acceleration<F> {
    pub s: Vector<F>,
    pub w: Vector<F>,
}

impl Path {
    fn moves_time(self) -> bool {
        matches!(self, Self::Time | Self::Motion)
    }
}

impl<F: Field> Pose<F> {
    pub fn frozen(&self) -> Self {
        let vector = |v: &Vector<F>| Vector(v.0.each_ref().map(Jet::frozen));
        Self {
            r: vector(&self.r),
            p: self.p.each_ref().map(Jet::frozen),
            a: Matrix(self.a.0.each_ref().map(|row| row.each_ref().map(Jet::frozen))),
        }
    }

    /// A point given in the body's frame, in the global one: `r + A s'`.
    pub fn point(&self, s: &Vector<F>) -> Vector<F> {
        self.a.apply(s) + &self.r
    }
}

impl<F: Field> Moving<F> {
    /// Velocity of a point given in the body's frame: `s + A (w' × s')`.
    pub fn velocity(&self, point: &Vector<F>) -> Vector<F> {
        self.pose.a.apply(&self.w.cross(point)) + &self.s
    }

    /// Angular velocity in the global frame.
    pub fn omega(&self) -> Vector<F> {
        self.pose.a.apply(&self.w)
    }
}

impl<F: Field> Evaluation<'_, F> {
    /// Time along a path.
    pub(super) fn time(&self, path: Path) -> Jet<F> {
        let t = self.scope.point.t.clone();
        if path.moves_time() { Jet::moving(t, self.scope.one.value.clone()) } else { Jet::constant(t) }
    }

    /// Poses of all bodies of the model along a path.
    pub(super) fn poses(&self, path: Path) -> Vec<Pose<F>> {
        (0..self.textbook.model.bodies.len()).map(|body| self.pose(body, path)).collect()
    }

    pub(super) fn pose(&self, body: usize, path: Path) -> Pose<F> {
        match (self.textbook.moving_body_of(body), &self.prescribed[body]) {
            (Some(moving_body), _) => self.pose_of_slot(moving_body, path),
            (None, Some(pose)) if path.moves_time() => pose.clone(),
            (None, Some(pose)) => pose.frozen(),
            (None, None) => unreachable!("a body without coordinates has a prescribed pose"),
        }
    }

    fn pose_of_slot(&self, moving_body: usize, path: Path) -> Pose<F> {
        let values = self.scope.point.position(moving_body);
        let mut r = Vector(from_fn(|k| Jet::constant(values[k].clone())));
        let mut p: Euler<F> = from_fn(|k| Jet::constant(values[3 + k].clone()));
        let one = self.scope.one.value.clone();
        match path {
            Path::Coordinate { moving_body: moved, k } if moved == moving_body => {
                if k < 3 {
                    r.0[k].rate = Some(one)
                } else {
                    p[k - 3].rate = Some(one)
                }
            }
            Path::Virtual { moving_body: moved, k } if moved == moving_body => {
                if k < 3 {
                    r.0[k].rate = Some(one);
                } else {
                    let mut turn = self.scope.no_vector();
                    turn.0[k - 3] = self.scope.one.clone();
                    p = self.turning(&p, &turn);
                }
            }
            Path::Motion => {
                let (s, w) = self.velocities_of_slot(moving_body);
                r = Vector(from_fn(|k| Jet::moving(r.0[k].value.clone(), s.0[k].value.clone())));
                p = self.turning(&p, &w);
            }
            _ => {}
        }
        Pose { a: self.scope.rotation(&p), r, p }
    }

    /// p on its way at w', which may change: `ṗ = ½ G(p)ᵀ w'`, and so `p̈ = ½ G(ṗ)ᵀ w' + ½ G(p)ᵀ ẇ'` as G is linear.
    pub(super) fn turning(&self, p: &Euler<F>, w: &Vector<F>) -> Euler<F> {
        let rate = self.scope.euler_rate(p, w);
        let second = self.scope.euler_rate(&rate, w);
        from_fn(|k| Jet {
            value: p[k].value.clone(),
            rate: Some(rate[k].value.clone()),
            second: Some(match &rate[k].rate {
                Some(turned) => second[k].value.add(turned),
                None => second[k].value.clone(),
            }),
        })
    }

    /// The formulas of all bodies on their way, at accelerations `(s̈, ẇ')` of those with coordinates.
    pub(super) fn on_its_way(&self, given: &[F]) -> Self {
        let with_rate = |v: &Vector<F>, rate: &Vector<F>| {
            Vector(from_fn(|k| Jet::moving(v.0[k].value.clone(), rate.0[k].value.clone())))
        };
        let one = |(body, Moving { pose, s, w }): (usize, &Moving<F>)| {
            let acceleration = self.acceleration(body, given);
            let (s, w) = (with_rate(s, &acceleration.s), with_rate(w, &acceleration.w));
            Moving { pose: self.moved(pose, &s, &w), s, w }
        };
        let moving: Vec<_> = self.moving.iter().enumerate().map(one).collect();
        let still = moving.iter().map(|moving| moving.pose.clone()).collect();
        Self { moving, still, ..self.clone() }
    }

    /// (s, w') of the body in a moving_body.
    pub(super) fn velocities_of_slot(&self, moving_body: usize) -> (Vector<F>, Vector<F>) {
        let values = self.scope.point.velocity(self.textbook.model, moving_body);
        let part = |from: usize| Vector(from_fn(|k| Jet::constant(values[from + k].clone())));
        (part(0), part(3))
    }

    /// Pose and velocities of a body; of one without coordinates by `s = ṙ` and `w̃' = Aᵀ Ȧ`.
    pub(super) fn moving(&self, body: usize) -> Moving<F> {
        let pose = self.pose(body, Path::Time);
        let (s, w) = match self.textbook.moving_body_of(body) {
            Some(moving_body) => self.velocities_of_slot(moving_body),
            None => (self.rate(&pose.r), self.turning_rate(&pose)),
        };
        let frozen = |v: Vector<F>| Vector(v.0.map(|x| x.frozen()));
        Moving { pose: pose.frozen(), s: frozen(s), w: frozen(w) }
    }

    /// Accelerations of a body: given ones of a body with coordinates, `(s̈, ẇ')` moving_body after moving_body.
    pub(super) fn acceleration(&self, body: usize, given: &[F]) -> Acceleration<F> {
        let zero = &self.scope.zero.value;
        let rate_of = |v: Vector<F>| Vector(v.0.map(|x| x.derivative(zero).frozen()));
        if let Some(moving_body) = self.textbook.moving_body_of(body) {
            let part =
                |from: usize| Vector(from_fn(|k| Jet::constant(given[6 * moving_body + from + k].clone())));
            return Acceleration { s: part(0), w: part(3) };
        }
        let pose = self.pose(body, Path::Time);
        Acceleration { s: rate_of(self.rate(&pose.r)), w: rate_of(self.turning_rate(&pose)) }
    }

    fn rate(&self, vector: &Vector<F>) -> Vector<F> {
        Vector(vector.0.each_ref().map(|x| x.derivative(&self.scope.zero.value)))
    }

    /// w' with its derivative.
    fn turning_rate(&self, pose: &Pose<F>) -> Vector<F> {
        let a_dot = Matrix(pose.a.0.each_ref().map(|row| self.rate(&Vector(row.clone())).0));
        pose.a.transposed().product(&a_dot).axial()
    }
}
