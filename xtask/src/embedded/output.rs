//! What the firmware prints, read.

/// The lines of a program.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Output {
    pub(crate) runs: Vec<Run>,
    pub(crate) counts: Vec<Count>,
    /// Instructions that a thousand instructions were counted as.
    pub(crate) thousand: Option<u32>,
    /// Bytes of the simulator.
    pub(crate) ram: Option<u32>,
    /// Bytes of the painted stack that were used.
    pub(crate) stack: Option<u32>,
    /// Ticks that took longer than they may.
    pub(crate) overruns: Option<u32>,
}

/// The bits that a run ended with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Run {
    pub(crate) precision: String,
    pub(crate) name: String,
    /// Of all states on the way.
    pub(crate) digest: u64,
    /// The first three joint positions, the bits of a number each.
    pub(crate) joints: [u64; 3],
}

impl Run {
    /// A joint position.
    pub(crate) fn joint(&self, index: usize) -> f64 {
        let bits = self.joints[index];
        if self.precision == "f64" {
            return f64::from_bits(bits);
        }
        // Of an f32 they are the low half.
        u32::try_from(bits).map_or(f64::NAN, |bits| f64::from(f32::from_bits(bits)))
    }
}

/// Instructions of a piece of work over a run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Count {
    pub(crate) precision: String,
    pub(crate) scene: String,
    pub(crate) form: String,
    pub(crate) work: String,
    pub(crate) least: u32,
    pub(crate) mean: u32,
    pub(crate) most: u32,
}

impl Output {
    /// Reads all lines; those that say where the gimbal is are for people.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut output = Self::default();
        for line in text.lines() {
            output.line(line).ok_or_else(|| format!("what does this mean: {line}"))?;
        }
        Ok(output)
    }

    fn line(&mut self, line: &str) -> Option<()> {
        let words: Vec<&str> = line.split_whitespace().collect();
        match *words {
            ["run", precision, ref name @ .., digest, a, b, c] => {
                let bits = |word: &str| u64::from_str_radix(word, 16).ok();
                let joints = [bits(a)?, bits(b)?, bits(c)?];
                let (precision, name) = (precision.to_owned(), name.join(" "));
                self.runs.push(Run { precision, name, digest: bits(digest)?, joints });
            }
            ["count", precision, scene, form, work, least, mean, most] => {
                let [precision, scene, form, work] = [precision, scene, form, work].map(str::to_owned);
                let number = |word: &str| word.parse().ok();
                let (least, mean, most) = (number(least)?, number(mean)?, number(most)?);
                self.counts.push(Count { precision, scene, form, work, least, mean, most });
            }
            ["thousand", value] => self.thousand = Some(value.parse().ok()?),
            ["ram", value] => self.ram = Some(value.parse().ok()?),
            ["stack", value] => self.stack = Some(value.parse().ok()?),
            ["overruns", value] => self.overruns = Some(value.parse().ok()?),
            ["end"] | [] => {}
            [_, "ms", "alpha", ..] => {}
            _ => return None,
        }
        Some(())
    }

    pub(crate) fn count(&self, precision: &str, scene: &str, form: &str, work: &str) -> Option<&Count> {
        self.counts.iter().find(|c| {
            (c.precision.as_str(), c.scene.as_str(), c.form.as_str(), c.work.as_str())
                == (precision, scene, form, work)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read_whole_or_not_at_all() {
        let text = "run f32 paper maximal d0143077ef1a83f8 000000003dcd15aa 00000000b7883789 0000000042c80012
count f64 paper joint step 481 550 551
thousand 1000
100 ms alpha 10203 beta -337 phi 10000014 beta rate 33903
end
";
        let output = Output::parse(text).unwrap();
        assert_eq!((output.runs.len(), output.thousand), (1, Some(1000)));
        assert_eq!(output.runs[0].name, "paper maximal");
        assert!((output.runs[0].joint(0) - 0.100_138_98).abs() < 1e-7);
        assert_eq!(output.count("f64", "paper", "joint", "step").unwrap().most, 551);
        assert!(Output::parse("run f32 paper maximal failed").is_err());
        assert!(Output::parse("hard fault").is_err());
    }
}
