//! Readers of what is written, as the programs' manuals describe their cards: 4×4 matrices on (y, θ) of nodes
//! 2 and 3.

use crate::common::Matrix4;
use std::collections::BTreeMap;

/// Entries of a Nastran deck: name and fields from the second on, blank ones included.
pub(crate) fn entries(text: &str) -> Vec<(String, Vec<String>)> {
    let mut entries: Vec<(String, Vec<String>)> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('$')) {
        let (name, rest) = line.split_at(line.len().min(8));
        let large = name.contains('*');
        let width = if large { 16 } else { 8 };
        let count = if large { 4 } else { 8 };
        assert!(rest.len() <= width * count, "too long: {line}");
        let whole = width * count;
        let padded = format!("{rest:<whole$}");
        let fields = (0..count).map(|i| padded[i * width..(i + 1) * width].trim().to_owned());
        match name.trim().trim_end_matches('*').trim_start_matches('+') {
            "" => entries.last_mut().unwrap().1.extend(fields),
            name => entries.push((name.to_owned(), fields.collect())),
        }
    }
    entries
}

/// A real number of Nastran: 1.5+3, 1.5D-3.
pub(crate) fn real(field: &str) -> f64 {
    if field.is_empty() {
        return 0.0;
    }
    assert!(field.contains('.'), "{field} is an integer");
    let text = field.replace('D', "");
    match text[1..].rfind(['+', '-']) {
        Some(at) => format!("{}e{}", &text[..=at], &text[at + 1..]).parse().unwrap(),
        None => text.parse().unwrap(),
    }
}

/// Adds value·v·vᵀ.
fn add(matrix: &mut Matrix4, v: [f64; 4], value: f64) {
    for i in 0..4 {
        for j in 0..4 {
            matrix[i][j] += value * v[i] * v[j];
        }
    }
}

/// K and C of a bush at its place between GRIDs 2 and 3.
pub(crate) fn nastran_bush(text: &str) -> (Matrix4, Matrix4) {
    let entries = entries(text);
    let of = |name: &str| entries.iter().find(|(n, _)| n == name).map(|(_, fields)| fields).unwrap();
    let x = |node: &str| {
        let grid = entries.iter().find(|(n, fields)| n == "GRID" && fields[0] == node).unwrap();
        real(&grid.1[2])
    };
    let bush = of("CBUSH");
    assert_eq!((bush[2].as_str(), bush[3].as_str(), bush[7].as_str()), ("2", "3", "0"));
    let place = match bush[9].as_str() {
        "0" => real(&bush[10]),
        _ => x("2") + real(&bush[8]) * (x("3") - x("2")),
    };
    let (near, far) = (place - x("2"), place - x("3"));
    let (across, turn) = ([-1.0, -near, 1.0, far], [0.0, -1.0, 0.0, 1.0]);
    let property = of("PBUSH");
    let mut found = [[[0.0; 4]; 4]; 2];
    for row in property.chunks(8) {
        let part = match row[1].as_str() {
            "K" => 0,
            "B" => 1,
            _ => continue,
        };
        add(&mut found[part], across, real(&row[3]));
        add(&mut found[part], turn, real(&row[7]));
    }
    (found[0], found[1])
}

/// Where a coordinate of nodes 2 and 3 stands.
fn place(node: &str, dof: &str) -> usize {
    2 * usize::from(node.trim() == "3") + usize::from(dof.trim() == "6")
}

/// A symmetric DMIG matrix.
pub(crate) fn nastran_dmig(text: &str, name: &str) -> Matrix4 {
    let entries = entries(text);
    let of: Vec<_> = entries.iter().filter(|(n, f)| n == "DMIG" && f[0] == name).map(|(_, f)| f).collect();
    assert_eq!(of[0][1..4], ["0", "6", "2"], "header: symmetric, double precision");
    let mut matrix = [[0.0; 4]; 4];
    for column in &of[1..] {
        let j = place(&column[1], &column[2]);
        for row in column[4..].chunks(4).filter(|row| !row[0].is_empty()) {
            assert!(row[2].contains('D'), "{} is not in double precision", row[2]);
            let i = place(&row[0], &row[1]);
            assert_eq!(matrix[i][j], 0.0, "an element twice is an error");
            (matrix[i][j], matrix[j][i]) = (real(&row[2]), real(&row[2]));
        }
    }
    matrix
}

/// MATRIX27 elements by KEYOPT(3).
pub(crate) fn ansys(text: &str) -> BTreeMap<u8, Matrix4> {
    let mut found = BTreeMap::new();
    let (mut option, mut constants) = (0, Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split(',').collect();
        match words[0] {
            "KEYOPT" if words[2] == "3" => (option, constants) = (words[3].parse().unwrap(), Vec::new()),
            "R" => constants.extend(words[2..].iter().map(|w| w.parse::<f64>().unwrap())),
            "RMORE" => constants.extend(words[1..].iter().map(|w| w.parse::<f64>().unwrap())),
            "E" => {
                assert_eq!((words[1], words[2], constants.len()), ("2", "3", 78));
                let mut whole = [[0.0; 12]; 12];
                let mut next = constants.iter();
                for i in 0..12 {
                    for j in i..12 {
                        let value = *next.next().unwrap();
                        (whole[i][j], whole[j][i]) = (value, value);
                    }
                }
                // UY, ROTZ of I; UY, ROTZ of J.
                let at = [1, 5, 7, 11];
                found.insert(option, at.map(|i| at.map(|j| whole[i][j])));
                let elsewhere = whole.iter().flatten().filter(|e| **e != 0.0).count();
                assert_eq!(elsewhere, 16, "nothing acts on other degrees of freedom");
            }
            _ => {}
        }
    }
    found
}

/// Keyword blocks of Abaqus and CalculiX: the keyword line and its data lines.
pub(crate) fn blocks(text: &str) -> Vec<(String, Vec<Vec<String>>)> {
    let mut blocks: Vec<(String, Vec<Vec<String>>)> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with("**")) {
        match line.starts_with('*') {
            true => blocks.push((line.to_owned(), Vec::new())),
            false => {
                let fields: Vec<String> = line.split(',').map(|f| f.trim().to_owned()).collect();
                assert!(fields.iter().all(|field| field.len() <= 20), "{line}");
                blocks.last_mut().unwrap().1.push(fields);
            }
        }
    }
    blocks
}

/// Matrices of a linear user element by TYPE: column after column from the top to the diagonal.
pub(crate) fn abaqus_element(text: &str) -> BTreeMap<String, Matrix4> {
    let mut found = BTreeMap::new();
    for (keyword, data) in blocks(text) {
        let Some(kind) = keyword.strip_prefix("*MATRIX, TYPE=") else { continue };
        assert!(data.iter().all(|line| line.len() <= 4));
        let mut values = data.iter().flatten().map(|field| field.parse::<f64>().unwrap());
        let mut matrix = [[0.0; 4]; 4];
        for j in 0..4 {
            for i in 0..=j {
                let value = values.next().unwrap();
                (matrix[i][j], matrix[j][i]) = (value, value);
            }
        }
        assert_eq!(values.next(), None);
        found.insert(kind.to_owned(), matrix);
    }
    found
}

/// Matrices of *MATRIX INPUT by what *MATRIX ASSEMBLE makes of them.
pub(crate) fn abaqus_matrix(text: &str) -> BTreeMap<String, Matrix4> {
    let blocks = blocks(text);
    let assembled = blocks.iter().find_map(|(k, _)| k.strip_prefix("*MATRIX ASSEMBLE, ")).unwrap();
    let mut found = BTreeMap::new();
    for part in assembled.split(", ") {
        let (kind, name) = part.split_once('=').unwrap();
        let input = format!("*MATRIX INPUT, NAME={name}, TYPE=SYMMETRIC");
        let (_, data) = blocks.iter().find(|(keyword, _)| *keyword == input).unwrap();
        let mut matrix = [[0.0; 4]; 4];
        for line in data {
            let (i, j) = (place(&line[0], &line[1]), place(&line[2], &line[3]));
            let value = line[4].parse().unwrap();
            (matrix[i][j], matrix[j][i]) = (value, value);
        }
        found.insert(kind.to_owned(), matrix);
    }
    found
}

/// K and C of springs and dashpots on motions that equations make; rotations are nodes of their own, named in
/// the notes.
pub(crate) fn calculix(text: &str) -> (Matrix4, Matrix4) {
    let comment: String = text.lines().filter_map(|l| l.strip_prefix("**")).collect::<Vec<_>>().join(" ");
    let words: Vec<&str> = comment.split_whitespace().collect();
    let rotation = |node: &str| {
        let found =
            words.windows(7).find(|w| w[1..6] == ["holds", "the", "rotation", "at", "node"] && w[6] == node);
        found.unwrap()[0].to_owned()
    };
    let index = [("2".to_owned(), "2"), (rotation("2"), "3"), ("3".to_owned(), "2"), (rotation("3"), "3")];
    let mut motions: BTreeMap<String, [f64; 4]> = BTreeMap::new();
    let mut found = [[[0.0; 4]; 4]; 2];
    let mut ends = Vec::new();
    for (keyword, data) in blocks(text) {
        if keyword == "*EQUATION" {
            let terms: Vec<&String> = data[1..].iter().flatten().collect();
            assert_eq!(terms.len(), 3 * data[0][0].parse::<usize>().unwrap());
            assert_eq!((terms[1].as_str(), terms[2].parse()), ("1", Ok(1.0)));
            let mut motion = [0.0; 4];
            for term in terms[3..].chunks(3) {
                let at = index.iter().position(|(n, dof)| n == term[0] && dof == term[1]).unwrap();
                motion[at] -= term[2].parse::<f64>().unwrap();
            }
            motions.insert(terms[0].clone(), motion);
        } else if keyword.starts_with("*ELEMENT") {
            ends.clone_from(&data[0]);
        } else if keyword.starts_with("*SPRING") || keyword.starts_with("*DASHPOT") {
            assert!(data[0][0].contains('.'), "without a point it is a degree of freedom");
            add(
                &mut found[usize::from(keyword.starts_with("*DASHPOT"))],
                motions[&ends[1]],
                data[0][0].parse().unwrap(),
            );
        }
    }
    (found[0], found[1])
}

/// A 4×4 matrix of a table.
pub(crate) fn csv(text: &str, quantity: &str) -> Matrix4 {
    let order = ["y from", "theta from", "y to", "theta to"];
    let mut matrix = [[f64::NAN; 4]; 4];
    for line in text.lines().filter(|l| !l.starts_with('#')) {
        let Some(rest) = line.strip_prefix(&format!("joint,J,\"{quantity}\",,")) else { continue };
        let fields: Vec<&str> = rest.split(',').collect();
        let at = |name: &str| order.iter().position(|o| *o == name).unwrap();
        matrix[at(fields[0])][at(fields[1])] = fields[2].parse().unwrap();
    }
    matrix
}
