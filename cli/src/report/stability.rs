//! The stability map: stable steps over a number of the scene, with the limit in theory.

use super::lab::Lab;
use super::limits::{self, Found, Knob, Spectrum};
use crate::failure::Failure;
use gyro_runner::Integrator;

/// The map of an integrator.
#[derive(Clone, Debug)]
pub(crate) struct Map {
    pub(crate) integrator: Integrator,
    pub(crate) columns: Vec<Column>,
}

/// At one value of the scene's number.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    pub(crate) value: f64,
    /// Limit in theory, s.
    pub(crate) theory: Option<f64>,
    pub(crate) found: Found,
}

/// The explicit methods; Rodas has no limit.
const INTEGRATORS: [Integrator; 3] = [Integrator::Rk4, Integrator::Tsit5, Integrator::Dop853];

/// Maps of the explicit methods, and messages about what could not be found.
pub(crate) fn maps(lab: &Lab, knob: Knob, per_decade: u32) -> Result<(Vec<Map>, Vec<String>), Failure> {
    let mut turned = limits::turnable(lab, knob)?;
    let decades = knob.decades();
    let n = (2 * decades * per_decade).max(2);
    let value =
        |k: u32| knob.nominal() * 10f64.powf(f64::from(decades) * (2.0 * f64::from(k) / f64::from(n) - 1.0));
    let mut maps = INTEGRATORS.map(|integrator| Map { integrator, columns: Vec::new() });
    let mut troubles = Vec::new();
    for value in (0..=n).map(value) {
        limits::turn(&mut turned, lab, knob, value);
        let spectrum = match Spectrum::new(&lab.model, knob, value) {
            Ok(spectrum) => spectrum,
            Err(words) => {
                troubles.push(format!("at {}: {words}", crate::words::number(value, 3)));
                continue;
            }
        };
        for map in &mut maps {
            let theory = limits::limit(map.integrator, &spectrum.eigenvalues);
            let guess = theory.unwrap_or(lab.t_end / 20.0).min(lab.t_end);
            match limits::find(&mut turned, map.integrator, spectrum.coordinates, guess) {
                Ok(found) => map.columns.push(Column { value, theory, found }),
                Err(words) => troubles.push(format!(
                    "{} at {}: {words}",
                    map.integrator,
                    crate::words::number(value, 3)
                )),
            }
        }
    }
    Ok((maps.into(), troubles))
}
