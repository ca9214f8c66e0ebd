//! The dynamic side of eq. (17), energies and powers.

use super::Evaluation;
use super::armature::Rotor;
use super::jet::Jet;
use super::linear::{Matrix, Vector};
use super::load::Load;
use super::pose::Moving;
use super::sparse::Sparse;
use crate::field::Field;
use gyro_model::{Attraction, Support};

impl<F: Field> Evaluation<'_, F> {
    /// `diag(M, J')` of eq. (17), (s̈, ẇ') body after body, and `J b bᵀ` of armatures.
    pub fn mass_matrix(&self) -> Sparse<F> {
        let size = 6 * self.textbook.moving_bodies.len();
        let mut matrix = Sparse::new(size, size);
        for (moving_body, &body) in self.textbook.moving_bodies.iter().enumerate() {
            let (mass, inertia) = (self.mass(body), self.inertia(body));
            for row in 0..3 {
                let (of_place, of_turning) = (6 * moving_body + row, 6 * moving_body + 3 + row);
                matrix.rows[of_place].insert(of_place, mass.value.clone());
                for column in 0..3 {
                    matrix.rows[of_turning]
                        .insert(6 * moving_body + 3 + column, inertia.0[row][column].value.clone());
                }
            }
        }
        for rotor in self.rotors() {
            let places = self.places_of(&rotor);
            for (row, left) in &places {
                let scaled = rotor.inertia.value.mul(left);
                for (column, right) in &places {
                    let added = scaled.mul(right);
                    let entry = matrix.rows[*row].entry(*column);
                    entry.and_modify(|x| *x = x.add(&added)).or_insert(added);
                }
            }
        }
        matrix
    }

    /// `(f, n' − w̃'J'w')` body after body, less `J b (ḃ·v)` of armatures; gravity is eq. (21).
    pub fn applied_force(&self) -> Option<Vec<F>> {
        let loads = self.forces()?.loads;
        let mut applied = Vec::new();
        for &body in &self.textbook.moving_bodies {
            let w = &self.moving[body].w;
            let gravity = self.gravity_at(&self.moving[body].pose.r)?;
            let force = gravity.times(&self.mass(body)) + &loads[body].force;
            let torque = loads[body].torque.clone() - w.cross(&self.inertia(body).apply(w));
            applied.extend(force.0.into_iter().chain(torque.0).map(|x| x.value));
        }
        for rotor in self.rotors() {
            let taken = rotor.inertia.value.mul(&rotor.bias);
            for (place, b) in self.places_of(&rotor) {
                applied[place] = applied[place].sub(&taken.mul(&b));
            }
        }
        Some(applied)
    }

    /// `(m g, 0)` body after body, g being that of the body's place. `None` at the centre of a central body.
    pub fn weights(&self) -> Option<Vec<F>> {
        let mut all = Vec::new();
        for &body in &self.textbook.moving_bodies {
            let weight = self.gravity_at(&self.moving[body].pose.r)?.times(&self.mass(body));
            all.extend(
                weight.0.into_iter().chain([(); 3].map(|()| self.scope.zero.clone())).map(|x| x.value),
            );
        }
        Some(all)
    }

    /// Kinetic and potential energy: `½ Σ (m s·s + w'·J'w')` with `½ J (b·v)²` of armatures, `−Σ m g·r`, or
    /// `−Σ m μ/|r|`, and the energy of springs.
    pub fn energy(&self) -> Option<[F; 2]> {
        let (mut twice_kinetic, mut potential) = (self.scope.zero.clone(), self.forces()?.potential);
        for &body in &self.textbook.moving_bodies {
            let (mass, Moving { pose, s, w }) = (self.mass(body), &self.moving[body]);
            twice_kinetic = twice_kinetic + &mass * s.dot(s) + w.dot(&self.inertia(body).apply(w));
            potential = potential + mass * self.potential_at(&pose.r)?;
        }
        for Rotor { inertia, rate, .. } in self.rotors() {
            twice_kinetic = twice_kinetic + inertia * &rate * &rate;
        }
        Some([twice_kinetic * &self.scope.half, potential].map(|energy| energy.value))
    }

    /// Power of non-conservative forces and power of the drivers, from the multipliers of all rows and the
    /// accelerations `(s̈, ẇ')` that go with them.
    ///
    /// Drivers do `−λᵀν`; what moves a driven body does besides what it takes against the forces on that body.
    pub fn power(&self, lambda: &[F], accelerations: &[F]) -> Option<[F; 2]> {
        let nu = self.nu()?;
        let of_rows = lambda.iter().zip(&nu).map(|(lambda, nu)| lambda.mul(nu).neg());
        self.powers(of_rows.fold(self.scope.zero.value.clone(), |sum, x| sum.add(&x)), accelerations)
    }

    /// The same from accelerations `(s̈, ẇ')` that satisfy eq. (17), where the velocities satisfy eq. (18): then
    /// `−λᵀν = −λᵀ(Φ_r s + Φ_π' w') = v·(M v̇ − f)`.
    pub fn power_of_motion(&self, accelerations: &[F]) -> Option<[F; 2]> {
        let imbalance = self.imbalance(accelerations)?;
        let moving_bodies = 0..self.textbook.moving_bodies.len();
        let velocities =
            moving_bodies.flat_map(|moving_body| self.scope.point.velocity(self.textbook.model, moving_body));
        self.powers(self.dot(velocities, &imbalance), accelerations)
    }

    /// Both powers from `−λᵀν`.
    fn powers(&self, of_rows: F, accelerations: &[F]) -> Option<[F; 2]> {
        let (mut forces, mut drivers) = (self.forces()?, of_rows);
        for rotor in self.rotors() {
            let taken = rotor.inertia.value.mul(&self.acceleration_of(&rotor, accelerations));
            let back = Jet::constant(taken.neg());
            for (body, along) in &rotor.along {
                let (force, torque) = (along.force.times(&back), along.torque.times(&back));
                forces.loads[*body] = forces.loads[*body].plus(&Load { force, torque });
            }
        }
        for (body, load) in forces.loads.iter().enumerate() {
            if self.textbook.model.bodies[body].support == Support::Driven {
                drivers = drivers.sub(&load.power(&self.moving[body]).value);
            }
        }
        Some([forces.power.value, drivers])
    }

    /// What is left of eq. (17) at accelerations `(s̈, ẇ')` and multipliers: 6 numbers for each body, then one for each
    /// row.
    pub fn residual_of_motion(&self, accelerations: &[F], lambda: &[F]) -> Option<Vec<F>> {
        let (imbalance, phi_pi) = (self.imbalance(accelerations)?, self.phi_pi()?);
        let reactions = phi_pi.transposed_product(lambda, &self.scope.zero.value);
        let forces = imbalance.iter().zip(&reactions).map(|(left, reaction)| left.add(reaction));
        Some(forces.chain(self.residual_of_rows(accelerations)?).collect())
    }

    /// `M v̇ − f`: what the constraints have to take.
    pub fn imbalance(&self, accelerations: &[F]) -> Option<Vec<F>> {
        let applied = self.applied_force()?;
        let inertial = self.product(&self.mass_matrix(), accelerations);
        Some(inertial.iter().zip(&applied).map(|(inertial, f)| inertial.sub(f)).collect())
    }

    /// `Φ_r s̈ + Φ_π' ẇ' − γ`.
    pub fn residual_of_rows(&self, accelerations: &[F]) -> Option<Vec<F>> {
        let (phi_pi, gamma) = (self.phi_pi()?, self.gamma()?);
        let moved = self.product(&phi_pi, accelerations);
        Some(moved.iter().zip(&gamma).map(|(moved, gamma)| moved.sub(gamma)).collect())
    }

    /// `matrix · vector`.
    pub fn product(&self, matrix: &Sparse<F>, vector: &[F]) -> Vec<F> {
        matrix.product(vector, &self.scope.zero.value)
    }

    fn dot<'f>(&self, a: impl IntoIterator<Item = &'f F>, b: &[F]) -> F
    where
        F: 'f,
    {
        a.into_iter().zip(b).fold(self.scope.zero.value.clone(), |sum, (a, b)| sum.add(&a.mul(b)))
    }

    /// The acceleration of what falls freely at a place: g, or `μ d/|d|³`, d leading to the central body.
    pub(super) fn gravity_at(&self, place: &Vector<F>) -> Option<Vector<F>> {
        let model = self.textbook.model;
        let Some(Attraction { mu, centre }) = &model.attraction else {
            return Some(self.scope.vector(&model.gravity));
        };
        let d = self.scope.vector(centre) - place.clone();
        // A product of roots holds for any number in the place of the root.
        let distance = self.scope.sqrt(&d.dot(&d))?;
        let cube = &distance * &distance * &distance;
        Some(d.times(&(self.scope.number(mu) * cube.reciprocal()?)))
    }

    /// The energy of a unit mass at a place: `−g·r`, or `−μ/|d|`.
    fn potential_at(&self, place: &Vector<F>) -> Option<Jet<F>> {
        let model = self.textbook.model;
        let Some(Attraction { mu, centre }) = &model.attraction else {
            return Some(-self.scope.vector(&model.gravity).dot(place));
        };
        let d = place.clone() - self.scope.vector(centre);
        let distance = self.scope.sqrt(&d.dot(&d))?;
        Some(-(self.scope.number(mu) * distance.reciprocal()?))
    }

    fn mass(&self, body: usize) -> Jet<F> {
        self.scope.number(&self.textbook.model.bodies[body].mass)
    }

    fn inertia(&self, body: usize) -> Matrix<F> {
        let [xx, yy, zz, xy, xz, yz] = self.scope.numbers(&self.textbook.model.bodies[body].inertia);
        Matrix([[xx, xy.clone(), xz.clone()], [xy, yy, yz.clone()], [xz, yz, zz]])
    }
}
