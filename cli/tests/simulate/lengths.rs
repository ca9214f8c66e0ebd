//! Links whose free length is a formula, against equations that are integrated here.

use crate::laws::{RUNS, SLIDER, end, integrated, run};
use crate::support::{Folder, json};
use std::fs;

/// A winch between the mast at (−0.2, 0.9, 0) and the cart of 2 kg.
const WINCH: &str = "[[state]]\nname = \"memory\"\nrate = \"rail rate - memory\"\nstart = 0.3\n\
    [[force]]\nname = \"winch\"\nkind = \"link\"\nfirst = { body = \"ground\", point = [-0.2, 0.9, 0] }\n\
    second = { body = \"cart\" }\nstiffness = \"2*k\"\n\
    free_length = \"0.5 + u*sin(2*t) + 0.2*memory - 0.1*rail*tip.vx\"\ndamping = 0.7\ntension = \"3*length rate\"\n\
    [[output]]\nname = \"tip\"\nkind = \"velocity\"\nbody = \"cart\"\n\
    [[output]]\nname = \"pull\"\nkind = \"link\"\nforce = \"winch\"\n";

fn page(link: &str) -> String {
    SLIDER.replacen("[[body]]", "[parameters]\nk = 20\n[inputs]\nu = 0.1\n[[body]]", 1) + link
}

/// The length of the link and its rate, of a cart at x.
fn line(x: f64, v: f64) -> [f64; 2] {
    let length = (x + 0.2).hypot(0.9);
    [length, (x + 0.2) * v / length]
}

fn pull([x, m]: [f64; 2], v: f64, t: f64) -> f64 {
    let [length, rate] = line(x, v);
    40.0 * (length - 0.5 - 0.1 * (2.0 * t).sin() - 0.2 * m + 0.1 * x * v) + 3.7 * rate
}

/// The second coordinate is the state, whose rate is `v − m`.
#[test]
fn links_with_a_free_length_by_formula_pull_as_their_equation_does() {
    let [[x, m], [v, _]] = integrated([[0.5, 0.3], [-0.2, -0.5]], 1.5, |[x, m], [v, dm], t| {
        let acceleration = -pull([x, m], v, t) * (x + 0.2) / line(x, v)[0] / 2.0;
        [acceleration, acceleration - dm]
    });
    let stiff: &[&str] = &["--integrator", "rodas4", "--tolerance", "1e-10"];
    for options in RUNS.into_iter().chain([stiff]) {
        let run = run(&page(WINCH), options, "1.5");
        let [found, rate, drift] = end(&run);
        assert!(
            (found - x).abs() < 1e-8 && (rate - v).abs() < 1e-8,
            "{options:?}: {found} {rate}, not {x} {v}"
        );
        assert!(drift.abs() < 1e-8, "{options:?}: {drift}");
        let told = &run["outputs"]["pull"];
        let [force, length] = [0, 1].map(|k| told[k].as_f64().unwrap());
        assert!((force + pull([x, m], v, 1.5)).abs() < 1e-6, "{options:?}: {force}");
        assert!((length - line(x, v)[0]).abs() < 1e-8, "{options:?}: {length}");
    }
}

/// A free length that does not vary is the stored spring, and the same by an input moves in the same way.
#[test]
fn an_input_as_the_free_length_does_work() {
    let link = "[[force]]\nname = \"winch\"\nkind = \"link\"\nfirst = { body = \"ground\", point = [-0.2, 0.9, 0] }\n\
        second = { body = \"cart\" }\nstiffness = 40\nfree_length = ";
    let [stored, worked] =
        ["0.1", "\"u\""].map(|length| run(&page(&format!("{link}{length}\n")), RUNS[0], "1"));
    let [stored_end, worked_end] = [&stored, &worked].map(end);
    assert!((stored_end[0] - worked_end[0]).abs() < 1e-9, "{stored_end:?} {worked_end:?}");
    let folder = Folder::new("lengths");
    fs::write(folder.0.join("page.toml"), page(&format!("{link}\"0.1 + 0*t\"\n"))).unwrap();
    let energies = json(&folder, &["page.toml", "--t-end", "1"]);
    assert!(energies["energy_drift"].as_f64().unwrap().abs() < 1e-6);
}
