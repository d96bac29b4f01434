//! What is asked of any input (`fuzz/`), asked of the inputs that are kept.

#[path = "../../../../fuzz/src/targets.rs"]
#[allow(unreachable_pub)] // a crate of its own elsewhere
#[allow(clippy::expect_used)] // what cannot fail
mod targets;

/// Asks `target` of its corpus.
fn replay(name: &str, target: impl Fn(&[u8])) {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(name);
    let mut inputs: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    inputs.sort();
    assert!(!inputs.is_empty());
    for input in inputs {
        println!("{}", input.display()); // a failure says which
        target(&std::fs::read(&input).unwrap());
    }
}

#[test]
fn universal_files_of_the_corpus_are_written_as_they_are_read() {
    replay("uff", targets::uff);
}

#[test]
fn fixtures_of_the_corpus_have_finite_frfs_and_mean_the_same_when_written() {
    replay("fixture", targets::fixture);
}

#[test]
fn recordings_of_the_corpus_give_finite_frfs_and_hits() {
    replay("recordings", targets::recordings);
}

#[test]
fn any_signals_of_the_corpus_give_finite_frfs() {
    replay("estimation", targets::estimation);
}

#[test]
fn answers_of_the_corpus_are_compared_and_exported_without_a_number_that_is_none() {
    replay("answers", targets::answers);
}
