//! What a page promises whatever it is given: no network, no way out of its place for any text, the same
//! bytes each time.

use maud::html;

use crate::error::PageError;
use crate::input_file::InputFile;
use crate::page::Page;
use crate::plot::{Axis, Plot, Role};
use crate::section::{Card, Section, Verdict};
use crate::table::{Cell, Table};
use crate::tone::Tone;

const HOSTILE: &str = "</script><img src=\"http://evil\" onerror='x'>&\u{2028}";

fn hostile_page() -> Page {
    let plot = Plot::new(HOSTILE, Axis::linear(HOSTILE, HOSTILE), Axis::linear(HOSTILE, HOSTILE))
        .over([1.0, 2.0])
        .line(HOSTILE, Role::Measured, [1.0, 2.0])
        .horizontal(HOSTILE, Role::Nominal, 1.5)
        .caption(HOSTILE);
    Page::new(HOSTILE)
        .subtitle(HOSTILE)
        .verdict(Verdict { tone: Tone::Problem, headline: HOSTILE.into(), details: vec![HOSTILE.into()] })
        .sections([Section::new(HOSTILE)
            .paragraph(HOSTILE)
            .cards([Card::text(HOSTILE, HOSTILE).note(HOSTILE), Card::quantity(HOSTILE, 1.0, 0.1, HOSTILE)])
            .with(
                Table::of([HOSTILE])
                    .numbers(HOSTILE, HOSTILE, |text| *text)
                    .names(HOSTILE, |text| *text)
                    .words(HOSTILE, |text| Cell::Link((*text).into(), (*text).into()))
                    .caption(HOSTILE)
                    .footnote(HOSTILE),
            )
            .notes([HOSTILE])
            .warnings([HOSTILE])
            .command(HOSTILE)
            .plot(plot)])
        .foot(HOSTILE, HOSTILE, &[InputFile { name: HOSTILE.into(), sha256: HOSTILE.into() }])
}

fn html(page: &Page) -> String {
    page.to_html().expect("the page is well formed")
}

fn page_of(plot: Plot) -> Page {
    Page::new("page").sections([Section::new("section").plot(plot)])
}

fn stiffness() -> Plot {
    Plot::new("k", Axis::frequency(), Axis::linear("k", "N/m"))
}

/// The JSON from which the script draws.
fn plot_data(html: &str) -> serde_json::Value {
    let start = html.find("id=\"plot-data\">").expect("a page with plots has their data") + 15;
    let end = start + html[start..].find("</script>").expect("the script ends");
    serde_json::from_str(&html[start..end]).expect("the data is JSON")
}

#[test]
fn no_text_from_outside_can_open_a_tag_or_end_a_script() {
    let html = html(&hostile_page());
    assert!(!html.contains("<img"), "a tag got through");
    assert_eq!(html.matches("<script").count(), 3);
    assert_eq!(html.matches("</script>").count(), 3);
    assert_eq!(plot_data(&html)["plots"][0]["x"]["label"], HOSTILE);
}

#[test]
fn text_cannot_open_a_tag_or_leave_an_attribute() {
    let text = "</script><b a='1' b=\"2\">&\u{7}";
    let page = Page::new("page").sections([Section::new("s").with(html! { p title=(text) { (text) } })]);
    // An apostrophe ends no attribute here: all stand in double quotes.
    let escaped = "&lt;/script&gt;&lt;b a='1' b=&quot;2&quot;&gt;&amp;\u{fffd}";
    assert!(html(&page).contains(&format!("<p title=\"{escaped}\">{escaped}</p>")));
}

#[test]
fn the_policy_forbids_all_sources_and_nothing_refers_to_one() {
    let html = html(&hostile_page());
    let policy = html.split("Content-Security-Policy\" content=\"").nth(1).expect("a policy");
    let policy = policy.split('"').next().expect("its end");
    assert!(
        policy.starts_with(
            "default-src 'none'; base-uri 'none'; form-action 'none'; img-src data:; script-src 'sha256-"
        ),
        "{policy}"
    );
    assert!(!policy.replace("style-src-attr 'unsafe-inline'", "").contains("unsafe"), "{policy}");
    for reference in ["src=\"http", "href=\"http", "src='http", "href='http", "url(", "@import"] {
        assert!(!html.contains(reference), "the page contains {reference}");
    }
    assert!(html.contains("The MIT License"), "uPlot's licence goes with it");
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    assert_eq!(html(&hostile_page()), html(&hostile_page()));
}

#[test]
fn masked_and_non_finite_values_are_gaps_in_the_data() {
    let plot = stiffness().over([1.0, 2.5, 3.0, 4.0]).line(
        "by line",
        Role::Measured,
        [Some(1.0), None, Some(f64::NAN), Some(2.0)],
    );
    let html = html(&page_of(plot));
    let columns = &plot_data(&html)["columns"];
    assert_eq!(columns[1], serde_json::json!([1, null, null, 2]));
    assert!(html.contains("2 lines are masked (gaps)."));
    assert!(!html.contains("NaN,"));
}

#[test]
fn values_that_are_not_positive_are_gaps_on_a_logarithmic_axis_and_the_page_says_so() {
    let plot = Plot::new("H", Axis::frequency(), Axis::logarithmic("|H|", "m/N")).over([1.0, 2.5, 3.0]).line(
        "measured",
        Role::Measured,
        [1e-6, 0.0, 1e-7],
    );
    let html = html(&page_of(plot));
    assert_eq!(plot_data(&html)["columns"][1], serde_json::json!([1e-6, null, 1e-7]));
    assert!(html.contains("1 value is not positive"));
}

#[test]
fn ordinates_are_drawn_in_the_unit_of_their_axis() {
    let plot = stiffness().over([1.0, 2.5]).line("by line", Role::Measured, [3.3e6, 3.4e6]).horizontal(
        "nominal",
        Role::Nominal,
        3.31e6,
    );
    let data = plot_data(&html(&page_of(plot)));
    assert_eq!(data["plots"][0]["y"]["unit"], "MN/m");
    assert_eq!(data["columns"][1], serde_json::json!([3.3, 3.4]));
    assert!(
        (data["plots"][0]["marks"][0]["horizontal"]["at"].as_f64().expect("a number") - 3.31).abs() < 1e-12
    );
}

#[test]
fn a_thinned_plot_says_so_and_keeps_the_resonance() {
    let frequency: Vec<f64> = (0..50_000).map(|line| f64::from(line) * 0.04).collect();
    let mut values = vec![1.0; 50_000];
    values[12_345] = 777.0;
    let html = html(&page_of(stiffness().over(&frequency).line("H", Role::Measured, &values)));
    assert!(html.contains("of 50000 lines, extremes kept"), "the thinning is not mentioned");
    assert!(html.contains(",777,"));
    assert!(html.len() < 200_000, "{} bytes", html.len());
}

#[test]
fn two_panes_of_6400_lines_with_bands_stay_below_400_kilobytes() {
    let frequency: Vec<f64> = (0..6400).map(|line| 100.0 + 0.15625 * f64::from(line)).collect();
    let pane = |level: f64| {
        let wave = |share: f64| -> Vec<f64> {
            (frequency.iter().enumerate())
                .map(|(line, f)| level * (share + 0.01 * (f * 1.7).sin() + 1e-3 * (line as f64 * 0.37).cos()))
                .collect()
        };
        stiffness().over(&frequency).band("95 %", Role::Uncertainty, wave(0.9), wave(1.1)).line(
            "by line",
            Role::Measured,
            wave(1.0),
        )
    };
    let panes = [pane(3.3e6), pane(-1.1e5)].map(|pane| pane.line_limit(8_000));
    let page = Page::new("size").sections([Section::new("k").plots(1, panes)]);
    let html = html(&page);
    assert!(html.len() <= 400_000, "{} bytes", html.len());
    let data = plot_data(&html);
    assert_eq!(
        data["plots"][0]["tables"][0][0], data["plots"][1]["tables"][0][0],
        "the abscissa is kept once"
    );
    assert_eq!(data["plots"][0]["group"], data["plots"][1]["group"], "the panes move together");
}

#[test]
fn pieces_that_do_not_fit_together_are_named() {
    let error = |page: Page| page.to_html().expect_err("the page is not well formed");
    assert_eq!(
        error(page_of(stiffness().over([1.0, 2.0]).line("by line", Role::Measured, [1.0]))),
        PageError::SeriesLength { plot: "k".into(), series: "by line".into(), expected: 2, got: 1 }
    );
    assert_eq!(
        error(page_of(stiffness().line("by line", Role::Measured, [1.0]))),
        PageError::NoAbscissa { plot: "k".into(), series: "by line".into() }
    );
    for abscissa in [[1.0, 1.0], [2.0, 1.0], [1.0, f64::NAN]] {
        let plot = stiffness().over(abscissa).line("by line", Role::Measured, [1.0, 2.0]);
        assert_eq!(error(page_of(plot)), PageError::Abscissa { plot: "k".into(), index: 1 });
    }
}

#[test]
fn sections_of_one_name_have_anchors_of_their_own() {
    let page = Page::new("page").sections(["Joint J", "Joint J", "§"].map(Section::new));
    let html = html(&page);
    for anchor in ["joint-j", "joint-j-2", "section"] {
        assert!(
            html.contains(&format!("<section id=\"{anchor}\">"))
                && html.contains(&format!("href=\"#{anchor}\"")),
            "no {anchor}"
        );
    }
}

#[test]
fn every_plot_says_in_a_sentence_what_it_shows() {
    let html = html(&page_of(stiffness().over([1.0, 2.0]).line("by line", Role::Measured, [1.0, 2.0])));
    assert!(html.contains("<figcaption>k over frequency: by line."));
}
