//! Points at which identities are tested.

use crate::field::{Degree, Field, Modular, Prime};
use crate::point::Point;
use gyro_model::Model;
use rand::Rng;

/// A random point with |p| = 1: Euler parameters are `(1 − u·u, 2u) / (1 + u·u)` of a random vector u, which reaches
/// every unit vector but one. `None` where `1 + u·u` vanishes.
pub fn drawn<'p, const L: usize>(
    model: &Model,
    prime: &'p Prime<L>,
    random: &mut impl Rng,
) -> Option<Point<Modular<'p, L>>> {
    let mut draw = || prime.draw(random);
    let n = model.coordinate_bodies().len();
    let mut state = Vec::new();
    for _ in 0..n {
        state.extend([(); 3].map(|()| draw()));
        state.extend(on_sphere(prime, [(); 3].map(|()| draw()))?);
    }
    let rest = 6 * n + usize::from(model.has_work()) + model.turn_references().len();
    state.extend((0..rest).map(|_| draw()));
    Some(Point {
        context: prime,
        t: draw(),
        state,
        parameters: model.parameters.iter().map(|_| draw()).collect(),
        inputs: model.inputs.iter().map(|_| draw()).collect(),
    })
}

/// The degrees of such a point in what is drawn.
pub fn degrees(model: &Model) -> Point<Degree> {
    let n = model.coordinate_bodies().len();
    let (variable, euler) = (Degree::polynomial(1.0), Degree::quotient(2.0, 2.0));
    let position = [variable, variable, variable, euler, euler, euler, euler];
    let rest = 6 * n + usize::from(model.has_work()) + model.turn_references().len();
    Point {
        context: (),
        t: variable,
        state: position.repeat(n).into_iter().chain(vec![variable; rest]).collect(),
        parameters: vec![variable; model.parameters.len()],
        inputs: vec![variable; model.inputs.len()],
    }
}

/// The point with the Euler parameters of each body made longer by a factor of its own.
pub fn stretched<F: Field>(point: &Point<F>, factors: &[F]) -> Point<F> {
    let mut stretched = point.clone();
    for (slot, factor) in factors.iter().enumerate() {
        for e in &mut stretched.state[7 * slot + 3..7 * slot + 7] {
            *e = e.mul(factor);
        }
    }
    stretched
}

fn on_sphere<F: Field<Context = C>, C>(context: C, u: [F; 3]) -> Option<[F; 4]> {
    let one = F::one(context);
    let square = u.iter().fold(one.sub(&one), |sum, x| sum.add(&x.mul(x)));
    let scale = one.add(&square).inv()?;
    let [x, y, z] = u.map(|x| x.add(&x).mul(&scale));
    Some([one.sub(&square).mul(&scale), x, y, z])
}
