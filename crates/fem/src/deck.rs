//! The mesh for CalculiX or Abaqus, against which our modes are checked.

use crate::Mesh;
use std::fmt::Write;

/// The mesh as an input deck for CalculiX or Abaqus: its `modes` lowest frequencies, so that somebody else's
/// program can check ours.
pub fn calculix_deck(mesh: &Mesh, title: &str, modes: usize) -> String {
    let mut deck = String::with_capacity(120 * mesh.nodes.len());
    // Writing to a String does not fail.
    let _ = writeln!(deck, "*HEADING\n{}\n*NODE, NSET=ALL", title.replace(['\n', '\r'], " "));
    for (index, [x, y, z]) in mesh.nodes.iter().enumerate() {
        let _ = writeln!(deck, "{}, {x:.12e}, {y:.12e}, {z:.12e}", index + 1);
    }
    for material in 0..mesh.materials.len() {
        let members = || mesh.elements.iter().enumerate().filter(|(_, e)| e.material == material);
        if members().next().is_none() {
            continue;
        }
        let _ = writeln!(deck, "*ELEMENT, TYPE=C3D20, ELSET=SET{material}");
        for (index, element) in members() {
            let names: Vec<String> = element.nodes.iter().map(|node| (node + 1).to_string()).collect();
            let (first, second) = names.split_at(11);
            let _ = writeln!(deck, "{}, {},\n{}", index + 1, first.join(", "), second.join(", "));
        }
    }
    for (index, material) in mesh.materials.iter().enumerate() {
        if mesh.elements.iter().any(|e| e.material == index) {
            let _ = writeln!(
                deck,
                "*MATERIAL, NAME=MAT{index}\n*ELASTIC\n{:e}, {}\n*DENSITY\n{:e}\n*SOLID SECTION, ELSET=SET{index}, MATERIAL=MAT{index}",
                material.youngs_modulus, material.poisson_ratio, material.density
            );
        }
    }
    if !mesh.whole {
        let depth = mesh.nodes.iter().fold(0.0_f64, |m, n| m.max(n[2]));
        deck.push_str("*NSET, NSET=PLANE\n");
        for (index, _) in mesh.nodes.iter().enumerate().filter(|(_, n)| n[2].abs() <= 1e-9 * depth) {
            let _ = writeln!(deck, "{},", index + 1);
        }
        deck.push_str("*BOUNDARY\nPLANE, 3, 3\n");
    }
    let _ = writeln!(deck, "*STEP\n*FREQUENCY\n{modes}\n*NODE FILE\nU\n*END STEP");
    deck
}
