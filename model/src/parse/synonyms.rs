//! What other programs and formats call things that have another name here: URDF, SDF, MuJoCo's MJCF, Simscape, Adams,
//! Modelica.
//!
//! One word may stand for several of ours; which is meant depends on the keys that are known in its place.

/// Words of others, each with those of ours that it may stand for, the likeliest first.
const WORDS: [(&str, &str); 70] = [
    // Kinds of joint.
    ("hinge pin continuous rotary rotational rotation pivot_joint r", "revolute"),
    ("slide slider sliding translational linear prism p", "prismatic"),
    ("ball ball_joint balljoint ball_and_socket ball_socket socket s", "spherical"),
    ("weld welded rigid lock locked clamp clamped", "fixed"),
    ("cardan hooke u_joint ujoint hinge2 revolute2 u", "universal"),
    ("cylinder c", "cylindrical"),
    ("helical lead_screw leadscrew ball_screw thread", "screw"),
    ("plane ground_plane", "planar"),
    ("inline in_line pin_slot pinslot point_on_curve", "point_on_line"),
    ("distance massless_link strut bar", "rod"),
    // Kinds of force.
    ("torsion torsion_spring rotational_spring elastic compliance", "spring"),
    ("tsda spring_damper springdamper translational_spring tendon cable rope", "link"),
    ("bush mount rubber_mount field force_field spring_6dof", "bushing"),
    ("viscous dashpot viscous_friction", "damper"),
    ("dry_friction stiction frictionloss rubbing", "coulomb"),
    ("end_stop endstop hard_stop limits bumper buffer contact", "stop"),
    ("actuator drive torque_source", "motor"),
    ("wrench external_force point_force gforce applied_force", "load"),
    // Kinds of output.
    ("frame transform pos position location orientation", "pose"),
    ("twist vel speed", "velocity"),
    ("acc accel", "acceleration"),
    ("imu accelerometer gyro gyroscope sensor", "inertial"),
    ("constraint_force joint_force reaction_force", "reaction"),
    // Keys of the model file and of its settings.
    ("g gravitational_acceleration", "gravity"),
    ("gm gravitational_parameter standard_gravitational_parameter", "mu"),
    ("center origin focus", "centre"),
    ("bodies link links rigid_body part", "body"),
    ("joints constraint constraints", "joint"),
    ("forces actuators springs", "force"),
    ("outputs sensors measurements", "output"),
    ("gear gears transmission couplers equality", "coupler"),
    ("drivers motions", "driver"),
    ("params constants variables", "parameters"),
    ("controls signals", "inputs"),
    ("controllers control regulator pid", "controller"),
    ("settings options option solver", "simulation"),
    ("version", "format"),
    ("dt timestep time_step h max_step_size", "step"),
    ("duration end_time stop_time stoptime t_final tend t_stop time", "t_end"),
    ("sample_time output_step dt_out", "sample_every"),
    ("integrator solver algorithm", "method"),
    ("rtol atol reltol abstol accuracy precision", "tolerance"),
    ("stabilization stabilisation projection constraint_correction", "correction"),
    // Keys of bodies.
    ("m weight", "mass"),
    ("i j moi inertia_tensor diaginertia fullinertia moments_of_inertia jg", "inertia"),
    ("static anchored ground grounded is_static", "fixed"),
    ("floating freejoint is_free", "free"),
    ("pos r0 origin xyz location translation", "position point displacement"),
    ("quat quaternion q0 attitude", "orientation"),
    ("vel v v0 linear_velocity", "velocity rate"),
    ("omega w w0 spin ang_vel angular_rate", "angular_velocity rate"),
    ("prescribed motion", "driven motion"),
    // Keys of joints, couplers and drivers.
    ("type class", "kind"),
    ("id label", "name"),
    ("parent base body1 body_1 body_a bodya from joint1", "first"),
    ("child follower body2 body_2 body_b bodyb to joint2", "second"),
    ("anchor location offset site", "point offset"),
    ("direction normal", "axis"),
    ("reference ref_direction x_axis", "zero"),
    ("viscosity viscous_friction b c d", "damping"),
    ("rotor_inertia motor_inertia reflected_inertia", "armature"),
    ("theta phi initial_angle angle_rad", "angle"),
    ("theta_deg initial_angle_deg degrees", "angle_deg"),
    ("thread_pitch screw_thread_pitch", "pitch"),
    ("gear_ratio n multiplier", "ratio"),
    ("initial_rate rate0 speed qd", "rate"),
    // Keys of forces.
    ("k spring_constant rate_constant spring_stiffness", "stiffness"),
    ("rest_length l0 natural_length springlength unstretched_length", "free_length"),
    ("springref spring_reference rest_angle x0", "free"),
    ("tau torque effort amplitude", "value level"),
];

/// The known word that a word of another program stands for.
pub(super) fn meant<'n>(written: &str, known: &[&'n str]) -> Option<&'n str> {
    let written = written.to_lowercase().replace([' ', '-'], "_");
    let meant = WORDS.iter().filter(|(theirs, _)| theirs.split(' ').any(|word| word == written));
    let mut ours = meant.flat_map(|(_, ours)| ours.split(' '));
    ours.find_map(|ours| known.iter().find(|name| **name == ours).copied())
}

/// What to do about a key of others that has no counterpart of the same form in a section that starts with `known`.
pub(super) fn elsewhere(written: &str, known: &[&str]) -> Option<&'static str> {
    let is_body = known.contains(&"inertia");
    let is_joint = known.contains(&"rough");
    let is_end = known.contains(&"zero") && known.contains(&"point") && !is_joint;
    let is_page = known.contains(&"gravity");
    let help = match written.to_lowercase().as_str() {
        "input" if is_page => "inputs are one table: [inputs], with a line such as torque = 0 for each",
        "parameter" | "param" if is_page => {
            "parameters are one table: [parameters], with a line such as length = 0.5 for each"
        }
        "com" | "cog" | "center_of_mass" | "centre_of_mass" | "mass_center" | "cm" if is_body => {
            "remove it: a body's frame has its origin at the mass centre, from where joints' points are measured"
        }
        "rpy" | "euler" | "euler_angles" if is_body || is_end => {
            "rotations are given by Euler parameters, orientation = [e0, e1, e2, e3], or by a joint's `axis` and `zero`"
        }
        "orientation" | "quat" if is_end => "the orientation of an end is given by its own `axis` and `zero`",
        "stiffness" | "springref" if is_joint => "add a [[force]] of kind \"spring\" on this joint",
        "limit" | "limits" | "range" | "lower" | "upper" if is_joint => {
            "add a [[force]] of kind \"stop\" on this joint for each end of its range"
        }
        "torque" | "effort" | "motor" | "actuator" if is_joint => {
            "add a [[force]] of kind \"motor\" on this joint"
        }
        "motion" | "driven" if is_joint => "add a [[driver]] for a coordinate of this joint",
        "gear" | "mimic" if is_joint => "add a [[coupler]] of this joint and another",
        "frictionloss" | "coulomb" if is_joint => "add a [[force]] of kind \"coulomb\" on this joint",
        "joint" | "joints" if is_body => "write a [[joint]] of its own that names this body in `second`",
        "parent" if is_body => "write a [[joint]] that names both bodies, in `first` and `second`",
        _ => return None,
    };
    Some(help)
}

/// What to write instead of a kind that other programs have and that is something else here.
pub(super) fn no_kind(written: &str, what: &str) -> Option<&'static str> {
    let help = match (what, written.to_lowercase().as_str()) {
        (
            "kind of joint",
            "free" | "floating" | "freejoint" | "free_joint" | "6dof" | "six_dof" | "bushing",
        ) => "remove the joint, and write free = true in the body that floats",
        ("kind of joint", "gear" | "gearbox" | "belt" | "rack_and_pinion" | "coupler") => {
            "write a [[coupler]] of two joints' coordinates in place of the joint"
        }
        ("kind of joint", "spring" | "damper" | "motor" | "spring_damper") => {
            "write it as a [[force]] that acts on a joint"
        }
        ("kind of joint", "motion" | "driver" | "actuator") => {
            "write a [[driver]] for a coordinate of a joint"
        }
        ("kind of force", "gravity") => "write gravity = [...] at the top of the model file",
        ("kind of output", "angle" | "rate" | "joint" | "coordinate") => {
            "remove it: joints' coordinates and rates are always among the results"
        }
        _ => return None,
    };
    Some(help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_others_are_understood_where_they_belong() {
        let check = |written: &str, known: &[&str], expected: Option<&str>| {
            assert_eq!(meant(written, known), expected, "{written}");
        };
        check("hinge", &["revolute", "fixed"], Some("revolute"));
        check("Ball", &["revolute", "spherical"], Some("spherical"));
        check("pos", &["mass", "position"], Some("position"));
        check("pos", &["body", "point"], Some("point"));
        check("pos", &["mass"], None);
        check("ball-and-socket", &["spherical"], Some("spherical"));
        check("mass", &["mass"], None);
    }
}
