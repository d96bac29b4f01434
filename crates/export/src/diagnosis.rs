//! What a diagnosis found: the repaired fixture's joints, supports and effects, with what `diagnosis.json` says of their uncertainty.

use crate::numbering::Numbering;
use crate::numbers::short;
use crate::parts::{Element, Omitted, Part};
use crate::repaired_joint::{RepairedJoint, is_on};
use crate::{Export, ExportError, ExportOptions, Joint, JointEnd};
use jointscope_fixture::{Damping, Dof, Effect, EffectKind as Kind, Fixture, Place};
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Lines of K and C by frequency over the recording's band.
const LINES: usize = 201;
/// Abscissae that are one, m.
const SAME_PLACE: f64 = 1e-9;

/// What is read of a `diagnosis.json`.
#[derive(Deserialize)]
struct DiagnosisEntry {
    verdict: String,
    findings: Vec<FindingEntry>,
    #[serde(default)]
    unnamed: bool,
    #[serde(default)]
    recording: BandEntry,
    #[serde(default)]
    band: Option<(f64, f64)>,
}

#[derive(Default, Deserialize)]
struct BandEntry {
    #[serde(default)]
    from: Option<f64>,
    #[serde(default)]
    to: Option<f64>,
}

#[derive(Deserialize)]
struct FindingEntry {
    kind: String,
    place: String,
    #[serde(default)]
    dof: Option<String>,
    #[serde(default)]
    parameters: BTreeMap<String, ParameterEntry>,
    #[serde(default)]
    probability: Option<f64>,
}

#[derive(Deserialize)]
struct ParameterEntry {
    #[serde(default)]
    value: Option<f64>,
    #[serde(default)]
    std: Option<f64>,
}

/// A diagnosis as an export, of the contents of its `diagnosis.json` and its repaired fixture.
///
/// # Errors
/// A diagnosis that nothing explains, numbers that cannot be, nothing that could be exported.
pub fn of_diagnosis(
    diagnosis: &Value,
    repaired: &Fixture,
    options: &ExportOptions,
) -> Result<Export, ExportError> {
    let diagnosis = DiagnosisEntry::deserialize(diagnosis)
        .map_err(|error| ExportError::Diagnosis(error.to_string().replace('`', "")))?;
    if diagnosis.verdict == "unexplained" && !options.anyway {
        return Err(ExportError::Unexplained);
    }
    let mut exporter = Exporter {
        fixture: repaired,
        shifts: shifts(repaired),
        numbering: Numbering::from(options.first_id)?,
        numbers_are_the_models: options.nodes.is_some(),
        points: BTreeMap::new(),
        notes: vec![format!("verdict of the diagnosis: {}", diagnosis.verdict)],
        parts: Vec::new(),
        omitted: Vec::new(),
        band: diagnosis.band(),
        findings: &diagnosis.findings,
    };
    if diagnosis.unnamed && !diagnosis.findings.is_empty() {
        exporter.notes.push(
            "no finding is likelier than something that is not listed: what was found is a description, not a cause".to_owned(),
        );
    }
    let joints = exporter.joints(options)?;
    exporter.notes.extend(joints.iter().filter_map(Joint::indefinite));
    exporter.supports();
    repaired.physics().iter().for_each(|effect| exporter.effect(effect));
    exporter.findings_beside_effects();
    exporter.damping();
    if joints.is_empty() && exporter.parts.is_empty() {
        return Err(ExportError::Nothing);
    }
    let (nodes, first_id) = exporter.numbering.finish();
    Export {
        title: format!("the repaired fixture of a diagnosis, {}", repaired.name()),
        notes: exporter.notes,
        nodes,
        joints,
        parts: exporter.parts,
        not_exported: exporter.omitted,
        first_id,
    }
    .checked()
}

impl DiagnosisEntry {
    /// The recording's band, Hz.
    fn band(&self) -> Option<(f64, f64)> {
        let band = self.recording.from.zip(self.recording.to).or(self.band)?;
        let (from, to) = (band.0.max(1e-3 * band.1), band.1);
        (from > 0.0 && from < to).then_some((from, to))
    }
}

/// How far a longer joint moves the bodies beyond it, m, by body.
fn shifts(fixture: &Fixture) -> Vec<f64> {
    let mut shifts = vec![0.0; fixture.bodies().len()];
    let body = |point: usize| fixture.points()[point].body;
    for (index, joint) in fixture.joints().iter().enumerate() {
        let longer = |e: &&Effect| e.kind == Kind::JointLength && is_on(fixture, joint, e);
        let dx: f64 = fixture.physics().iter().filter(longer).map(|effect| effect.value(0)).sum();
        let mut beyond = vec![false; shifts.len()];
        beyond[body(joint.to)] = true;
        loop {
            let others = fixture.joints().iter().enumerate().filter(|(other, _)| *other != index);
            let reached = others.map(|(_, other)| (body(other.from), body(other.to)));
            let Some((a, b)) = reached.into_iter().find(|(a, b)| beyond[*a] != beyond[*b]) else { break };
            (beyond[a], beyond[b]) = (true, true);
        }
        shifts.iter_mut().zip(&beyond).filter(|(_, beyond)| **beyond).for_each(|(shift, _)| *shift += dx);
    }
    shifts
}

struct Exporter<'a> {
    fixture: &'a Fixture,
    shifts: Vec<f64>,
    numbering: Numbering,
    numbers_are_the_models: bool,
    /// Nodes of points by their index.
    points: BTreeMap<usize, u64>,
    notes: Vec<String>,
    parts: Vec<Part>,
    omitted: Vec<Omitted>,
    band: Option<(f64, f64)>,
    findings: &'a [FindingEntry],
}

impl Exporter<'_> {
    fn joints(&mut self, options: &ExportOptions) -> Result<Vec<Joint>, ExportError> {
        let fixture = self.fixture;
        let known = || fixture.joints().iter().map(|j| j.name.as_str()).collect::<Vec<_>>().join(", ");
        let chosen: Vec<_> = fixture
            .joints()
            .iter()
            .filter(|joint| options.joint.as_ref().is_none_or(|name| *name == joint.name))
            .collect();
        match (&options.joint, options.nodes) {
            (Some(name), _) if chosen.is_empty() => {
                return Err(ExportError::NoSuchJoint { name: name.clone(), known: known() });
            }
            (None, Some(_)) if chosen.is_empty() => return Err(ExportError::NoJoint),
            (None, Some(_)) if chosen.len() > 1 => return Err(ExportError::WhichJoint { known: known() }),
            _ => {}
        }
        if let (Some(nodes), [joint]) = (options.nodes, chosen.as_slice()) {
            for (point, number) in [joint.from, joint.to].into_iter().zip(nodes) {
                let (x, says) = (self.x_of(point), self.point_says(point));
                self.points.insert(point, self.numbering.existing(number, x, says)?);
            }
        }
        for joint in fixture.joints().iter().filter(|joint| !chosen.iter().any(|c| c.name == joint.name)) {
            let why = "another joint was chosen with --joint".to_owned();
            self.omitted.push(Omitted { what: format!("joint {} with its effects", joint.name), why });
        }
        chosen.into_iter().map(|joint| self.joint(joint, options.by_line)).collect()
    }

    fn joint(&mut self, joint: &jointscope_fixture::Joint, by_line: bool) -> Result<Joint, ExportError> {
        let element = RepairedJoint::new(self.fixture, joint)
            .map_err(|error| ExportError::Diagnosis(error.to_string()))?;
        let centre = self.band.map_or(1.0, |(from, to)| (from * to).sqrt());
        let matrices = element.matrices(centre).map_err(|error| ExportError::Diagnosis(error.to_string()))?;
        let on_it = self.fixture.physics().iter().filter(|effect| is_on(self.fixture, joint, effect));
        let on_it: Vec<String> = on_it.map(|effect| self.says(effect)).collect();
        let effects = match on_it.is_empty() {
            true => "no effects".to_owned(),
            false => on_it.join("; "),
        };
        if let Some(hz) = matrices.read_at {
            let note = depends_on_frequency(&joint.name, &element, hz, self.band);
            self.notes.push(note);
        }
        let lines = match (by_line, self.band) {
            (false, _) => Vec::new(),
            (true, None) => {
                return Err(ExportError::NoLines(
                    "diagnosis.json does not state the recording's band".into(),
                ));
            }
            (true, Some((from, to))) => {
                let step = (to - from) / (LINES - 1) as f64;
                element.lines((0..LINES).map(|i| from + step * i as f64))
            }
        };
        let rotates = |point: usize| self.fixture.bodies()[self.fixture.points()[point].body].kind.rotates();
        let scalar = !(rotates(joint.from) && rotates(joint.to));
        let cut = |[[a, b], [c, d]]: jointscope_comparison::Matrix| match scalar {
            true => [[a, 0.0], [0.0, 0.0]],
            false => [[a, b], [c, d]],
        };
        Ok(Joint {
            name: joint.name.clone(),
            says: format!("of the repaired fixture, with {effects}"),
            from: self.end(joint.from),
            to: self.end(joint.to),
            length: matrices.length,
            scalar,
            stiffness: cut(matrices.stiffness),
            damping: cut(matrices.damping),
            structural: cut(matrices.structural),
            mass: matrices.mass,
            std: None,
            covariance: None,
            lines,
        })
    }

    fn end(&mut self, point: usize) -> JointEnd {
        let node = self.node_of(point);
        let named = &self.fixture.points()[point];
        let body = self.fixture.bodies()[named.body].name.clone();
        JointEnd { point: named.name.clone(), body, x: self.x_of(point), node }
    }

    fn x_of(&self, point: usize) -> f64 {
        let point = &self.fixture.points()[point];
        point.x.value + self.shifts[point.body]
    }

    fn point_says(&self, point: usize) -> String {
        let point = &self.fixture.points()[point];
        format!("point {} of body {}", point.name, self.fixture.bodies()[point.body].name)
    }

    fn node_of(&mut self, point: usize) -> u64 {
        if let Some(node) = self.points.get(&point) {
            return *node;
        }
        let (x, says) = (self.x_of(point), self.point_says(point));
        // Beside nodes of the model, names of points are no numbers of its nodes.
        let node = match self.numbers_are_the_models {
            true => self.numbering.on_body(x, &says),
            false => self.numbering.point(&self.fixture.points()[point].name, x, &says),
        };
        self.points.insert(point, node);
        node
    }

    /// The node at an abscissa of a body: a point's where there is one.
    fn node_at(&mut self, body: usize, x: f64) -> u64 {
        let here =
            |point: &jointscope_fixture::Point| point.body == body && (point.x.value - x).abs() <= SAME_PLACE;
        if let Some(point) = self.fixture.points().iter().position(here) {
            return self.node_of(point);
        }
        let says = format!("on body {}", self.fixture.bodies()[body].name);
        self.numbering.on_body(x + self.shifts[body], &says)
    }

    fn supports(&mut self) {
        for support in self.fixture.supports() {
            let (body, x) = self.fixture.support_place(support);
            let node = self.node_at(body, x);
            let says = format!("support {} of the repaired fixture", support.name);
            let value = |q: &Option<jointscope_fixture::Quantity>| q.map_or(0.0, |q| q.value);
            let mut add = |dof: Dof, stiffness: f64, damping: f64| {
                if stiffness != 0.0 || damping != 0.0 {
                    let element = Element::Ground { node, dof, stiffness, damping };
                    self.parts.push(Part { says: says.clone(), element });
                }
            };
            add(Dof::Translation, support.stiffness.value, value(&support.damping));
            add(Dof::Rotation, value(&support.rotational_stiffness), value(&support.rotational_damping));
        }
    }

    /// An effect as a part, or why it is none; those of joints are in their matrices.
    fn effect(&mut self, effect: &Effect) {
        if self.fixture.joints().iter().any(|joint| is_on(self.fixture, joint, effect)) {
            return;
        }
        let says = self.says(effect);
        let value = |index: usize| effect.value(index);
        match (effect.kind, &effect.place) {
            (Kind::AddedMass, Place::Body(name)) => {
                let Some(body) = self.body(name) else { return };
                let node = self.node_at(body, value(0));
                self.parts.push(Part { says, element: Element::Mass { node, mass: value(1) } });
            }
            (Kind::Support, Place::Body(name)) => {
                let Some(body) = self.body(name) else { return };
                let dof = effect.dof.unwrap_or(Dof::Translation);
                let node = match dof {
                    Dof::Translation => self.node_at(body, value(0)),
                    Dof::Rotation => self.any_node_of(body),
                };
                let element = Element::Ground { node, dof, stiffness: value(1), damping: value(2) };
                self.parts.push(Part { says, element });
            }
            (Kind::AttachedResonator, Place::Body(name)) => {
                let Some(body) = self.body(name) else { return };
                let from = self.node_at(body, value(0));
                let (mass, omega, ratio) = (value(1), TAU * value(2), value(3));
                let on = format!("mass of the resonator on node {from}, moves along y only");
                let to = self.numbering.along_y(value(0) + self.shifts[body], on);
                let stiffness = mass * omega * omega;
                let damping = 2.0 * ratio * mass * omega;
                self.parts.push(Part {
                    says: format!("{says}: its mass"),
                    element: Element::Mass { node: to, mass },
                });
                let element = Element::Spring { from, to, stiffness, damping };
                self.parts.push(Part { says: format!("{says}: its spring and dashpot"), element });
            }
            (Kind::Bypass, Place::Between(one, other)) => {
                let (Some(one), Some(other)) = (self.body(one), self.body(other)) else { return };
                let (from, to) = (self.node_at(one, value(0)), self.node_at(other, value(1)));
                let element = Element::Spring { from, to, stiffness: value(2), damping: value(3) };
                self.parts.push(Part { says, element });
            }
            _ => self.omitted.push(Omitted { what: says, why: why_not(effect).to_owned() }),
        }
    }

    fn body(&self, name: &str) -> Option<usize> {
        self.fixture.bodies().iter().position(|body| body.name == *name)
    }

    /// Some node of a body that turns as one.
    fn any_node_of(&mut self, body: usize) -> u64 {
        match self.fixture.points().iter().position(|point| point.body == body) {
            Some(point) => self.node_of(point),
            None => self.node_at(body, 0.0),
        }
    }

    /// Findings that are no effects: quantities of the fixture that are wrong.
    fn findings_beside_effects(&mut self) {
        for finding in self.findings {
            let stands_for = |effect: &Effect| {
                finding.kind == effect.kind.name() && finding.place == effect.place.to_string()
            };
            if self.fixture.physics().iter().any(stands_for) {
                continue;
            }
            let value = finding.parameters.get("value").and_then(|parameter| parameter.value);
            let value = value.map_or(String::new(), |value| format!(" = {}", short(value)));
            self.omitted.push(Omitted {
                what: format!("{} of {}{value}", finding.kind.replace('_', " "), finding.place),
                why: "it is a quantity of your own model: correct it there; where it is a joint's or a support's, what is written here has it".to_owned(),
            });
        }
    }

    fn damping(&mut self) {
        let (what, why) = match self.fixture.damping() {
            Damping::Undamped => return,
            Damping::LossFactor(factor) if factor.value == 0.0 => return,
            Damping::ModalRatios { ratios, .. } => {
                let ratios: Vec<String> = ratios.iter().map(|ratio| short(ratio.value)).collect();
                (
                    format!("modal damping of the assembly, ratios {}", ratios.join(", ")),
                    "it belongs to no element: state it in the analysis (modal damping)",
                )
            }
            Damping::Rayleigh { mass, stiffness } => (
                format!(
                    "C = {} 1/s·M + {} s·K of bodies and joints",
                    short(mass.value),
                    short(stiffness.value)
                ),
                "it belongs to all elements: state it in the analysis (proportional damping)",
            ),
            Damping::LossFactor(factor) => (
                format!("loss factor {} of the bodies", short(factor.value)),
                "only the joints are exported, and they have it: give the bodies' material the same",
            ),
        };
        self.omitted.push(Omitted { what, why: why.to_owned() });
    }

    /// An effect with its size, uncertainty and probability, or that it was stated.
    fn says(&self, effect: &Effect) -> String {
        let dof = effect.dof.map(|dof| dof.name());
        let finding = self.findings.iter().find(|finding| {
            finding.kind == effect.kind.name()
                && finding.place == effect.place.to_string()
                && finding.dof.as_deref() == dof
        });
        let parameters = effect.kind.spec().parameters.iter().enumerate().map(|(index, spec)| {
            let std = finding.and_then(|finding| finding.parameters.get(spec.name)).and_then(|p| p.std);
            let std = std.map_or(String::new(), |std| format!(" ± {}", short(std)));
            format!("{} = {}{std} {}", spec.name, short(effect.value(index)), spec.unit_in(effect.dof))
                .trim_end()
                .to_owned()
        });
        let origin = match finding.map(|finding| finding.probability) {
            Some(Some(probability)) => format!("found, probability {probability:.2}"),
            Some(None) => "found".to_owned(),
            None => "stated in the fixture".to_owned(),
        };
        let kind = effect.kind.name().replace('_', " ");
        let dof = dof.map_or(String::new(), |dof| format!(", {dof}"));
        let parameters = parameters.collect::<Vec<_>>().join(", ");
        format!("{kind} of {}{dof} ({parameters}; {origin})", effect.place)
    }
}

/// Why an effect is no element.
fn why_not(effect: &Effect) -> &'static str {
    match effect.kind {
        Kind::BodyFlexibility => {
            "a meshed body bends by itself: check its first free bending frequency against this one"
        }
        Kind::ShearDeformation => "it belongs to the body's own elements: let them deform in shear",
        Kind::StiffnessChange => {
            "it belongs to the body's own elements: multiply their Young's modulus by the factor"
        }
        Kind::PointOffset => "a sensor or an impact sits elsewhere: move the node that you compare with",
        Kind::SensorMass => "the mass is there only while that response is measured",
        Kind::ChannelGain
        | Kind::ChannelDelay
        | Kind::ChannelHighpass
        | Kind::ChannelResonance
        | Kind::ExponentialWindow => "it is of the measuring chain, not of the structure",
        Kind::CubicStiffness | Kind::Friction | Kind::Gap => {
            "it depends on amplitude and has no constant matrix: model it as a nonlinear spring, a slider or a gap"
        }
        _ => "it has no counterpart",
    }
}

/// That a joint's matrices are those of one frequency, and how far k11 goes over the band.
fn depends_on_frequency(name: &str, element: &RepairedJoint, hz: f64, band: Option<(f64, f64)>) -> String {
    let mut note = format!(
        "joint {name} depends on frequency: K and C are those at {} Hz, the middle of the recording's band",
        short(hz)
    );
    if let Some((from, to)) = band {
        let ends = element.lines([from, to].into_iter());
        let k11 = [0, 1].map(|i| short(ends[i].stiffness[0][0]));
        let (from, to) = (short(from), short(to));
        note += &format!("; k11 goes from {} N/m at {from} Hz to {} N/m at {to} Hz", k11[0], k11[1]);
    }
    note
}
