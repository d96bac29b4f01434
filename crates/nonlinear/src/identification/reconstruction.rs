//! What a joint must have borne beyond the linear fixture, reconstructed from recorded responses: where the search for its law begins.
//!
//! Of a linear structure with one amplitude-dependent force pair g at a joint, Y = Y₀ − h·G holds line by line, Y₀ being what the structure reads
//! under the recorded force and h what it reads under a force pair of 1. So G follows from responses by weighted least squares, and with it
//! the joint's relative motion, D = D₀ − h_d·G, without a simulation. A law whose shape is known (where it slips, where it touches) is
//! then linear in its strength, and shapes are compared by what they leave of Y₀ − Y. Stiffness, dashpot and mass at the joint that the
//! fixture states a little wrongly are columns beside it. All signals are multiplied by e^{−at}, under which the above stays exact.

use super::candidates::Seat;
use super::records::Record;
use super::shapes::{Suggestion, suggested};
use crate::force_state::Lines;
use crate::time::kernel::{Stepper, Steps};
use crate::time::oversampling::oversampled_for_lines;
use crate::time::structure::Structure;
use jointscope_fixture::{Dof, Fixture};
use num_complex::Complex64;
use rayon::prelude::*;
use std::ops::Range;

/// How responses are looked at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Look {
    /// a of the window e^{−at}, 1/s.
    pub decay: f64,
    /// Highest frequency compared, Hz.
    pub highest: f64,
    /// Steps within a sampling interval.
    pub within: usize,
}

/// Departure of every line that is not held against a model whose quantities are known within tolerances, relative to the line.
const INEXACT: f64 = 0.03;
/// e^{−aT} at which a record is cut off, as an exponent.
const CUT: f64 = 6.0;
/// A record seen through the linear fixture.
pub(super) struct Seen {
    lines: Lines,
    band: Range<usize>,
    /// e^{−at}.
    pub window: Vec<f64>,
    /// (Y₀ − Y)·weight, response by response.
    pub target: Vec<Vec<Complex64>>,
    /// Of every seat: h·weight response by response, the motion over time, its lines in the band, and iω + a there.
    pub seats: Vec<SeenSeat>,
    pub s: Vec<Complex64>,
}

pub(super) struct SeenSeat {
    pub transfer: Vec<Vec<Complex64>>,
    pub motion: Vec<f64>,
    pub lines: Vec<Complex64>,
}

/// For every seat, suggestions for each kind of law that helps there. `model` is the fixture as far as it is known, laws found already included.
pub(crate) fn suggestions(
    model: &Fixture,
    records: &[&Record],
    seats: &[Seat],
    look: Look,
) -> Option<Vec<Vec<Suggestion>>> {
    let linear = model.physics().iter().filter(|effect| !effect.kind.is_nonlinear()).cloned().collect();
    let linear = model.clone().with_physics(linear).ok()?;
    let highest = 2.0 * look.highest;
    let structure = Structure::new(model, highest).ok()?;
    let linear = Structure::new(&linear, highest).ok()?;
    let seen: Vec<Seen> = records
        .par_iter()
        .map(|record| Seen::of(&structure, &linear, record, seats, look))
        .collect::<Option<_>>()?;
    Some((0..seats.len()).into_par_iter().map(|index| suggested(&seen, index, &seats[index])).collect())
}

impl Seen {
    fn of(
        structure: &Structure,
        linear: &Structure,
        record: &Record,
        seats: &[Seat],
        look: Look,
    ) -> Option<Self> {
        let hit = &record.hit;
        let interval = hit.interval();
        let samples = (record.onset + (CUT / (look.decay * interval)).ceil() as usize).min(hit.samples());
        let window: Vec<f64> =
            (0..samples).map(|i| (-look.decay * interval * (i as f64 - record.onset as f64)).exp()).collect();
        let lines = Lines::new(samples, interval);
        let last = (1..=samples).take_while(|line| lines.frequency(*line) <= look.highest).last()?;
        let band = 1..last + 1;
        let s: Vec<Complex64> = band.clone().map(|line| lines.s(line) + look.decay).collect();
        let across = |structure: &Structure| -> Option<Vec<(Vec<f64>, Vec<f64>)>> {
            seats
                .iter()
                .map(|seat| {
                    Some(structure.across(&seat.joint)?[usize::from(seat.dof == Dof::Rotation)].clone())
                })
                .collect()
        };
        let rows: Vec<Vec<f64>> = across(structure)?.into_iter().map(|(row, _)| row).collect();
        let steps = Steps { interval, within: look.within, halvings: 3 };
        let windowed = |values: &[f64]| -> Vec<Complex64> {
            lines.of(&values.iter().zip(&window).map(|(v, w)| v * w).collect::<Vec<f64>>())
        };
        let system = structure.system_with(record.struck(), &record.readings, &rows).ok()?;
        let force = oversampled_for_lines(&hit.force()[..samples], look.within);
        let run = Stepper::new(&system, steps)?.run(&force, samples);
        let count = record.readings.len();
        let energy: f64 = window.iter().map(|w| w * w).sum();
        let (mut weights, mut target): (Vec<Vec<f64>>, Vec<Vec<Complex64>>) = Default::default();
        for ((response, noise), simulated) in hit.responses().iter().zip(&record.noise).zip(&run.outputs) {
            let recorded = windowed(&response.values[..samples]);
            let simulated = windowed(simulated);
            let pairs = || recorded[band.clone()].iter().zip(&simulated[band.clone()]);
            let variance = |(y, y0): (&Complex64, &Complex64)| {
                noise * noise * energy + INEXACT * INEXACT * (y.norm_sqr() + y0.norm_sqr())
            };
            let weight: Vec<f64> = pairs().map(|pair| variance(pair).sqrt().recip()).collect();
            target.push(pairs().zip(&weight).map(|((y, y0), w)| (y0 - y) * *w).collect());
            weights.push(weight);
        }
        let unmoved: Vec<Vec<Complex64>> =
            run.outputs[count..].iter().map(|motion| windowed(motion)).collect();
        // A pulse of three samples: what is above half of the rate does not ring ahead of it.
        const AT: usize = 24;
        let mut pulse = vec![0.0; samples];
        for (offset, value) in [0.25, 0.5, 0.25].into_iter().enumerate() {
            *pulse.get_mut(AT + offset)? = value;
        }
        let pulse_lines = windowed(&pulse);
        let pulse = oversampled_for_lines(&pulse, look.within);
        let seats = across(linear)?.into_iter().zip(seats).enumerate().map(|(index, ((row, load), seat))| {
            let system = linear.system_loaded(load, &record.readings, &[row]).ok()?;
            let run = Stepper::new(&system, steps)?.run(&pulse, samples);
            let of_one = |values: &Vec<f64>| {
                let mut lines = windowed(values);
                lines.iter_mut().zip(&pulse_lines).for_each(|(line, pulse)| *line /= *pulse);
                lines
            };
            let mut transfer: Vec<Vec<Complex64>> = run.outputs.iter().map(of_one).collect();
            let own = transfer.pop()?;
            for (row, weight) in transfer.iter_mut().zip(&weights) {
                row.drain(..band.start);
                row.truncate(weight.len());
                row.iter_mut().zip(weight).for_each(|(h, w)| *h *= *w);
            }
            // A force of the joint's own size is what little is known of it before.
            let mut motion = unmoved[index].clone();
            for k in 0..band.len() {
                let line = band.start + k;
                let known = (seat.stiffness * unmoved[index][line].norm()).powi(2).recip();
                let (mut top, mut bottom) = (Complex64::ZERO, if known.is_finite() { known } else { 1.0 });
                for (h, t) in transfer.iter().zip(&target) {
                    top += h[k].conj() * t[k];
                    bottom += h[k].norm_sqr();
                }
                motion[line] -= own[line] * (top / bottom);
            }
            let seen = motion[band.clone()].to_vec();
            let mut values = lines.signal(motion);
            values.iter_mut().zip(&window).for_each(|(v, w)| *v /= w);
            Some(SeenSeat { transfer, motion: values, lines: seen })
        });
        let seats = seats.collect::<Option<_>>()?;
        Some(Seen { band, window, target, seats, s, lines })
    }

    /// Lines in the band of a force history on a seat's motion.
    pub fn force(&self, values: &[f64]) -> Vec<Complex64> {
        let windowed: Vec<f64> = values.iter().zip(&self.window).map(|(v, w)| v * w).collect();
        let mut lines = self.lines.of(&windowed);
        lines.truncate(self.band.end);
        lines.drain(..self.band.start);
        lines
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::candidates::seats;
    use super::super::parameters::Law;
    use super::super::records::records;
    use super::*;
    use crate::{RestoringLaw, simulate};
    use jointscope_fixture::Effect;
    use jointscope_hits::Hit;
    use jointscope_spectra::Channel;

    /// Two blocks on a strip whose modulus is stated `stated` times as large as it is.
    fn two_blocks(stated: f64) -> Fixture {
        let modulus = 2.07e11 * stated;
        Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {{ "mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030 }}, "B": {{ "mass": 1.30, "inertia": 1.1e-3, "x_cg": 0.095 }} }},
              "points": {{ "1": {{ "body": "A", "x": -0.060 }}, "2": {{ "body": "A", "x": 0.0 }},
                "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": 0.125 }} }},
              "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": {modulus}, "second_moment": 3.67e-10 }} }} }},
              "damping": {{ "modal_ratios": [0.003] }} }}"#
        ))
        .unwrap()
    }

    /// Hits of three strengths at two points, read at the far block.
    fn struck(hidden: Effect) -> Vec<Hit> {
        let fixture = two_blocks(1.0).with_physics(vec![hidden]).unwrap();
        let blow = |number: u32, peak: f64, at: &str| {
            let pulse = |i: usize| peak * (-0.5 * ((i as f64 - 40.0) / 1.6).powi(2)).exp();
            let force = (0..2048).map(pulse).collect();
            Hit::new(number, 1.0 / 6400.0, 0.0, Channel::transverse(at), force, Vec::new()).unwrap()
        };
        let hits: Vec<Hit> = (0..6)
            .map(|i| blow(i + 1, [35.0, 140.0, 500.0][i as usize / 2], ["1", "2"][i as usize % 2]))
            .collect();
        simulate(&fixture, &hits, &[Channel::transverse("3"), Channel::transverse("4")]).unwrap().hits
    }

    #[test]
    fn the_law_that_acted_explains_the_most_and_is_met_within_a_third_though_the_joint_is_stated_wrongly() {
        let (across, turning) = (Dof::Translation, Dof::Rotation);
        let laws = [
            (across, RestoringLaw::Cubic { stiffness3: 4e13 }),
            (turning, RestoringLaw::Cubic { stiffness3: 3e8 }),
            (across, RestoringLaw::Friction { slip_force: 40.0, stiffness: 6e5 }),
            (turning, RestoringLaw::Friction { slip_force: 0.5, stiffness: 600.0 }),
            (across, RestoringLaw::Gap { clearance: 3e-5, stiffness: 1e6 }),
            (turning, RestoringLaw::Gap { clearance: 8e-4, stiffness: 1500.0 }),
        ];
        for (dof, law) in laws {
            let hits = struck(law.to_effect("J", dof));
            let stated = two_blocks(1.01);
            let recorded = records(&stated, &hits).unwrap();
            let recorded: Vec<&Record> = recorded.iter().collect();
            let seats = seats(&stated, &recorded, 4000.0);
            let look = Look { decay: 20.0, highest: 1500.0, within: 4 };
            let mut found: Vec<Suggestion> =
                suggestions(&stated, &recorded, &seats, look).unwrap().into_iter().flatten().collect();
            found.sort_by(|a, b| b.share.total_cmp(&a.share));
            let hidden = Law::new("J", dof, law);
            assert!(found[0].laws[0].is_named_as(&hidden), "{law:?} in {dof:?}: {:?}", found[0]);
            assert!(
                found[0].laws.iter().any(|suggested| suggested.is_like(&hidden, 1.0 / 3.0)),
                "{law:?} in {dof:?}: {:?}",
                found[0]
            );
        }
    }
}
