//! Forces. A kind is its law and its keys: what acts along a joint coordinate x, on its second body and in the opposite
//! sense on its first, and what acts on points of bodies.

use super::{
    KIND, Key, ON_COORDINATE, ON_JOINT, POINT, Range, Table, Value, kind, name, number, reference, strength,
    table,
};

const STIFFNESS_UNIT: &str = "N.m/rad or N/m";
const DAMPING_UNIT: &str = "N.m.s/rad or N.s/m";
const DRIVES: Range = Range::NotNegative("it would drive the motion");

/// What resists: never negative.
const fn damping(unit: &'static str) -> Key {
    strength("damping", unit, "").within(DRIVES)
}

const fn vector(name: &'static str, unit: &'static str) -> Key {
    Key::new(name, Value::Strengths(unit), "").default("[0, 0, 0]")
}

/// `[[force]]`.
pub static FORCE: Table = Table {
    name: "force",
    meaning: "A force besides gravity and the joints' own damping.",
    keys: &[name("name"), KIND],
    kinds: &[
        kind(
            "spring",
            "−`stiffness` · (x − `free`)",
            &[
                ON_JOINT,
                ON_COORDINATE,
                number("stiffness", STIFFNESS_UNIT, "").required(),
                number("free", "rad or m", "where it is relaxed").default("0"),
            ],
        ),
        kind("damper", "−`damping` · ẋ", &[ON_JOINT, ON_COORDINATE, damping(DAMPING_UNIT).required()]),
        kind(
            "coulomb",
            "−`level` · tanh(ẋ / `rate`): dry friction, made smooth",
            &[
                ON_JOINT,
                ON_COORDINATE,
                strength("level", "N.m or N", "").within(DRIVES).required(),
                number("rate", "rad/s or m/s", "at which friction reaches 76 % of its level")
                    .within(Range::Positive("friction would jump where the velocity changes sign"))
                    .required()
                    .example("rate = ..., in rad/s or m/s, where friction reaches 76 % of its level"),
            ],
        ),
        kind(
            "stop",
            "−`stiffness` · ρ(z) − `damping` · σ(z) · ẋ with z = x − `limit` for an upper stop, mirrored for a lower \
             one; ρ(z) = ½ (z + √(z² + softness²)), σ = ρ'",
            &[
                ON_JOINT,
                ON_COORDINATE,
                number("limit", "rad or m", "").required(),
                Key::new(
                    "side",
                    Value::Word(&[("lower", "blocks below the limit"), ("upper", "blocks above it")]),
                    "`\"lower\"` or `\"upper\"`: which way is blocked",
                )
                .required(),
                number("stiffness", STIFFNESS_UNIT, "")
                    .within(Range::Positive("the stop would exert no force"))
                    .required(),
                damping(DAMPING_UNIT).default("0"),
                number("softness", "rad or m", "the width over which it sets in")
                    .within(Range::Positive("the force of the stop would jump"))
                    .required()
                    .example("softness = ..., in rad or m: the distance over which the force of the stop builds up"),
            ],
        ),
        kind(
            "motor",
            "`value`",
            &[
                ON_JOINT,
                ON_COORDINATE,
                strength("value", "N.m or N", "usually an input")
                    .required()
                    .example("value = ..., in N.m or N, or an input"),
            ],
        ),
        kind(
            "link",
            "−`stiffness` · (l − `free_length`) − `damping` · l̇ along the line between two points at the distance l, \
             which must not vanish (a start with l = 0 is refused)",
            &[
                table("first", &FORCE_END, "an end: a table of `body` and `point`")
                    .required()
                    .example("first = { body = \"...\", point = [0, 0, 0] }"),
                table("second", &FORCE_END, "the other end")
                    .required()
                    .example("second = { body = \"...\", point = [0, 0, 0] }"),
                number("stiffness", "N/m", "it or `damping` must be there")
                    .default("0")
                    .example("stiffness = ..., in N/m, or damping = ..., in N.s/m"),
                damping("N.s/m").default("0"),
                number("free_length", "m", "length at which it is relaxed")
                    .within(Range::NotNegative("lengths cannot be negative"))
                    .default("required with `stiffness`"),
            ],
        ),
        kind(
            "load",
            "a force at a point of a body and a torque on it, constant in a frame",
            &[
                reference("body", "the body"),
                Key { meaning: "", ..POINT },
                Key {
                    meaning: "it or `torque` must be there",
                    example: "force = [0, 0, 0], in N, or torque = [0, 0, 0], in N.m",
                    ..vector("force", "N")
                },
                vector("torque", "N.m"),
                Key::new(
                    "frame",
                    Value::Word(&[("global", "the global frame"), ("body", "the body's own frame")]),
                    "or `\"body\"`: the frame in which it is constant",
                )
                .default("\"global\""),
            ],
        ),
    ],
};

/// `first` and `second` of a link.
pub static FORCE_END: Table = Table {
    name: "end of a link",
    meaning: "A point of a body.",
    keys: &[reference("body", "name of the body"), POINT],
    kinds: &[],
};
