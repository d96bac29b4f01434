//! The side view of a fixture: what is drawn, and that labels keep clear of each other.

use jointscope_fixture::Fixture;
use jointscope_samples::TWO_BLOCKS;
use jointscope_spectra::FrfPair;
use serde_json::{Value, json};

use crate::drawing::{Highlight, SideView};

fn fixture(json: &Value) -> Fixture {
    Fixture::from_value(json).expect("a fixture")
}

fn block(x_cg: f64) -> Value {
    json!({ "mass": 1.0, "inertia": 1e-3, "x_cg": x_cg })
}

fn point(body: &str, x: f64) -> Value {
    json!({ "body": body, "x": x })
}

/// FRFs of every point to every point, or of every point to the first.
fn frfs(fixture: &Fixture, references: usize) -> Vec<FrfPair> {
    let names = || fixture.points().iter().map(|point| point.name.as_str());
    names().flat_map(|o| names().take(references).map(move |i| FrfPair::transverse(o, i))).collect()
}

fn two_blocks_named(body: &str, point_1: &str) -> Fixture {
    let [body, point_1] = [body, point_1].map(|name| json!(name).to_string());
    let file = TWO_BLOCKS.replace(r#""A""#, &body).replacen(r#""1""#, &point_1, 1);
    Fixture::from_json(&file).expect("a fixture")
}

pub(super) fn two_blocks() -> Fixture {
    two_blocks_named("A", "1")
}

fn drawn(fixture: &Fixture, highlights: Vec<Highlight>) -> String {
    let frfs = frfs(fixture, usize::MAX);
    SideView { highlights, ..SideView::new(fixture, &frfs) }.draw().wide.into_string()
}

#[test]
fn the_drawing_for_narrow_windows_has_everything_within_its_width() {
    for fixture in [two_blocks(), chain(), frame()] {
        let frfs = frfs(&fixture, usize::MAX);
        let narrow = SideView::new(&fixture, &frfs).draw().narrow.unwrap().into_string();
        assert!(narrow.contains("class=\"fx narrow\"") && narrow.contains("viewBox=\"0 0 400 "));
        for point in fixture.points() {
            assert!(narrow.contains(&format!(">{}<", point.name)), "point {}", point.name);
        }
        let places = narrow.split("translate(").skip(1).map(|rest| rest.split(' ').next().unwrap());
        for x in places {
            assert!((0.0..=400.0).contains(&x.parse::<f64>().unwrap()), "{x}");
        }
    }
}

#[test]
fn a_name_too_long_for_the_drawing_loses_its_middle_and_stands_whole_in_the_words_for_who_cannot_see_it() {
    let name = format!("left {} 12", "long ".repeat(40));
    let fixture = two_blocks_named(&name, "1");
    let drawing = SideView::new(&fixture, &frfs(&fixture, 1)).draw();
    for (markup, most) in [(drawing.wide, 860.0), (drawing.narrow.unwrap(), 400.0)] {
        let markup = markup.into_string();
        assert!(markup.contains(&format!("Bodies: {name}, B.")), "{markup}");
        let shown =
            markup.split('>').find(|text| text.starts_with("left long") && text.contains('…')).unwrap();
        let shown = shown.split('<').next().unwrap();
        assert!(shown.ends_with(" 12") && 7.4 * (shown.chars().count() as f64) < most, "{shown}");
    }
}

/// Four bodies in a row, eight points, three joints, a support under each body.
pub(super) fn chain() -> Fixture {
    let (mut bodies, mut points, mut joints, mut supports) = (json!({}), json!({}), json!({}), json!({}));
    for i in 0..4 {
        let (name, from) = (format!("block {i}"), 0.1 * f64::from(i));
        bodies[&name] = block(from + 0.035);
        points[(2 * i + 1).to_string()] = point(&name, from);
        points[(2 * i + 2).to_string()] = point(&name, from + 0.07);
        supports[format!("S{i}")] = json!({ "body": name, "x": from + 0.03, "stiffness": 1e3 });
        if i > 0 {
            joints[format!("J{}", i - 1)] = json!({ "from": (2 * i).to_string(), "to": (2 * i + 1).to_string(), "stiffness": [[1e6, 0], [0, 1e3]] });
        }
    }
    fixture(&json!({ "bodies": bodies, "points": points, "joints": joints, "supports": supports }))
}

/// Storeys above each other.
pub(super) fn frame() -> Fixture {
    let storey = json!({ "mass": 6.0, "rotates": false });
    fixture(&json!({
        "bodies": { "one": storey, "two": storey },
        "points": { "1": point("one", 0.0), "2": point("two", 0.0) },
        "joints": { "columns": { "from": "1", "to": "2", "stiffness": [[3.4e6, 0], [0, 0]] } }
    }))
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

fn check_labels_keep_clear(svg: &str) {
    let texts = texts(svg);
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
    check_labels_keep_clear(&drawn(&two_blocks(), vec![]));
}

#[test]
fn the_labels_of_a_chain_of_four_bodies_keep_clear_of_each_other() {
    let chain = chain();
    let svg = SideView::new(&chain, &frfs(&chain, 1)).draw().wide.into_string();
    assert_eq!(svg.matches("fx-ground").count(), 5, "four supports and their style");
    check_labels_keep_clear(&svg);
}

#[test]
fn a_long_highlight_stays_within_the_drawing() {
    let label = "rotational compliance of the interface at 4: 12.0 ± 0.3 kN·m/rad".to_owned();
    let svg = drawn(&two_blocks(), vec![Highlight { x: 0.125, body: Some(1), label: label.clone() }]);
    check_labels_keep_clear(&svg);
    assert!(svg.contains(&label));
}

/// Upright lines that tie labels to their places: abscissa, upper and lower end.
fn leaders(svg: &str) -> Vec<(f64, f64, f64)> {
    let of_class = |class: &'static str| svg.split(class).skip(1);
    let paths =
        of_class("<path class=\"fx-leader\" d=\"M").chain(of_class("<path class=\"fx-highlight\" d=\"M"));
    let number = |text: &str| text.parse::<f64>().expect("a number");
    let ends = |rest: &str| {
        let d = rest.split_once('"').expect("an end").0.replace('L', " ");
        let all: Vec<f64> = d.split(' ').map(number).collect();
        (all[0], all[1].min(all[3]), all[1].max(all[3]))
    };
    paths.map(ends).collect()
}

#[test]
fn no_leader_crosses_a_label() {
    let label = "1. interface compliance".to_owned();
    let at = |x: f64, body: usize| Highlight { x, body: Some(body), label: label.clone() };
    let chain = chain();
    let of_chain =
        SideView { highlights: vec![at(0.07, 0), at(0.27, 2)], ..SideView::new(&chain, &frfs(&chain, 8)) };
    for svg in [drawn(&two_blocks(), vec![at(0.0, 0), at(0.065, 1)]), of_chain.draw().wide.into_string()] {
        check_labels_keep_clear(&svg);
        let leaders = leaders(&svg);
        assert!(leaders.len() > 5, "{svg}");
        for (text, x, y) in texts(&svg) {
            let half = 3.0 * text.chars().count() as f64;
            let crossed = leaders
                .iter()
                .find(|(at, top, low)| (at - x).abs() < half && *top < y - 6.0 && *low > y - 2.0);
            assert!(crossed.is_none(), "{crossed:?} crosses '{text}' at ({x}, {y}): {svg}");
        }
    }
}

#[test]
fn who_cannot_see_the_drawing_is_told_what_is_marked() {
    let svg =
        drawn(&two_blocks(), vec![Highlight { x: 0.065, body: Some(1), label: "1. added mass".into() }]);
    assert!(svg.contains("Marked: 1. added mass on B at x = 65.00 mm. Bodies: A, B."), "{svg}");
}

#[test]
fn names_are_escaped() {
    let svg = drawn(&two_blocks_named("<script>", "\"><b>"), vec![]);
    assert!(!svg.contains("<script") && !svg.contains("<b>"));
    assert!(svg.contains("&lt;script&gt;"));
}

#[test]
fn storeys_at_one_abscissa_are_drawn_above_each_other() {
    let frame = frame();
    let svg = SideView::new(&frame, []).draw().wide.into_string();
    check_labels_keep_clear(&svg);
    let texts = texts(&svg);
    let height = |name: &str| texts.iter().find(|text| text.0.starts_with(name)).expect(name).2;
    assert!(height("two") > height("one") + 60.0);
    assert!(
        !texts.iter().any(|text| text.0.ends_with(" mm") && text.0.len() > 4),
        "no scale bar without a scale"
    );
}

#[test]
fn bodies_without_a_place_and_highlights_at_no_abscissa_are_left_out() {
    let mut json: Value = serde_json::from_str(&two_blocks().to_json()).expect("json");
    json["bodies"]["nowhere"] = json!({ "mass": 1.0, "rotates": false });
    let ghost = Highlight { x: f64::NAN, body: None, label: "ghost".into() };
    let elsewhere = FrfPair::transverse("lost", "1");
    let fixture = fixture(&json);
    let view = SideView { highlights: vec![ghost], ..SideView::new(&fixture, [&elsewhere]) };
    let svg = view.draw().wide.into_string();
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    let drawn = texts(&svg);
    assert!(
        !drawn.iter().any(|text| ["response lost", "nowhere (y only)", "ghost"].contains(&text.0.as_str()))
    );
}

#[test]
fn of_thousands_of_points_those_in_use_are_named_and_the_rest_is_counted() {
    let mut file = json!({
        "bodies": { "A": block(-0.030), "B": block(0.095) },
        "points": { "2": point("A", 0.0), "3": point("B", 0.065) },
        "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 } } }
    });
    for index in 10..3010 {
        file["points"][index.to_string()] = point("B", 0.065 + 1e-5 * f64::from(index));
    }
    let fixture = fixture(&file);
    let frfs = [FrfPair::transverse("2000", "2001")];
    let svg = SideView::new(&fixture, &frfs).draw().wide.into_string();
    for name in ["2", "3", "2000", "2001", "response 2000", "reference 2001"] {
        assert!(svg.contains(&format!(">{name}<")), "{name}");
    }
    check_labels_keep_clear(&svg);
    // Both bodies stand in one row: its four points in use and 56 more.
    let unlabelled = 3002 - 60;
    assert!(svg.contains(&format!("{unlabelled} more points")));
    assert!(svg.contains("Points: 3002 of them."));
}
