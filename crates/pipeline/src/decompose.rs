//! The way from a measurement to its joint, or joints.

use crate::{Error, HammerTest, MeasuredFrfs, Measurement};
use jointscope_decomposition::{
    Analysis, AnalysisOptions, DecompositionError, JointFit, JointsFit, Relation, SidesError, fit_joints,
};
use jointscope_estimation::EstimateOptions;
use jointscope_fixture::Fixture;
use jointscope_wording::{Remarks, Summary};

/// What to find of the joints in a measurement.
#[derive(Debug, Clone)]
pub struct DecomposeOptions {
    /// Which joint, by which relation, on which lines.
    pub analysis: AnalysisOptions,
    /// How FRFs follow from hits.
    pub estimate: EstimateOptions,
    /// Refuse a fixture of several joints of which none is named.
    pub one_joint: bool,
}

/// The joint in a measurement, or all joints of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Decomposition {
    /// The fixture that the joints were found with: the one given, under the recording's exponential window
    /// where its FRFs have one.
    pub fixture: Fixture,
    /// What was found.
    pub found: Joints,
    /// What a reader should know of the recording, one plain sentence each.
    pub notes: Vec<String>,
    /// The hits, where it was made from such.
    pub hammer_test: Option<HammerTest>,
    /// Whether lines were asked for by a relation that joints found at once have none of.
    relation_unused: bool,
}

/// What was found, by the way taken.
#[derive(Debug, Clone)]
pub enum Joints {
    /// One joint, taken out of its assembly line by line and by a fit to all FRFs.
    One(Box<Analysis>),
    /// All joints, or one in a loop, by a fit to all FRFs alone.
    AtOnce(Box<JointsFit>),
}

impl Decomposition {
    /// The fit to all FRFs, of the first of several joints; `None` where there is none.
    pub fn fit(&self) -> Option<&JointFit> {
        match &self.found {
            Joints::One(analysis) => analysis.joint_fit.as_ref().ok(),
            Joints::AtOnce(joints) => joints.joints.first().map(|joint| &joint.fit),
        }
    }
}

impl Summary for Decomposition {
    fn summary(&self) -> Vec<String> {
        match &self.found {
            Joints::One(analysis) => analysis.summary(),
            Joints::AtOnce(joints) => joints.summary(),
        }
    }
}

impl Remarks for Decomposition {
    fn remarks(&self) -> Vec<String> {
        match &self.found {
            Joints::One(analysis) => analysis.remarks(),
            Joints::AtOnce(_) if self.relation_unused => vec![
                "--relation paper has no meaning for several joints at once: no line is decomposed, all are fitted"
                    .to_owned(),
            ],
            Joints::AtOnce(_) => Vec::new(),
        }
    }
}

/// Finds the joint of `fixture` in `measurement`, or all its joints at once where it has several and none is
/// named, or the one lies in a loop.
///
/// # Errors
/// See [`Error`]; [`Error::concern`] says which of the inputs is at fault.
pub fn decompose(
    fixture: &Fixture,
    measurement: Measurement,
    options: &DecomposeOptions,
) -> Result<Decomposition, Error> {
    let measured = MeasuredFrfs::of(&measurement, &options.estimate);
    drop(measurement); // as much memory as the recording
    let MeasuredFrfs { frfs, notes, window_decay, hammer_test } = measured?.screened(fixture)?.restored();
    let fixture = MeasuredFrfs::under_window(fixture, window_decay)?;
    let asked = &options.analysis;
    let count = fixture.joints().len();
    let several = asked.joint.is_none() && count > 1;
    if several && options.one_joint {
        return Err(Error::SeveralJoints { count });
    }
    let analysis = match several {
        true => None,
        false => match Analysis::of(&fixture, &frfs, asked) {
            Err(DecompositionError::Sides(SidesError::Loop(_))) => None,
            analysis => Some(analysis?),
        },
    };
    let found = match analysis {
        Some(analysis) => Joints::One(Box::new(analysis)),
        None => {
            let names = asked.joint.as_ref().map(std::slice::from_ref);
            Joints::AtOnce(Box::new(fit_joints(&fixture, &frfs, names, asked.of_fit())?))
        }
    };
    let relation_unused = asked.relation == Relation::Paper;
    Ok(Decomposition { fixture, found, notes, hammer_test, relation_unused })
}
