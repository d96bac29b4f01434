//! Natural frequencies that a family is drawn for.

use crate::{Structure, StructureError};
use jointscope_fixture::Fixture;

/// Natural frequencies in Hz, ascending, of the free assembly without effects; rigid motions are left out.
pub(crate) fn elastic_frequencies(fixture: &Fixture) -> Result<Vec<f64>, StructureError> {
    let modes = Structure::of(&fixture.clone().with_physics(Vec::new())?)?.natural_frequencies()?;
    let supported = !fixture.supports().is_empty();
    let highest = modes.last().copied().unwrap_or(0.0);
    // On supports the rigid motions are slow but not still; they are soft by intent.
    let still = if supported { 12.0 } else { 2e-6 * highest };
    Ok(modes.into_iter().filter(|f| *f > still).collect())
}
