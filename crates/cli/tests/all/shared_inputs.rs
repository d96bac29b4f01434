//! Inputs that others made wrong, beside the workspace: each is refused in one sentence or answered, and what
//! its flaw is stands in what is said.

use std::fs;
use std::path::Path;

use crate::common::Bench;

/// What is refused by `check`; all else is answered.
const REFUSED: &[&str] = &[
    "0_bytes.uff",
    "1_line.uff",
    "1e300_value.uff",
    "1e400.json",
    "58b_with_float_fmt_IBM.uff",
    "58b_with_wrong_byte_order.uff",
    "all_FRFs_zero.uff",
    "array.json",
    "asym_stiffness.json",
    "binary_truncated_58b_header.uff",
    "comments.json",
    "CR_only.uff",
    "CSV.uff",
    "decimal_comma.json",
    "decimal_commas.uff",
    "deep_nest.json",
    "different_axes.uff",
    "direction_x.uff",
    "dup_key.json",
    "duplicate_FRF.uff",
    "duplicate_FRF_differing.uff",
    "empty.json",
    "extra_field.json",
    "fixture_is_the_uff.json",
    "FRF_displaced_freq_axis_in_rad_s_.uff",
    "FRFs_x1000.uff",
    "huge_num_pts.uff",
    "indefinite_stiffness.json",
    "Inf_value.uff",
    "joint_to_itself.json",
    "joint_to_unknown.json",
    "latin_1.json",
    "letters_in_data.uff",
    "missing_inertia.json",
    "NaN_literal.json",
    "NaN_value.uff",
    "negative_mass.json",
    "negative_num_pts.uff",
    "negative_ratio.json",
    "negative_std.json",
    "negative_step.uff",
    "no_closing_1.uff",
    "not_json.json",
    "null_mass.json",
    "one_block_other_length.uff",
    "only_newline.uff",
    "ord_type_99.uff",
    "physics_typo.json",
    "physics_unknown_kind.json",
    "point_on_no_body.json",
    "random_binary.uff",
    "ratio_40_percent_.json",
    "reversed_joint.json",
    "spacing_0_uneven_claimed.uff",
    "std_missing.json",
    "std_string.json",
    "string_mass.json",
    "support_without_stiffness.json",
    "tb0.uff",
    "tb1.uff",
    "tb2.uff",
    "tb3.uff",
    "trailing_comma.json",
    "truncated.json",
    "truncated_at_header.uff",
    "truncated_mid_number.uff",
    "typo_Bodies.json",
    "typo_masss.json",
    "unclosed_9999.uff",
    "unit_string.json",
    "units_bananas.uff",
    "UTF_16.uff",
    "zero_increment.uff",
    "zero_length_joint.json",
    "zero_mass.json",
    "zero_num_pts.uff",
    "zip_file.uff",
];

/// What must be said of some, words parted by `|`.
const SAID: &[(&str, &str)] = &[
    ("58b_with_wrong_byte_order.uff", "byte order|export it again"),
    ("E_in_GPa.json", "joints/J/beam/youngs_modulus|GPa|--as-stated"),
    ("FRFs_x1000.uff", "steps by a factor of 1000|export the file again"),
    ("asym_stiffness.json", "joints/J/stiffness|make the two equal"),
    ("cg_outside.json", "bodies/B|--as-stated"),
    ("decimal_commas.uff", "line 9|decimal points|export it again"),
    ("extra_field.json", "`colour` is unknown|remove it"),
    ("inertia_in_kg_mm2.json", "bodies/A/inertia|kg·mm²"),
    ("mass_in_grams.json", "bodies/A/mass|grams"),
    ("missing_inertia.json", "bodies/A|`inertia` is missing|`\"rotates\": false`"),
    ("negative_mass.json", "bodies/A/mass|correct it"),
    ("negative_num_pts.uff", "line 9|-40|export the file again"),
    ("no_damping.json", "modal_ratios"),
    ("null_mass.json", "bodies/A/mass|write one in SI units"),
    ("ord_type_99.uff", "line 9|99|export the file again"),
    ("std_missing.json", "bodies/A/mass|`std` is missing|write the value alone"),
    ("three_bodies_disconnected.json", "body C hangs on nothing|2 are free"),
    ("unclosed_9999.uff", "line 5|put back the missing one"),
    ("units_lbf.uff", "lbf and N"),
    ("x_in_mm.json", "points/1/x|millimetres"),
];

#[test]
fn every_input_that_goes_wrong_is_refused_in_one_sentence_or_answered_with_its_flaw() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/bad-inputs/files");
    let Ok(entries) = fs::read_dir(&folder) else {
        println!("skipped: no folder `shared/bad-inputs/files` beside the workspace");
        return;
    };
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    let bench = Bench::new("shared-inputs");
    let mut failures = Vec::new();
    for name in names.iter().filter(|name| *name != "fx.json") {
        let path = |name: &str| folder.join(name).display().to_string();
        let (fixture, recording) = if name.ends_with(".json") {
            (path(name), path("good.uff"))
        } else {
            (path("fx.json"), path(name))
        };
        let output = bench.run(&["check", &fixture, &recording]);
        let told = String::from_utf8_lossy(&output.stderr);
        let refused = REFUSED.contains(&name.as_str());
        if output.status.code() != Some(if refused { 2 } else { 0 }) {
            failures.push(format!("{name} ends with {:?}: {told}", output.status.code()));
        }
        let sentences = told.lines().filter(|line| !line.starts_with("note: ")).count();
        if sentences != usize::from(refused)
            || told.contains("panicked")
            || output.stdout.is_empty() != refused
        {
            failures.push(format!("{name} is not one sentence or one answer: {told}"));
        }
        let said = format!("{told}{}", String::from_utf8_lossy(&output.stdout));
        let words = SAID.iter().filter(|(of, _)| of == name).flat_map(|(_, words)| words.split('|'));
        let lacking = words.filter(|word| !said.contains(word));
        failures.extend(lacking.map(|word| format!("{name} lacks `{word}`: {said}")));
    }
    assert!(names.len() > 100, "{names:?}");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(bench.names().is_empty());
}
