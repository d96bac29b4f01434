//! Scores the diagnosis of stepped sines at several levels on concealed cases of the simulated laboratory, which shares no code with it.
//!
//! `cargo run --release -p jointscope-proof --example levels -- CASES SEED [two|three|frame|supported] [exact]`: every fourth case is linear; with
//! `exact` the fixture is the truth, else every quantity is drawn within its tolerance.
#![allow(clippy::unwrap_used)]

use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use jointscope_nonlinear::{Held, NonlinearOptions, SteppedDiagnosis, SteppedLevel, Verdict};
use jointscope_rig::{Control, Family, Instrument, SteppedSines, drawn_within_tolerance, frfs, generator};
use jointscope_spectra::{Channel, FrfForm, FrfPair, SpectralLines};
use jointscope_wording::Says;
use num_complex::Complex64;
use rand::Rng;
use std::collections::BTreeMap;

/// Lines a half-power width.
const DENSITY: f64 = 4.0;
/// Half-power widths that are stepped beyond the resonances.
const MARGIN: f64 = 6.0;

/// Random numbers of the cases.
struct Dice<R: Rng>(R);

impl<R: Rng> Dice<R> {
    fn uniform(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn log_uniform(&mut self, from: f64, to: f64) -> f64 {
        self.uniform(from.ln(), to.ln()).exp()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.uniform(0.0, count as f64) as usize).min(count - 1)
    }
}

/// A joint's component at a resonance of the linear structure.
struct Resonance {
    hz: f64,
    /// Half-power width, Hz.
    width: f64,
    /// Receptance of d by a force across the joint at the peak.
    own: f64,
    /// d over the force, and over the acceleration of the driving point, at the peak.
    by_force: f64,
    by_response: f64,
}

/// Receptances of d by a force across the joint, of d by a force at `struck`, and of `struck` by that force.
fn across(truth: &Fixture, joint: &str, dof: Dof, struck: &Channel, hz: Vec<f64>) -> Vec<[Complex64; 3]> {
    let joint = truth.joint(joint).unwrap();
    let length = truth.joint_length(joint);
    let name = |point: usize| truth.points()[point].name.clone();
    let weights: [f64; 4] = match dof {
        Dof::Translation => [-1.0, -length, 1.0, 0.0],
        Dof::Rotation => [0.0, -1.0, 0.0, 1.0],
    };
    let both = |point: usize| [Channel::transverse(name(point)), Channel::rotational(name(point))];
    let ends: Vec<Channel> = [both(joint.from), both(joint.to)].concat();
    // A storey does not rotate and has no moment.
    let ends: Vec<(Channel, f64)> = ends.into_iter().zip(weights).filter(|(_, w)| *w != 0.0).collect();
    let mut pairs: Vec<FrfPair> = Vec::new();
    let mut factors: Vec<(usize, f64)> = Vec::new();
    let mut add = |pair: FrfPair, what: usize, weight: f64| {
        if !pairs.contains(&pair) {
            pairs.push(pair.clone());
        }
        factors.push((what, weight));
        pairs.iter().position(|p| *p == pair).unwrap()
    };
    let mut places = Vec::new();
    for (out, a) in &ends {
        for (input, b) in &ends {
            places.push(add(FrfPair::new(out.clone(), input.clone()), 0, a * b));
        }
        places.push(add(FrfPair::new(out.clone(), struck.clone()), 1, *a));
    }
    places.push(add(FrfPair::new(struck.clone(), struck.clone()), 2, 1.0));
    let lines = SpectralLines::new(hz).unwrap();
    let set = frfs(truth, &pairs, &lines, Instrument::Perfect).unwrap().to_form(FrfForm::Receptance).unwrap();
    (0..lines.len())
        .map(|line| {
            let mut sums = [Complex64::ZERO; 3];
            for (&place, &(what, weight)) in places.iter().zip(&factors) {
                sums[what] += weight * set.values(place)[line];
            }
            sums
        })
        .collect()
}

/// The resonance of d about `hz`, if it stands alone.
fn resonance(truth: &Fixture, joint: &str, dof: Dof, struck: &Channel, hz: f64) -> Option<Resonance> {
    let grid: Vec<f64> = (0..4001).map(|i| hz * (0.93 + 0.14 * f64::from(i) / 4000.0)).collect();
    let all = across(truth, joint, dof, struck, grid.clone());
    let size = |i: usize| all[i][0].norm();
    let top = (0..grid.len()).fold(0, |top, i| if size(i) > size(top) { i } else { top });
    let high = |i: &usize| size(*i) > size(top) / 2f64.sqrt();
    let (last, first) =
        ((top..grid.len()).take_while(high).last()?, (0..=top).rev().take_while(high).last()?);
    let omega = std::f64::consts::TAU * grid[top];
    let [own, by_force, driving] = all[top].map(|v| v.norm());
    let alone = first > 200 && last + 200 < grid.len();
    // The driving point moves with the mode, as a test engineer would see to.
    let seen = driving > 0.3 * all[0][2].norm().max(all[grid.len() - 1][2].norm()) * 10.0;
    (alone && seen).then(|| Resonance {
        hz: grid[top],
        width: grid[last] - grid[first],
        own,
        by_force,
        by_response: by_force / (driving * omega * omega),
    })
}

/// The effect that moves the resonance by `shift` half half-power widths at most when d reaches `reach`.
fn law(
    dice: &mut Dice<impl Rng>,
    kind: EffectKind,
    joint: &str,
    dof: Dof,
    stiffness: f64,
    reach: f64,
) -> Effect {
    let values = match kind {
        EffectKind::CubicStiffness => {
            let sign = if dice.below(4) == 0 { -1.0 } else { 1.0 };
            vec![sign * stiffness / (0.75 * reach * reach)]
        }
        EffectKind::Friction => vec![stiffness * reach * dice.log_uniform(0.05, 0.5), stiffness],
        _ => vec![reach * dice.uniform(0.1, 0.5), 2.0 * stiffness],
    };
    Effect::new(kind, Place::Joint(joint.to_owned()), Some(dof), &values)
}

#[derive(Default)]
struct Score {
    cases: usize,
    seen: usize,
    kind: usize,
    whole: usize,
    wrong: usize,
    intervals: BTreeMap<String, (usize, usize, Vec<f64>)>,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, or: u64| arguments.get(i).and_then(|a| a.parse().ok()).unwrap_or(or);
    let (cases, seed) = (number(0, 100), number(1, 1));
    let exact = arguments.iter().any(|a| a == "exact");
    // A tenth of the noise shows what the analysis itself errs by.
    let noise = if arguments.iter().any(|a| a == "quiet") { 0.1 } else { 1.0 };
    let null = arguments.iter().any(|a| a == "null");
    let told = arguments.iter().any(|a| a == "tell");
    let families = match arguments.get(2).map(String::as_str) {
        Some("two") => vec![Family::TwoBlocks],
        Some("three") => vec![Family::ThreeBlocks],
        Some("frame") => vec![Family::Frame],
        Some("supported") => vec![Family::SupportedTwoBlocks],
        _ => vec![Family::TwoBlocks, Family::Frame, Family::SupportedTwoBlocks, Family::ThreeBlocks],
    };
    let mut scores: BTreeMap<&'static str, Score> = BTreeMap::new();
    // The cases named alone, where any are: `only=24,28`.
    let only: Vec<u64> = arguments
        .iter()
        .filter_map(|a| a.strip_prefix("only="))
        .flat_map(|list| list.split(',').filter_map(|n| n.parse().ok()))
        .collect();
    for case in (0..cases).filter(|case| only.is_empty() || only.contains(case)) {
        let mut dice = Dice(generator(seed * 100_000 + case));
        let (fixture, levels, effect) = loop {
            if let Some(made) = concealed(&mut dice, case, &families, (exact, null), noise) {
                break made;
            }
        };
        let begun = std::time::Instant::now();
        let found = SteppedDiagnosis::of(&fixture, &levels, &NonlinearOptions { band: None, exact });
        let seconds = begun.elapsed().as_secs_f64();
        let planted = effect.as_ref().map_or("linear", |e| e.kind.name());
        let score = scores.entry(planted).or_default();
        score.cases += 1;
        let found = match found {
            Ok(found) => found,
            Err(error) => {
                println!("{case}: {planted}: {error}");
                continue;
            }
        };
        let called = found.verdict != Verdict::Consistent;
        score.seen += usize::from(called);
        let name = |e: &Effect| format!("{} {} {}", e.kind.name(), e.place, e.dof.unwrap().name());
        let names: Vec<String> =
            found.findings.iter().map(|f| format!("{} ({:.2})", name(&f.effect), f.probability)).collect();
        let head = format!(
            "{case}: {}, {:?} levels {}, {:?} p {:.0e}, holds {}, {names:?}",
            effect.as_ref().map_or("linear".to_owned(), name),
            levels.len(),
            levels[0].held,
            found.verdict,
            found.change.0,
            found.holds
        );
        let Some(effect) = effect else {
            if called || told {
                println!("{head} [{seconds:.1} s]");
            }
            continue;
        };
        let one = match found.findings.as_slice() {
            [one] => Some(one),
            _ => None,
        };
        let same_kind = one.is_some_and(|f| f.effect.kind == effect.kind);
        let whole = one.is_some_and(|f| name(&f.effect) == name(&effect));
        score.kind += usize::from(same_kind);
        score.whole += usize::from(whole);
        score.wrong += usize::from(!found.findings.is_empty() && !same_kind);
        let mut line = String::new();
        if let Some(one) = one.filter(|_| whole) {
            for (index, estimate) in one.estimates.iter().enumerate() {
                let truth = effect.value(index);
                let error = estimate.value / truth - 1.0;
                let holds = estimate.interval.map(|[low, high]| low <= truth && truth <= high);
                line += &format!(
                    " {} {:+.2} ± {:.2} %{}",
                    estimate.parameter.name,
                    100.0 * error,
                    100.0 * estimate.std.unwrap_or(f64::NAN) / truth.abs(),
                    match holds {
                        Some(true) => "",
                        Some(false) => " MISSED",
                        None => " none",
                    }
                );
                if let Some(holds) = holds {
                    let entry = score.intervals.entry(estimate.parameter.name.to_owned()).or_default();
                    entry.0 += 1;
                    entry.1 += usize::from(holds);
                    entry.2.push(error.abs());
                }
            }
        }
        println!("{head}{line} [{seconds:.1} s]");
        if told {
            for l in &found.levels {
                println!(
                    "    {} {:.4} Hz {:.4} % d {:.4e} delta {:.4e} {:.4e} nrmse {:.5} {:.5} {:.5} {:.5}",
                    l.held,
                    l.resonance.frequency.0,
                    100.0 * l.resonance.damping_ratio.0,
                    l.motion,
                    l.stiffness.0,
                    l.loss.0,
                    l.nrmse[0],
                    l.nrmse[1],
                    l.nrmse[2],
                    l.nrmse[3]
                );
            }
        }
        if told {
            println!("    {}", found.says());
            println!("    planted {:?}", effect.parameters.iter().map(|q| q.value).collect::<Vec<_>>());
            for t in &found.tried {
                println!("    {} {} {} {:.5} {:.3}", t.form, t.joint, t.dof.name(), t.nrmse, t.share);
            }
        }
    }
    for (planted, score) in &scores {
        println!(
            "{planted}: {} cases, called non-linear {}, kind named {}, with joint and component {}, another kind {}",
            score.cases, score.seen, score.kind, score.whole, score.wrong
        );
        for (parameter, (all, hold, errors)) in &score.intervals {
            let mut errors = errors.clone();
            errors.sort_by(f64::total_cmp);
            println!(
                "    {parameter}: 95 % intervals hold {hold} of {all}, median error {:.2} %, largest {:.2} %",
                100.0 * errors[errors.len() / 2],
                100.0 * errors[errors.len() - 1]
            );
        }
    }
}

/// A fixture, its FRFs at several levels, and what was hidden in them; `None` where the dice fell badly.
fn concealed(
    dice: &mut Dice<impl Rng>,
    case: u64,
    families: &[Family],
    (exact, null): (bool, bool),
    noise: f64,
) -> Option<(Fixture, Vec<SteppedLevel>, Option<Effect>)> {
    let family = families[dice.below(families.len())];
    let fixture = family.draw("levels", &mut dice.0).unwrap();
    let truth = if exact { fixture.clone() } else { drawn_within_tolerance(&fixture, &mut dice.0).unwrap() };
    let joint = truth.joints()[dice.below(truth.joints().len())].name.clone();
    let dof = if family == Family::Frame || dice.below(2) == 0 { Dof::Translation } else { Dof::Rotation };
    let points = truth.points();
    let struck = Channel::transverse(points[dice.below(points.len())].name.clone());
    let modes = jointscope_rig::Structure::of(&truth).unwrap().natural_frequencies().unwrap();
    let elastic: Vec<f64> = modes.into_iter().filter(|hz| *hz > 12.0).take(2).collect();
    let at = resonance(&truth, &joint, dof, &struck, elastic[dice.below(elastic.len())])?;
    let control = if dice.below(2) == 0 { Control::Response } else { Control::Force };
    let held: Vec<f64> = {
        let top = if control == Control::Force {
            dice.log_uniform(1.0, 30.0)
        } else {
            dice.log_uniform(10.0, 200.0)
        };
        let count = 4 + dice.below(4);
        let least = dice.uniform(0.08, 0.2);
        (0..count).map(|i| top * least.powf(1.0 - i as f64 / (count - 1) as f64)).collect()
    };
    let top = held[held.len() - 1];
    let reach = top * if control == Control::Force { at.by_force } else { at.by_response };
    let kind = [Some(EffectKind::CubicStiffness), Some(EffectKind::Friction), Some(EffectKind::Gap), None]
        [if null { 3 } else { (case % 4) as usize }];
    // A resonance that bends over has two motions to one force.
    let shift = dice.log_uniform(0.4, if control == Control::Force { 2.0 } else { 8.0 });
    let effect = kind.map(|kind| law(dice, kind, &joint, dof, shift / at.own, reach));
    let pairs = {
        let mut pairs = vec![FrfPair::new(struck.clone(), struck.clone())];
        let other = Channel::transverse(points[dice.below(points.len())].name.clone());
        if other != struck {
            pairs.push(FrfPair::new(other, struck));
        }
        pairs
    };
    let beyond = (MARGIN + 0.5 * shift) * at.width;
    let count = (2.0 * beyond / at.width * DENSITY) as usize + 1;
    let lines = SpectralLines::even(at.hz - beyond, 2.0 * beyond / (count - 1) as f64, count).ok()?;
    let test = SteppedSines { control, harmonics: 9, noise: noise * dice.uniform(0.005, 0.01) };
    let hidden = truth.with_physics(effect.clone().into_iter().collect()).unwrap();
    let sets = test.record(&hidden, &pairs, &held, &lines, &mut dice.0).ok()?;
    let level = |(frfs, held): (_, &f64)| {
        let held = if control == Control::Force { Held::Force(*held) } else { Held::Response(*held) };
        SteppedLevel { held, frfs }
    };
    Some((fixture, sets.into_iter().zip(&held).map(level).collect(), effect))
}
