//! What the tests share: models, seeded random states, dense copies of sparse values.
#![allow(dead_code, reason = "every test file uses a part of it")]

use gyro_assembled::{Careful, Dense};
use gyro_model::Model;
use gyro_sim::{Dynamics, Kinematics, Mechanism, Partition, Projection};
use nalgebra::DMatrix;
use std::path::{Path, PathBuf};

/// Every model of the project, and those of these tests.
pub fn models() -> Vec<Model> {
    let folders = ["../models", "tests/models"].map(|folder| {
        let mut pages = pages(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
        assert!(pages.len() >= 2, "no models in {folder}");
        pages.sort();
        pages
    });
    folders.concat().iter().map(|page| read(page)).collect()
}

/// Those of them that the careful form does.
pub fn careful_models() -> Vec<Model> {
    let mut models = models();
    let all = models.len();
    models.retain(|model| Careful::<f64>::supports(model).is_ok());
    assert!(models.len() > 8 && models.len() < all, "{} of {all}", models.len());
    models
}

/// The dense form of every model.
pub fn dense_models() -> Vec<(String, Dense<f64>)> {
    models().iter().map(|model| (model.name.clone(), dense(model))).collect()
}

/// The dense form of a model.
pub fn dense(model: &Model) -> Dense<f64> {
    Dense::new(model).unwrap_or_else(|error| panic!("{}: {error}", model.name))
}

/// One model of the project.
pub fn model(name: &str) -> Model {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../models/{name}.toml")))
}

/// One model of these tests.
pub fn test_model(name: &str) -> Model {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/models/{name}.toml")))
}

fn pages(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("its entries can be read").path());
    paths.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect()
}

fn read(page: &Path) -> Model {
    let text = std::fs::read_to_string(page).expect("the model file can be read");
    let folder = page.parent().expect("a model file is in a folder");
    let mut load = |path: &str| std::fs::read_to_string(folder.join(path)).map_err(|error| error.to_string());
    analysed(gyro_model::read_with(&page.display().to_string(), &text, &mut load))
}

/// The model of a model file.
pub fn read_text(page: &str) -> Model {
    analysed(gyro_model::read("page", page))
}

/// The model without redundant rows.
fn analysed(model: Result<Model, gyro_model::Diagnostics>) -> Model {
    let mut model = model.unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let analysis = gyro_model::analyse(&model).unwrap_or_else(|error| panic!("{}: {error}", model.name));
    model.redundant = analysis.redundant;
    model
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
    let (mut y, n) = (mechanism.start(), mechanism.description().bodies.len());
    let (q, v) = y[..13 * n].split_at_mut(7 * n);
    for q in q.as_chunks_mut::<7>().0 {
        q[..3].iter_mut().for_each(|r| *r += spread * mechanism.size() * random.signed());
        q[3..].iter_mut().for_each(|e| *e += spread * random.signed());
    }
    normalise(q);
    for v in v.as_chunks_mut::<6>().0 {
        v[..3].iter_mut().for_each(|s| *s = 10.0 * mechanism.size() * random.signed());
        v[3..].iter_mut().for_each(|w| *w = 10.0 * random.signed());
    }
    y
}

/// Makes the Euler parameters of positions unit vectors.
pub fn normalise(q: &mut [f64]) {
    for q in q.as_chunks_mut::<7>().0 {
        let norm = q[3..].iter().map(|e| e * e).sum::<f64>().sqrt();
        q[3..].iter_mut().for_each(|e| *e /= norm);
    }
}

/// (Φ_r, Φ_π') as a dense matrix.
pub fn dense_phi_pi<M: Kinematics<Scalar = f64> + Dynamics + Projection>(
    mechanism: &M,
    t: f64,
    y: &M::State,
) -> DMatrix<f64> {
    let mut values = mechanism.terms().phi_pi;
    mechanism.phi_pi(t, y, &mut values);
    let n_rows = mechanism.buffers().rows.as_ref().len();
    scatter(n_rows, 6 * mechanism.description().bodies.len(), mechanism.phi_pi_pattern(), values.as_ref())
}

/// Φ_q as a dense matrix.
pub fn dense_phi_q<M: Kinematics<Scalar = f64> + Dynamics + Projection>(
    mechanism: &M,
    t: f64,
    y: &M::State,
) -> DMatrix<f64> {
    let mut values = mechanism.terms().phi_q;
    mechanism.phi_q(t, y, &mut values);
    let n_rows = mechanism.buffers().constraints.as_ref().len();
    scatter(n_rows, 7 * mechanism.description().bodies.len(), mechanism.phi_q_pattern(), values.as_ref())
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
pub fn phi<M: Mechanism<Scalar = f64>>(mechanism: &M, t: f64, y: &M::State) -> Vec<f64> {
    let mut out = mechanism.buffers().constraints;
    mechanism.phi(t, y, &mut out);
    out.as_ref().to_vec()
}

/// The velocity residual at a state.
pub fn velocity_residual<M: Mechanism<Scalar = f64>>(mechanism: &M, t: f64, y: &M::State) -> Vec<f64> {
    let mut out = mechanism.buffers().rows;
    mechanism.velocity_residual(t, y, &mut out);
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
