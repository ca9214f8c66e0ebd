//! Gyroscopes over 0.1 s under error control to 1e-6, in lanes, and nothing else: no draws, no records, no files, no
//! other program. `kernels N` runs N of them, with parameters that were drawn before, and prints the sum of where they
//! end.

#[allow(warnings, clippy::all)]
mod mechanism;

use gyro_sim::lanes::{Adaptive, Lanes, Outcome, f64x8};
use gyro_sim::{Control, Dop853, Joint, JointSpace, Mechanism, Scalar, When};

type One = mechanism::MisalignedGyroscope<f64>;
type Eight = mechanism::MisalignedGyroscope<f64x8>;
type State<M> = <M as JointSpace>::Joints;
type Method<M> = Dop853<State<M>, <M as Mechanism>::Scalar>;

const LANES: usize = f64x8::COUNT;
const END: f64 = 0.1;

/// Half the widths of what the study draws, and where it does not draw about zero.
const WITHIN: [f64; 7] = [2e-5, 2e-5, 2e-5, 2e-6, 2e-6, 1e-3, 1e-3];
const OFFSET: f64 = 0.000_125;

fn built<T: Scalar>(p: &[T; 7]) -> mechanism::MisalignedGyroscope<T> {
    let [offset_x, offset_y, offset_z, imbalance_y, imbalance_z, lean_y, lean_z] = *p;
    mechanism::MisalignedGyroscope::new(mechanism::Parameters {
        offset_x,
        offset_y,
        offset_z,
        imbalance_y,
        imbalance_z,
        lean_y,
        lean_z,
    })
}

/// Parameters of 4096 gyroscopes.
fn drawn() -> Vec<[f64; 7]> {
    let mut random: u64 = 1;
    let mut unit = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut one = || {
        let mut p = WITHIN.map(|within| within * (2.0 * unit() - 1.0));
        p[0] += OFFSET;
        p
    };
    (0..4096).map(|_| one()).collect()
}

fn main() {
    let n: usize = std::env::args().nth(1).and_then(|word| word.parse().ok()).expect("a number of gyroscopes");
    let drawn = drawn();
    let start = built::<f64>(&drawn[0]).joint_start();
    let control = Control { when: When::Steps(u32::MAX), ..Control::default().with_tolerance(1e-6) };
    let mut parameters = [f64x8::constant(0.0); 7];
    let mut ones: [One; LANES] = core::array::from_fn(|_| built(&drawn[0]));
    let mut all: Eight = built(&parameters);
    let mut out = all.joint_start();
    let mut solvers: Adaptive<Joint, State<Eight>, f64x8, Method<Eight>, Joint, State<One>, Method<One>> =
        Adaptive::new(Joint, Dop853::new(&out), &out);
    let (mut begun, mut running, mut sum) = (0, [false; LANES], 0.0);
    loop {
        let mut has_changed = false;
        for lane in 0..LANES {
            if running[lane] || begun == n {
                continue;
            }
            let p = &drawn[begun % drawn.len()];
            begun += 1;
            for (pack, value) in parameters.iter_mut().zip(p) {
                let before = *pack;
                *pack = f64x8::from_lanes(|other| if other == lane { *value } else { before.lane(other) });
            }
            ones[lane] = built(p);
            solvers.begin(lane, Joint, &start, control);
            (running[lane], has_changed) = (true, true);
        }
        if running == [false; LANES] {
            break;
        }
        if has_changed {
            all = built(&parameters);
        }
        let mut is_kept = [false; LANES];
        solvers.attempt(|lane| &ones[lane], &all, END, |lane, outcome| {
            assert!(!matches!(outcome, Outcome::Failed(_)));
            is_kept[lane] = outcome == Outcome::Kept;
        });
        let has_ended =
            |lane: usize| running[lane] && is_kept[lane] && solvers.time(lane).is_some_and(|t| t >= END);
        let ended: [bool; LANES] = core::array::from_fn(has_ended);
        if ended != [false; LANES] {
            solvers.interpolate(&all, |lane| ended[lane].then_some(END), &mut out);
        }
        for lane in (0..LANES).filter(|lane| ended[*lane]) {
            sum += out[0].lane(lane) + out[1].lane(lane);
            solvers.end(lane);
            running[lane] = false;
        }
    }
    println!("{sum:e}");
}
