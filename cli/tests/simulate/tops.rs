//! Tops that turn over and turn back, and a wheel on a tyre: bodies that touch, against what is conserved, equations
//! integrated here and a closed form.

use crate::rolling::kutta;
use crate::rolling_bodies::{EXACT, FORMS, near, number, told};
use crate::support::{Folder, json, model};
use crate::touching::{V, cross, dot, run};

/// A tippe top: a ball whose mass centre is not in its middle. What pushes and drags it at its lowest point leaves
/// Jellett's constant as it is, its angular momentum times the way from its mass centre to that point; and it turns
/// over.
#[test]
fn a_tippe_top_turns_over() {
    let (r, off, across, about): (f64, f64, f64, f64) = (0.02, 0.002, 9e-7, 8e-7);
    let constant = |seen: [f64; 18]| {
        let (axis, spin) = ([seen[5], seen[8], seen[11]], [seen[15], seen[16], seen[17]]);
        let own = (about - across) * dot(axis, spin);
        let turning: V = std::array::from_fn(|k| across * spin[k] + own * axis[k]);
        let down: V = std::array::from_fn(|k| off * axis[k] - if k == 2 { r } else { 0.0 });
        dot(turning, down)
    };
    let ends = ["1e-6", "1.5", "3"].map(|t_end| {
        let folder = Folder::new("tippe-top");
        let page = model("../examples/contact/tippe_top.toml");
        told::<18>(
            &json(&folder, &[&page, "--no-prove", "--t-end", t_end, "--tolerance", "1e-12"]),
            "foot_seen",
        )
    });
    let constants = ends.map(constant);
    for later in &constants[1..] {
        assert!((later / constants[0] - 1.0).abs() < 1e-9, "{constants:?}");
    }
    assert!(ends[0][11] > 0.99 && ends[2][11] < -0.5, "{ends:?}");
}

/// A rattleback: spun the wrong way it begins to rock, stops and
/// turns back. With u the vertical and r from the mass centre to where it touches, both by its own axes,
/// `(I + m (r² − r rᵀ)) ω̇ = −ω × I ω + m r × (ṙ × ω + ω × (r × ω) + g u)` and `u̇ = u × ω`.
#[test]
fn a_rattleback_turns_back() {
    let semi: V = [0.2, 0.03, 0.02];
    let (g, high, inertia) = (9.81, 0.01, [[2e-4, -2e-5, 0.0], [-2e-5, 1.6e-3, 0.0], [0.0, 0.0, 1.7e-3]]);
    let times = |m: [V; 3], v: V| m.map(|row| dot(row, v));
    let slope = |[w0, w1, w2, u0, u1, u2]: [f64; 6]| {
        let (w, u): (V, V) = ([w0, w1, w2], [u0, u1, u2]);
        let turned = cross(u, w);
        let q: V = semi.map(|x| x * x);
        let (qu, h): (V, f64) =
            (std::array::from_fn(|k| q[k] * u[k]), (0..3).map(|k| q[k] * u[k] * u[k]).sum::<f64>().sqrt());
        let r: V = std::array::from_fn(|k| -qu[k] / h + if k == 2 { high } else { 0.0 });
        let growth = dot(qu, turned) / h;
        let moved: V = std::array::from_fn(|k| (-q[k] * turned[k] + qu[k] * growth / h) / h);
        let (one, two) = (cross(moved, w), cross(w, cross(r, w)));
        let pull = cross(r, std::array::from_fn(|k| one[k] + two[k] + g * u[k]));
        let gyro = cross(w, times(inertia, w));
        let right: V = std::array::from_fn(|k| pull[k] - gyro[k]);
        let matrix: [V; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| inertia[i][j] - r[i] * r[j] + if i == j { dot(r, r) } else { 0.0 })
        });
        let [a, b, c] = matrix;
        let det = dot(a, cross(b, c));
        // By the cross products of its rows, which is symmetric.
        let inverse = [cross(b, c), cross(c, a), cross(a, b)];
        let [x, y, z]: V =
            std::array::from_fn(|k| (0..3).map(|i| inverse[i][k] * right[i]).sum::<f64>() / det);
        [x, y, z, turned[0], turned[1], turned[2]]
    };
    let tilt: f64 = 0.01;
    let start = [0.0, 0.0, -5.0, 0.0, tilt.sin(), tilt.cos()];
    // The point of the ellipsoid that touches is below its middle, and the mass centre below that.
    let h = (semi[1] * start[4]).hypot(semi[2] * start[5]);
    let touches = [0.0, -semi[1].powi(2) * start[4] / h, -semi[2].powi(2) * start[5] / h + high];
    let velocity = cross(touches, [0.0, 0.0, -5.0]);
    let (s, c) = (tilt.sin(), tilt.cos());
    // The body is turned by the tilt about x: its y and z have the vertical's parts.
    let global: V = [velocity[0], c * velocity[1] - s * velocity[2], s * velocity[1] + c * velocity[2]];
    let page = format!(
        "format = 1\nname = \"rattleback\"\ngravity = [0, 0, -{g}]\n[[body]]\nname = \"ground\"\nfixed = true\n\
         [[body]]\nname = \"stone\"\nfree = true\nmass = 1\n\
         inertia = {{ xx = 2e-4, yy = 1.6e-3, zz = 1.7e-3, xy = -2e-5 }}\nposition = [0, 0, {:?}]\n\
         orientation = [{:?}, {:?}, 0, 0]\nvelocity = {global:?}\nangular_velocity = [0, 0, -5]\n\
         [[rolling]]\nname = \"rocks\"\nkind = \"ellipsoid\"\nfirst = {{ body = \"ground\" }}\n\
         second = {{ body = \"stone\", point = [0, 0, {high}] }}\nsemi_axes = {semi:?}\n",
        -(s * touches[1] + c * touches[2]),
        (tilt / 2.0).cos(),
        (tilt / 2.0).sin(),
    );
    let expected = kutta(start, 1.0, slope);
    for form in FORMS {
        let run = run("rattleback", &page, &[&["--t-end", "1"], &EXACT[..]].concat(), form);
        let seen: [f64; 18] = told(&run, "rocks_seen");
        // By the body's axes.
        let spin: V = std::array::from_fn(|k| (0..3).map(|i| seen[3 + 3 * i + k] * seen[15 + i]).sum());
        near(spin, [expected[0], expected[1], expected[2]], 1e-8);
        near([seen[9], seen[10], seen[11]], [expected[3], expected[4], expected[5]], 1e-9);
    }
    // It has turned back by then, from where on a small change would have become a large one.
    let run = run("rattleback", &page, &["--t-end", "6"], &[]);
    assert!(kutta(start, 6.0, slope)[2] > 2.0 && told::<18>(&run, "rocks_seen")[17] > 2.0, "{run}");
}

/// A wheel that is towed at an angle: what holds it across builds up over its relaxation length, `F = C tan a
/// (1 − e^(−V t/σ))` where it is far from its limit, and has the limit's part beyond.
#[test]
fn a_tyre_takes_its_way() {
    let (v, angle, relaxation, c): (f64, f64, f64, f64) = (6.0, 0.02, 0.4, 5e4);
    for (mu, t_end) in [(1e9, 0.05), (0.8, 0.2)] {
        // It neither turns nor yields: what slips along is what the wheel does not roll.
        let page = format!(
            "format = 1\nname = \"towed\"\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\nname = \"hub\"\n\
             driven = {{ translation = [{{ polynomial = [0, {v}] }}, 0, 0.29], rotations = [{{ axis = [0, 0, 1], angle = {angle} }}] }}\n\
             [[body]]\nname = \"wheel\"\nmass = 1\ninertia = [0.1, 0.2, 0.1]\n\
             [[joint]]\nname = \"axle\"\nkind = \"revolute\"\naxis = [0, 1, 0]\nzero = [1, 0, 0]\nfirst = {{ body = \"hub\" }}\n\
             second = {{ body = \"wheel\" }}\nrate = {:?}\n\
             [[element]]\nname = \"tyre\"\nkind = \"tyre\"\nfirst = {{ body = \"ground\" }}\nsecond = {{ body = \"wheel\" }}\n\
             radius = 0.3\nstiffness = 2e5\nalong_stiffness = 8e4\nacross_stiffness = {c}\nrelaxation = {relaxation}\n\
             friction_coefficient = {mu}\n",
            v * angle.cos() / 0.3,
        );
        // Along the wheel it moves at V cos a, across at −V sin a.
        let slip = angle.tan() * (1.0 - (-v * angle.cos() * t_end / relaxation).exp());
        let free = c * slip;
        let force = free / (1.0 + (free / (mu * 2000.0)).powi(2)).sqrt();
        for form in FORMS {
            let run = run("tyre", &page, &[&["--t-end", &format!("{t_end}")], &EXACT[..]].concat(), form);
            near([number(&run, "tyre_normal"), number(&run, "tyre_along")], [2000.0, 0.0], 1e-6);
            near([number(&run, "tyre_across")], [force], 1e-6);
        }
    }
}
