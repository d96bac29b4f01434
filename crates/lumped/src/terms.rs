//! Everything that is not a proportional part of the free assembly, as a change V Δ(s) Vᵀ of low rank.

use crate::Station;
use crate::effects::{Action, actions};
use crate::held::{Held, in_the_modes, supports};
use crate::joint::{JointDynamics, TwoEnds};
use crate::lanes::Lines;
use crate::point_law::PointLaw;
use crate::term_station::TermStation;
use jointscope_fixture::Fixture;
use jointscope_linalg::ComplexMatrix2;
use num_complex::Complex64;

/// One term of Δ, by the first of its stations in the list of [`Terms`].
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Term {
    /// A rank-one change at one station.
    Point { station: usize, law: PointLaw },
    /// A joint without mass, through the two stations that read its relative motion d.
    Relative { station: usize, joint: Box<JointDynamics> },
    /// A joint with mass, through the four stations (y, θ) at its ends, less what the modes hold of it where
    /// they read the same motions.
    Ends { station: usize, joint: Box<JointDynamics>, held: Option<TwoEnds<Complex64>> },
    /// What the modes hold of a joint already, taken out through the two stations that read d as the modes
    /// have it.
    TakenOut { station: usize, stiffness: ComplexMatrix2 },
}

/// All terms with the stations they act through.
#[derive(Debug, Clone, Default)]
pub(crate) struct Terms {
    pub stations: Vec<TermStation>,
    pub terms: Vec<Term>,
}

impl Terms {
    pub(crate) fn of(fixture: &Fixture, flexible: &[bool]) -> Self {
        let mut all = Terms::default();
        let in_the_modes = in_the_modes(fixture);
        for Held { station, stiffness, damping } in supports(fixture) {
            let motion = TermStation::single(station);
            let bends = flexible[station.body];
            // The modes hold a spring by the body's rigid motion alone.
            if in_the_modes && bends {
                let held = PointLaw::Spring { stiffness: -stiffness, damping: 0.0 };
                all.point(motion.of_rigid_motion(), held);
            }
            let stiffness = if in_the_modes && !bends { 0.0 } else { stiffness };
            if stiffness != 0.0 || damping != 0.0 {
                all.point(motion, PointLaw::Spring { stiffness, damping });
            }
        }
        for joint in fixture.joints() {
            let dynamics = JointDynamics::new(fixture, joint);
            let ends = [joint.from, joint.to].map(|p| &fixture.points()[p]);
            let bends = ends.iter().any(|p| flexible[p.body]);
            if dynamics.is_altered() || bends {
                all.joint(ends.map(|p| (p.body, p.x.value)), dynamics, bends);
            }
        }
        for action in actions(fixture) {
            if let Action::Through { motion, law } = action {
                all.point(motion, law);
            }
        }
        all
    }

    /// The terms of both that are not the same in `other`, which has as many.
    pub(crate) fn where_they_differ(&self, other: &Terms) -> (Terms, Terms) {
        let differ: Vec<bool> = self.terms.iter().zip(&other.terms).map(|(own, its)| own != its).collect();
        let chosen = |all: &Terms| Terms {
            stations: all.stations.clone(),
            terms: all
                .terms
                .iter()
                .zip(&differ)
                .filter(|(_, differs)| **differs)
                .map(|(t, _)| t.clone())
                .collect(),
        };
        (chosen(self), chosen(other))
    }

    fn point(&mut self, motion: TermStation, law: PointLaw) {
        let station = self.push(&[motion]);
        self.terms.push(Term::Point { station, law });
    }

    fn joint(&mut self, [from, to]: [(usize, f64); 2], joint: JointDynamics, bends: bool) {
        let (acting, in_the_modes) = joint.lengths();
        let stiffness = joint.in_the_modes();
        let taken_out = if joint.is_heavy() {
            let both = [from, to].map(|(body, x)| Station::both(body, x).map(TermStation::single)).concat();
            let station = self.push(&both);
            let held = (!bends).then(|| TwoEnds::from_end(stiffness, in_the_modes));
            self.terms.push(Term::Ends { station, joint: Box::new(joint), held });
            bends.then(|| self.push(&TermStation::relative(from, to, in_the_modes, true)))
        } else {
            let station = self.push(&TermStation::relative(from, to, acting, false));
            self.terms.push(Term::Relative { station, joint: Box::new(joint) });
            let same = !bends && acting == in_the_modes;
            Some(if same {
                station
            } else {
                self.push(&TermStation::relative(from, to, in_the_modes, bends))
            })
        };
        if let Some(station) = taken_out {
            self.terms.push(Term::TakenOut { station, stiffness });
        }
    }

    fn push(&mut self, stations: &[TermStation]) -> usize {
        let first = self.stations.len();
        self.stations.extend_from_slice(stations);
        first
    }

    /// (row, column) of the elements of Δ that are not zero by themselves, row by row.
    pub(crate) fn elements(&self) -> Vec<(usize, usize)> {
        let block = |first: usize, size: usize| {
            (0..size).flat_map(move |i| (0..size).map(move |j| (first + i, first + j)))
        };
        let mut all: Vec<(usize, usize)> =
            self.terms.iter().flat_map(|t| block(t.station(), t.size())).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Writes Δ(s), order × order row-major, over `delta`.
    #[inline(always)]
    pub(crate) fn write<T: Lines>(&self, s: T, delta: &mut [T]) {
        let order = self.stations.len();
        delta.fill(T::ZERO);
        for term in &self.terms {
            let (first, size) = (term.station(), term.size());
            let mut add = |i: usize, j: usize, value: T| {
                let element = &mut delta[(first + i) * order + first + j];
                *element = *element + value;
            };
            match term {
                Term::Point { law, .. } => add(0, 0, law.at(s)),
                Term::Relative { joint, .. } => {
                    let stiffness = joint.on_relative_motion(s);
                    (0..size).for_each(|i| (0..size).for_each(|j| add(i, j, stiffness.at(i, j))));
                }
                Term::Ends { joint, held, .. } => {
                    let ends = joint.on_both_ends(s);
                    for i in 0..size {
                        for j in 0..size {
                            let held = held.map_or(Complex64::ZERO, |held| held.at(i, j));
                            add(i, j, ends.at(i, j) - T::constant(held));
                        }
                    }
                }
                Term::TakenOut { stiffness, .. } => {
                    (0..size)
                        .for_each(|i| (0..size).for_each(|j| add(i, j, T::constant(-stiffness.at(i, j)))));
                }
            }
        }
    }
}

impl Term {
    /// The first of its stations.
    fn station(&self) -> usize {
        match self {
            Term::Point { station, .. }
            | Term::Relative { station, .. }
            | Term::Ends { station, .. }
            | Term::TakenOut { station, .. } => *station,
        }
    }

    /// How many stations it acts through.
    fn size(&self) -> usize {
        match self {
            Term::Point { .. } => 1,
            Term::Relative { .. } | Term::TakenOut { .. } => 2,
            Term::Ends { .. } => 4,
        }
    }
}
