//! What a joint must have borne beyond the linear fixture, reconstructed from recorded responses: where the
//! search for its law begins.
//!
//! Of a linear structure with one amplitude-dependent force pair g at a joint, Y = Y₀ − h·G holds line by
//! line, Y₀ being what the structure reads under the recorded force and h what it reads under a force pair
//! of 1. So G follows from responses by weighted least squares, and with it the joint's relative motion,
//! D = D₀ − h_d·G, without a simulation. A law whose shape is known (where it slips, where it touches) is
//! then linear in its strength, and shapes are compared by what they leave of Y₀ − Y. Stiffness, dashpot and
//! mass at the joint that the fixture states a little wrongly are columns beside it. All signals are
//! multiplied by e^{−at}, under which the above stays exact.

use super::locations::JointLocation;
use super::misfit::Focus;
use super::records::Record;
use crate::settings::band::BEYOND_BAND;
use crate::settings::misfit::{CUT, LINE_ERROR_WITHIN_TOLERANCES};
use crate::settings::suggestions::{PULSE, PULSE_AT};
use crate::spectra::{Windowed, oversampled_for_lines};
use crate::time::kernel::{Stepper, Steps};
use crate::time::structure::Structure;
use jointscope_fixture::Fixture;
use jointscope_inference::each;
use num_complex::Complex64;
use std::ops::Range;

/// A record seen through the linear fixture.
pub(super) struct Seen {
    lines: Windowed,
    band: Range<usize>,
    /// (Y₀ − Y)·weight, response by response.
    target: Vec<Vec<Complex64>>,
    pub locations: Vec<SeenLocation>,
    /// iω + a of every line in the band.
    pub s: Vec<Complex64>,
}

/// A joint's component seen so.
pub(super) struct SeenLocation {
    /// h·weight, response by response.
    transfer: Vec<Vec<Complex64>>,
    /// The motion over time.
    pub motion: Vec<f64>,
    /// Its lines in the band.
    pub lines: Vec<Complex64>,
}

/// The records seen through `model`, the fixture as far as it is known, laws found already included.
pub(super) fn seen(
    model: &Fixture,
    records: &[&Record],
    locations: &[JointLocation],
    focus: &Focus,
) -> Option<Vec<Seen>> {
    let linear = model.physics().iter().filter(|effect| !effect.kind.is_nonlinear()).cloned().collect();
    let linear = model.clone().with_physics(linear).ok()?;
    let highest = BEYOND_BAND * focus.lines.band.1;
    let structures = [Structure::new(model, highest).ok()?, Structure::new(&linear, highest).ok()?];
    each(records, |record| Seen::of(&structures, record, locations, focus)).into_iter().collect()
}

/// Weights of lines, recorded and simulated, by noise and by what a model gets wrong at best; and the
/// weighted difference of the two.
fn weighted_difference(
    [recorded, simulated]: &[Vec<Complex64>; 2],
    noise: f64,
) -> (Vec<f64>, Vec<Complex64>) {
    let pairs = || recorded.iter().zip(simulated);
    let variance = |(y, y0): (&Complex64, &Complex64)| {
        noise + LINE_ERROR_WITHIN_TOLERANCES * LINE_ERROR_WITHIN_TOLERANCES * (y.norm_sqr() + y0.norm_sqr())
    };
    let weights: Vec<f64> = pairs().map(|pair| variance(pair).sqrt().recip()).collect();
    let difference = pairs().zip(&weights).map(|((y, y0), w)| (y0 - y) * *w).collect();
    (weights, difference)
}

impl Seen {
    fn of(
        [structure, linear]: &[Structure; 2],
        record: &Record,
        locations: &[JointLocation],
        focus: &Focus,
    ) -> Option<Self> {
        let hit = &record.hit;
        let interval = hit.interval();
        let samples = (record.onset + (CUT / (focus.decay * interval)).ceil() as usize).min(hit.samples());
        let weight = |i: usize| (-focus.decay * interval * (i as f64 - record.onset as f64)).exp();
        let lines = Windowed::padded((0..samples).map(weight).collect(), interval);
        let last = (1..=samples).take_while(|line| lines.frequency_hz(*line) <= focus.lines.band.1).last()?;
        let band = 1..last + 1;
        let steps = Steps { interval, within: focus.within, halvings: focus.halvings };
        let across = |structure: &Structure| -> Option<Vec<(Vec<f64>, Vec<f64>)>> {
            locations.iter().map(|location| structure.across(&location.joint, location.dof)).collect()
        };
        let rows: Vec<Vec<f64>> = across(structure)?.into_iter().map(|(row, _)| row).collect();
        let system = structure.system(structure.load(record.struck()).ok()?, &record.readings, &rows).ok()?;
        let force = oversampled_for_lines(&hit.force()[..samples], focus.within);
        let run = Stepper::new(&system, steps)?.run(&force, samples);
        let (simulated, unmoved) = run.split_at(record.readings.len());
        let energy = lines.power();
        let responses = hit.responses().iter().zip(&record.noise).zip(simulated);
        let (weights, target): (Vec<Vec<f64>>, Vec<Vec<Complex64>>) = responses
            .map(|((response, noise), simulated)| {
                let spectra = [&response.values, simulated].map(|values| lines.band(values, &band));
                weighted_difference(&spectra, noise * noise * energy)
            })
            .unzip();
        let mut pulse = vec![0.0; samples];
        pulse.get_mut(PULSE_AT..PULSE_AT + PULSE.len())?.copy_from_slice(&PULSE);
        let pulse_lines = lines.lines(&pulse);
        let pulse = oversampled_for_lines(&pulse, focus.within);
        let mut seen = Seen {
            s: band.clone().map(|line| lines.s(line) + focus.decay).collect(),
            locations: Vec::new(),
            lines,
            band,
            target,
        };
        for (((row, load), location), unmoved) in across(linear)?.into_iter().zip(locations).zip(unmoved) {
            let system = linear.system(load, &record.readings, &[row]).ok()?;
            let run = Stepper::new(&system, steps)?.run(&pulse, samples);
            let of_one = |values: &Vec<f64>| -> Vec<Complex64> {
                seen.lines.lines(values).iter().zip(&pulse_lines).map(|(line, pulse)| line / pulse).collect()
            };
            let mut transfer: Vec<Vec<Complex64>> = run.iter().map(of_one).collect();
            let own = transfer.pop()?;
            for (row, weights) in transfer.iter_mut().zip(&weights) {
                *row = row[seen.band.clone()].iter().zip(weights).map(|(h, w)| h * w).collect();
            }
            let motion = seen.motion(unmoved, &own, &transfer, location.stiffness);
            let within = motion[seen.band.clone()].to_vec();
            let mut values = seen.lines.signal(motion);
            values.iter_mut().zip(seen.window()).for_each(|(v, w)| *v /= w);
            seen.locations.push(SeenLocation { transfer, motion: values, lines: within });
        }
        Some(seen)
    }

    /// Lines of a location's motion, D = D₀ − h_d·G, G from the responses.
    fn motion(
        &self,
        unmoved: &[f64],
        own: &[Complex64],
        transfer: &[Vec<Complex64>],
        stiffness: f64,
    ) -> Vec<Complex64> {
        let mut motion = self.lines.lines(unmoved);
        for (k, line) in self.band.clone().enumerate() {
            // A force of the joint's own size is what little is known of it before.
            let known = (stiffness * motion[line].norm()).powi(2).recip();
            let (mut top, mut bottom) = (Complex64::ZERO, if known.is_finite() { known } else { 1.0 });
            for (h, t) in transfer.iter().zip(&self.target) {
                top += h[k].conj() * t[k];
                bottom += h[k].norm_sqr();
            }
            motion[line] -= own[line] * (top / bottom);
        }
        motion
    }

    /// e^{−at} from the blow on.
    pub(super) fn window(&self) -> &[f64] {
        &self.lines.window
    }

    /// Every value compared at a location, in the order of responses and lines: line in the band, h·weight,
    /// target.
    pub(super) fn each_value(&self, location: usize, mut visit: impl FnMut(usize, Complex64, Complex64)) {
        for (transfer, target) in self.locations[location].transfer.iter().zip(&self.target) {
            transfer.iter().zip(target).enumerate().for_each(|(k, (h, target))| visit(k, *h, *target));
        }
    }

    /// Lines in the band of a force history on a joint's motion.
    pub(super) fn force(&self, values: &[f64]) -> Vec<Complex64> {
        self.lines.band(values, &self.band)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::hypothesis::Hypothesis;
    use super::super::locations::locations;
    use super::super::records::records;
    use super::super::search::Search;
    use super::super::shapes::{is_like, suggestions};
    use super::*;
    use crate::spectra::Compared;
    use crate::{RestoringLaw, simulate};
    use jointscope_fixture::{Dof, Effect};
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
    fn a_gap_wider_than_any_hit_moves_the_joint_and_friction_that_never_slips_are_idle() {
        let stated = two_blocks(1.0);
        let hits = struck(RestoringLaw::Cubic { stiffness3: 4e13 }.to_effect("J", Dof::Translation));
        let recorded = records(&stated, &hits).unwrap();
        let lines = Compared { band: (0.0, 1500.0), exclude: &[] };
        let search = Search::new(recorded.iter().collect(), lines, (200.0, 900.0));
        let all = locations(&stated, &search.records, 4000.0);
        let reach = all.iter().find(|location| location.dof == Dof::Rotation).unwrap().reach;
        let nominal = Hypothesis::nominal(&stated, true, &[]);
        let is_idle = |law: RestoringLaw| search.is_idle(&nominal.with(law.to_effect("J", Dof::Rotation)));
        let stiffness = 100.0;
        assert!(is_idle(RestoringLaw::Gap { clearance: 1.5 * reach, stiffness }));
        assert!(!is_idle(RestoringLaw::Gap { clearance: 0.5 * reach, stiffness }));
        assert!(is_idle(RestoringLaw::Friction { slip_force: 1.5 * reach * stiffness, stiffness }));
        assert!(!is_idle(RestoringLaw::Friction { slip_force: 0.5 * reach * stiffness, stiffness }));
        assert!(!is_idle(RestoringLaw::Cubic { stiffness3: 1.0 }));
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
            let locations = locations(&stated, &recorded, 4000.0);
            let lines = Compared { band: (0.0, 1500.0), exclude: &[] };
            let focus = Focus { decay: 20.0, lines, within: 4, halvings: 3 };
            let mut found = suggestions(&stated, &recorded, &locations, &focus).unwrap();
            found.sort_by(|a, b| b.share.total_cmp(&a.share));
            let hidden = law.to_effect("J", dof);
            assert!(found[0].effects[0].is_named_as(&hidden), "{law:?} in {dof:?}: {:?}", found[0]);
            assert!(
                found[0].effects.iter().any(|suggested| is_like(suggested, &hidden, 1.0 / 3.0)),
                "{law:?} in {dof:?}: {:?}",
                found[0]
            );
        }
    }
}
