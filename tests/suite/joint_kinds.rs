//! Each kind of joint by itself: how many freedoms it leaves, and one motion with its reaction against a solution that
//! owes nothing to constraints.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_reference::{
    BaseMotion, Bead, BodyState, Chain, FallingScrew, FallingSpindle, FreeBody, GearedDiscs, HeavyTop, Link,
    Pendulum, PlanarBlock, RodPendulum, Slider,
};
use gyro_runner::{Sample, Settings};
use gyro_sim_suite::{
    Engine, Run, along, as_paged, body, check, check_pairs, cross, generated, model, multipliers, output,
    pair, played, reference_body, simulate, times, worst,
};

/// Coordinates (rad, m) and rates: RK4 at the model files' steps, some ten radians a second over a second or two, is
/// good for this.
const MOTION: f64 = 1e-9;

/// Forces and torques, N and N·m, of order ten: they follow from the motion.
const REACTION: f64 = 1e-8;

/// The same of a top whose bearing bears thousands of newtons.
const REACTION_OF_TOP: f64 = 1e-6;

/// Tolerance on the position of the top, m: the truncation error of the step is below it.
const TOP: f64 = 1e-8;

/// Each model file with its degrees of freedom.
const FREEDOMS: [(&str, usize); 14] = [
    ("pendulum", 1),
    ("weld", 1),
    ("universal", 2),
    ("cylindrical", 2),
    ("prismatic", 1),
    ("planar", 3),
    ("screw", 1),
    ("point-on-line", 4),
    ("rod", 5),
    ("spherical", 3),
    ("gear", 1),
    ("carried-block", 4),
    ("driven-four-bar", 0),
    ("all-joints", 2),
];

/// Positions and rates of the first coordinates.
fn check_coordinates(what: &str, run: &Run, expected: impl Fn(usize) -> Vec<(f64, f64)>) {
    check_pairs(what, run, MOTION, expected);
}

fn check_reaction(name: &str, mechanism: &Engine, run: &Run, expected: impl Fn(usize, &Sample) -> [f64; 6]) {
    check(&format!("{name}: reaction"), run, REACTION, |k, sample| {
        (output(mechanism, sample, "load"), expected(k, sample).to_vec())
    });
}

fn check_body(what: &str, run: &Run, expected: impl Fn(usize) -> BodyState) {
    check(what, run, MOTION, |k, sample| (body(&sample.bodies[0]), reference_body(&expected(k))));
}

#[test]
fn joints_leave_as_many_freedoms_as_they_should() {
    for (page, freedoms) in FREEDOMS {
        let model = model(page);
        assert_eq!(model.degrees_of_freedom(), freedoms, "{page}");
        assert!(model.redundant.is_empty(), "{page}");
    }
}

#[test]
fn revolute() {
    let run = played(&generated("pendulum"), &model("pendulum"));
    let reference = Pendulum::slender_rod().solve(&times(&run));
    check_coordinates("revolute", &run, |k| vec![(reference[k].angle, reference[k].rate)]);
}

#[test]
fn fixed() {
    let mechanism = generated("weld");
    let run = played(&mechanism, &model("weld"));
    let reference = Pendulum::slender_rod().solve(&times(&run));
    check_coordinates("fixed", &run, |k| vec![(reference[k].angle, reference[k].rate)]);
    // Newton and Euler for the outer half, along the rod, across it and about it: 0.6 kg, 0.75 m from the pivot.
    check("fixed: reaction", &run, REACTION, |k, sample| {
        let (angle, rate, turning) = (reference[k].angle, reference[k].rate, reference[k].acceleration);
        let force = [
            0.6 * (-0.75 * rate * rate - 9.81 * angle.cos()),
            0.6 * (0.75 * turning + 9.81 * angle.sin()),
            0.0,
        ];
        let torque = [0.0, 0.0, 0.0125 * turning + 0.25 * force[1]];
        (output(&mechanism, sample, "seam_load"), [force, torque].concat())
    });
}

/// The damping about the universal joint's second axis, N·m·s/rad.
const DAMPING: f64 = 0.05;

#[test]
fn universal() {
    let first = Link { stiffness: 1.5, free: 0.2, start: 0.9, rate: 1.5, ..Link::turning([1.0, 0.0, 0.0]) };
    let second = Link {
        own: [-0.03, 0.02, 0.4],
        mass: 2.0,
        inertia: [0.05, 0.06, 0.03, 0.002, -0.004, 0.003],
        damping: DAMPING,
        start: -0.5,
        rate: 2.0,
        ..Link::turning([0.0, 1.0, 0.0])
    };
    let chain = Chain { gravity: [0.0, 0.0, -9.81], base: BaseMotion::default(), links: [first, second] };
    let mechanism = generated("universal");
    let run = played(&mechanism, &model("universal"));
    let reference = chain.solve(&times(&run));
    check_coordinates("universal", &run, |k| {
        (0..2).map(|axis| (reference[k].positions[axis], reference[k].rates[axis])).collect()
    });
    check_reaction("universal", &mechanism, &run, |k, _| {
        // The first link's reaction is without its own spring, but the damper about the second axis, (0, cos, sin),
        // goes through it.
        let sample = &reference[k];
        let (sin, cos) = sample.positions[0].sin_cos();
        let mut reaction = sample.reactions[0].in_joint_frame([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
        reaction[3] += DAMPING * sample.rates[1] * cos;
        reaction[4] += DAMPING * sample.rates[1] * sin;
        reaction
    });
}

#[test]
fn cylindrical() {
    let reference = FallingSpindle {
        mass: 0.8,
        gravity: 9.81,
        eccentricity: 0.15,
        angle: [0.4, 11.0],
        displacement: [0.5, 2.0],
    };
    let mechanism = generated("cylindrical");
    let run = played(&mechanism, &model("cylindrical"));
    let times = times(&run);
    check_coordinates("cylindrical", &run, |k| reference.at(times[k]).map(pair).to_vec());
    check_reaction("cylindrical", &mechanism, &run, |k, _| {
        let [f, g, h] = reference.reaction(times[k]);
        [f, g, h, 0.0, 0.0, 0.0]
    });
}

#[test]
fn prismatic() {
    let reference = Slider { mass: 1.3, gravity: -5.886, stiffness: 37.0, free: 0.2, start: [0.5, 1.5] };
    let mechanism = generated("prismatic");
    let run = played(&mechanism, &model("prismatic"));
    let times = times(&run);
    check_coordinates("prismatic", &run, |k| vec![pair(reference.at(times[k]))]);
    check_reaction("prismatic", &mechanism, &run, |k, _| {
        // m (r̈ − g) at the mass centre, which lies at −(0.1, 0.05, −0.02) from the point; the spring acts at the
        // point.
        let [.., acceleration] = reference.at(times[k]);
        let total = [0.8 * acceleration, 0.6 * acceleration + 9.81, 0.0].map(|x| 1.3 * x);
        let frame = [[-0.6, 0.8, 0.0], [0.0, 0.0, 1.0], [0.8, 0.6, 0.0]];
        let mut reaction = along(frame, total, cross([-0.1, -0.05, 0.02], total));
        reaction[2] = 0.0;
        reaction
    });
}

#[test]
fn planar() {
    let reference = PlanarBlock {
        gravity: [1.5, -4.0],
        point: [0.2, -0.1],
        start: [0.3, -0.4, 0.7],
        rates: [1.0, 2.0, -6.0],
    };
    let mechanism = generated("planar");
    let run = played(&mechanism, &model("planar"));
    let times = times(&run);
    check_coordinates("planar", &run, |k| reference.at(times[k]).map(pair).to_vec());
    check_reaction("planar", &mechanism, &run, |k, _| {
        let (sin, cos) = reference.at(times[k])[2][0].sin_cos();
        let from_point = [-(cos * 0.2 + sin * 0.1), -(sin * 0.2 - cos * 0.1), -0.05];
        let force = [0.0, 0.0, 0.8 * 8.0];
        let [[fx, fy, fz], [x, y, z]] = [force, cross(from_point, force)];
        [fx, fy, fz, x, y, z]
    });
}

/// Along a skew axis, between two bodies that move, with springs and dampers along three coordinates.
#[test]
fn planar_between_moving_bodies() {
    let before = [0.2, 0.1, 0.1];
    let arm = Link {
        before: [0.1, 0.0, 0.2],
        own: [-0.2, 0.1, 0.0],
        mass: 1.5,
        inertia: [0.3, 0.25, 0.2, 0.02, -0.03, 0.01],
        rate: 2.0,
        ..Link::turning([2.0, -1.0, 2.0])
    };
    let x = Link {
        before,
        damping: 0.8,
        stiffness: 25.0,
        start: 0.05,
        rate: 0.3,
        ..Link::sliding([2.0, 1.0, -2.0])
    };
    let y = Link { stiffness: 40.0, free: 0.05, start: -0.1, rate: 0.2, ..Link::sliding([-2.0, 2.0, -1.0]) };
    let block = Link {
        own: [0.03, 0.05, -0.1],
        mass: 0.6,
        inertia: [0.02, 0.03, 0.025, 0.001, 0.002, -0.003],
        damping: 0.02,
        stiffness: 0.6,
        start: 0.4,
        rate: -3.0,
        ..Link::turning([1.0, 2.0, 2.0])
    };
    let chain = Chain { gravity: [1.0, -9.0, 3.0], base: BaseMotion::default(), links: [arm, x, y, block] };
    let mechanism = generated("carried-block");
    let run = played(&mechanism, &model("carried-block"));
    let reference = chain.solve(&times(&run));
    check_coordinates("planar, carried", &run, |k| {
        (0..4).map(|axis| (reference[k].positions[axis], reference[k].rates[axis])).collect()
    });
    check("planar, carried: reactions", &run, REACTION, |k, sample| {
        let reactions = &reference[k].reactions;
        let [.., h, mf, mg, _] =
            reactions[3].in_joint_frame([2.0, 1.0, -2.0].map(|x| x / 3.0), [1.0, 2.0, 2.0].map(|x| x / 3.0));
        let shoulder = reactions[0]
            .in_joint_frame([1.0, 2.0, 0.0].map(|x| x / 5f64.sqrt()), [2.0, -1.0, 2.0].map(|x| x / 3.0));
        let found = [output(&mechanism, sample, "shoulder_load"), output(&mechanism, sample, "face_load")];
        (found.concat(), [&shoulder[..], &[0.0, 0.0, h, mf, mg, 0.0]].concat())
    });
    check("planar, carried: work", &run, MOTION, |k, sample| {
        (vec![sample.work], vec![reference[k].damping_work])
    });
}

#[test]
fn screw() {
    let reference = FallingScrew { mass: 2.0, inertia: 0.003, gravity: 9.81, lead: 0.02, start: [0.5, 4.0] };
    let mechanism = generated("screw");
    let run = played(&mechanism, &model("screw"));
    let times = times(&run);
    check_coordinates("screw", &run, |k| vec![pair(reference.at(times[k]))]);
    let [force, torque] = reference.reaction();
    check_reaction("screw", &mechanism, &run, |_, _| [0.0, 0.0, force, 0.0, 0.0, torque]);
    assert!(reference.at(2.0)[0].abs() > 10.0, "it turns more than once");
}

fn carried_body() -> FreeBody {
    FreeBody {
        mass: 0.7,
        inertia: [0.02, 0.05, 0.04, 0.0, 0.0, 0.0],
        orientation: [1.0, 0.5, -0.3, 0.2],
        angular_velocity: [3.0, 0.1, -4.0],
    }
}

#[test]
fn point_on_line() {
    let bead =
        Bead { body: carried_body(), line: [1.0, 2.0, -2.0], gravity: [0.3, 0.0, -9.81], start: [0.4, 0.0] };
    let mechanism = generated("point-on-line");
    let run = played(&mechanism, &model("point-on-line"));
    let reference = bead.solve(&times(&run));
    check_coordinates("point on line", &run, |k| {
        let [x, rate] = reference[k].displacement;
        vec![(x, rate)]
    });
    check_body("point on line: body", &run, |k| reference[k].body);
    let frame = [[2.0, 1.0, 2.0], [2.0, -2.0, -1.0], [1.0, 2.0, -2.0]].map(|axis| axis.map(|x| x / 3.0));
    check_reaction("point on line", &mechanism, &run, |k, _| along(frame, reference[k].force, [0.0; 3]));
}

#[test]
fn rod() {
    let pendulum = RodPendulum {
        body: carried_body(),
        gravity: [0.0, 0.0, -9.81],
        position: [0.3, 0.0, -0.4],
        velocity: [0.4, 1.2, 0.3],
    };
    let (mechanism, model) = (generated("rod"), model("rod"));
    let run = played(&mechanism, &model);
    let reference = pendulum.solve(&times(&run));
    check_body("rod: body", &run, |k| reference[k].body);
    check("rod: tension", &run, REACTION, |k, sample| {
        let [x, y, z, mx, my, mz] = output(&mechanism, sample, "load")[..] else { panic!("six numbers") };
        let pull = (x * x + y * y + z * z).sqrt();
        let found = [multipliers(&mechanism, &model, sample)[0], pull, mx, my, mz];
        (found.to_vec(), vec![reference[k].tension, reference[k].tension.abs(), 0.0, 0.0, 0.0])
    });
}

#[test]
fn spherical() {
    let top = HeavyTop {
        mass: 15.0,
        inertia: [0.25, 0.5, 0.375, 0.01, -0.02, 0.03],
        centre: [0.3, 0.5, -0.2],
        gravity: [0.0, 0.0, -9.81],
        orientation: [1.0, 0.0, 0.0, 0.0],
        angular_velocity: [3.0, 20.0, -5.0],
    };
    let mechanism = generated("spherical");
    let run = played(&mechanism, &model("spherical"));
    let reference = top.solve(&times(&run));
    check_body("spherical: body", &run, |k| reference[k].body);
    check("spherical: reaction", &run, REACTION_OF_TOP, |k, sample| {
        let expected = [&reference[k].force[..], &[0.0; 3]].concat();
        (output(&mechanism, sample, "load"), expected)
    });
}

#[test]
fn the_benchmark_top_is_where_it_should_be_after_a_second() {
    let model = model("spinning-top");
    let settings = as_paged(&model, model.simulation.t_end / 20.0);
    // At the model file's own step it is 1.04e-8 m off.
    let settings = Settings { step: settings.step / 2.0, ..settings };
    let run = simulate(&generated("spinning-top"), &model, &settings);
    let reference = HeavyTop::benchmark().solve(&times(&run));
    check("spinning top: centre", &run, TOP, |k, sample| {
        (sample.bodies[0].pose[..3].to_vec(), reference[k].body.position.to_vec())
    });
    let published = [0.1733439641, 0.6400885921, -0.7484907911];
    let error = worst(&run.last().bodies[0].pose[..3], &published);
    println!("spinning top: {error:.1e} m from the published centre");
    assert!(error <= TOP, "{error:e}");
}

#[test]
fn gear() {
    let reference = GearedDiscs {
        inertia: [0.02, 0.05],
        ratio: -2.5,
        offset: 0.3,
        torque: 0.7,
        stiffness: 0.4,
        free: -0.2,
        start: [0.1, 3.0],
    };
    let (mechanism, model) = (generated("gear"), model("gear"));
    let run = played(&mechanism, &model);
    let times = times(&run);
    check_coordinates("gear", &run, |k| reference.at(times[k]).map(pair).to_vec());
    check("gear: multiplier", &run, REACTION, |k, sample| {
        let lambda = multipliers(&mechanism, &model, sample);
        (vec![lambda[10]], vec![reference.multiplier(times[k])])
    });
}

#[test]
fn a_motion_that_is_a_little_wrong_is_noticed() {
    // The check must be able to fail: the rail is a part in a million less steep.
    let reference =
        Slider { mass: 1.3, gravity: -5.886 * (1.0 - 1e-6), stiffness: 37.0, free: 0.2, start: [0.5, 1.5] };
    let run = played(&generated("prismatic"), &model("prismatic"));
    let times = times(&run);
    let wrong = || check_coordinates("prismatic", &run, |k| vec![pair(reference.at(times[k]))]);
    assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(wrong)).is_err());
}
