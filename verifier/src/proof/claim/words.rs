//! Claims in words.

use super::Claim;

impl Claim {
    /// The claim in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Phi => "Φ of the joints, eqs. (7) to (12)",
            Self::PhiQ => "Φ_q by dual numbers, zero outside its pattern",
            Self::PhiPi => "½ Φ_p Gᵀ by dual numbers, zero outside its pattern",
            Self::Nu => "ν = −Φ_t",
            Self::Gamma => "γ, minus the second derivative of Φ at s̈ = ẇ' = 0",
            Self::VelocityResidual => "Φ_r s + Φ_π' w' − ν",
            Self::AppliedForce => "(f, n' − w̃'J'w')",
            Self::Motion => "eq. (17) leaves no residual",
            Self::Projection => "rows change as asked; M δ ⊥ all that changes no row",
            Self::Derivative => "eqs. (14), (16), power, rates of turn references",
            Self::Energy => "T and V",
            Self::Readings => "joint coordinates and rates, also for |p| ≠ 1",
            Self::Outputs => "outputs at the proved accelerations and multipliers",
            Self::ChartVectors => "parallel to Gᵀh' or to p",
            Self::NewtonStep => "linearised rows vanish, the special parameter is kept",
            Self::SolveVelocities => "velocity rows vanish, independent rates are kept",
            Self::ToMaximal => "rows vanish but those of loops, its joint coordinates are x and u",
            Self::ToJoints => "x and u of any state, angles by their derivative",
            Self::JointAccelerations => "with B = ∂v/∂u: Bᵀ(M v̇ − f) = −Jᵀλ, Φ_π' v̇ = γ",
            Self::JointDerivative => "along it the state moves by eqs. (14), (16); power",
            Self::JointAccelerationsAt => "the proved u̇ at the state of (x, u)",
            Self::CorrectedAccelerations => "the proved v̇ at the state of (x, u)",
            Self::CorrectedDerivative => "eqs. (14), (16), v̇, turns; power at the state of (x, u)",
            Self::CorrectedMultipliers => "M v̇ + Φ_π'ᵀ λ = f at the state of (x, u)",
            Self::CorrectedSolution => "the proved v̇ there, M v̇ + Φ_π'ᵀ λ = f",
            Self::LoopClosure => "Φ of what closes loops at the state of (x, u)",
            Self::ClosureDistances => "D of J Jᵀ = L D Lᵀ, J by dual numbers",
            Self::ClosePositions => "J δ = −Φ of what closes loops, x changes by T δ",
            Self::CloseVelocities => "loops stay closed; rates at which they do are kept",
            Self::JointJacobian => "`joint_derivative` by dual numbers, of x and of t",
            Self::JointInputJacobian => "`joint_derivative` by dual numbers, of the inputs",
            Self::JointParameterJacobian => "`joint_derivative` by dual numbers, of the parameters",
            Self::JointOutputs => "outputs at the state of (x, u), at the proved v̇ and λ",
            Self::OutputDerivatives => "`joint_outputs` by dual numbers, at any u̇",
            Self::FrameJacobians => "velocities at the state of (x, u) by the rates",
            Self::FrameBiases => "accelerations at the state of (x, u) for u̇ = 0",
            Self::InverseDynamics => "Bᵀ(M v̇ − f) at any u̇",
            Self::BiasForces => "Bᵀ(M v̇ − f) at u̇ = 0",
            Self::GravityForces => "−Bᵀ(m g, 0)",
            Self::MassMatrix => "Bᵀ diag(M, J') B",
            Self::MassFactor => "Lᵀ D L = Bᵀ diag(M, J') B, L triangular in its order",
            Self::InverseDerivatives => "`inverse_dynamics` by dual numbers, along the rates and of them",
            Self::Regressor => "Bᵀ(M v̇ − f) of bodies with unit parameters",
            Self::ForwardDerivatives => "`joint_accelerations` by dual numbers, likewise; M M⁻¹ = 1",
        }
    }

    /// What its functions are proved against, for the data sheet of a module: claims next to each other share it.
    pub fn against(self) -> &'static str {
        match self {
            Self::Phi => "Φ of eqs. (7) to (12)",
            Self::PhiQ | Self::PhiPi | Self::Nu | Self::Gamma | Self::VelocityResidual => {
                "the derivatives of Φ by dual numbers"
            }
            Self::AppliedForce | Self::Motion | Self::Projection => "eq. (17)",
            Self::Derivative => "eqs. (14) and (16)",
            Self::Energy | Self::Readings | Self::Outputs => "their definitions",
            Self::ChartVectors | Self::NewtonStep => "Newton's step for Φ = 0",
            Self::SolveVelocities => "eq. (19)",
            Self::ToMaximal | Self::ToJoints => "Φ = 0, eq. (18) and the joint coordinates",
            Self::JointAccelerations
            | Self::JointAccelerationsAt
            | Self::CorrectedAccelerations
            | Self::CorrectedMultipliers
            | Self::CorrectedSolution => "eq. (17) on the constraints",
            Self::LoopClosure | Self::ClosureDistances | Self::ClosePositions | Self::CloseVelocities => {
                "Newton's step for closed loops"
            }
            Self::JointJacobian | Self::JointInputJacobian | Self::JointParameterJacobian => {
                "the derivatives of `joint_derivative` by dual numbers"
            }
            Self::InverseDerivatives | Self::ForwardDerivatives => {
                "the derivatives of what is proved by dual numbers"
            }
            Self::MassMatrix | Self::MassFactor => "the kinetic energy of free motions",
            Self::InverseDynamics | Self::BiasForces | Self::GravityForces | Self::Regressor => {
                "virtual power on the constraints"
            }
            Self::JointDerivative | Self::CorrectedDerivative => "eqs. (14) and (16) on the constraints",
            Self::OutputDerivatives => "the derivatives of `joint_outputs` by dual numbers",
            Self::JointOutputs | Self::FrameJacobians | Self::FrameBiases => {
                "the outputs' definitions on the constraints"
            }
        }
    }
}
