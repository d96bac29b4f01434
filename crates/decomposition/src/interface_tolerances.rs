//! The interfaces by line with what the fixture's tolerances and the joint's own mass leave uncertain.

use crate::settings::differences::TOLERANCE_STEP;
use crate::spectrum::read_at_s;
use crate::{CrossingFrfs, IdlePoints, InterfaceSpectrum, JointSpectrum, Sides, interface_spectrum};
use jointscope_fixture::Fixture;
use jointscope_frf::fit_rigid_motion;
use jointscope_spectra::FrfSet;

/// The interfaces by line of the joint that `sides` were taken apart at, from its `spectrum` by the exact
/// relation. `mass` is the joint's own with its standard deviation, kg; `exact` takes bare numbers of the
/// fixture as exact.
///
/// Every quantity moves by a small share of its deviation and the lines are read anew, as for the averages.
/// What the mass and the fixture's quantities have in common in the fit that told the mass is left out: each
/// counts by itself.
///
/// `None` of a joint that is no beam, and where [`interface_spectrum`] is.
pub(crate) fn interfaces_with_tolerances(
    frfs: &FrfSet,
    sides: &Sides,
    spectrum: &JointSpectrum,
    (mass, mass_std): (f64, f64),
    exact: bool,
) -> Option<InterfaceSpectrum> {
    let fixture = sides.fixture();
    let bending_stiffness = |fixture: &Fixture| fixture.joints()[sides.joint_index()].law.bending_stiffness();
    let stated = bending_stiffness(fixture)?;
    let found = interface_spectrum(spectrum, stated, mass)?;
    let quantities = if exact { fixture.quantities_exact() } else { fixture.quantities() };
    let idle = IdlePoints::of(fixture, frfs.pairs());
    let moved = quantities.iter().enumerate().filter_map(|(index, quantity)| {
        let std = quantity.std.filter(|std| *std > 0.0 && !idle.have(quantity.owner))?;
        let mut other = fixture.clone();
        other.set_quantities([(index, quantity.value + TOLERANCE_STEP * std)]);
        let stated = bending_stiffness(&other)?;
        Some((read_with(&other, frfs, sides, spectrum)?, stated, mass))
    });
    let of_mass = (mass_std > 0.0).then(|| (spectrum.clone(), stated, mass + TOLERANCE_STEP * mass_std));
    Some(found.with_tolerances(spectrum, moved.chain(of_mass), TOLERANCE_STEP))
}

/// The spectrum's H41 and sides as another fixture has them; of K and C nothing is asked.
fn read_with(
    fixture: &Fixture,
    frfs: &FrfSet,
    stated: &Sides,
    spectrum: &JointSpectrum,
) -> Option<JointSpectrum> {
    let sides = Sides::of(fixture, Some(&stated.joint().name)).ok()?;
    let plan = CrossingFrfs::of(frfs, &sides).ok()?;
    let (loaded, responding) = (&plan.loaded, &plan.responding);
    let compliances =
        sides.compliances(frfs.lines(), (loaded.0, loaded.1), (responding.0, responding.1)).ok()?;
    let h41 = read_at_s(fit_rigid_motion(frfs, &plan.layout).ok()?, &sides);
    let (solved, masked) = (Vec::new(), Vec::new());
    Some(JointSpectrum { h41, decay: sides.decay(), sides: compliances, solved, masked, ..*spectrum })
}
