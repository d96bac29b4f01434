//! What could be measured: every FRF between the fixture's points, masses at them, no supports, averages, and
//! every quantity that scales and callipers reach.

use crate::PlanError;
use crate::measure::{Measure, two_digits};
use crate::settings::candidates::{
    ADDED_MASS, ADDED_MASS_DEVIATION, ADDED_MASS_PLACE_DEVIATION, AVERAGES, CALLIPER, KNIFE_EDGE,
    MASS_PLACES, MOST_POINTS, NARROWER, PENDULUM, SCALES,
};
use jointscope_diagnosis::Hypothesis;
use jointscope_fixture::{Fixture, QuantityKey};
use jointscope_spectra::{Channel, Dof, FrfPair};

/// The points between which FRFs are considered: those that are named, or all of a small structure; of many
/// those where something is, and others evenly.
pub(crate) fn points(
    fixture: &Fixture,
    named: &[String],
    present: &[FrfPair],
) -> Result<Vec<String>, PlanError> {
    let all: Vec<&String> = fixture.points().iter().map(|point| &point.name).collect();
    if let Some(point) = named.iter().find(|name| !all.contains(name)) {
        let known: Vec<&str> = all.iter().take(MOST_POINTS).map(|name| name.as_str()).collect();
        let more = if all.len() > MOST_POINTS { ", …" } else { "" };
        return Err(PlanError::UnknownPoint {
            point: point.clone(),
            known: format!("{}{more}", known.join(", ")),
        });
    }
    if !named.is_empty() {
        return Ok(named.to_vec());
    }
    if all.len() <= MOST_POINTS {
        return Ok(all.into_iter().cloned().collect());
    }
    let is_channel = |name: &String| {
        present.iter().any(|pair| pair.response.point == *name || pair.reference.point == *name)
    };
    let held: Vec<usize> = fixture.held_points().collect();
    let mut chosen: Vec<usize> = (0..all.len()).filter(|&i| is_channel(all[i])).collect();
    let mut others: Vec<usize> = (0..all.len()).filter(|i| !chosen.contains(i)).collect();
    others.sort_by_key(|i| !held.contains(i));
    let free = others.split_off(others.iter().filter(|i| held.contains(i)).count());
    chosen.extend(others);
    let left = MOST_POINTS.saturating_sub(chosen.len());
    chosen.extend((0..left).filter_map(|k| free.get(k * free.len() / left.max(1))));
    chosen.sort_unstable();
    chosen.dedup();
    Ok(chosen.into_iter().map(|i| all[i].clone()).collect())
}

/// The fixture where FRFs are recorded, or considered between these points: what only other points would show
/// is exact.
pub(crate) fn with_idle_points_exact(fixture: Fixture, points: &[String], present: &[FrfPair]) -> Fixture {
    let driving = points.iter().map(|point| FrfPair::transverse(point, point));
    let channels: Vec<FrfPair> = driving.chain(present.iter().cloned()).collect();
    jointscope_diagnosis::with_idle_points_exact(fixture, &channels)
}

/// The FRFs between these points that were not recorded yet.
pub(crate) fn frfs(points: &[String], present: &[FrfPair]) -> Vec<FrfPair> {
    let all = points.iter().flat_map(|reference| points.iter().map(move |response| (response, reference)));
    all.map(|(response, reference)| FrfPair::transverse(response, reference))
        .filter(|pair| !present.contains(pair))
        .collect()
}

/// The transverse channels of one end of the FRFs, each once.
fn ends(present: &[FrfPair], end: impl Fn(&FrfPair) -> &Channel) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for channel in present.iter().map(end).filter(|channel| channel.dof == Dof::Translation) {
        if !all.contains(&channel.point) {
            all.push(channel.point.clone());
        }
    }
    all
}

/// Single FRFs, and those that one more hammer point or one more sensor gives at once.
pub(crate) fn of_frfs(points: &[String], present: &[FrfPair]) -> Vec<Measure> {
    let new = frfs(points, present);
    let mut all: Vec<Measure> = new.iter().map(|frf| Measure::Frf { frf: frf.clone() }).collect();
    let (sensors, hammers) = (ends(present, |p| &p.response), ends(present, |p| &p.reference));
    for point in points {
        let together = |frfs: Vec<FrfPair>| -> Option<Vec<FrfPair>> {
            let frfs: Vec<FrfPair> = frfs.into_iter().filter(|pair| new.contains(pair)).collect();
            (frfs.len() > 1).then_some(frfs)
        };
        let of_hammer = sensors.iter().map(|sensor| FrfPair::transverse(sensor, point)).collect();
        if let Some(frfs) = together(of_hammer).filter(|_| !hammers.contains(point)) {
            all.push(Measure::HammerAt { point: point.clone(), frfs });
        }
        let of_sensor = hammers.iter().map(|hammer| FrfPair::transverse(point, hammer)).collect();
        if let Some(frfs) = together(of_sensor).filter(|_| !sensors.contains(point)) {
            all.push(Measure::SensorAt { point: point.clone(), frfs });
        }
    }
    all
}

/// More averages.
pub(crate) fn averages() -> Measure {
    Measure::Averages { times: AVERAGES }
}

/// Masses at the points, one a place, and the structure off its supports.
pub(crate) fn changes(fixture: &Fixture, points: &[String]) -> Vec<Measure> {
    let mut places: Vec<(usize, f64)> = Vec::new();
    for point in points.iter().filter_map(|name| fixture.point(name)) {
        let same = |&(body, x): &(usize, f64)| body == point.body && (x - point.x.value).abs() < 1e-6;
        // A body that does not turn feels a mass the same wherever it is.
        let turns = fixture.bodies()[point.body].kind.rotates();
        if !places.iter().any(|place| same(place) || (!turns && place.0 == point.body)) {
            places.push((point.body, point.x.value));
        }
    }
    if places.len() > MASS_PLACES {
        let count = places.len();
        places = (0..MASS_PLACES).map(|k| places[k * (count - 1) / (MASS_PLACES - 1)]).collect();
    }
    let of = |(body, x): (usize, f64)| {
        let name = fixture.bodies()[body].name.clone();
        let mass = one_two_five(ADDED_MASS * fixture.bodies()[body].kind.mass());
        Measure::AddedMass {
            mass,
            mass_std: ADDED_MASS_DEVIATION * mass,
            body: name,
            x,
            x_std: ADDED_MASS_PLACE_DEVIATION,
        }
    };
    let off_its_supports = (!fixture.supports().is_empty()).then_some(Measure::HungFreely);
    places.into_iter().map(of).chain(off_its_supports).collect()
}

/// The quantities of a hypothesis that can be measured better than they are known.
pub(crate) fn quantities(hypothesis: &Hypothesis) -> Vec<Measure> {
    let of = |quantity: &jointscope_fixture::NamedQuantity| {
        let reached = match quantity.key {
            QuantityKey::Mass | QuantityKey::PointMass(_) => SCALES * quantity.value.abs(),
            QuantityKey::Inertia => PENDULUM * quantity.value.abs(),
            QuantityKey::Abscissa
            | QuantityKey::PointMassAbscissa(_)
            | QuantityKey::From
            | QuantityKey::To => CALLIPER,
            QuantityKey::CentreOfGravity => KNIFE_EDGE,
            _ => return None,
        };
        let worth = quantity.std.is_none_or(|std| reached <= NARROWER * std);
        (worth && reached > 0.0).then(|| Measure::Quantity {
            path: quantity.path.clone(),
            std: two_digits(reached),
            unit: quantity.key.unit(),
        })
    };
    hypothesis.tolerances().iter().filter_map(|tolerance| of(&tolerance.quantity)).collect()
}

/// The nearest of 1, 2 and 5 times a power of ten.
fn one_two_five(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
    let nearest = |a: &f64, b: &f64| (a / value).ln().abs().total_cmp(&(b / value).ln().abs());
    // Of a decade to the minus three, one times it prints with rounding.
    let chosen = steps.into_iter().min_by(nearest).unwrap_or(value);
    two_digits(chosen)
}
