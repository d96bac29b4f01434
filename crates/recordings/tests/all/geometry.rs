//! Nodes of the files in global axes and metres, and what files hold.

use crate::common::{frf, history, source};
use jointscope_recordings::{Contents, Geometry, GeometryError, PlacedNode, Source, SpatialAxis};
use jointscope_uff::{Axis, CoordinateSystem, GridPoint, Nodes, SystemKind, UffFile, Units};
use proptest::prelude::*;

fn node(label: i64, definition_system: i64, coordinates: [f64; 3]) -> GridPoint {
    GridPoint { label, definition_system, displacement_system: definition_system, coordinates }
}

/// Turned by `angle` about z, `shift` away.
fn turned(label: i64, reference: i64, angle: f64, shift: [f64; 3]) -> CoordinateSystem {
    let (s, c) = angle.sin_cos();
    let axes = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]];
    CoordinateSystem {
        label,
        name: "turned".into(),
        kind: SystemKind::Cartesian,
        reference,
        axes,
        origin: shift,
    }
}

fn file(nodes: Vec<GridPoint>, systems: Vec<CoordinateSystem>, units: Option<Units>) -> Source {
    let file = UffFile { nodes: vec![Nodes { nodes, units }], systems, ..UffFile::default() };
    Source { name: "mesh.uff".into(), file }
}

fn millimetres() -> Option<Units> {
    Some(Units { length_factor: 1000.0, force_factor: 1000.0, ..Units::si() })
}

/// The direction (±1 to ±3) of a node that points along a global axis to within five degrees.
fn direction_along(node: &PlacedNode, axis: usize) -> Option<i32> {
    let cosine = |direction: &[f64; 3]| direction[axis];
    let (number, direction) = (1..).zip(node.directions?).find(|(_, d)| cosine(d).abs() > 0.9962)?;
    Some(if cosine(&direction) > 0.0 { number } else { -number })
}

#[track_caller]
fn close(found: [f64; 3], expected: [f64; 3]) {
    let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-12, "expected {expected:?} m, got {found:?}");
}

#[test]
fn nodes_become_points_in_metres_along_an_axis() {
    let nodes =
        vec![node(7, 0, [150.0, 2.0, 0.0]), node(3, 0, [0.0, -1.0, 0.0]), node(5, 0, [60.0, -1.0, 0.0])];
    let geometry = Geometry::of(&[file(nodes, vec![], millimetres())], None).unwrap();
    let points = geometry.points_along(SpatialAxis::X);
    let found: Vec<_> = points.iter().map(|point| (point.node, point.x)).collect();
    assert_eq!(found, [(3, 0.0), (5, 0.06), (7, 0.15)]);
    assert!((points[2].off_line - 2e-3).abs() < 1e-12, "{points:?}");
    assert_eq!(geometry.longest_axis(), SpatialAxis::X);
    assert_eq!(direction_along(geometry.node(5).unwrap(), 1), Some(2));
}

#[test]
fn local_axes_are_turned_and_shifted_into_the_global_ones() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let systems = vec![turned(4, 0, quarter, [10.0, 0.0, 0.0]), turned(5, 4, quarter, [1.0, 0.0, 0.0])];
    let nodes = vec![node(1, 4, [3.0, 0.0, 0.0]), node(2, 5, [3.0, 0.0, 2.0])];
    let geometry = Geometry::of(&[file(nodes, systems, Some(Units::si()))], None).unwrap();
    // Local x of system 4 is global y.
    close(geometry.node(1).unwrap().position, [10.0, 3.0, 0.0]);
    assert_eq!(direction_along(geometry.node(1).unwrap(), 1), Some(1));
    assert_eq!(direction_along(geometry.node(1).unwrap(), 0), Some(-2));
    // System 5 stands one unit along it, turned by half a turn in all.
    close(geometry.node(2).unwrap().position, [7.0, 1.0, 2.0]);
    assert_eq!(direction_along(geometry.node(2).unwrap(), 0), Some(-1));
}

#[test]
fn what_cannot_be_placed_is_refused_with_its_node() {
    let refused = |source: Source, unit: Option<&str>, parts: &[&str]| {
        let message = Geometry::of(&[source], unit).unwrap_err().to_string();
        parts.iter().for_each(|part| assert!(message.contains(part), "`{part}` is missing from: {message}"));
    };
    let one = || vec![node(1, 9, [1.0, 0.0, 0.0])];
    let si = Some(Units::si());
    refused(file(one(), vec![], si.clone()), None, &["mesh.uff: node 1", "system 9", "datasets 18 and 2420"]);
    let round = CoordinateSystem { kind: SystemKind::Cylindrical, ..turned(9, 0, 0.0, [0.0; 3]) };
    refused(file(one(), vec![round], si.clone()), None, &["node 1", "cylindrical", "Cartesian"]);
    refused(file(one(), vec![turned(9, 9, 0.1, [1.0; 3])], si.clone()), None, &["system 9", "by itself"]);
    refused(file(vec![node(1, 0, [1.0; 3])], vec![], None), None, &["mesh.uff", "unit", "`mm`"]);
    refused(file(vec![node(1, 0, [1.0; 3])], vec![], None), Some("N"), &["`N` is no unit of length"]);
    let two = vec![node(1, 0, [1.0; 3]), node(1, 0, [2.0; 3])];
    refused(file(two, vec![], si), None, &["node 1 has two places"]);
    refused(source("frf.uff", vec![frf((4, 2), (1, 2))]), None, &["frf.uff: there are no nodes"]);
    let stated = Geometry::of(&[file(vec![node(1, 0, [1.0; 3])], vec![], None)], Some("mm")).unwrap();
    close(stated.node(1).unwrap().position, [1e-3; 3]);
}

proptest! {
    #[test]
    fn a_system_within_a_system_keeps_distances(
        angles in (-3.0..3.0_f64, -3.0..3.0_f64),
        a in prop::array::uniform3(-5.0..5.0_f64),
        b in prop::array::uniform3(-5.0..5.0_f64),
    ) {
        let systems = vec![turned(1, 0, angles.0, [1.0, -2.0, 3.0]), turned(2, 1, angles.1, [0.5, 0.0, -7.0])];
        let geometry = Geometry::of(&[file(vec![node(1, 2, a), node(2, 2, b)], systems, Some(Units::si()))], None).unwrap();
        let distance = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let global = distance(geometry.nodes[0].position, geometry.nodes[1].position);
        prop_assert!((global - distance(a, b)).abs() < 1e-9);
    }
}

#[test]
fn files_say_what_they_hold() {
    let mut mesh = file(
        (1..=1204).map(|label| node(label, 0, [label as f64, 0.0, 0.0])).collect(),
        vec![],
        millimetres(),
    );
    mesh.file.skipped.insert(2467, 2);
    let contents = Contents::of(&[mesh.clone()]);
    assert_eq!(contents.phrase(), "a geometry of 1,204 nodes, 2 datasets 2467 (groups)");
    let pressure = history(3, Axis::new(jointscope_uff::data_type::PRESSURE, "Sound", "Pa"));
    let recording = source("test.uff", vec![frf((4, 2), (1, 2)), frf((3, 2), (1, 2)), pressure]);
    let contents = Contents::of(&[recording, mesh]);
    assert_eq!(
        contents.phrase(),
        "1 time history (pressure), 2 FRFs (function type 4), a geometry of 1,204 nodes, 2 datasets 2467 (groups)"
    );
    let said = contents.says();
    let frfs = "2 FRFs of acceleration per excitation force in m/s^2 per N: 3 values from 10 to 15 Hz; channels 4:+y/1:+y, 3:+y/1:+y";
    assert!(said.iter().any(|line| line == frfs), "{said:#?}");
}

#[test]
fn geometries_of_many_programs_are_placed() {
    let folder =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/recordings/pyuff-data");
    if !folder.is_dir() {
        println!("skipped: no folder `shared/recordings/pyuff-data` beside the workspace");
        return;
    }
    let geometry = |name: &str, unit| {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        Geometry::of(&[Source { name: name.into(), file: jointscope_uff::read(&bytes).unwrap() }], unit)
    };
    let beam = geometry("2411 and 2414.uff", Some("m")).unwrap();
    let points = beam.points_along(SpatialAxis::X);
    assert_eq!((points.len(), points[0].x, points[440].x), (441, 0.0, 1.0));
    // Local displacement systems of Testlab (dataset 18) and NX (2420).
    let tower = geometry("TestLab 161 164 18 15 82.uff", None).unwrap();
    close(tower.node(1).unwrap().position, [-2.4, -0.95, 0.0]);
    assert_eq!(direction_along(tower.node(1).unwrap(), 0), Some(-1));
    let rod = geometry("NX simulation output.uff", None).unwrap();
    assert_eq!(rod.longest_axis(), SpatialAxis::Z);
    assert_eq!(direction_along(rod.node(3992).unwrap(), 0), Some(-2));
    assert!(geometry("mesh_Oros-modal_uff15_uff2412.uff", Some("mm")).is_ok());
    assert_eq!(
        geometry("mesh_Oros-modal_uff15_uff2412.uff", None),
        Err(GeometryError::NoUnit("mesh_Oros-modal_uff15_uff2412.uff".into()))
    );
}
