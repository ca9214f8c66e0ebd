//! What the joints of the trees leave free. Their rows are independent by construction, each link's six velocities
//! being new to them, so that the rank of the other rows among these motions decides: a few columns, however many
//! bodies.

use nalgebra::{DMatrix, DVector, Matrix6, SVD};

use crate::{Attachment, Model, Row, RowOwner, Tree};

/// The rows of the trees' joints and of constrained bodies, link by link, root first.
#[derive(Debug)]
pub(super) struct TreeRows(Vec<LinkRows>);

#[derive(Debug)]
struct LinkRows {
    rows: Vec<usize>,
    /// Places among the bodies with coordinates.
    body: usize,
    parent: Option<usize>,
}

/// The Jacobian at a pose, rows of length one, and what the trees leave free there.
#[derive(Debug)]
pub(super) struct Motions {
    pub(super) jacobian: DMatrix<f64>,
    /// The lengths that the rows had.
    lengths: Vec<f64>,
    /// An orthonormal basis, in columns.
    free: DMatrix<f64>,
    /// Of each link the least velocities of its body by which its rows change as given.
    least: Vec<DMatrix<f64>>,
}

impl TreeRows {
    pub(super) fn of(model: &Model, tree: &Tree, rows: &[Row]) -> Self {
        let bodies = model.coordinate_bodies();
        let place = |body: usize| bodies.iter().position(|&other| other == body);
        let links = tree.links.iter().map(|link| {
            let (owner, parent) = match link.attachment {
                Attachment::Free => (None, None),
                Attachment::Constrained => (Some(RowOwner::Body(link.body)), None),
                Attachment::Joint { joint, parent, .. } => (Some(RowOwner::Joint(joint)), place(parent)),
            };
            let own = rows.iter().enumerate().filter(|(_, row)| Some(row.owner) == owner);
            let body = place(link.body).expect("links have coordinates");
            LinkRows { rows: own.map(|(row, _)| row).collect(), body, parent }
        });
        Self(links.collect())
    }

    /// All of them.
    pub(super) fn rows(&self) -> impl Iterator<Item = usize> {
        self.0.iter().flat_map(|link| link.rows.iter().copied())
    }

    /// What they leave at a pose, singular poses of the mechanism among them.
    pub(super) fn motions(&self, jacobian: &DMatrix<f64>) -> Motions {
        let (jacobian, lengths) = with_unit_rows(jacobian);
        let count = self.0.iter().map(|link| 6 - link.rows.len()).sum();
        let mut all = DMatrix::zeros(jacobian.ncols(), count);
        let (mut least, mut first) = (Vec::new(), 0);
        for link in &self.0 {
            let (inverse, free) = inverse_and_rest(&part(&jacobian, &link.rows, link.body));
            if let Some(parent) = link.parent {
                let carried = -(&inverse * part(&jacobian, &link.rows, parent)) * all.rows(6 * parent, 6);
                all.rows_mut(6 * link.body, 6).copy_from(&carried);
            }
            all.view_mut((6 * link.body, first), free.shape()).copy_from(&free);
            first += free.ncols();
            least.push(inverse);
        }
        let free = if count > 0 { all.qr().q() } else { all };
        Motions { jacobian, lengths, free, least }
    }

    /// The coefficients by which the trees' rows add up to each of these vectors, in the order of [`Self::rows`]; the
    /// vectors are of length zero along what the trees leave.
    pub(super) fn combinations(&self, motions: &Motions, mut vectors: DMatrix<f64>) -> DMatrix<f64> {
        let count = self.rows().count();
        let mut coefficients = DMatrix::zeros(vectors.nrows(), count);
        let mut end = count;
        for (link, inverse) in self.0.iter().zip(&motions.least).rev() {
            let own = vectors.columns(6 * link.body, 6) * inverse;
            end -= link.rows.len();
            coefficients.columns_mut(end, link.rows.len()).copy_from(&own);
            if let Some(parent) = link.parent {
                let carried = own * part(&motions.jacobian, &link.rows, parent);
                let mut on_parent = vectors.columns_mut(6 * parent, 6);
                on_parent -= carried;
            }
        }
        coefficients
    }
}

impl Motions {
    /// How many the trees leave free.
    pub(super) fn count(&self) -> usize {
        self.free.ncols()
    }

    /// The part of a row of the Jacobian that the trees leave free.
    pub(super) fn row(&self, row: usize) -> DVector<f64> {
        self.free.tr_mul(&self.jacobian.row(row).transpose())
    }

    /// The same, rows being made anew.
    pub(super) fn with(&self, jacobian: &DMatrix<f64>) -> Self {
        let (jacobian, lengths) = with_unit_rows(jacobian);
        Self { jacobian, lengths, free: self.free.clone(), least: self.least.clone() }
    }

    /// By how much a row was longer than another; none has no length.
    pub(super) fn ratio(&self, row: usize, other: usize) -> f64 {
        self.lengths[row] / self.lengths[other]
    }
}

/// Some rows' derivatives by the velocities of one body.
fn part(jacobian: &DMatrix<f64>, rows: &[usize], body: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), 6, |row, column| jacobian[(rows[row], 6 * body + column)])
}

/// The pseudoinverse of independent rows, and an orthonormal basis of what they leave, in columns.
fn inverse_and_rest(rows: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let count = rows.nrows();
    let mut square = Matrix6::zeros();
    square.rows_mut(0, count).copy_from(rows);
    let SVD { u, v_t, singular_values } = square.svd(true, true);
    let (u, v_t) = (u.expect("asked for"), v_t.expect("asked for"));
    let mut inverse = DMatrix::zeros(6, count);
    for k in 0..count {
        inverse += v_t.row(k).transpose() * u.view((0, k), (count, 1)).transpose() / singular_values[k];
    }
    (inverse, DMatrix::from_fn(6, 6 - count, |row, column| v_t[(count + column, row)]))
}

/// Rows on zero length stay as they are: nothing that has coordinates is in them.
fn with_unit_rows(jacobian: &DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
    let lengths: Vec<f64> = jacobian.row_iter().map(|row| row.norm()).collect();
    let mut unit = jacobian.clone();
    for (mut row, &length) in unit.row_iter_mut().zip(&lengths) {
        if length > 0.0 {
            row /= length;
        }
    }
    (unit, lengths)
}
