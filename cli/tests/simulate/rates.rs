//! How fast formulas change along a motion, against closed forms: a pendulum, from which a cart is seen below it.

use crate::support::{Folder, simulate};
use std::fs;

/// A bob of 2 kg at 1 m, with 0.5 kg·m² about its mass centre, and a cart that goes to and fro below it.
const PAGE: &str = "format = 1\nname = \"rates\"\ngravity = [0, 0, -9.81]\n[inputs]\nu = 2\n[[body]]\nname = \"ground\"\n\
    fixed = true\n[[body]]\nname = \"cart\"\nposition = [0, 0, -2]\n\
    driven = { translation = [{ sinusoid = { amplitude = 0.1, angular_frequency = 3 } }, 0, 0] }\n[[body]]\nname = \"bob\"\nmass = 2\n\
    inertia = [0.3, 0.5, 0.4]\n[[joint]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0, 1, 0]\nzero = [1, 0, 0]\n\
    first = { body = \"ground\" }\nsecond = { body = \"bob\", point = [-1, 0, 0] }\nangle = 0.4\nrate = 0.7\n\
    [[output]]\nname = \"seen\"\nkind = \"relative\"\nfirst = { body = \"bob\" }\nsecond = { body = \"cart\" }\n\
    [[output]]\nname = \"speed\"\nkind = \"rate\"\nof = \"hinge\"\n\
    [[output]]\nname = \"acceleration\"\nkind = \"rate\"\nof = \"hinge rate\"\n\
    [[output]]\nname = \"of_seen\"\nkind = \"rate\"\nof = \"u*seen.vx*seen.z + sin(seen.wy)*t\"\n\
    [[output]]\nname = \"sum\"\nkind = \"formula\"\nof = \"of_seen - u*acceleration\"\n";

const FORMS: [&[&str]; 3] = [
    &["--coordinates", "joint"],
    &["--coordinates", "maximal"],
    &["--coordinates", "maximal", "--engine", "assembled"],
];

/// All is a formula of the same sample: what is left is rounding, and how well constraints are kept.
const EXACT: f64 = 1e-10;

#[test]
fn rates_of_formulas_are_those_of_their_closed_forms() {
    for form in FORMS {
        let folder = Folder::new("rates");
        fs::write(folder.0.join("page.toml"), PAGE).unwrap();
        let options = ["page.toml", "--t-end", "2", "--tolerance", "1e-12", "--out", ".", "--input", "u=3"];
        let output = simulate(&folder, &[&options[..], form].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let table = fs::read_to_string(folder.0.join("rates.csv")).unwrap();
        let mut lines = table.lines();
        let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
        let mut n_rows = 0;
        for line in lines {
            let row: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
            let at = |name: &str| {
                row[heads.iter().position(|head| head.starts_with(&format!("{name} ["))).unwrap()]
            };
            let (t, w) = (at("t"), at("hinge rate"));
            let turn = 2.0 * 9.81 * at("hinge").cos() / 2.5;
            // The cart at C, by the bob's axes e: x = C·e_x - 1 and z = C·e_z, with e_x' = -w e_z and e_z' = w e_x.
            let (sine, cosine) = at("hinge").sin_cos();
            let along = |c: [f64; 2]| [c[0] * cosine - c[1] * sine, c[0] * sine + c[1] * cosine];
            let [to_x, z] = along([0.1 * (3.0 * t).sin(), -2.0]);
            let [drift_x, drift_z] = along([0.3 * (3.0 * t).cos(), 0.0]);
            let [pull_x, _] = along([-0.9 * (3.0 * t).sin(), 0.0]);
            let (vx, vz) = (drift_x - w * z, drift_z + w * to_x);
            let change = pull_x - w * drift_z - turn * z - w * vz;
            let of_seen = 3.0 * (change * z + vx * vz) - w.cos() * turn * t - w.sin();
            let expected =
                [("speed", w), ("acceleration", turn), ("of_seen", of_seen), ("sum", of_seen - 3.0 * turn)];
            for (name, expected) in expected {
                let found = at(name);
                assert!((found - expected).abs() < EXACT, "{form:?} {name} at {t}: {found}, not {expected}");
            }
            n_rows += 1;
        }
        assert!(n_rows > 20, "{n_rows} samples");
    }
}
