use crate::expr::schedule::Operations;
use crate::groups::Functions;
use crate::kernels::Kernels;
use gyro_program::Kernel;

/// Sines and cosines of angles between axes that are rational.
const SKEW: [[i32; 3]; 7] =
    [[0, 1, 1], [3, 4, 5], [5, 12, 13], [8, 15, 17], [7, 24, 25], [20, 21, 29], [12, 35, 37]];
const RIGHT: [[i32; 3]; 7] = [[0, 1, 1], [-1, 0, 1], [1, 0, 1], [1, 0, 1], [-1, 0, 1], [1, 0, 1], [1, 0, 1]];

/// An arm on the ground whose first frame is on the first axis, in Denavit and Hartenberg's parameters as Khalil
/// and Kleinfinger modified them: angles between axes, distances along their normals and along themselves. Bodies
/// have mass centres and inertias in general position.
fn arm(angles: &[[i32; 3]], normals: &[f64], along: &[f64]) -> String {
    let mut page = "format = 1\nname = \"arm\"\ngravity = [0, 0, -9.81]\n\
                    [[body]]\nname = \"b0\"\nfixed = true\n"
        .to_owned();
    let mut centre = [0.0; 3];
    for (k, [sine, cosine, unit]) in angles.iter().map(|angle| angle.map(f64::from)).enumerate() {
        let n = k as f64;
        let place = [normals[k], -along[k] * sine / unit, along[k] * cosine / unit];
        let point = [0, 1, 2].map(|k| place[k] - centre[k]);
        centre = [0.03 + 0.02 * n, 0.05 - 0.03 * n, 0.1 - 0.01 * n];
        let (mass, [x, y, z]) = (5.0 - 0.6 * n, centre.map(|c| -c));
        let inertia = [0.05 + 0.001 * n, 0.06 + 0.002 * n, 0.04 + 0.001 * n];
        page += &format!(
            "[[body]]\nname = \"b{}\"\nmass = {mass}\ninertia = {{ xx = {}, yy = {}, zz = {}, \
             xy = 0.003, xz = -0.002, yz = 0.001 }}\n[[joint]]\nname = \"j{k}\"\nkind = \"revolute\"\n\
             first = {{ body = \"b{k}\", point = {point:?}, axis = [0, {}, {cosine}], zero = [1, 0, 0] }}\n\
             second = {{ body = \"b{}\", point = [{x}, {y}, {z}], axis = [0, 0, 1], zero = [1, 0, 0] }}\n",
            k + 1,
            inertia[0],
            inertia[1],
            inertia[2],
            -sine,
            k + 1,
        );
    }
    page
}

/// Of some functions of a mechanism that has those of a group.
fn operations(page: &str, group: &str, wanted: [Kernel; 2]) -> [Operations; 2] {
    let model = gyro_model::read("page.toml", page).unwrap_or_else(|error| panic!("{error}\n{page}"));
    let (start, functions) = (model.assemble().expect("a start"), Functions::named([group]));
    let asked = (crate::Elimination::NullSpace, &functions.expect("a group"), crate::Effort::Full);
    let mut equations = crate::equations(&model, asked, &start);
    let mut kernels = Kernels::of(&equations);
    kernels.finish(&mut equations.graph, equations.passes);
    wanted.map(|kernel| Operations::count(&equations.graph, kernels.roots(kernel)))
}

/// The published count is 92 n − 127 products and 81 n − 117 sums (W. Khalil and E. Dombre, *Modeling,
/// Identification and Control of Robots* (2002)).
#[test]
fn inverse_dynamics_of_a_general_arm_takes_less_than_is_published() {
    let page = arm(&SKEW[..6], &[0.0, 0.11, 0.42, 0.07, 0.13, 0.05], &[0.0, 0.23, 0.09, 0.31, 0.17, 0.12]);
    let [inverse, bias] = operations(&page, "inverse", [Kernel::InverseDynamics, Kernel::BiasForces]);
    assert!(inverse.multiplications <= 381 && 381 < 92 * 6 - 127, "{inverse}");
    assert!(inverse.additions <= 318 && 318 < 81 * 6 - 117, "{inverse}");
    assert!(bias.total() < inverse.total(), "{bias}");
}

/// An arm of right angles and offsets as they are sold.
#[test]
fn derivatives_of_seven_joints_take_five_times_what_the_accelerations_take() {
    let page =
        arm(&RIGHT, &[0.0, 0.0, 0.0, 0.0825, -0.0825, 0.0, 0.088], &[0.0, 0.0, 0.316, 0.0, 0.384, 0.0, 0.0]);
    let [forward, accelerations] =
        operations(&page, "derivatives", [Kernel::ForwardDerivatives, Kernel::JointAccelerations]);
    assert!(forward.total() <= 5 * accelerations.total(), "{forward} against {accelerations}");
}
