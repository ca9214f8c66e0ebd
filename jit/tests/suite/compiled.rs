//! Shipped mechanisms against the same ones compiled by rustc.

use crate::pair::check_with_joints;
use gyro_sim::{CorrectedSolution, Dynamics, JointSpace, Kinematics, Mechanism, Partition, Projection};

fn check<M>(name: &str, rustc: M)
where
    M: Mechanism<Scalar = f64>
        + Kinematics
        + Dynamics
        + CorrectedSolution
        + Projection
        + Partition
        + JointSpace,
{
    let file = format!("{}/../models/{}.toml", env!("CARGO_MANIFEST_DIR"), name.replace('_', "-"));
    let model = gyro_model::read(name, &std::fs::read_to_string(file).unwrap());
    check_with_joints(name, &model.unwrap_or_else(|error| panic!("{error}")), rustc);
}

macro_rules! shipped {
    ($($module:ident::$ty:ident),* $(,)?) => {
        $(check(stringify!($module), gyro_mechanisms::$module::$ty::<f64>::default());)*
    };
}

/// Trees with and without parameters, couplers, motions that are prescribed, turn references and charts; loops. All
/// mechanisms are compared by the example `beside_rustc`.
#[test]
fn functions_have_the_bits_that_rustc_gives_them() {
    shipped![
        driven_gyroscope::DrivenGyroscope,
        four_bar::FourBar,
        gyroscope_misalignments::GyroscopeMisalignments,
        gyroscope_parameters::GyroscopeParameters,
        heavy_top::HeavyTop,
        slider_crank::SliderCrank,
        torsion::Torsion,
    ];
}
