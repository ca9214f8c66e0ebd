use super::*;
use crate::motion::Element;
use crate::{
    BodySample, Controller, Coordinates, Correction, End, Input, Integrator, JointSample, Kink, Levels, Line,
    Seen, Stay, Stop, Touch, Watch, What, When, Wiring,
};
use crate::{Formula, Operation, Path};
use gyro_sim::Elementary;
use gyro_sim::{JointPlace, Owner, Passage, Statistics};
use gyro_yardstick::Measured;

const AWKWARD: [f64; 7] = [0.1, -1.0 / 3.0, 5e-324, -0.0, f64::MAX, 1e-300, 0.300_000_000_000_000_04];

fn again<T: SerBin + DeBin>(value: &T) -> T {
    let mut text = Vec::new();
    write(&mut text, value).unwrap();
    read(&mut &text[..]).unwrap().unwrap()
}

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
                leaves_stiff: correct_every.is_none(),
                meets_knots: correct_every.is_none(),
            },
            parameters: vec![1.0 / 7.0],
            start: Start {
                positions: AWKWARD.to_vec(),
                velocities: AWKWARD[..6].to_vec(),
                states: vec![AWKWARD[2]],
                turn_references: vec![AWKWARD[1]],
                angles: vec![],
                knots: vec![AWKWARD[3]],
                inputs: vec![
                    Input::new(1, vec![[0.0, AWKWARD[2]], [AWKWARD[0], AWKWARD[4]]], crate::Between::Smooth),
                    Input::new(0, vec![], crate::Between::Held),
                ],
                observed_bodies: vec![0, 12],
                controllers: vec![Controller {
                    law: Wiring::TransferFunction(AWKWARD.to_vec(), vec![AWKWARD[1]]),
                    outputs: vec![Seen::Output(3), Seen::Rate(1, 0)],
                    inputs: vec![(2, AWKWARD[0])],
                    period: [1, 3],
                    limits: Some([AWKWARD[1], AWKWARD[6]]),
                    ..Controller::default()
                }],
                kinks: vec![
                    Kink {
                        words: "force `wire` where length = 1".to_owned(),
                        of: Formula(vec![Operation::Seen(Seen::DistanceRate(Line([
                            End { slot: None, point: [AWKWARD[0], 0.0, AWKWARD[1]] },
                            End { slot: Some(3), point: [0.0; 3] },
                        ])))]),
                        at: Levels::At(vec![AWKWARD[1], AWKWARD[4]]),
                    },
                    Kink {
                        words: "force `wire` where length = 1".to_owned(),
                        of: Formula(vec![Operation::Seen(Seen::Input(2, AWKWARD[3], -1.0))]),
                        at: Levels::Whole,
                    },
                ],
                watches: vec![Watch {
                    of: Formula(vec![
                        Operation::Seen(Seen::Rate(1, 0)),
                        Operation::Number(AWKWARD[1]),
                        Operation::Power(1, -2),
                        Operation::Call(Elementary::When, [0, 2]),
                        Operation::Difference(0, 3),
                    ]),
                    level: AWKWARD[0],
                    rising: true,
                    falling: false,
                    stops: correct_every.is_some(),
                }],
                paths: vec![Path { inputs: [3, 1, 4, 2], rows: vec![AWKWARD[..2].try_into().unwrap(); 2] }],
                contacts: vec![Touch::Stop(Stop {
                    on: (1, 0),
                    input: 2,
                    ends: [f64::NEG_INFINITY, AWKWARD[1]],
                    restitution: AWKWARD[0],
                    levels: [0.0, AWKWARD[5]],
                    coefficients: [AWKWARD[1], AWKWARD[0]],
                    reaction: correct_every.map(|_| 7),
                    seen: correct_every.map(|_| 9),
                })],
            },
            measure_for: correct_every.map(|every| 3.0 * every),
        };
        assert_eq!(again(&request), request);
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
        controlled: vec![AWKWARD[5]],
        bodies: vec![BodySample { pose: AWKWARD, velocity: [AWKWARD[6]; 6] }],
        kinetic: 1.0,
        potential: -2.0 / 3.0,
        work: -0.0,
        position_violation: 1e-17,
        velocity_violation: 0.0,
        norm_violation: 1e-18,
        chart_switches: 7,
    };
    let summary = Summary {
        steps: 10_000,
        chart_switches: 32,
        smallest_pivot: Some(0.5),
        kinks_crossed: 9,
        stay: Some(Stay { kink: 3, t: AWKWARD[2] }),
        ..Default::default()
    };
    let first = Passage { t: AWKWARD[0], pivot: AWKWARD[4], owner: Some(Owner::Driver(3)) };
    let passed = Summary {
        statistics: Statistics { passages: 2, first_passage: Some(first), ..Statistics::default() },
        ..summary
    };
    for reply in [
        Reply::Sample(sample),
        Reply::Occurred(Occurrence { t: AWKWARD[6], what: What::Crossed { event: 3, rises: true } }),
        Reply::Linear(Linear {
            t: AWKWARD[0],
            elements: vec![
                Element::Position { place: JointPlace::Scalar { joint: 1, coordinate: 0 }, component: 0 },
                Element::Rate { place: JointPlace::Body { body: 2 }, component: 5 },
            ],
            state: AWKWARD[..2].to_vec(),
            slope: AWKWARD[2..4].to_vec(),
            by_state: AWKWARD[1..5].to_vec(),
            by_inputs: vec![AWKWARD[6]; 2],
            outputs: vec![AWKWARD[3]],
            ..Linear::default()
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
        assert_eq!(again(&reply), reply);
    }
}

#[test]
fn numbers_keep_their_bits() {
    for value in AWKWARD.into_iter().chain([f64::NAN, f64::INFINITY, f64::NEG_INFINITY]) {
        assert_eq!(again(&value).to_bits(), value.to_bits());
    }
}

#[test]
fn what_is_not_a_reply_is_refused() {
    let mut whole = Vec::new();
    write(&mut whole, &Reply::Progress(0.5)).unwrap();
    assert_eq!(read::<Reply>(&mut &whole[..0]).unwrap(), None);
    for text in [b"thread 'main' panicked", &whole[..whole.len() - 1]] {
        assert!(read::<Reply>(&mut &text[..]).is_err());
    }
}
