//! Two points that sit in each other's place.

use crate::diagnosis::Finding;
use jointscope_fixture::{EffectKind, Fixture, Place};

/// How close to the other point an offset must lead, as a share of the distance between the two.
const CLOSE: f64 = 0.1;

/// Sentences about pairs of points whose offsets exchange them: channels that were swapped.
pub(super) fn swapped(findings: &[Finding], fixture: &Fixture) -> Vec<String> {
    let moved: Vec<(&str, usize, f64, f64)> = findings
        .iter()
        .filter(|finding| finding.effect.kind == EffectKind::PointOffset)
        .filter_map(|finding| match &finding.effect.place {
            Place::Point(name) => {
                let point = fixture.point(name)?;
                let x = point.x.value;
                Some((name.as_str(), point.body, x, x + finding.effect.value(0)))
            }
            _ => None,
        })
        .collect();
    let mut said = Vec::new();
    for (index, a) in moved.iter().enumerate() {
        for b in &moved[index + 1..] {
            let near = |to: f64, at: f64| (to - at).abs() <= CLOSE * (a.2 - b.2).abs();
            if a.1 == b.1 && near(a.3, b.2) && near(b.3, a.2) {
                said.push(format!(
                    "Points {} and {} have each other's place: their channels are swapped, in the cables or in the node numbers of the file.",
                    a.0, b.0
                ));
            }
        }
    }
    said
}
