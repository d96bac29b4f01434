//! Bars: cuboids of one material, and what follows from their dimensions.

use crate::material::{Material, MaterialError};
use std::str::FromStr;

/// A cuboid of one material.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// Along x, m.
    pub length: f64,
    /// Across, m.
    pub width: f64,
    /// Along y, the direction of the motion, m.
    pub height: f64,
    /// What it is made of.
    pub material: Material,
}

/// Why a text is no bar.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BarError {
    /// No dimensions.
    #[error(
        "`{0}` is not LENGTHxWIDTHxHEIGHT:MATERIAL with three lengths in mm above zero, such as 60x40x6:steel"
    )]
    Dimensions(String),
    /// A comma for a point.
    #[error("`{0}` has a comma within a number; write it with a decimal point, such as 60.5x40x6:steel")]
    Comma(String),
    /// Lengths that no block has.
    #[error(
        "`{0}` has no side of a millimetre, so its lengths look like metres; give them in mm, such as 60x40x6:steel"
    )]
    Metres(String),
    /// No material.
    #[error(transparent)]
    Material(#[from] MaterialError),
}

impl FromStr for Bar {
    type Err = BarError;

    /// `LENGTHxWIDTHxHEIGHT:MATERIAL`, mm.
    fn from_str(text: &str) -> Result<Self, BarError> {
        let bad = || BarError::Dimensions(text.to_owned());
        let (dimensions, material) = text.split_once(':').ok_or_else(bad)?;
        if dimensions.contains(',') {
            return Err(BarError::Comma(text.to_owned()));
        }
        let millimetres = |text: &str| {
            text.trim().parse::<f64>().ok().filter(|mm| mm.is_finite() && *mm > 0.0).map(|mm| 1e-3 * mm)
        };
        let sides: Option<Vec<f64>> = dimensions.split(['x', 'X', '×', '*']).map(millimetres).collect();
        let [length, width, height] = <[f64; 3]>::try_from(sides.ok_or_else(bad)?).map_err(|_| bad())?;
        if [length, width, height].iter().all(|side| *side < 1e-3) {
            return Err(BarError::Metres(text.to_owned()));
        }
        Ok(Bar { length, width, height, material: material.parse()? })
    }
}

/// A value and its standard deviation.
pub(crate) type Known = (f64, f64);

impl Bar {
    /// ρ L b h, kg; each side known to `ruler` (m).
    pub(crate) fn mass(&self, ruler: f64) -> Known {
        let mass = self.material.density * self.length * self.width * self.height;
        let sides = [self.length, self.width, self.height].map(|side| ruler / side);
        let relative = sides.iter().fold(self.material.density_std, |sum, side| sum.hypot(*side));
        (mass, relative * mass)
    }

    /// m (L² + h²)/12 about the centre of gravity, kg·m².
    pub(crate) fn inertia(&self, ruler: f64) -> Known {
        let (mass, mass_std) = self.mass(ruler);
        let square = self.length.powi(2) + self.height.powi(2);
        let sides = 2.0 * ruler * (self.length.powi(2) + self.height.powi(2)).sqrt() / square;
        let inertia = mass * square / 12.0;
        (inertia, inertia * (mass_std / mass).hypot(sides))
    }

    /// b h³/12, m⁴.
    pub(crate) fn second_moment(&self, ruler: f64) -> Known {
        let moment = self.width * self.height.powi(3) / 12.0;
        (moment, moment * (ruler / self.width).hypot(3.0 * ruler / self.height))
    }

    /// ρ b h, kg/m.
    pub(crate) fn mass_per_length(&self, ruler: f64) -> Known {
        let value = self.material.density * self.width * self.height;
        let sides = (ruler / self.width).hypot(ruler / self.height);
        (value, value * self.material.density_std.hypot(sides))
    }

    /// E, Pa.
    pub(crate) fn modulus(&self) -> Known {
        (self.material.youngs_modulus, self.material.modulus_std * self.material.youngs_modulus)
    }

    /// As it was asked for: `60 x 40 x 6 mm of steel`.
    pub(crate) fn says(&self) -> String {
        let mm = [self.length, self.width, self.height].map(|side| (1e7 * side).round() / 1e4);
        format!("{} x {} x {} mm of {}", mm[0], mm[1], mm[2], self.material.name)
    }
}
