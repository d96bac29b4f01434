//! What stands at the top of every file: origin, units, axes, nodes, matrices with their uncertainty, what is
//! left out.

use crate::joint::is_zero;
use crate::numbers::short;
use crate::{Export, Joint};
use jointscope_comparison::Matrix;

/// Columns that a comment may take.
const WIDTH: usize = 100;

/// A file's comment: every line behind `mark`, in ASCII.
pub(crate) fn comment(mark: &str, export: &Export, made: &[String], notes: &[String]) -> String {
    let mut lines = Vec::new();

    lines.push(
        "SI units: m, kg, s, N, rad; stiffness N/m, N/rad, N*m/m, N*m/rad; damping the same times s"
            .to_owned(),
    );
    lines.push(
        "axes: x along the joint from its near to its far end, y transverse (dof 2), theta about z (dof 6), positive from x to y"
            .to_owned(),
    );
    lines.push("a joint acts on y and theta alone: what it does along x and z, and about x and y, was not measured and is not written".to_owned());
    lines.extend(export.nodes.iter().map(|node| {
        let where_from = if node.existing { "of your model, must lie" } else { "defined here" };
        let y =
            if node.y == 0.0 { "y = z = 0".to_owned() } else { format!("y = {} m, z = 0", short(node.y)) };
        format!("node {}: {}, {where_from} at x = {} m, {y}", node.number, node.says, short(node.x))
    }));
    export.joints.iter().for_each(|joint| lines.extend(of_joint(joint)));
    lines.extend(export.parts.iter().map(|part| format!("part: {}", part.says)));
    lines.extend(export.notes.iter().chain(notes).map(|note| format!("note: {note}")));
    lines.extend(
        export.not_exported.iter().map(|omitted| format!("not exported: {}; {}", omitted.what, omitted.why)),
    );
    // Hashes and commands are copied from here, so they stay on one line.
    let origin = std::iter::once(&export.title).chain(made).map(|line| format!("{mark}{}\n", ascii(line)));
    origin.chain(lines.iter().map(|line| wrapped(mark, &ascii(line)))).collect()
}

/// A joint's matrices and their uncertainty.
fn of_joint(joint: &Joint) -> Vec<String> {
    let mut lines = vec![
        format!("joint {}: {}", joint.name, joint.says),
        format!(
            "  matrices act on d = u_to - R u_from, u = (y, theta), R = [[1, L], [0, 1]], node {} to node {}, L = {} m",
            joint.from.node,
            joint.to.node,
            short(joint.length)
        ),
    ];
    let elements: &[(usize, usize)] = if joint.scalar { &[(0, 0)] } else { &[(0, 0), (0, 1), (1, 1)] };
    let stiffness_std = joint.std.map(|(k, _)| k);
    let damping_std = joint.std.map(|(_, c)| c);
    let structural_std = joint.structural_std();
    let rows: [(&str, &Matrix, Option<Matrix>, &str); 3] = [
        ("k", &joint.stiffness, stiffness_std, ""),
        ("c", &joint.damping, damping_std, "*s"),
        ("structural damping ", &joint.structural, structural_std, ""),
    ];
    for (symbol, matrix, std, times) in rows {
        let other = symbol == "c" && !is_zero(&joint.structural);
        if (symbol.len() > 1 || other) && is_zero(matrix) {
            continue;
        }
        let figure = |&(i, j): &(usize, usize)| {
            let std = std.map_or(String::new(), |std| format!(" +- {}", short(std[i][j])));
            let unit = ["N/m", "N/rad", "N*m/rad"][i + j].replacen('N', &format!("N{times}"), 1);
            format!("{symbol}{}{} = {}{std} {unit}", i + 1, j + 1, short(matrix[i][j]))
        };
        lines.push(format!("  {}", elements.iter().map(figure).collect::<Vec<_>>().join(", ")));
    }
    if let (false, Some(centre), Some(x)) = (joint.scalar, joint.centre(), joint.centre_x()) {
        let std = joint.centre_std().map_or(String::new(), |std| format!(" +- {}", short(std)));
        lines.push(format!(
            "  elastic centre at x = {}{std} m ({} m from the far end): {} N/m and {} N*m/rad there",
            short(x),
            short(centre.offset),
            short(centre.translation),
            short(centre.rotation)
        ));
    }
    lines
}

/// Comments of input decks are ASCII, and a name must not end one.
fn ascii(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '±' => plain.push_str("+-"),
            'θ' => plain.push_str("theta"),
            'ω' => plain.push_str("omega"),
            'χ' => plain.push_str("chi"),
            '²' => plain.push('2'),
            '·' | '×' => plain.push('*'),
            '−' | '–' => plain.push('-'),
            ' '..='~' => plain.push(character),
            c if c.is_whitespace() || c.is_control() => plain.push(' '),
            _ => plain.push('?'),
        }
    }
    plain
}

fn wrapped(mark: &str, line: &str) -> String {
    let indent: String = line.chars().take_while(|c| *c == ' ').collect();
    let mut text = String::new();
    let mut current = format!("{mark}{indent}");
    let mut empty = true;
    for word in line.split_whitespace() {
        if !empty && current.len() + 1 + word.len() > WIDTH {
            text += current.trim_end();
            text.push('\n');
            current = format!("{mark}{indent}   ");
            empty = true;
        }
        if !empty {
            current.push(' ');
        }
        current += word;
        empty = false;
    }
    text + current.trim_end() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_line_breaks_or_other_letters_stays_inside_its_comment() {
        let text = wrapped("$ ", &ascii("body A\nGRID,1 ± θ é"));
        assert_eq!(text, "$ body A GRID,1 +- theta ?\n");
    }

    #[test]
    fn long_lines_are_broken_and_every_piece_is_marked() {
        let text = wrapped("! ", &"word ".repeat(60));
        assert!(text.lines().count() > 2 && text.lines().all(|l| l.starts_with("! ") && l.len() <= WIDTH));
    }
}
