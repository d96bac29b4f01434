//! Units that the analyst states for files which state none: `--assume-units`.

use jointscope_spectra::FrfForm;

use crate::unit::{Dimension, Unit};

/// What the analyst says of the units where a file states none: `g,lbf`, the response's and the force's.
///
/// ```
/// use jointscope_recordings::AssumedUnits;
/// assert!(AssumedUnits::parse("g,lbf").is_ok());
/// assert!(AssumedUnits::parse("mm/s, N").is_ok());
/// let error = AssumedUnits::parse("lbf").unwrap_err();
/// assert_eq!(error.to_string(), "`lbf` is not the units of response and force, such as `g,lbf` or `m/s^2,N`");
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct AssumedUnits {
    pub(crate) form: FrfForm,
    pub(crate) response: NamedUnit,
    pub(crate) force: NamedUnit,
}

/// A unit and its spelling.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NamedUnit {
    pub si: f64,
    pub text: String,
}

/// Why assumed units make no sense.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AssumedUnitsError {
    /// Not two units.
    #[error("`{0}` is not the units of response and force, such as `g,lbf` or `m/s^2,N`")]
    Form(String),
    /// The first is no unit of a translation.
    #[error("`{0}` is no unit of a displacement, velocity or acceleration, such as `mm`, `m/s` or `g`")]
    Response(String),
    /// The second is no unit of a force.
    #[error("`{0}` is no unit of a force, such as `N` or `lbf`")]
    Force(String),
}

impl AssumedUnits {
    /// Reads `response,force`, such as `g,lbf`.
    ///
    /// # Errors
    /// Anything but a unit of translational motion, a comma and a unit of force.
    pub fn parse(text: &str) -> Result<Self, AssumedUnitsError> {
        let (response, force) =
            text.split_once(',').ok_or_else(|| AssumedUnitsError::Form(text.to_owned()))?;
        let (response, force) = (response.trim(), force.trim());
        let motion = Unit::parse(response)
            .and_then(|unit| Some((unit, form_of(unit.dimension, false)?)))
            .ok_or_else(|| AssumedUnitsError::Response(response.to_owned()))?;
        let pull = Unit::parse(force)
            .filter(|unit| unit.dimension == Dimension::FORCE)
            .ok_or_else(|| AssumedUnitsError::Force(force.to_owned()))?;
        Ok(AssumedUnits {
            form: motion.1,
            response: NamedUnit { si: motion.0.si, text: response.to_owned() },
            force: NamedUnit { si: pull.si, text: force.to_owned() },
        })
    }
}

pub(crate) const FORMS: [FrfForm; 3] = [FrfForm::Receptance, FrfForm::Mobility, FrfForm::Accelerance];

/// The form whose numerator has this dimension.
fn form_of(dimension: Dimension, rotational: bool) -> Option<FrfForm> {
    FORMS.into_iter().find(|form| dimension == Dimension::motion(form.order(), rotational))
}

/// The numerator's name in the plural, for notes and messages.
pub(crate) fn motion_name(form: FrfForm) -> &'static str {
    match form {
        FrfForm::Receptance => "displacements",
        FrfForm::Mobility => "velocities",
        FrfForm::Accelerance => "accelerations",
    }
}
