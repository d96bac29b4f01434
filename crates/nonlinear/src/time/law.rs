//! Restoring forces that depend on amplitude, on one component of a joint's relative motion.

use jointscope_fixture::{Dof, Effect, EffectKind, Place};

/// Force g (N, N·m) of a joint's amplitude-dependent part against its relative motion d (m, rad).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum RestoringLaw {
    /// g = k₃·d³.
    Cubic {
        /// k₃, N/m³ or N·m/rad³.
        stiffness3: f64,
    },
    /// Jenkins element: a spring that slips at a force.
    Friction {
        /// Force at which it slips.
        slip_force: f64,
        /// Stiffness while it sticks.
        stiffness: f64,
    },
    /// One-sided contact: g = k·(d − clearance) where d is larger, else nothing.
    Gap {
        /// Distance before contact.
        clearance: f64,
        /// Stiffness in contact.
        stiffness: f64,
    },
}

/// What a law remembers: where it was and what it bore. A spring that slips needs both, the others need
/// neither.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Memory {
    /// Relative motion d, m or rad.
    pub motion: f64,
    /// Force g, N or N·m.
    pub force: f64,
}

/// Which branch of its law an element is on: a change of it within a step is an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Branch {
    Smooth,
    Open,
    Closed,
    Stuck,
    SlipsForward,
    SlipsBackward,
}

impl RestoringLaw {
    /// The law of an effect; `None` for one whose force is linear.
    pub(crate) fn of(effect: &Effect) -> Option<Self> {
        Self::of_kind(effect.kind, |index| effect.value(index))
    }

    fn of_kind(kind: EffectKind, value: impl Fn(usize) -> f64) -> Option<Self> {
        Some(match kind {
            EffectKind::CubicStiffness => RestoringLaw::Cubic { stiffness3: value(0) },
            EffectKind::Friction => RestoringLaw::Friction { slip_force: value(0), stiffness: value(1) },
            EffectKind::Gap => RestoringLaw::Gap { clearance: value(0), stiffness: value(1) },
            _ => return None,
        })
    }

    /// Relative motion, m or rad, up to which it is a spring or nothing at all.
    pub(crate) fn acts_from(&self) -> f64 {
        match *self {
            RestoringLaw::Cubic { .. } => 0.0,
            RestoringLaw::Friction { slip_force, stiffness } => slip_force / stiffness,
            RestoringLaw::Gap { clearance, .. } => clearance,
        }
    }

    /// The kind of its effect.
    pub(crate) fn kind(&self) -> EffectKind {
        match self {
            RestoringLaw::Cubic { .. } => EffectKind::CubicStiffness,
            RestoringLaw::Friction { .. } => EffectKind::Friction,
            RestoringLaw::Gap { .. } => EffectKind::Gap,
        }
    }

    /// Its parameters in the order of the effect's.
    pub(crate) fn values(&self) -> Vec<f64> {
        match *self {
            RestoringLaw::Cubic { stiffness3 } => vec![stiffness3],
            RestoringLaw::Friction { slip_force, stiffness } => vec![slip_force, stiffness],
            RestoringLaw::Gap { clearance, stiffness } => vec![clearance, stiffness],
        }
    }

    /// A law of this kind with other parameters.
    pub(crate) fn with_values(&self, values: &[f64]) -> Self {
        let value = |index: usize| values.get(index).copied().unwrap_or(f64::NAN);
        Self::of_kind(self.kind(), value).unwrap_or(*self)
    }

    /// Whether all parameters are positive, and a fit moves them by their logarithms: a cubic stiffness may
    /// have either sign.
    pub(crate) fn is_positive(&self) -> bool {
        !matches!(self, RestoringLaw::Cubic { .. })
    }

    /// The effect of this law at a joint.
    pub(crate) fn to_effect(self, joint: &str, dof: Dof) -> Effect {
        Effect::new(self.kind(), Place::Joint(joint.to_owned()), Some(dof), &self.values())
    }

    /// Its force along a history of motion that begins at rest.
    pub fn forces<'a>(self, motions: impl IntoIterator<Item = &'a f64>) -> Vec<f64> {
        let mut memory = Memory::default();
        let force = |motion: &f64| {
            memory = Memory { motion: *motion, force: self.force(*motion, &memory) };
            memory.force
        };
        motions.into_iter().map(force).collect()
    }

    /// The force at motion `motion` after what it remembers.
    pub(crate) fn force(&self, motion: f64, before: &Memory) -> f64 {
        match *self {
            RestoringLaw::Cubic { stiffness3 } => stiffness3 * motion.powi(3),
            RestoringLaw::Gap { clearance, stiffness } => (stiffness * (motion - clearance)).max(0.0),
            RestoringLaw::Friction { slip_force, stiffness } => {
                no_more_than(slip_force, before.force + stiffness * (motion - before.motion))
            }
        }
    }

    /// Solves d = free − yields·g(d): motion and force at the end of a step during which the force itself
    /// moves d by −`yields` per N.
    #[inline]
    pub(crate) fn settle(&self, free: f64, yields: f64, before: &Memory) -> Memory {
        let force = match *self {
            RestoringLaw::Cubic { stiffness3 } => {
                let stiff = yields * stiffness3;
                let mut motion = before.motion;
                for _ in 0..12 {
                    let slope = 1.0 + 3.0 * stiff * motion * motion;
                    let step = (motion + stiff * motion * motion * motion - free) / slope;
                    motion -= step;
                    if step.abs() <= 1e-13 * motion.abs() || !step.is_finite() {
                        break;
                    }
                }
                stiffness3 * motion * motion * motion
            }
            RestoringLaw::Gap { clearance, stiffness } => {
                (stiffness * (free - clearance)).max(0.0) / (1.0 + stiffness * yields)
            }
            RestoringLaw::Friction { slip_force, stiffness } => {
                let stuck = (before.force + stiffness * (free - before.motion)) / (1.0 + stiffness * yields);
                no_more_than(slip_force, stuck)
            }
        };
        Memory { motion: free - yields * force, force }
    }

    #[inline]
    pub(crate) fn branch(&self, now: &Memory) -> Branch {
        match *self {
            RestoringLaw::Cubic { .. } => Branch::Smooth,
            RestoringLaw::Gap { .. } if now.force > 0.0 => Branch::Closed,
            RestoringLaw::Gap { .. } => Branch::Open,
            RestoringLaw::Friction { slip_force, .. } if now.force >= slip_force => Branch::SlipsForward,
            RestoringLaw::Friction { slip_force, .. } if now.force <= -slip_force => Branch::SlipsBackward,
            RestoringLaw::Friction { .. } => Branch::Stuck,
        }
    }
}

/// What of a force a Jenkins element bears before it slips.
#[inline]
fn no_more_than(slip_force: f64, force: f64) -> f64 {
    if force > slip_force {
        slip_force
    } else if force < -slip_force {
        -slip_force
    } else {
        force
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jenkins_element_moved_to_and_fro_dissipates_what_its_loop_encloses() {
        // Amplitude X beyond the slip displacement F/k: 4 F (X − F/k) a cycle.
        let (slip_force, stiffness, amplitude) = (3.0, 1e6, 9e-6);
        let law = RestoringLaw::Friction { slip_force, stiffness };
        let mut memory = Memory::default();
        let mut work = 0.0;
        let steps = 40_000;
        for i in 1..=2 * steps {
            let motion = amplitude * (std::f64::consts::TAU * i as f64 / steps as f64).sin();
            let force = law.force(motion, &memory);
            if i > steps {
                work += 0.5 * (force + memory.force) * (motion - memory.motion);
            }
            memory = Memory { motion, force };
        }
        let expected = 4.0 * slip_force * (amplitude - slip_force / stiffness);
        assert!((work / expected - 1.0).abs() < 1e-6, "{work} J against {expected} J");
    }

    #[test]
    fn a_slip_force_that_no_joint_has_stops_no_program() {
        for slip_force in [-1.0, f64::NAN] {
            let law = RestoringLaw::Friction { slip_force, stiffness: 1e6 };
            assert_eq!(law.forces(&[0.0, 1e-6, -1e-6]).len(), 3);
        }
    }

    #[test]
    fn a_settled_element_obeys_its_law_and_the_motion_it_causes() {
        let laws = [
            RestoringLaw::Cubic { stiffness3: 4e13 },
            RestoringLaw::Gap { clearance: 1e-5, stiffness: 1e6 },
            RestoringLaw::Friction { slip_force: 5.0, stiffness: 1e6 },
        ];
        for law in laws {
            for free in [-6e-5, -1e-6, 2e-6, 3e-5] {
                let before = Memory { motion: 1e-6, force: law.force(1e-6, &Memory::default()) };
                let yields = 3e-8;
                let after = law.settle(free, yields, &before);
                assert!((after.motion + yields * after.force - free).abs() < 1e-15);
                assert!((after.force - law.force(after.motion, &before)).abs() < 1e-9, "{law:?} at {free}");
            }
        }
    }
}
