//! How time, memory and output grow with lines, FRFs and bodies: the table of
//! `docs/records/2026-11-23-growth.md`.
//!
//! Each row but the first is a run of the program (`target/release/jointscope`, built first) on files made
//! here, with one thread and with two. Processor time is what the kernel counts of ended children, memory the
//! largest resident set; both from `/proc`, so that elsewhere they are not shown. A run that takes too long
//! is ended. Names of rows after `--` choose among them: `-- modes`.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

use jointscope_benches::cases::{self, Attachments};
use jointscope_benches::{compare, ratio};
use jointscope_decomposition::Relation;
use jointscope_linalg::Matrix2;
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Time by the clock after which a run is ended.
const PATIENCE: Duration = Duration::from_secs(300);
/// Clock ticks a second in `/proc`.
const TICKS: f64 = 100.0;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // `cargo test --all-targets` calls without `--bench`: then it is enough that this compiles.
    if !arguments.iter().any(|argument| argument == "--bench") {
        return;
    }
    let chosen: Vec<&String> = arguments.iter().filter(|argument| !argument.starts_with('-')).collect();
    let is_chosen = |name: &str| chosen.is_empty() || chosen.iter().any(|part| name.contains(part.as_str()));
    let program = program();
    let folder = std::env::temp_dir().join(format!("jointscope-growth-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    if is_chosen("kernel") {
        kernel();
    }
    println!("| work | processor time, 1 thread | 2 threads | memory | of the data | output | wanted |");
    println!("|---|---|---|---|---|---|---|");
    for (lines, wanted) in [(10_000, "0.2 s"), (100_000, "1.5 s"), (1_000_000, "15 s, 3 × the data")] {
        let test = Test::of(&folder, (2, 1), (2, lines));
        let name = format!("decompose 4 FRFs × {lines} lines");
        row(is_chosen, &name, &program, &test, &["decompose", "F", "R"], wanted);
        if lines == 1_000_000 {
            let name = format!("modes 4 FRFs × {lines} lines");
            row(is_chosen, &name, &program, &test, &["modes", "R"], "5 s, 300 MB");
        }
    }
    for (references, wanted) in [(4, "3 s"), (8, "6 s")] {
        let test = Test::of(&folder, (4, 8), (references, 400));
        let name = format!("diagnose {} FRFs × 400 lines, 4 bodies", 8 * references);
        row(is_chosen, &name, &program, &test, &["diagnose", "F", "R"], wanted);
    }
    for (bodies, wanted) in [(8, "2 s"), (12, "4 s"), (16, "6 s"), (32, "20 s")] {
        let test = Test::of(&folder, (bodies, 2), (2, 400));
        let name = format!("diagnose 4 FRFs × 400 lines, {bodies} bodies");
        row(is_chosen, &name, &program, &test, &["diagnose", "F", "R"], wanted);
    }
    let size = fs::metadata(&program).unwrap().len() as f64 / 1e6;
    println!("| size of the program | | | | | {size:.1} MB | 8 MB |");
    fs::remove_dir_all(&folder).unwrap();
}

/// The program, built as it is released.
fn program() -> PathBuf {
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let built = Command::new(cargo).args(["build", "--release", "-p", "jointscope-cli"]).status().unwrap();
    assert!(built.success(), "the program cannot be built");
    let own = std::env::current_exe().unwrap();
    own.ancestors().nth(2).unwrap().join("jointscope")
}

/// H41 to the joint's dynamic stiffness, in memory and over the floor.
fn kernel() {
    for count in [4_000, 1_000_000] {
        let (h41, sides) = cases::decomposition(count);
        let [mut ours, mut floor] = [0, 1].map(|_| vec![Matrix2::zero(); count]);
        let times = compare(
            15,
            0.01,
            &mut [
                &mut || Relation::Exact.decompose_lines(black_box(&h41), &sides, black_box(&mut ours[..])),
                &mut || cases::floor(black_box(&h41), &sides, black_box(&mut floor[..])),
            ],
        );
        let (line, over) = (times[0].best / count as f64 * 1e9, ratio(&times[0], &times[1]));
        println!(
            "joint from H41, {count} lines: {line:.1} ns a line, {over:.2} × the floor (wanted: 12 ns, 1.2 ×)"
        );
    }
    println!();
}

/// Files of a test.
struct Test {
    fixture: PathBuf,
    recording: PathBuf,
}

impl Test {
    /// A chain of blocks to which a mass was added on the first one that its fixture does not have, where it
    /// is longer than two.
    fn of(folder: &Path, (bodies, responses): (usize, usize), (references, lines): (usize, usize)) -> Self {
        let [fixture, recording] = ["json", "uff"]
            .map(|kind| folder.join(format!("{bodies}-{responses}-{references}-{lines}.{kind}")));
        let believed = cases::chain(bodies, Attachments::None);
        fs::write(&fixture, believed.to_json()).unwrap();
        let bytes = match bodies {
            2 => cases::universal_file(lines, cases::BINARY),
            _ => cases::test_of_a_chain(bodies, (responses, references), lines),
        };
        fs::write(&recording, bytes).unwrap();
        Test { fixture, recording }
    }
}

/// What a run took.
struct Taken {
    /// s; `None` where it was ended.
    seconds: Option<f64>,
    /// Bytes.
    memory: f64,
}

/// One row: the command on the test's fixture (`F`) and recording (`R`).
fn row(
    is_chosen: impl Fn(&str) -> bool,
    name: &str,
    program: &Path,
    test: &Test,
    words: &[&str],
    wanted: &str,
) {
    if !is_chosen(name) {
        return;
    }
    let out = test.recording.with_extension("out");
    let runs = [1, 2].map(|threads| {
        let mut command = Command::new(program);
        for word in words {
            match *word {
                "F" => command.arg(&test.fixture),
                "R" => command.arg(&test.recording),
                word => command.arg(word),
            };
        }
        command.arg("-o").arg(&out).env("RAYON_NUM_THREADS", threads.to_string());
        run(command)
    });
    let time = |run: &Taken| match run.seconds {
        Some(seconds) => format!("{seconds:.2} s"),
        None => format!("ended after {} s", PATIENCE.as_secs()),
    };
    let data = fs::metadata(&test.recording).unwrap().len() as f64;
    let memory = runs.iter().map(|run| run.memory).fold(0.0, f64::max);
    let output: u64 =
        fs::read_dir(&out).map_or(0, |all| all.map(|file| file.unwrap().metadata().unwrap().len()).sum());
    println!(
        "| {name} | {} | {} | {:.0} MB | {:.1} × | {:.1} MB | {wanted} |",
        time(&runs[0]),
        time(&runs[1]),
        memory / 1e6,
        memory / data,
        output as f64 / 1e6
    );
    let _ = fs::remove_dir_all(&out);
}

fn run(mut command: Command) -> Taken {
    let before = children();
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let (start, mut memory) = (Instant::now(), 0.0);
    let ended = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status.code().is_some_and(|code| code < 2);
        }
        memory = peak(child.id()).unwrap_or(memory);
        if start.elapsed() > PATIENCE {
            child.kill().unwrap();
            child.wait().unwrap();
            break false;
        }
        sleep(Duration::from_millis(5));
    };
    Taken { seconds: before.zip(children()).map(|(before, after)| after - before).filter(|_| ended), memory }
}

/// Processor time of ended children, s.
fn children() -> Option<f64> {
    let own = fs::read_to_string("/proc/self/stat").ok()?;
    // After the name in brackets: state, ten more, utime, stime, cutime, cstime.
    let (_, rest) = own.rsplit_once(") ")?;
    let fields: Vec<&str> = rest.split(' ').collect();
    Some((fields.get(13)?.parse::<f64>().ok()? + fields.get(14)?.parse::<f64>().ok()?) / TICKS)
}

/// Largest resident set of a process until now, bytes.
fn peak(process: u32) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? * 1024.0)
}
