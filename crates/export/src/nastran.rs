//! Bulk data for Nastran: CBUSH about the elastic centre, or DMIG on both nodes; large fields of 16
//! characters.

use crate::Form;
use crate::body::Body;
use crate::joint::{CentreAgreement, about, is_zero};
use crate::matrices::{KINDS, Kind, Sparse};
use crate::numbers::{nastran as real, nastran_double, short};
use crate::parts::{Element, dof_number};
use crate::{Export, ExportError, Joint};

/// Shares of the length between which a bush lies on the line between its nodes.
const ON_THE_LINE: std::ops::RangeInclusive<f64> = 0.0..=1.0;
/// Grid points nearer than this have no line between them, m (CBUSH, remark 6).
const COINCIDENT: f64 = 1e-4;

pub(crate) fn body(export: &Export, form: Option<Form>) -> Result<Body, ExportError> {
    let mut text = String::new();
    let mut notes = Vec::new();
    for node in export.nodes.iter().filter(|node| !node.existing) {
        let held = if node.only_y { "13456" } else { "" };
        let fields = [&node.number.to_string(), "", &real(node.x), &real(node.y), &real(0.0), "", held, ""];
        text += &large("GRID", &fields);
    }
    let mut matrices = KINDS.map(|kind| (kind, Sparse::default()));
    let mut id = export.first_id;
    for joint in &export.joints {
        let bush = bush_of(joint, form)?;
        for (kind, sparse) in &mut matrices {
            // A bush has no mass of its own here.
            if let Some(matrix) = kind.of(joint).filter(|_| !bush || *kind == Kind::Mass) {
                sparse.add(joint, &matrix);
            }
        }
        if bush {
            text += &bush_cards(joint, &mut id, &mut notes)?;
        } else if form.is_none() {
            notes.push(format!(
                "joint {}: written as DMIG, for one CBUSH does not hold it: {}",
                joint.name,
                why_no_bush(joint)
            ));
        }
    }
    for part in &export.parts {
        text += &part_cards(&part.element, &mut id);
    }
    let mut selected = Vec::new();
    for (kind, sparse) in matrices.iter().filter(|(_, sparse)| !sparse.is_empty()) {
        let (name, command) = match kind {
            Kind::Stiffness => ("KJOINT", "K2GG"),
            Kind::Damping => ("BJOINT", "B2GG"),
            Kind::Structural => ("SJOINT", "K42GG"),
            Kind::Mass => ("MJOINT", "M2GG"),
        };
        selected.push(format!("{command} = {name}"));
        text += &dmig(name, sparse);
    }
    if !selected.is_empty() {
        notes.push(format!("the case control must select the matrices: {}", selected.join(", ")));
    }
    Ok(Body { text, notes })
}

/// Whether a joint is written as a bush.
fn bush_of(joint: &Joint, form: Option<Form>) -> Result<bool, ExportError> {
    let shares = joint.damping_centre().is_some_and(|centre| centre.agrees);
    let structural = joint.structural_centre().is_some_and(|centre| centre.agrees);
    let by_line = !joint.lines.is_empty();
    match form {
        Some(Form::Dmig) if by_line => Err(ExportError::DmigByLine),
        Some(Form::Dmig) => Ok(false),
        Some(Form::Bush) if joint.centre().is_some() && (shares && structural || by_line) => Ok(true),
        Some(_) if joint.centre().is_none() => Err(ExportError::NoCentre {
            joint: joint.name.clone(),
            matrix: "K",
            form: "no CBUSH holds it",
            remedy: "take `--form dmig`",
        }),
        Some(_) => Err(ExportError::Centres {
            joint: joint.name.clone(),
            matrix: if shares { "structural damping" } else { "C" },
        }),
        None if by_line && joint.centre().is_none() => Err(ExportError::NoCentre {
            joint: joint.name.clone(),
            matrix: "K",
            form: "no CBUSH holds it by line",
            remedy: "leave `--by-line` out",
        }),
        None => Ok(by_line || (shares && structural)),
    }
}

fn why_no_bush(joint: &Joint) -> &'static str {
    match joint.damping_centre() {
        None => "k11 is not positive",
        Some(centre) if !centre.agrees => "its damping acts about another centre than its stiffness",
        Some(_) => "its structural damping acts about another centre than its stiffness",
    }
}

fn bush_cards(joint: &Joint, id: &mut u64, notes: &mut Vec<String>) -> Result<String, ExportError> {
    let Some(centre) = joint.centre() else { return Ok(String::new()) };
    let element = next(id).to_string();
    let (from, to) = (joint.from.node.to_string(), joint.to.node.to_string());
    let place = place_of_centre(joint, centre.offset, notes);
    let mut text = large(
        "CBUSH",
        &[
            &element, &element, &from, &to, "", "", "", "0", &place[0], &place[1], &place[2], &place[3],
            &place[4],
        ],
    );
    let mut property = Vec::new();
    let mut row = |first: &str, flag: &str, y: String, theta: String| {
        let rest = ["", "", ""].map(str::to_owned);
        property.extend([first.to_owned(), flag.to_owned(), String::new(), y]);
        property.extend(rest);
        property.push(theta);
    };
    let turning = |value: f64| if joint.scalar { String::new() } else { real(value) };
    row(&element, "K", real(centre.translation), turning(centre.rotation));
    if !is_zero(&joint.damping) {
        let damping = about(&joint.damping, centre.offset);
        row("", "B", real(damping[0][0]), turning(damping[1][1]));
        neglected(joint, ("c12", "N*s/rad"), joint.damping_centre(), damping, notes);
    }
    // Tables by line hold all of the joint's losses.
    if !is_zero(&joint.structural) && joint.lines.is_empty() {
        let structural = about(&joint.structural, centre.offset);
        neglected(joint, ("h12", "N/rad"), joint.structural_centre(), structural, notes);
        let ratio = |part: f64, of: f64| if of == 0.0 { 0.0 } else { part / of };
        // With one field stated all others count as zero, so all are (PBUSH, remark 9).
        let [y, theta] =
            [ratio(structural[0][0], centre.translation), ratio(structural[1][1], centre.rotation)];
        let zero = real(0.0);
        property.extend([
            "".into(),
            "GE".into(),
            zero.clone(),
            real(y),
            zero.clone(),
            zero.clone(),
            zero,
            real(theta),
        ]);
    }
    let property: Vec<&str> = property.iter().map(String::as_str).collect();
    text += &large("PBUSH", &property);
    if !joint.lines.is_empty() {
        text += &tables(joint, centre.offset, &element, id, notes);
    }
    Ok(text)
}

/// Fields S, OCID, S1, S2 and S3: the elastic centre on the line between the nodes, or in basic coordinates.
fn place_of_centre(joint: &Joint, offset: f64, notes: &mut Vec<String>) -> [String; 5] {
    let share = 1.0 + offset / joint.length;
    let on_the_line = joint.length > COINCIDENT && ON_THE_LINE.contains(&share);
    if !on_the_line {
        notes.push(format!(
            "joint {}: its elastic centre does not lie between its nodes and is stated in basic coordinates (OCID 0): the nodes must lie where this header says",
            joint.name
        ));
    }
    match (on_the_line, joint.centre_x()) {
        (false, Some(x)) => ["".into(), "0".into(), real(x), real(0.0), real(0.0)],
        _ => [real(share), String::new(), String::new(), String::new(), String::new()],
    }
}

/// Says what a bush cannot hold, where it is not zero.
fn neglected(
    joint: &Joint,
    (what, unit): (&str, &str),
    centre: Option<CentreAgreement>,
    [[a, b], [_, d]]: [[f64; 2]; 2],
    notes: &mut Vec<String>,
) {
    if let Some(std) = centre.and_then(|centre| centre.std).filter(|_| b != 0.0) {
        let share = b.abs() / (a.abs() * d.abs()).sqrt();
        notes.push(format!(
            "joint {}: {what} about the elastic centre of K is {} +- {} {unit} ({} of the root of 11 times 22), taken as zero",
            joint.name,
            short(b),
            short(std),
            short(share)
        ));
    }
}

/// Tables of K and C by frequency about the fixed centre.
fn tables(joint: &Joint, offset: f64, property: &str, id: &mut u64, notes: &mut Vec<String>) -> String {
    let mut text = String::new();
    let mut numbers = Vec::new();
    let mut largest = [0.0_f64; 2];
    for (part, flag) in ["K", "B"].into_iter().enumerate() {
        for element in 0..if joint.scalar { 1 } else { 2 } {
            let number = next(id);
            numbers.push((flag, element, number));
            let mut fields = vec![number.to_string()];
            fields.extend(std::iter::repeat_n(String::new(), 7));
            for line in &joint.lines {
                let matrix = about(if part == 0 { &line.stiffness } else { &line.damping }, offset);
                let scale = (matrix[0][0].abs() * matrix[1][1].abs()).sqrt();
                if scale > 0.0 {
                    largest[part] = largest[part].max(matrix[0][1].abs() / scale);
                }
                fields.extend([real(line.frequency), real(matrix[element][element])]);
            }
            fields.push("ENDT".to_owned());
            let fields: Vec<&str> = fields.iter().map(String::as_str).collect();
            text += &large("TABLED1", &fields);
        }
    }
    let mut card = String::new();
    for (row, flag) in ["K", "B"].into_iter().enumerate() {
        let mut fields = [""; 8].map(str::to_owned);
        fields[0] = if row == 0 { property.to_owned() } else { String::new() };
        fields[1] = flag.to_owned();
        for (_, element, number) in numbers.iter().filter(|(of, ..)| *of == flag) {
            fields[3 + 4 * element] = number.to_string();
        }
        card += &small(if row == 0 { "PBUSHT" } else { "+" }, &fields);
    }
    notes.push(format!(
        "joint {}: K and C by frequency about the elastic centre of the constant K (PBUSHT); what couples y and theta there is taken as zero, at most {} of the root of the diagonal's product in K and {} in C. Nastran extrapolates the tables beyond {} to {} Hz",
        joint.name,
        short(largest[0]),
        short(largest[1]),
        short(joint.lines.first().map_or(0.0, |line| line.frequency)),
        short(joint.lines.last().map_or(0.0, |line| line.frequency)),
    ));
    card + &text
}

fn part_cards(element: &Element, id: &mut u64) -> String {
    match *element {
        Element::Mass { node, mass } => {
            large("CONM2", &[&next(id).to_string(), &node.to_string(), "0", &real(mass)])
        }
        Element::Ground { node, dof, stiffness, damping } => {
            let ends = [node.to_string(), dof_number(dof).to_string(), String::new(), String::new()];
            spring_and_dashpot(&ends, stiffness, damping, id)
        }
        Element::Spring { from, to, stiffness, damping } => {
            let ends = [from.to_string(), "2".into(), to.to_string(), "2".into()];
            spring_and_dashpot(&ends, stiffness, damping, id)
        }
    }
}

fn spring_and_dashpot(ends: &[String; 4], stiffness: f64, damping: f64, id: &mut u64) -> String {
    let mut text = String::new();
    for (name, value) in [("CELAS2", stiffness), ("CDAMP2", damping)] {
        if value != 0.0 {
            let [a, b, c, d] = ends.each_ref().map(String::as_str);
            text += &large(name, &[&next(id).to_string(), &real(value), a, b, c, d]);
        }
    }
    text
}

/// A symmetric matrix in double precision, its elements below the diagonal once.
fn dmig(name: &str, sparse: &Sparse) -> String {
    let mut text = small("DMIG", &[name, "0", "6", "2", "0"].map(str::to_owned));
    for ((node, dof), rows) in sparse.columns() {
        let mut fields = vec![name.to_owned(), node.to_string(), dof.to_string(), String::new()];
        for ((node, dof), value) in rows {
            fields.extend([node.to_string(), dof.to_string(), nastran_double(value), String::new()]);
        }
        let fields: Vec<&str> = fields.iter().map(String::as_str).collect();
        text += &large("DMIG", &fields);
    }
    text
}

fn next(id: &mut u64) -> u64 {
    *id += 1;
    *id - 1
}

/// An entry in large fields: a name of eight columns, four fields of sixteen a line, an even number of lines.
fn large(name: &str, fields: &[&str]) -> String {
    let mut text = String::new();
    let mut lines: Vec<&[&str]> = fields.chunks(4).collect();
    if lines.len() % 2 == 1 {
        lines.push(&[]);
    }
    for (index, line) in lines.into_iter().enumerate() {
        let name = if index == 0 { format!("{name}*") } else { "*".to_owned() };
        let line: String = line.iter().map(|field| format!("{field:<16}")).collect();
        text += format!("{name:<8}{line}").trim_end();
        text.push('\n');
    }
    text
}

/// An entry in small fields of eight columns.
fn small(name: &str, fields: &[String]) -> String {
    let line: String = fields.iter().map(|field| format!("{field:<8}")).collect();
    format!("{}\n", format!("{name:<8}{line}").trim_end())
}
