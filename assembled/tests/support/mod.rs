//! What the tests share: models, seeded random states, dense copies of sparse values.
#![allow(dead_code, reason = "every test file uses a part of it")]

use gyro_model::Model;
use gyro_sim::{Equations, Mechanism, Partition};
use nalgebra::DMatrix;
use std::path::{Path, PathBuf};

/// Every model of the project, and the zoo of these tests.
pub fn models() -> Vec<Model> {
    let crate_dir = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = crate_dir.join("../models");
    let mut pages: Vec<PathBuf> = std::fs::read_dir(&folder)
        .expect("the models folder is there")
        .map(|entry| entry.expect("its entries can be read").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    pages.sort();
    assert!(pages.len() >= 2, "no models in {}", folder.display());
    pages.push(crate_dir.join("tests/zoo.toml"));
    pages.iter().map(|page| read(page)).collect()
}

/// One model of the project.
pub fn model(name: &str) -> Model {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../models/{name}.toml")))
}

fn read(page: &Path) -> Model {
    let text = std::fs::read_to_string(page).expect("the page can be read");
    match gyro_model::read(&page.display().to_string(), &text) {
        Ok(model) => model,
        Err(mistakes) => panic!("{mistakes}"),
    }
}

/// Seeded random numbers: Vigna's splitmix64.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// Uniform in (−1, 1).
    pub fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A state off the joint manifold: positions within `spread` of the start (of the mechanism's size; of one), |p| = 1.
pub fn state_near<M: Partition<Scalar = f64, State = Vec<f64>>>(
    mechanism: &M,
    spread: f64,
    random: &mut Random,
) -> Vec<f64> {
    let (mut y, n) = (mechanism.start(), mechanism.n_bodies());
    let (q, v) = y.split_at_mut(7 * n);
    for q in q.as_chunks_mut::<7>().0 {
        q[..3].iter_mut().for_each(|r| *r += spread * mechanism.size() * random.signed());
        q[3..].iter_mut().for_each(|e| *e += spread * random.signed());
        let norm = q[3..].iter().map(|e| e * e).sum::<f64>().sqrt();
        q[3..].iter_mut().for_each(|e| *e /= norm);
    }
    for v in v.as_chunks_mut::<6>().0 {
        v[..3].iter_mut().for_each(|s| *s = 10.0 * mechanism.size() * random.signed());
        v[3..].iter_mut().for_each(|w| *w = 10.0 * random.signed());
    }
    y
}

/// (Φ_r, Φ_π') as a dense matrix.
pub fn dense_phi_pi<M: Equations<Scalar = f64>>(mechanism: &M, y: &M::State) -> DMatrix<f64> {
    let mut values = mechanism.phi_pi_values();
    mechanism.phi_pi(0.0, y, &mut values);
    let n_rows = mechanism.rows().as_ref().len();
    scatter(n_rows, 6 * mechanism.n_bodies(), mechanism.phi_pi_pattern(), values.as_ref())
}

/// Φ_q as a dense matrix.
pub fn dense_phi_q<M: Equations<Scalar = f64>>(mechanism: &M, y: &M::State) -> DMatrix<f64> {
    let mut values = mechanism.phi_q_values();
    mechanism.phi_q(0.0, y, &mut values);
    let n_rows = mechanism.constraints().as_ref().len();
    scatter(n_rows, 7 * mechanism.n_bodies(), mechanism.phi_q_pattern(), values.as_ref())
}

fn scatter(n_rows: usize, n_columns: usize, pattern: &[(u16, u16)], values: &[f64]) -> DMatrix<f64> {
    assert!(pattern.is_sorted() && pattern.len() == values.len());
    let mut matrix = DMatrix::zeros(n_rows, n_columns);
    for (&(row, column), &value) in pattern.iter().zip(values) {
        matrix[(row.into(), column.into())] = value;
    }
    matrix
}

/// Φ at a state.
pub fn phi<M: Mechanism<Scalar = f64>>(mechanism: &M, y: &M::State) -> Vec<f64> {
    let mut out = mechanism.constraints();
    mechanism.phi(0.0, y, &mut out);
    out.as_ref().to_vec()
}

/// The velocity residual at a state.
pub fn velocity_residual<M: Mechanism<Scalar = f64>>(mechanism: &M, y: &M::State) -> Vec<f64> {
    let mut out = mechanism.rows();
    mechanism.velocity_residual(0.0, y, &mut out);
    out.as_ref().to_vec()
}

/// Largest absolute value.
pub fn max_norm<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().fold(0.0, |max, value| if value.abs() <= max { max } else { value.abs() })
}

/// Asserts that two lists agree to `tolerance` of the larger one's norm, or of `scale` where that is larger.
pub fn assert_close(what: &str, a: &[f64], b: &[f64], scale: f64, tolerance: f64) {
    assert_eq!(a.len(), b.len(), "{what}");
    let scale = scale.max(max_norm(a)).max(max_norm(b));
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        let error = (a - b).abs();
        assert!(error <= tolerance * scale, "{what}[{k}]: {a} and {b} differ by {error:e}, scale {scale}");
    }
}
