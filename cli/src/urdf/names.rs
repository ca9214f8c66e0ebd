//! Names of the robot as names of a model file.

/// Makes names in `snake_case`, each only once.
#[derive(Debug, Default)]
pub(super) struct Names {
    taken: Vec<String>,
    /// Names that had to change: as they were and as they are.
    pub(super) changed: Vec<(String, String)>,
}

/// Characters that are kept of a name: what is made of it, as `_upper_stop`, has room in the hundred of a model file.
const LONGEST: usize = 80;

impl Names {
    /// The name in the model file of something with this name in the file.
    pub(super) fn name(&mut self, written: &str) -> String {
        let name = self.made(&snake_case(written));
        if name != written {
            self.changed.push((written.to_owned(), name.clone()));
        }
        name
    }

    /// The name of something that is made besides; with a number if it is taken.
    pub(super) fn made(&mut self, plain: &str) -> String {
        let mut name = plain.to_owned();
        let mut number = 2;
        while self.taken.contains(&name) {
            name = format!("{plain}_{number}");
            number += 1;
        }
        self.taken.push(name.clone());
        name
    }
}

/// A lowercase letter, then lowercase letters, digits and underscores.
pub(super) fn snake_case(written: &str) -> String {
    let mut name = String::new();
    let mut before = '_';
    for c in written.chars() {
        let starts_word = c.is_ascii_uppercase() && before.is_ascii_lowercase();
        if (starts_word || !c.is_ascii_alphanumeric()) && !name.is_empty() && !name.ends_with('_') {
            name.push('_');
        }
        if c.is_ascii_alphanumeric() {
            name.push(c.to_ascii_lowercase());
        }
        before = c;
    }
    name.truncate(LONGEST);
    let name = name.trim_end_matches('_');
    if name.starts_with(|c: char| c.is_ascii_lowercase()) { name.to_owned() } else { format!("a{name}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_in_snake_case_and_differ() {
        let mut names = Names::default();
        for (written, expected) in [
            ("base_link", "base_link"),
            ("Shoulder-Pan", "shoulder_pan"),
            ("wristRoll2", "wrist_roll2"),
            ("LEFT arm", "left_arm"),
            ("left.arm", "left_arm_2"),
            ("2nd", "a2nd"),
            ("", "a"),
            ("__x__", "x"),
            ("\u{fc}ber-\u{394}/x", "ber_x"),
            (&"x".repeat(200), &"x".repeat(80)),
        ] {
            assert_eq!(names.name(written), expected, "{written}");
        }
        assert_eq!(names.changed.len(), 9);
    }
}
