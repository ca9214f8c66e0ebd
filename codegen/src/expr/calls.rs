//! Values and derivatives of called functions in numbers: elementary functions, and curves of tables.

use crate::expr::domains::Domains;
use crate::expr::elementary;
use gyro_program::elementary::Function;
use num_traits::Float;

/// The value at some operands; of one operand the second one is of no matter.
pub fn value<F: Float>(domains: &Domains, function: Function, [x, y]: [F; 2]) -> F {
    let Function::Curve { curve, order } = function else { return elementary::value(function, [x, y]) };
    let at = domains.curves.get(usize::from(curve)).zip(x.to_f64());
    let value = at.and_then(|(spline, x)| F::from(spline.jet(x)[usize::from(order)]));
    value.unwrap_or_else(F::nan)
}

/// The derivatives by both operands, where the function has this value.
pub fn slopes(domains: &Domains, function: Function, operands: [f64; 2], value: f64) -> [f64; 2] {
    match function {
        Function::Curve { order: Function::LAST_ORDER.., .. } => [0.0, 0.0],
        Function::Curve { curve, order } => {
            [self::value(domains, Function::curve(usize::from(curve), order + 1), operands), 0.0]
        }
        function => elementary::slopes_at(function, operands, value),
    }
}
