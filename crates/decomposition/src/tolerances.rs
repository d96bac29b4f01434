//! What the fixture's own uncertainty does to the joint found.

use crate::interfaces::left_over;
use crate::likelihood::continued;
use crate::{Averages, DecompositionError, LikelihoodFit, Relation, Sides, decompose};
use jointscope_averaging::Band;
use jointscope_fixture::{Fixture, JointLaw};
use jointscope_linalg::RealMatrix2;
use jointscope_spectra::FrfSet;

/// By how much the joint found changes when one quantity of the fixture moves by its standard deviation.
#[derive(Debug, Clone, PartialEq)]
pub struct ToleranceShare {
    /// Path of the quantity in the fixture file.
    pub path: String,
    /// Its standard deviation, SI.
    pub std: f64,
    /// Change of the plain averages of K and C.
    pub plain: (RealMatrix2, RealMatrix2),
    /// Change of the maximum-likelihood K and C.
    pub likelihood: Option<(RealMatrix2, RealMatrix2)>,
    /// Change of the interfaces' compliances (D11, D12, D22) and of the two of eq (6); of a beam joint only.
    pub compliance: Option<[f64; 5]>,
}

/// The shares of all quantities.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ToleranceShares {
    /// One by quantity.
    pub shares: Vec<ToleranceShare>,
    /// Paths of quantities whose share could not be found: uncertainties leave them out.
    pub lost: Vec<String>,
}

/// Moves every quantity of the fixture that has a standard deviation up and down by it, and decomposes again;
/// half of the difference is its share. `band` is the one averaged over, `fit_band` the one fitted (all lines
/// without); `fit` is the fit at the stated values, from which the others start.
///
/// `exact` takes bare numbers of the fixture as exact. A quantity whose change cannot be followed (a fixture that
/// becomes impossible, a fit that fails) is named among the lost ones.
///
/// # Errors
/// A fixture that cannot be taken apart at `joint`.
#[allow(clippy::too_many_arguments)]
pub fn tolerance_shares(
    fixture: &Fixture,
    joint: &str,
    frfs: &FrfSet,
    relation: Relation,
    band: Band,
    fit_band: Option<Band>,
    fit: Option<&LikelihoodFit>,
    exact: bool,
) -> Result<ToleranceShares, DecompositionError> {
    Sides::of(fixture, Some(joint))?;
    let quantities = if exact { fixture.quantities_exact() } else { fixture.quantities() };
    let mut result = ToleranceShares::default();
    for (index, quantity) in quantities.iter().enumerate() {
        let Some(std) = quantity.std.filter(|s| *s > 0.0) else { continue };
        let moved = |sign: f64| {
            let mut other = fixture.clone();
            if let Some(entry) = other.quantities_mut().into_iter().nth(index) {
                entry.quantity.value += sign * std;
            }
            Outcome::of(&other, joint, frfs, relation, (band, fit_band), fit)
        };
        let (Ok(up), Ok(down)) = (moved(1.0), moved(-1.0)) else {
            result.lost.push(quantity.path.clone());
            continue;
        };
        if fit.is_some() && (up.likelihood.is_none() || down.likelihood.is_none()) {
            result.lost.push(quantity.path.clone());
        }
        let half = |a: RealMatrix2, b: RealMatrix2| (a - b).scale(0.5);
        result.shares.push(ToleranceShare {
            path: quantity.path.clone(),
            std,
            plain: (half(up.plain.0, down.plain.0), half(up.plain.1, down.plain.1)),
            likelihood: up.likelihood.zip(down.likelihood).map(|(u, d)| (half(u.0, d.0), half(u.1, d.1))),
            compliance: up
                .compliance
                .zip(down.compliance)
                .map(|(u, d)| std::array::from_fn(|e| 0.5 * (u[e] - d[e]))),
        });
    }
    Ok(result)
}

/// What one fixture makes of the recording.
struct Outcome {
    plain: (RealMatrix2, RealMatrix2),
    likelihood: Option<(RealMatrix2, RealMatrix2)>,
    compliance: Option<[f64; 5]>,
}

impl Outcome {
    fn of(
        fixture: &Fixture,
        joint: &str,
        frfs: &FrfSet,
        relation: Relation,
        (band, fit_band): (Band, Option<Band>),
        fit: Option<&LikelihoodFit>,
    ) -> Result<Self, DecompositionError> {
        let sides = Sides::of(fixture, Some(joint))?;
        let spectrum = decompose(frfs, &sides, relation)?;
        let model = fit
            .map_or((spectrum.solved[0].stiffness, spectrum.solved[0].damping), |f| (f.stiffness, f.damping));
        let averages = Averages::of(&spectrum, Some(band), model)?;
        let exact = match relation {
            Relation::Exact => None,
            Relation::Paper => Some(decompose(frfs, &sides, Relation::Exact)?),
        };
        let exact = exact.as_ref().unwrap_or(&spectrum);
        let fitted = match fit {
            Some(fit) => continued(frfs, &sides, exact, fit_band, fit).ok(),
            None => None,
        };
        let compliance = match (&fitted, &sides.joint().law) {
            (Some(fitted), JointLaw::Beam { youngs_modulus, second_moment }) => {
                left_over(fitted.stiffness, youngs_modulus.value * second_moment.value, sides.length())
            }
            _ => None,
        };
        Ok(Outcome {
            plain: (averages.plain.stiffness, averages.plain.damping),
            likelihood: fitted.map(|f| (f.stiffness, f.damping)),
            compliance,
        })
    }
}
