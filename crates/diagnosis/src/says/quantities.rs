//! The fixture's quantities: units, and where a fit left them.

use crate::hypothesis::{Hypothesis, Tolerance};

impl Tolerance {
    /// The unit of the quantity, by its name in the file.
    pub fn unit(&self) -> &'static str {
        let section = self.path.split('/').next().unwrap_or_default();
        let tail: Vec<&str> = self.path.rsplit('/').take(3).collect();
        match (section, tail.as_slice()) {
            ("joints", ["0", "0", "stiffness"]) => "N/m",
            ("joints", ["1", "0", "stiffness"]) => "N/rad",
            ("joints", ["1", "1", "stiffness"]) => "N*m/rad",
            ("joints", ["0", "0", "damping"]) => "N*s/m",
            ("joints", ["1", "0", "damping"]) => "N*s/rad",
            ("joints", ["1", "1", "damping"]) => "N*m*s/rad",
            ("damping", ["mass", ..]) => "1/s",
            ("damping", ["stiffness", ..]) => "s",
            ("damping", _) => "",
            (_, ["mass", ..]) => "kg",
            (_, ["inertia", ..]) => "kg*m^2",
            (_, ["x" | "x_cg" | "from" | "to", ..]) => "m",
            (_, ["youngs_modulus", ..]) => "Pa",
            (_, ["second_moment", ..]) => "m^4",
            (_, ["mass_per_length", ..]) => "kg/m",
            (_, ["stiffness", ..]) => "N/m",
            (_, ["damping", ..]) => "N*s/m",
            (_, ["rotational_stiffness", ..]) => "N*m/rad",
            (_, ["rotational_damping", ..]) => "N*m*s/rad",
            _ => "",
        }
    }
}

impl Hypothesis {
    /// Where quantity `index` of [`Hypothesis::tolerances`] stands, SI.
    pub fn ended_at(&self, index: usize) -> f64 {
        let Some(tolerance) = self.tolerances().get(index) else { return f64::NAN };
        let tenth = if tolerance.nominal == 0.0 { 1.0 } else { 0.1 * tolerance.nominal.abs() };
        tolerance.nominal + self.departure(index) * tolerance.std.unwrap_or(tenth)
    }
}
