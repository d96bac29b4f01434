//! Harmonic balance: the stiffness that a law shows to a sine.

use crate::RestoringLaw;
use crate::settings::level_model::CONTACT_STEPS;
use num_complex::Complex64;
use std::f64::consts::PI;

/// First harmonic of a law's force over the amplitude of d = a·cos ωt: stiffness, and i times what it loses.
/// `yields` is the static relative displacement of the joint by a force of 1 across it: one-sided contact
/// pushes the mean of d away from the stop.
pub(crate) fn equivalent(law: &RestoringLaw, amplitude: f64, yields: f64) -> Complex64 {
    match *law {
        RestoringLaw::Cubic { stiffness3 } => (0.75 * stiffness3 * amplitude * amplitude).into(),
        RestoringLaw::Friction { slip_force, stiffness } => {
            let onset = slip_force / stiffness;
            if amplitude <= onset {
                return stiffness.into();
            }
            let ratio = onset / amplitude;
            let angle = (1.0 - 2.0 * ratio).acos();
            let stores = stiffness / PI * (angle - 0.5 * (2.0 * angle).sin());
            Complex64::new(stores, 4.0 * stiffness * ratio / PI * (1.0 - ratio))
        }
        RestoringLaw::Gap { clearance, stiffness } => {
            let angle = contact(clearance, stiffness, amplitude, yields);
            (stiffness / PI * (angle - 0.5 * (2.0 * angle).sin())).into()
        }
    }
}

/// Half the angle of a period during which the stop is touched, the mean of d being that at which the
/// structure balances the stop's mean force.
fn contact(clearance: f64, stiffness: f64, amplitude: f64, yields: f64) -> f64 {
    let angle_at = |mean: f64| ((clearance - mean) / amplitude).clamp(-1.0, 1.0).acos();
    if amplitude <= clearance {
        return 0.0;
    }
    // mean + yields·push(mean) = 0.
    let mut mean = 0.0;
    for _ in 0..CONTACT_STEPS {
        let angle = angle_at(mean);
        let push =
            stiffness * amplitude / PI * (angle.sin() - (clearance - mean) / amplitude * angle).max(0.0);
        let step = (mean + yields.abs() * push) / (1.0 + yields.abs() * stiffness * angle / PI);
        mean -= step;
        if step.abs() <= 1e-12 * amplitude {
            break;
        }
    }
    angle_at(mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First harmonic by stepping through a settled period.
    fn stepped(law: RestoringLaw, amplitude: f64) -> Complex64 {
        let steps = 20_000;
        let phase = |i: usize| 2.0 * PI * i as f64 / steps as f64;
        let motions: Vec<f64> = (0..3 * steps).map(|i| amplitude * phase(i).cos()).collect();
        let settled = law.forces(&motions).into_iter().enumerate().skip(2 * steps);
        let first = settled.map(|(i, force)| force * Complex64::from_polar(2.0 / steps as f64, -phase(i)));
        first.sum::<Complex64>() / amplitude
    }

    #[test]
    fn equivalent_stiffness_is_the_first_harmonic_of_the_force() {
        let laws = [
            RestoringLaw::Cubic { stiffness3: 3e9 },
            RestoringLaw::Friction { slip_force: 2.0, stiffness: 4e4 },
            RestoringLaw::Gap { clearance: 5e-5, stiffness: 2e5 },
        ];
        for law in laws {
            for amplitude in [3e-5, 6e-5, 3e-4] {
                let (found, expected) = (equivalent(&law, amplitude, 0.0), stepped(law, amplitude));
                assert!(
                    (found - expected).norm() < 1e-3 * expected.norm() + 1e-3,
                    "{law:?}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_stop_pushes_the_joint_away_and_is_touched_for_less_time() {
        let law = RestoringLaw::Gap { clearance: 5e-5, stiffness: 2e5 };
        let (held, free) = (equivalent(&law, 1e-4, 0.0), equivalent(&law, 1e-4, 1e-5));
        assert!(free.re < 0.9 * held.re && free.re > 0.1 * held.re, "{held} {free}");
    }
}
