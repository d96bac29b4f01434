//! Pages in use: curves hidden and shown, zoomed into and out of, saved.

use serde_json::{Value, json};

use super::browser::opened;
use crate::common::{Bench, TWO_BLOCKS};

/// Numbers along the abscissa of a plot: how many, the least and the greatest.
fn abscissae(axes: &Value) -> (usize, f64, f64) {
    let numbers: Vec<f64> = axes["x"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    (numbers.len(), least, numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max))
}

/// Demands of a page that its plots can be used: keys of legends hide curves, in the page and in what is
/// saved; a drag and a plus zoom, and take the other plots with them; a double click and Escape leave every
/// plot as it was.
#[track_caller]
fn usable(page: &Value) {
    for list in ["dead", "kept", "stuck", "broken", "altered", "cut"] {
        assert_eq!(page[list], json!([]), "{list}");
    }
    let (_, from, to) = abscissae(&page["before"]);
    // Two tenths of the axis, of plots of a group alike.
    for zoomed in ["zoomed", "fellow"] {
        let (count, low, high) = abscissae(&page[zoomed]);
        assert!(count > 1 && from < low && high < to && high - low < 0.3 * (to - from), "{zoomed}: {page}");
    }
    assert!(page["before"]["y"] != page["zoomed"]["y"], "ordinates are not drawn anew: {}", page["zoomed"]);
    for place in ["read", "arrow"] {
        assert!(page[place].as_str().unwrap().ends_with(" Hz"), "{place}: {}", page[place]);
    }
    assert!(abscissae(&page["plus"]).2 < to, "a plus zooms in: {}", page["plus"]);
    assert_eq!(page["png"], "data:image/png;base64,");
}

#[test]
fn a_curve_is_hidden_by_its_key_a_drag_zooms_both_axes_and_a_double_click_restores_them() {
    let bench = Bench::synthesized("pages-used", TWO_BLOCKS, "50:1000:10");
    bench.done(&["decompose", "two.json", "frf.uff", "-o", "joint"]);
    let Some(seen) = opened(&bench, &["joint/report.html"], include_str!("use.js")) else { return };
    assert_eq!(seen.console, Vec::<String>::new());
    usable(&seen.pages[0]);
    assert!(seen.pages[0]["whole"].as_u64() > Some(0), "some plots leave out at first what is far off");
}

/// Each band that is held out has a key of its own in the legend, and all have the same label.
#[test]
fn of_several_marks_with_one_label_the_one_that_is_clicked_is_hidden() {
    let bench = Bench::synthesized("pages-alike", TWO_BLOCKS, "50:1000:10");
    bench.done(&["diagnose", "two.json", "frf.uff", "-o", "found"]);
    let Some(seen) = opened(&bench, &["found/report.html"], include_str!("use.js")) else { return };
    assert!(bench.text("found/report.html").matches("held out</button>").count() > 4, "two a pane");
    assert_eq!(seen.console, Vec::<String>::new());
    usable(&seen.pages[0]);
}

#[test]
fn the_low_end_of_a_logarithmic_axis_has_no_more_than_three_digits_after_a_zoom() {
    let bench = Bench::synthesized("pages-logarithmic", TWO_BLOCKS, "50:1000:10");
    bench.done(&["modes", "frf.uff", "--fixture", "two.json", "-o", "modes"]);
    let Some(seen) = opened(&bench, &["modes/report.html"], include_str!("use.js")) else { return };
    usable(&seen.pages[0]);
    for view in ["before", "zoomed", "plus"] {
        for label in seen.pages[0][view]["y"].as_array().unwrap() {
            let digits = label.as_str().unwrap().replace('.', "");
            assert!(digits.trim_matches('0').chars().count() <= 3, "{view}: {label}");
        }
    }
}

#[test]
fn models_are_drawn_dashed_and_dotted_beside_the_full_line_of_a_measurement() {
    let bench = Bench::new("pages-kinds");
    bench.write("two.json", TWO_BLOCKS);
    for (case, inertia) in [("test", "2.9e-10"), ("sim", "3.67e-10"), ("fem", "3.4e-10")] {
        bench.write("truth.json", TWO_BLOCKS.replace("3.67e-10", inertia));
        bench.done(&["synthesize", "truth.json", "--lines", "50:1000:10", "-o", "frf.uff"]);
        bench.done(&["decompose", "two.json", "frf.uff", "-o", case]);
    }
    bench.done(&["compare", "--as", "exp=test", "--as", "sim=sim", "--as", "fem=fem", "-o", "out"]);
    let Some(seen) = opened(&bench, &["out/report.html"], include_str!("use.js")) else { return };
    assert_eq!(seen.console, Vec::<String>::new());
    usable(&seen.pages[0]);
    assert_eq!(seen.pages[0]["dashes"]["H41₁₁"], json!(["6 4", "2 3"]));
}
