//! `jointscope prove --recordings` as a user meets it; the shipped hammer test stands in for a real
//! recording.

use crate::common::{Bench, TWO_BLOCKS};
use jointscope::uff::FunctionType;

/// A directory `test` with a fixture and the FRFs of one that differs by a channel.
fn bench(name: &str) -> Bench {
    let bench = Bench::new(name);
    std::fs::create_dir(bench.0.join("test")).unwrap();
    bench.write("test/fixture.json", TWO_BLOCKS);
    bench.done(&["synthesize", "test/fixture.json", "--lines", "10:1000:10", "-o", "test/frf.uff"]);
    bench
}

#[test]
fn a_concealed_sign_is_told_with_its_seal_and_the_files_say_the_same() {
    let bench = bench("prove-recordings");
    let arguments = ["prove", "--recordings", "test", "--cases", "2", "--conceal", "sign", "-o", "proof"];
    let output = bench.run(&arguments);
    let (table, progress) =
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(0), "{progress}");
    let seal = progress.split_whitespace().find(|word| word.len() == 64).unwrap();
    assert!(table.contains(seal) && table.contains("case 1, sign"), "{table}");
    assert!(table.contains("scaled by -1") && table.contains("4 FRFs on 100 lines"), "{table}");
    assert_eq!(bench.json("proof/seal.json")["sealed_truths_sha256"], seal);
    let proof = bench.json("proof/proof.json");
    assert_eq!(proof["cases"][1]["truth"]["concealment"], "sign");
    assert_eq!(proof["cases"][0]["truth"]["what"], "nothing");
    assert_eq!(bench.json("proof/answers.json").as_array().unwrap().len(), 2);
    for file in ["timing.json", "explaining.json"] {
        assert!(bench.0.join("proof").join(file).is_file(), "{file}");
    }
}

#[test]
fn a_directory_that_will_not_do_is_refused_in_a_sentence() {
    let bench = bench("prove-recordings-refused");
    let refused =
        |directory: &str, parts: &[&str]| bench.refused(&["prove", "--recordings", directory], parts);
    refused("nowhere", &["nowhere", "no such directory"]);
    refused("test/frf.uff", &["test/frf.uff", "give the directory"]);
    refused(".", &["no fixture.json", "in its directories test"]);
    for (name, files) in [
        ("bare", &["fixture.json"][..]),
        ("two", &["fixture.json", "repaired.json"]),
        ("other", &["beam.json"]),
    ] {
        std::fs::create_dir(bench.0.join(name)).unwrap();
        files.iter().for_each(|file| bench.write(&format!("{name}/{file}"), TWO_BLOCKS));
    }
    refused("bare", &["bare", "no recording"]);
    refused("two", &["several fixtures (fixture.json, repaired.json)"]);
    refused("other", &["no fixture.json", "beam.json"]);
    bench.rewrite("test/frf.uff", "bare/coherence.uff", |datasets| {
        datasets.iter_mut().for_each(|dataset| dataset.function = FunctionType::Coherence);
    });
    refused("bare", &["bare/coherence.uff", "no FRF"]);
    for (arguments, part) in [
        (&["--cases", "1"][..], "first is a control"),
        (&["--only", "8"], "0 to 7"),
        (&["--conceal", "weather"], "weather"),
        (&["--level", "loud"], "response 5 m/s^2"),
        (&["--level", "force 1 N"], "no FRFs at the level force 1 N"),
        (&["--band", "2000:3000"], "10 to 1000 Hz"),
        (&["--family", "frame"], "--family"),
        (&["--conceal", "entry"], "nothing can be concealed of the kinds asked for (entry)"),
    ] {
        bench.refused(&[&["prove", "--recordings", "test"], arguments].concat(), &[part]);
    }
    bench.refused(&["prove", "--conceal", "gain"], &["--recordings"]);
}
