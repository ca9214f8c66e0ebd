//! Sobol's indices of sensitivity, from scenarios in Saltelli's scheme.
//!
//! Estimators of Saltelli et al. (*Variance based sensitivity analysis of model output*, Comput. Phys. Commun. 181,
//! 2010, table 2): of first order (b), of all orders Jansen's (f).

/// The sums for some kept numbers; scenarios come in their order.
#[derive(Clone, Debug)]
pub struct Indices {
    /// Number of draws d.
    draws: usize,
    /// The numbers of the group under way: a, b, then a with one of b's draws.
    group: Vec<Vec<f64>>,
    sums: Vec<Sums>,
}

/// The indices of one kept number.
#[derive(Clone, Debug, PartialEq)]
pub struct IndicesOf {
    /// Of each draw, the part of the variance that is its own.
    pub first: Vec<f64>,
    /// The part in which it takes part at all.
    pub total: Vec<f64>,
    /// How many groups of scenarios they come from.
    pub groups: u64,
}

#[derive(Clone, Debug)]
struct Sums {
    groups: u64,
    /// The first value: sums are of differences from it, so that a large mean does not drown them.
    origin: f64,
    sum: f64,
    squares: f64,
    first: Vec<f64>,
    total: Vec<f64>,
}

impl Indices {
    /// Of so many kept numbers and draws.
    pub fn new(numbers: usize, draws: usize) -> Self {
        let zeros = || vec![0.0; draws];
        let sums = Sums { groups: 0, origin: 0.0, sum: 0.0, squares: 0.0, first: zeros(), total: zeros() };
        Self { draws, group: Vec::new(), sums: vec![sums; numbers] }
    }

    /// Takes the next scenario. Of a group with a number that is not finite that number is left out.
    pub fn add(&mut self, numbers: &[f64]) {
        self.group.push(numbers[..self.sums.len()].to_vec());
        if self.group.len() < self.draws + 2 {
            return;
        }
        for (index, sums) in self.sums.iter_mut().enumerate() {
            let values: Vec<f64> = self.group.iter().map(|row| row[index]).collect();
            if values.iter().all(|value| value.is_finite()) {
                sums.add(&values);
            }
        }
        self.group.clear();
    }

    /// The indices of each number.
    pub fn finish(&self) -> Vec<IndicesOf> {
        self.sums.iter().map(Sums::finish).collect()
    }
}

impl Sums {
    fn add(&mut self, values: &[f64]) {
        if self.groups == 0 {
            self.origin = values[0];
        }
        let [a, b] = [values[0] - self.origin, values[1] - self.origin];
        self.groups += 1;
        self.sum += a + b;
        self.squares += a * a + b * b;
        for (k, value) in values[2..].iter().enumerate() {
            let exchanged = value - self.origin;
            self.first[k] += b * (exchanged - a);
            self.total[k] += (a - exchanged) * (a - exchanged);
        }
    }

    fn finish(&self) -> IndicesOf {
        #[expect(clippy::cast_precision_loss, reason = "numbers of scenarios stay below 2⁵³")]
        let n = self.groups as f64;
        let mean = self.sum / (2.0 * n);
        let variance = self.squares / (2.0 * n) - mean * mean;
        let part = |sum: &f64, n: f64| if variance > 0.0 { sum / n / variance } else { f64::NAN };
        IndicesOf {
            first: self.first.iter().map(|sum| part(sum, n)).collect(),
            total: self.total.iter().map(|sum| part(sum, 2.0 * n)).collect(),
            groups: self.groups,
        }
    }
}

#[cfg(test)]
mod tests;
