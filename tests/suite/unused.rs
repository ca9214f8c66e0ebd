//! What a model does not use costs nothing: text that others add to a model file leaves no trace in what it does not
//! concern, and what contacts add is what is said of them.

use gyro_codegen::{Effort, Functions};
use gyro_sim_suite::page;

fn code(name: &str, text: &str) -> String {
    let model = gyro_model::read(name, text).expect("it is a model file");
    gyro_codegen::generate_by_effort(name, &model, &Functions::of_solvers(), Effort::Quick)
        .expect("it can be generated")
        .code
}

/// A page, its first joint and its first body that moves.
const PAGES: [(&str, &str); 3] =
    [("compound-pendulum", "pivot"), ("four-bar", "crank_pivot"), ("gyroscope-coulomb", "alpha")];

#[test]
fn events_leave_no_trace() {
    for (name, joint) in PAGES {
        let text = page(name);
        let event = format!(
            "\n[[event]]\nname = \"passes\"\nof = \"{joint}\"\nlevel = 0.1\n[[event]]\nname = \"turns\"\nof = \"{joint} rate\"\n"
        );
        assert!(
            code(name, &text) == code(name, &(text.clone() + &event)),
            "{name}: events change its module"
        );
    }
}

/// A mass on a rail with a spring and a pendulum that hangs on it.
const CART: &str = r#"format = 1
name = "cart"
gravity = [0, -9.81, 0]
[[body]]
name = "ground"
fixed = true
[[body]]
name = "cart"
mass = 2
inertia = [0.1, 0.1, 0.1]
[[body]]
name = "bob"
mass = 1
inertia = [0.01, 0.02, 0.03]
[[joint]]
name = "rail"
kind = "prismatic"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = "ground" }
second = { body = "cart" }
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 0, 1]
zero = [0, -1, 0]
first = { body = "cart" }
second = { body = "bob", point = [0, 0.3, 0] }
angle = 0.5
[[force]]
name = "spring"
kind = "spring"
joint = "rail"
stiffness = 5
"#;

const ON_THE_RAIL: &str =
    "[[contact]]\nname = \"ends\"\njoint = \"rail\"\nlower = -1\nupper = 1\nrestitution = 0.5\n";
const MOTOR: &str =
    "[[force]]\nname = \"ends\"\nkind = \"motor\"\njoint = \"rail\"\nvalue = \"ends\"\n[inputs]\nends = 0\n";

/// Stops and levels of friction are the run's: the module has a motor whose value is an input, and nothing more.
#[test]
fn a_contact_is_a_motor_whose_value_is_an_input() {
    let motor = code("cart", &format!("{CART}{MOTOR}"));
    for more in ["", "friction = 0.1\n", "friction = 0.1\nstatic_friction = 0.2\n"] {
        assert!(motor == code("cart", &format!("{CART}{ON_THE_RAIL}{more}")), "`{more}` changes the module");
    }
    assert!(motor != code("cart", CART), "a motor is to be seen");
}

/// Friction in proportion to a reaction adds an output, that reaction.
#[test]
fn friction_by_a_reaction_is_an_output() {
    let output = "[[output]]\nname = \"ends\"\nkind = \"reaction\"\njoint = \"rail\"\n";
    let contact = code("cart", &format!("{CART}{ON_THE_RAIL}friction_coefficient = 0.1\n"));
    assert!(contact == code("cart", &format!("{CART}{MOTOR}{output}")));
    // An output that is there already serves.
    let named = output.replace("ends", "felt");
    let both = format!("{CART}{ON_THE_RAIL}friction_coefficient = 0.1\n{named}");
    assert!(code("cart", &both) == code("cart", &format!("{CART}{MOTOR}{named}")));
}

/// About an axis a contact also counts turns, which only maximal coordinates have to: what joint coordinates integrate
/// is that of the motor.
#[test]
fn in_joint_coordinates_a_contact_about_an_axis_is_a_motor() {
    let on_the_hinge = |text: &str| text.replace("\"rail\"", "\"hinge\"");
    let contact = code("cart", &format!("{CART}{}", on_the_hinge(ON_THE_RAIL)));
    let motor = code("cart", &format!("{CART}{}", on_the_hinge(MOTOR)));
    let derivative = |code: &str| {
        let from = code.find("fn joint_derivative").expect("it is there");
        let rest = &code[from..];
        rest[..rest[1..].find("\n    fn ").map_or(rest.len(), |end| end + 1)].to_owned()
    };
    assert_eq!(derivative(&contact), derivative(&motor));
    assert!(contact != motor, "the turn reference is to be seen");
}
