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

/// Trees with and without parameters, couplers, motions that are prescribed, turn references and charts; loops.
#[test]
fn functions_have_the_bits_that_rustc_gives_them() {
    shipped![
        driven_gyroscope::DrivenGyroscope,
        four_bar::FourBar,
        gyroscope_misalignments::GyroscopeMisalignments,
        gyroscope_parameters::GyroscopeParameters,
        heavy_top::HeavyTop,
        pitching_gyroscope::PitchingGyroscope,
        slider_crank::SliderCrank,
        torsion::Torsion,
    ];
}

/// `cargo test -p gyro-jit --test suite -- --ignored`: the others take half a minute.
#[test]
#[ignore = "takes half a minute"]
fn functions_of_all_shipped_mechanisms_have_the_bits_that_rustc_gives_them() {
    shipped![
        compound_pendulum::CompoundPendulum,
        double_wishbone::DoubleWishbone,
        four_bar_bushing::FourBarBushing,
        four_bar_in_line::FourBarInLine,
        four_bar_revolute::FourBarRevolute,
        free_body::FreeBody,
        gyroscope::Gyroscope,
        gyroscope_at_rest::GyroscopeAtRest,
        gyroscope_combined_offsets::GyroscopeCombinedOffsets,
        gyroscope_coulomb::GyroscopeCoulomb,
        gyroscope_fast::GyroscopeFast,
        gyroscope_four_bar::GyroscopeFourBar,
        gyroscope_free_nutation::GyroscopeFreeNutation,
        gyroscope_gimbal_lock::GyroscopeGimbalLock,
        gyroscope_heavy_rotor::GyroscopeHeavyRotor,
        gyroscope_light_rings::GyroscopeLightRings,
        gyroscope_long::GyroscopeLong,
        gyroscope_maximal::GyroscopeMaximal,
        gyroscope_overdamped::GyroscopeOverdamped,
        gyroscope_radial_imbalance::GyroscopeRadialImbalance,
        gyroscope_rolling_base::GyroscopeRollingBase,
        gyroscope_stiff::GyroscopeStiff,
        gyroscope_viscous::GyroscopeViscous,
        spinning_top::SpinningTop,
        stewart_platform::StewartPlatform,
    ];
}
