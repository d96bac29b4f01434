//! Materials of test benches.

use std::str::FromStr;

/// An isotropic elastic material, with what handbooks' values of it scatter by.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Its relative standard deviation.
    pub modulus_std: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Its relative standard deviation.
    pub density_std: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
}

/// Why a text is no material.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no material `{0}`; take one of {known}, or Young's modulus in Pa and density in kg/m^3 such as 2.07e11,7850", known = names())]
pub struct MaterialError(String);

/// Name, E in Pa with its relative deviation, density in kg/m³ with its, Poisson's ratio. Deviations are
/// those between alloys and tempers of one name.
const TABLE: [(&str, f64, f64, f64, f64, f64); 11] = [
    ("steel", 2.07e11, 0.02, 7850.0, 0.005, 0.29),
    ("stainless", 1.95e11, 0.03, 7950.0, 0.01, 0.29),
    ("aluminium", 7.0e10, 0.02, 2700.0, 0.01, 0.33),
    ("brass", 1.0e11, 0.05, 8500.0, 0.015, 0.34),
    ("copper", 1.2e11, 0.04, 8930.0, 0.005, 0.34),
    ("titanium", 1.12e11, 0.04, 4430.0, 0.01, 0.34),
    ("magnesium", 4.5e10, 0.03, 1780.0, 0.01, 0.35),
    ("cast-iron", 1.1e11, 0.15, 7200.0, 0.02, 0.26),
    ("glass", 7.0e10, 0.05, 2500.0, 0.01, 0.22),
    ("pmma", 3.2e9, 0.1, 1190.0, 0.01, 0.37),
    ("abs", 2.2e9, 0.15, 1050.0, 0.03, 0.37),
];

/// The materials that have a name.
fn names() -> String {
    TABLE.iter().map(|row| row.0).collect::<Vec<_>>().join(", ")
}

/// Deviations, and Poisson's ratio, of a material stated by its two numbers.
const OWN: (f64, f64, f64) = (0.02, 0.01, 0.3);

impl FromStr for Material {
    type Err = MaterialError;

    /// `steel`, or `E,density` in Pa and kg/m³.
    fn from_str(text: &str) -> Result<Self, MaterialError> {
        let unknown = || MaterialError(text.to_owned());
        let name = match text.trim().to_lowercase().as_str() {
            "aluminum" => "aluminium".to_owned(),
            "plexiglass" | "acrylic" => "pmma".to_owned(),
            name => name.to_owned(),
        };
        if let Some(&(name, youngs_modulus, modulus_std, density, density_std, poisson_ratio)) =
            TABLE.iter().find(|row| row.0 == name)
        {
            let name = name.to_owned();
            return Ok(Material { name, youngs_modulus, modulus_std, density, density_std, poisson_ratio });
        }
        let (modulus, density) = text.split_once(',').ok_or_else(unknown)?;
        let number = |text: &str| text.trim().parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0);
        let (youngs_modulus, density) = number(modulus).zip(number(density)).ok_or_else(unknown)?;
        let (modulus_std, density_std, poisson_ratio) = OWN;
        let name = "material".to_owned();
        Ok(Material { name, youngs_modulus, modulus_std, density, density_std, poisson_ratio })
    }
}
