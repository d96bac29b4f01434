//! Bodies that nothing joins.

use crate::Remark;
use jointscope_fixture::{Fixture, Place};

/// What is to be said of a fixture that is more than one structure: bodies that neither joints nor effects
/// join move independently of each other, and no FRF leads from one to the other.
pub(crate) fn apart(fixture: &Fixture) -> Option<Remark> {
    let parts = parts(fixture);
    if parts.len() < 2 {
        return None;
    }
    let held: Vec<usize> =
        fixture.supports().iter().map(|support| fixture.support_place(support).0).collect();
    let free = parts.iter().filter(|part| !part.iter().any(|body| held.contains(body))).count();
    let name = |body: &usize| fixture.bodies()[*body].name.as_str();
    let listed: Vec<String> =
        parts.iter().map(|part| part.iter().map(name).collect::<Vec<_>>().join(" with ")).collect();
    let alone: Vec<&Vec<usize>> = parts.iter().filter(|part| part.len() == 1).collect();
    let of = match alone[..] {
        [part] => format!("body {} hangs on nothing: ", name(&part[0])),
        _ => String::new(),
    };
    Some(Remark::odd(
        "joints",
        format!(
            "{of}nothing joins these {} parts, of which {free} {} free: {}; state the joint between them, or leave out what was not tested",
            parts.len(),
            if free == 1 { "is" } else { "are" },
            listed.join(", ")
        ),
    ))
}

/// The bodies by the part of the structure that they belong to, in the order of the file.
fn parts(fixture: &Fixture) -> Vec<Vec<usize>> {
    let bodies = fixture.bodies();
    let body = |name: &str| bodies.iter().position(|body| body.name == name);
    let points = fixture.points();
    let joints = fixture.joints().iter().map(|joint| (points[joint.from].body, points[joint.to].body));
    let effects = fixture.physics().iter().filter_map(|effect| match &effect.place {
        Place::Between(one, other) => body(one).zip(body(other)),
        _ => None,
    });
    let mut part: Vec<usize> = (0..bodies.len()).collect();
    for (one, other) in joints.chain(effects) {
        let (kept, gone) = (part[one].min(part[other]), part[one].max(part[other]));
        part.iter_mut().filter(|own| **own == gone).for_each(|own| *own = kept);
    }
    let of = |first: usize| (0..bodies.len()).filter(|body| part[*body] == first).collect::<Vec<_>>();
    (0..bodies.len()).map(of).filter(|bodies| !bodies.is_empty()).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn said(more: &str) -> Option<String> {
        let fixture = Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {{ "mass": 1, "inertia": 1e-3, "x_cg": -0.03 }}, "B": {{ "mass": 1, "inertia": 1e-3, "x_cg": 0.1 }}, "C": {{ "mass": 1, "inertia": 1e-3, "x_cg": 3 }} }},
              "points": {{ "1": {{ "body": "A", "x": 0 }}, "2": {{ "body": "B", "x": 0.07 }}, "3": {{ "body": "B", "x": 0.13 }}, "4": {{ "body": "C", "x": 2.9 }} }},
              "joints": {{ "J": {{ "from": "1", "to": "2", "stiffness": [[1e7, 0], [0, 1e4]] }}{more} }}"#
        ));
        apart(&fixture.unwrap()).map(|remark| remark.says)
    }

    #[test]
    fn bodies_that_nothing_joins_are_told_with_the_number_of_free_parts() {
        let says = said("}").unwrap();
        assert!(
            says.contains("body C hangs on nothing") && says.contains("2 are free: A with B, C"),
            "{says}"
        );
        let held = said(r#"}, "supports": { "S": { "point": "4", "stiffness": 10 } }"#).unwrap();
        assert!(held.contains("2 parts, of which 1 is free"), "{held}");
        assert_eq!(said(r#", "K": { "from": "3", "to": "4", "stiffness": [[1e7, 0], [0, 1e4]] } }"#), None);
    }
}
