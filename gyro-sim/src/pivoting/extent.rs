//! How many constraints and coordinates there are, and arrays of these lengths.

use crate::Real;
use crate::contract::Storage;
use core::fmt::Debug;

/// Numbers of constraints and coordinates, and where an elimination keeps its numbers: in arrays of fixed size for
/// generated modules ([`Fixed`]), on a heap for mechanisms that are put together at run time.
pub trait Extent: Copy + Debug + PartialEq {
    /// One place for each coordinate.
    type Columns: Storage<u16> + PartialEq;
    /// One place for each constraint.
    type Places: Storage<u16>;
    /// One scalar for each constraint.
    type Rows<T: Real>: Storage<T>;
    /// One scalar for each coordinate.
    type Line<T: Real>: Storage<T>;
    /// A line for each constraint.
    type Jacobian<T: Real>: AsRef<[Self::Line<T>]> + AsMut<[Self::Line<T>]>;

    /// So many constraints and coordinates.
    fn new(n_constraints: usize, n_coordinates: usize) -> Self;
    /// The number of constraints, joint rows and normalisations.
    fn n_constraints(self) -> usize;
    /// The number of coordinates.
    fn n_coordinates(self) -> usize;
    /// All coordinates in their order.
    fn columns(self) -> Self::Columns;
    /// Zeros.
    fn places(self) -> Self::Places;
    /// Zeros.
    fn rows<T: Real>(self) -> Self::Rows<T>;
    /// Zeros.
    fn line<T: Real>(self) -> Self::Line<T>;
    /// Zeros.
    fn jacobian<T: Real>(self) -> Self::Jacobian<T>;
}

/// `NC` constraints and `NQ` coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed<const NC: usize, const NQ: usize>;

impl<const NC: usize, const NQ: usize> Extent for Fixed<NC, NQ> {
    type Columns = [u16; NQ];
    type Places = [u16; NC];
    type Rows<T: Real> = [T; NC];
    type Line<T: Real> = [T; NQ];
    type Jacobian<T: Real> = [[T; NQ]; NC];

    fn new(_: usize, _: usize) -> Self {
        const { assert!(NC <= NQ, "a mechanism has at least as many coordinates as constraints") };
        Self
    }
    fn n_constraints(self) -> usize {
        NC
    }
    fn n_coordinates(self) -> usize {
        NQ
    }
    fn columns(self) -> [u16; NQ] {
        core::array::from_fn(|c| c as u16)
    }
    fn places(self) -> [u16; NC] {
        [0; NC]
    }
    fn rows<T: Real>(self) -> [T; NC] {
        [T::constant(0.0); NC]
    }
    fn line<T: Real>(self) -> [T; NQ] {
        [T::constant(0.0); NQ]
    }
    fn jacobian<T: Real>(self) -> [[T; NQ]; NC] {
        [[T::constant(0.0); NQ]; NC]
    }
}
