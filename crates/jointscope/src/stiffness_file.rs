use jointscope_decomposition::{
    Analysis, Compliance, Element, FoundJoint, InterfaceStiffness, JointFit, JointLine, JointsFit, LawFit,
    LawKind, MatrixAverage, Method, Part, Relation,
};
use jointscope_linalg::RealMatrix2;
use serde_json::{Map, Value, json};

/// The contents of `stiffness.json`: K and C by line, averages, the fitted joint and its interfaces, in SI units.
///
/// `std` is what the FRFs' noise leaves uncertain, `std_fixture` what the fixture's tolerances do, `std_model` what it
/// costs that a constant joint does not explain the FRFs.
pub fn stiffness_file(analysis: &Analysis) -> Value {
    let mut root = Map::new();
    let spectrum = &analysis.spectrum;
    root.insert("joint".into(), joint(analysis));
    root.insert("ends".into(), json!(analysis.ends));
    root.insert("relation".into(), json!(spectrum.relation.name()));
    root.insert("lines".into(), spectrum.solved.iter().map(|solved| line(analysis, solved)).collect());
    let frequencies = spectrum.h41.lines.hz();
    let masked =
        spectrum.masked.iter().map(|(i, why)| json!({"frequency": frequencies[*i], "why": why.why()}));
    root.insert("masked".into(), masked.collect());
    root.insert("average".into(), averages(analysis));
    if let Some(weighted) = &analysis.averages.weighted {
        root.insert("weighted_average".into(), average(weighted));
    }
    root.insert("maximum_likelihood".into(), likelihood(analysis));
    if let Some(interfaces) = &analysis.interfaces {
        root.insert(
            "interfaces".into(),
            json!({
                "rest_on": analysis.interfaces_rest_on().map(|(method, explains)| {
                    json!({"fit": method_name(method), "explains_the_frfs": explains})
                }),
                "translation_both": stiffness(&interfaces.translation, "N/m"),
                "rotation_from": stiffness(&interfaces.near_rotation, "N*m/rad"),
                "rotation_to": stiffness(&interfaces.far_rotation, "N*m/rad"),
                "scalar_11": stiffness(&interfaces.scalar[0], "N/m"),
                "scalar_22": stiffness(&interfaces.scalar[1], "N*m/rad"),
            }),
        );
    }
    root.insert("judgement".into(), json!(analysis.judgement));
    root.insert("nominal_stiffness".into(), matrix(&analysis.nominal_stiffness));
    root.insert("nominal".into(), nominal(analysis));
    root.insert("recording".into(), recording(analysis));
    Value::Object(root)
}

/// The contents of `stiffness.json` where several joints were found at once, or one in a loop: every joint as `joint` has it, and the covariance of all.
pub fn joints_file(joints: &JointsFit) -> Value {
    let of = |found: &FoundJoint| {
        let mut entry = fitted(&found.fit);
        entry["name"] = json!(found.name);
        entry["ends"] = json!(found.ends);
        entry["in_a_loop"] = json!(found.is_in_a_loop);
        entry["nominal_stiffness"] = matrix(&found.nominal);
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
    let (k, c) = fit.std();
    let mut entry = json!({
        "name": null,
        "stiffness": matrix(&fit.stiffness),
        "damping": matrix(&fit.damping),
        "std": pair(&k, &c),
        "covariance": fit.covariance,
        "chi2_per_dof": fit.chi2_per_dof,
        "model_error": {"inflation": fit.inflation, "strain": fit.strain, "covariance": fit.model_covariance},
        "on_the_boundary_of_passive": fit.is_on_the_boundary,
        "tests": fit.tests,
        "quantities": fit.quantities,
        "unmoved": fit.unmoved,
        "length": {"value": fit.length.value, "std": fit.length.variance.max(0.0).sqrt()},
        "law_covariance": fit.law_covariance,
        "frfs": fit.frfs.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "lines": fit.lines,
    });
    if let Some(likelihood) = &fit.likelihood {
        entry["likelihood"] = json!(likelihood);
    }
    if let Some((mass, std)) = fit.mass {
        entry["mass"] = json!({"value": mass, "std": std});
    }
    if let Some(admissible) = &fit.admissible {
        entry["admissible"] = json!(admissible);
    }
    if let Some(best) = fit.law() {
        entry["law"] = json!(best.name());
        entry["laws"] = fit.laws.iter().map(law).collect();
    }
    entry
}

fn law(law: &LawFit) -> Value {
    let mut parameters = json!({"stiffness": matrix(&law.stiffness)});
    let (damping, shape) = match law.kind {
        LawKind::Constant => (None, None),
        LawKind::Viscous | LawKind::LinearStiffness => (Some("damping"), None),
        LawKind::Structural => (Some("imaginary_stiffness"), None),
        LawKind::StandardLinearSolid => (Some("relaxing_stiffness"), Some("time")),
        LawKind::Fractional => (Some("springpot"), Some("exponent")),
    };
    if let Some(key) = damping {
        parameters[key] = matrix(&law.damping);
    }
    if let Some((key, value)) = shape.zip(law.shape) {
        parameters[key] = json!(value);
    }
    if let Some(change) = &law.change {
        parameters["stiffness_per_rad_per_s"] = matrix(change);
    }
    if let Some(mass) = law.mass {
        parameters["mass"] = json!(mass);
    }
    let (k, c) = law.in_the_middle();
    json!({
        "law": law.name(),
        "probability": law.probability,
        "parameters": parameters,
        "in_the_middle": pair(&k, &c),
    })
}

fn matrix(m: &RealMatrix2) -> Value {
    json!(m.0)
}

fn pair(k: &RealMatrix2, c: &RealMatrix2) -> Value {
    json!({"stiffness": matrix(k), "damping": matrix(c)})
}

fn line(analysis: &Analysis, line: &JointLine) -> Value {
    let mut entry = json!({
        "frequency": line.frequency,
        "stiffness": matrix(&line.stiffness),
        "damping": matrix(&line.damping),
        "condition": line.condition,
    });
    if let Some(h41) = analysis.spectrum.h41.values.get(line.line) {
        entry["h41"] = json!(h41.0.map(|row| row.map(|value| [value.re, value.im])));
    }
    if let (Some(k), Some(c)) = (&line.stiffness_std, &line.damping_std) {
        entry["std"] = pair(k, c);
        entry["noisy"] = json!(line.is_noisy());
    }
    entry
}

fn average(average: &MatrixAverage) -> Value {
    json!({
        "stiffness": matrix(&average.stiffness),
        "damping": matrix(&average.damping),
        "std": pair(&average.stiffness_std, &average.damping_std),
    })
}

fn averages(analysis: &Analysis) -> Value {
    let mut entry = average(&analysis.averages.plain);
    let (k, c) = analysis.tolerance_of_averages();
    entry["band"] = json!([analysis.averages.band.from, analysis.averages.band.to]);
    entry["lines"] = json!(analysis.averages.lines);
    entry["std_fixture"] = pair(&k, &c);
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
        Ok(fit) => {
            let (k, c) = analysis.tolerance_of_likelihood();
            let (k_model, c_model) = fit.model_std();
            json!({
                "stiffness": matrix(&fit.stiffness),
                "damping": matrix(&fit.damping),
                "std": pair(&fit.stiffness_std, &fit.damping_std),
                "std_fixture": pair(&k, &c),
                "std_model": pair(&k_model, &c_model),
                "chi2_per_dof": fit.chi2_per_dof,
                "relation": "exact",
            })
        }
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
    entry["compliance"] = json!({"value": compliance.value, "std": compliance.std});
    entry
}

fn recording(analysis: &Analysis) -> Value {
    let used: Vec<String> = analysis
        .plan
        .layout
        .channels
        .iter()
        .map(|(index, ..)| analysis.frfs.pairs()[*index].to_string())
        .collect();
    let unused: Vec<String> = analysis.plan.unused.iter().map(ToString::to_string).collect();
    let noise: Map<String, Value> = analysis
        .frfs
        .pairs()
        .iter()
        .zip(&analysis.noise)
        .map(|(pair, source)| (pair.to_string(), json!(source.says())))
        .collect();
    json!({
        "used": used,
        "unused": unused,
        "noise_from": noise,
        "reference_points": {"responding": analysis.plan.responding.2, "loaded": analysis.plan.loaded.2},
        "rigid_motion_chi2_per_dof": analysis.spectrum.h41.rigidity(),
        "noisy_lines": analysis.noisy_lines(),
        "tolerances_not_followed": analysis.lost_tolerances,
    })
}
