//! The joint's interfaces over the spectral lines (eq 6), beside the single numbers.

use jointscope_decomposition::{
    Compliance, DynamicStiffnessPart, InterfaceLine, InterfaceSpectrum, InterfaceStiffness, LineInterface,
};
use jointscope_inference::Z95;

use super::subject::Subject;
use crate::format::{magnitude, significant};
use crate::plot::{AVERAGING_BAND, Axis, Plot, Role, YRange};
use crate::section::Section;

/// Nothing for a joint that is no beam, and for blocks that do not rotate.
pub(super) fn section(subject: &Subject) -> Option<Section> {
    let found = subject.analysis.interface_spectrum.as_ref()?;
    let ends = Ends::of(subject)?;
    let inertia = match found.mass {
        0.0 => String::new(),
        mass => format!(
            " The inertia of the joint's own mass, {} as found from all FRFs, is taken out.",
            magnitude(mass, "kg", 3)
        ),
    };
    let section = Section::new("Interfaces by line").paragraph(format!(
        "D(ω) = k⁻¹ − k_E⁻¹ on each line, each interface seen through its own R: one complex compliance of both translations together and one of the rotation at either end, by \
         least squares, D having one element more than these. One over a compliance is a spring with a dashpot beside it, K + iωC.{inertia} Bands are 95 % intervals, the dark one from noise and the \
         light one from tolerances as well, the beam's own EI and length included; what tolerances do is alike on neighbouring lines. The beam is taken as without losses: those that it has count as the interfaces'."
    ));
    let told = ends.told(found);
    let springs = told.iter().flat_map(|end| {
        [DynamicStiffnessPart::Stiffness, DynamicStiffnessPart::Damping]
            .map(|part| spring_plot(subject, found, part, end))
    });
    let compliances = ends.all().into_iter().flat_map(|end| {
        [("Real part", true), ("Imaginary part", false)]
            .map(|(word, real)| compliance_plot(subject, found, word, real, end))
    });
    Some(
        section
            .paragraph(what_lines_tell(subject, found, &ends))
            .warnings(warnings(found, &ends))
            .plots(2, springs)
            .paragraph(
                "The compliances themselves, which every solved line has: where a band holds zero, the line does not tell the interface from a rigid one.",
            )
            .plots(2, compliances),
    )
}

/// An interface: what it is called, its place among those of a line, and the number that the fit gives.
struct End {
    name: String,
    of: usize,
    at_rest: Option<Compliance>,
    is_rotation: bool,
}

struct Ends([End; 3]);

impl Ends {
    fn of(subject: &Subject) -> Option<Self> {
        let joint = subject.joint()?;
        let point = |point: usize| subject.fixture.points().get(point).map_or("", |p| p.name.as_str());
        let (near, far) = (point(joint.from), point(joint.to));
        let at_rest = subject.analysis.interfaces.as_ref();
        Some(Ends([
            End {
                name: format!("translation at {near} and {far}"),
                of: 0,
                at_rest: at_rest.map(|of| of.translation),
                is_rotation: false,
            },
            End {
                name: format!("rotation at {near}"),
                of: 1,
                at_rest: at_rest.map(|of| of.near_rotation),
                is_rotation: true,
            },
            End {
                name: format!("rotation at {far}"),
                of: 2,
                at_rest: at_rest.map(|of| of.far_rotation),
                is_rotation: true,
            },
        ]))
    }

    fn all(&self) -> [&End; 3] {
        self.0.each_ref()
    }

    /// Those of which a line tells a stiffness.
    fn told(&self, found: &InterfaceSpectrum) -> Vec<&End> {
        self.0.iter().filter(|end| end.told(found) > 0).collect()
    }
}

impl End {
    fn on<'a>(&self, line: &'a InterfaceLine) -> &'a LineInterface {
        line.all()[self.of]
    }

    fn told(&self, found: &InterfaceSpectrum) -> usize {
        found.lines.len() - found.within_noise()[self.of]
    }
}

/// How many lines tell what, and why the others do not.
fn what_lines_tell(subject: &Subject, found: &InterfaceSpectrum, ends: &Ends) -> String {
    let all = subject.analysis.spectrum.h41.lines.len();
    let reasons = found.masked_summary();
    let reasons: Vec<String> =
        reasons.iter().map(|(mask, count)| format!("{} ({count})", mask.why())).collect();
    let masked = match reasons.is_empty() {
        true => String::new(),
        false => format!("; the others are masked: {}", reasons.join(", ")),
    };
    let told: Vec<String> =
        ends.all().iter().map(|end| format!("{} on {}", end.name, end.told(found))).collect();
    let check = found.asymmetry().map_or(String::new(), |chi2| {
        format!(
            " D₁₂ and D₂₁, which reciprocity makes equal, differ by χ² = {} per degree of freedom.",
            significant(chi2, 3)
        )
    });
    format!(
        "{} of {all} lines have a D{masked}. A stiffness is told where the real part of a compliance is known to a fifth: {}. The other lines say nothing of a \
         stiffness: there the compliance is within its noise and tolerances.{check}",
        found.lines.len(),
        told.join(", ")
    )
}

fn warnings(found: &InterfaceSpectrum, ends: &Ends) -> Vec<String> {
    let mut all = Vec::new();
    let silent: Vec<&str> =
        ends.all().into_iter().filter(|end| end.told(found) == 0).map(|end| end.name.as_str()).collect();
    if !silent.is_empty() {
        all.push(format!("No line by itself tells a stiffness of: {}.", silent.join(", ")));
    }
    if found.asymmetry().is_some_and(|chi2| chi2 > NOT_RECIPROCAL) {
        all.push(
            "D₁₂ and D₂₁ differ by more than noise: what the fixture states of blocks, places or channels is not exact to the noise of these lines, or the joint has what no beam with \
             springs at its ends has. Intervals are then too narrow."
                .to_owned(),
        );
    }
    let stiffer = ends.all().into_iter().filter(|end| {
        let lines = found.lines.iter().filter_map(|line| end.on(line).spring);
        let (count, negative) =
            lines.fold((0, 0), |(all, below), spring| (all + 1, below + usize::from(spring.stiffness < 0.0)));
        2 * negative > count
    });
    let stiffer: Vec<&str> = stiffer.map(|end| end.name.as_str()).collect();
    if !stiffer.is_empty() {
        all.push(format!(
            "On most lines that tell it the stiffness is negative: {}. The joint is stiffer there than the beam it is said to be.",
            stiffer.join(", ")
        ));
    }
    all
}

/// χ² per degree of freedom of D12 = D21 above which noise does not explain their difference.
const NOT_RECIPROCAL: f64 = 2.0;

fn spring_plot(subject: &Subject, found: &InterfaceSpectrum, part: DynamicStiffnessPart, end: &End) -> Plot {
    let unit = match (part, end.is_rotation) {
        (DynamicStiffnessPart::Stiffness, false) => "N/m",
        (DynamicStiffnessPart::Stiffness, true) => "N*m/rad",
        (DynamicStiffnessPart::Damping, false) => "N*s/m",
        (DynamicStiffnessPart::Damping, true) => "N*m*s/rad",
    };
    let symbol = part.of(("K", "C"));
    let columns = Columns::of(subject, found, |line| {
        let spring = end.on(line).spring?;
        Some(Known {
            value: part.of((spring.stiffness, spring.damping)),
            noise: spring.std.map(|std| part.of(std)),
            both: spring.std_of_both().map(|std| part.of(std)),
        })
    });
    let hz = subject.analysis.spectrum.h41.lines.hz();
    let law: Vec<Option<f64>> = (0..hz.len())
        .map(|line| subject.analysis.fitted_interfaces_at(line).map(|all| part.of(all[end.of])))
        .collect();
    let title = format!("{symbol}, {}", end.name);
    let mut plot =
        columns.drawn(Plot::new(title.clone(), Axis::frequency(), Axis::linear(symbol, unit)).over(hz));
    if law.iter().any(Option::is_some) {
        plot = plot.line("law from all FRFs", Role::Estimate, law);
    }
    if let (DynamicStiffnessPart::Stiffness, Some(InterfaceStiffness::Found { stiffness, .. })) =
        (part, end.at_rest.map(|compliance| compliance.stiffness()))
    {
        plot = plot.horizontal("at rest, as tabled", Role::Reference, stiffness);
    }
    let caption = format!("{title}: a constant interface would be level.");
    finish(subject, plot, found.masked.len() + found.within_noise()[end.of], caption)
}

fn compliance_plot(subject: &Subject, found: &InterfaceSpectrum, word: &str, real: bool, end: &End) -> Plot {
    let unit = if end.is_rotation { "rad/(N*m)" } else { "m/N" };
    let columns = Columns::of(subject, found, |line| {
        let compliance = end.on(line).compliance;
        let (value, both) = (compliance.value, compliance.std_of_both());
        Some(match real {
            true => Known { value: value.re, noise: compliance.std, both: both.map(|[re, _]| re) },
            false => Known { value: value.im, noise: compliance.std, both: both.map(|[_, im]| im) },
        })
    });
    let title = format!("{word} of the compliance, {}", end.name);
    let symbol = if real { "Re" } else { "Im" };
    let mut plot = columns.drawn(
        Plot::new(title.clone(), Axis::frequency(), Axis::linear(symbol, unit))
            .over(subject.analysis.spectrum.h41.lines.hz()),
    );
    if let Some(at_rest) = end.at_rest.filter(|_| real) {
        plot = plot.horizontal("at rest, as tabled", Role::Reference, at_rest.value);
    }
    finish(subject, plot.horizontal("rigid", Role::Nominal, 0.0), found.masked.len(), format!("{title}."))
}

fn finish(subject: &Subject, plot: Plot, masked: usize, caption: String) -> Plot {
    let band = subject.analysis.averages.band;
    plot.shaded(AVERAGING_BAND, band.from, band.to).y_range(YRange::Robust).masked(masked).caption(caption)
}

/// A value with its standard deviations by noise, and by noise and tolerances together.
struct Known {
    value: f64,
    noise: Option<f64>,
    both: Option<f64>,
}

/// Values over all lines of the recording with their 95 % intervals; gaps where a line tells nothing.
struct Columns {
    values: Vec<Option<f64>>,
    noise: [Vec<Option<f64>>; 2],
    both: [Vec<Option<f64>>; 2],
}

impl Columns {
    fn of(
        subject: &Subject,
        found: &InterfaceSpectrum,
        known: impl Fn(&InterfaceLine) -> Option<Known>,
    ) -> Self {
        let empty = || vec![None; subject.analysis.spectrum.h41.lines.len()];
        let mut columns = Columns { values: empty(), noise: [empty(), empty()], both: [empty(), empty()] };
        for line in &found.lines {
            let Some(Known { value, noise, both }) = known(line) else { continue };
            columns.values[line.line] = Some(value);
            for (band, std) in [(&mut columns.noise, noise), (&mut columns.both, both)] {
                band[0][line.line] = std.map(|std| value - Z95 * std);
                band[1][line.line] = std.map(|std| value + Z95 * std);
            }
        }
        columns
    }

    /// Points, since neighbours of a line that tells something may not.
    fn drawn(self, plot: Plot) -> Plot {
        // Without tolerances both bands are one.
        let apart = self.noise != self.both;
        let bands = [("95 %, noise and tolerances", self.both, apart), ("95 %, noise", self.noise, true)];
        let drawn =
            bands.into_iter().filter(|(_, [low, _], wanted)| *wanted && low.iter().any(Option::is_some));
        drawn
            .fold(plot, |plot, (label, [low, high], _)| plot.band(label, Role::Uncertainty, low, high))
            .points("by line", Role::Measured, self.values)
    }
}
