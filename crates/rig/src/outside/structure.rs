//! Structures with physics that no effect describes.

use super::Outside;
use crate::physical::{BodyMode, Order};
use crate::{Assembly, Law, Row, Station, Structure, StructureError};
use jointscope_fixture::{Fixture, Support};
use jointscope_spectra::Channel;
use std::f64::consts::{PI, TAU};

/// Branches of spring and dashpot in series that make a springpot, from 1 Hz to 10 kHz.
const BRANCHES: usize = 17;
/// Resonances of a cable, one by one; those above them follow the body.
const RESONANCES: usize = 40;

impl Outside {
    /// The structure that `fixture` describes with this physics in it.
    pub(super) fn structure(&self, fixture: &Fixture) -> Result<Structure, StructureError> {
        let beyond: Vec<BodyMode<'_>> = match self {
            Outside::SecondBending { body, frequency, damping_ratio } => {
                let (frequency, damping_ratio) = (*frequency, *damping_ratio);
                vec![BodyMode { body, order: Order::Second, frequency, damping_ratio }]
            }
            _ => Vec::new(),
        };
        let (plain, bodies) = Structure::with_modes(fixture, &beyond)?;
        let station = |name: &str| -> Result<Station, StructureError> {
            Ok(Station {
                y: plain.motion(&Channel::transverse(name))?.clone(),
                theta: plain.motion(&Channel::rotational(name))?.clone(),
            })
        };
        // The motion of one place relative to what another, reaching over to it, carries along.
        let relative = |from: &str, to: &str| -> Result<Row, StructureError> {
            let x = |name: &str| fixture.point(name).map_or(0.0, |p| p.x.value);
            let [translation, _] = station(to)?.relative_to(&station(from)?, x(to) - x(from));
            Ok(translation)
        };
        let across = |name: &str| -> Result<Row, StructureError> {
            let joint =
                fixture.joint(name).ok_or_else(|| StructureError::UnknownPoint(format!("joint {name}")))?;
            relative(&fixture.points()[joint.from].name, &fixture.points()[joint.to].name)
        };
        let mut assembly = plain.assembly().clone();
        match self {
            Outside::Inerter { joint, inertance } => assembly.inertia(&across(joint)?, *inertance),
            Outside::Drift { .. }
            | Outside::CrossAxis { .. }
            | Outside::ClockError { .. }
            | Outside::SecondBending { .. } => {}
            Outside::Bypass { from, to, stiffness } => {
                assembly.spring(&relative(from, to)?, *stiffness, Law::ELASTIC);
            }
            Outside::Gyroscope { point, coupling } => {
                let Station { y, theta } = station(point)?;
                assembly.dashpots(&[y, theta], &[0.0, *coupling, -*coupling, 0.0]);
            }
            Outside::Springpot { joint, stiffness, order } => {
                springpot(&mut assembly, &across(joint)?, *stiffness, *order);
            }
            Outside::Cable { body, x, mass, frequency, damping_ratio } => {
                let index = fixture.bodies().iter().position(|known| known.name == *body);
                let index = index.ok_or_else(|| StructureError::UnknownPoint(format!("on body {body}")))?;
                let tied = bodies.station(index, *x)?.y;
                cable(&mut assembly, &tied, *mass, *frequency, *damping_ratio);
            }
            Outside::BaseMotion { mass, frequency, damping_ratio } => {
                let place = |support| {
                    let (body, x) = fixture.support_place(support);
                    Ok((bodies.station(body, x)?.y, support))
                };
                let held = fixture.supports().iter().map(place).collect::<Result<_, StructureError>>()?;
                table(&mut assembly, held, *mass, *frequency, *damping_ratio);
            }
        }
        let points: Vec<(String, Station)> = fixture
            .points()
            .iter()
            .map(|point| Ok((point.name.clone(), station(&point.name)?)))
            .collect::<Result<_, StructureError>>()?;
        Ok(Structure::new(assembly, points))
    }
}

/// A force across `relative` proportional to (iω)^`order`, of the magnitude `stiffness` (N/m) at 100 Hz.
fn springpot(assembly: &mut Assembly, relative: &Row, stiffness: f64, order: f64) {
    let (slowest, fastest) = (TAU.ln(), (TAU * 1e4).ln());
    let spacing = (fastest - slowest) / (BRANCHES - 1) as f64;
    // ∫ ν^α·s/(s + ν) dν/ν over all rates ν is s^α·π/sin(πα): a sum over branches of rate ν, a spring for the
    // slower ones, a dashpot for the faster ones.
    let unit = stiffness * (TAU * 100.0).powf(-order) * (PI * order).sin() / PI;
    let (slower, faster) = ((slowest - 0.5 * spacing).exp(), (fastest + 0.5 * spacing).exp());
    assembly.spring(relative, unit * slower.powf(order) / order, Law::ELASTIC);
    assembly.dashpot(relative, unit * faster.powf(order - 1.0) / (1.0 - order));
    for branch in 0..BRANCHES {
        let rate = (slowest + spacing * branch as f64).exp();
        let spring = unit * spacing * rate.powf(order);
        let dashpot = Row::coordinate(assembly.coordinate());
        assembly.spring(&relative.minus(&dashpot), spring, Law::ELASTIC);
        assembly.dashpot(&dashpot, spring / rate);
    }
}

/// A table of `mass` (kg) on a suspension of `frequency` (Hz), which carries the supports.
fn table(assembly: &mut Assembly, held: Vec<(Row, &Support)>, mass: f64, frequency: f64, damping_ratio: f64) {
    let (omega, table) = (TAU * frequency, Row::coordinate(assembly.coordinate()));
    assembly.inertia(&table, mass);
    assembly.spring(&table, mass * omega * omega, Law::ELASTIC);
    assembly.dashpot(&table, 2.0 * damping_ratio * mass * omega);
    for (place, support) in held {
        let stretch = place.minus(&table);
        let damping = support.damping.map_or(0.0, |damping| damping.value);
        // What was to ground is to the table.
        assembly.spring(&place, -support.stiffness.value, Law::ELASTIC);
        assembly.spring(&stretch, support.stiffness.value, Law::ELASTIC);
        assembly.dashpot(&place, -damping);
        assembly.dashpot(&stretch, damping);
    }
}

/// A string of `mass` (kg) from `tied` to ground, its resonances with both ends held at multiples of
/// `frequency` (Hz).
///
/// Its motion is a straight line from the body to ground, which has the static stiffness T/ℓ = 4·m·f², and
/// sines of index n. A sine is a resonator of mass 2m/(nπ)² at n·f; all of them together weigh m/3, as the
/// straight line does.
fn cable(assembly: &mut Assembly, tied: &Row, mass: f64, frequency: f64, damping_ratio: f64) {
    assembly.spring(tied, 4.0 * mass * frequency * frequency, Law::ELASTIC);
    let mut rest = mass / 3.0;
    for index in 1..=RESONANCES {
        let n = index as f64;
        let (own, omega) = (2.0 * mass / (n * PI).powi(2), TAU * n * frequency);
        let sine = Row::coordinate(assembly.coordinate());
        let stretch = sine.minus(tied);
        rest -= own;
        assembly.inertia(&sine, own);
        assembly.spring(&stretch, own * omega * omega, Law::ELASTIC);
        assembly.dashpot(&stretch, 2.0 * damping_ratio * omega * own);
    }
    assembly.inertia(tied, rest);
}
