//! The side view of a fixture: what is drawn, and that labels keep clear of each other.

#![allow(clippy::expect_used)] // a test that cannot read its page has failed

use jointscope_report::drawing::{
    Body, Channel, ChannelKind, FixtureDrawing, Highlight, Joint, Point, Support,
};

fn two_blocks() -> FixtureDrawing {
    FixtureDrawing {
        bodies: vec![Body::block("A", -0.060, 0.0), Body::block("B", 0.065, 0.125)],
        points: [("1", -0.060, 0), ("2", 0.0, 0), ("3", 0.065, 1), ("4", 0.125, 1)]
            .map(|(name, x, body)| Point::new(name, x, body))
            .to_vec(),
        joints: vec![Joint::beam("J", 1, 2)],
        channels: (0..4)
            .flat_map(|point| {
                [ChannelKind::Response, ChannelKind::Reference].map(|kind| Channel { point, kind })
            })
            .collect(),
        ..FixtureDrawing::default()
    }
}

/// Four bodies in a row, eight points, three joints, a support under each body.
fn chain() -> FixtureDrawing {
    let bodies: Vec<Body> = (0..4)
        .map(|i| Body::block(format!("block {i}"), 0.1 * f64::from(i), 0.1 * f64::from(i) + 0.07))
        .collect();
    FixtureDrawing {
        points: (bodies.iter().enumerate())
            .flat_map(|(i, body)| {
                [(2 * i + 1, body.from), (2 * i + 2, body.to)]
                    .map(|(name, x)| Point::new(name.to_string(), x, i))
            })
            .collect(),
        joints: (0..3).map(|i| Joint::spring(format!("J{i}"), 2 * i + 1, 2 * i + 2)).collect(),
        supports: (0..4).map(|body| Support { x: 0.1 * body as f64 + 0.03, body }).collect(),
        channels: (0..8).map(|point| Channel { point, kind: ChannelKind::Response }).collect(),
        bodies,
        ..FixtureDrawing::default()
    }
}

/// Texts with centre and baseline, read from the markup.
fn texts(svg: &str) -> Vec<(String, f64, f64)> {
    svg.split("<g transform=\"translate(")
        .skip(1)
        .map(|rest| {
            let (place, rest) = rest.split_once(')').expect("a place");
            let (x, y) = place.split_once(' ').expect("two numbers");
            let text = rest.split_once("\">").expect("attributes end").1;
            let text = text.split_once("<text").expect("a text").1.split_once('>').expect("attributes").1;
            let text = text.split_once('<').expect("an end tag").0;
            (text.to_owned(), x.parse().expect("x"), y.parse().expect("y"))
        })
        .collect()
}

fn check_labels_keep_clear(drawing: &FixtureDrawing) {
    let svg = drawing.to_svg();
    let texts = texts(svg.as_str());
    for (i, (a, ax, ay)) in texts.iter().enumerate() {
        let width = |text: &str| 6.4 * text.chars().count() as f64;
        assert!(
            ax - 0.5 * width(a) > -3.0 && ax + 0.5 * width(a) < 863.0,
            "'{a}' leaves the drawing at {ax}"
        );
        for (b, bx, by) in &texts[i + 1..] {
            let meet = (ax - bx).abs() < 0.5 * (width(a) + width(b)) && (ay - by).abs() < 11.0;
            assert!(!meet, "'{a}' at ({ax}, {ay}) meets '{b}' at ({bx}, {by})");
        }
    }
}

#[test]
fn the_labels_of_two_blocks_with_four_points_keep_clear_of_each_other() {
    check_labels_keep_clear(&two_blocks());
}

#[test]
fn the_labels_of_a_chain_of_four_bodies_keep_clear_of_each_other() {
    check_labels_keep_clear(&chain());
}

#[test]
fn a_long_highlight_stays_within_the_drawing() {
    let mut drawing = two_blocks();
    let label = "rotational compliance of the interface at 4: 12.0 ± 0.3 kN·m/rad".to_owned();
    drawing.highlights.push(Highlight { x: 0.125, body: Some(1), label: label.clone() });
    check_labels_keep_clear(&drawing);
    assert!(drawing.to_svg().as_str().contains(&label));
}

#[test]
fn names_are_escaped() {
    let mut drawing = two_blocks();
    drawing.bodies[0].name = "<script>".into();
    drawing.points[0].name = "\"><b>".into();
    let svg = drawing.to_svg();
    assert!(!svg.as_str().contains("<script") && !svg.as_str().contains("<b>"));
}

#[test]
fn storeys_at_one_abscissa_are_drawn_above_each_other() {
    let frame = FixtureDrawing {
        bodies: vec![Body { rotates: false, ..Body::block("one", 0.0, 0.0) }, Body::block("two", 0.0, 0.0)],
        points: vec![Point::new("1", 0.0, 0), Point::new("2", 0.0, 1)],
        joints: vec![Joint::spring("columns", 0, 1)],
        ..FixtureDrawing::default()
    };
    check_labels_keep_clear(&frame);
    let texts = texts(frame.to_svg().as_str());
    let height = |name: &str| texts.iter().find(|text| text.0.starts_with(name)).expect(name).2;
    assert!(height("two") > height("one") + 60.0);
    assert!(
        !texts.iter().any(|text| text.0.ends_with(" mm") && text.0.len() > 4),
        "no scale bar without a scale"
    );
}

#[test]
fn indices_and_abscissae_that_lead_nowhere_are_left_out() {
    let mut drawing = two_blocks();
    drawing.points.push(Point::new("lost", 0.0, 9));
    drawing.points.push(Point::new("nowhere", f64::NAN, 0));
    drawing.bodies.push(Body::block("unbounded", f64::NEG_INFINITY, 0.0));
    drawing.joints.push(Joint::beam("loose", 4, 77));
    drawing.supports.push(Support { x: f64::INFINITY, body: 0 });
    drawing.channels.push(Channel { point: 40, kind: ChannelKind::Response });
    drawing.highlights.push(Highlight { x: f64::NAN, body: None, label: "ghost".into() });
    let svg = drawing.to_svg();
    assert!(!svg.as_str().contains("NaN") && !svg.as_str().contains("inf"), "{}", svg.as_str());
    let drawn = texts(svg.as_str());
    assert!(!drawn.iter().any(|text| ["lost", "nowhere", "loose", "ghost"].contains(&text.0.as_str())));
}

#[test]
fn an_empty_fixture_gives_an_empty_drawing() {
    assert!(FixtureDrawing::default().to_svg().as_str().ends_with("</svg>\n"));
}
