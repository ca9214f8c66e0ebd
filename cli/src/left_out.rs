//! What a model file says of a run, and code that is made of the mechanism alone does not do.

use crate::{contacts, remarks};
use gyro_model::Model;

/// Each thing that is left out, and what of it is the caller's to do.
pub(crate) fn left_out(model: &Model) -> Vec<String> {
    let names = |inputs: &[usize]| {
        let named = inputs.iter().map(|&input| format!("`{}`", model.inputs[input].name));
        named.collect::<Vec<_>>().join(", ")
    };
    let controllers = model.controllers.iter().map(|of| {
        format!("controller `{}`: what it sets, {}, is the caller's to set", of.name, names(&of.inputs))
    });
    let contacts = contacts::contacts(model);
    let contacts = contacts.iter().enumerate().map(|(n, of)| {
        let name = contacts::name(model, n);
        format!("contact `{name}`: its forces, {}, are inputs, the caller's to set", names(of.inputs()))
    });
    let events = model.events.iter().map(|of| {
        let does = if of.stops { "nothing ends there" } else { "nothing is told of it" };
        format!("event `{}`: {does}", of.name)
    });
    let followed = model.followed_inputs();
    let followed = followed.iter().map(|(name, inputs)| {
        format!("the curve that `{name}` follows: the caller sets {} so that they fit", names(inputs))
    });
    controllers.chain(contacts).chain(events).chain(followed).collect()
}

/// Says so.
pub(crate) fn tell(model: &Model, what: &str) {
    left_out(model).iter().for_each(|words| remarks::warn(&format!("{what} leaves out {words}")));
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = r#"
format = 1
name = "cart"
inputs = { push = 0, road = 0 }
body = [
    { name = "ground", fixed = true },
    { name = "cart", mass = 1, inertia = [1, 1, 1] },
    { name = "rider", mass = 1, inertia = [1, 1, 1] },
]
joint = [
    { name = "slide", kind = "prismatic", axis = [1, 0, 0], zero = [0, 1, 0], first = { body = "ground" }, second = { body = "cart" } },
    { name = "lift", kind = "prismatic", axis = [0, 1, 0], zero = [1, 0, 0], first = { body = "cart" }, second = { body = "rider" } },
]
driver = [{ name = "axle", joint = "lift", motion = "road" }]
force = [{ name = "motor", kind = "motor", joint = "slide", value = "push" }]
controller = [
    { name = "loop", kind = "pid", outputs = ["slide"], inputs = ["push"], frequency_hz = 100, kp = 1, setpoint = 1 },
]
event = [
    { name = "end", of = "slide", level = 1, stop = true },
    { name = "turn", of = "slide rate" },
]
contact = [{ name = "buffer", joint = "slide", lower = -1, restitution = 0.5 }]
"#;

    #[test]
    fn all_of_it_is_named() {
        let model = gyro_model::read("cart.toml", PAGE).unwrap();
        let said = left_out(&model);
        let named = [
            "`loop`: what it sets, `push`",
            "`buffer`: its forces, ",
            "`end`: nothing ends",
            "`turn`: ",
            "`axle` follows: the caller sets `road`, ",
        ];
        assert_eq!(said.len(), named.len(), "{said:?}");
        for (words, part) in said.iter().zip(named) {
            assert!(words.contains(part), "{part}: {words}");
        }
    }
}
