//! Points that nothing in a test depends on: thousands of them, as a geometry file has, must not be fitted.

use jointscope_fixture::{Fixture, Place, QuantityOwner, Spread};
use jointscope_spectra::FrfPair;

/// Which points neither hold anything nor are channels of `pairs`.
fn idle(fixture: &Fixture, pairs: &[FrfPair]) -> Vec<bool> {
    let named = |name: &str| fixture.points().iter().position(|point| point.name == name);
    let channels = pairs.iter().flat_map(|pair| [&pair.response.point, &pair.reference.point]);
    let places = fixture.effects().filter_map(|effect| match &effect.place {
        Place::Point(name) => Some(name.as_str()),
        Place::Response(name) | Place::Reference(name) => Some(name.strip_suffix(":theta").unwrap_or(name)),
        _ => None,
    });
    let of_names = channels.map(String::as_str).chain(places).filter_map(named);
    let mut idle = vec![true; fixture.points().len()];
    of_names.chain(fixture.held_points()).for_each(|point| idle[point] = false);
    idle
}

/// The fixture with the abscissae of its idle points taken as exact.
pub fn with_idle_points_exact(mut fixture: Fixture, pairs: &[FrfPair]) -> Fixture {
    let idle = idle(&fixture, pairs);
    for quantity in fixture.quantities_mut() {
        if let QuantityOwner::Point(point) = quantity.owner
            && idle[point]
        {
            quantity.quantity.spread = Spread::Stated(0.0);
        }
    }
    fixture
}

/// A fixture that came of such a one, its points known as well as `stated` says.
pub fn as_known(mut fixture: Fixture, stated: &Fixture) -> Fixture {
    let known: Vec<Spread> = stated.points().iter().map(|point| point.x.spread).collect();
    for quantity in fixture.quantities_mut() {
        if let QuantityOwner::Point(point) = quantity.owner
            && let Some(spread) = known.get(point)
        {
            quantity.quantity.spread = *spread;
        }
    }
    fixture
}
