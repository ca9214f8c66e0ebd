//! Ready elements: what each may be told. What it stands for is in `prelude.toml`.

use super::{
    BUSHING_END, COUPLER_END, FORCE_END, KIND, Key, Kind, ON_COORDINATE, ON_JOINT, POINT, Table, kind, name,
    number, orientation, reference, strength, strengths, table, tables_of, vector, word,
};

const SIDES: &[(&str, &str)] = &[("lower", ""), ("upper", "")];
const LOSES: &str = "it would drive the motion";
const FIRST: Key = table("first", &FORCE_END, "a table of `body` and `point`").required();
const SECOND: Key = table("second", &FORCE_END, "likewise").required();
const STIFFNESS: Key = number("stiffness", "N/m", "").positive("it would exert no force").required();
const DAMPING: Key = number("damping", "N.s/m", "").not_negative(LOSES).or("0");
const LENGTH: Key = strength("free_length", "m", "beyond which it pulls: a formula winds it up").required();
const LEVEL: Key = strength("level", "N.m or N", "of sliding").not_negative(LOSES).required();
const STATIC: Key = strength("static_level", "N.m or N", "of breaking away").not_negative(LOSES).required();
const STRIBECK: Key =
    number("stribeck_rate", "rad/s or m/s", "at which friction has come down from the one to the other")
        .positive("friction would jump")
        .required();
const VISCOUS: Key = number("viscous", "N.m.s/rad or N.s/m", "").not_negative(LOSES).or("0");

/// The first key that an element of a kind has to have and that it lacks.
pub(crate) fn lacking(kind: &Kind, has: impl Fn(&'static str) -> bool) -> Option<&'static str> {
    let is_of_either = kind.key("closed").is_some();
    let is_needed = |key: &Key| match key.name {
        "joint" if is_of_either => !has("first"),
        "first" | "second" | "closed" if is_of_either => !has("joint"),
        _ => key.is_required,
    };
    kind.keys.iter().filter(|key| is_needed(key)).map(|key| key.name).find(|name| !has(name))
}

/// `[[element]]`.
pub static ELEMENT: Table = Table::new(
    "element",
    "A ready element: forces, states and outputs that belong together.",
    &[name("name, with which the names of its parts begin"), KIND],
)
.of_kinds(&[
    kind(
        "dc_motor",
        "a motor on direct current that turns a joint through a gear: L i̇ = `voltage` − R i − k N ẋ and the torque \
         k N i, times the efficiency of the gear when it drives and over it when it is driven; state `NAME_current`",
        &[
            ON_JOINT,
            ON_COORDINATE,
            strength("voltage", "V", "usually an input").required(),
            number("resistance", "ohm", "R").positive("the current would have no bound").required(),
            number("inductance", "H", "L").positive("the current would jump").required(),
            number("constant", "N.m/A or V.s/rad", "k").not_zero("it would exert no torque").required(),
            number("ratio", "", "N: turns of the motor for one of the joint").or("1"),
            number("efficiency", "", "of the gear, up to 1").positive("nothing would come through").or("1"),
        ],
    ),
    kind(
        "cylinder",
        "a hydraulic cylinder along a joint coordinate x, or between two points at the distance `closed` + x, its valve \
         on a pump and a tank: the pressure of each chamber has the rate `bulk_modulus` · (flow − area · ẋ) / volume, a flow through the open valve is `valve` · `opening` \
         · √(difference of pressures), and the force is p_a · `area` − p_b · `rod_area`; states `NAME_pressure_a` and \
         `NAME_pressure_b`, between points an output `NAME_line`",
        &[
            Key { is_required: false, ..ON_JOINT }.or("between points"),
            ON_COORDINATE,
            Key { is_required: false, ..FIRST }.or("along a joint"),
            Key { is_required: false, ..SECOND }.or("along a joint"),
            number("closed", "m", "the distance of its points at x = 0").positive("").or("along a joint"),
            strength("opening", "", "of the valve, from −1 (retract) to 1 (extend), usually an input").required(),
            number("supply", "Pa", "pressure of the pump").positive("").required(),
            number("tank", "Pa", "pressure of the tank").or("0"),
            number("valve", "m3/s/Pa^0.5", "flow for the root of a pressure, wide open").positive("").required(),
            number("area", "m2", "of the piston, in chamber a, which extends").positive("").required(),
            number("rod_area", "m2", "of the piston less the rod, in chamber b").positive("").required(),
            number("stroke", "m", "from x = 0, where chamber a has its least volume").positive("").required(),
            number("dead_volume", "m3", "of either chamber at its least, with its hose")
                .positive("pressures would have no bound")
                .required(),
            number("bulk_modulus", "Pa", "of the oil").positive("").or("1400000000"),
            number("leakage", "m3/s/Pa", "from one chamber to the other").not_negative("").or("0"),
            number("pressure", "Pa", "in both chambers at the start").or("0"),
        ],
    ),
    kind(
        "propeller",
        "`thrust` · n · abs(n) along `axis`, and the torque −`torque` · n · abs(n) about it, on a body, n being the speed",
        &[
            reference("body", "name of the body"),
            POINT,
            vector("axis", "", "in the body's frame, of any length").or("[0, 0, 1]"),
            strength("speed", "rad/s", "an input, or the rate of a joint").required(),
            number("thrust", "N.s2", "negative for one that pushes when it turns backwards").required(),
            number("torque", "N.m.s2", "").not_negative(LOSES).or("0"),
        ],
    ),
    kind(
        "tyre",
        "a wheel that yields on a plane, as a law: it is pushed by `stiffness` · δ + `damping` · δ̇ where it is lower than \
         the plane by δ, never pulled; its slip s along and its slip across follow the velocity u with which it slips by \
         `relaxation` · ṡ = −u − abs(v) s, v the velocity of its centre along, and the forces are the slip stiffnesses \
         times these, F/√(1 + (F/(`friction_coefficient` N))²) together; states `NAME_slip_along` and \
         `NAME_slip_across`, outputs `NAME_normal`, `NAME_along` and `NAME_across`",
        &[
            SURFACE,
            ON_IT,
            number("radius", "m", "from its axis to the plane, unloaded").positive("nothing would roll").required(),
            AXIS,
            number("stiffness", "N/m", "").positive("it would exert no force").required(),
            number("damping", "N.s/m", "").not_negative(LOSES).or("0"),
            number("along_stiffness", "N", "force along for a slip of 1").not_negative(LOSES).required(),
            number("across_stiffness", "N", "force across for a slip of 1, or 1 rad").not_negative(LOSES).required(),
            number("relaxation", "m", "way over which slip builds up").positive("slip would jump").required(),
            number("friction_coefficient", "", "").positive("it would not hold").or("1"),
        ],
    ),
    kind(
        "drag",
        "−½ `density` · `area` · `coefficient` · abs(v) v at a point of a body, v its velocity less that of the wind; \
         output `NAME_air`",
        &[
            reference("body", "name of the body"),
            POINT,
            number("area", "m2", "").positive("").required(),
            number("coefficient", "", "").not_negative(LOSES).required(),
            number("density", "kg/m3", "of what it moves through").not_negative(LOSES).or("1.225"),
            strengths("wind", "m/s", "").or("[0, 0, 0]"),
        ],
    ),
    kind(
        "wire",
        "pulls with `stiffness` · (l − `free_length`) + `damping` · l̇ where two points are further apart than its \
         free length, and never pushes",
        &[FIRST, SECOND, STIFFNESS, DAMPING, LENGTH],
    ),
    kind(
        "rope",
        "a wire through several points, over pulleys without friction, which pulls alike at all of them by its whole \
         length; links `NAME_1`, `NAME_2` and so on from each point to the next",
        &[
            tables_of(&FORCE_END, "points", "at least two tables of `body` and `point`").required(),
            STIFFNESS,
            DAMPING,
            LENGTH,
        ],
    ),
    kind(
        "shaft",
        "a torsional spring and damper between two joint coordinates: −`stiffness` · z − `damping` · ż along z = \
         second − `ratio` · first − `free`; the energy is stored",
        &[
            table("first", &COUPLER_END, "a table of `joint` and, if it has several, `coordinate`").required(),
            table("second", &COUPLER_END, "likewise").required(),
            number("stiffness", "N.m/rad", "").positive("it would exert no torque").required(),
            number("damping", "N.m.s/rad", "").not_negative(LOSES).or("0"),
            number("ratio", "", "").or("1"),
            number("free", "rad", "").or("0"),
        ],
    ),
    kind(
        "ball_spring",
        "a torsional spring and damper about the Cardan angles of a spherical joint: a bushing at its place",
        &[
            ON_JOINT,
            number("stiffness", "N.m/rad", "").not_negative("").or("0"),
            number("damping", "N.m.s/rad", "").not_negative(LOSES).or("0"),
            orientation("Euler parameters: how the second body is turned against the first where it is relaxed")
                .or("as the first"),
        ],
    ),
    kind(
        "impact",
        "the law of Hunt and Crossley at a limit: `stiffness` · δ^`exponent` · (1 + `damping` · δ̇) against what is \
         beyond the limit by δ, and never a pull; that of Hertz without damping",
        &[
            ON_JOINT,
            ON_COORDINATE,
            number("limit", "rad or m", "").required(),
            word("side", SIDES, "which way is blocked").required(),
            number("stiffness", "N/m^exponent", "").positive("it would exert no force").required(),
            number("exponent", "", "1.5 for a ball").positive("the force would jump").or("1.5"),
            number("damping", "s/m or s/rad", "").not_negative(LOSES).or("0"),
        ],
    ),
    kind(
        "stribeck",
        "−(`level` + (`static_level` − `level`) · exp(−(ẋ / `stribeck_rate`)²)) · tanh(ẋ / `rate`) − `viscous` · ẋ",
        &[
            ON_JOINT,
            ON_COORDINATE,
            LEVEL,
            STATIC,
            STRIBECK,
            number("rate", "rad/s or m/s", "at which friction reaches 76 % of its level")
                .positive("friction would jump where the velocity changes sign")
                .required(),
            VISCOUS,
        ],
    ),
    kind(
        "lugre",
        "friction by bristles: ż = ẋ − `bristle_stiffness` · abs(ẋ) / g · z with g the level of Stribeck, and the force \
         −`bristle_stiffness` · z − `bristle_damping` · ż − `viscous` · ẋ; state `NAME_bristles`",
        &[
            ON_JOINT,
            ON_COORDINATE,
            LEVEL,
            STATIC,
            STRIBECK,
            number("bristle_stiffness", "N.m/rad or N/m", "").positive("nothing would hold").required(),
            number("bristle_damping", "N.m.s/rad or N.s/m", "").not_negative(LOSES).or("0"),
            VISCOUS,
        ],
    ),
]);

const SURFACE: Key = table(
    "first",
    &BUSHING_END,
    "the surface: a table of `body`, `point` and `orientation`; a plane is the frame's x-y plane, z points away from it, \
     the centre of a sphere is the frame's origin, the axis of a cylinder its z axis",
)
.required();
const ON_IT: Key =
    table("second", &FORCE_END, "what rolls: a table of `body` and of its centre, `point`").required();
const RADIUS: Key = number("radius", "m", "").positive("nothing would roll").required();
const OUTER: Key = number("outer", "m", "radius of the surface").positive("there would be none").required();
const GRIPS: &[(&str, &str)] = &[
    ("both", "it does not slip"),
    ("along", "it slips across"),
    ("across", "it slips along"),
    ("none", "it slides without friction"),
];
const GRIP: Key = word("grip", GRIPS, "in which directions it does not slip").or("\"both\"");
const AXIS: Key = vector("axis", "", "of the body's frame, about which it is round").or("[0, 1, 0]");

/// `[[rolling]]`.
pub static ROLLING: Table = Table::new(
    "rolling",
    "A body that touches a surface and rolls on it: rows of positions and of velocities.",
    &[name("name, with which the names of its parts begin"), KIND],
)
.of_kinds(&[
    kind(
        "disc",
        "a wheel with a sharp rim on a plane; along is where it rolls, across is along its axis",
        &[SURFACE, ON_IT, RADIUS, AXIS, GRIP],
    ),
    kind(
        "torus",
        "a wheel with a round rim on a plane, likewise",
        &[
            SURFACE,
            ON_IT,
            number("radius", "m", "from its axis to the centre of the rim").positive("").required(),
            number("rim", "m", "radius of the rim").positive("it would be a disc").required(),
            AXIS,
            GRIP,
        ],
    ),
    kind("sphere", "a ball on a plane; along is x of the surface, across is y", &[SURFACE, ON_IT, RADIUS, GRIP]),
    kind(
        "cylinder",
        "a roller that touches a plane along a line; along is where it rolls, across is along its axis; that it does not \
         slip in either keeps it from turning about the normal, too",
        &[SURFACE, ON_IT, RADIUS, AXIS, GRIP],
    ),
    kind(
        "ellipsoid",
        "an ellipsoid on a plane; along is x of the surface, across is y",
        &[
            SURFACE,
            Key { value: super::Value::Table(&BUSHING_END), ..ON_IT },
            vector("semi_axes", "m", "half of its length along x, y and z of its frame")
                .positive("it would have no volume")
                .required(),
            GRIP,
        ],
    ),
    kind(
        "skate",
        "an edge on a plane, at a point of the body; along is where it points",
        &[
            SURFACE,
            ON_IT,
            vector("axis", "", "of the body's frame, along the edge").or("[1, 0, 0]"),
            word("grip", GRIPS, "in which directions it does not slip").or("\"across\""),
        ],
    ),
    kind(
        "sphere_in_sphere",
        "a ball in a hollow sphere; along and across are x and y of the surface at its lowest point, where z is normal",
        &[SURFACE, ON_IT, RADIUS, OUTER, GRIP],
    ),
    kind(
        "sphere_on_sphere",
        "a ball on a sphere; along and across are x and y of the surface at its top, where z is normal",
        &[SURFACE, ON_IT, RADIUS, OUTER, GRIP],
    ),
    kind(
        "sphere_in_cylinder",
        "a ball in a hollow cylinder; along is the cylinder's axis, across is around it",
        &[SURFACE, ON_IT, RADIUS, OUTER, GRIP],
    ),
    kind("sphere_on_cylinder", "a ball on a cylinder, likewise", &[SURFACE, ON_IT, RADIUS, OUTER, GRIP]),
]);

/// How shapes touch: what `[[contact]]` between bodies comes to. Their first is the surface that is touched.
pub(crate) static SURFACES: Table = Table::new("contact", "A pair of shapes.", &[]).of_kinds(&[
    kind("points", "points of a body, or balls about them, on a plane", super::CONTACT.keys),
    kind("ellipsoid", "an ellipsoid on a plane", super::CONTACT.keys),
    kind("rims", "round rims on a plane", super::CONTACT.keys),
    kind("on_sphere", "a ball on a ball", super::CONTACT.keys),
    kind("on_capsule", "a ball on a capsule", super::CONTACT.keys),
    kind("on_cylinder", "a ball on a cylinder", super::CONTACT.keys),
    kind("on_box", "a ball on a box", super::CONTACT.keys),
    kind("capsules", "a capsule on a capsule", super::CONTACT.keys),
]);
