//! The contents of `stiffness.json`.

mod across;
mod by_line;
mod from_all_frfs;
mod interfaces;
mod interfaces_by_line;
mod masked;
mod pair;
mod recording;

use crate::file::value;
use across::{AcrossJoint, across, average, averages, nominal};
use by_line::line;
use from_all_frfs::JointEntry;
use interfaces::InterfaceEntries;
use interfaces_by_line::InterfacesByLine;
use jointscope_comparison::{EstimateEntry, LineEntry, Nominal};
use jointscope_decomposition::{
    Analysis, DecompositionError, FoundJoint, JointEnds, JointLikelihood, JointsCovariance, JointsFit,
    Judgement, Relation,
};
use jointscope_frf::MaskReason;
use jointscope_linalg::RealMatrix2;
use jointscope_pipeline::{Decomposition, Joints};
use masked::MaskedLine;
use recording::UsedRecording;
use serde::Serialize;
use serde_json::Value;

/// The contents of `stiffness.json`, of one joint or of several.
pub fn joint_file(decomposition: &Decomposition) -> Value {
    match &decomposition.found {
        Joints::One(analysis) => stiffness_file(analysis),
        Joints::AtOnce(joints) => joints_file(joints),
    }
}

/// The contents of `stiffness.json`: K and C by line, averages, the fitted joint and its interfaces, also by
/// line, in SI units.
///
/// `std` is what the FRFs' noise leaves uncertain, `std_fixture` what the fixture's tolerances do,
/// `std_model` what it costs that a constant joint does not explain the FRFs.
pub fn stiffness_file(analysis: &Analysis) -> Value {
    value(OneJoint::of(analysis))
}

/// The contents of `stiffness.json` where several joints were found at once, or one in a loop: every joint as
/// `joint` has it, and the covariance of all.
pub fn joints_file(joints: &JointsFit) -> Value {
    value(JointsAtOnce {
        joints: joints.joints.iter().map(JointAtOnce::of).collect(),
        covariance: joints.covariance_of_all(),
        likelihood: &joints.likelihood,
    })
}

/// The file of one joint.
#[derive(Serialize)]
struct OneJoint<'a> {
    joint: Named<'a>,
    ends: &'a JointEnds,
    relation: Relation,
    lines: Vec<LineEntry>,
    masked: Vec<MaskedLine>,
    average: EstimateEntry,
    maximum_likelihood: Fitted<AcrossJoint>,
    judgement: Judgement,
    nominal_stiffness: RealMatrix2,
    nominal: Nominal,
    recording: UsedRecording<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    weighted_average: Option<EstimateEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    interfaces: Option<InterfaceEntries>,
    #[serde(skip_serializing_if = "Option::is_none")]
    interfaces_by_line: Option<InterfacesByLine>,
}

/// The file of joints that one fit found.
#[derive(Serialize)]
struct JointsAtOnce<'a> {
    joints: Vec<JointAtOnce<'a>>,
    covariance: JointsCovariance<'a>,
    likelihood: &'a Option<JointLikelihood>,
}

/// One of the joints that one fit found.
#[derive(Serialize)]
struct JointAtOnce<'a> {
    #[serde(flatten)]
    fit: JointEntry<'a>,
    name: &'a str,
    ends: &'a JointEnds,
    in_a_loop: bool,
    nominal_stiffness: RealMatrix2,
}

/// The joint from all FRFs, by the name it has in the fixture.
#[derive(Serialize)]
struct Named<'a> {
    #[serde(flatten)]
    fit: Fitted<JointEntry<'a>>,
    name: &'a str,
}

/// What a fit found, or why there is none.
#[derive(Serialize)]
#[serde(untagged)]
enum Fitted<T> {
    Found(T),
    Failed { failed: String },
}

impl<'a> OneJoint<'a> {
    fn of(analysis: &'a Analysis) -> Self {
        let spectrum = &analysis.spectrum;
        let frequencies = spectrum.h41.lines.hz();
        let masked =
            |&(line, why): &(usize, MaskReason)| MaskedLine { frequency: frequencies[line], why: why.why() };
        OneJoint {
            joint: Named { fit: Fitted::of(&analysis.joint_fit, JointEntry::of), name: &analysis.joint },
            ends: &analysis.ends,
            relation: spectrum.relation,
            lines: spectrum.solved.iter().map(|solved| line(analysis, solved)).collect(),
            masked: spectrum.masked.iter().map(masked).collect(),
            average: averages(analysis),
            maximum_likelihood: Fitted::of(&analysis.likelihood, |fit| across(analysis, fit)),
            judgement: analysis.judgement,
            nominal_stiffness: analysis.nominal_stiffness,
            nominal: nominal(analysis),
            recording: UsedRecording::of(analysis),
            weighted_average: analysis.averages.weighted.as_ref().map(average),
            interfaces: analysis.interfaces.as_ref().map(|found| InterfaceEntries::of(analysis, found)),
            interfaces_by_line: analysis
                .interface_spectrum
                .as_ref()
                .map(|found| InterfacesByLine::of(found, frequencies)),
        }
    }
}

impl<T> Fitted<T> {
    fn of<'a, F>(fit: &'a Result<F, DecompositionError>, entry: impl Fn(&'a F) -> T) -> Self {
        match fit {
            Ok(fit) => Fitted::Found(entry(fit)),
            Err(error) => Fitted::Failed { failed: error.to_string() },
        }
    }
}

impl<'a> JointAtOnce<'a> {
    fn of(found: &'a FoundJoint) -> Self {
        JointAtOnce {
            fit: JointEntry::of(&found.fit),
            name: &found.name,
            ends: &found.ends,
            in_a_loop: found.is_in_a_loop,
            nominal_stiffness: found.nominal,
        }
    }
}
