//! Figures with the deviations that a fixture's tolerances leave them.

use crate::settings::figures::{LEAST_CHANGE, RELATIVE_STEP};
use jointscope_fixture::{Fixture, Place, QuantityOwner};
use serde::Serialize;
use std::collections::BTreeSet;

/// A figure computed from a fixture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Figure {
    /// Its value, SI.
    pub value: f64,
    /// One standard deviation from those of the fixture's numbers; `None` where it rests on a number of
    /// unknown deviation.
    pub std: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
}

/// Standard deviations of what `of` makes of a fixture, as a Taylor series of first order has them: each
/// uncertain number is moved by its deviation, the changes are added as squares. `None` where the figure
/// rests on a number of unknown deviation, or where the moved fixture has no such figure. Points that hold
/// nothing and are none of `channels` are passed over: no figure rests on where they are, and there may be
/// thousands of them.
pub(crate) fn deviations(
    fixture: &Fixture,
    nominal: &[f64],
    channels: &BTreeSet<&str>,
    of: impl Fn(&Fixture) -> Option<Vec<f64>>,
) -> Vec<Option<f64>> {
    let mut squares = vec![Some(0.0); nominal.len()];
    let mut moved = fixture.clone();
    let held = in_use(fixture, channels);
    for (_, quantity) in fixture.uncertain_quantities(false) {
        if matches!(quantity.owner, QuantityOwner::Point(point) if !held[point]) {
            continue;
        }
        let unknown = RELATIVE_STEP * if quantity.value == 0.0 { 1.0 } else { quantity.value.abs() };
        let (owner, key) = (quantity.owner, quantity.key);
        moved.set_quantity(owner, key, quantity.value + quantity.std.unwrap_or(unknown));
        let figures = of(&moved);
        moved.set_quantity(owner, key, quantity.value);
        let mut figures = figures.unwrap_or_default().into_iter();
        for (square, nominal) in squares.iter_mut().zip(nominal) {
            // What such a step does away with has a deviation that no first-order series tells.
            let Some(figure) = figures.next() else {
                *square = None;
                continue;
            };
            let change = figure - nominal;
            match quantity.std {
                Some(_) => *square = square.map(|square| square + change * change),
                None if change.abs() > LEAST_CHANGE * nominal.abs() => *square = None,
                None => {}
            }
        }
    }
    squares.into_iter().map(|square| square.map(f64::sqrt)).collect()
}

/// Which points of the fixture joints, supports or effects are at, or are among the channels.
fn in_use(fixture: &Fixture, channels: &BTreeSet<&str>) -> Vec<bool> {
    let of_effects: BTreeSet<&str> = fixture
        .effects()
        .filter_map(|effect| match &effect.place {
            Place::Point(name) => Some(name.as_str()),
            Place::Response(name) | Place::Reference(name) => {
                Some(name.strip_suffix(":theta").unwrap_or(name))
            }
            _ => None,
        })
        .collect();
    let named = |name: &str| channels.contains(name) || of_effects.contains(name);
    let mut used: Vec<bool> = fixture.points().iter().map(|point| named(&point.name)).collect();
    fixture.held_points().for_each(|point| used[point] = true);
    used
}
