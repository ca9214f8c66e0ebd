//! Which knowns of a unit its unknowns depend on, read off the operations that compute them: what no operation hands on
//! to an unknown does not matter to it.

use gyro_codegen::tape::{At, Direction, Loop, Operation, Place, Tape};
use gyro_codegen::{Argument, Kernel, Scheduled, Stored, Variable};
use gyro_program::Space;
use std::collections::HashMap;

/// A set of value references, a bit for each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Knowns(Vec<u64>);

impl Knowns {
    pub(super) fn one(reference: usize) -> Self {
        let mut words = vec![0; reference / 64 + 1];
        words[reference / 64] = 1 << (reference % 64);
        Self(words)
    }

    fn add(&mut self, other: &Self) {
        if self.0.len() < other.0.len() {
            self.0.resize(other.0.len(), 0);
        }
        self.0.iter_mut().zip(&other.0).for_each(|(word, other)| *word |= other);
    }

    /// In ascending order.
    pub(super) fn references(&self) -> impl Iterator<Item = usize> {
        let bits = self
            .0
            .iter()
            .enumerate()
            .flat_map(|(n, word)| (0..64).map(move |bit| (64 * n + bit, word >> bit)));
        bits.filter(|(_, word)| word & 1 == 1).map(|(reference, _)| reference)
    }
}

/// Value references of what is known: time, then the joint state, and on from these the inputs, and the parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct References {
    pub(super) time: usize,
    pub(super) states: usize,
    pub(super) inputs: usize,
    pub(super) parameters: usize,
}

/// What the derivatives of the joint state depend on, and what the outputs do.
pub(super) fn dependencies(scheduled: &Scheduled, references: References) -> [Vec<Knowns>; 2] {
    let mut reader = Reader { scheduled, references, derived: Vec::new(), given: Vec::new() };
    reader.derived = reader.results(Kernel::ParameterSetup);
    reader.given = reader.results(Kernel::JointAccelerations);
    let results = reader.results(Kernel::JointDerivative);
    let derivatives = scheduled.stores(Kernel::JointDerivative).into_iter().map(|store| match store.value {
        Stored::Result(n) => results[n].clone(),
        Stored::Element("x", place) => Knowns::one(references.states + place),
        Stored::Element(_, place) => reader.given[place].clone(),
    });
    let derivatives: Vec<Knowns> = derivatives.collect();
    assert_eq!(derivatives.len(), scheduled.len(Space::Joints), "every number of the state has a derivative");
    [derivatives, reader.results(Kernel::JointOutputs)]
}

/// Follows the operations of kernels.
struct Reader<'a> {
    scheduled: &'a Scheduled,
    references: References,
    /// Of the numbers that parameters alone decide.
    derived: Vec<Knowns>,
    /// Of the accelerations.
    given: Vec<Knowns>,
}

/// What arrays that loops fill hold, by array, row and column, and what loops are given.
#[derive(Default)]
struct Held {
    kept: HashMap<[usize; 3], Knowns>,
    fixed: Vec<Knowns>,
}

impl Reader<'_> {
    /// Of each result of a kernel; none where there is no such kernel.
    fn results(&self, kernel: Kernel) -> Vec<Knowns> {
        let Some(kernel) = self.scheduled.kernels.get(&kernel) else { return Vec::new() };
        let (tape, mut held, mut numbers) = (&kernel.tape, Held::default(), Vec::new());
        let number = |numbers: &[Knowns], place: Place| numbers[place.0 as usize].clone();
        for each in &tape.loops {
            self.follow(&tape.outside, (each.after, 0), &held, &mut numbers);
            held.fixed.extend(each.fixed.iter().map(|&place| number(&numbers, place)));
            held.kept.extend(each.stores.iter().map(|&(at, place)| (at, number(&numbers, place))));
            self.repeat(each, &mut held);
        }
        self.follow(&tape.outside, (tape.outside.operations.len(), 0), &held, &mut numbers);
        tape.results.iter().map(|&place| number(&numbers, place)).collect()
    }

    fn repeat(&self, each: &Loop<Variable, f64>, held: &mut Held) {
        for nth in 0..each.count {
            let part = if each.direction == Direction::Backward { each.count - 1 - nth } else { nth };
            let mut numbers = Vec::new();
            self.follow(&each.body, (each.body.operations.len(), part), held, &mut numbers);
            for row in &each.rows {
                let at = if let At::Part(offset) = row.at { part + offset } else { 0 };
                for (column, place) in row.values.iter().enumerate() {
                    held.kept.insert([row.array, at, column], numbers[place.0 as usize].clone());
                }
            }
        }
    }

    /// The operations of a tape that have not been followed yet, up to one of them.
    fn follow(
        &self,
        tape: &Tape<Variable, f64>,
        (end, part): (usize, usize),
        held: &Held,
        numbers: &mut Vec<Knowns>,
    ) {
        for operation in &tape.operations[numbers.len()..end] {
            let mut knowns = match operation {
                Operation::Variable(variable) => self.variable(*variable, part, held),
                _ => Knowns::default(),
            };
            operation.operands().for_each(|place| knowns.add(&numbers[place.0 as usize]));
            numbers.push(knowns);
        }
    }

    fn variable(&self, variable: Variable, part: usize, held: &Held) -> Knowns {
        let References { time, states, inputs, parameters } = self.references;
        let kept = |at: [usize; 3]| held.kept.get(&at).cloned().unwrap_or_default();
        match variable {
            Variable::Time | Variable::Curve { .. } => Knowns::one(time),
            Variable::Element(Argument::Joints, place) => Knowns::one(states + place),
            Variable::Element(_, place) => self.given[place].clone(),
            Variable::Strided { argument, first, stride } => {
                self.variable(Variable::Element(argument, first + stride * part), part, held)
            }
            Variable::Parameter(n) => Knowns::one(parameters + n),
            Variable::ParameterSetup(place) => self.derived[place].clone(),
            Variable::Input(n) => Knowns::one(inputs + n),
            Variable::Kept { array, row, column } => kept([array, row, column]),
            Variable::Row { array, offset, column } => kept([array, part + offset, column]),
            Variable::Fixed(number) => held.fixed[number].clone(),
            Variable::Chart(_) | Variable::Factor(_) => Knowns::default(),
        }
    }
}
