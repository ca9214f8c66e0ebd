//! Studies of models with rigid stops, and with drivers along straight lines.

use super::{Folder, ran, rows};
use std::fs;

/// A body on a rail, which is thrown at a stop, and one on a cart that jerks.
const MODEL: &str = "format = 1\nname = \"thrown\"\n[parameters]\nrestitution = 0.5\n[[body]]\nname = \"ground\"\n\
    fixed = true\n[[body]]\nname = \"cart\"\nmass = 1\ninertia = [1, 1, 1]\n[[joint]]\nname = \"rail\"\n\
    kind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = { body = \"ground\" }\n\
    second = { body = \"cart\" }\n[[driver]]\nname = \"belt\"\njoint = \"rail\"\n\
    motion = { table = \"saw.csv\", between = \"linear\" }\n[[body]]\nname = \"rider\"\nmass = 1\ninertia = [1, 1, 1]\n\
    [[joint]]\nname = \"slide\"\nkind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\n\
    first = { body = \"cart\" }\nsecond = { body = \"rider\" }\nrate = 1\n[[contact]]\nname = \"end\"\njoint = \"slide\"\n\
    upper = 0.4\nrestitution = \"restitution\"\n";

#[test]
#[ignore = "compiles programs"]
fn scenarios_hit_stops_and_follow_kinks() {
    let folder = Folder::new();
    fs::write(folder.0.join("thrown.toml"), MODEL).unwrap();
    // From rest on, at a quarter of a second, forwards at a quarter of a metre a second.
    fs::write(folder.0.join("saw.csv"), "t,x\n0,0\n0.25,0\n1.25,0.25\n").unwrap();
    let study = folder.0.join("study.toml");
    let text = "format = 1\nmodel = \"thrown.toml\"\nscenarios = 40\n\
        run = { t_end = 1, coordinates = \"joint\", tolerance = 1e-9, integrator = \"dop853\" }\n\
        keep = { final = [\"slide\", \"slide rate\"], estimate = true }\n\
        vary = [{ parameter = \"restitution\", uniform = [0, 1.25] }, { start = \"slide rate\", uniform = [0.75, 1.5] }]\n";
    fs::write(&study, text).unwrap();
    ran(&[study.to_str().unwrap(), "--out", folder.0.join("out").to_str().unwrap()]);
    let found = rows(&folder.0.join("out/scenarios.csv"));
    let (mut possible, mut impossible) = (0, 0);
    for row in &found {
        let (restitution, rate, last) = (row[1], row[2], &row[3..6]);
        if restitution > 1.0 {
            assert!(last.iter().all(|number| number.is_nan()), "{row:?}");
            impossible += 1;
            continue;
        }
        // On the cart the jerk takes a quarter off its rate.
        let slower = rate - 0.25;
        let hit = 0.25 + (0.4 - 0.25 * rate) / slower;
        let [place, left] = if hit < 1.0 {
            [0.4 - restitution * slower * (1.0 - hit), -restitution * slower]
        } else {
            [0.25 * rate + 0.75 * slower, slower]
        };
        let error = (last[0] - place).abs().max((last[1] - left).abs());
        assert!(error < 1e-12 && last[2] < 1e-9, "{row:?}: {place} {left}");
        possible += 1;
    }
    assert!(possible > 20 && impossible > 3, "{possible} {impossible}");
}
