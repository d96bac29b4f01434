use crate::file::value;
use jointscope_decomposition::{
    Analysis, Compliance, Element, FoundJoint, InterfaceStiffness, JointFit, JointLine, JointsFit, LawFit,
    LawKind, MatrixAverage, Method, Part, Relation,
};
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
        "lines": spectrum.solved.iter().map(|solved| line(analysis, solved)).collect::<Value>(),
        "masked": masked.collect::<Value>(),
        "average": averages(analysis),
        "maximum_likelihood": likelihood(analysis),
        "judgement": analysis.judgement,
        "nominal_stiffness": analysis.nominal_stiffness,
        "nominal": nominal(analysis),
        "recording": recording(analysis),
    });
    if let Some(weighted) = &analysis.averages.weighted {
        file["weighted_average"] = average(weighted);
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
    entry["std"] = pair(fit.std());
    let (inflation, strain) = (fit.inflation, fit.strain);
    entry["model_error"] =
        json!({"inflation": inflation, "strain": strain, "covariance": fit.model_covariance});
    entry["follows"] = follows(fit);
    if let Some(best) = fit.law() {
        entry["law"] = json!(best.name());
        entry["laws"] = fit.laws.iter().map(law).collect();
    }
    entry
}

/// The law that the joint's numbers are of, the frequency at which they are stated, and its losses in its own terms.
fn follows(fit: &JointFit) -> Value {
    let follows = &fit.follows;
    let frequency = follows.omega / std::f64::consts::TAU;
    let mut entry = json!({
        "law": follows.fit.name(),
        "probability": follows.fit.probability,
        "frequency": frequency,
    });
    if let Some((shape, std)) = follows.shape {
        let key = if follows.law == LawKind::Fractional { "exponent" } else { "time" };
        entry[key] = json!({"value": shape, "std": std});
    }
    if follows.law == LawKind::Structural {
        let element = |of: &dyn Fn((f64, f64)) -> Value| {
            [0, 1].map(|row| [0, 1].map(|column| fit.loss_factor(row, column).map(of)))
        };
        entry["loss_factor"] = json!({
            "value": element(&|(loss, _)| json!(loss)),
            "std": element(&|(_, std)| json!(std)),
            "ci95": element(&|(loss, std)| json!([loss - 1.96 * std, loss + 1.96 * std])),
        });
    }
    entry
}

fn law(law: &LawFit) -> Value {
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
    json!({
        "law": law.name(),
        "probability": law.probability,
        "parameters": parameters,
        "in_the_middle": pair(law.in_the_middle()),
    })
}

fn pair((k, c): (RealMatrix2, RealMatrix2)) -> Value {
    json!({"stiffness": k, "damping": c})
}

fn line(analysis: &Analysis, line: &JointLine) -> Value {
    let mut entry = value(line);
    if let Some(h41) = analysis.spectrum.h41.values.get(line.line) {
        entry["h41"] = json!(h41.0.map(|row| row.map(|value| [value.re, value.im])));
    }
    if let Some(std) = line.stiffness_std.zip(line.damping_std) {
        entry["std"] = pair(std);
        entry["noisy"] = json!(line.is_noisy());
    }
    entry
}

fn average(average: &MatrixAverage) -> Value {
    json!({
        "stiffness": average.stiffness,
        "damping": average.damping,
        "std": pair((average.stiffness_std, average.damping_std)),
    })
}

fn averages(analysis: &Analysis) -> Value {
    let mut entry = average(&analysis.averages.plain);
    entry["band"] = json!([analysis.averages.band.from, analysis.averages.band.to]);
    entry["lines"] = json!(analysis.averages.lines);
    entry["std_fixture"] = pair(analysis.tolerance_of_averages());
    entry
}

/// K and C of the fixture as it stands, read as the lines are; `null` where no line of the band has them.
fn nominal(analysis: &Analysis) -> Value {
    let paper = analysis.spectrum.relation == Relation::Paper;
    let element = |part: Part, row: usize, column: usize| {
        analysis.nominal_average(part, Element { row, column }, paper)
    };
    let of = |part: Part| [0, 1].map(|row| [0, 1].map(|column| element(part, row, column)));
    json!({"stiffness": of(Part::Stiffness), "damping": of(Part::Damping)})
}

fn likelihood(analysis: &Analysis) -> Value {
    match &analysis.likelihood {
        Ok(fit) => json!({
            "stiffness": fit.stiffness,
            "damping": fit.damping,
            "std": pair((fit.stiffness_std, fit.damping_std)),
            "std_fixture": pair(analysis.tolerance_of_likelihood()),
            "std_model": pair(fit.model_std()),
            "chi2_per_dof": fit.chi2_per_dof,
            "relation": "exact",
        }),
        Err(error) => json!({"failed": error.to_string()}),
    }
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
