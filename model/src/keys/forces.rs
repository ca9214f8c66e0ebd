//! Forces. A kind is its law and its keys: what acts along a joint coordinate x, on its second body and in the opposite
//! sense on its first, and what acts on points of bodies.

use super::{
    KIND, Key, ON_COORDINATE, ON_JOINT, POINT, Table, kind, name, number, orientation, reference, strength,
    strengths, table, vector, word,
};
use crate::Seen;

const STIFFNESS: Key = number("stiffness", "N.m/rad or N/m", "").required();
const DAMPING: Key = strength("damping", "N.m.s/rad or N.s/m", "").not_negative(DRIVES);
const DRIVES: &str = "it would drive the motion";
const SIDES: &[(&str, &str)] = &[("lower", ""), ("upper", "")];

/// What a link's own formula calls the distance of its ends, and the rate of that.
const LENGTHS: &[(&str, Seen)] = &[("length", Seen::Length), ("length rate", Seen::LengthRate)];

/// What a bushing's own formulas call its readings, and their rates.
const READINGS: &[(&str, Seen)] = &[
    ("x", Seen::Between(0)),
    ("y", Seen::Between(1)),
    ("z", Seen::Between(2)),
    ("angle_x", Seen::Between(3)),
    ("angle_y", Seen::Between(4)),
    ("angle_z", Seen::Between(5)),
    ("x rate", Seen::BetweenRate(0)),
    ("y rate", Seen::BetweenRate(1)),
    ("z rate", Seen::BetweenRate(2)),
    ("angle_x rate", Seen::BetweenRate(3)),
    ("angle_y rate", Seen::BetweenRate(4)),
    ("angle_z rate", Seen::BetweenRate(5)),
];

/// `[[force]]`.
pub static FORCE: Table = Table::new(
    "force",
    "A force besides gravity and the joints' own damping.",
    &[name("name"), KIND],
)
.of_kinds(&[
    kind(
        "spring",
        "−`stiffness` · (x − `free`)",
        &[ON_JOINT, ON_COORDINATE, STIFFNESS, number("free", "rad or m", "where it is relaxed").or("0")],
    ),
    kind("damper", "−`damping` · ẋ", &[ON_JOINT, ON_COORDINATE, DAMPING.required()]),
    kind(
        "coulomb",
        "−`level` · tanh(ẋ / `rate`): dry friction, made smooth",
        &[
            ON_JOINT,
            ON_COORDINATE,
            strength("level", "N.m or N", "").not_negative(DRIVES).required(),
            number("rate", "rad/s or m/s", "at which friction reaches 76 % of its level")
                .positive("friction would jump where the velocity changes sign")
                .required()
                .eg("rate = ..., in rad/s or m/s, where friction reaches 76 % of its level"),
        ],
    ),
    kind(
        "stop",
        "−`stiffness` · ρ(z) − `damping` · σ(z) · ẋ with z = x − `limit`, see below",
        &[
            ON_JOINT,
            ON_COORDINATE,
            number("limit", "rad or m", "").required(),
            word("side", SIDES, "which way is blocked").required(),
            STIFFNESS.positive("the stop would exert no force"),
            DAMPING.or("0"),
            number("softness", "rad or m", "the width over which it sets in")
                .positive("the force of the stop would jump")
                .required()
                .eg("softness = ..., in rad or m: the distance over which the force of the stop builds up"),
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
                .eg("value = ..., in N.m or N, or an input"),
        ],
    ),
    kind(
        "link",
        "−`stiffness` · (l − `free_length`) − `damping` · l̇ − `tension` between two points at the distance l",
        &[
            table("first", &FORCE_END, "a table of `body` and `point`").required(),
            table("second", &FORCE_END, "likewise").required(),
            number("stiffness", "N/m", "it, `damping` or `tension` must be there")
                .eg("stiffness = ..., in N/m, damping = ..., in N.s/m, or tension = ..., in N")
                .or("0"),
            strength("damping", "N.s/m", "").not_negative(DRIVES).or("0"),
            strength("free_length", "m", "of a formula, or an input, the spring does work and stores nothing")
                .not_negative("lengths cannot be negative")
                .or("required with `stiffness`"),
            strength("tension", "N", "what it pulls besides: a formula may name `length` and `length rate`")
                .naming(LENGTHS)
                .or("0"),
        ],
    ),
    kind(
        "bushing",
        "−`stiffness` · u − `damping` · u̇ + `force` along each axis of the first frame, and the like about the angles \
         between the frames, see below",
        &[
            table("first", &BUSHING_END, "a table of `body`, `point` and `orientation`").required(),
            table("second", &BUSHING_END, "likewise").required(),
            vector("stiffness", "N/m", "of x, y and z; one of the six must be there")
                .eg("stiffness = [...], in N/m, or another of its strengths")
                .or("[0, 0, 0]"),
            strengths("damping", "N.s/m", "").naming(READINGS).not_negative(DRIVES).or("[0, 0, 0]"),
            strengths("force", "N", "what is added: a formula may name the readings and their rates")
                .naming(READINGS)
                .or("[0, 0, 0]"),
            vector("torsion", "N.m/rad", "of `angle_x`, `angle_y` and `angle_z`").or("[0, 0, 0]"),
            strengths("torsional_damping", "N.m.s/rad", "")
                .naming(READINGS)
                .not_negative(DRIVES)
                .or("[0, 0, 0]"),
            strengths("torque", "N.m", "what is added, likewise").naming(READINGS).or("[0, 0, 0]"),
            strengths("moment", "N.m", "torque by the axes of the first frame, likewise")
                .naming(READINGS)
                .or("[0, 0, 0]"),
        ],
    ),
    kind(
        "load",
        "a force at a point of a body and a torque on it, constant in a frame",
        &[
            reference("body", ""),
            POINT,
            strengths("force", "N", "it or `torque` must be there")
                .eg("force = [0, 0, 0], in N, or torque = [0, 0, 0], in N.m")
                .or("[0, 0, 0]"),
            strengths("torque", "N.m", "").or("[0, 0, 0]"),
            word("frame", &[("global", ""), ("body", "")], "").or("\"global\""),
        ],
    ),
    kind(
        "potential",
        "−∂`energy`/∂x along each joint coordinate x that the formula names; the energy is stored",
        &[strength("energy", "J", "a formula of joint coordinates").required().eg("energy = \"...\", in J")],
    ),
    kind(
        "dissipation",
        "−½ ∂`power`/∂ẋ along each joint coordinate whose rate ẋ the formula names",
        &[strength("power", "W", "a formula of rates: if it is quadratic in them, the power that is lost")
            .required()
            .eg("power = \"...\", in W")],
    ),
]);

/// `first` and `second` of a link.
pub static FORCE_END: Table =
    Table::new("end of a link", "A point of a body.", &[reference("body", "name of the body"), POINT]);

/// `first` and `second` of a bushing, and of an output of two frames.
pub static BUSHING_END: Table = Table::new(
    "frame",
    "A frame of a body.",
    &[
        reference("body", "name of the body"),
        POINT,
        orientation("Euler parameters of the frame's axes").or("the body's axes"),
    ],
);
