//! A joint over time: the part of its dynamic stiffness that states of its own can follow.

use super::{JointDynamics, in_series};
use jointscope_beam::end_stiffness;
use jointscope_linalg::{ComplexMatrix2, RealMatrix2};
use num_complex::Complex64;

/// A joint without mass over time, on d = u_to − R·u_from.
///
/// With the slips e of its interfaces and the states w of its relaxations, δ = d − Σ rᵢeᵢ, τⱼẇⱼ = δ − wⱼ, its
/// force is f = K((1 + Σρⱼ) δ − Σ ρⱼwⱼ) + C δ̇, and rᵢᵀf = kᵢeᵢ + cᵢėᵢ.
#[derive(Debug, Clone)]
pub(crate) struct JointInTime {
    /// K: elastic, its factor, shear and the interfaces without a state in it.
    pub stiffness: RealMatrix2,
    /// C.
    pub dashpots: Option<RealMatrix2>,
    /// (ρ, τ).
    pub relaxations: Vec<(f64, f64)>,
    /// (r, k, c).
    pub slips: Vec<([f64; 2], f64, f64)>,
}

/// Time constant of a spring in series that has no dashpot but needs a state, s: far below any sampling
/// interval.
const INSTANT: f64 = 1e-10;

impl JointDynamics {
    /// The joint over time; `Err` with the name of the effect that has no form there.
    ///
    /// The fixture's own loss factor is not part of it: over time its modes are damped by its viscous
    /// equivalent.
    pub(crate) fn in_time(&self) -> Result<JointInTime, &'static str> {
        if self.loss != 0.0 {
            return Err("loss_factor");
        }
        if self.mass != 0.0 {
            return Err("joint_mass");
        }
        let length = self.length + self.extra_length;
        let elastic = match self.bending_stiffness {
            Some(bending) if self.extra_length != 0.0 => end_stiffness(bending, length),
            _ => self.nominal,
        };
        let mut stiffness = elastic.scale(self.factor).to_complex();
        let real = |value: f64| Complex64::new(value, 0.0);
        if let Some(shear) = self.shear_stiffness {
            stiffness = in_series(stiffness, [1.0, 0.0], real(self.factor * shear / length));
        }
        let dynamic = self.dashpots.is_some() || !self.relaxations.is_empty();
        let mut slips = Vec::new();
        for interface in &self.interfaces {
            let direction = self.slip_at_far_end(interface, length);
            if dynamic || interface.damping > 0.0 {
                let dashpot = interface.damping.max(INSTANT * interface.stiffness);
                slips.push((direction, interface.stiffness, dashpot));
            } else {
                stiffness = in_series(stiffness, direction, real(interface.stiffness));
            }
        }
        Ok(JointInTime {
            stiffness: real_part(stiffness),
            dashpots: self.dashpots,
            relaxations: self.relaxations.clone(),
            slips,
        })
    }
}

fn real_part(matrix: ComplexMatrix2) -> RealMatrix2 {
    matrix.map(|element| element.re)
}
