use crate::file::value;
use jointscope_comparison::{
    ComparedLaw, EstimateEntry, FiledLikelihood, FollowedLaw, LineEntry, LossFactor, MatrixPair, ModelError,
    Nominal, Uncertain,
};
use jointscope_decomposition::{
    Analysis, Compliance, DecompositionError, Element, FoundJoint, InterfaceStiffness, Interfaces, JointEnds,
    JointFit, JointLikelihood, JointLine, JointsCovariance, JointsFit, Judgement, LawFit, LawKind,
    LikelihoodFit, MatrixAverage, Method, Part, Relation,
};
use jointscope_frf::MaskReason;
use jointscope_inference::interval95;
use jointscope_linalg::RealMatrix2;
use jointscope_pipeline::{Decomposition, Joints};
use jointscope_spectra::FrfPair;
use serde::Serialize;
use serde_json::{Map, Value};

/// The contents of `stiffness.json`, of one joint or of several.
pub fn joint_file(decomposition: &Decomposition) -> Value {
    match &decomposition.found {
        Joints::One(analysis) => stiffness_file(analysis),
        Joints::AtOnce(joints) => joints_file(joints),
    }
}

/// The contents of `stiffness.json`: K and C by line, averages, the fitted joint and its interfaces, in SI units.
///
/// `std` is what the FRFs' noise leaves uncertain, `std_fixture` what the fixture's tolerances do, `std_model` what it
/// costs that a constant joint does not explain the FRFs.
pub fn stiffness_file(analysis: &Analysis) -> Value {
    value(OneJoint::of(analysis))
}

/// The contents of `stiffness.json` where several joints were found at once, or one in a loop: every joint as `joint` has it, and the covariance of all.
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

/// A joint from all FRFs, with what follows from its fit.
#[derive(Serialize)]
struct JointEntry<'a> {
    #[serde(flatten)]
    fit: &'a JointFit,
    std: MatrixPair,
    model_error: ModelError,
    follows: FollowedLaw,
    #[serde(skip_serializing_if = "Option::is_none")]
    law: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    laws: Vec<ComparedLaw>,
}

/// Parameters of a law over frequency.
#[derive(Serialize)]
struct LawParameters {
    stiffness: RealMatrix2,
    #[serde(flatten)]
    losses: Option<Losses>,
    #[serde(flatten)]
    shape: Option<Shape>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stiffness_per_rad_per_s: Option<RealMatrix2>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mass: Option<f64>,
}

/// The matrix of a law's losses, which has a name of its own in each.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Losses {
    Damping(RealMatrix2),
    ImaginaryStiffness(RealMatrix2),
    RelaxingStiffness(RealMatrix2),
    Springpot(RealMatrix2),
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Shape {
    Time(f64),
    Exponent(f64),
}

/// The joint from the FRFs across it.
#[derive(Serialize)]
struct AcrossJoint {
    #[serde(flatten)]
    estimate: EstimateEntry,
    relation: Relation,
}

/// A line that could not be solved, Hz.
#[derive(Serialize)]
struct MaskedLine {
    frequency: f64,
    why: &'static str,
}

/// The joint's interfaces, and the fit that they are taken from.
#[derive(Serialize)]
struct InterfaceEntries {
    rest_on: Option<RestOn>,
    translation_both: InterfaceEntry,
    rotation_from: InterfaceEntry,
    rotation_to: InterfaceEntry,
    scalar_11: InterfaceEntry,
    scalar_22: InterfaceEntry,
}

#[derive(Serialize)]
struct RestOn {
    fit: Method,
    explains_the_frfs: bool,
}

#[derive(Serialize)]
struct InterfaceEntry {
    #[serde(flatten)]
    stiffness: StiffnessEntry,
    unit: &'static str,
    compliance: Compliance,
}

/// An interface's stiffness, as far as its compliance tells one.
#[derive(Serialize)]
#[serde(untagged)]
enum StiffnessEntry {
    Found { stiffness: f64, ci95: [f64; 2] },
    StifferThan { above: f64 },
    StifferThanTheBeam { says: &'static str },
}

/// Which FRFs of the recording were used, and how well they are known.
#[derive(Serialize)]
struct UsedRecording<'a> {
    used: Vec<&'a FrfPair>,
    unused: &'a [FrfPair],
    noise_from: Map<String, Value>,
    reference_points: ReferencePoints<'a>,
    rigid_motion_chi2_per_dof: Option<f64>,
    noisy_lines: usize,
    tolerances_not_followed: &'a [String],
}

#[derive(Serialize)]
struct ReferencePoints<'a> {
    responding: &'a str,
    loaded: &'a str,
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

impl<'a> JointEntry<'a> {
    fn of(fit: &'a JointFit) -> Self {
        let (inflation, strain) = (fit.inflation, fit.strain);
        JointEntry {
            fit,
            std: pair(fit.std()),
            model_error: ModelError { inflation, strain, covariance: fit.model_covariance },
            follows: follows(fit),
            law: fit.law().map(LawFit::name),
            laws: fit.laws.iter().map(law).collect(),
        }
    }
}

/// The law that the joint's numbers are of, the frequency at which they are stated, and its losses in its own terms.
fn follows(fit: &JointFit) -> FollowedLaw {
    let follows = &fit.follows;
    let shape = |law: LawKind| {
        let shape = follows.shape.filter(|_| follows.law == law);
        shape.map(|(value, std)| Uncertain { value, std })
    };
    let loss_factor = (follows.law == LawKind::Structural).then(|| {
        let elements = [0, 1].map(|row| [0, 1].map(|column| fit.loss_factor(row, column)));
        LossFactor {
            value: elements.map(|row| row.map(|of| of.map(|(loss, _)| loss))),
            std: elements.map(|row| row.map(|of| of.map(|(_, std)| std))),
            ci95: elements.map(|row| row.map(|of| of.map(|(loss, std)| interval95(loss, std)))),
        }
    });
    FollowedLaw {
        law: follows.fit.name(),
        probability: Some(follows.fit.probability),
        frequency: follows.omega / std::f64::consts::TAU,
        exponent: shape(LawKind::Fractional),
        time: shape(LawKind::StandardLinearSolid),
        loss_factor,
    }
}

fn law(law: &LawFit) -> ComparedLaw {
    let (losses, shape) = match law.kind {
        LawKind::Constant => (None, None),
        LawKind::Viscous | LawKind::LinearStiffness => (Some(Losses::Damping(law.damping)), None),
        LawKind::Structural => (Some(Losses::ImaginaryStiffness(law.damping)), None),
        LawKind::StandardLinearSolid => {
            (Some(Losses::RelaxingStiffness(law.damping)), law.shape.map(Shape::Time))
        }
        LawKind::Fractional => (Some(Losses::Springpot(law.damping)), law.shape.map(Shape::Exponent)),
    };
    let (stiffness, stiffness_per_rad_per_s, mass) = (law.stiffness, law.change, law.mass);
    let parameters = LawParameters { stiffness, losses, shape, stiffness_per_rad_per_s, mass };
    ComparedLaw {
        law: law.name(),
        probability: law.probability,
        parameters: value(parameters),
        in_the_middle: Some(pair(law.in_the_middle())),
        likelihood: law.likelihood.as_ref().map(likelihood),
    }
}

fn likelihood(told: &JointLikelihood) -> FiledLikelihood {
    FiledLikelihood {
        elements: told.elements.clone(),
        at: told.at.clone(),
        gradient: told.gradient.clone(),
        information: told.information.clone(),
    }
}

fn pair((k, c): (RealMatrix2, RealMatrix2)) -> MatrixPair {
    MatrixPair { stiffness: k.0, damping: c.0 }
}

fn line(analysis: &Analysis, line: &JointLine) -> LineEntry {
    let h41 = analysis.spectrum.h41.values.get(line.line);
    let std = line.stiffness_std.zip(line.damping_std).map(pair);
    LineEntry {
        frequency: line.frequency,
        stiffness: line.stiffness.0,
        damping: line.damping.0,
        condition: Some(line.condition),
        h41: h41.map(|h41| h41.0.map(|row| row.map(|value| [value.re, value.im]))),
        noisy: std.map(|_| line.is_noisy()),
        std,
    }
}

/// An estimate with what noise leaves uncertain.
fn estimate(value: (RealMatrix2, RealMatrix2), std: (RealMatrix2, RealMatrix2)) -> EstimateEntry {
    let MatrixPair { stiffness, damping } = pair(value);
    EstimateEntry {
        stiffness,
        damping,
        std: Some(pair(std)),
        band: None,
        lines: None,
        std_fixture: None,
        std_model: None,
        chi2_per_dof: None,
    }
}

fn average(average: &MatrixAverage) -> EstimateEntry {
    estimate((average.stiffness, average.damping), (average.stiffness_std, average.damping_std))
}

fn averages(analysis: &Analysis) -> EstimateEntry {
    let band = analysis.averages.band;
    EstimateEntry {
        band: Some((band.from, band.to)),
        lines: Some(analysis.averages.lines),
        std_fixture: Some(pair(analysis.tolerance_of_averages())),
        ..average(&analysis.averages.plain)
    }
}

/// K and C of the fixture as it stands, read as the lines are; `null` where no line of the band has them.
fn nominal(analysis: &Analysis) -> Nominal {
    let paper = analysis.spectrum.relation == Relation::Paper;
    let element = |part: Part, row: usize, column: usize| {
        analysis.nominal_average(part, Element { row, column }, paper)
    };
    let of = |part: Part| [0, 1].map(|row| [0, 1].map(|column| element(part, row, column)));
    Nominal { stiffness: of(Part::Stiffness), damping: of(Part::Damping) }
}

fn across(analysis: &Analysis, fit: &LikelihoodFit) -> AcrossJoint {
    let estimate = EstimateEntry {
        std_fixture: Some(pair(analysis.tolerance_of_likelihood())),
        std_model: Some(pair(fit.model_std())),
        chi2_per_dof: Some(fit.chi2_per_dof),
        ..estimate((fit.stiffness, fit.damping), (fit.stiffness_std, fit.damping_std))
    };
    AcrossJoint { estimate, relation: Relation::Exact }
}

impl InterfaceEntries {
    fn of(analysis: &Analysis, found: &Interfaces) -> Self {
        let rest_on = |(fit, explains_the_frfs)| RestOn { fit, explains_the_frfs };
        InterfaceEntries {
            rest_on: analysis.interfaces_rest_on().map(rest_on),
            translation_both: InterfaceEntry::of(found.translation, "N/m"),
            rotation_from: InterfaceEntry::of(found.near_rotation, "N*m/rad"),
            rotation_to: InterfaceEntry::of(found.far_rotation, "N*m/rad"),
            scalar_11: InterfaceEntry::of(found.scalar[0], "N/m"),
            scalar_22: InterfaceEntry::of(found.scalar[1], "N*m/rad"),
        }
    }
}

impl InterfaceEntry {
    fn of(compliance: Compliance, unit: &'static str) -> Self {
        let stiffness = match compliance.stiffness() {
            InterfaceStiffness::Found { stiffness, interval } => {
                StiffnessEntry::Found { stiffness, ci95: interval }
            }
            InterfaceStiffness::StifferThan { above } => StiffnessEntry::StifferThan { above },
            InterfaceStiffness::StifferThanTheBeam => StiffnessEntry::StifferThanTheBeam {
                says: "the joint is stiffer than the beam it is said to be",
            },
        };
        InterfaceEntry { stiffness, unit, compliance }
    }
}

impl<'a> UsedRecording<'a> {
    fn of(analysis: &'a Analysis) -> Self {
        let (plan, pairs) = (&analysis.plan, analysis.frfs.pairs());
        let noise = pairs.iter().zip(&analysis.noise).map(|(pair, source)| (pair.to_string(), value(source)));
        UsedRecording {
            used: plan.layout.channels.iter().map(|(index, ..)| &pairs[*index]).collect(),
            unused: &plan.unused,
            noise_from: noise.collect(),
            reference_points: ReferencePoints { responding: &plan.responding.2, loaded: &plan.loaded.2 },
            rigid_motion_chi2_per_dof: analysis.spectrum.h41.rigidity(),
            noisy_lines: analysis.noisy_lines(),
            tolerances_not_followed: &analysis.lost_tolerances,
        }
    }
}
