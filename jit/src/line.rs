//! What is known of a tape before it is written: whose signs others take, which numbers are one.

use gyro_codegen::Variable;
use gyro_codegen::tape::{Operation, Place, Tape};
use gyro_sim::fused::IS_FUSED;

/// A tape with its signs that differences take: those of no use to any other operation or to what it gives.
pub(crate) struct Line<'t> {
    pub(crate) tape: &'t Tape<Variable, f64>,
    pub(crate) is_taken: Vec<bool>,
    /// Of products that are of use to nothing but their signs the constant factors that the signs go to.
    pub(crate) scaled_by: Vec<Option<Place>>,
    /// These factors.
    pub(crate) is_opposite: Vec<bool>,
}

impl<'t> Line<'t> {
    pub(crate) fn new<'g>(
        tape: &'t Tape<Variable, f64>,
        given: impl Iterator<Item = &'g Place> + Clone,
    ) -> Self {
        let scaled_by = scaled(tape, given.clone());
        let mut is_opposite = vec![false; tape.operations.len()];
        scaled_by.iter().flatten().for_each(|factor| is_opposite[factor.0 as usize] = true);
        let is_sign = |operation: &Operation<_, _>| !IS_FUSED && matches!(operation, Operation::Negate(_));
        let mut is_taken: Vec<bool> = tape.operations.iter().map(is_sign).collect();
        let mut stays = |place: Place| is_taken[place.0 as usize] = false;
        given.copied().for_each(&mut stays);
        for operation in &tape.operations {
            match *operation {
                Operation::Fused(a, b, c) => {
                    stays(b);
                    if negated(tape, a).is_some() {
                        stays(c);
                    }
                }
                ref other => other.operands().for_each(&mut stays),
            }
        }
        Self { tape, is_taken, scaled_by, is_opposite }
    }
}

/// Operands in an order in which a constant comes second, or else what was loaded last: processors read second operands
/// from memory, which is where both are.
pub(crate) fn second(tape: &Tape<Variable, f64>, [a, b]: [Place; 2]) -> [Place; 2] {
    let rank = |place: Place| match tape.operations[place.0 as usize] {
        Operation::Constant(_) => (2, 0),
        Operation::Variable(_) => (1, place.0),
        _ => (0, 0),
    };
    if rank(a) > rank(b) { [b, a] } else { [a, b] }
}

/// Of products that are of use to nothing but their signs the constant factor, if it is of no other use.
fn scaled<'g>(tape: &Tape<Variable, f64>, given: impl Iterator<Item = &'g Place>) -> Vec<Option<Place>> {
    let (mut n_uses, mut n_signs) = (vec![0; tape.operations.len()], vec![0; tape.operations.len()]);
    given.for_each(|place| n_uses[place.0 as usize] += 1);
    for operation in &tape.operations {
        operation.operands().for_each(|place| n_uses[place.0 as usize] += 1);
        match *operation {
            Operation::Negate(of) => n_signs[of.0 as usize] += 1,
            // Differences are made of what signs stand before.
            Operation::Fused(a, _, c) => {
                let taken = [a, c].into_iter().filter_map(|place| negated(tape, place));
                taken.for_each(|place| n_uses[place.0 as usize] += 1);
            }
            _ => (),
        }
    }
    let factor = |place: Place| {
        let is_constant = matches!(tape.operations[place.0 as usize], Operation::Constant(_));
        (is_constant && n_uses[place.0 as usize] == 1).then_some(place)
    };
    let of = |(at, operation): (usize, &Operation<Variable, f64>)| match *operation {
        Operation::Multiply(a, b) if n_signs[at] == 1 && n_uses[at] == 1 => factor(a).or_else(|| factor(b)),
        _ => None,
    };
    tape.operations.iter().enumerate().map(of).collect()
}

/// Whether two numbers are one: what is read is read wherever it is used.
pub(crate) fn is_same(tape: &Tape<Variable, f64>, a: Place, b: Place) -> bool {
    let [of_a, of_b] = [a, b].map(|place| &tape.operations[place.0 as usize]);
    a == b || matches!((of_a, of_b), (Operation::Variable(a), Operation::Variable(b)) if a == b)
}

/// What a number is the negative of, if it is written so.
pub(crate) fn negated(tape: &Tape<Variable, f64>, place: Place) -> Option<Place> {
    match tape.operations[place.0 as usize] {
        Operation::Negate(of) => Some(of),
        _ => None,
    }
}
