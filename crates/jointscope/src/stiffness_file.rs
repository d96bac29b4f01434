use crate::file::value;
use jointscope_comparison::{
    ComparedLaw, EstimateEntry, FollowedLaw, LineEntry, LossFactor, MatrixPair, ModelError, Nominal,
    Uncertain,
};
use jointscope_decomposition::{
    Analysis, Compliance, Element, FoundJoint, InterfaceStiffness, JointFit, JointLine, JointsFit, LawFit,
    LawKind, MatrixAverage, Method, Part, Relation,
};
use jointscope_inference::interval95;
use jointscope_linalg::RealMatrix2;
use jointscope_pipeline::{Decomposition, Joints};
use serde_json::{Value, json};

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
    let spectrum = &analysis.spectrum;
    let frequencies = spectrum.h41.lines.hz();
    let masked =
        spectrum.masked.iter().map(|(i, why)| json!({"frequency": frequencies[*i], "why": why.why()}));
    let mut file = json!({
        "joint": joint(analysis),
        "ends": analysis.ends,
        "relation": spectrum.relation.name(),
        "lines": spectrum.solved.iter().map(|solved| line(analysis, solved)).collect::<Vec<_>>(),
        "masked": masked.collect::<Value>(),
        "average": averages(analysis),
        "maximum_likelihood": likelihood(analysis),
        "judgement": analysis.judgement,
        "nominal_stiffness": analysis.nominal_stiffness,
        "nominal": nominal(analysis),
        "recording": recording(analysis),
    });
    if let Some(weighted) = &analysis.averages.weighted {
        file["weighted_average"] = value(average(weighted));
    }
    if let Some(interfaces) = &analysis.interfaces {
        let rest_on = |(method, explains)| json!({"fit": method_name(method), "explains_the_frfs": explains});
        file["interfaces"] = json!({
            "rest_on": analysis.interfaces_rest_on().map(rest_on),
            "translation_both": stiffness(&interfaces.translation, "N/m"),
            "rotation_from": stiffness(&interfaces.near_rotation, "N*m/rad"),
            "rotation_to": stiffness(&interfaces.far_rotation, "N*m/rad"),
            "scalar_11": stiffness(&interfaces.scalar[0], "N/m"),
            "scalar_22": stiffness(&interfaces.scalar[1], "N*m/rad"),
        });
    }
    file
}

/// The contents of `stiffness.json` where several joints were found at once, or one in a loop: every joint as `joint` has it, and the covariance of all.
pub fn joints_file(joints: &JointsFit) -> Value {
    let of = |found: &FoundJoint| {
        let mut entry = fitted(&found.fit);
        entry["name"] = json!(found.name);
        entry["ends"] = json!(found.ends);
        entry["in_a_loop"] = json!(found.is_in_a_loop);
        entry["nominal_stiffness"] = json!(found.nominal);
        entry
    };
    json!({
        "joints": joints.joints.iter().map(of).collect::<Vec<_>>(),
        "covariance": joints.covariance_of_all(),
        "likelihood": joints.likelihood,
    })
}

/// The joint from all FRFs, by the name it has in the fixture.
fn joint(analysis: &Analysis) -> Value {
    let mut entry = match &analysis.joint_fit {
        Ok(fit) => fitted(fit),
        Err(error) => json!({"failed": error.to_string()}),
    };
    entry["name"] = json!(analysis.joint);
    entry
}

fn fitted(fit: &JointFit) -> Value {
    let mut entry = value(fit);
    entry["std"] = value(pair(fit.std()));
    let (inflation, strain) = (fit.inflation, fit.strain);
    entry["model_error"] = value(ModelError { inflation, strain, covariance: fit.model_covariance });
    entry["follows"] = value(follows(fit));
    if let Some(best) = fit.law() {
        entry["law"] = json!(best.name());
        entry["laws"] = value(fit.laws.iter().map(law).collect::<Vec<_>>());
    }
    entry
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
    let mut parameters = json!({"stiffness": law.stiffness});
    let (damping, shape) = match law.kind {
        LawKind::Constant => (None, None),
        LawKind::Viscous | LawKind::LinearStiffness => (Some("damping"), None),
        LawKind::Structural => (Some("imaginary_stiffness"), None),
        LawKind::StandardLinearSolid => (Some("relaxing_stiffness"), Some("time")),
        LawKind::Fractional => (Some("springpot"), Some("exponent")),
    };
    if let Some(key) = damping {
        parameters[key] = json!(law.damping);
    }
    if let Some((key, value)) = shape.zip(law.shape) {
        parameters[key] = json!(value);
    }
    if let Some(change) = &law.change {
        parameters["stiffness_per_rad_per_s"] = json!(change);
    }
    if let Some(mass) = law.mass {
        parameters["mass"] = json!(mass);
    }
    ComparedLaw {
        law: law.name(),
        probability: law.probability,
        parameters,
        in_the_middle: Some(pair(law.in_the_middle())),
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

fn likelihood(analysis: &Analysis) -> Value {
    let fit = match &analysis.likelihood {
        Ok(fit) => fit,
        Err(error) => return json!({"failed": error.to_string()}),
    };
    let mut entry = value(EstimateEntry {
        std_fixture: Some(pair(analysis.tolerance_of_likelihood())),
        std_model: Some(pair(fit.model_std())),
        chi2_per_dof: Some(fit.chi2_per_dof),
        ..estimate((fit.stiffness, fit.damping), (fit.stiffness_std, fit.damping_std))
    });
    entry["relation"] = json!(Relation::Exact.name());
    entry
}

/// The entry of the file that an estimate stands in.
fn method_name(method: Method) -> &'static str {
    match method {
        Method::AllFrfs => "joint",
        Method::MaximumLikelihood => "maximum_likelihood",
        Method::WeightedMean => "weighted_average",
        Method::PlainMean => "average",
    }
}

fn stiffness(compliance: &Compliance, unit: &str) -> Value {
    let mut entry = match compliance.stiffness() {
        InterfaceStiffness::Found { stiffness, interval } => {
            json!({"stiffness": stiffness, "ci95": interval})
        }
        InterfaceStiffness::StifferThan { above } => json!({"above": above}),
        InterfaceStiffness::StifferThanTheBeam => {
            json!({"says": "the joint is stiffer than the beam it is said to be"})
        }
    };
    entry["unit"] = json!(unit);
    entry["compliance"] = json!(compliance);
    entry
}

fn recording(analysis: &Analysis) -> Value {
    let (plan, pairs) = (&analysis.plan, analysis.frfs.pairs());
    let noise = pairs.iter().zip(&analysis.noise).map(|(pair, source)| (pair.to_string(), json!(source)));
    json!({
        "used": plan.layout.channels.iter().map(|(index, ..)| json!(pairs[*index])).collect::<Value>(),
        "unused": plan.unused,
        "noise_from": noise.collect::<Value>(),
        "reference_points": {"responding": plan.responding.2, "loaded": plan.loaded.2},
        "rigid_motion_chi2_per_dof": analysis.spectrum.h41.rigidity(),
        "noisy_lines": analysis.noisy_lines(),
        "tolerances_not_followed": analysis.lost_tolerances,
    })
}
