//! Chains of bodies with skewed axes, of any length: what generation and solves are measured on.

use std::fmt::Write as _;

/// Axes of the joints and directions across them, in turn: none parallel or at right angles to the next.
const AXES: [([i32; 3], [i32; 3]); 3] =
    [([1, 2, 2], [2, 1, -2]), ([2, -1, 2], [2, 2, -1]), ([-2, 1, 2], [2, 2, 1])];

/// The model file of a chain that hangs from the ground, its joints askew, at angles and rates.
pub fn model_file(bodies: usize) -> String {
    let mut text = format!(
        "format = 1\nname = \"chain_{bodies}\"\ngravity = [0, 0, -9.81]\n\n[[body]]\nname = \"base\"\nfixed = true\n"
    );
    for link in 1..=bodies {
        let _ =
            write!(text, "\n[[body]]\nname = \"link_{link}\"\nmass = 0.5\ninertia = [2e-3, 3e-3, 4e-3]\n");
    }
    for link in 1..=bodies {
        let before = if link == 1 { "base".to_owned() } else { format!("link_{}", link - 1) };
        let (axis, zero) = AXES[link % AXES.len()];
        let (angle, rate) = (0.1 * ((link % 5) as f64 + 1.0), 0.3 * ((link % 7) as f64 - 2.5));
        let _ = write!(
            text,
            "\n[[joint]]\nname = \"hinge_{link}\"\nkind = \"revolute\"\naxis = {axis:?}\nzero = {zero:?}\nfirst = {{ body = \
             \"{before}\", point = [0.02, -0.01, -0.1] }}\nsecond = {{ body = \"link_{link}\", point = [-0.01, 0.02, 0.1] }}\nangle = \
             {angle:.1}\nrate = {rate:.2}\n"
        );
    }
    text
}
