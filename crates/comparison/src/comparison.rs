use crate::{Decomposed, Estimate, Ranking};

/// K or C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// K.
    Stiffness,
    /// C.
    Damping,
}

impl Kind {
    /// `K` or `C`.
    pub fn symbol(self) -> &'static str {
        match self {
            Kind::Stiffness => "K",
            Kind::Damping => "C",
        }
    }

    /// Unit of an element, SI.
    pub fn unit(self, (i, j): (usize, usize)) -> &'static str {
        match (self, i, j) {
            (Kind::Stiffness, 0, 0) => "N/m",
            (Kind::Stiffness, 0, _) => "N/rad",
            (Kind::Stiffness, _, 0) => "N*m/m",
            (Kind::Stiffness, ..) => "N*m/rad",
            (Kind::Damping, 0, 0) => "N*s/m",
            (Kind::Damping, 0, _) => "N*s/rad",
            (Kind::Damping, _, 0) => "N*s",
            (Kind::Damping, ..) => "N*m*s/rad",
        }
    }

    /// Value and standard deviation of an element of an estimate.
    pub fn of(self, estimate: &Estimate, (i, j): (usize, usize)) -> (f64, f64) {
        match self {
            Kind::Stiffness => (estimate.stiffness[i][j], estimate.stiffness_std[i][j]),
            Kind::Damping => (estimate.damping[i][j], estimate.damping_std[i][j]),
        }
    }
}

/// Rows and columns of the elements.
pub const ELEMENTS: [(usize, usize); 4] = [(0, 0), (0, 1), (1, 0), (1, 1)];

/// The order of the joints by one element.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementRanking {
    /// K or C.
    pub kind: Kind,
    /// Row and column, from 0.
    pub element: (usize, usize),
    /// The order.
    pub ranking: Ranking,
}

/// Several joints side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The joints, as given.
    pub joints: Vec<Decomposed>,
    /// The relation of all of them.
    pub relation: String,
    /// Whether the maximum-likelihood joints are compared, or the averages.
    pub by_likelihood: bool,
    /// Orders by each element of K, then of C.
    pub rankings: Vec<ElementRanking>,
}

/// Why joints cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ComparisonError {
    /// Fewer than two.
    #[error("a comparison needs two decompositions or more")]
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
    /// A name twice.
    #[error("two decompositions are called `{0}`")]
    Twice(String),
}

impl Comparison {
    /// Ranks joints by every element: by their maximum-likelihood estimates where all have one and the relation is the exact one, which those
    /// are of, by their averages elsewhere.
    ///
    /// # Errors
    /// See [`ComparisonError`].
    pub fn of(joints: Vec<Decomposed>) -> Result<Self, ComparisonError> {
        let [first, others @ ..] = joints.as_slice() else { return Err(ComparisonError::TooFew) };
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
        if let Some(i) = (1..joints.len()).find(|&i| joints[..i].iter().any(|j| j.name == joints[i].name)) {
            return Err(ComparisonError::Twice(joints[i].name.clone()));
        }
        let relation = first.relation.clone();
        let by_likelihood = relation == "exact" && joints.iter().all(|joint| joint.likelihood.is_some());
        let mut comparison = Comparison { joints, relation, by_likelihood, rankings: Vec::new() };
        for kind in [Kind::Stiffness, Kind::Damping] {
            for element in ELEMENTS {
                let values: Vec<(f64, f64)> = comparison
                    .joints
                    .iter()
                    .map(|joint| kind.of(comparison.estimate(joint), element))
                    .collect();
                comparison.rankings.push(ElementRanking { kind, element, ranking: Ranking::of(&values) });
            }
        }
        Ok(comparison)
    }

    /// The estimate by which a joint is compared.
    pub fn estimate<'a>(&self, joint: &'a Decomposed) -> &'a Estimate {
        joint.likelihood.as_ref().filter(|_| self.by_likelihood).unwrap_or(&joint.average)
    }

    /// What is compared, in words.
    pub fn estimate_words(&self) -> &'static str {
        if self.by_likelihood { "maximum-likelihood estimates" } else { "averages over each joint's band" }
    }
}
