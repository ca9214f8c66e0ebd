//! How a body stands to its carrier where the angles of the joint between them are zero.

use super::link_kinematics::at_zero;
use crate::derive::frames::JointFrames;
use crate::derive::system::System;
use crate::expr::evaluate::evaluate;
use crate::expr::graph::Graph;
use crate::expr::symbol::Symbol;
use crate::expr::vector::Vec4;
use std::array::from_fn;

/// Euler parameters, up to a factor, of the second body in the first's frame where all angles are zero: of the four
/// ways to read them off a rotation matrix the one farthest from a division by zero.
pub fn orientation_at_zero(system: &mut System, joint: &JointFrames) -> Vec4 {
    let r = at_zero(&mut system.graph, joint);
    let graph = &mut system.graph;
    let d = [r[0][0], r[1][1], r[2][2]];
    let mut sum = |signs: [i64; 3]| {
        let mut sum = Graph::ONE;
        for (sign, &entry) in signs.iter().zip(&d) {
            sum = if *sign > 0 { graph.add(sum, entry) } else { graph.sub(sum, entry) };
        }
        sum
    };
    let squares = [sum([1, 1, 1]), sum([1, -1, -1]), sum([-1, 1, -1]), sum([-1, -1, 1])];
    let skew = [(2, 1), (0, 2), (1, 0)].map(|(i, j)| graph.sub(r[i][j], r[j][i]));
    let even = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| graph.add(r[i][j], r[j][i]));
    let rows = [
        [squares[0], skew[0], skew[1], skew[2]],
        [skew[0], squares[1], even[2], even[1]],
        [skew[1], even[2], squares[2], even[0]],
        [skew[2], even[1], even[0], squares[3]],
    ];
    let largest = match rows_to_add(system, &rows)[..] {
        [(row, _)] => row,
        ref several => {
            let graph = &mut system.graph;
            return several.iter().fold([Graph::ZERO; 4], |sum, &(row, sign)| {
                from_fn(|k| {
                    if sign > 0 { graph.add(sum[k], rows[row][k]) } else { graph.sub(sum[k], rows[row][k]) }
                })
            });
        }
    };
    // The nicest multiple: the largest component one.
    let graph = &mut system.graph;
    let inverse = graph.recip(squares[largest]);
    graph.scale_vec(inverse, &rows[largest])
}

/// Values of the parameters at which rows are tried, besides their own.
const TRIED: usize = 64;

/// Of the rows `4 eᵢ e` the one with the largest square. Where other values of parameters turn an axis around, that
/// may be zero: then a sum `Σ cᵢ 4 eᵢ e` that is not, with each row's cᵢ of ±1.
fn rows_to_add(system: &System, rows: &[Vec4; 4]) -> Vec<(usize, i32)> {
    let (parameters, flat) = (&system.model.parameters, rows.concat());
    let numbers = |value: &dyn Fn(usize, f64) -> f64| {
        evaluate(&system.graph, &flat, |symbol| match symbol {
            Symbol::Parameter(k) => value(k, gyro_model::to_f64(&parameters[k].value)),
            _ => f64::NAN,
        })
    };
    let given = numbers(&|_, own| own);
    let largest = (0..4).max_by(|&a, &b| given[5 * a].total_cmp(&given[5 * b])).expect("four of them");
    // Of either sign, by powers of two up to 64 times smaller or larger than their own.
    let other = |n: usize, k: usize, own: f64| {
        let size = if own == 0.0 { 1.0 } else { own.abs() };
        let power = i32::try_from(n * (k + 1) % 13).expect("it is small") - 6;
        let size = size * 2_f64.powi(power);
        if (n >> (k % 6)) & 1 == 0 { size } else { -size }
    };
    let others: Vec<_> = (0..TRIED).map(|n| numbers(&|k, own| other(n, k, own))).collect();
    // Four times the square of Σ cᵢ eᵢ.
    let square = |values: &[f64], c: &[(usize, i32)]| -> f64 {
        c.iter().flat_map(|&(i, a)| c.iter().map(move |&(k, b)| f64::from(a * b) * values[4 * i + k])).sum()
    };
    let sums = (0..81).map(|code| {
        let coefficients = [27, 9, 3, 1].map(|power| code / power % 3);
        (0..4).zip(coefficients.map(|c| if c == 2 { -1 } else { c })).filter(|(_, c)| *c != 0).collect()
    });
    let mut sums: Vec<Vec<(usize, i32)>> = sums.collect();
    sums.sort_by_key(Vec::len);
    let vanishes =
        |c: &[(usize, i32)]| others.iter().chain([&given]).any(|values| square(values, c) <= NEARLY_ZERO);
    let is_clear = |c: &Vec<(usize, i32)>| !vanishes(c);
    let alone = vec![(largest, 1)];
    if is_clear(&alone) { alone } else { sums.into_iter().find(is_clear).unwrap_or(alone) }
}

/// Less than this is the square of nothing that is divided by.
const NEARLY_ZERO: f64 = 1e-9;
