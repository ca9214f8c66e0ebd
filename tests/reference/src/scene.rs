//! One reference for each shipped model file, by its name.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_6};

use crate::moving_base::{loose_camera, rolling, rolling_and_pitching, rolling_fast};
use crate::vector::{dot, sub};
use crate::{
    AxisForce, Bar, BodyState, BushingFourBar, Chain, DoubleWishbone, FourBar, FourBarSample, Gyroscope,
    GyroscopeFourBar, HeavyTop, OneAxis, Pendulum, PendulumSample, ReducedGyroscope, Sample, SliderCrank,
    SliderCrankSample, StewartPlatform, StewartSample, TopSample,
};

/// Joint coordinates of a mechanism at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct JointRow {
    /// Time, s.
    pub t: f64,
    /// Scalar coordinates in the order of the model file's joints, rad or m; angles are continuous.
    pub positions: Vec<f64>,
    /// Their rates.
    pub rates: Vec<f64>,
    /// What spherical joints show, in the order of the model file.
    pub orientations: Vec<Orientation>,
}

/// How the second body of a joint is turned and turns in the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    /// Rotation matrix by rows: components in the second body's frame into those in the first's.
    pub rotation: [[f64; 3]; 3],
    /// Relative angular velocity in the second body's frame, rad/s.
    pub angular_velocity: [f64; 3],
}

/// The motion of a shipped model file.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneReference(Motion);

#[derive(Clone, Debug, PartialEq)]
enum Motion {
    Gyroscope(Box<Gyroscope>),
    Reduced(ReducedGyroscope),
    /// The same, for long runs that nothing damps.
    Periodic(ReducedGyroscope),
    /// A gyroscope on a base that moves.
    Carried(Box<Chain<3>>),
    /// Two axes on a base that moves.
    TwoAxes(Box<Chain<2>>),
    Top(HeavyTop),
    Axis(OneAxis),
    Pendulum(Pendulum),
    FourBar(FourBar, Joints),
    /// In a plane.
    SliderCrank(SliderCrank),
    Bushing(BushingFourBar),
    Stewart(Box<StewartPlatform>),
    Wishbone(DoubleWishbone),
    GyroscopeFourBar(GyroscopeFourBar),
    /// A parallelogram as a pendulum, its crank's angle counted from the horizontal.
    Parallelogram(Pendulum),
}

/// How the coupler of a four-bar linkage is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Joints {
    /// By revolute joints on either side.
    Revolute,
    /// By a universal joint on the crank and a spherical one on the rocker.
    UniversalAndSpherical,
}

/// The motion of the model file of this name, such as `gyroscope-fast`, with inputs of zero and without contacts;
/// `None` if there is no such model file or it has no joints.
#[must_use]
pub fn scene(model_name: &str) -> Option<SceneReference> {
    let motion = match model_name {
        "compound-pendulum" => Motion::Pendulum(Pendulum::slender_rod()),
        "driven-gyroscope" => Motion::Carried(Box::new(rolling())),
        "double-wishbone" => Motion::Wishbone(DoubleWishbone::default()),
        "four-bar" => Motion::FourBar(FourBar::crank_rocker(), Joints::UniversalAndSpherical),
        "four-bar-bushing" => Motion::Bushing(BushingFourBar::default()),
        "four-bar-in-line" => Motion::Parallelogram(thrown_parallelogram()),
        "four-bar-revolute" => Motion::FourBar(FourBar::crank_rocker(), Joints::Revolute),
        "gyroscope" | "gyroscope-maximal" | "gyroscope-misalignments" | "gyroscope-parameters" => {
            Motion::Gyroscope(Box::new(Gyroscope::paper()))
        }
        "gyroscope-combined-offsets" => Motion::Gyroscope(Box::new(Gyroscope::combined_offsets())),
        "gyroscope-four-bar" => Motion::GyroscopeFourBar(GyroscopeFourBar::default()),
        "gyroscope-free-nutation" => Motion::Gyroscope(Box::new(Gyroscope::free_nutation())),
        "gyroscope-radial-imbalance" => Motion::Gyroscope(Box::new(Gyroscope::radial_imbalance())),
        "gyroscope-viscous" => Motion::Gyroscope(Box::new(Gyroscope::viscous_bearings())),
        "gyroscope-rolling-base" => Motion::Carried(Box::new(rolling_fast())),
        "gyroscope-long" => Motion::Periodic(ReducedGyroscope::free_nutation()),
        "heavy-top" => Motion::Top(steady_top()),
        "pitching-gyroscope" => Motion::Carried(Box::new(rolling_and_pitching())),
        "slider-crank" => Motion::SliderCrank(SliderCrank::in_line()),
        "spinning-top" => Motion::Top(HeavyTop::benchmark()),
        "stabilised-gimbal" => Motion::TwoAxes(Box::new(loose_camera())),
        "stewart-platform" => Motion::Stewart(Box::new(StewartPlatform::plate_of_ten_kilograms())),
        "torsion" => Motion::Axis(OneAxis::torsion()),
        name => Motion::Reduced(extreme(name)?),
    };
    Some(SceneReference(motion))
}

impl SceneReference {
    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend from zero.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<JointRow> {
        match &self.0 {
            Motion::Gyroscope(gyroscope) => gyroscope.solve(times).iter().map(of_gimbal).collect(),
            Motion::Reduced(gyroscope) => gyroscope.solve(times).iter().map(of_gimbal).collect(),
            Motion::Periodic(gyroscope) => gyroscope.solve_by_periods(times).iter().map(of_gimbal).collect(),
            Motion::Carried(chain) => {
                let samples = chain.solve(times);
                samples.iter().map(|s| JointRow::of_scalars(s.t, &s.positions, &s.rates)).collect()
            }
            Motion::TwoAxes(chain) => {
                let samples = chain.solve(times);
                samples.iter().map(|s| JointRow::of_scalars(s.t, &s.positions, &s.rates)).collect()
            }
            Motion::Top(top) => {
                let turned = |s: &TopSample| Orientation {
                    rotation: s.body.rotation,
                    angular_velocity: s.body.angular_velocity,
                };
                let samples = top.solve(times);
                let row =
                    |s| JointRow { orientations: vec![turned(s)], ..JointRow::of_scalars(s.t, &[], &[]) };
                samples.iter().map(row).collect()
            }
            Motion::Axis(axis) => {
                let samples = axis.solve(times);
                samples.iter().map(|s| JointRow::of_scalars(s.t, &[s.position], &[s.rate])).collect()
            }
            Motion::Pendulum(pendulum) => {
                let samples = pendulum.solve(times);
                samples.iter().map(|s| JointRow::of_scalars(s.t, &[s.angle], &[s.rate])).collect()
            }
            Motion::FourBar(linkage, joints) => {
                linkage.solve(times).iter().map(|sample| of_four_bar(sample, *joints)).collect()
            }
            Motion::SliderCrank(mechanism) => mechanism.solve(times).iter().map(of_slider_crank).collect(),
            Motion::Bushing(linkage) => linkage.solve(times),
            Motion::Stewart(platform) => platform.solve(times).iter().map(of_stewart).collect(),
            Motion::Wishbone(wishbone) => wishbone.solve(times),
            Motion::GyroscopeFourBar(gyroscope) => gyroscope.solve(times),
            Motion::Parallelogram(pendulum) => pendulum.solve(times).iter().map(of_parallelogram).collect(),
        }
    }
}

impl JointRow {
    fn of_scalars(t: f64, positions: &[f64], rates: &[f64]) -> Self {
        JointRow { t, positions: positions.to_vec(), rates: rates.to_vec(), orientations: Vec::new() }
    }
}

fn of_gimbal(sample: &Sample) -> JointRow {
    let [t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, _] = sample.values();
    JointRow::of_scalars(t, &[alpha, beta, phi], &[alpha_rate, beta_rate, phi_rate])
}

/// Pivots of crank and rocker, elbow between crank and coupler, knee between coupler and rocker.
fn of_four_bar(sample: &FourBarSample, joints: Joints) -> JointRow {
    let between = |[crank, coupler, rocker]: [f64; 3]| [crank, rocker, coupler - crank, rocker - coupler];
    let ([crank, rocker, elbow, knee], rates) = (between(sample.angles), between(sample.rates));
    match joints {
        Joints::Revolute => JointRow::of_scalars(sample.t, &[crank, rocker, elbow, knee], &rates),
        Joints::UniversalAndSpherical => {
            let [crank_rate, rocker_rate, elbow_rate, knee_rate] = rates;
            let positions = [crank, rocker, elbow, 0.0];
            let scalars =
                JointRow::of_scalars(sample.t, &positions, &[crank_rate, rocker_rate, elbow_rate, 0.0]);
            JointRow { orientations: vec![about_z(knee, knee_rate)], ..scalars }
        }
    }
}

/// Crank, crank pin, wrist pin, rail; the rod leans by less than a right angle.
fn of_slider_crank(sample: &SliderCrankSample) -> JointRow {
    let [[cos, ..], [sin, ..], _] = sample.rod.rotation;
    let (lean, lean_rate) = (sin.atan2(cos), sample.rod.angular_velocity[2]);
    JointRow::of_scalars(
        sample.t,
        &[sample.angle, lean - sample.angle, -lean, sample.displacement],
        &[sample.rate, lean_rate - sample.rate, -lean_rate, sample.displacement_rate],
    )
}

/// Of each leg: universal joint on the base, how far the piston is out, spherical joint on the plate.
fn of_stewart(sample: &StewartSample) -> JointRow {
    let of_leg = |part: usize| {
        let legs = sample.hinges.iter().zip(&sample.lengths);
        legs.flat_map(move |([first, second], length)| [first[part], second[part], length[part]])
    };
    // Both mass centres are 0.3 m from the leg's ends.
    let beside = |(k, x): (usize, f64)| if k % 3 == 2 { x - 0.6 } else { x };
    let positions: Vec<f64> = of_leg(0).enumerate().map(beside).collect();
    let rates: Vec<f64> = of_leg(1).collect();
    let orientations = sample.pistons.iter().map(|piston| relative(piston, &sample.plate)).collect();
    JointRow { orientations, ..JointRow::of_scalars(sample.t, &positions, &rates) }
}

/// How the second body is turned and turns in the first.
fn relative(first: &BodyState, second: &BodyState) -> Orientation {
    let columns = |body: &BodyState| [0, 1, 2].map(|k| body.rotation.map(|row| row[k]));
    let (a, b) = (columns(first), columns(second));
    let rotation = a.map(|x| b.map(|y| dot(x, y)));
    let seen = [0, 1, 2].map(|k| dot(rotation.map(|row| row[k]), first.angular_velocity));
    Orientation { rotation, angular_velocity: sub(second.angular_velocity, seen) }
}

/// The coupler keeps its direction: crank and rocker turn against it alike.
fn of_parallelogram(sample: &PendulumSample) -> JointRow {
    let (crank, rate) = (sample.angle - FRAC_PI_2, sample.rate);
    let scalars = JointRow::of_scalars(sample.t, &[crank, crank, -crank, 0.0], &[rate, rate, -rate, 0.0]);
    JointRow { orientations: vec![about_z(crank, rate)], ..scalars }
}

fn about_z(angle: f64, rate: f64) -> Orientation {
    let (sin, cos) = angle.sin_cos();
    Orientation {
        rotation: [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]],
        angular_velocity: [0.0, 0.0, rate],
    }
}

/// The paper's scene and one thing that is extreme about it.
fn extreme(name: &str) -> Option<ReducedGyroscope> {
    let paper = ReducedGyroscope::paper();
    let sprung = |damping: f64| {
        let spring = AxisForce::Spring { stiffness: 1e3, free: 0.0 };
        ReducedGyroscope {
            beta: 0.001,
            forces: vec![spring, AxisForce::Damper(damping)],
            ..ReducedGyroscope::paper()
        }
    };
    Some(match name {
        "gyroscope-fast" => ReducedGyroscope { spin: 1e5, step: 7e-6, ..paper },
        "gyroscope-at-rest" => ReducedGyroscope { spin: 0.0, step: 0.1, ..paper },
        "gyroscope-light-rings" => {
            ReducedGyroscope { outer: 10e-13, inner: [10e-13, 20e-13, 10e-13], ..paper }
        }
        "gyroscope-heavy-rotor" => ReducedGyroscope { mass: 1e10, rotor: [1_250_000.0, 625_000.0], ..paper },
        "gyroscope-gimbal-lock" => ReducedGyroscope { offset: 0.005, spin: 10.0, step: 0.01, ..paper },
        "gyroscope-stiff" => ReducedGyroscope { step: 7e-5, ..sprung(1e-2) },
        "gyroscope-overdamped" => ReducedGyroscope { step: 1e-5, ..sprung(1.0) },
        "gyroscope-coulomb" => ReducedGyroscope {
            forces: vec![AxisForce::Coulomb { level: 2e-6, rate: 1e-3 }],
            step: 1e-3,
            ..paper
        },
        _ => return None,
    })
}

/// The heavy top in steady precession.
fn steady_top() -> HeavyTop {
    HeavyTop {
        mass: 0.5,
        inertia: [3e-4, 3e-4, 5e-4, 0.0, 0.0, 0.0],
        centre: [0.0, 0.0, 0.04],
        gravity: [0.0, 0.0, -9.81],
        orientation: [3.0, 1.0, 0.0, 0.0],
        angular_velocity: [0.0, 1.198_258_752_558_553_3, 200.0],
    }
}

/// Crank and rocker of 0.2 m, thrown up at 12 rad/s from 60 degrees below the line.
fn thrown_parallelogram() -> Pendulum {
    let bar = |length: f64, mass, inertia| Bar { length, mass, inertia, centre: [0.5 * length, 0.0] };
    let bars = [bar(0.2, 0.4, 1.35e-3), bar(0.5, 1.0, 2.1e-2), bar(0.2, 0.4, 1.35e-3)];
    Pendulum::parallelogram(bars, 9.81, FRAC_PI_6, 12.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_without_joints_and_other_names_have_no_reference() {
        assert_eq!(scene("free-body"), None);
        assert_eq!(scene("gyroscope-slow"), None);
        assert!(scene("gyroscope-fast").is_some());
    }
}
