use super::*;
use crate::{Coordinates, Correction, Integrator, When};

const AWKWARD: [f64; 7] = [0.1, -1.0 / 3.0, 5e-324, -0.0, f64::MAX, 1e-300, 0.300_000_000_000_000_04];

#[test]
fn a_request_comes_back_bit_by_bit() {
    for correct_every in [None, Some(5e-4)] {
        let request = Request {
            settings: Settings { t_end: 0.1 + 0.2, step: 1e-4, correct_every, sample_every: 1.0 / 3.0 },
            approach: Approach {
                integrator: Integrator::Dop853,
                tolerance: correct_every.map(|every: f64| every / 3.0),
                coordinates: Coordinates::Joint,
                correction: Correction::Baumgarte(AWKWARD[0]),
                when: correct_every.map(When::Violation),
                budget: correct_every.map(|_| 7),
                patience: correct_every,
                examine: correct_every.is_some(),
            },
            parameters: vec![1.0 / 7.0],
            start: Start {
                positions: AWKWARD.to_vec(),
                velocities: AWKWARD[..6].to_vec(),
                turn_references: vec![AWKWARD[1]],
                angles: vec![],
                inputs: vec![
                    Input { index: 1, rows: vec![[0.0, AWKWARD[2]], [AWKWARD[0], AWKWARD[4]]] },
                    Input { index: 0, rows: vec![] },
                ],
                observed_bodies: vec![0, 12],
            },
            measure_for: correct_every.map(|every| 3.0 * every),
        };
        assert_eq!(Request::parse(&request.to_text()).unwrap(), request);
    }
}

#[test]
fn replies_come_back_bit_by_bit() {
    let coordinates = vec![
        JointSample::Angle { position: AWKWARD[0], rate: AWKWARD[1] },
        JointSample::Length { position: AWKWARD[5], rate: AWKWARD[3] },
        JointSample::Orientation { position: [0.5; 4], rate: [AWKWARD[2]; 3] },
    ];
    let sample = Sample {
        t: 0.1 + 0.2,
        coordinates,
        outputs: vec![AWKWARD[4], AWKWARD[3]],
        bodies: vec![BodySample { pose: AWKWARD, velocity: [AWKWARD[6]; 6] }],
        kinetic: 1.0,
        potential: -2.0 / 3.0,
        work: -0.0,
        position_violation: 1e-17,
        velocity_violation: 0.0,
        norm_violation: 1e-18,
        chart_switches: 7,
    };
    let summary =
        Summary { steps: 10_000, chart_switches: 32, smallest_pivot: Some(0.5), ..Default::default() };
    let first = Passage { t: AWKWARD[0], pivot: AWKWARD[4], owner: Some(Owner::Driver(3)) };
    let passed = Summary {
        statistics: Statistics { passages: 2, first_passage: Some(first), ..Statistics::default() },
        ..summary
    };
    for reply in [
        Reply::Sample(sample),
        Reply::Linear(Linear {
            t: AWKWARD[0],
            state: AWKWARD[..2].to_vec(),
            slope: AWKWARD[2..4].to_vec(),
            by_state: AWKWARD[1..5].to_vec(),
            by_inputs: vec![AWKWARD[6]; 2],
        }),
        Reply::Stopped(AWKWARD[0], AWKWARD[1..4].to_vec()),
        Reply::Progress(0.25),
        Reply::Timed(Timing {
            measured: Measured { runs: 9, seconds: AWKWARD[1], ratio: AWKWARD[6] },
            statistics: Statistics { accepted: 3, fastest_rate: AWKWARD[4], ..Statistics::default() },
        }),
        Reply::Done(passed),
        Reply::Done(summary),
        Reply::Forecast(Forecast { steps: 1e12, seconds: AWKWARD[0] }),
        Reply::Failed("at t = 1 s the end".to_owned()),
        Reply::Refused("a budget of 0 steps".to_owned()),
    ] {
        assert_eq!(Reply::parse(&reply.to_line()).unwrap(), reply);
    }
}

#[test]
fn other_lines_are_refused() {
    for line in ["", "sample", "sample 1 2", "progress 1 2", "done 1", "thread 'main' panicked"] {
        assert_eq!(Reply::parse(line), Err(Garbled(line.to_owned())));
    }
    assert_eq!(Request::parse("positions 1 x"), Err(Garbled("positions 1 x".to_owned())));
}
