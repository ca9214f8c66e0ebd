use super::*;

const SETTINGS: Settings = Settings { t_end: 1.0, step: 1e-3, correct_every: None, sample_every: 0.1 };

#[test]
fn what_cannot_be_done_is_refused_in_words() {
    let controlled =
        Approach { integrator: Integrator::Dop853, tolerance: Some(1e-9), ..Approach::default() };
    let joint = Approach { coordinates: Coordinates::Joint, ..Approach::default() };
    let loops = Offers { joint_space: false, ..Offers::ALL };
    let assembled = Offers { derivatives: false, ..loops };
    let single = Offers { epsilon: f64::from(f32::EPSILON), ..Offers::ALL };
    let tolerance = |tolerance| Approach { tolerance: Some(tolerance), ..controlled };
    let stiff = Approach { integrator: Integrator::Rodas4, ..controlled };
    for (offers, approach, words) in [
        (Offers::ALL, tolerance(f64::NAN), "a tolerance of NaN cannot be met"),
        (Offers::ALL, tolerance(0.0), "a tolerance of 0e0 cannot be met"),
        (Offers::ALL, tolerance(1e10), "a tolerance of 1e10 cannot be met"),
        (single, tolerance(1e-9), "a tolerance of 1e-9 cannot be met"),
        (Offers::ALL, Approach { integrator: Integrator::Rk4, ..controlled }, "rk4 has no error"),
        (loops, joint, "joint coordinates are for"),
        (loops, Approach { correction: Correction::ClosedForm, ..controlled }, "the closed form is for"),
        (assembled, stiff, "rodas4 needs derivatives"),
        (
            Offers::ALL,
            Approach { correction: Correction::Baumgarte(20.0), ..stiff },
            "rodas4 has the derivatives of",
        ),
        (Offers::ALL, Approach { budget: Some(0), ..controlled }, "a budget of 0 steps"),
    ] {
        let found = offers.refusal(&SETTINGS, &approach).unwrap_or_default();
        assert!(found.starts_with(words), "{approach}: {found}");
    }
    for approach in [controlled, joint, stiff, tolerance(1.0), tolerance(1e-15)] {
        assert_eq!(Offers::ALL.refusal(&SETTINGS, &approach), None, "{approach}");
    }
}
