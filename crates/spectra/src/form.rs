//! Receptance, mobility and accelerance, and the powers of iω between them.

use num_complex::Complex64;

/// What an FRF's numerator is: displacement, velocity or acceleration, each per unit of force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrfForm {
    /// Displacement per force (compliance), m/N.
    Receptance,
    /// Velocity per force, m/(N·s).
    Mobility,
    /// Acceleration per force, m/(N·s²) = 1/kg.
    Accelerance,
}

impl FrfForm {
    /// Number of times the displacement is differentiated.
    pub fn order(self) -> i32 {
        match self {
            FrfForm::Receptance => 0,
            FrfForm::Mobility => 1,
            FrfForm::Accelerance => 2,
        }
    }

    /// The form's name.
    pub fn name(self) -> &'static str {
        match self {
            FrfForm::Receptance => "receptance",
            FrfForm::Mobility => "mobility",
            FrfForm::Accelerance => "accelerance",
        }
    }

    /// The factor (iω)ⁿ that turns a value of this form into `target`, `omega` in rad/s; `None`
    /// at 0 Hz where a division would be needed.
    pub fn factor_to(self, target: FrfForm, omega: f64) -> Option<Complex64> {
        let order = target.order() - self.order();
        if omega == 0.0 && order < 0 {
            return None;
        }
        Some(Complex64::new(0.0, omega).powi(order))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_accelerance_is_minus_omega_squared_times_the_receptance() {
        let factor = FrfForm::Receptance.factor_to(FrfForm::Accelerance, 10.0).unwrap();
        assert!((factor - Complex64::new(-100.0, 0.0)).norm() < 1e-12);
        let back = FrfForm::Accelerance.factor_to(FrfForm::Receptance, 10.0).unwrap();
        assert!((factor * back - 1.0).norm() < 1e-15);
    }

    #[test]
    fn nothing_can_be_integrated_at_zero_hertz() {
        assert_eq!(FrfForm::Accelerance.factor_to(FrfForm::Receptance, 0.0), None);
        assert_eq!(FrfForm::Receptance.factor_to(FrfForm::Accelerance, 0.0), Some(Complex64::ZERO));
    }
}
