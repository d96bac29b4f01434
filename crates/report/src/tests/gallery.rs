//! A page that shows every element of a report, with made-up data of a two-block fixture.
//!
//! `JOINTSCOPE_GALLERY=gallery.html cargo test -p jointscope-report gallery` writes it.

use std::f64::consts::PI;

use jointscope_fixture::Fixture;
use jointscope_samples::Noise;
use jointscope_spectra::FrfPair;

use super::drawing::{chain, frame, two_blocks};
use crate::drawing::{Drawing, Highlight, SideView};
use crate::format::{fixed, in_column};
use crate::input_file::InputFile;
use crate::page::Page;
use crate::plot::{Axis, Plot, Role, YRange};
use crate::section::{Card, Section, Verdict};
use crate::table::Table;
use crate::tone::Tone;
use crate::unit::Scale;

const STIFFNESS: f64 = 3.32e6;
const NOMINAL: f64 = 3.31e6;
const BAND: (f64, f64) = (474.0, 843.0);

#[test]
fn the_gallery_shows_every_element_of_a_page() {
    let html = gallery().to_html().expect("the page is well formed");
    for class in
        ["verdict attention", "cards", "table", "notes", "notes warnings", "command", "sketch", "legend"]
    {
        assert!(html.contains(&format!("class=\"{class}\"")), "{class}");
    }
    if let Ok(path) = std::env::var("JOINTSCOPE_GALLERY") {
        std::fs::write(path, html).expect("the page is written");
    }
}

fn gallery() -> Page {
    let input = |name: &str, sha256: &str| InputFile { name: name.to_owned(), sha256: sha256.to_owned() };
    Page::new("Joint J: stiffness and damping")
        .subtitle("two blocks and a beam · recordings of 5 hits at two points")
        .verdict(Verdict {
            tone: Tone::Attention,
            headline: "The joint is 0.3 % stiffer than the fixture file says, within its tolerance.".into(),
            details: vec!["The damping of the rotational terms is not determined: its standard deviation exceeds its value.".into()],
        })
        .sections([fixture(), result(), by_line(), frfs(), drawings()])
        .foot(
            "jointscope 0.1.0",
            "jointscope decompose rig.json hits.uff --joint J --band 474:843 -o out",
            &[input("rig.json", "5f0c…91aa"), input("hits </script>.uff", "c3ab…07d2")],
        )
}

fn fixture() -> Section {
    Section::new("Fixture").drawing(
        side_view(&two_blocks(), vec![]),
        "Side view with the measured responses (blue) and the points struck by the hammer (green).",
    )
}

fn side_view(fixture: &Fixture, highlights: Vec<Highlight>) -> Drawing {
    let joints = fixture.joints().iter().skip(1).take(1).map(|joint| joint.name.as_str()).collect();
    let frfs = ["3", "4"].map(|response| FrfPair::transverse(response, "1"));
    SideView { highlights, joints, ..SideView::new(fixture, &frfs) }.draw()
}

fn result() -> Section {
    let scale = Scale::for_values([STIFFNESS], "N/m");
    let rotational = Scale::for_values([1.1e5], "N/rad");
    Section::new("Result")
        .paragraph(
            "Averages over the band, weighted by the uncertainty of each line; ± is one standard deviation.",
        )
        .cards([
            Card::quantity("k₁₁, force per displacement", STIFFNESS, 1.2e4, "N/m").note("nominal 3.310 MN/m"),
            Card::quantity("k₁₂, force per rotation", -1.079e5, 410.0, "N/rad").note("nominal −107.6 kN/rad"),
            Card::quantity("k₂₂, moment per rotation", 4672.0, 21.0, "N*m/rad")
                .note("nominal 4.662 kN·m/rad"),
            Card::quantity("c₁₁", 1.48, 0.31, "N*s/m"),
            Card::quantity("c₂₂", f64::NAN, f64::NAN, "N*m*s/rad").tone(Some(Tone::Attention)),
            Card::text("Lines in use", "351 of 370").note("474 to 843 Hz"),
        ])
        .with(
            Table::of([
                ("exact", STIFFNESS, -1.079e5, "1.48 ± 0.31", "351"),
                ("paper", 3.291e6, -1.065e5, "not determined", "351"),
                ("nominal", NOMINAL, -1.076e5, "0.00", "–"),
            ])
            .words("Relation", |row| row.0)
            .numbers("k₁₁", scale.unit(), |row| in_column(row.1, 1.2e4, &scale))
            .numbers("k₁₂", rotational.unit(), |row| in_column(row.2, 410.0, &rotational))
            .numbers("c₁₁", "N*s/m", |row| row.3)
            .numbers("Lines", "", |row| row.4)
            .marked(|row| (row.0 == "paper").then_some(Tone::Attention))
            .footnote(format!("± one standard deviation from the scatter of {} hits", fixed(5.0, 0))),
        )
        .warnings(["Reference 2 has one average only: its noise is estimated from neighbouring lines."])
        .notes([
            "Lines at which the coherence is below 0.8 are masked.",
            "The line at 0 Hz has no displacement.",
        ])
        .command("jointscope decompose rig.json hits.uff --joint J --band 474:843 -o out")
}

/// Receptance of the elastic mode over the rigid body motion, 4/1.
fn receptance(frequency: f64) -> (f64, f64) {
    let omega = 2.0 * PI * frequency;
    let mode = |natural: f64, share: f64| {
        let natural = 2.0 * PI * natural;
        let (re, im) = (natural * natural - omega * omega, 2.0 * 0.003 * natural * omega);
        let norm = re * re + im * im;
        (share * re / norm, -share * im / norm)
    };
    let (a, b) = (mode(312.0, 0.7), mode(934.0, -0.4));
    (a.0 + b.0 - 0.45 / (omega * omega + 1.0), a.1 + b.1)
}

/// A reproducible number between −1 and 1, roughly bell-shaped.
fn bell(noise: &mut Noise) -> f64 {
    (0..4).map(|_| noise.uniform()).sum::<f64>() / 2.0 - 1.0
}

fn by_line() -> Section {
    let frequency: Vec<f64> = (0..6400).map(|line| 100.0 + 0.15625 * f64::from(line)).collect();
    let mut noise = Noise::from_state(1);
    let mut series = |level: f64, slope: f64, scatter: f64| {
        let (mut values, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new());
        for &f in &frequency {
            let wild = 1.0
                + 400.0 / (1.0 + ((f - 312.0) / 0.6).powi(2))
                + 60.0 / (1.0 + ((f - 934.0) / 1.5).powi(2));
            let std = scatter * (1.0 + (500.0 / f).powi(2)) * wild;
            let value = level + slope * f + 2.0 * std * bell(&mut noise);
            let masked = (610.0..622.0).contains(&f);
            values.push((!masked).then_some(value));
            low.push((!masked).then_some(value - 1.96 * std));
            high.push((!masked).then_some(value + 1.96 * std));
        }
        (values, low, high)
    };
    let (k, k_low, k_high) = series(STIFFNESS, 0.0, 2.4e4);
    let (c, c_low, c_high) = series(1.48, 0.0, 0.3);
    let stiffness = Plot::new("Transverse stiffness", Axis::frequency(), Axis::linear("k₁₁", "N/m"))
        .over(&frequency)
        .band("95 % interval", Role::Uncertainty, k_low, k_high)
        .line("by line", Role::Measured, k)
        .horizontal("average", Role::Estimate, STIFFNESS)
        .horizontal("nominal", Role::Nominal, NOMINAL)
        .shaded("averaging band", BAND.0, BAND.1)
        .y_range(YRange::Robust)
        .caption("The stiffness is level over the averaging band; near the resonance at 312 Hz the lines say little.");
    let damping = Plot::new("Transverse damping", Axis::frequency(), Axis::linear("c₁₁", "N*s/m"))
        .over(&frequency)
        .band("95 % interval", Role::Uncertainty, c_low, c_high)
        .line("by line", Role::Measured, c)
        .horizontal("average", Role::Estimate, 1.48)
        .shaded("averaging band", BAND.0, BAND.1)
        .y_range(YRange::Robust)
        .caption("The damping scatters about a constant.");
    Section::new("Stiffness and damping by line").plots(1, [stiffness, damping])
}

fn frfs() -> Section {
    let frequency: Vec<f64> = (1..=50_000).map(|line| 0.04 * f64::from(line)).collect();
    let mut noise = Noise::from_state(2);
    let mut plots = Vec::new();
    for (name, factor) in [("4/1", 1.0), ("3/1", 0.7), ("4/2", 0.8), ("3/2", 0.5)] {
        let model: Vec<f64> =
            frequency.iter().map(|f| receptance(*f)).map(|(re, im)| factor * re.hypot(im)).collect();
        let measured: Vec<f64> = model
            .iter()
            .map(|h| (h * (1.0 + 0.02 * bell(&mut noise)) + 4e-10 * bell(&mut noise)).abs())
            .collect();
        plots.push(
            Plot::new(
                format!("Receptance {name}"),
                Axis::logarithmic("Frequency", "Hz"),
                Axis::logarithmic("|H|", "m/N"),
            )
            .over(&frequency)
            .line("measured", Role::Measured, measured)
            .dashed("nominal", Role::Nominal, model)
            .vertical("natural frequency", Role::Estimate, 312.0)
            .line_limit(2_000)
            .height(220),
        );
    }
    let hits = [312.4, 311.9, 312.1, 311.7, 312.6];
    let steps = Plot::new("Natural frequency by hit", Axis::linear("Hit", ""), Axis::linear("f₁", "Hz"))
        .over([1.0, 2.0, 3.0, 4.0, 5.0])
        .line("running mean", Role::Estimate, [312.4, 312.15, 312.13, 312.03, 312.14])
        .points("each hit", Role::Highlight, hits)
        .over([1.5, 2.5, 3.5, 4.5])
        .points("half-way check", Role::Reference, [312.0, 312.1, 312.2, 312.1])
        .height(180);
    let phase = frequency.iter().map(|f| receptance(*f)).map(|(re, im)| im.atan2(re).to_degrees());
    let phase = Plot::new("Phase of 4/1", Axis::logarithmic("Frequency", "Hz"), Axis::linear("arg H", "°"))
        .over(&frequency)
        .line("nominal", Role::Nominal, phase)
        .line_limit(2_000)
        .height(180);
    Section::new("FRFs").plots(2, plots).plots(2, [phase, steps])
}

fn drawings() -> Section {
    let label = "rotational compliance at 3: 12.0 ± 0.3 kN·m/rad".into();
    Section::new("Other drawings")
        .drawing(
            side_view(&two_blocks(), vec![Highlight { x: 0.065, body: Some(1), label }]),
            "A finding pointed out.",
        )
        .drawing(side_view(&chain(), vec![]), "A chain of four bodies with supports.")
        .drawing(side_view(&frame(), vec![]), "A frame whose storeys lie above each other.")
}
