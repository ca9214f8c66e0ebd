//! Names, numbers and motions.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

/// A name: a lowercase letter, then lowercase letters, digits and underscores.
pub(crate) struct Name;

impl JsonSchema for Name {
    fn schema_name() -> Cow<'static, str> {
        "Name".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A lowercase letter, then lowercase letters, digits and underscores.",
            "type": "string",
            "pattern": "^[a-z][a-z0-9_]*$",
            "maxLength": 100,
        })
    }
}

/// A number, the name of a parameter or an input, or an expression.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "a description")]
pub(crate) enum Number {
    /// A number in SI units.
    Number(f64),
    /// A parameter, such as "rod_mass" or "-rod_mass", or an expression, such as "m * length^2 / 12" or "30 deg".
    Text(String),
}

/// A number, or an expression without parameters.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "a description")]
pub(crate) enum Plain {
    /// A number.
    Number(f64),
    /// An expression without parameters, such as "1/3".
    Text(String),
}

/// Three numbers.
pub(crate) type Vector = [Number; 3];

/// Four Euler parameters.
pub(crate) type Orientation = [Number; 4];

/// A motion: a constant, or one form of it.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "a description")]
pub(crate) enum Motion {
    Constant(Number),
    Form(Box<Form>),
}

/// A motion has one of `polynomial`, `sinusoid`, `sum`, `product` and `table`.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 3))]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Form {
    /// `[c0, c1, c2]`: c0 + c1 t + c2 t².
    #[schemars(length(min = 1))]
    polynomial: Option<Vec<Number>>,
    sinusoid: Option<Sinusoid>,
    /// The sum of motions.
    #[schemars(length(min = 1))]
    sum: Option<Vec<Motion>>,
    /// The product of motions.
    #[schemars(length(min = 1))]
    product: Option<Vec<Motion>>,
    /// Name of a CSV file.
    table: Option<String>,
    /// The columns of time and value in the table.
    columns: Option<[String; 2]>,
    /// What is between the rows of the table; `smooth` unless given.
    between: Option<Curve>,
}

/// What joins the rows of a table of a motion.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
pub(crate) enum Curve {
    /// The natural cubic spline.
    Smooth,
    /// Straight lines, on which the velocity jumps at a row.
    Linear,
}

/// amplitude · sin(angular_frequency · t + phase).
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Sinusoid {
    /// rad or m.
    amplitude: Number,
    /// rad/s.
    angular_frequency: Option<Number>,
    /// Hz.
    frequency_hz: Option<Plain>,
    /// rad.
    phase: Option<Number>,
    /// Degrees.
    phase_deg: Option<Plain>,
}
