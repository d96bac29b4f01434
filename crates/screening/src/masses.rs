//! Masses and inertias of a fixture in another unit than they say, told by what was recorded.
//!
//! Masses and inertias that are all in grams belong to one structure: no number by itself is odd. But the
//! recording weighs it: where the fixture's FRFs are nothing like those recorded, and like them with masses,
//! inertias or both over what lies between two units, that was meant. A recording in another unit looks alike
//! where only mass counts, for its levels are off by the same factor; stiffness tells the two apart, since
//! other masses move all natural frequencies and another unit of the FRFs moves none.

use crate::levels::{better, median, ratios_apart};
use crate::settings::masses::{MOST_BODIES, MOST_LINES, UNLIKE_FIXTURE};
use crate::{Implausible, plausible};
use jointscope_fixture::{Fixture, Nature, QuantityKey, QuantityOwner};
use jointscope_lumped::{Instrument, accelerances};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

/// What masses are multiplied by to be in kg, and what they look like before.
const MASSES: [(f64, &str); 7] = [
    (1e-3, "grams"),
    (1e-6, "milligrams"),
    (0.453_592_37, "pounds"),
    (0.028_349_5, "ounces"),
    (1e3, "tonnes"),
    (14.593_9, "slugs"),
    (175.127, "lbf·s²/in"),
];
/// The same of moments of inertia.
const INERTIAS: [(f64, &str); 7] = [
    (1e-3, "g·m²"),
    (1e-6, "kg·mm²"),
    (1e-9, "g·mm²"),
    (1e-4, "kg·cm²"),
    (1e-7, "g·cm²"),
    (0.042_140_1, "lb·ft²"),
    (2.926_397e-4, "lb·in²"),
];
/// Slips of the decimal point in one number.
const DECIMAL: [f64; 4] = [0.1, 0.01, 10.0, 100.0];

/// Another reading of the fixture.
struct Reading {
    place: String,
    /// `the masses and inertias look like grams and g·m²`.
    looks: String,
    /// What quantities of which body (all where `None`) are multiplied by: masses, inertias.
    body: Option<usize>,
    mass: f64,
    inertia: f64,
}

/// What is wrong with the masses or inertias of `fixture`; `modelled` are its accelerances. `in_another_unit`
/// is the median |ln(|H|/|Ĥ|)| that another unit of the FRFs leaves, and between which units it lies, where
/// one does: both are said where both are like the recording.
pub(crate) fn slip(
    frfs: &FrfSet,
    modelled: &[Complex64],
    fixture: &Fixture,
    in_another_unit: Option<(f64, &str)>,
) -> Option<Implausible> {
    let stated = median(ratios_apart(frfs.all_values(), modelled))?;
    // Numbers that do not belong together are told by themselves.
    if stated < UNLIKE_FIXTURE || plausible(fixture).is_err() {
        return None;
    }
    let some = thinned(frfs)?;
    let apart = |reading: &Reading| {
        let other = reading.of(fixture)?;
        let modelled = accelerances(&other, some.pairs(), some.lines(), Instrument::AsRecorded).ok()?;
        median(ratios_apart(some.all_values(), &modelled))
    };
    let read = readings(fixture).into_iter().filter_map(|reading| Some((apart(&reading)?, reading)));
    let (apart, reading) = read.min_by(|a, b| a.0.total_cmp(&b.0))?;
    if apart > UNLIKE_FIXTURE || !better(apart, stated) {
        return None;
    }
    let also = match in_another_unit {
        Some((other, _)) if better(other, apart) => return None,
        Some((other, units)) if !better(apart, other) => {
            format!(
                ", or the recording's levels are off as where {units} are taken for each other: no stiffness in the band tells which"
            )
        }
        _ => String::new(),
    };
    Some(Implausible {
        place: reading.place,
        problem: format!(
            "the recording's levels are off the fixture's by a factor of {:.1} in the median, and by {:.2} with another reading of its numbers",
            stated.exp(),
            apart.exp()
        ),
        advice: format!(": {}{also}", reading.looks),
    })
}

/// The FRFs on fewer lines.
fn thinned(frfs: &FrfSet) -> Option<FrfSet> {
    let every = frfs.lines().len().div_ceil(MOST_LINES);
    let hz = frfs.lines().hz();
    frfs.on_lines(|line| line % every == 0 && hz[line] > 0.0)
}

fn readings(fixture: &Fixture) -> Vec<Reading> {
    let mut all = Vec::new();
    let bodies = || "bodies".to_owned();
    for (factor, unit) in MASSES {
        let looks = format!("all masses look like {unit}, and the inertias like {unit} times m²");
        all.push(Reading { place: bodies(), looks, body: None, mass: factor, inertia: factor });
        let looks = format!("all masses look like {unit}");
        all.push(Reading { place: bodies(), looks, body: None, mass: factor, inertia: 1.0 });
    }
    for (factor, unit) in INERTIAS {
        let looks = format!("all inertias look like {unit}");
        all.push(Reading { place: bodies(), looks, body: None, mass: 1.0, inertia: factor });
    }
    for (index, body) in fixture.bodies().iter().enumerate().take(MOST_BODIES) {
        for factor in DECIMAL {
            let off = match factor < 1.0 {
                true => format!("{} times too large", factor.recip()),
                false => format!("{factor} times too small"),
            };
            let reading = |key: &str, mass, inertia| Reading {
                place: format!("bodies/{}/{key}", body.name),
                looks: format!("the {key} of {} looks {off}", body.name),
                body: Some(index),
                mass,
                inertia,
            };
            all.push(reading("inertia", 1.0, factor));
            all.push(reading("mass", factor, 1.0));
        }
    }
    all
}

impl Reading {
    /// The fixture as it reads; `None` where it has nothing of the kind, or does not claim to know it.
    fn of(&self, fixture: &Fixture) -> Option<Fixture> {
        let mut other = fixture.clone();
        let mut changed = false;
        for quantity in fixture.quantities() {
            let QuantityOwner::Body(index) = quantity.owner else { continue };
            let factor = match (quantity.nature, quantity.key) {
                _ if self.body.is_some_and(|body| body != index) => 1.0,
                (Nature::Inertia, _) => self.inertia,
                (Nature::Mass, _) | (_, QuantityKey::MassPerLength) => self.mass,
                _ => 1.0,
            };
            if factor == 1.0 {
                continue;
            }
            // A number of which nothing is known is fitted, wherever it starts.
            quantity.std?;
            other.set_quantity(quantity.owner, quantity.key, factor * quantity.value);
            changed = true;
        }
        changed.then_some(other)
    }
}
