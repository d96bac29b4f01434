//! Several decompositions side by side: ratios and orders of their elements, and what to be careful about.

use crate::by_law::{ByLaw, posteriors};
use crate::choices::choices;
use crate::equality::of_two;
use crate::{
    Caution, Compared, Decomposed, ELEMENTS, Equality, FiledEstimate, FiledJoint, Kind, LawOfAll, LawsDiffer,
    ModelRatios, Number, Pair, Ranking, Specimens, Together,
};

/// Those of a symmetric matrix.
const DISTINCT: [(usize, usize); 3] = [(0, 0), (0, 1), (1, 1)];

/// The order of the joints by one number.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementRanking {
    /// K or C.
    pub kind: Kind,
    /// Row and column, from 0.
    pub element: (usize, usize),
    /// The order.
    pub ranking: Ranking,
    /// Whether all joints' numbers have a standard deviation: without, the order's probabilities say nothing.
    pub has_deviations: bool,
}

impl ElementRanking {
    /// The number ranked by.
    pub fn number(&self) -> Number {
        Number { kind: self.kind, element: self.element }
    }

    /// Whether the whole order is as good as sure.
    pub fn is_settled(&self) -> bool {
        self.has_deviations && self.ranking.is_settled()
    }

    /// Whether the whole order may be stated: twice as likely right as wrong, or with nothing that tells how
    /// sure it is.
    pub fn is_stated(&self) -> bool {
        !self.has_deviations || self.ranking.is_stated()
    }

    /// Pairs of joints whose order is as good as sure, the smaller first; none where nothing tells how sure
    /// that is.
    pub fn decided(&self) -> impl Iterator<Item = (usize, &[usize])> {
        let of_joint =
            self.ranking.order.iter().zip(&self.ranking.decided).filter(|(_, larger)| !larger.is_empty());
        of_joint.filter(|_| self.has_deviations).map(|(joint, larger)| (*joint, larger.as_slice()))
    }

    /// Of each joint in the order but the first: whether it is as good as sure that it is larger than the one
    /// before it.
    pub fn settled_neighbours(&self) -> impl Iterator<Item = bool> {
        self.ranking.settled_neighbours().map(|settled| self.has_deviations && settled)
    }
}

impl From<&FiledJoint> for FiledEstimate {
    fn from(fit: &FiledJoint) -> Self {
        let deviation = |e: usize| fit.covariance[e][e].max(0.0).sqrt();
        let matrix = |first: usize| {
            let of = |e: usize| deviation(first + e);
            [[of(0), of(1)], [of(1), of(2)]]
        };
        FiledEstimate {
            stiffness: fit.stiffness,
            damping: fit.damping,
            stiffness_std: matrix(0),
            damping_std: matrix(3),
        }
    }
}

/// What is known besides the files.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ComparisonOptions {
    /// Take every joint as tested on blocks of its own, whatever the fixtures state.
    pub independent: bool,
    /// Names of kinds, and their specimens by their places among the joints.
    pub specimens: Vec<(String, Vec<usize>)>,
}

/// Several joints side by side.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// The joints, as given, with the fits by the law of all of them.
    pub joints: Vec<Decomposed>,
    /// The relation of all of them.
    pub relation: String,
    /// Which estimates are compared.
    pub compared: Compared,
    /// The numbers compared: six of symmetric matrices, eight of averages.
    pub numbers: Vec<Number>,
    /// The law over frequency at which they are compared; nothing where no one law is probable enough for
    /// all, or where less than fits to all FRFs are compared. Each is then of its own law.
    pub law: Option<LawOfAll>,
    /// All joints in one Gaussian.
    pub together: Together,
    /// Every two of them, in the order given.
    pub pairs: Vec<Pair>,
    /// Whether all joints are the same: of the two that differ most, its p-value times the number of pairs;
    /// nothing where two are not tested.
    pub equality: Option<Equality>,
    /// Orders by each number of K, then of C.
    pub rankings: Vec<ElementRanking>,
    /// Joints of models over measured ones; none where no joint is said to be of a model, or none of a
    /// measurement.
    pub models: Vec<ModelRatios>,
    /// Kinds with several specimens.
    pub specimens: Vec<Specimens>,
    /// What keeps the comparison from being taken as it stands; none where it may be.
    pub cautions: Vec<Caution>,
}

/// Why joints cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ComparisonError {
    /// Fewer than two.
    #[error(
        "a comparison needs two decompositions or more; name the directories that two runs of `jointscope decompose` wrote to"
    )]
    TooFew,
    /// Some were found by eq (7), some by the exact relation.
    #[error(
        "`{first}` was decomposed by the relation `{one}` and `{second}` by `{other}`, which are different matrices: decompose all with the same `--relation`"
    )]
    Relations {
        /// A joint.
        first: String,
        /// Its relation.
        one: String,
        /// Another.
        second: String,
        /// Its relation.
        other: String,
    },
    /// No estimate that all of them have.
    #[error(
        "`{found_at_once}` was found together with other joints by a fit to all FRFs alone, and `{other}` has no such fit: compare it with joints that have one, or decompose anew with `--joint`"
    )]
    NothingInCommon {
        /// A joint without averages.
        found_at_once: String,
        /// A joint without a fit to all FRFs.
        other: String,
    },
    /// A name twice.
    #[error("two decompositions are called `{0}`")]
    Twice(String),
    /// A kind of one specimen.
    #[error(
        "`{0}` has one specimen, whose scatter nothing tells: name two directories or more, or one of several joints"
    )]
    OneSpecimen(String),
}

impl Comparison {
    /// Compares joints on the blocks that their fixtures state alike; see [`Comparison::with`].
    ///
    /// # Errors
    /// See [`ComparisonError`].
    pub fn of(joints: Vec<Decomposed>) -> Result<Self, ComparisonError> {
        Comparison::with(joints, &ComparisonOptions::default())
    }

    /// Compares joints by the first of [`Compared`] that all of them have; by fits only where the relation is
    /// the exact one, which they are of.
    ///
    /// # Errors
    /// See [`ComparisonError`].
    pub fn with(joints: Vec<Decomposed>, options: &ComparisonOptions) -> Result<Self, ComparisonError> {
        if let Some((name, _)) = options.specimens.iter().find(|(_, places)| places.len() < 2) {
            return Err(ComparisonError::OneSpecimen(name.clone()));
        }
        let relation = common_relation(&joints)?;
        let compared = common_estimate(&relation, &joints)?;
        let law = LawOfAll::of(&joints).filter(|_| compared == Compared::AllFrfs);
        let given = joints;
        let joints = law.as_ref().map_or_else(|| given.clone(), |law| law.placed(&given));
        let numbers = numbers(&joints, compared);
        let estimates: Vec<FiledEstimate> = joints.iter().map(|joint| stated(joint, compared)).collect();
        let by_law = match compared {
            Compared::AllFrfs => {
                posteriors(&choices(&given, &joints, law.as_ref()), &numbers, options.independent)
            }
            _ => vec![(1.0, Together::independent(&estimates, &numbers))],
        };
        let together = with_spread(&by_law);
        let cautions = Caution::of(&joints, &estimates, (compared, &numbers), &together);
        let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
        let pairs = every_two(joints.len()).map(|(a, b)| {
            let tested = (compared == Compared::AllFrfs).then_some([&given[a], &given[b]]);
            pair(&by_law, &numbers, ((a, b), [names[a], names[b]]), tested, options.independent)
        });
        let pairs: Vec<Pair> = pairs.collect();
        let rankings = (0..numbers.len()).map(|n| ranking(&together, &estimates, &numbers, n)).collect();
        let specimens = options.specimens.iter().map(|(kind, places)| {
            let named: Vec<(usize, &str)> = places.iter().map(|&joint| (joint, names[joint])).collect();
            Specimens::of(kind, &together, &numbers, &named)
        });
        let specimens = specimens.collect();
        let equality = Equality::of_pairs(pairs.iter().map(|pair| pair.equality));
        Ok(Comparison {
            models: ModelRatios::all(&joints, &by_law, &numbers),
            relation,
            compared,
            law,
            pairs,
            equality,
            rankings,
            specimens,
            cautions,
            numbers,
            together,
            joints,
        })
    }

    /// What is compared of a joint: of fits to tests on the same blocks what all of them tell of it.
    pub fn estimate(&self, joint: usize) -> FiledEstimate {
        let mut estimate = stated(&self.joints[joint], self.compared);
        for (n, number) in self.numbers.iter().enumerate() {
            let (value, std) = (self.together.value(joint, n), self.together.std(joint, n));
            let (i, j) = number.element;
            let (values, stds) = match number.kind {
                Kind::Stiffness => (&mut estimate.stiffness, &mut estimate.stiffness_std),
                Kind::Damping => (&mut estimate.damping, &mut estimate.damping_std),
            };
            (values[i][j], stds[i][j]) = (value, std);
            if self.compared != Compared::Average {
                (values[j][i], stds[j][i]) = (value, std);
            }
        }
        estimate
    }

    /// Whether nothing speaks against taking it as it stands.
    pub fn is_sound(&self) -> bool {
        self.cautions.is_empty()
    }

    /// Whether the decomposition of one of the joints is judged unusable.
    pub fn is_unusable(&self) -> bool {
        self.cautions.iter().any(|caution| matches!(caution, Caution::Unusable { .. }))
    }

    /// Whether every element of K orders all joints, by fits to all FRFs that nothing speaks against: what
    /// does not explain its recording earns no approval, however sure the order.
    pub fn is_conclusive(&self) -> bool {
        let mut stiffness = self.rankings.iter().filter(|entry| entry.kind == Kind::Stiffness).peekable();
        let settled = stiffness.peek().is_some() && stiffness.all(ElementRanking::is_settled);
        settled && self.is_sound() && self.compared == Compared::AllFrfs
    }
}

/// The relation of all joints, two or more, no two of one name.
fn common_relation(joints: &[Decomposed]) -> Result<String, ComparisonError> {
    let [first, others @ ..] = joints else { return Err(ComparisonError::TooFew) };
    if others.is_empty() {
        return Err(ComparisonError::TooFew);
    }
    if let Some(other) = others.iter().find(|joint| joint.relation != first.relation) {
        return Err(ComparisonError::Relations {
            first: first.name.clone(),
            one: first.relation.clone(),
            second: other.name.clone(),
            other: other.relation.clone(),
        });
    }
    match (1..joints.len()).find(|&i| joints[..i].iter().any(|j| j.name == joints[i].name)) {
        Some(twice) => Err(ComparisonError::Twice(joints[twice].name.clone())),
        None => Ok(first.relation.clone()),
    }
}

/// The first of the estimates that all joints have.
fn common_estimate(relation: &str, joints: &[Decomposed]) -> Result<Compared, ComparisonError> {
    let compared = Compared::of(relation, joints);
    if let Some(joint) = joints.iter().find(|joint| !compared.is_had_by(joint)) {
        let other = joints.iter().find(|joint| !Compared::AllFrfs.is_had_by(joint));
        return Err(ComparisonError::NothingInCommon {
            found_at_once: joint.name.clone(),
            other: other.map_or(String::new(), |other| other.name.clone()),
        });
    }
    Ok(compared)
}

/// The estimate that stands for a joint, as its file states it.
fn stated(joint: &Decomposed, compared: Compared) -> FiledEstimate {
    let found = match compared {
        Compared::AllFrfs => joint.fitted.as_ref().map(FiledEstimate::from),
        Compared::Likelihood => joint.likelihood,
        Compared::Average => None,
    };
    found.or(joint.average.map(|average| average.estimate)).unwrap_or_default()
}

/// The numbers that any of the joints has.
fn numbers(joints: &[Decomposed], compared: Compared) -> Vec<Number> {
    let estimates: Vec<FiledEstimate> = joints.iter().map(|joint| stated(joint, compared)).collect();
    let elements: &[(usize, usize)] = if compared == Compared::Average { &ELEMENTS } else { &DISTINCT };
    let all = [Kind::Stiffness, Kind::Damping]
        .into_iter()
        .flat_map(|kind| elements.iter().map(move |&element| Number { kind, element }));
    // Bodies that do not rotate leave all but the first element empty.
    all.filter(|number| estimates.iter().any(|estimate| number.of(estimate) != (0.0, 0.0))).collect()
}

/// All joints in one Gaussian by the laws compared at, with how far other laws take them.
fn with_spread(by_law: &ByLaw) -> Together {
    let mut together = by_law[0].1.clone();
    together.spread(&by_law[1..]);
    together
}

/// Every two of so many joints, in the order given.
fn every_two(joints: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..joints).flat_map(move |a| (a + 1..joints).map(move |b| (a, b)))
}

/// Two joints with their names; whether they are the same is tested by their files, `tested`, where fits to
/// all FRFs are compared.
fn pair(
    by_law: &ByLaw,
    numbers: &[Number],
    (places, names): ((usize, usize), [&str; 2]),
    tested: Option<[&Decomposed; 2]>,
    independent: bool,
) -> Pair {
    let of_two = tested.and_then(|two| of_two(&two.map(Decomposed::clone), numbers, independent));
    let pair = Pair::of(by_law, numbers, places, names, of_two.as_deref());
    let untested = tested.filter(|_| pair.equality.is_none());
    Pair { laws_differ: untested.and_then(|[a, b]| LawsDiffer::of(a, b)), ..pair }
}

/// The order of all joints by the number of index `n`.
fn ranking(together: &Together, estimates: &[FiledEstimate], numbers: &[Number], n: usize) -> ElementRanking {
    let all = 0..estimates.len();
    let values: Vec<f64> = all.clone().map(|joint| together.value(joint, n)).collect();
    let covariance: Vec<f64> = all
        .clone()
        .flat_map(|a| all.clone().map(move |b| (a, b)))
        .map(|(a, b)| together.covariance((a, n), (b, n)))
        .collect();
    let number = &numbers[n];
    ElementRanking {
        kind: number.kind,
        element: number.element,
        ranking: Ranking::joint(&values, &covariance),
        has_deviations: !estimates.iter().any(|estimate| number.has_no_deviation(estimate)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn file(all: Option<f64>, across: Option<f64>, average: f64) -> Value {
        let pair = |k: f64| {
            let m = json!([[k, 0.1 * k], [0.1 * k, k]]);
            json!({"stiffness": m, "damping": m})
        };
        let estimate = |k: f64| {
            let mut entry = pair(k);
            entry["std"] = pair(1.0);
            entry
        };
        let covariance: [[f64; 6]; 6] =
            std::array::from_fn(|m| std::array::from_fn(|n| if m == n { (m + 1) as f64 } else { 0.0 }));
        let mut file = json!({"joint": "J", "relation": "exact", "lines": [], "average": estimate(average)});
        file["average"]["band"] = json!([100.0, 200.0]);
        if let Some(k) = across {
            file["maximum_likelihood"] = estimate(k);
        }
        if let Some(k) = all {
            file["joint"] = pair(k);
            file["joint"]["name"] = json!("J");
            file["joint"]["covariance"] = json!(covariance);
        }
        file
    }

    fn compared(files: [Value; 2]) -> Comparison {
        let [a, b] =
            files.map(|file| Decomposed::of(file["average"]["stiffness"].to_string(), &file).unwrap());
        Comparison::of(vec![a, b]).unwrap()
    }

    #[test]
    fn joints_from_all_frfs_are_ranked_rather_than_those_from_the_frfs_across() {
        // By all FRFs the second is the larger, by those across it and by averages the first.
        let found = compared([file(Some(100.0), Some(300.0), 500.0), file(Some(200.0), Some(250.0), 400.0)]);
        assert_eq!(found.compared, Compared::AllFrfs);
        let first = &found.rankings[0].ranking;
        assert_eq!(first.order, [0, 1]);
        let estimate = found.estimate(0);
        assert_eq!(estimate.stiffness[0][0], 100.0);
        let roots = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(f64::sqrt);
        assert_eq!(estimate.stiffness_std, [[roots[0], roots[1]], [roots[1], roots[2]]]);
        assert_eq!(estimate.damping_std, [[roots[3], roots[4]], [roots[4], roots[5]]]);
    }

    #[test]
    fn where_one_joint_lacks_a_fit_all_are_compared_by_what_they_share() {
        let found = compared([file(Some(100.0), Some(300.0), 500.0), file(None, Some(250.0), 400.0)]);
        assert_eq!((found.compared, found.compared.name()), (Compared::Likelihood, "maximum_likelihood"));
        assert_eq!(found.rankings[0].ranking.order, [1, 0]);
        // Nothing is known of how the errors of their numbers go together.
        assert!(found.pairs[0].equality.is_none() && found.pairs[0].number("elastic_centre").is_none());
        let found = compared([file(Some(100.0), None, 500.0), file(None, Some(250.0), 400.0)]);
        assert_eq!(found.compared, Compared::Average);
        assert_eq!(found.estimate(1).stiffness[0][0], 400.0);
    }
}
