use crate::{Decomposed, Estimate, FittedJoint, Ranking};

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

/// Which of its estimates stands for each joint: the first one that all of them have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compared {
    /// The joint from all FRFs, the fixture's quantities moving within their tolerances.
    AllFrfs,
    /// The maximum-likelihood joint from the FRFs across it.
    Likelihood,
    /// Averages over each joint's band.
    Average,
}

impl Compared {
    fn of(relation: &str, joints: &[Decomposed]) -> Self {
        // Fits are of the exact relation.
        let fits = relation == "exact";
        if fits && joints.iter().all(|joint| joint.fitted.is_some()) {
            Compared::AllFrfs
        } else if fits && joints.iter().all(|joint| joint.likelihood.is_some()) {
            Compared::Likelihood
        } else {
            Compared::Average
        }
    }

    /// As `comparison.json` writes it.
    pub fn name(self) -> &'static str {
        match self {
            Compared::AllFrfs => "all_frfs",
            Compared::Likelihood => "maximum_likelihood",
            Compared::Average => "average",
        }
    }
}

impl From<&FittedJoint> for Estimate {
    fn from(fit: &FittedJoint) -> Self {
        let deviation = |e: usize| fit.covariance[e][e].max(0.0).sqrt();
        let matrix = |first: usize| {
            let of = |e: usize| deviation(first + e);
            [[of(0), of(1)], [of(1), of(2)]]
        };
        Estimate {
            stiffness: fit.stiffness,
            damping: fit.damping,
            stiffness_std: matrix(0),
            damping_std: matrix(3),
        }
    }
}

/// Several joints side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The joints, as given.
    pub joints: Vec<Decomposed>,
    /// The relation of all of them.
    pub relation: String,
    /// Which estimates are compared.
    pub compared: Compared,
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
    /// Ranks joints by every element: by the first of [`Compared`] that all of them have; fits only where the relation is the exact one, which they
    /// are of.
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
        let compared = Compared::of(&relation, &joints);
        let mut comparison = Comparison { joints, relation, compared, rankings: Vec::new() };
        for kind in [Kind::Stiffness, Kind::Damping] {
            for element in ELEMENTS {
                let values: Vec<(f64, f64)> = comparison
                    .joints
                    .iter()
                    .map(|joint| kind.of(&comparison.estimate(joint), element))
                    .collect();
                comparison.rankings.push(ElementRanking { kind, element, ranking: Ranking::of(&values) });
            }
        }
        Ok(comparison)
    }

    /// The estimate by which a joint is compared.
    pub fn estimate(&self, joint: &Decomposed) -> Estimate {
        let fitted = || joint.fitted.as_ref().map(Estimate::from);
        let found = match self.compared {
            Compared::AllFrfs => fitted(),
            Compared::Likelihood => joint.likelihood,
            Compared::Average => None,
        };
        found.unwrap_or(joint.average)
    }

    /// What is compared, in words.
    pub fn estimate_words(&self) -> &'static str {
        match self.compared {
            Compared::AllFrfs => "the joints from all FRFs",
            Compared::Likelihood => "maximum-likelihood estimates from the FRFs across each joint",
            Compared::Average => "averages over each joint's band",
        }
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
        let estimate = found.estimate(&found.joints[0]);
        assert_eq!(estimate.stiffness[0][0], 100.0);
        let roots = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(f64::sqrt);
        assert_eq!(estimate.stiffness_std, [[roots[0], roots[1]], [roots[1], roots[2]]]);
        assert_eq!(estimate.damping_std, [[roots[3], roots[4]], [roots[4], roots[5]]]);
        assert!(found.estimate_words().contains("all FRFs"));
    }

    #[test]
    fn where_one_joint_lacks_a_fit_all_are_compared_by_what_they_share() {
        let found = compared([file(Some(100.0), Some(300.0), 500.0), file(None, Some(250.0), 400.0)]);
        assert_eq!((found.compared, found.compared.name()), (Compared::Likelihood, "maximum_likelihood"));
        assert_eq!(found.rankings[0].ranking.order, [1, 0]);
        let found = compared([file(Some(100.0), None, 500.0), file(None, Some(250.0), 400.0)]);
        assert_eq!(found.compared, Compared::Average);
        assert_eq!(found.estimate(&found.joints[1]).stiffness[0][0], 400.0);
    }
}
