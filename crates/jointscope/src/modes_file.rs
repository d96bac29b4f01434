use jointscope_frf::noise::NoiseSource;
use jointscope_modes::{ModalAnalysis, Mode, Stability};
use jointscope_spectra::Channel;
use jointscope_wording::Remarks;
use num_complex::Complex64;
use serde_json::{Map, Value, json};

/// The contents of `modes.json`: modes with standard deviations, shapes and residues, residual terms, how well the rebuilt FRFs meet the measured ones, and the
/// stabilisation chart. SI units; complex numbers as `[real, imaginary]`; what is not told is `null`.
pub fn modes_file(analysis: &ModalAnalysis) -> Value {
    let mut root = Map::new();
    let names: Vec<String> = analysis.pairs().iter().map(ToString::to_string).collect();
    let modes = |modes: &[Mode]| modes.iter().map(|m| mode(m, &names)).collect::<Value>();
    root.insert("modes".into(), modes(&analysis.modes));
    root.insert("outside_the_band".into(), modes(&analysis.outside));
    let count = analysis.modes.len().max(1);
    root.insert("auto_mac".into(), analysis.auto_mac().chunks(count).map(|row| json!(row)).collect());
    root.insert("chi2_per_dof".into(), json!(analysis.chi2_per_dof));
    root.insert("explained".into(), json!(analysis.is_explained()));
    let hz = analysis.lines().hz();
    root.insert("lines".into(), json!({"from": hz[0], "to": hz[hz.len() - 1], "count": hz.len()}));
    root.insert("frfs".into(), frfs(analysis, &names));
    root.insert("stabilization".into(), stabilization(analysis));
    root.insert("remarks".into(), json!(analysis.remarks()));
    Value::Object(root)
}

fn complex(value: &Complex64) -> Value {
    json!([value.re, value.im])
}

fn mode(mode: &Mode, names: &[String]) -> Value {
    let shape = |shape: &[(Channel, Complex64)]| -> Value {
        shape
            .iter()
            .map(|(channel, v)| json!({"channel": channel.to_string(), "value": complex(v)}))
            .collect()
    };
    let residue = |((name, r), std): ((&String, &Complex64), &f64)| json!({"frf": name, "value": complex(r), "std": std});
    let drift = mode.drift.as_ref().map(|drift| {
        let of = |&(frf, f, f_std, z, z_std): &(usize, f64, f64, f64, f64)| {
            json!({"frf": names[frf], "frequency": f, "damping_ratio": z, "std": {"frequency": f_std, "damping_ratio": z_std}})
        };
        json!({
            "frequency": drift.frequency,
            "damping_ratio": drift.damping_ratio,
            "frfs": drift.by_frf.iter().map(of).collect::<Value>(),
        })
    });
    json!({
        "frequency": mode.frequency,
        "damping_ratio": mode.damping_ratio,
        "std": {"frequency": mode.frequency_std, "damping_ratio": mode.damping_std},
        "correlation": mode.correlation,
        "drift": drift,
        "pole": complex(&mode.pole),
        "shape": {"responses": shape(&mode.responses), "references": shape(&mode.references)},
        "modal_mass": mode.modal_mass,
        "phase_collinearity": mode.phase_collinearity,
        "stands_out": mode.stands_out(),
        "damping_is_vague": mode.is_vaguely_damped(),
        "residues": names.iter().zip(&mode.residues).zip(&mode.residue_std).map(residue).collect::<Value>(),
    })
}

fn frfs(analysis: &ModalAnalysis, names: &[String]) -> Value {
    let errors = analysis.relative_errors();
    let of = |(index, name): (usize, &String)| {
        let terms = &analysis.residual_terms[index];
        let noise = analysis.noise.get(index).map(|noise| match noise {
            NoiseSource::Coherence => "coherence",
            NoiseSource::CoherenceAlone => "coherence, averages by scatter",
            NoiseSource::Scatter => "scatter",
        });
        json!({
            "frf": name,
            "nrmse": errors[index],
            "noise": noise,
            "lower_residuals": terms.lower.iter().map(complex).collect::<Value>(),
            "upper_residuals": terms.upper.iter().map(complex).collect::<Value>(),
        })
    };
    names.iter().enumerate().map(of).collect()
}

fn stabilization(analysis: &ModalAnalysis) -> Value {
    let stability = |stability| match stability {
        Stability::New => "new",
        Stability::Frequency => "frequency",
        Stability::Stable => "stable",
    };
    let pole = |p: &jointscope_modes::ChartPole| {
        json!([p.order, p.frequency, p.damping_ratio, stability(p.stability)])
    };
    json!({
        "orders": [analysis.orders.0, analysis.orders.1],
        "columns": ["order", "frequency", "damping_ratio", "stability"],
        "poles": analysis.chart.iter().map(pole).collect::<Value>(),
    })
}
