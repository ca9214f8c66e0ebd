//! Numbers that inputs are set to at every step.

use gyro_sim::{Mechanism, Scalar};

/// What one of the mechanism's inputs is over time: linear between the rows of a table, and held beyond its ends. A
/// table of one row is a constant.
///
/// Each step of the integrator has the value at its own start, held over the step, as a sampled controller gives it;
/// each sample has the value at its own time.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Input {
    /// Index among the mechanism's inputs.
    pub index: usize,
    /// Time, s, and value; times ascend.
    pub rows: Vec<[f64; 2]>,
}

impl Input {
    /// The value at a time; zero for an empty table.
    pub fn at(&self, t: f64) -> f64 {
        let after = self.rows.partition_point(|[time, _]| *time <= t);
        match (after.checked_sub(1).and_then(|before| self.rows.get(before)), self.rows.get(after)) {
            (Some([t0, before]), Some([t1, after])) => before + (after - before) * ((t - t0) / (t1 - t0)),
            (Some([_, value]), None) | (None, Some([_, value])) => *value,
            (None, None) => 0.0,
        }
    }
}

/// Whether any input changes, so that steps must be taken one by one.
pub fn any_varies(inputs: &[Input]) -> bool {
    inputs.iter().any(|input| input.rows.windows(2).any(|pair| pair[0][1] != pair[1][1]))
}

/// Sets all inputs to their values at a time.
pub(crate) fn set<M: Mechanism>(mechanism: &mut M, inputs: &[Input], t: f64) {
    for input in inputs {
        mechanism.set_input(input.index, M::Scalar::constant(input.at(t)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_linear_inside_and_held_outside() {
        let input = Input { index: 0, rows: vec![[1.0, 10.0], [2.0, 20.0], [4.0, 0.0]] };
        for (t, value) in
            [(0.0, 10.0), (1.0, 10.0), (1.25, 12.5), (2.0, 20.0), (3.5, 5.0), (4.0, 0.0), (9.0, 0.0)]
        {
            assert_eq!(input.at(t), value, "{t}");
        }
        assert_eq!(Input { index: 0, rows: vec![[5.0, 3.0]] }.at(-1.0), 3.0);
        assert_eq!(Input { index: 0, rows: vec![] }.at(1.0), 0.0);
    }

    #[test]
    fn a_table_of_equal_values_does_not_vary() {
        let constant = Input { index: 0, rows: vec![[0.0, 1.0], [1.0, 1.0]] };
        let ramp = Input { index: 1, rows: vec![[0.0, 1.0], [1.0, 2.0]] };
        assert!(!any_varies(std::slice::from_ref(&constant)) && any_varies(&[constant, ramp]));
    }
}
