//! Concealments and answers side by side.

use super::outcome::{Excess, extra, outcome, sizes};
use super::{Concealed, Outcome};
use crate::judge::Judge;
use crate::workers::on_workers;
use crate::{Answer, Answers, Case, Name, NoAnswer, Share, Size, VISIBLE};

/// A case after the truth was opened.
#[derive(Debug, Clone, PartialEq)]
pub struct ScoredConcealment {
    /// What was concealed.
    pub truth: Concealed,
    /// What was answered.
    pub answer: Result<Answer, NoAnswer>,
    /// What became of it.
    pub outcome: Outcome,
    /// Parameters of what was concealed, as far as it was found.
    pub sizes: Vec<Size>,
    /// Findings that are neither what was concealed nor the recording's own.
    pub extra: Vec<Name>,
    /// Findings that the control has too.
    pub own: Vec<Name>,
    /// What the concealment costs the fixture as refitted by the answer: its χ² and squared departures over
    /// those of the first control's refitted fixture, so that what the recording has of its own counts on
    /// both sides; `None` where it cannot be evaluated.
    pub shows: Option<f64>,
    /// The same of the repaired fixture, over that of the first control's: zero, and a little to either side,
    /// if all is made good.
    pub left: Option<f64>,
}

/// All cases of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct ConcealmentScores {
    /// What is found in the recording with nothing concealed: its own.
    pub own: Vec<Name>,
    /// The cases, the first control first.
    pub cases: Vec<ScoredConcealment>,
}

impl ConcealmentScores {
    /// Lays truths and answers side by side, on `threads` workers. The first case is the control that decides
    /// what is the recording's own.
    pub fn of(cases: &[Case], truths: Vec<Concealed>, answers: &Answers, threads: usize) -> Self {
        let work: Vec<_> = cases.iter().zip(answers.all()).collect();
        let objectives = on_workers(&work, threads, |_| (), |(case, answer)| Objectives::of(case, answer));
        let mut objectives: Vec<Option<Objectives>> = objectives.into_iter().map(Option::flatten).collect();
        let own: Vec<Name> = match answers.all().first() {
            Some(Ok(answer)) => answer.names(),
            _ => Vec::new(),
        };
        objectives.resize_with(truths.len(), || None);
        let control = objectives.first().and_then(|first| first.as_ref().map(Objectives::of_control));
        let each = truths.into_iter().zip(answers.all()).zip(&objectives);
        let scored = each.map(|((truth, answer), objectives)| {
            let excess = objectives.as_ref().zip(control).and_then(|(of, control)| of.over(control));
            scored(truth, answer.clone(), &own, excess)
        });
        ConcealmentScores { cases: scored.collect(), own }
    }

    /// A share by its key: `quiet` of the controls but the first; `found` (kind and place), `kind` and
    /// `extra` (further findings) of the concealments that show and that effects describe; `noticed` of those
    /// that no effect describes; `intervals` (that hold the truth) of the found parameters of planted sizes
    /// and `agreements` of those of deleted entries, whose size had been found in the same recording. Nothing
    /// of nothing by any other key.
    pub fn share(&self, key: &str) -> Share {
        let concealed = || self.cases.iter().filter(|case| !case.truth.is_control());
        // By the same measure whether it was found or not: what is found below it is luck, what is missed
        // there no fault.
        let asked = || {
            let there = |case: &&ScoredConcealment| {
                let shows = case.shows.is_none_or(|shows| shows >= VISIBLE);
                shows && case.outcome != Outcome::Own && !case.truth.expected.is_empty()
            };
            concealed().filter(there)
        };
        let sizes = |planted: bool| {
            let of = move |case: &&ScoredConcealment| {
                case.outcome == Outcome::Found
                    && case.truth.kind.is_some_and(|kind| kind.is_planted() == planted)
            };
            Share::count(asked().filter(of).flat_map(|case| &case.sizes), Size::is_held)
        };
        match key {
            "quiet" => {
                let controls = self.cases.iter().skip(1).filter(|case| case.truth.is_control());
                Share::count(controls, |case| case.outcome == Outcome::Quiet)
            }
            "found" => Share::count(asked(), |case| case.outcome == Outcome::Found),
            "kind" => {
                let right = [Outcome::Found, Outcome::HalfFound, Outcome::Elsewhere];
                Share::count(asked(), |case| right.contains(&case.outcome))
            }
            "extra" => {
                let also =
                    |case: &ScoredConcealment| case.outcome == Outcome::Found && !case.extra.is_empty();
                Share::count(asked(), also)
            }
            "noticed" => {
                let nameless = concealed().filter(|case| case.truth.expected.is_empty());
                Share::count(nameless, |case| case.outcome == Outcome::Noticed)
            }
            "intervals" => sizes(true),
            "agreements" => sizes(false),
            _ => Share::default(),
        }
    }
}

fn scored(
    truth: Concealed,
    answer: Result<Answer, NoAnswer>,
    own: &[Name],
    excess: Option<Excess>,
) -> ScoredConcealment {
    let Ok(given) = &answer else {
        let (sizes, extra) = (Vec::new(), Vec::new());
        let outcome = Outcome::NoAnswer;
        return ScoredConcealment {
            truth,
            answer,
            outcome,
            sizes,
            extra,
            own: Vec::new(),
            shows: None,
            left: None,
        };
    };
    // In the first control what is found is by definition the recording's own.
    ScoredConcealment {
        outcome: outcome(&truth, given, own, excess),
        sizes: sizes(&truth, given),
        extra: extra(&truth, given, own),
        own: given.names().into_iter().filter(|name| own.contains(name)).collect(),
        shows: excess.map(|excess| excess.refitted),
        left: excess.map(|excess| excess.repaired),
        truth,
        answer,
    }
}

/// Objectives of a case's fixtures, evaluated anew and not taken at the answer's word.
struct Objectives {
    believed: f64,
    /// Refitted and repaired; `None` where there is no answer.
    answered: Option<[f64; 2]>,
}

impl Objectives {
    fn of(case: &Case, answer: &Result<Answer, NoAnswer>) -> Option<Self> {
        let judge = Judge::of(case)?;
        let of =
            |answer: &Answer| Some([judge.objective(&answer.refitted)?, judge.objective(&answer.repaired)?]);
        let answered = answer.as_ref().ok().and_then(of);
        Some(Objectives { believed: judge.objective(&case.believed)?, answered })
    }

    /// The lowest that are known of the first control, refitted and repaired.
    fn of_control(&self) -> [f64; 2] {
        let [refitted, repaired] = self.answered.unwrap_or([f64::INFINITY; 2]);
        let refitted = refitted.min(self.believed);
        [refitted, repaired.min(refitted)]
    }

    fn over(&self, control: [f64; 2]) -> Option<Excess> {
        let [refitted, repaired] = self.answered?;
        Some(Excess { refitted: refitted - control[0], repaired: repaired - control[1] })
    }
}
