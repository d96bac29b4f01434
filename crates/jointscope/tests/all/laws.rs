//! What probabilities of laws are worth, on joints whose dynamic stiffness is any function of frequency: two
//! rigid blocks on a joint, solved here by elimination of four equations a line, which share nothing with the
//! model fitted.

use crate::joint_fit::{Case, EIGHT, fit, fixture, lines, parameters_of};
use jointscope::decomposition::{LawFit, LawKind};
use jointscope::fixture::{BodyKind, Fixture, JointLaw};
use jointscope::spectra::{FrfForm, FrfSet};
use jointscope_rig::{drawn_within_tolerance, generator};
use jointscope_samples::{Noise, transverse};
use num_complex::Complex64;

type Real2 = [[f64; 2]; 2];

/// What a joint really is: K, its losses D in units of stiffness in the middle of the band, what K changes by
/// up to there, time or exponent, mass.
#[derive(Debug, Clone)]
pub(crate) struct Truth {
    pub kind: LawKind,
    pub stiffness: Real2,
    pub losses: Real2,
    pub change: Real2,
    /// ωτ in the middle of the band, or the exponent.
    pub shape: f64,
    /// kg, uniform over the length.
    pub mass: f64,
}

impl Truth {
    fn is(&self, law: &LawFit) -> bool {
        law.kind == self.kind && law.mass.is_some() == (self.mass > 0.0)
    }

    /// The joint's dynamic stiffness on d at a multiple of the frequency in the middle of the band.
    fn stiffness_at(&self, relative: f64) -> [[Complex64; 2]; 2] {
        let s = Complex64::new(0.0, relative);
        let losses = match self.kind {
            LawKind::Constant => Complex64::ZERO,
            LawKind::Viscous | LawKind::LinearStiffness => s,
            LawKind::Structural => Complex64::I,
            LawKind::StandardLinearSolid => {
                // Its loss in the middle of the band is that of D.
                let own = |s: Complex64| s * self.shape / (1.0 + s * self.shape);
                own(s) / own(Complex64::I).im
            }
            LawKind::Fractional => s.powf(self.shape) / Complex64::I.powf(self.shape).im,
        };
        let element = |i: usize, j: usize| {
            losses * self.losses[i][j] + self.stiffness[i][j] + (relative - 1.0) * self.change[i][j]
        };
        [[element(0, 0), element(0, 1)], [element(1, 0), element(1, 1)]]
    }

    /// Accelerances of two blocks on this joint, without noise.
    pub(crate) fn recorded(&self, blocks: &Fixture) -> FrfSet {
        let body = |index: usize| match &blocks.bodies()[index].kind {
            BodyKind::Rigid(rigid) => {
                [rigid.mass.value, rigid.inertia.unwrap().value, rigid.x_cg.unwrap().value]
            }
            BodyKind::Beam(_) => unreachable!(),
        };
        let [a, b] = [body(0), body(1)];
        let x: Vec<f64> = blocks.points().iter().map(|point| point.x.value).collect();
        let (from, to) = (blocks.joints()[0].from, blocks.joints()[0].to);
        let length = x[to] - x[from];
        // Rows by the motions of A and B at their centres of mass: the joint's ends (y, θ, y, θ), and d.
        let (p, q) = (x[from] - a[2], x[to] - b[2]);
        let ends = [[1.0, p, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, q], [0.0, 0.0, 0.0, 1.0]];
        let d = [[-1.0, -p - length, 1.0, q], [0.0, -1.0, 0.0, 1.0]];
        let l = length;
        let bar = [
            [156.0, 22.0 * l, 54.0, -13.0 * l],
            [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
            [54.0, 13.0 * l, 156.0, -22.0 * l],
            [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
        ];
        let own = [a[0], a[1], b[0], b[1]];
        let inertia = |i: usize, j: usize| -> f64 {
            let of_joint: f64 = (0..4)
                .flat_map(|m| (0..4).map(move |n| (m, n)))
                .map(|(m, n)| ends[m][i] * bar[m][n] * ends[n][j] * self.mass / 420.0)
                .sum();
            of_joint + if i == j { own[i] } else { 0.0 }
        };
        let row = |point: &str| {
            let index = blocks.points().iter().position(|other| other.name == point).unwrap();
            let centre = if blocks.points()[index].body == 0 { a[2] } else { b[2] };
            let arm = x[index] - centre;
            if blocks.points()[index].body == 0 { [1.0, arm, 0.0, 0.0] } else { [0.0, 0.0, 1.0, arm] }
        };
        let pairs = transverse(&EIGHT);
        let lines = lines();
        let omegas: Vec<f64> = lines.omegas().collect();
        let middle = 0.5 * (omegas[0] + omegas[omegas.len() - 1]);
        let mut values = vec![Complex64::ZERO; pairs.len() * omegas.len()];
        for (line, omega) in omegas.iter().enumerate() {
            let k = self.stiffness_at(omega / middle);
            let mut z = [[Complex64::ZERO; 4]; 4];
            for (i, row) in z.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry = Complex64::from(-omega * omega * inertia(i, j));
                    for m in 0..2 {
                        for n in 0..2 {
                            *entry += k[m][n] * (d[m][i] * d[n][j]);
                        }
                    }
                }
            }
            for (index, (out, input)) in EIGHT.iter().enumerate() {
                let motion = solved(z, row(input).map(Complex64::from));
                let response: Complex64 = row(out).iter().zip(motion).map(|(t, u)| u * *t).sum();
                values[index * omegas.len() + line] = -(omega * omega) * response;
            }
        }
        FrfSet::new(lines, FrfForm::Accelerance, pairs, values).unwrap()
    }
}

/// Elimination with pivots.
fn solved(mut z: [[Complex64; 4]; 4], mut f: [Complex64; 4]) -> [Complex64; 4] {
    for column in 0..4 {
        let pivot = (column..4).max_by(|&a, &b| z[a][column].norm().total_cmp(&z[b][column].norm())).unwrap();
        z.swap(column, pivot);
        f.swap(column, pivot);
        for row in 0..4 {
            if row != column {
                let share = z[row][column] / z[column][column];
                let above = z[column];
                z[row].iter_mut().zip(above).for_each(|(entry, a)| *entry -= share * a);
                let pulled = share * f[column];
                f[row] -= pulled;
            }
        }
    }
    std::array::from_fn(|i| f[i] / z[i][i])
}

/// How truths are drawn.
struct Draw<'a> {
    noise: &'a mut Noise,
}

impl Draw<'_> {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.noise.uniform()
    }

    /// As likely between 1 and 2 as between 10 and 20.
    fn of_any_size(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// A positive matrix of about `size` times K, distributed over its elements otherwise: √K·U·√Kᵀ with
    /// eigenvalues of U from 0.3 to 1.7.
    fn beside(&mut self, k: &Real2, size: f64) -> Real2 {
        let (one, two) = (self.between(0.3, 1.7), self.between(0.3, 1.7));
        let (sin, cos) = self.between(0.0, std::f64::consts::PI).sin_cos();
        let u = [
            [one * cos * cos + two * sin * sin, (one - two) * sin * cos],
            [(one - two) * sin * cos, one * sin * sin + two * cos * cos],
        ];
        let root = [
            [k[0][0].sqrt(), 0.0],
            [k[0][1] / k[0][0].sqrt(), (k[1][1] - k[0][1] * k[0][1] / k[0][0]).sqrt()],
        ];
        let mut all = [[0.0; 2]; 2];
        for (i, row) in all.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                for m in 0..2 {
                    for n in 0..2 {
                        *entry += size * root[i][m] * u[m][n] * root[j][n];
                    }
                }
            }
        }
        all
    }

    fn truth(&mut self, kind: LawKind, heavy: bool, blocks: &Fixture) -> Truth {
        let k = match &blocks.joints()[0].law {
            JointLaw::Stiffness { stiffness: [a, b, d], .. } => [[a.value, b.value], [b.value, d.value]],
            JointLaw::Beam { .. } => unreachable!(),
        };
        let none = [[0.0; 2]; 2];
        let loss = self.of_any_size(1e-3, 0.05);
        let losses = self.beside(&k, if kind == LawKind::Constant { 0.0 } else { loss });
        let sign = if self.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
        let change = sign * self.of_any_size(1e-3, 0.05);
        Truth {
            kind,
            stiffness: k,
            losses,
            change: if kind == LawKind::LinearStiffness { self.beside(&k, change) } else { none },
            shape: match kind {
                LawKind::Fractional => self.between(0.1, 0.9),
                _ => self.of_any_size(0.1, 10.0),
            },
            mass: if heavy { self.of_any_size(1e-3, 0.03) } else { 0.0 },
        }
    }
}

/// What one run says.
struct Named {
    /// Of the laws in [`all_laws`]: its probability, and whether it is the truth.
    said: Vec<(f64, bool)>,
    /// Probability of the most probable one, and whether it is the truth.
    best: (f64, bool),
    /// Whether χ² of every other law that has no more parameters, and does not hold the true one, is larger
    /// by 30.
    told: bool,
    chi2: f64,
}

fn all_laws() -> impl Iterator<Item = (LawKind, bool)> {
    LawKind::ALL.into_iter().flat_map(|kind| [(kind, false), (kind, true)])
}

fn run(truth: (LawKind, bool), seed: u64) -> Named {
    let noise = &mut Noise::new(seed);
    let analyst = fixture(&Case::ordinary(), "");
    let blocks = drawn_within_tolerance(&analyst, &mut generator(seed)).unwrap();
    let truth = Draw { noise }.truth(truth.0, truth.1, &blocks);
    let frfs = noise.on(&truth.recorded(&blocks), 0.01);
    if std::env::var("ONLY").is_ok_and(|only| only != format!("{seed}")) {
        return Named { said: Vec::new(), best: (0.0, false), told: false, chi2: 0.0 };
    }
    let fit = fit(&analyst, &frfs, true);
    if std::env::var("DETAIL").is_ok() {
        for law in &fit.laws {
            println!("      {} {:.4}", law.name(), law.probability);
        }
    }
    let of = |kind: LawKind, heavy: bool| {
        fit.laws.iter().find(|law| law.kind == kind && law.mass.is_some() == heavy)
    };
    let said = all_laws().map(|(kind, heavy)| {
        let is_truth = kind == truth.kind && heavy == (truth.mass > 0.0);
        (of(kind, heavy).map_or(0.0, |law| law.probability), is_truth)
    });
    let heavy = truth.mass > 0.0;
    let own = of(truth.kind, heavy).map_or(f64::INFINITY, |law| law.objective);
    let most = parameters_of(truth.kind, heavy);
    let others =
        fit.laws.iter().filter(|law| !truth.is(law) && parameters_of(law.kind, law.mass.is_some()) <= most);
    let least = others.map(|law| law.objective).fold(f64::INFINITY, f64::min);
    let best = fit.law().map_or((0.0, false), |law| (law.probability, truth.is(law)));
    if std::env::var("EACH_RUN").is_ok() {
        println!(
            "{seed} {:?} mass {:.4} loss {:.4} change {:.4} shape {:.2}: own {own:.1} least other {least:.1} named {} {:.3}, chi2 {:.3}",
            truth.kind,
            truth.mass,
            truth.losses[0][0] / truth.stiffness[0][0],
            truth.change[0][0] / truth.stiffness[0][0],
            truth.shape,
            fit.law().map_or(String::new(), LawFit::name),
            best.0,
            fit.chi2_per_dof
        );
    }
    Named {
        said: said.collect(),
        best,
        told: least.is_finite() && least - own >= 30.0,
        chi2: fit.chi2_per_dof,
    }
}

/// Runs of all laws with and without mass, and their table.
fn table(each: u64, seed: u64) -> Vec<((LawKind, bool), Vec<Named>)> {
    let mut runs = Vec::new();
    for (place, truth) in all_laws().enumerate() {
        let all: Vec<Named> = (0..each).map(|i| run(truth, seed + 1000 * place as u64 + i)).collect();
        let count = |of: &dyn Fn(&Named) -> bool| all.iter().filter(|run| of(run)).count();
        println!(
            "{:?}, mass {}: told apart {}, named then {}, named {} of {each}, mean probability of the truth {:.3}, chi2 {:.3}",
            truth.0,
            truth.1,
            count(&|run| run.told),
            count(&|run| run.told && run.best.1),
            count(&|run| run.best.1),
            all.iter().filter_map(|run| run.said.get(place)).map(|said| said.0).sum::<f64>() / each as f64,
            all.iter().map(|run| run.chi2).sum::<f64>() / each as f64,
        );
        runs.push((truth, all));
    }
    let every = || runs.iter().flat_map(|(_, all)| all);
    println!("law: mean probability over all runs, share of runs of which it is the truth");
    for (place, (kind, heavy)) in all_laws().enumerate() {
        let total = every().count() as f64;
        let stated: f64 = every().map(|run| run.said[place].0).sum();
        let true_of = every().filter(|run| run.said[place].1).count() as f64;
        println!("{kind:?}, mass {heavy}: {:.3} {:.3}", stated / total, true_of / total);
    }
    for (low, high) in BINS {
        let of = |all: &mut dyn Iterator<Item = (f64, bool)>| {
            let inside: Vec<(f64, bool)> = all.filter(|(p, _)| *p >= low && *p < high).collect();
            let n = inside.len() as f64;
            let mean = inside.iter().map(|(p, _)| p).sum::<f64>() / n;
            (inside.len(), mean, inside.iter().filter(|(_, right)| *right).count() as f64 / n)
        };
        let (n, p, share) = of(&mut every().map(|run| run.best));
        let (m, q, other) = of(&mut every().flat_map(|run| run.said.iter().copied()));
        println!(
            "stated {low} to {high}: most probable law {n} runs, mean {p:.3}, right {share:.3}; any law {m}, mean {q:.3}, right {other:.3}"
        );
    }
    runs
}

const BINS: [(f64, f64); 7] =
    [(0.0, 0.05), (0.05, 0.2), (0.2, 0.4), (0.4, 0.6), (0.6, 0.8), (0.8, 0.95), (0.95, 1.01)];

/// How often a joint on drawn blocks is named as what it is.
fn named(truth: &Truth, count: u64, seed: u64) -> usize {
    let analyst = fixture(&Case::ordinary(), "");
    let is_named = |i: &u64| {
        let blocks = drawn_within_tolerance(&analyst, &mut generator(seed + i)).unwrap();
        let frfs = Noise::new(seed + i).on(&truth.recorded(&blocks), 0.01);
        let fit = fit(&analyst, &frfs, true);
        println!("{:?}: {} {:.3}", truth.kind, fit.law().unwrap().name(), fit.law().unwrap().probability);
        fit.law().is_some_and(|law| truth.is(law))
    };
    (0..count).filter(is_named).count()
}

/// With noise as small the nearest law without mass gains nothing over the viscous one.
#[test]
fn a_structural_joint_with_a_mass_has_its_law_in_quiet_tests_too() {
    let k = [[2.4e6, -8.4e4], [-8.4e4, 4.1e3]];
    let losses = k.map(|row| row.map(|element| 0.03 * element));
    let none = [[0.0; 2]; 2];
    let truth =
        Truth { kind: LawKind::Structural, stiffness: k, losses, change: none, shape: 1.0, mass: 0.05 };
    let analyst = fixture(&Case::ordinary(), "");
    for seed in 0..4 {
        let blocks = drawn_within_tolerance(&analyst, &mut generator(seed)).unwrap();
        let frfs = Noise::new(seed).on(&truth.recorded(&blocks), 0.001);
        let fit = fit(&analyst, &frfs, true);
        let law = fit.law().unwrap();
        assert!(truth.is(law), "seed {seed}: {} at chi2 {}", law.name(), fit.chi2_per_dof);
        assert!((0.9..1.1).contains(&fit.chi2_per_dof), "seed {seed}: {}", fit.chi2_per_dof);
    }
}

#[test]
fn a_joint_with_a_mass_and_no_losses_is_named_as_one() {
    let k = [[2.4e6, -8.4e4], [-8.4e4, 4.1e3]];
    let none = [[0.0; 2]; 2];
    let truth =
        Truth { kind: LawKind::Constant, stiffness: k, losses: none, change: none, shape: 1.0, mass: 0.02 };
    // Peaks without losses are so sharp that one fit in three ends in a false minimum.
    assert!(named(&truth, 3, 81) >= 2);
}

#[test]
fn a_stiffness_that_changes_by_three_hundredths_over_half_the_band_is_named_as_linear() {
    let k: Real2 = [[2.4e6, -8.4e4], [-8.4e4, 4.1e3]];
    let (losses, change) = (k.map(|row| row.map(|e| 0.01 * e)), k.map(|row| row.map(|e| 0.03 * e)));
    let truth = Truth { kind: LawKind::LinearStiffness, stiffness: k, losses, change, shape: 1.0, mass: 0.0 };
    assert_eq!(named(&truth, 3, 91), 3);
}

#[test]
#[ignore = "minutes; the record of the joint has its figures"]
fn a_law_of_stated_probability_is_right_as_often() {
    let each = std::env::var("RUNS").ok().and_then(|runs| runs.parse().ok()).unwrap_or(30);
    let runs = table(each, 51);
    let every = || runs.iter().flat_map(|(_, all)| all);
    let told = every().filter(|run| run.told).count() as f64;
    let right = every().filter(|run| run.told && run.best.1).count() as f64;
    println!("told apart {told}, named right {right}: {:.3}", right / told);
    assert!(right >= 0.95 * told);
    let sure: Vec<&Named> = every().filter(|run| run.best.0 >= 0.95).collect();
    let wrong = sure.iter().filter(|run| !run.best.1).count() as f64;
    let expected: f64 = sure.iter().map(|run| 1.0 - run.best.0).sum();
    println!("stated above 0.95: {} runs, {wrong} wrong, {expected:.1} expected", sure.len());
    assert!(wrong <= expected + 3.0 * expected.sqrt().max(1.0));
}
